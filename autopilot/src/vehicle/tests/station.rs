//! Setpoints that are followed, and a ground station that falls silent.

use kinematics::Sticks;

use super::bench::{Bench, SECOND, START};
use super::*;

/// The drone of these tests stands still, so it is not sent far.
const STAY: &str = "takeoff\nsetStayTime 12\ngoto 0 0 0 0\nsetStayTime 60\ngoto 0 0 0 0\nland";
/// System 255, component 190.
const STATION: Operator = Operator { station: Station::Mavlink, number: 0xffbe, local: false };
const OTHER: Operator = Operator { number: 0xfebe, ..STATION };

fn place(x_m: f64, y_m: f64) -> Setpoint {
    Setpoint {
        horizontal: Horizontal::Place { x_m, y_m },
        vertical: Vertical::Climb(0.0),
        heading: Heading::Keep,
    }
}

fn manual(bench: &Bench) -> Option<ManualControl> {
    bench.vehicle.status(bench.now).manual
}

fn count(bench: &Bench, event: &FlightEvent) -> usize {
    bench.events.iter().filter(|other| *other == event).count()
}

/// Time until an event, in milliseconds.
fn until_event_ms(bench: &mut Bench, since: Duration, event: &FlightEvent) -> u128 {
    bench.until(25 * SECOND, |bench| bench.events.contains(event));
    bench.now.saturating_sub(since).as_millis()
}

/// In the air, with a station that has the controls and was heard just now.
fn with_station(config: &VehicleConfig) -> Bench {
    let mut bench = Bench::in_the_air_with(config, STAY);
    bench.accepted(OperatorOrder::Release);
    from(&mut bench, STATION, OperatorOrder::Take).unwrap();
    bench
}

fn from(bench: &mut Bench, by: Operator, order: OperatorOrder) -> Result<(), Refused> {
    bench.vehicle.order(bench.now, by, order)
}

#[test]
fn setpoints_lead_the_drone_as_long_as_they_come() {
    let mut bench = Bench::in_the_air(STAY);
    let next = OperatorOrder::Setpoint(place(0.1, 0.05));
    assert_eq!(bench.order(next.clone()), Err(Refused::NotFollowing));
    assert!(!bench.vehicle.status(bench.now).mission_waits, "it changes nothing");
    bench.accepted(OperatorOrder::Follow(place(0.1, 0.0)));
    for _ in 0..30 {
        bench.run(4 * TICK);
        bench.accepted(next.clone());
    }
    let status = bench.vehicle.status(bench.now);
    assert_eq!((status.manual, status.mission_waits), (Some(ManualControl::Setpoints), true));
    let target = status.target.unwrap();
    assert!((target.x_m - 0.1).hypot(target.y_m - 0.05) < 0.01, "{target:?}");
    assert_eq!(count(&bench, &FlightEvent::FollowingSetpoints), 1);
    // Another order by hand ends it.
    bench.accepted(OperatorOrder::Hold);
    assert_eq!(bench.order(next), Err(Refused::NotFollowing));
    bench.run(20 * SECOND);
    assert_eq!((bench.phase(), manual(&bench)), (Phase::Flying, Some(ManualControl::Hold)));
    bench.accepted(OperatorOrder::Resume);
    bench.until(20 * SECOND, |bench| bench.vehicle.report().steps_done == 3);
}

/// The agent handles one such goal in a step: one that was left would end what was ordered after it.
#[test]
fn of_several_orders_in_one_tick_the_last_is_flown() {
    let steer = OperatorOrder::Steer(Sticks { roll: 0.3, ..Sticks::default() });
    let follow = OperatorOrder::Follow(place(0.1, 0.0));
    let mut bench = Bench::in_the_air(STAY);
    bench.run(SECOND);
    let of_mission = bench.vehicle.status(bench.now).target;
    for order in [steer.clone(), follow.clone(), OperatorOrder::Resume] {
        bench.accepted(order);
    }
    bench.run(SECOND / 3);
    assert_eq!(bench.vehicle.status(bench.now).target, of_mission);
    bench.until(15 * SECOND, |bench| bench.vehicle.report().steps_done == 3);
    for order in [follow, steer, OperatorOrder::Hold] {
        bench.accepted(order);
    }
    bench.step();
    let held = bench.vehicle.status(bench.now).target.unwrap();
    bench.run(SECOND);
    assert_eq!(bench.vehicle.status(bench.now).target, Some(held));
    assert_eq!(manual(&bench), Some(ManualControl::Hold));
}

