//! No single sensor leads the drone far astray: `cargo xtask sensors` is the same with more seeds.

use std::thread;

use system_tests::sensors::{AIRFRAMES, Model, Situation, failures, fly};

const SEEDS: std::ops::RangeInclusive<u64> = 1..=1;

#[test]
fn no_single_sensor_leads_the_drone_far_astray() {
    let airframes = AIRFRAMES.map(|airframe| thread::spawn(move || faults_on(airframe)));
    let found: Vec<String> =
        airframes.into_iter().flat_map(|airframe| airframe.join().unwrap()).collect();
    assert!(found.is_empty(), "{} led astray:\n{}", found.len(), found.join("\n"));
}

/// What led this airframe too far.
fn faults_on(Model { name, profile }: Model) -> Vec<String> {
    let failures = failures();
    let mut found = Vec::new();
    for situation in Situation::ALL {
        for seed in SEEDS {
            let siblings = fly(profile(), situation, seed, &failures).unwrap();
            for (failure, excursion) in failures.iter().zip(&siblings.flown) {
                if failure.shows() && excursion.is_too_far(&siblings.own) {
                    let failure = &failure.name;
                    found.push(format!("{name} {situation} {seed}: {failure}: {excursion:?}"));
                }
            }
        }
    }
    found
}
