//! Sets some limits under a custom identity, reads the drone's configuration back, and prints events
//! meanwhile.
//!
//! `cargo run -p ardrone-link --features net --example configure [HOST]`
#![allow(clippy::print_stdout, reason = "it shows what happens")]

use std::error::Error;
use std::time::Duration;

use ardrone_link::{Client, ClientBuilder, Configuration, Event, Identity, Setting};

/// Configures the drone; returns the configuration that it reports afterwards.
pub(crate) async fn configure(drone: ClientBuilder) -> Result<Configuration, Box<dyn Error>> {
    let drone = drone
        .identity(Identity { session: 0x5E55_1011, user: 0x0000_0A5E, application: 0xA9B1 })
        .setting(Setting::Outdoor(false))
        .setting(Setting::AltitudeMaxM(2.5))
        .setting(Setting::ClimbMaxMS(0.5))
        .read_back(true)
        .start()
        .await?;
    // Fails unless the drone has applied every setting.
    drone.ready().await?;
    let mut events = drone.events();
    loop {
        match events.next(Duration::from_secs(5)).await? {
            Event::Configured { key } => println!("acknowledged: {key}"),
            Event::ConfigurationRead(configuration) => {
                println!("{} keys were read back", configuration.len());
                drone.close().await?;
                return Ok(configuration);
            }
            other => println!("{other:?}"),
        }
    }
}

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    let host = std::env::args().nth(1).unwrap_or_else(|| "192.168.1.1".to_owned());
    configure(Client::builder().host(host)).await?;
    Ok(())
}
