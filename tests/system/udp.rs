//! Flights over real sockets.

use ardrone_link::DroneAddress;
use ardrone_pilot::flight::{Connections, Content, Flight};
use ardrone_pilot::runtime::{Runtime, SecondSignal};
use autopilot::VehicleConfig;
use autopilot::outcome::Outcome;
use autopilot::vehicle::Telemetry;
use mock_drone::firmware::Phase;
use mock_drone::scenario::Scenario;
use mock_drone::server::{MockDrone, Ports};
use mock_drone::{Truth, WorldConfig};
use system_tests::sim::Simulation;
use system_tests::{SQUARE, place_in_navdata_frame, plan, true_error_m};

/// Address of a drone simulated in this process.
pub(crate) fn address(mock: &MockDrone) -> DroneAddress {
    let ports = mock.ports();
    DroneAddress {
        host: ports.host.to_string(),
        at_port: ports.at,
        navdata_port: ports.navdata,
        control_port: ports.control,
    }
}

/// What runs beside the flights.
pub(crate) fn runtime() -> Runtime {
    Runtime::start(SecondSignal::IsPassedOn).unwrap()
}

#[test]
fn a_flight_over_udp_is_the_simulated_one() {
    let simulated = Simulation::default().fly(plan(SQUARE)).unwrap();

    let mock = MockDrone::start(&WorldConfig::default(), Ports::LOOPBACK).unwrap();
    let (runtime, config) = (runtime(), VehicleConfig::default());
    let flight = Flight::start(
        &runtime,
        Some(plan(SQUARE)),
        &config,
        &address(&mock),
        Connections::default(),
    )
    .unwrap();
    let mut truths = Vec::new();
    for message in flight.messages() {
        if let Content::Telemetry(_, Telemetry::Waypoint(waypoint), _) = message.content {
            let truth = mock.truth();
            let error_m = true_error_m(&waypoint, &truth);
            assert!(error_m < 0.2, "{error_m:.2} m");
            truths.push(truth);
        }
    }
    let finished = flight.finish().unwrap();
    assert_eq!(finished.outcome, Outcome::Completed);
    assert_eq!(finished.dropped_messages, 0);
    assert_eq!(truths.len(), simulated.truth_at_waypoints.len());
    for (real, simulated) in truths.iter().zip(&simulated.truth_at_waypoints) {
        let apart = place_in_navdata_frame(real) - place_in_navdata_frame(simulated);
        println!("waypoint: {:.3} m apart", apart.norm());
        assert!(apart.norm() < 0.05, "{:.3} m apart", apart.norm());
    }
}

/// Outcome of a flight over UDP with this scenario, and the true state at its end.
fn ends(scenario: &str) -> (Outcome, Truth) {
    let scenario = Scenario::parse("scenario", scenario).unwrap();
    let world = WorldConfig { scenario, ..WorldConfig::default() };
    let mock = MockDrone::start(&world, Ports::LOOPBACK).unwrap();
    let flown = plan("takeoff\nsetStayTime 5\ngoto 0 0.5 0 0\nland\n");
    let (runtime, config) = (runtime(), VehicleConfig::default());
    let flight =
        Flight::start(&runtime, Some(flown), &config, &address(&mock), Connections::default())
            .unwrap();
    let outcome = flight.finish().unwrap().outcome;
    (outcome, mock.truth())
}

#[test]
fn outages_and_a_restart_end_as_the_documentation_says() {
    let flights = ["+4 outage 1.2", "+4 outage 4", "+4 restart"]
        .map(|scenario| std::thread::spawn(move || ends(scenario)));
    let restarted = Outcome::Failsafe { reason: "the drone has restarted".to_owned() };
    let expected = [Outcome::Completed, Outcome::LinkLost, restarted];
    for (flight, expected) in flights.into_iter().zip(expected) {
        let (outcome, truth) = flight.join().unwrap();
        assert_eq!((outcome, truth.phase), (expected, Phase::Landed));
    }
}
