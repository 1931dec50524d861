//! Phases before a flight: finding the drone, preparing it, taking it over.

use ardrone_link::at::Ref;

use super::super::watch::OURS;
use super::bench::{Bench, SECOND, START};
use super::*;

const PLAN: &str = "takeoff\nland";
const TAKE_OVER: &str = "autoTakeover 500 800 4000 0.5\nland";
const WHEN_READY: OperatorOrder = OperatorOrder::Start { when_ready: true };

fn load(bench: &mut Bench, plan: &str) {
    bench.accepted(OperatorOrder::Load(Plan::parse("plan", plan).unwrap()));
}

/// A vehicle whose drone was in the air from the first packet.
fn in_the_air_already() -> Bench {
    let mut bench = Bench::new();
    bench.rises();
    bench
}

#[test]
fn a_plan_is_flown_from_the_first_packet_to_the_ground() {
    let mut bench = Bench::in_the_air(PLAN);
    assert!(!bench.vehicle.is_at_rest());
    bench.until(SECOND, |bench| bench.reference() == Some(Ref::Land));
    bench.comes_down();
    bench.until(SECOND, |bench| bench.phase() == Phase::Standby);
    assert_eq!(bench.outcomes, [Outcome::Completed]);
    assert_eq!(bench.vehicle.report().steps_done, 2);
    assert!(bench.vehicle.report().flight_time().is_some_and(|time| time > Duration::ZERO));
    assert!(bench.vehicle.is_at_rest());
}

/// An order that comes before the flight has ended, but after its landing, changes nothing of how it ended.
#[test]
fn a_hold_on_the_ground_after_the_plan_is_no_landing_on_order() {
    let mut bench = Bench::in_the_air("takeoff\nland\n");
    bench.run(SECOND);
    bench.comes_down();
    bench.until(SECOND, |bench| bench.vehicle.report().steps_done == 2);
    assert!(bench.outcomes.is_empty(), "it ends in the next tick");
    assert_eq!(bench.order(OperatorOrder::Hold), Err(Refused::OnGround));
    bench.run(SECOND);
    assert_eq!(bench.outcomes, [Outcome::Completed]);
}

#[test]
fn phases_are_named_like_their_variants_except_for_none() {
    for phase in [
        Phase::Connecting,
        Phase::Observing,
        Phase::Configuring,
        Phase::Trimming,
        Phase::Standby,
        Phase::Flying,
        Phase::Landing,
    ] {
        assert_eq!(phase.name(), format!("{phase:?}").to_lowercase());
    }
}

#[test]
fn without_an_order_a_vehicle_waits_for_its_drone_for_ever() {
    let mut bench = Bench::new();
    bench.is_heard = false;
    bench.run(3 * CONNECT_TIMEOUT);
    assert_eq!(bench.phase(), Phase::Connecting);
    bench.is_heard = true;
    bench.obeys = false;
    // An acknowledge bit that never falls keeps every setting waiting.
    bench.state |= DroneState::COMMAND_ACKNOWLEDGE;
    bench.step();
    bench.obeys = true;
    for _ in 0..1100 {
        bench.state |= DroneState::COMMAND_ACKNOWLEDGE;
        bench.step();
    }
    assert_eq!(bench.phase(), Phase::Configuring);
    assert_eq!(bench.outcomes, []);
    assert!(bench.vehicle.is_at_rest());
}

#[test]
fn a_flight_is_refused_once_its_drone_does_not_take_the_settings_in_time() {
    let mut bench = Bench::new();
    load(&mut bench, PLAN);
    bench.accepted(WHEN_READY);
    let began = bench.now;
    while bench.outcomes.is_empty() && bench.now < began + 2 * CONFIGURE_TIMEOUT {
        bench.state |= DroneState::COMMAND_ACKNOWLEDGE;
        bench.step();
    }
    let reasons = vec!["the drone does not take its configuration".to_owned()];
    assert_eq!(bench.outcomes, [Outcome::PreflightRefused { reasons }]);
    assert!(bench.now >= began + CONFIGURE_TIMEOUT);
    assert!(bench.now < began + CONFIGURE_TIMEOUT + SECOND);
}

#[test]
fn the_configuration_that_is_read_back_must_be_the_one_that_was_set() {
    for (altered, expected) in [
        ("", vec![]),
        ("control:altitude_max", vec![NotReady::Settings("control:altitude_max".into())]),
    ] {
        let mut bench = Bench::with(&VehicleConfig::default());
        let is_asked = |bench: &Bench| {
            let ask = ardrone_link::at::Command::Control(
                ardrone_link::at::ControlMode::SendConfiguration,
            );
            bench.commands.contains(&ask)
        };
        bench.until(5 * SECOND, is_asked);
        let mut text = String::new();
        for setting in &bench.vehicle.settings {
            let value = if setting.key() == altered { "1" } else { setting.value() };
            text.extend([setting.key(), " = ", value, "\n"]);
        }
        text.push('\0');
        let handled = bench.vehicle.handle(bench.now, Input::Control(text.as_bytes()));
        assert_eq!(handled, Ok(()));
        bench.run(SECOND);
        assert!(bench.events.contains(&FlightEvent::ConfigurationRead { version: None }));
        assert_eq!((bench.phase(), bench.vehicle.readiness()), (Phase::Standby, &expected[..]));
    }
}

