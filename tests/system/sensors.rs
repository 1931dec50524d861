//! No single sensor failure leads the drone far astray. `cargo xtask sensors` is the same with more seeds.

use std::thread;

use system_tests::sensors::{AIRFRAMES, led_astray};

const SEED: u64 = 1;

#[test]
fn no_single_sensor_leads_the_drone_far_astray() {
    let airframes =
        AIRFRAMES.map(|airframe| thread::spawn(move || led_astray(airframe, SEED).unwrap()));
    let found: Vec<String> =
        airframes.into_iter().flat_map(|airframe| airframe.join().unwrap()).collect();
    assert!(found.is_empty(), "{} led astray:\n{}", found.len(), found.join("\n"));
}
