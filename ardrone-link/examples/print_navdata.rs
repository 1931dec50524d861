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

use ardrone_link::{Client, ClientBuilder, NavdataMode, Packet};
use tokio::time::Instant;

/// Prints what the drone sends for some time; returns the number of packets.
pub(crate) async fn listen(
    drone: ClientBuilder,
    duration: Duration,
) -> Result<u32, Box<dyn Error>> {
    let drone = drone.navdata(NavdataMode::Full).start().await?;
    drone.ready().await?;
    let mut packets = drone.packets();
    let begun = Instant::now();
    let (mut count, mut printed) = (0, None::<Instant>);
    while begun.elapsed() < duration {
        let bytes = packets.next(Duration::from_secs(2)).await?;
        count += 1;
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
    println!("{count} packets in {duration:?}");
    drone.close().await?;
    Ok(count)
}

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let host = arguments.next().unwrap_or_else(|| "192.168.1.1".to_owned());
    let seconds = arguments.next().map_or(Ok(10), |text| text.parse())?;
    listen(Client::builder().host(host), Duration::from_secs(seconds)).await?;
    Ok(())
}
