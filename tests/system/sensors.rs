//! No single sensor failure leads the drone far astray. `cargo xtask sensors` is the same with more seeds.

use std::thread;

use system_tests::airframes::AIRFRAMES;
use system_tests::sensors::{led_astray, random};

const SEED: u64 = 1;
/// Random failures that are flown, and the number of the first, for each of some threads.
const RANDOM: u64 = 75;
const FIRST: [u64; 4] = [1, 76, 151, 226];

#[test]
fn no_single_sensor_leads_the_drone_far_astray() {
    let airframes =
        AIRFRAMES.map(|airframe| thread::spawn(move || led_astray(airframe, SEED).unwrap()));
    let found: Vec<String> =
        airframes.into_iter().flat_map(|airframe| airframe.join().unwrap()).collect();
    assert!(found.is_empty(), "{} led astray:\n{}", found.len(), found.join("\n"));
}

#[test]
fn no_random_failure_of_a_sensor_leads_the_drone_far_astray() {
    let threads = FIRST.map(|first| {
        thread::spawn(move || {
            let flown = (first..first + RANDOM).map(|number| random(number).unwrap());
            flown.filter(|flight| flight.shows && flight.is_too_far()).collect::<Vec<_>>()
        })
    });
    let found: Vec<String> = threads
        .into_iter()
        .flat_map(|thread| thread.join().unwrap())
        .map(|flight| flight.to_string())
        .collect();
    assert!(found.is_empty(), "{} led astray:\n{}", found.len(), found.join("\n"));
}