#[test]
fn setpoints_need_a_drone_that_flies_and_numbers() {
    let mut bench = Bench::standing_by(STAY);
    assert_eq!(bench.order(OperatorOrder::Follow(place(0.0, 0.0))), Err(Refused::OnGround));
    let mut bench = Bench::in_the_air(STAY);
    for (x_m, y_m) in [(f64::NAN, 0.0), (0.0, f64::INFINITY)] {
        let setpoint = place(x_m, y_m);
        for order in [OperatorOrder::Follow(setpoint), OperatorOrder::Setpoint(setpoint)] {
            assert_eq!(bench.order(order), Err(Refused::NoPlace));
        }
    }
    assert_eq!(manual(&bench), None);
    // However far they are, the fence counts.
    bench.accepted(OperatorOrder::Follow(place(1e300, -1e300)));
    bench.run(10 * TICK);
    let target = bench.vehicle.status(bench.now).target.unwrap();
    assert!(FlightLimits::default().outside_m(&target) < 0.0, "{target:?}");
    bench.accepted(OperatorOrder::Land);
    bench.step();
    assert_eq!(bench.order(OperatorOrder::Follow(place(0.0, 0.0))), Err(Refused::Landing));
}

#[test]
fn setpoints_that_stop_are_held_without_and_then_landed_without() {
    let mut bench = Bench::in_the_air(STAY);
    bench.accepted(OperatorOrder::Follow(place(1.0, 0.0)));
    let since = bench.now;
    let silent_ms = until_event_ms(&mut bench, since, &FlightEvent::SetpointsSilent);
    assert!((500..600).contains(&silent_ms), "{silent_ms}");
    assert_eq!(manual(&bench), Some(ManualControl::Hold));
    // They are there again, but only a new order follows them; meanwhile the drone does not land.
    for _ in 0..15 {
        bench.run(SECOND);
        let next = OperatorOrder::Setpoint(place(1.0, 0.0));
        assert_eq!(bench.order(next), Err(Refused::NotFollowing));
    }
    let since = bench.now;
    let status = bench.vehicle.status(bench.now);
    let target = status.target.unwrap();
    assert!(status.phase == Phase::Flying && target.x_m < 0.5, "{status:?}");
    bench.accepted(OperatorOrder::Follow(place(1.0, 0.0)));
    let gone = FlightEvent::LandingOrdered(LandingReason::SetpointsGone);
    let gone_ms = until_event_ms(&mut bench, since, &gone);
    assert!((10_500..10_600).contains(&gone_ms), "{gone_ms}");
    assert_eq!(count(&bench, &FlightEvent::SetpointsSilent), 2);
    assert_eq!(bench.order(OperatorOrder::Follow(place(0.0, 0.0))), Err(Refused::Landing));
}

#[test]
fn a_silent_station_is_told_of_then_its_mission_paused_and_then_the_drone_landed() {
    let mut bench = with_station(&quick());
    let since = bench.now;
    for (event, expected_ms) in [
        (FlightEvent::StationSilent, 3000),
        (FlightEvent::PausedForStation, 10_000),
        (FlightEvent::LandingOrdered(LandingReason::StationGone), 20_000),
    ] {
        assert_eq!(count(&bench, &event), 0, "{event}");
        let after_ms = until_event_ms(&mut bench, since, &event);
        assert!((expected_ms..expected_ms + 100).contains(&after_ms), "{event}: {after_ms}");
        assert_eq!(count(&bench, &event), 1, "{event}");
    }
    assert_eq!(from(&mut bench, STATION, OperatorOrder::Hold), Err(Refused::Landing));
    bench.run(SECOND);
    assert_eq!(count(&bench, &FlightEvent::StationSilent), 1, "it is told once");
}

/// A vehicle that does not read its configuration back.
fn quick() -> VehicleConfig {
    VehicleConfig { read_back: false, ..VehicleConfig::default() }
}

#[test]
fn the_times_are_those_of_the_configuration() {
    let patience =
        StationPatience { hold_after: 2 * SECOND, land_after: Duration::from_millis(3500) };
    let mut bench = with_station(&VehicleConfig { station: patience, ..quick() });
    let since = bench.now;
    let paused_ms = until_event_ms(&mut bench, since, &FlightEvent::PausedForStation);
    assert!((2000..2100).contains(&paused_ms), "{paused_ms}");
    let gone = FlightEvent::LandingOrdered(LandingReason::StationGone);
    let gone_ms = until_event_ms(&mut bench, since, &gone);
    assert!((3500..3600).contains(&gone_ms), "{gone_ms}");
}

