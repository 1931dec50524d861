//! Landings and what else ends a flight.

use ardrone_link::at::Ref;
use ardrone_link::navdata::Gps;

use super::super::life::{Active, Flying};
use super::super::watch::ON_ITS_WAY;
use super::bench::{Bench, SECOND, START};
use super::*;
use crate::agent::AgentCommand;
use crate::mission::Due;

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
fn a_mission_that_is_replaced_while_it_lands_has_ended_once_the_drone_is_down() {
    for comes_down in [true, false] {
        let mut bench = Bench::in_the_air(PLAN);
        bench.until(SECOND, |bench| bench.reference() == Some(Ref::Land));
        bench.accepted(OperatorOrder::Load(Plan::parse("next", PLAN).unwrap()));
        bench.run(SECOND);
        assert_eq!((bench.phase(), bench.reference()), (Phase::Landing, Some(Ref::Land)));
        assert_eq!(bench.vehicle.status(bench.now).landing, None, "nothing was given up");
        if comes_down {
            bench.comes_down();
        }
        bench.until(2 * LANDING_TIMEOUT, |bench| !bench.outcomes.is_empty());
        let reason = "the drone did not confirm that it has landed".to_owned();
        let outcome = if comes_down { Outcome::Completed } else { Outcome::Failsafe { reason } };
        assert_eq!(bench.outcomes, [outcome]);
    }
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
    assert_eq!(bench.vehicle.report().ended_at, Some(bench.now));
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

fn gps(north_m: f64) -> Gps {
    Gps {
        plugged: 1,
        data_available: 1,
        satellite_count: 7,
        latitude_deg: 48.9 + north_m / 111_320.0,
        longitude_deg: 2.4,
        horizontal_error_m: 3.0,
        ..Gps::default()
    }
}

#[test]
fn a_plan_whose_place_is_contradicted_is_not_called_flown() {
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

/// The place on the ground counts, from which it took off.
#[test]
fn a_gps_that_leaps_during_the_take_off_contradicts() {
    let config = VehicleConfig { read_back: false, gps: true, ..VehicleConfig::default() };
    let mut bench = Bench::with(&config);
    bench.gps = Some(gps(0.0));
    let mut bench = bench.stands_by("takeoff\nsetStayTime 90\ngoto 0 0 0 0\nland");
    bench.accepted(START);
    bench.until(SECOND, |bench| bench.reference() == Some(Ref::TakeOff));
    bench.rises();
    bench.control_state = ControlState::TakingOff;
    bench.gps = Some(gps(60.0));
    bench.run(2 * SECOND);
    bench.control_state = ControlState::Hovering;
    bench.run(7 * SECOND);
    assert_eq!(bench.vehicle.status(bench.now).contradicted_by, Some(CrossCheck::Gps));
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

/// Motors that are cut in the air and come back must not fly on.
#[test]
fn a_drone_that_is_in_the_air_after_its_emergency_is_landed() {
    let mut bench = Bench::in_the_air("takeoff\nsetStayTime 90\ngoto 0 0 0 0\nland");
    bench.run(SECOND);
    bench.state |= DroneState::EMERGENCY;
    bench.run(SECOND);
    assert_eq!(bench.outcomes, [Outcome::Emergency]);
    assert_eq!(bench.phase(), Phase::Landing);
    bench.state = bench.state.difference(DroneState::EMERGENCY);
    bench.run(SECOND);
    assert_eq!((bench.phase(), bench.reference()), (Phase::Landing, Some(Ref::Land)));
    assert_eq!(bench.vehicle.decision().unwrap().wanted, AgentCommand::Land);
}

#[test]
fn an_emergency_on_the_ground_is_no_end_of_a_flight() {
    let mut bench = Bench::standing_by(PLAN);
    bench.state |= DroneState::EMERGENCY;
    bench.run(2 * SECOND);
    assert_eq!((bench.phase(), bench.outcomes.len()), (Phase::Standby, 0));
}

#[test]
fn a_fault_on_the_ground_does_not_take_back_a_take_off() {
    let mut bench = Bench::standing_by(PLAN);
    bench.accepted(START);
    bench.until(SECOND, |bench| bench.reference() == Some(Ref::TakeOff));
    bench.state |= DroneState::TOO_MUCH_WIND;
    bench.run(2 * FAULT_TIME);
    assert_eq!((bench.phase(), bench.reference()), (Phase::Flying, Some(Ref::TakeOff)));
}

/// The bits of a drone that has just restarted do not say what it does.
#[test]
fn a_drone_in_emergency_is_down_only_once_its_flight_data_say_so() {
    let mut bench = Bench::in_the_air(PLAN);
    bench.is_heard = false;
    bench.run(SECOND / 2);
    bench.is_heard = true;
    (bench.sequence, bench.has_demo) = (0, false);
    bench.comes_down();
    bench.state |= DroneState::NAVDATA_BOOTSTRAP | DroneState::EMERGENCY;
    bench.run(2 * SECOND);
    assert_eq!(bench.outcomes, [Outcome::Emergency]);
    assert_eq!(bench.phase(), Phase::Landing);
}

/// What was heard before the order to land says nothing of a take-off that is on its way.
#[test]
fn a_landing_is_over_only_by_what_was_heard_after_it_began() {
    let mut bench = Bench::standing_by(PLAN);
    bench.accepted(START);
    bench.until(SECOND, |bench| bench.reference() == Some(Ref::TakeOff));
    bench.is_heard = false;
    bench.accepted(OperatorOrder::Land);
    bench.run(3 * SECOND / 2);
    assert_eq!((bench.phase(), bench.outcomes.len()), (Phase::Landing, 0));
    bench.rises();
    bench.is_heard = true;
    bench.run(SECOND);
    assert_eq!((bench.phase(), bench.reference()), (Phase::Landing, Some(Ref::Land)));
    bench.comes_down();
    bench.until(SECOND, |bench| !bench.outcomes.is_empty());
    assert_eq!(bench.outcomes, [Outcome::Interrupted]);
}

/// A take-off that was ordered may have lifted it meanwhile.
#[test]
fn a_drone_that_is_lost_on_the_ground_before_it_rose_is_landed_in_silence() {
    let mut bench = Bench::standing_by(PLAN);
    bench.accepted(START);
    bench.until(SECOND, |bench| bench.reference() == Some(Ref::TakeOff));
    bench.is_heard = false;
    bench.until(10 * SECOND, |bench| bench.phase() == Phase::Landing);
    let since = bench.now;
    assert_eq!(bench.vehicle.status(since).landing, Some(LandingReason::LinkLost));
    bench.until(10 * SECOND, |bench| !bench.outcomes.is_empty());
    assert!(bench.now >= since + BLIND_LANDING_TIME);
    assert_eq!(bench.outcomes, [Outcome::LinkLost]);
    assert_eq!(bench.vehicle.report().ended_at, None);
    assert_eq!((bench.phase(), bench.reference()), (Phase::Landing, Some(Ref::Land)));
}

#[test]
fn a_flight_that_the_link_has_ended_is_called_so_even_if_the_drone_is_heard_again() {
    let mut bench = Bench::in_the_air("takeoff\nsetStayTime 90\ngoto 0 0 0 0\nland");
    bench.is_heard = false;
    let ordered = FlightEvent::LandingOrdered(LandingReason::LinkLost);
    bench.until(10 * SECOND, |bench| bench.events.contains(&ordered));
    bench.is_heard = true;
    bench.run(SECOND);
    bench.comes_down();
    bench.until(2 * SECOND, |bench| !bench.outcomes.is_empty());
    assert_eq!(bench.outcomes, [Outcome::LinkLost]);
    assert_eq!(bench.phase(), Phase::Standby);
}

#[test]
fn landings_are_given_up_exactly_after_their_time() {
    let mut bench = Bench::in_the_air(PLAN);
    bench.until(SECOND, |bench| bench.vehicle.status(bench.now).step == Some(1));
    let since = bench.now;
    bench.until(2 * LANDING_TIMEOUT, |bench| bench.phase() == Phase::Landing);
    assert_eq!(bench.now, since + LANDING_TIMEOUT);
    bench.until(2 * LANDING_TIMEOUT, |bench| !bench.outcomes.is_empty());
    assert_eq!(bench.now, since + 2 * LANDING_TIMEOUT);
    // The order that the next tick will be late enough for.
    let mut bench = Bench::in_the_air(PLAN);
    let ticks = BLIND_LANDING_TIME.as_millis().div_ceil(TICK.as_millis());
    let ends = bench.now + TICK * u32::try_from(ticks).unwrap();
    let ordered = ends.saturating_sub(BLIND_LANDING_TIME);
    let land = Input::Order(Operator::TERMINAL, OperatorOrder::Land);
    assert_eq!(bench.vehicle.handle(ordered, land), Ok(()));
    bench.is_heard = false;
    bench.until(10 * SECOND, |bench| !bench.outcomes.is_empty());
    assert_eq!(bench.now, ends);
}

/// Steps that are no landings have the agent's limits.
#[test]
fn a_place_may_be_held_for_longer_than_a_landing_may_last() {
    let mut bench = Bench::in_the_air("takeoff\nsetStayTime 120\ngoto 0 0 0 0\nland");
    bench.run(TAG_LANDING_TIMEOUT + 5 * SECOND);
    assert_eq!((bench.phase(), bench.vehicle.status(bench.now).step), (Phase::Flying, Some(2)));
    bench.until(30 * SECOND, |bench| bench.waypoints.len() == 1);
}

#[test]
fn a_drone_whose_sensor_is_not_believed_holds_before_it_is_landed() {
    let mut bench = Bench::in_the_air("takeoff\nsetStayTime 90\ngoto 0 0 0 0\nland");
    bench.accepted(OperatorOrder::Hold);
    bench.drifts_m_s = 0.5;
    bench.until(10 * SECOND, |bench| bench.vehicle.status(bench.now).trust != Trust::Sound);
    bench.step();
    assert_eq!(bench.phase(), Phase::Flying, "{:?}", bench.events);
    bench.until(10 * SECOND, |bench| bench.phase() == Phase::Landing);
    let Some(LandingReason::Distrust(trust)) = bench.vehicle.status(bench.now).landing else {
        panic!("{:?}", bench.events)
    };
    assert!(matches!(trust, Trust::Implausible(_)), "{trust:?}");
}

#[test]
fn each_danger_that_lands_the_drone_has_its_own_reason() {
    let blind_after = |silence_ms: u64| {
        let mut bench = Bench::in_the_air(PLAN);
        let now = bench.now + Duration::from_millis(silence_ms);
        bench.vehicle.endangered(now, Danger::Blind);
        bench.vehicle.life.landing_reason()
    };
    assert_eq!(blind_after(0), Some(LandingReason::NavdataLate));
    assert_eq!(blind_after(500), Some(LandingReason::NavdataLate));
    assert_eq!(blind_after(501), Some(LandingReason::LinkLost));
    for (danger, reason) in [
        (Danger::Lost, LandingReason::PlaceUncertain),
        (Danger::Wind, LandingReason::Wind),
        (Danger::SetpointsGone, LandingReason::SetpointsGone),
        (Danger::StationGone, LandingReason::StationGone),
        (Danger::BatteryEmpty, LandingReason::Battery { percent: 80 }),
    ] {
        let mut bench = Bench::in_the_air(PLAN);
        bench.vehicle.endangered(bench.now, danger);
        assert_eq!(bench.vehicle.life.landing_reason(), Some(reason));
    }
}

#[test]
fn warnings_are_told_and_land_nobody() {
    let mut bench = Bench::in_the_air(PLAN);
    let silent = FlightEvent::StationSilent;
    for (danger, event) in [
        (Danger::BatteryLow, FlightEvent::BatteryLow { percent: 80 }),
        (Danger::Searching, FlightEvent::SearchingTag),
        (Danger::NoTag, FlightEvent::NoTagFound),
        (Danger::TagLost, FlightEvent::TagLost),
        (Danger::StationSilent, silent.clone()),
    ] {
        bench.vehicle.events.clear();
        bench.vehicle.endangered(bench.now, danger);
        assert_eq!(bench.vehicle.events, [event]);
        assert_eq!(bench.phase(), Phase::Flying);
    }
    // The agent says it in every step; another warning in between does not count.
    for (last, told) in [(Danger::StationSilent, 0), (Danger::BatteryLow, 1)] {
        bench.vehicle.events.clear();
        bench.vehicle.decision.as_mut().unwrap().danger = Some(last);
        bench.vehicle.endangered(bench.now, Danger::StationSilent);
        assert_eq!(bench.vehicle.events.len(), told);
    }
}

#[test]
fn cut_motors_are_told_as_such_and_not_as_a_landing_on_order() {
    let mut bench = Bench::in_the_air(PLAN);
    bench.accepted(OperatorOrder::Cut);
    bench.step();
    assert!(bench.events.contains(&FlightEvent::CutOrdered));
    assert_eq!(bench.vehicle.status(bench.now).landing, None);
}

/// A hovering drone could not show that its altitude follows the sticks again.
#[test]
fn a_drone_whose_altitude_does_not_follow_its_sticks_is_landed_at_once() {
    let mut bench = Bench::in_the_air("takeoff\nsetStayTime 90\ngoto 0 0 0 0\nland");
    bench.accepted(OperatorOrder::GoTo(Place { height_m: Some(2.0), ..Place::default() }));
    let unresponsive = Trust::Unresponsive(Quantity::Altitude);
    bench.until(20 * SECOND, |bench| bench.vehicle.status(bench.now).trust == unresponsive);
    let reason = LandingReason::Distrust(unresponsive);
    assert_eq!(bench.vehicle.status(bench.now).landing, Some(reason));
    assert_eq!((bench.phase(), bench.reference()), (Phase::Landing, Some(Ref::Land)));
}

/// One on a tag may begin with a search. Steps that are no landings have the agent's limits.
#[test]
fn each_landing_of_a_plan_has_its_time_and_nothing_else_has() {
    let orders = [
        (AgentOrder::Land, Some(LANDING_TIMEOUT)),
        (AgentOrder::LandOnTag, Some(TAG_LANDING_TIMEOUT)),
        (AgentOrder::FindTag, None),
        (AgentOrder::TakeOff, None),
    ];
    for (order, limit) in orders {
        let mut vehicle = vehicle(PLAN);
        let active = Active { due: Due { step: 3, order }, since: SECOND, offered: true };
        vehicle.life = Life::Flying(Flying { due: Some(active), ..Flying::default() });
        let ends = SECOND + limit.unwrap_or(10 * TAG_LANDING_TIMEOUT);
        vehicle.watch(ends.saturating_sub(Duration::from_millis(1)));
        assert_eq!(vehicle.life.phase(), Phase::Flying, "{order:?}");
        vehicle.watch(ends);
        let reason = limit.map(|_| LandingReason::StepTimedOut { step: 3 });
        assert_eq!(vehicle.life.landing_reason(), reason, "{order:?}");
    }
}
