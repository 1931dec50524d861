//! Sets some limits with an identity of its own, and reads the drone's configuration back.
//!
//! `cargo run -p ardrone-link --features net --example configure [HOST]`
#![allow(clippy::print_stdout, reason = "it shows what happens")]

use std::error::Error;

use ardrone_link::DroneAddress;
use ardrone_link::at::Identity;
use ardrone_link::net::Client;
use ardrone_link::session::{Event, SessionConfig};
use ardrone_link::settings::Setting;

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    let mut address = DroneAddress::default();
    if let Some(host) = std::env::args().nth(1) {
        address.host = host;
    }
    let settings = [
        Setting::NavdataDemo(true),
        Setting::Outdoor(false),
        Setting::AltitudeMaxM(2.5),
        Setting::ClimbMaxMS(0.5),
    ];
    let configs: Vec<_> = settings.iter().map(Setting::config).collect::<Result<_, _>>()?;
    let config = SessionConfig {
        settings: configs.clone(),
        identity: Some(Identity { session: 0x5E55_1011, user: 0x0000_0A5E, application: 0xA9B1 }),
        read_back: true,
        ..SessionConfig::default()
    };
    let mut drone = Client::start(&address, config).await?;
    while let Some(event) = drone.next_event().await {
        match event {
            Event::Configured { key } => println!("acknowledged: {key}"),
            Event::ConfigurationTimedOut { key } => println!("never acknowledged: {key}"),
            Event::ConfigurationRead(configuration) => {
                println!("{} keys were read back", configuration.len());
                for config in &configs {
                    let taken = configuration.has(config.key(), config.value());
                    println!("{} = {}: {}", config.key(), config.value(), taken);
                }
            }
            Event::ConfigurationNotRead => println!("the configuration could not be read back"),
            Event::Ready => break,
            _ => {}
        }
    }
    drone.close().await?;
    Ok(())
}
