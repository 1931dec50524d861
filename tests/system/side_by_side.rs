//! Several vehicles in one process do not know of each other.

use std::io::{BufRead as _, BufReader};
use std::process::{Command, Stdio};
use std::time::Duration;

use ardrone_pilot::drive::{Driver, Passed, Simulated};
use ardrone_pilot::flight::{Connections, Content, Flight};
use ardrone_pilot::recording::{Header, Log, Recorder, file_name};
use ardrone_pilot::settings::Settings;
use autopilot::outcome::Outcome;
use autopilot::vehicle::{Telemetry, Transmit};
use autopilot::{Vehicle, VehicleConfig};
use mock_drone::firmware::Phase;
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

fn named(name: &str) -> VehicleConfig {
    VehicleConfig { name: name.parse().unwrap(), ..VehicleConfig::default() }
}

#[test]
fn over_udp_two_fly_at_once_into_one_folder() {
    let runtime = crate::udp::runtime();
    let folder = tempfile::tempdir().unwrap();
    let flights = [("one", PLANS[0]), ("two", PLANS[1])].map(|(name, text)| {
        let mock = MockDrone::start(&world(1), Ports::LOOPBACK).unwrap();
        let (address, config) = (crate::udp::address(&mock), named(name));
        let path = folder.path().join(file_name(Duration::ZERO, config.name));
        let header = Header {
            vehicle: config.name,
            settings: Settings::sample().unwrap(),
            ..Header::default()
        };
        let (recorder, recording) = Recorder::start(&path, &header).unwrap();
        let flown = Some(plan(text));
        let flight = Flight::start(
            &runtime,
            flown,
            &config,
            &address,
            Connections { recorder: Some(recorder), ..Connections::default() },
        )
        .unwrap();
        (config.name, flight, recording, mock)
    });
    // Each has its own targets, its drone is where it thinks, and each message says whose it is.
    let targets = flights.map(|(name, flight, recording, mock)| {
        assert_eq!(flight.controls().vehicle(), name);
        let mut errors_m = Vec::new();
        for message in flight.messages() {
            assert_eq!(message.vehicle, name);
            if let Content::Telemetry(_, Telemetry::Waypoint(waypoint), _) = message.content {
                errors_m.push(true_error_m(&waypoint, &mock.truth()));
            }
        }
        let finished = flight.finish().unwrap();
        assert_eq!((finished.vehicle, finished.outcome), (name, Outcome::Completed));
        let log = Log::read(&std::fs::read(recording.finish().unwrap().path).unwrap()).unwrap();
        assert_eq!((log.vehicle, log.complete), (name, true));
        let targets = finished.report.waypoints.into_iter().map(|waypoint| waypoint.target);
        (
            targets.map(|target| [target.x_m.round(), target.y_m.round()]).collect::<Vec<_>>(),
            errors_m,
        )
    });
    assert_eq!(targets[0].0, [[0.0, 1.0]]);
    assert_eq!(targets[1].0, [[-1.0, 0.0], [0.0, 0.0]]);
    assert!(targets[0].1.iter().all(|error_m| *error_m < 0.2), "{targets:?}");
    let mut files: Vec<_> =
        std::fs::read_dir(folder.path()).unwrap().map(|file| file.unwrap().file_name()).collect();
    files.sort();
    assert_eq!(files, ["1970-01-01T00-00-00Z-one.mcap", "1970-01-01T00-00-00Z-two.mcap"]);
}

/// A process of its own: signals are a process's, and would end the flights of other tests.
#[test]
#[ignore = "one_signal_lands_all starts it"]
fn two_fly_until_a_signal() {
    let runtime = crate::udp::runtime();
    let flights = ["one", "two"].map(|name| {
        let mock = MockDrone::start(&world(1), Ports::LOOPBACK).unwrap();
        let flown = Some(plan("takeoff\nsetStayTime 60\ngoto 0 0 0 0\nland\n"));
        let address = crate::udp::address(&mock);
        (
            Flight::start(&runtime, flown, &named(name), &address, Connections::default()).unwrap(),
            mock,
        )
    });
    while flights.iter().any(|(_, mock)| mock.truth().phase != Phase::Flying) {
        std::thread::sleep(Duration::from_millis(20));
    }
    println!("both fly");
    for (flight, mock) in flights {
        let finished = flight.finish().unwrap();
        assert_eq!(finished.outcome, Outcome::Interrupted);
        assert_eq!(mock.truth().phase, Phase::Landed);
    }
}

#[test]
fn one_signal_lands_all() {
    let mut both = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "side_by_side::two_fly_until_a_signal", "--ignored", "--nocapture"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(both.stdout.take().unwrap()).lines().map(Result::unwrap);
    assert!(lines.any(|line| line.ends_with("both fly")));
    let sent = Command::new("kill").args(["-INT", &both.id().to_string()]).status().unwrap();
    assert!(sent.success());
    lines.for_each(drop);
    assert!(both.wait().unwrap().success());
}
