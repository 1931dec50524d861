//! Phases before a flight: finding the drone, preparing it, taking it over.

use ardrone_link::at::Ref;

use super::super::watch::{ON_ITS_WAY, OURS};
use super::bench::{Bench, SECOND, START};
use super::*;
use crate::agent::AgentCommand;

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

#[test]
fn a_phase_is_written_with_the_width_that_is_asked_for() {
    for phase in Phase::ALL {
        assert_eq!(format!("[{phase:>12}]"), format!("[{:>12}]", phase.name()));
    }
}

/// Whoever has not flown it has no old order that could have lifted it.
#[test]
fn a_drone_that_rises_before_its_first_flight_is_flown_by_another_however_soon() {
    for refused in [false, true] {
        let mut bench = Bench::new();
        if refused {
            load(&mut bench, PLAN);
            bench.accepted(WHEN_READY);
            bench.battery_percent = 15;
        }
        bench.until(5 * SECOND, |bench| bench.phase() == Phase::Standby);
        assert_eq!(bench.outcomes.len(), usize::from(refused));
        bench.rises();
        bench.step();
        assert_eq!((bench.phase(), bench.commands.len()), (Phase::Observing, 0), "{refused}");
    }
}

/// For a moment it may fall back under the bit of its state: an order of ours may still be on its way.
#[test]
fn a_drone_that_rose_again_for_a_moment_is_landed_as_long_as_an_order_is_on_its_way() {
    let mut bench = Bench::in_the_air(PLAN);
    bench.until(SECOND, |bench| bench.reference() == Some(Ref::Land));
    bench.comes_down();
    bench.until(SECOND, |bench| bench.phase() == Phase::Standby);
    bench.rises();
    bench.step();
    let since = bench.now;
    assert_eq!(bench.phase(), Phase::Landing);
    assert_eq!(bench.vehicle.decision().unwrap().wanted, AgentCommand::Land, "the agent lands it");
    bench.comes_down();
    bench.until(SECOND, |bench| bench.phase() == Phase::Standby);
    assert_eq!(bench.now.saturating_sub(since), ON_ITS_WAY);
    assert_eq!(bench.outcomes, [Outcome::Completed], "the first outcome is kept");
}

#[test]
fn a_drone_that_is_lost_while_it_is_prepared_or_watched_is_looked_for_again() {
    for phase in [Phase::Observing, Phase::Configuring, Phase::Trimming] {
        let mut bench = Bench::new();
        if phase == Phase::Observing {
            bench.rises();
        }
        bench.until(3 * SECOND, |bench| bench.phase() == phase);
        // Trimming ends without the drone.
        bench.is_heard = false;
        bench.run(3 * SECOND);
        assert_eq!(bench.phase(), Phase::Connecting, "{phase}");
        bench.is_heard = true;
        bench.step();
        let found = if phase == Phase::Observing { phase } else { Phase::Configuring };
        assert_eq!(bench.phase(), found, "{phase}");
    }
}

#[test]
fn while_the_drone_settles_it_may_be_flown_by_another_or_restart() {
    for restarts in [false, true] {
        let mut bench = Bench::new();
        bench.until(3 * SECOND, |bench| bench.phase() == Phase::Trimming);
        if restarts {
            // It settles for no longer than it is silent.
            bench.now += SECOND / 2;
            bench.sequence = 0;
            bench.state |= DroneState::NAVDATA_BOOTSTRAP;
        } else {
            bench.rises();
        }
        bench.step();
        let expected = if restarts { Phase::Configuring } else { Phase::Observing };
        assert_eq!(bench.phase(), expected);
    }
}

/// It may have been set up for somebody else.
#[test]
fn a_drone_that_another_pilot_has_landed_is_given_all_its_settings_again() {
    let mut bench = Bench::standing_by(PLAN);
    let count = bench.vehicle.settings.len();
    bench.rises();
    bench.run(SECOND);
    assert_eq!(bench.phase(), Phase::Observing);
    bench.comes_down();
    let mut keys = std::collections::BTreeSet::new();
    bench.until(5 * SECOND, |bench| {
        for command in &bench.commands {
            if let ardrone_link::at::Command::Config(config) = command {
                keys.insert(config.key().to_owned());
            }
        }
        bench.phase() == Phase::Standby
    });
    assert_eq!(keys.len(), count, "{keys:?}");
}

#[test]
fn a_flight_whose_drone_rises_before_it_is_refused_at_once() {
    for starts in [false, true] {
        let mut bench = Bench::new();
        load(&mut bench, PLAN);
        if starts {
            bench.accepted(WHEN_READY);
        }
        bench.step();
        bench.rises();
        bench.run(2 * TICK);
        assert_eq!((bench.phase(), bench.outcomes.len()), (Phase::Observing, usize::from(starts)));
        let told = bench.events.contains(&FlightEvent::FlownByAnother);
        assert_eq!(told, !starts, "a refusal says it already");
    }
}

/// What it had sent before is no sign of a good link now.
#[test]
fn a_drone_that_another_pilot_took_is_watched_anew_before_it_is_taken_over() {
    for refused in [false, true] {
        let mut bench = Bench::new();
        load(&mut bench, PLAN);
        if refused {
            // An acknowledge bit that never falls keeps every setting waiting.
            bench.obeys = false;
            bench.state |= DroneState::COMMAND_ACKNOWLEDGE;
            bench.accepted(WHEN_READY);
        }
        for _ in 0..100 {
            if refused {
                bench.state |= DroneState::COMMAND_ACKNOWLEDGE;
            }
            bench.step();
        }
        bench.rises();
        bench.step();
        assert_eq!(bench.phase(), Phase::Observing);
        let since = bench.now;
        load(&mut bench, TAKE_OVER);
        bench.accepted(WHEN_READY);
        bench.outcomes.clear();
        for tick in 1..25 {
            bench.is_heard = tick % 10 == 0;
            bench.step();
            let is_over = bench.now >= since + SETTLE_TIME;
            assert_eq!(bench.outcomes.len(), usize::from(is_over), "{refused} {tick}");
        }
        assert!(!bench.events.contains(&FlightEvent::TakingOver));
    }
}

