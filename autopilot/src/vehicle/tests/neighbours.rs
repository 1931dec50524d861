//! Other vehicles in the room, as one vehicle hears them and tells of itself.

use ardrone_link::at::Ref;
use nalgebra::Vector2;

use super::bench::{Bench, SECOND, START};
use super::*;
use crate::separation::{Neighbour, Presence};

const STAY: &str = "takeoff\nsetStayTime 90\ngoto 0 0 0 0\nland";

/// Lets time pass in which another vehicle is heard so far to the right.
fn hears(bench: &mut Bench, x_m: f64, presence: Presence, time: Duration) {
    let end = bench.now + time;
    while bench.now < end {
        let neighbour = Neighbour {
            system: 2,
            at: bench.now,
            place_m: Vector2::new(x_m, 0.0),
            velocity_m_s: Vector2::zeros(),
            uncertainty_m: 0.0,
            separation_m: 1.5,
            presence,
            claim: None,
        };
        assert_eq!(bench.vehicle.handle(bench.now, Input::Neighbour(neighbour)), Ok(()));
        bench.step();
    }
}

fn presence(bench: &Bench) -> Option<Presence> {
    bench.vehicle.as_neighbour(bench.now).map(|told| told.presence)
}

/// A drone is heard before it measures anything.
#[test]
fn it_tells_its_start_from_the_first_moment_on() {
    let mut config = VehicleConfig::default();
    config.starts_at(Some(Start {
        place_m: Vector2::new(4.0, -2.0),
        heading_deg: 90.0,
        ..Start::default()
    }));
    let mut bench = Bench::with(&config);
    let mut told = 0;
    for tick in 0..100 {
        bench.has_demo = tick > 50;
        bench.step();
        let Some(neighbour) = bench.vehicle.as_neighbour(bench.now) else { continue };
        let off_m = (neighbour.place_m - Vector2::new(4.0, -2.0)).norm();
        assert!(off_m < 0.1, "{neighbour:?}");
        told += 1;
    }
    assert!(told > 50, "{told}");
}

#[test]
fn nobody_takes_off_beside_another_one() {
    for presence in [Presence::Stands, Presence::Starts, Presence::Flies] {
        let mut bench = Bench::standing_by(STAY);
        hears(&mut bench, 1.2, presence, SECOND);
        let near = NotReady::PeerNear { system: 2, away_m: 1.2 };
        let refused = Refused::NotReady(vec![near.to_string()]);
        assert_eq!(bench.vehicle.readiness(), [near], "it is told before");
        assert_eq!(bench.order(START), Err(refused));
    }
}

/// Otherwise who loads a plan again and again would let it wait for ever, and lift off when nobody expects it.
#[test]
fn a_take_off_that_waits_for_its_place_does_not_wait_longer_for_another_mission() {
    let mut bench = Bench::in_the_air("takeoff\nland\ntakeoff\nland");
    bench.until(SECOND, |bench| bench.reference() == Some(Ref::Land));
    bench.comes_down();
    let begun = bench.now;
    for _ in 0..5 {
        hears(&mut bench, 1.0, Presence::Stands, 3 * SECOND);
        // It is refused once the flight has ended.
        _ = bench.order(OperatorOrder::Load(Plan::parse("next", "takeoff\nland").unwrap()));
        if !bench.outcomes.is_empty() {
            break;
        }
    }
    let reason = "another vehicle was in the way for too long".to_owned();
    assert_eq!(bench.outcomes, [Outcome::Failsafe { reason }]);
    let waited = bench.now.saturating_sub(begun);
    assert!(waited < 13 * SECOND, "{waited:?}");
    assert!(!bench.commands.is_empty() && bench.vehicle.is_at_rest());
}

#[test]
fn who_takes_off_tells_so_for_a_second_before_and_is_not_delayed_alone() {
    let lifts_after = |is_heard: bool| {
        let mut bench = Bench::standing_by(STAY);
        if is_heard {
            hears(&mut bench, 4.0, Presence::Stands, SECOND);
        }
        assert_eq!(presence(&bench), Some(Presence::Stands));
        bench.accepted(START);
        let ordered = bench.now;
        bench.until(2 * SECOND, |bench| {
            assert_eq!(presence(bench), Some(Presence::Starts));
            bench.phase() == Phase::Flying
        });
        assert_eq!(presence(&bench), Some(Presence::Starts));
        bench.rises();
        bench.run(SECOND / 2);
        assert_eq!(presence(&bench), Some(Presence::Flies));
        bench.now.saturating_sub(ordered)
    };
    assert!(lifts_after(true) >= SECOND + SECOND / 2 && lifts_after(false) < SECOND + SECOND / 5);
}

/// Drones do not answer at the same moment.
#[test]
fn a_flight_that_was_ordered_waits_for_those_that_are_not_heard_yet() {
    let flies_after = |heard: bool| {
        let config = VehicleConfig { peers: vec![2], read_back: false, ..VehicleConfig::default() };
        let mut bench = Bench::with(&config);
        bench.accepted(OperatorOrder::Load(Plan::parse("plan", STAY).unwrap()));
        bench.accepted(OperatorOrder::Start { when_ready: true });
        bench.run(10 * SECOND);
        assert_eq!((bench.phase(), bench.vehicle.outcome()), (Phase::Trimming, None));
        if heard {
            hears(&mut bench, 4.0, Presence::Stands, 2 * SECOND);
        } else {
            bench.run(25 * SECOND);
        }
        (bench.phase(), bench.vehicle.outcome().cloned())
    };
    assert_eq!(flies_after(true), (Phase::Flying, None));
    let refused =
        Outcome::PreflightRefused { reasons: vec![NotReady::PeerSilent { system: 2 }.to_string()] };
    assert_eq!(flies_after(false), (Phase::Standby, Some(refused)), "not for ever");
}

#[test]
fn who_has_cut_its_motors_flies_no_more() {
    let mut bench = Bench::in_the_air(STAY);
    assert_eq!(presence(&bench), Some(Presence::Flies));
    bench.state |= DroneState::EMERGENCY;
    bench.run(SECOND);
    assert_eq!(presence(&bench), Some(Presence::Stands));
}
