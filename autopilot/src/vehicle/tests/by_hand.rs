//! What an operator does by hand: sticks, places to fly to, and the course of setpoints.

use ardrone_link::at::Ref;
use kinematics::Sticks;
use nalgebra::{Vector2, Vector3};
use pid::Course;

use super::super::manual::Mode;
use super::bench::{Bench, SECOND, START};
use super::*;
use crate::safety::INSIDE_M;

const STAY: &str = "takeoff\nsetStayTime 60\ngoto 0 0 0 0\nland";

fn velocity(x_m_s: f64, y_m_s: f64) -> OperatorOrder {
    OperatorOrder::Follow(Setpoint {
        horizontal: Horizontal::Velocity { x_m_s, y_m_s },
        vertical: Vertical::Climb(0.0),
        heading: Heading::Keep,
    })
}

fn course(bench: &Bench) -> Course {
    match bench.vehicle.life.manual().mode {
        Mode::Following { course, .. } => course,
        mode => panic!("{mode:?}"),
    }
}

#[test]
fn sticks_beyond_their_ends_steer_nobody() {
    let none = Sticks::default();
    let mut bench = Bench::in_the_air(STAY);
    for stick in [1.001, -1.001, f64::NAN, f64::INFINITY] {
        for sticks in [
            Sticks { roll: stick, ..none },
            Sticks { pitch: stick, ..none },
            Sticks { gaz: stick, ..none },
            Sticks { yaw: stick, ..none },
        ] {
            let refused = Err(Refused::NoSticks);
            assert_eq!(bench.order(OperatorOrder::Steer(sticks)), refused, "{sticks:?}");
        }
    }
    bench.step();
    assert_eq!(bench.vehicle.status(bench.now).manual, None, "the mission goes on");
    bench.accepted(OperatorOrder::Steer(Sticks { roll: 1.0, pitch: -1.0, gaz: -1.0, yaw: 1.0 }));
}

#[test]
fn set_points_begin_where_the_drone_is_held_and_else_with_its_motion() {
    for (order, holds) in
        [(OperatorOrder::Hold, true), (OperatorOrder::GoTo(Place::at(0.0, 3.0)), false)]
    {
        let mut bench = Bench::in_the_air(STAY);
        bench.drifts_m_s = 0.3;
        bench.run(SECOND / 2);
        bench.accepted(order);
        bench.run(10 * TICK);
        let target = bench.vehicle.status(bench.now).target.unwrap();
        bench.accepted(velocity(0.0, 0.0));
        let course = course(&bench);
        let off_m = (course.position_m - Vector2::new(target.x_m, target.y_m)).norm();
        assert_eq!(off_m < 1e-9, holds, "{course:?} {target:?}");
        assert_eq!(course.velocity_m_s.norm() < 0.1, holds, "{course:?}");
    }
}

#[test]
fn a_course_goes_on_from_tick_to_tick_and_anew_from_where_the_drone_has_hovered_by_itself() {
    let mut bench = Bench::in_the_air(STAY);
    bench.accepted(velocity(1.0, 0.0));
    bench.run(10 * TICK);
    let before = course(&bench);
    assert!(before.velocity_m_s.x > 0.3, "{before:?}");
    // The same setpoints, ordered anew.
    bench.accepted(velocity(1.0, 0.0));
    assert_eq!(course(&bench), before);
    bench.vehicle.flight.target = None;
    let position_m = Vector3::new(2.0, 1.0, 0.8);
    bench.vehicle.advance_setpoint(&Prediction { position_m, ..Prediction::default() }, 0.03);
    let anew = course(&bench);
    assert!((anew.position_m - position_m.xy()).norm() < 0.01, "{anew:?}");
}

#[test]
fn a_course_ends_as_far_inside_the_fence_as_a_drone_is_stopped_by_hand() {
    let mut bench = Bench::in_the_air(STAY);
    bench.accepted(velocity(2.0, 0.0));
    bench.step();
    for _ in 0..900 {
        let position_m = course(&bench).position_m.push(0.8);
        bench.vehicle.advance_setpoint(&Prediction { position_m, ..Prediction::default() }, 0.03);
    }
    let end_m = course(&bench).position_m.norm();
    let inside_m = FlightLimits::default().border.furthest_m() - INSIDE_M;
    assert!((inside_m - 0.2..inside_m + 0.05).contains(&end_m), "{end_m}");
}

/// One whose thrust is weak reaches less at full tilt.
#[test]
fn a_course_asks_for_no_more_than_the_airframe_can_do() {
    let mut config = VehicleConfig::default();
    config.estimator.identify = false;
    config.estimator.airframe.thrust_gain = Vector2::new(0.9, 0.5);
    let vehicle = Vehicle::new(&config).unwrap();
    let weakest_m_s2 = 0.5 * vehicle.full_tilt_m_s2();
    let most = vehicle.mission.max_control();
    let expected = config.cascade.motion_limits(weakest_m_s2, 0.0, most, f64::INFINITY);
    let limits = vehicle.course_limits();
    assert!((limits.acceleration_m_s2 - expected.acceleration_m_s2).abs() < 0.01, "{limits:?}");
}

#[test]
fn a_place_that_is_given_again_changes_nothing_and_any_other_one_does() {
    let first = Place { yaw_deg: Some(10.0), ..Place::at(1.0, 1.0) };
    for (second, places) in [
        (first, 1),
        (Place { x_m: Some(1.1), ..first }, 2),
        (Place { height_m: Some(1.2), ..first }, 2),
        (Place { yaw_deg: Some(20.0), ..first }, 2),
    ] {
        for ticks in [0, 1, 5] {
            let mut bench = Bench::in_the_air(STAY);
            bench.accepted(OperatorOrder::GoTo(first));
            bench.run(ticks * TICK);
            bench.accepted(OperatorOrder::GoTo(second));
            bench.run(3 * TICK);
            let set = bench.events.iter().filter(|event| **event == FlightEvent::ManualTargetSet);
            assert_eq!(set.count(), places, "{second:?} after {ticks}");
            let target = bench.vehicle.status(bench.now).target.unwrap();
            assert_eq!((Some(target.x_m), Some(target.yaw_deg)), (second.x_m, second.yaw_deg));
        }
    }
}

/// The agent holds before it is given a place.
#[test]
fn places_that_change_in_every_tick_are_flown_to() {
    let mut bench = Bench::in_the_air(STAY);
    let mut furthest_m: f64 = 0.0;
    for tick in 0..10 {
        bench.accepted(OperatorOrder::GoTo(Place::at(1.0 + f64::from(tick) / 10.0, 0.0)));
        bench.step();
        furthest_m = furthest_m.max(bench.vehicle.status(bench.now).target.unwrap().x_m);
    }
    assert!(furthest_m > 1.5, "{furthest_m}");
}

#[test]
fn a_take_off_whose_mission_is_replaced_on_its_way_is_taken_back_all_the_same() {
    let mut bench = Bench::standing_by(STAY);
    bench.accepted(START);
    bench.until(SECOND, |bench| bench.reference() == Some(Ref::TakeOff));
    bench.accepted(OperatorOrder::Load(Plan::parse("next", STAY).unwrap()));
    bench.accepted(OperatorOrder::Hold);
    bench.step();
    assert_eq!((bench.phase(), bench.reference()), (Phase::Landing, Some(Ref::Land)));
}
