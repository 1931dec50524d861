//! Several vehicles in one process do not know of each other.

use std::time::Duration;

use ardrone_pilot::drive::{Driver, Passed, Simulated};
use ardrone_pilot::flight::{Flight, Message};
use autopilot::outcome::Outcome;
use autopilot::vehicle::{Telemetry, Transmit};
use autopilot::{Vehicle, VehicleConfig};
use mock_drone::server::{MockDrone, Ports};
use mock_drone::{DroneConfig, WorldConfig};
use system_tests::{plan, true_error_m};

const PLANS: [&str; 2] =
    ["takeoff\ngoto 0 1 0 0\nland\n", "takeoff\ngoto -1 0 0.4 90\ngoto 0 0 0 0\nland\n"];

fn world(seed: u64) -> WorldConfig {
    WorldConfig { drone: DroneConfig { seed, ..DroneConfig::default() }, ..WorldConfig::default() }
}

fn driver(seed: u64, text: &str) -> Driver<Simulated> {
    Driver::new(Vehicle::flying(plan(text), &VehicleConfig::default()).unwrap(), &world(seed))
}

/// What was sent, and how the flight ended.
#[derive(Debug, Default, PartialEq)]
struct Flown {
    sent: Vec<(Duration, Vec<u8>)>,
    outcome: Option<Outcome>,
}

impl Flown {
    fn step(&mut self, driver: &mut Driver<Simulated>) {
        driver.step(|at, passed| match passed {
            Passed::Sent { transmit: Transmit::Command { datagram, .. }, .. } => {
                self.sent.push((at, datagram.to_vec()));
            }
            Passed::Told(Telemetry::Ended(outcome, _)) => self.outcome = Some(outcome),
            _ => {}
        });
        driver.pass();
    }
}

#[test]
fn in_simulated_time_each_flies_as_alone_bit_for_bit() {
    let drivers = || vec![driver(1, PLANS[0]), driver(2, PLANS[1])];
    let fly_alone = |mut driver: Driver<Simulated>| {
        let mut flown = Flown::default();
        while flown.outcome.is_none() {
            flown.step(&mut driver);
        }
        flown
    };
    let alone: Vec<Flown> = drivers().into_iter().map(fly_alone).collect();
    let mut together = vec![Flown::default(), Flown::default()];
    let mut drivers = drivers();
    while together.iter().any(|flown| flown.outcome.is_none()) {
        for (flown, driver) in together.iter_mut().zip(&mut drivers) {
            if flown.outcome.is_none() {
                flown.step(driver);
            }
        }
    }
    assert_eq!(together, alone);
    assert!(together.iter().all(|flown| flown.outcome == Some(Outcome::Completed)));
    assert_ne!(together[0].sent, together[1].sent);
}

#[test]
fn over_udp_two_fly_at_once() {
    let flights = PLANS.map(|text| {
        let mock = MockDrone::start(&world(1), Ports::LOOPBACK).unwrap();
        let address = crate::udp::address(&mock);
        let config = VehicleConfig::default();
        (Flight::start(Some(plan(text)), &config, &address, None).unwrap(), mock)
    });
    // Each has its own targets, and its drone is where it thinks.
    let targets = flights.map(|(flight, mock)| {
        let mut errors_m = Vec::new();
        for message in flight.messages() {
            if let Message::Telemetry(_, Telemetry::Waypoint(waypoint), _) = message {
                errors_m.push(true_error_m(&waypoint, &mock.truth()));
            }
        }
        let finished = flight.finish().unwrap();
        assert_eq!(finished.outcome, Outcome::Completed);
        let targets = finished.report.waypoints.into_iter().map(|waypoint| waypoint.target);
        (
            targets.map(|target| [target.x_m.round(), target.y_m.round()]).collect::<Vec<_>>(),
            errors_m,
        )
    });
    assert_eq!(targets[0].0, [[0.0, 1.0]]);
    assert_eq!(targets[1].0, [[-1.0, 0.0], [0.0, 0.0]]);
    assert!(targets[0].1.iter().all(|error_m| *error_m < 0.2), "{targets:?}");
}