/// Nothing is sent, so there is nothing to land.
#[test]
fn a_landing_is_no_end_of_what_was_never_begun() {
    for rises in [false, true] {
        let mut bench = Bench::new();
        bench.accepted(OperatorOrder::Land);
        if rises {
            bench.rises();
        }
        for _ in 0..10 {
            bench.step();
            bench.accepted(OperatorOrder::Land);
        }
        let expected = if rises { Phase::Observing } else { Phase::Configuring };
        assert_eq!((bench.phase(), bench.outcomes.len()), (expected, 0));
    }
}

#[test]
fn what_is_ordered_before_a_take_over_leaves_the_drone_to_its_pilot() {
    for order in [OperatorOrder::Land, OperatorOrder::Hold, OperatorOrder::Cut] {
        let name = order.name();
        let mut bench = in_the_air_already();
        load(&mut bench, TAKE_OVER);
        bench.accepted(WHEN_READY);
        bench.run(5 * TICK);
        bench.accepted(order);
        bench.run(SECOND);
        let reasons = vec![NotReady::NotLanded.to_string()];
        assert_eq!(bench.outcomes, [Outcome::PreflightRefused { reasons }], "{name}");
        assert_eq!((bench.phase(), bench.commands.len()), (Phase::Observing, 0), "{name}");
        assert!(bench.vehicle.is_at_rest());
    }
}

#[test]
fn a_landing_while_the_drone_is_prepared_lands_it_if_it_is_in_the_air() {
    for takes_over in [false, true] {
        let mut bench = if takes_over { in_the_air_already() } else { Bench::new() };
        load(&mut bench, if takes_over { TAKE_OVER } else { PLAN });
        bench.accepted(WHEN_READY);
        bench.until(2 * SECOND, |bench| bench.phase() == Phase::Configuring);
        bench.accepted(OperatorOrder::Land);
        bench.step();
        if takes_over {
            assert_eq!((bench.phase(), bench.reference()), (Phase::Landing, Some(Ref::Land)));
            assert_eq!(bench.outcomes, []);
            bench.comes_down();
            bench.run(SECOND);
        }
        let outcome = if takes_over { Outcome::Interrupted } else { Outcome::CalledOff };
        assert_eq!(bench.outcomes, [outcome], "{takes_over}");
    }
}

/// The state of a drone that was lost in the air is the last that was heard of it.
#[test]
fn a_start_that_waits_for_a_lost_drone_just_ends() {
    let mut bench = in_the_air_already();
    bench.run(SECOND);
    bench.is_heard = false;
    bench.run(3 * SECOND);
    assert_eq!(bench.phase(), Phase::Connecting);
    load(&mut bench, PLAN);
    bench.accepted(WHEN_READY);
    bench.accepted(OperatorOrder::Land);
    bench.step();
    assert_eq!(
        (bench.phase(), &bench.outcomes[..]),
        (Phase::Connecting, &[Outcome::CalledOff][..])
    );
}

#[test]
fn a_take_over_that_is_refused_says_why_it_lands_unless_the_drone_is_down_already() {
    for is_down in [false, true] {
        let mut bench = in_the_air_already();
        load(&mut bench, TAKE_OVER);
        bench.accepted(WHEN_READY);
        bench.until(2 * SECOND, |bench| bench.events.contains(&FlightEvent::TakingOver));
        bench.battery_percent = 15;
        if is_down {
            bench.comes_down();
        }
        bench.until(3 * SECOND, |bench| {
            bench.phase() == if is_down { Phase::Standby } else { Phase::Landing }
        });
        let reason = LandingReason::TakeOverRefused;
        let ordered = FlightEvent::LandingOrdered(reason);
        assert_eq!(bench.events.contains(&ordered), !is_down);
        assert_eq!(bench.vehicle.status(bench.now).landing, (!is_down).then_some(reason));
        assert_eq!(bench.outcomes.len(), usize::from(is_down));
    }
}

#[test]
fn settings_that_a_drone_has_not_taken_count_until_it_is_configured_again() {
    let mut bench = Bench::standing_by(PLAN);
    bench.vehicle.setting_unconfirmed("control:outdoor");
    bench.run(SECOND);
    assert_eq!(bench.vehicle.readiness(), [NotReady::Settings("control:outdoor".to_owned())]);
    bench.rises();
    bench.run(SECOND);
    bench.comes_down();
    bench.run(4 * SECOND);
    assert_eq!((bench.phase(), bench.vehicle.readiness()), (Phase::Standby, &[][..]));
}

/// Without flight data nobody knows that it stands.
#[test]
fn a_flight_that_is_called_off_while_its_drone_settles_lets_it_settle() {
    let mut bench = Bench::new();
    load(&mut bench, PLAN);
    bench.accepted(WHEN_READY);
    bench.until(3 * SECOND, |bench| bench.phase() == Phase::Trimming);
    bench.has_demo = false;
    bench.step();
    bench.accepted(OperatorOrder::Land);
    assert_eq!(bench.phase(), Phase::Trimming);
    bench.run(SECOND);
    assert_eq!(
        (bench.phase(), bench.outcomes.as_slice()),
        (Phase::Standby, &[Outcome::CalledOff][..])
    );
}
