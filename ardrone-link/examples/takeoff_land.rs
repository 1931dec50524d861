//! Takes off, flies forward for a second, lands.
//!
//! `cargo run -p ardrone-link --features net --example takeoff_land [HOST]`, against a real drone or
//! `mock-drone`. The README shows what stands below.
use std::error::Error;
use std::time::Duration;

use ardrone_link::{Client, ClientBuilder, Setting, Steering};

/// Takes off, flies forward for a second, lands.
pub(crate) async fn fly(drone: ClientBuilder) -> Result<(), Box<dyn Error>> {
    let drone = drone
        .setting(Setting::Outdoor(false))
        .setting(Setting::AltitudeMaxM(2.0))
        .setting(Setting::EulerAngleMaxDeg(8.0))
        .start()
        .await?;
    drone.ready().await?; // found and configured
    drone.flat_trim()?;
    drone.take_off().await?; // hovers
    drone.steer(Steering::forward(0.2), Duration::from_secs(1))?;
    tokio::time::sleep(Duration::from_secs(3)).await; // hovers again after the first
    drone.land().await?; // stands
    drone.close().await?;
    Ok(())
}

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    let host = std::env::args().nth(1).unwrap_or_else(|| "192.168.1.1".to_owned());
    fly(Client::builder().host(host)).await
}
