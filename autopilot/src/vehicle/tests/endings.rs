//! Landings and what else ends a flight.

use ardrone_link::at::Ref;
use ardrone_link::navdata::Gps;

use super::super::watch::ON_ITS_WAY;
use super::bench::{Bench, SECOND};
use super::*;

const PLAN: &str = "takeoff\nland";

#[test]
fn a_fault_must_last_before_it_lands_the_drone() {
    let windy = DroneState::TOO_MUCH_WIND;
    let mut bench = Bench::in_the_air("takeoff\ngoto 0 0 0 0\nland");
    bench.accepted(OperatorOrder::Hold);
    let ticks = |time: Duration| time.as_millis() / TICK.as_millis();
    for _ in 0..3 {
        bench.state |= windy;
        bench.run(FAULT_TIME.saturating_sub(TICK));
        bench.state = bench.state.difference(windy);
        bench.step();
    }
    assert_eq!(bench.phase(), Phase::Flying, "it never lasted");
    bench.state |= windy;
    let lasted = (0..20).position(|_| {
        bench.step();
        bench.phase() == Phase::Landing
    });
    assert_eq!(lasted.map(|ticks| ticks as u128), Some(ticks(FAULT_TIME)));
    let reason = LandingReason::DroneFault("the drone reports too much wind");
    assert!(bench.events.contains(&FlightEvent::LandingOrdered(reason)));
}

#[test]
fn a_landing_step_that_never_ends_is_given_up_after_its_time() {
    let mut bench = Bench::in_the_air(PLAN);
    let began = bench.now;
    bench.until(2 * LANDING_TIMEOUT, |bench| bench.phase() == Phase::Landing);
    assert!(bench.now >= began + LANDING_TIMEOUT && bench.now < began + LANDING_TIMEOUT + SECOND);
    let reason = LandingReason::StepTimedOut { step: 1 };
    assert!(bench.events.contains(&FlightEvent::LandingOrdered(reason)));
    bench.until(2 * LANDING_TIMEOUT, |bench| !bench.outcomes.is_empty());
    let reason = "step 2 exceeded its time limit; the drone did not confirm that it has landed";
    assert_eq!(bench.outcomes, [Outcome::Failsafe { reason: reason.to_owned() }]);
    assert_eq!(bench.phase(), Phase::Landing, "it is in the air all the same");
}

#[test]
fn a_landing_is_over_once_the_drone_has_had_time_to_rise() {
    let mut bench = Bench::in_the_air(PLAN);
    bench.accepted(OperatorOrder::Land);
    let began = bench.now;
    bench.comes_down();
    bench.until(SECOND, |bench| !bench.outcomes.is_empty());
    assert_eq!(bench.outcomes, [Outcome::Interrupted]);
    assert!(bench.now >= began + ON_ITS_WAY && bench.now <= began + ON_ITS_WAY + TICK);
    assert_eq!(bench.vehicle.report().landed_at, Some(bench.now));
    let landings =
        bench.events.iter().filter(|event| matches!(event, FlightEvent::LandingOrdered(_)));
    assert_eq!(landings.count(), 1);
    assert_eq!(bench.phase(), Phase::Standby);
}

#[test]
fn an_operators_landing_that_is_not_confirmed_is_left_after_its_time() {
    let mut bench = Bench::in_the_air(PLAN);
    bench.accepted(OperatorOrder::Land);
    let began = bench.now;
    bench.until(2 * LANDING_TIMEOUT, |bench| !bench.outcomes.is_empty());
    assert_eq!(bench.outcomes, [Outcome::LeftLanding]);
    assert!(bench.now >= began + LANDING_TIMEOUT && bench.now < began + LANDING_TIMEOUT + SECOND);
}

#[test]
fn a_landing_in_silence_is_ordered_for_four_seconds_at_least() {
    let mut bench = Bench::in_the_air(PLAN);
    bench.accepted(OperatorOrder::Land);
    let began = bench.now;
    bench.is_heard = false;
    bench.until(10 * SECOND, |bench| !bench.outcomes.is_empty());
    assert_eq!(bench.outcomes, [Outcome::LinkLost]);
    assert!(bench.now >= began + BLIND_LANDING_TIME);
    assert!(bench.now <= began + BLIND_LANDING_TIME + 2 * TICK);
    assert_eq!(bench.reference(), Some(Ref::Land));
    // Heard again, it is landed until it is down.
    bench.is_heard = true;
    bench.run(SECOND);
    assert_eq!((bench.phase(), bench.reference()), (Phase::Landing, Some(Ref::Land)));
    bench.comes_down();
    bench.run(5 * SECOND);
    assert_eq!(bench.phase(), Phase::Standby);
    assert_eq!(bench.outcomes.len(), 1, "the first outcome is kept");
}

#[test]
fn a_drone_that_restarts_in_flight_is_landed_and_configured_again() {
    let mut bench = Bench::in_the_air(PLAN);
    bench.accepted(OperatorOrder::Hold);
    bench.is_heard = false;
    bench.run(SECOND / 2);
    bench.is_heard = true;
    bench.comes_down();
    (bench.sequence, bench.has_demo) = (0, false);
    bench.state |= DroneState::NAVDATA_BOOTSTRAP;
    bench.obeys = false;
    bench.run(2 * SECOND);
    let reason = LandingReason::DroneRestarted;
    assert!(bench.events.contains(&FlightEvent::LandingOrdered(reason)), "{:?}", bench.events);
    assert_eq!(bench.phase(), Phase::Landing, "its state is not known before its flight data");
    assert_eq!(bench.outcomes, []);
    bench.has_demo = true;
    bench.step();
    assert_eq!(bench.phase(), Phase::Configuring);
    let reason = "the drone has restarted".to_owned();
    assert_eq!(bench.outcomes, [Outcome::Failsafe { reason }]);
    bench.state = DroneState::empty();
    bench.obeys = true;
    bench.run(5 * SECOND);
    assert_eq!(bench.phase(), Phase::Standby);
}