#[test]
fn a_station_that_shows_that_it_is_there_flies_on() {
    let mut bench = with_station(&quick());
    for second in 0..40 {
        bench.run(SECOND);
        if second % 2 == 0 {
            from(&mut bench, STATION, OperatorOrder::Present).unwrap();
        }
    }
    assert_eq!(count(&bench, &FlightEvent::StationSilent), 0);
    assert_eq!(manual(&bench), None);
    // That somebody else is there is no sign of it, and takes no controls.
    let since = bench.now;
    while !bench.events.contains(&FlightEvent::PausedForStation) {
        bench.run(SECOND / 2);
        for by in [OTHER, Operator::TERMINAL] {
            from(&mut bench, by, OperatorOrder::Present).unwrap();
        }
        assert!(bench.now < since + 11 * SECOND, "{:?}", bench.events);
    }
    assert_eq!(bench.vehicle.status(bench.now).controls, Some(STATION));
}

/// Neither is there one without controls, nor one that need not be heard.
#[test]
fn nobody_else_must_be_heard() {
    for by in [
        Operator::TERMINAL,
        Operator::PROGRAM,
        Operator { station: Station::Browser, number: 1, local: false },
    ] {
        let mut bench = with_station(&quick());
        from(&mut bench, STATION, OperatorOrder::Release).unwrap();
        from(&mut bench, by, OperatorOrder::Take).unwrap();
        bench.run(25 * SECOND);
        assert_eq!((bench.phase(), manual(&bench)), (Phase::Flying, None), "{by}");
        from(&mut bench, by, OperatorOrder::Release).unwrap();
        bench.run(25 * SECOND);
        assert_eq!((bench.phase(), manual(&bench)), (Phase::Flying, None), "{by}");
        assert_eq!(count(&bench, &FlightEvent::StationSilent), 0, "{by}");
    }
}

#[test]
fn a_lost_station_resumes_by_an_order_only() {
    for resume in [START, OperatorOrder::Resume] {
        let mut bench = with_station(&quick());
        let since = bench.now;
        until_event_ms(&mut bench, since, &FlightEvent::PausedForStation);
        // It is back, and says nothing.
        for _ in 0..15 {
            from(&mut bench, STATION, OperatorOrder::Present).unwrap();
            bench.run(SECOND);
        }
        let status = bench.vehicle.status(bench.now);
        assert_eq!(
            (status.phase, status.manual, status.mission_waits),
            (Phase::Flying, Some(ManualControl::Hold), true)
        );
        let steps_done = bench.vehicle.report().steps_done;
        from(&mut bench, STATION, resume).unwrap();
        assert!(!bench.vehicle.status(bench.now).mission_waits);
        for _ in 0..14 {
            bench.run(SECOND);
            from(&mut bench, STATION, OperatorOrder::Present).unwrap();
        }
        assert!(bench.vehicle.report().steps_done > steps_done, "the mission goes on");
    }
}

#[test]
fn every_order_shows_that_a_station_is_there() {
    let mut bench = with_station(&quick());
    from(&mut bench, STATION, OperatorOrder::Follow(place(0.0, 0.0))).unwrap();
    for _ in 0..100 {
        bench.run(8 * TICK);
        from(&mut bench, STATION, OperatorOrder::Setpoint(place(0.0, 0.0))).unwrap();
    }
    assert_eq!(manual(&bench), Some(ManualControl::Setpoints));
    assert_eq!(count(&bench, &FlightEvent::StationSilent), 0);
    // Refused ones too.
    from(&mut bench, STATION, OperatorOrder::Hold).unwrap();
    for _ in 0..25 {
        bench.run(SECOND);
        let nowhere = OperatorOrder::Setpoint(place(f64::NAN, 0.0));
        assert_eq!(from(&mut bench, STATION, nowhere), Err(Refused::NoPlace));
    }
    assert_eq!(count(&bench, &FlightEvent::StationSilent), 0);
}

/// `MAVLink` has no login.
#[test]
fn a_mavlink_station_takes_the_controls_from_nobody() {
    const PAGE: Operator = Operator { station: Station::Browser, number: 1, local: false };
    for holder in [Operator::TERMINAL, Operator::PROGRAM, PAGE, OTHER] {
        for by in [STATION, Operator { local: true, ..STATION }] {
            let mut bench = with_station(&quick());
            from(&mut bench, STATION, OperatorOrder::Release).unwrap();
            from(&mut bench, holder, OperatorOrder::Take).unwrap();
            let held = Err(Refused::ControlsHeld(holder));
            assert_eq!(from(&mut bench, by, OperatorOrder::Take), held, "{by}");
            assert_eq!(from(&mut bench, by, OperatorOrder::Hold), Ok(()), "anyone may");
            assert_eq!(bench.vehicle.status(bench.now).controls, Some(holder));
        }
    }
    for by in [Operator::TERMINAL, Operator { local: true, ..PAGE }] {
        let mut bench = with_station(&quick());
        assert_eq!(
            from(&mut bench, PAGE, OperatorOrder::Take),
            Err(Refused::ControlsHeld(STATION))
        );
        assert_eq!(from(&mut bench, by, OperatorOrder::Take), Ok(()), "{by}");
    }
}