#[test]
fn a_configuration_that_is_never_sent_forbids_the_flight() {
    let mut bench = Bench::with(&VehicleConfig::default());
    bench.run(12 * SECOND);
    assert!(bench.events.contains(&FlightEvent::ConfigurationNotRead));
    assert_eq!(bench.vehicle.readiness(), [NotReady::SettingsNotRead]);
}

#[test]
fn after_flat_trim_the_drone_settles_for_half_a_second() {
    let mut bench = Bench::new();
    bench.until(3 * SECOND, |bench| bench.phase() == Phase::Trimming);
    let since = bench.now;
    assert_eq!(
        bench
            .vehicle
            .handle(since + SETTLE_TIME.saturating_sub(Duration::from_millis(1)), Input::Tick),
        Ok(())
    );
    assert_eq!(bench.phase(), Phase::Trimming);
    assert_eq!(bench.vehicle.handle(since + SETTLE_TIME, Input::Tick), Ok(()));
    assert_eq!(bench.phase(), Phase::Standby);
}

#[test]
fn a_drone_found_in_the_air_is_left_alone_until_it_stands() {
    let mut bench = in_the_air_already();
    for _ in 0..200 {
        bench.step();
        assert_eq!((bench.phase(), bench.commands.len()), (Phase::Observing, 0));
    }
    bench.comes_down();
    bench.until(SECOND, |bench| bench.phase() == Phase::Configuring);
    bench.until(3 * SECOND, |bench| bench.phase() == Phase::Standby);
    assert_eq!(bench.outcomes, []);
}

#[test]
fn a_drone_in_the_air_is_watched_for_a_moment_before_it_is_taken_over() {
    let mut bench = in_the_air_already();
    load(&mut bench, TAKE_OVER);
    bench.accepted(WHEN_READY);
    let began = bench.now;
    bench.until(2 * SECOND, |bench| !bench.commands.is_empty());
    assert!(bench.now >= began + SETTLE_TIME, "{:?}", bench.now);
    assert!(bench.events.contains(&FlightEvent::TakingOver));
    bench.until(3 * SECOND, |bench| bench.phase() == Phase::Flying);
    assert_eq!(bench.outcomes, []);
}

#[test]
fn a_drone_in_the_air_is_not_taken_over_by_a_plan_that_takes_off() {
    let mut bench = in_the_air_already();
    load(&mut bench, PLAN);
    bench.accepted(WHEN_READY);
    bench.run(2 * SECOND);
    let reasons = vec![NotReady::NotLanded.to_string()];
    assert_eq!(bench.outcomes, [Outcome::PreflightRefused { reasons }]);
    assert_eq!((bench.phase(), bench.commands.len()), (Phase::Observing, 0));
}

#[test]
fn a_drone_that_was_taken_over_and_must_not_fly_on_is_landed() {
    let mut bench = in_the_air_already();
    load(&mut bench, TAKE_OVER);
    bench.accepted(WHEN_READY);
    bench.until(2 * SECOND, |bench| bench.events.contains(&FlightEvent::TakingOver));
    bench.battery_percent = 15;
    bench.until(3 * SECOND, |bench| bench.phase() == Phase::Landing);
    bench.until(SECOND, |bench| bench.reference() == Some(Ref::Land));
    assert_eq!(bench.outcomes, [], "not before it is down");
    bench.comes_down();
    bench.run(SECOND);
    let reasons = vec!["battery at 15 %: more than 20 % are needed".to_owned()];
    assert_eq!(bench.outcomes, [Outcome::PreflightRefused { reasons }]);
    assert_eq!(bench.phase(), Phase::Standby);
}

#[test]
fn a_drone_that_rises_while_it_is_prepared_is_flown_by_another() {
    for starts in [false, true] {
        let mut bench = Bench::new();
        load(&mut bench, PLAN);
        if starts {
            bench.accepted(WHEN_READY);
        }
        bench.step();
        assert_eq!(bench.phase(), Phase::Configuring);
        bench.rises();
        bench.run(SECOND);
        assert_eq!((bench.phase(), bench.commands.len()), (Phase::Observing, 0), "{starts}");
        let reasons = vec![NotReady::NotLanded.to_string()];
        let refused = [Outcome::PreflightRefused { reasons }];
        assert_eq!(bench.outcomes, refused[..usize::from(starts)]);
    }
}