#[test]
fn cut_motors_end_the_flight() {
    let mut bench = Bench::in_the_air(PLAN);
    bench.accepted(OperatorOrder::Cut);
    bench.step();
    assert_eq!(bench.reference(), Some(Ref::ToggleEmergency));
    bench.comes_down();
    bench.state |= DroneState::EMERGENCY;
    bench.run(SECOND);
    assert_eq!(bench.outcomes, [Outcome::Emergency]);
    assert_eq!(bench.phase(), Phase::Standby);
    assert_eq!(bench.vehicle.readiness(), [NotReady::Emergency]);
    bench.accepted(OperatorOrder::Recover);
    bench.step();
    assert_eq!(bench.reference(), Some(Ref::ToggleEmergency));
    bench.state = bench.state.difference(DroneState::EMERGENCY);
    bench.run(SECOND);
    assert!(bench.events.contains(&FlightEvent::EmergencyCleared));
    assert_eq!(bench.vehicle.readiness(), []);
}

#[test]
fn a_target_that_is_not_reached_in_time_is_the_operators_or_the_plans() {
    let reason = |manual: bool| {
        let mut bench = Bench::in_the_air("takeoff\ngoto 0 1 0 0\nland");
        bench.until(SECOND, |bench| bench.vehicle.status(bench.now).step == Some(1));
        if manual {
            bench.accepted(OperatorOrder::GoTo(Place::at(0.0, 1.0)));
        }
        bench.vehicle.endangered(bench.now, Danger::NoProgress);
        bench.vehicle.life.landing_reason()
    };
    assert_eq!(reason(true), Some(LandingReason::ManualTargetTimedOut));
    assert_eq!(reason(false), Some(LandingReason::StepTimedOut { step: 1 }));
}

#[test]
fn a_plan_whose_place_is_contradicted_is_not_called_flown() {
    let gps = |north_m: f64| Gps {
        plugged: 1,
        data_available: 1,
        satellite_count: 7,
        latitude_deg: 48.9 + north_m / 111_320.0,
        longitude_deg: 2.4,
        horizontal_error_m: 3.0,
        ..Gps::default()
    };
    let config = VehicleConfig { read_back: false, gps: true, ..VehicleConfig::default() };
    let by = CrossCheck::Gps;
    for (north_m, outcome, status) in
        [(10.0, Outcome::Completed, 0), (60.0, Outcome::Contradicted { by }, 60)]
    {
        let mut bench = Bench::with(&config);
        bench.gps = Some(gps(0.0));
        let mut bench = bench.stands_by(PLAN).takes_off();
        bench.gps = Some(gps(north_m));
        bench.run(7 * SECOND);
        bench.comes_down();
        bench.until(SECOND, |bench| !bench.outcomes.is_empty());
        assert_eq!(bench.outcomes, std::slice::from_ref(&outcome));
        assert_eq!(outcome.exit_status(), status);
        let told = FlightEvent::PlaceContradicted { by };
        let tells = bench.events.iter().filter(|event| **event == told).count();
        assert_eq!(tells, usize::from(status == 60), "once");
    }
}

#[test]
fn a_drone_that_is_held_and_lands_by_itself_has_ended_its_flight() {
    let mut bench = Bench::in_the_air("takeoff\nsetStayTime 90\ngoto 0 0 0 0\nland");
    bench.accepted(OperatorOrder::Hold);
    bench.run(SECOND);
    // A single packet may be damaged.
    bench.comes_down();
    bench.run(2 * TICK);
    bench.rises();
    bench.run(SECOND);
    assert!(bench.outcomes.is_empty(), "{:?}", bench.outcomes);
    bench.comes_down();
    bench.run(2 * SECOND);
    let reason = "the drone lands by itself".to_owned();
    assert_eq!(bench.outcomes, [Outcome::Failsafe { reason }]);
    assert_eq!(bench.phase(), Phase::Standby);
}

/// A few packets can be damaged, or somebody else's: whoever believed them would let go of a drone in the air.
#[test]
fn a_drone_that_says_for_a_moment_that_it_is_down_is_still_landed() {
    for said in ["landed", "emergency"] {
        let mut bench = Bench::in_the_air("takeoff\nland");
        bench.until(SECOND, |bench| bench.reference() == Some(Ref::Land));
        bench.run(SECOND);
        let (state, control_state) = (bench.state, bench.control_state);
        if said == "landed" {
            bench.comes_down();
        } else {
            bench.state = DroneState::EMERGENCY;
        }
        bench.run(8 * TICK);
        (bench.state, bench.control_state) = (state, control_state);
        bench.run(SECOND);
        assert!(bench.outcomes.is_empty(), "{said}: {:?}", bench.outcomes);
        assert_eq!(bench.reference(), Some(Ref::Land), "{said}");
        bench.comes_down();
        bench.until(2 * SECOND, |bench| !bench.outcomes.is_empty());
        assert_eq!(bench.outcomes, [Outcome::Completed], "{said}");
    }
}

/// Without the bit, what it does says that it flies.
#[test]
fn a_drone_that_hovers_is_in_the_air_whatever_its_bit_says() {
    let mut bench = Bench::in_the_air("takeoff\nsetStayTime 90\ngoto 0 0 0 0\nland");
    bench.state = bench.state.difference(DroneState::FLYING);
    bench.run(3 * SECOND);
    assert!(bench.vehicle.status(bench.now).airborne);
    assert!(bench.vehicle.decision().unwrap().percepts.hovering);
    assert!(bench.outcomes.is_empty(), "{:?}", bench.outcomes);
}
