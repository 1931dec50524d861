//! Prints every option of the drone's full navdata, once a second.
//!
//! `cargo run -p ardrone-link --features net --example print_navdata [HOST] [SECONDS]`
#![allow(
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "it shows what happens, once a second"
)]

use std::error::Error;
use std::time::Duration;

use ardrone_link::DroneAddress;
use ardrone_link::navdata::Packet;
use ardrone_link::net::Client;
use ardrone_link::session::SessionConfig;
use ardrone_link::settings::Setting;
use tokio::time::{Instant, timeout_at};

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut address = DroneAddress::default();
    if let Some(host) = arguments.next() {
        address.host = host;
    }
    let seconds: u64 = arguments.next().map_or(Ok(10), |text| text.parse())?;
    let settings = vec![Setting::NavdataDemo(false).config()?];
    let config = SessionConfig { settings, ..SessionConfig::default() };
    let mut drone = Client::start(&address, config).await?;

    let end = Instant::now() + Duration::from_secs(seconds);
    let (mut packets, mut printed) = (0_u32, None::<Instant>);
    while let Ok(Some(bytes)) = timeout_at(end, drone.next_packet()).await {
        packets += 1;
        if printed.is_some_and(|at| at.elapsed() < Duration::from_secs(1)) {
            continue;
        }
        printed = Some(Instant::now());
        let packet = Packet::decode(&bytes)?;
        println!("packet {} with {} bytes, {:?}", packet.sequence, bytes.len(), packet.state);
        for option in packet.options() {
            println!("  {option:?}");
        }
    }
    println!("{packets} packets in {seconds} s");
    drone.close().await?;
    Ok(())
}
