//! Each fault of the mock drone: the flight is completed, or the drone is landed with a reason and does not
//! take off again.

use std::time::Duration;

use ardrone_link::WAKE_UP;
use ardrone_link::at::Config;
use ardrone_link::session::{Input, Order, Output, Session, SessionConfig, Transmit};
use autopilot::outcome::Outcome;
use autopilot::vehicle::{FlightEvent, LandingReason};
use mock_drone::firmware::Phase;
use mock_drone::scenario::Scenario;
use mock_drone::{Message, World, WorldConfig};
use system_tests::SQUARE;
use system_tests::sim::{SimulatedFlight, Simulation};

use crate::simulated::fly;

/// Flies the square with this scenario, with several seeds.
fn flights(scenario: &str) -> Vec<SimulatedFlight> {
    let scenario = Scenario::parse("scenario", scenario).unwrap();
    (1..=10)
        .map(|seed| {
            let mut world = WorldConfig { scenario: scenario.clone(), ..WorldConfig::default() };
            world.drone.seed = seed;
            let flight = fly(&Simulation { world, ..Simulation::default() }, SQUARE);
            assert_eq!(
                flight.final_truth.phase,
                Phase::Landed,
                "seed {seed}: {:?}",
                flight.outcome
            );
            assert!(flight.final_truth.position_m.z.abs() < 1e-9);
            flight
        })
        .collect()
}

/// Faults that do not end a flight.
fn completes(scenario: &str) {
    completes_within(scenario, 0.8);
}

/// Faults that do not end a flight, with the largest distance from the start at the end.
fn completes_within(scenario: &str, distance_m: f64) {
    for flight in flights(scenario) {
        assert_eq!(flight.outcome, Outcome::Completed, "{scenario}");
        let last = flight.final_truth.position_m;
        assert!(last.x.hypot(last.y) < distance_m, "{scenario}: {last}");
    }
}

/// Faults that end a flight.
fn lands(scenario: &str, because: LandingReason) {
    for flight in flights(scenario) {
        let ordered = FlightEvent::LandingOrdered(because);
        let landed = flight.events.iter().any(|(_, event)| *event == ordered);
        assert!(landed, "{scenario}: {:?} {:?}", flight.outcome, flight.events);
    }
}

#[test]
fn lost_datagrams_are_survived() {
    completes("0 loss 10");
    completes("0 loss 30");
}

#[test]
fn late_and_overtaking_datagrams_are_survived() {
    completes("0 delay 20 jitter 20");
    completes("0 delay 10 jitter 80\n0 loss 30");
    completes("0 delay 50\n0 loss 10");
    completes("0 reorder 20");
}

#[test]
fn doubled_and_spoiled_datagrams_are_survived() {
    completes("0 duplicate 20");
    completes("0 corrupt 2");
    completes("0 corrupt 10\n0 duplicate 10\n0 reorder 5\n0 loss 5\n0 delay 15 jitter 10");
}

#[test]
fn a_short_outage_is_survived() {
    completes("+4 outage 1.2");
}

#[test]
fn a_long_outage_lands_as_soon_as_the_drone_is_heard_again() {
    for flight in flights("+4 outage 3") {
        assert_eq!(flight.outcome, Outcome::LinkLost);
    }
}

/// A session with a simulated drone, without a vehicle.
#[test]
fn navdata_are_back_within_a_second_of_the_links_return() {
    for (text, back) in [("3 outage 1", 4), ("3 outage 3", 6), ("3 outage 9", 12), ("3 restart", 4)]
    {
        for seed in 1..=5 {
            let scenario = Scenario::parse("scenario", text).unwrap();
            let mut config = WorldConfig { scenario, ..WorldConfig::default() };
            config.drone.seed = seed;
            let mut world = World::new(&config);
            let settings = vec![Config::new("general:navdata_demo", "TRUE").unwrap()];
            let mut session = Session::new(SessionConfig { settings, ..SessionConfig::default() });
            let mut heard = Duration::ZERO;
            for step in 0_u32..3000 {
                let now = Duration::from_millis(5) * step;
                world.advance(now);
                while let Some(message) = world.receive(now) {
                    if let Message::Navdata(packet) = message {
                        session.handle(now, Input::Navdata(&packet));
                        let received = session.poll();
                        let new = matches!(received, Some(Output::Navdata(n)) if n.demo.is_some());
                        if new && heard < Duration::from_secs(back) {
                            heard = now;
                        }
                    }
                }
                if step % 6 == 0 {
                    session.handle(now, Input::Tick(Order::LAND));
                }
                while let Some(transmit) = session.poll_transmit() {
                    match transmit {
                        Transmit::Command(datagram) => world.send_at(now, datagram),
                        Transmit::WakeUp => world.send_wake_up(now, &WAKE_UP),
                    }
                }
            }
            let late = heard.checked_sub(Duration::from_secs(back));
            assert!(late.is_some_and(|late| late <= Duration::from_secs(1)), "{text}: {late:?}");
        }
    }
}

#[test]
fn a_restart_in_flight_is_noticed_and_the_drone_never_takes_off_again() {
    lands("+5 restart", LandingReason::DroneRestarted);
}

#[test]
fn gusts_are_flown_through() {
    // The wind carries the drone along while it lands.
    completes_within("0 wind 1 0.5 gusts 0.4", 2.0);
}

/// Sensors that are frozen or wrong for a moment are not noticed, or only cause a wait.
#[test]
fn frozen_and_lying_sensors_are_survived_for_a_moment() {
    completes("+4 freeze 0.5");
    completes("+4 lie altitude 0.1 for 2");
    completes("+4 lie velocity 0.1 0 for 2");
    completes("+4 lie yaw 10 for 1");
}