#[test]
fn a_drone_that_rises_from_standby_is_flown_by_another_and_left_alone() {
    let mut bench = Bench::standing_by(PLAN);
    bench.run(SECOND);
    assert_eq!(bench.phase(), Phase::Standby);
    bench.rises();
    bench.run(SECOND);
    assert_eq!(bench.events, [FlightEvent::FlownByAnother]);
    assert_eq!((bench.phase(), bench.commands.len()), (Phase::Observing, 0));
    assert_eq!(bench.order(OperatorOrder::Cut), Err(Refused::FlownByAnother));
    assert_eq!(bench.order(OperatorOrder::Hold), Err(Refused::FlownByAnother));
    assert_eq!(bench.order(START), Err(Refused::NotReady(vec![NotReady::NotLanded.to_string()])));
}

/// A take-off that was ordered may lift the drone late.
#[test]
fn a_drone_that_rises_soon_after_its_landing_is_ours_and_is_landed() {
    for (later, is_ours) in [(OURS.saturating_sub(TICK), true), (OURS, false)] {
        let mut bench = Bench::in_the_air(PLAN);
        bench.until(SECOND, |bench| bench.reference() == Some(Ref::Land));
        bench.comes_down();
        bench.until(SECOND, |bench| bench.phase() == Phase::Standby);
        let since = bench.now;
        bench.run(later.saturating_sub(TICK));
        bench.rises();
        bench.now = since + later.saturating_sub(TICK);
        bench.step();
        let expected = if is_ours { Phase::Landing } else { Phase::Observing };
        assert_eq!(bench.phase(), expected, "{later:?}");
        let lands = bench.reference() == Some(Ref::Land);
        assert_eq!(lands, is_ours, "{later:?}");
    }
}

#[test]
fn a_drone_that_restarts_on_the_ground_is_configured_again() {
    let mut bench = Bench::standing_by(PLAN);
    bench.is_heard = false;
    bench.run(SECOND / 2);
    bench.is_heard = true;
    bench.sequence = 0;
    bench.state |= DroneState::NAVDATA_BOOTSTRAP;
    bench.step();
    assert_eq!(bench.phase(), Phase::Configuring);
    bench.state = bench.state.difference(DroneState::NAVDATA_BOOTSTRAP);
    bench.run(3 * SECOND);
    assert_eq!(bench.phase(), Phase::Standby);
}

#[test]
fn a_drone_that_is_lost_on_the_ground_is_looked_for_again() {
    let mut bench = Bench::standing_by(PLAN);
    bench.is_heard = false;
    bench.run(3 * SECOND);
    assert_eq!(bench.phase(), Phase::Connecting);
    assert_eq!(bench.events, [FlightEvent::LinkLost]);
    assert_eq!((bench.outcomes.len(), bench.commands.len()), (0, 0));
    assert_eq!(bench.vehicle.readiness(), [NotReady::NoDrone]);
    bench.is_heard = true;
    bench.run(3 * SECOND);
    assert_eq!(bench.phase(), Phase::Standby);
    let found = bench.events.iter().filter(|event| **event == FlightEvent::Connected);
    assert_eq!(found.count(), 1);
}

#[test]
fn a_refused_flight_leaves_a_drone_on_the_ground_standing_by() {
    let mut bench = Bench::new();
    load(&mut bench, PLAN);
    bench.accepted(WHEN_READY);
    bench.battery_percent = 15;
    bench.until(5 * SECOND, |bench| !bench.outcomes.is_empty());
    let reasons = vec!["battery at 15 %: more than 20 % are needed".to_owned()];
    assert_eq!(bench.outcomes, [Outcome::PreflightRefused { reasons }]);
    assert_eq!((bench.phase(), bench.reference()), (Phase::Standby, Some(Ref::Land)));
}

/// A drone that has lost its pilot sends nothing but its state until it is configured.
#[test]
fn a_drone_is_taken_over_without_flight_data_but_not_over_a_bad_link() {
    for (has_demo, one_in, takes_over) in
        [(true, 1, true), (false, 1, true), (true, 4, true), (true, 10, false)]
    {
        let mut bench = in_the_air_already();
        load(&mut bench, TAKE_OVER);
        bench.accepted(WHEN_READY);
        bench.has_demo = has_demo;
        for tick in 0..25 {
            bench.is_heard = tick % one_in == 0;
            bench.step();
        }
        let taken_over = bench.events.contains(&FlightEvent::TakingOver);
        assert_eq!(taken_over, takes_over, "{has_demo} {one_in}: {:?}", bench.outcomes);
        assert_eq!(bench.outcomes.len(), usize::from(!takes_over));
    }
}

#[test]
fn while_the_drone_settles_a_flight_that_is_about_to_begin_is_the_reason_not_to_start_one() {
    for (starts, reason) in [(false, NotReady::Configuring), (true, NotReady::InFlight)] {
        let mut bench = Bench::new();
        load(&mut bench, PLAN);
        if starts {
            bench.accepted(WHEN_READY);
        }
        bench.step();
        assert_eq!(bench.vehicle.not_ready(bench.now), [NotReady::Configuring]);
        bench.until(3 * SECOND, |bench| bench.phase() == Phase::Trimming);
        assert_eq!(bench.vehicle.not_ready(bench.now), [reason]);
    }
}
