//! Takes off, hovers for three seconds, lands.
//!
//! `cargo run -p ardrone-link --features net --example takeoff_land [HOST]`, against a real drone or
//! `mock-drone`.
#![allow(clippy::print_stdout, reason = "it shows what happens")]

use std::error::Error;
use std::time::Duration;

use ardrone_link::DroneAddress;
use ardrone_link::net::Client;
use ardrone_link::session::{Event, FlightOrder, Order, SessionConfig};
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
        Setting::AltitudeMaxM(2.0),
        Setting::EulerAngleMaxDeg(8.0),
    ];
    let settings = settings.iter().map(Setting::config).collect::<Result<_, _>>()?;
    let config = SessionConfig { settings, ..SessionConfig::default() };
    let mut drone = Client::start(&address, config).await?;

    wait_for(&mut drone, &Event::Ready).await?;
    drone.request_flat_trim();
    println!("taking off");
    drone.order(Order { flight: FlightOrder::TakeOff, ..Order::default() });
    wait_for(&mut drone, &Event::Airborne).await?;
    drone.order(Order { flight: FlightOrder::StayAirborne, ..Order::default() });
    for _ in 0..6 {
        tokio::time::sleep(Duration::from_secs(1)).await;
        if let Some(demo) = drone.navdata().and_then(|navdata| navdata.demo) {
            println!("{:?} at {:.2} m", demo.control_state, demo.altitude_m);
        }
    }
    println!("landing");
    drone.order(Order::default());
    wait_for(&mut drone, &Event::Landed).await?;
    drone.close().await?;
    Ok(())
}

/// Waits for an event, but not for ever, and not past an emergency.
async fn wait_for(drone: &mut Client, wanted: &Event) -> Result<(), Box<dyn Error>> {
    let waiting = async {
        while let Some(event) = drone.next_event().await {
            println!("{event:?}");
            match event {
                event if event == *wanted => return Ok(()),
                Event::Emergency | Event::LinkLost | Event::TakeOffTimedOut => {
                    return Err(format!("{event:?} while waiting for {wanted:?}").into());
                }
                _ => {}
            }
        }
        Err("the client has ended".into())
    };
    match tokio::time::timeout(Duration::from_secs(20), waiting).await {
        Ok(result) => result,
        Err(_) => Err(format!("{wanted:?} never came").into()),
    }
}
