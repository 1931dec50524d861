//! How long a flight was.

use ardrone_link::at::Ref;

use super::bench::{Bench, SECOND, START};
use super::*;

#[test]
fn the_time_of_a_flight_ends_with_the_motors_and_a_new_start_counts_anew() {
    let mut bench = Bench::in_the_air("takeoff\nland");
    let time = |bench: &Bench| bench.vehicle.status(bench.now).flight_time;
    bench.accepted(OperatorOrder::Hold);
    bench.run(5 * SECOND);
    let cut_at = bench.now;
    bench.comes_down();
    bench.state |= DroneState::EMERGENCY;
    bench.until(SECOND, |bench| !bench.outcomes.is_empty());
    assert_eq!(bench.outcomes, [Outcome::Emergency]);
    assert_eq!(bench.phase(), Phase::Standby, "nothing is being landed");
    let began = bench.vehicle.report().took_off_at.unwrap();
    let flown = bench.vehicle.report().flight_time().expect("it is told with the outcome");
    let late = (began + flown).checked_sub(cut_at).unwrap();
    assert!(late <= FAULT_TIME + 2 * TICK, "{late:?}");
    bench.run(20 * SECOND);
    assert_eq!((time(&bench), bench.phase()), (Some(flown), Phase::Standby));
    assert!(!bench.events.contains(&FlightEvent::Landed), "{:?}", bench.events);
    // Recovered, it flies again.
    bench.accepted(OperatorOrder::Recover);
    bench.step();
    bench.state = bench.state.difference(DroneState::EMERGENCY);
    bench.run(SECOND);
    assert_eq!(time(&bench), Some(flown), "it was cleared on the ground");
    let mut bench = bench.takes_off();
    assert!(time(&bench).unwrap() < 4 * SECOND, "{:?}", time(&bench));
    let again = time(&bench).unwrap();
    bench.run(SECOND);
    assert!(time(&bench).unwrap() + TICK >= again + SECOND);
}

#[test]
fn a_flight_that_is_called_off_during_its_take_off_has_a_time() {
    let mut bench = Bench::standing_by("takeoff\nland");
    bench.accepted(START);
    bench.until(SECOND, |bench| bench.reference() == Some(Ref::TakeOff));
    assert_eq!(bench.vehicle.status(bench.now).flight_time, None, "it stands");
    bench.rises();
    bench.control_state = ControlState::TakingOff;
    bench.run(SECOND);
    bench.accepted(OperatorOrder::Land);
    bench.run(SECOND);
    bench.comes_down();
    bench.until(5 * SECOND, |bench| !bench.outcomes.is_empty());
    assert_eq!(bench.vehicle.report().steps_done, 0);
    let flown = bench.vehicle.report().flight_time().expect("it was in the air");
    assert!((2 * SECOND..5 * SECOND).contains(&flown), "{flown:?}");
}

#[test]
fn the_time_of_a_flight_goes_on_when_its_plan_takes_off_again() {
    let mut bench = Bench::in_the_air("takeoff\nland\ntakeoff\nland");
    let time = |bench: &Bench| bench.vehicle.status(bench.now).flight_time;
    bench.until(SECOND, |bench| bench.reference() == Some(Ref::Land));
    bench.comes_down();
    bench.until(2 * SECOND, |bench| bench.reference() == Some(Ref::TakeOff));
    let landed = time(&bench);
    bench.run(SECOND);
    assert_eq!(time(&bench), landed, "it stands");
    bench.rises();
    bench.run(2 * SECOND);
    assert!(time(&bench) >= landed.map(|landed| landed + 2 * SECOND), "{:?}", time(&bench));
}
