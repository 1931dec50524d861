use nalgebra::Vector2;

use super::descent::*;
use super::*;

pub(super) const FINE: Situation = Situation {
    now: Duration::from_mins(1),
    blind_for: Duration::ZERO,
    emergency: false,
    airborne: true,
    landing: false,
    sticks: Sticks { roll: 0.0, pitch: 0.0, gaz: 0.0, yaw: 0.0 },
    pose: Pose { x_m: 0.0, y_m: 0.0, z_m: 1.0, yaw_deg: 0.0 },
    velocity_m_s: [0.0; 3],
    soon: Motion {
        pose: Pose { x_m: 0.0, y_m: 0.0, z_m: 1.0, yaw_deg: 0.0 },
        velocity_m_s: [0.0; 3],
    },
    wind: Wind::calm(2.0),
    drag_1_s: 0.2,
    tilts_after_s: 0.2,
    tick_s: 0.1,
    climb_lag_s: 0.5,
    climb_m_s: 0.7,
    sink_m_s: 0.7,
};

/// A drone that moves evenly.
fn moving(pose: Pose, velocity_m_s: [f64; 3]) -> Situation {
    Situation { pose, velocity_m_s, soon: Motion { pose, velocity_m_s }, ..FINE }
}

const TARGET: Pose = Pose { x_m: 1.0, ..FINE.pose };
const GO_TO: AgentCommand = AgentCommand::GoTo(TARGET);

fn monitor() -> SafetyMonitor {
    SafetyMonitor::new(FlightLimits::default())
}

#[test]
fn only_what_moves_the_drone_needs_fresh_navdata() {
    let stale = Situation { blind_for: Duration::from_millis(301), ..FINE };
    let just_fresh = Situation { blind_for: STALE, ..FINE };
    for fresh in [&FINE, &just_fresh] {
        assert_eq!(monitor().check(GO_TO, fresh), (GO_TO, None));
    }
    let held = (AgentCommand::Hover, Some(Veto::StaleNavdata));
    assert_eq!(monitor().check(GO_TO, &stale), held);
    assert_eq!(monitor().check(AgentCommand::Sticks, &stale), held);
    let nearly_blind = Situation { blind_for: BLIND, ..FINE };
    assert_eq!(monitor().check(GO_TO, &nearly_blind), held);
    assert_eq!(monitor().check(AgentCommand::Land, &stale), (AgentCommand::Land, None));
}

#[test]
fn nothing_flies_in_an_emergency() {
    let emergency = Situation { emergency: true, ..FINE };
    for command in [AgentCommand::TakeOff, AgentCommand::Hover, GO_TO, AgentCommand::Sticks] {
        let vetoed = (AgentCommand::Standby, Some(Veto::Emergency));
        assert_eq!(monitor().check(command, &emergency), vetoed);
    }
    assert_eq!(monitor().check(AgentCommand::Land, &emergency), (AgentCommand::Land, None));
}

#[test]
fn a_drone_that_lands_is_let_land() {
    let landing = Situation { landing: true, ..FINE };
    for command in [AgentCommand::TakeOff, AgentCommand::Hover, GO_TO, AgentCommand::Sticks] {
        let vetoed = (AgentCommand::Land, Some(Veto::Landing));
        assert_eq!(monitor().check(command, &landing), vetoed);
    }
    let outside = Situation { pose: Pose { x_m: 11.0, ..FINE.pose }, ..FINE };
    let mut monitor = monitor();
    assert_ne!(monitor.check(GO_TO, &outside).0, AgentCommand::Land);
    let command = monitor.check(AgentCommand::Land, &Situation { landing: true, ..outside });
    assert_eq!(command, (AgentCommand::Land, None), "no retreat any more");
}

#[test]
fn a_drone_that_rises_after_its_landing_is_landed_again() {
    let mut monitor = monitor();
    let on_ground = Situation { airborne: false, ..FINE };
    monitor.check(AgentCommand::TakeOff, &on_ground);
    monitor.check(AgentCommand::Standby, &on_ground);
    assert_eq!(monitor.check(AgentCommand::Hover, &on_ground).0, AgentCommand::Hover);
    let lands = (AgentCommand::Land, Some(Veto::Landing));
    assert_eq!(monitor.check(AgentCommand::Hover, &FINE), lands);
    let landed = (AgentCommand::TakeOff, None);
    assert_eq!(monitor.check(AgentCommand::TakeOff, &on_ground), landed);
    assert_eq!(monitor.check(AgentCommand::Hover, &FINE), (AgentCommand::Hover, None));
}

#[test]
fn a_drone_that_is_landed_for_its_safety_is_landed_to_the_end() {
    for bad in [
        Situation { blind_for: Duration::from_secs(5), ..FINE },
        Situation { pose: Pose { x_m: 10.4, ..FINE.pose }, ..FINE },
        Situation { pose: Pose { z_m: 3.4, ..FINE.pose }, ..FINE },
    ] {
        let mut monitor = monitor();
        let veto = monitor.check(AgentCommand::Hover, &bad).1;
        assert!(veto.is_some_and(Veto::lands));
        let low = Situation { pose: Pose { z_m: 0.5, ..FINE.pose }, ..FINE };
        assert_eq!(monitor.check(GO_TO, &low), (AgentCommand::Land, veto), "it came back");
        assert_eq!(monitor.check(GO_TO, &low).1, veto, "for the same reason to the end");
        let landed = Situation { airborne: false, ..FINE };
        assert_eq!(monitor.check(AgentCommand::TakeOff, &landed).0, AgentCommand::TakeOff);
    }
}

#[test]
fn a_drone_outside_the_fence_is_flown_back_and_down() {
    let outside = Situation { pose: Pose { y_m: -10.5, z_m: 2.0, ..FINE.pose }, ..FINE };
    let stale = Situation { blind_for: Duration::from_millis(400), ..outside };
    let blind = Situation { blind_for: Duration::from_millis(1001), ..outside };
    let much_later = Situation { now: outside.now + RETREAT, ..outside };
    let land = AgentCommand::Land;
    assert_eq!(monitor().check(land, &outside), (land, None), "whoever lands, lands");
    for then in [&blind, &much_later] {
        let mut monitor = monitor();
        let (command, veto) = monitor.check(GO_TO, &outside);
        assert_eq!(veto, Some(Veto::OutsideFence));
        let AgentCommand::GoTo(target) = command else { panic!("{command:?}") };
        assert!((target.y_m + 9.5).abs() < 1e-9 && target.z_m < 0.5, "{target:?}");
        // The landing waits for the flight back, but only for a limited time and only with usable
        // navdata.
        assert_eq!(monitor.check(land, &outside).0, command);
        assert_eq!(monitor.check(land, &stale).0, AgentCommand::Hover);
        assert_eq!(monitor.check(land, then).0, land);
        assert_eq!(monitor.check(land, &outside).0, land, "a landing is not taken back");
    }
    let mut monitor = monitor();
    monitor.check(GO_TO, &outside);
    monitor.land_here();
    assert_eq!(monitor.check(land, &outside).0, land, "nor does it wait for the pilot");
}

#[test]
fn the_way_back_leads_to_the_nearest_place_until_the_drone_is_as_far_inside() {
    let at = |x_m, y_m| Situation { pose: Pose { x_m, y_m, z_m: 2.0, ..FINE.pose }, ..FINE };
    let mut monitor = monitor();
    for (here, [x_m, y_m]) in
        [(at(10.5, 0.0), [9.5, 0.0]), (at(0.0, 9.8), [0.0, 9.5]), (at(3.0, 0.0), [0.0, 9.5])]
    {
        let (command, _) = monitor.check(GO_TO, &here);
        let AgentCommand::GoTo(target) = command else { panic!("{command:?}") };
        assert!((target.x_m - x_m).hypot(target.y_m - y_m) < 1e-9, "{target:?}");
    }
}

#[test]
fn a_drone_stops_from_the_larger_of_its_speeds_on_each_axis() {
    let soon = Motion { velocity_m_s: [1.0, -2.0, -0.5], ..FINE.soon };
    let now = Situation { velocity_m_s: [2.0, -1.0, 0.5], soon, ..FINE };
    let [right, forward, up] = now.stops_from().velocity_m_s.map(|m_s| (10.0 * m_s).round());
    assert!(right > 19.0 && forward < -19.0 && up < 0.0, "{right} {forward} {up}");
}

#[test]
fn near_the_floor_the_drone_sinks_slowly() {
    let down = Sticks { gaz: -1.0, ..Sticks::default() };
    let gaz = |height_m| monitor().limit(&down, 1.0, height_m, 0.7).gaz;
    assert!((gaz(2.0) + 1.0).abs() < 1e-9);
    assert!((-0.4..-0.3).contains(&gaz(0.5)), "{}", gaz(0.5));
    assert!((-0.25..-0.2).contains(&gaz(0.3)), "{}", gaz(0.3));
    // Below it the drone rises.
    assert!((gaz(0.3 - 1e-9)).abs() < 1e-6, "{}", gaz(0.3 - 1e-9));
    assert!((gaz(0.1) - 0.2 / 0.7).abs() < 1e-9, "{}", gaz(0.1));
    // However far below, with no more than the sticks may.
    let far_below = |most| monitor().limit(&down, most, -3.0, 0.7).gaz;
    assert!((far_below(1.0) - 1.0).abs() < 1e-9 && (far_below(0.2) - 0.2).abs() < 1e-9);
    let up = Sticks { gaz: 1.0, ..Sticks::default() };
    assert!((monitor().limit(&up, 1.0, 0.1, 0.7).gaz - 1.0).abs() < 1e-9);
}

#[test]
fn a_drone_that_does_not_come_back_is_landed_where_it_is() {
    let lands_after = |speed_m_s: f64| {
        let mut monitor = monitor();
        (0_u32..400).map(|tick| Duration::from_millis(30) * tick).find(|time| {
            let x_m = 10.5 + speed_m_s * time.as_secs_f64();
            let now = Situation { now: FINE.now + *time, pose: Pose { x_m, ..FINE.pose }, ..FINE };
            monitor.check(GO_TO, &now).0 == AgentCommand::Land
        })
    };
    let soon = NO_WAY_BACK + Duration::from_millis(60);
    for blown_m_s in [0.0, 2.0] {
        assert!(lands_after(blown_m_s).is_some_and(|time| time <= soon), "{blown_m_s}");
    }
    assert!(lands_after(-0.1).is_some_and(|time| time >= RETREAT), "slowly, but it comes back");
}

#[test]
fn a_drone_is_not_flown_back_against_a_wind_that_is_stronger_than_it() {
    // The drone leaves the fence at 3 m/s and decelerates by `brakes_m_s2`.
    let lands_after = |wind: [f64; 2], brakes_m_s2: f64| {
        let mut monitor = monitor();
        (0_u32..400).map(|tick| Duration::from_millis(30) * tick).find(|time| {
            let away_m_s = (3.0 - brakes_m_s2 * time.as_secs_f64()).max(0.1);
            let now = Situation {
                now: FINE.now + *time,
                pose: Pose { y_m: -10.5 - away_m_s, ..FINE.pose },
                velocity_m_s: [0.0, -away_m_s, 0.0],
                wind: Wind::steady(wind, 2.0),
                ..FINE
            };
            monitor.check(GO_TO, &now).0 == AgentCommand::Land
        })
    };
    let soon = Some(NO_WAY_BACK);
    for wind in [[0.0, -1.1], [0.0, 1.1], [1.1, 0.0]] {
        assert_eq!(lands_after(wind, 0.0), soon, "{wind:?}");
    }
    let braked_for = Some(Duration::from_secs(2));
    assert!(lands_after([0.0; 2], 1.5) > soon.max(braked_for), "it was a gust, and it brakes");
}

#[test]
fn a_drone_that_is_carried_off_is_flown_down_against_the_wind_and_lands() {
    // Three metres inside the fence, moving backward at 1 m/s in a storm.
    let lands_after = |height_m: f64, sinks_m_s: f64| {
        let mut monitor = monitor();
        let mut downward = 0;
        let lands = (0_u32..400).map(|tick| Duration::from_millis(30) * tick).find(|time| {
            let sunk_m = sinks_m_s * time.as_secs_f64();
            let now = Situation {
                now: FINE.now + *time,
                pose: Pose { y_m: -7.0, z_m: height_m - sunk_m, ..FINE.pose },
                velocity_m_s: [0.0, -1.0, 0.0],
                wind: Wind::steady([0.0, -1.1], 2.0),
                ..FINE
            };
            let (command, veto) = monitor.check(GO_TO, &now);
            if veto == Some(Veto::CarriedOff)
                && let AgentCommand::GoTo(target) = command
            {
                assert!(target.y_m > -5.1 && target.z_m < 0.5, "{target:?}");
                downward += 1;
            }
            command == AgentCommand::Land
        });
        (lands.unwrap_or(Duration::MAX), downward)
    };
    let tick = Duration::from_millis(30);
    assert_eq!(lands_after(0.75, 0.5), (Duration::ZERO, 0), "low already");
    let (time, downward) = lands_after(1.8, 0.5);
    assert!(time <= Duration::from_secs(2) + 2 * tick && downward > 60, "{time:?}");
    let (time, _) = lands_after(1.8, 0.0);
    assert!(time <= Duration::from_millis(2500) + 2 * tick, "it does not sink: {time:?}");
    assert_eq!(time_to_sink(f64::NAN), Duration::ZERO);
    assert_eq!(time_to_sink(f64::INFINITY), Duration::ZERO);
}

#[test]
fn targets_outside_the_fence_are_not_flown_to() {
    let here = FINE.pose;
    for target in
        [Pose { x_m: 8.0, y_m: -7.0, ..here }, Pose { z_m: 3.1, ..here }, Pose { z_m: 0.2, ..here }]
    {
        let (command, veto) = monitor().check(AgentCommand::GoTo(target), &FINE);
        assert_eq!(veto, Some(Veto::TargetOutside));
        let AgentCommand::GoTo(inside) = command else { panic!("{command:?}") };
        assert!(monitor().fence.is_inside(&inside, FlightLimits::TOLERANCE_M), "{inside:?}");
    }
}

#[test]
fn a_held_stick_is_stopped_at_one_place_until_it_leads_inside() {
    let ahead = Sticks { pitch: -1.0, ..Sticks::default() };
    let fast = |y_m: f64, up_m_s: f64, sticks: Sticks| {
        let pose = Pose { y_m, ..FINE.pose };
        Situation { sticks, ..moving(pose, [0.5, 3.0, up_m_s]) }
    };
    let mut monitor = monitor();
    let mut check = |now: &Situation| match monitor.check(AgentCommand::Sticks, now) {
        (AgentCommand::GoTo(stop), Some(Veto::NearFence)) => Some(stop),
        (AgentCommand::Sticks, None) => None,
        other => panic!("{other:?}"),
    };
    let stop = check(&fast(8.0, 0.4, ahead)).unwrap();
    assert!((stop.x_m.hypot(stop.y_m) - 9.5).abs() < 1e-6 && stop.z_m > 1.2, "{stop:?}");
    assert_eq!(check(&fast(8.5, 0.8, ahead)), Some(stop), "it climbs on, and goes along");
    let rests = |sticks| Situation { sticks, ..moving(stop, [0.0; 3]) };
    assert_eq!(check(&rests(ahead)), Some(stop));
    let turned = Pose { yaw_deg: 180.0, ..stop };
    let back = Situation { sticks: ahead, ..moving(turned, [0.0; 3]) };
    assert_eq!(check(&back), None, "it looks back, and flies so");
    for (roll, pitch) in [(1.0, 0.1), (-1.0, 0.0), (0.0, 0.0)] {
        let stop = check(&fast(8.0, 0.4, ahead)).unwrap();
        let along = Sticks { roll, pitch, ..Sticks::default() };
        assert_eq!(check(&fast(8.5, 0.8, along)), Some(stop), "first it stops: {roll} {pitch}");
        assert_eq!(check(&rests(along)), None, "{roll} {pitch}");
    }
    assert!(check(&fast(8.0, 0.4, ahead)).is_some());
    assert_eq!(check(&Situation { airborne: false, ..rests(ahead) }), None);
    assert_eq!(check(&rests(ahead)), None, "the next flight is another");
    // At the ceiling only what leads up is stopped.
    let up = Sticks { gaz: 1.0, ..Sticks::default() };
    let climbs = |z_m: f64, sticks| Situation {
        sticks,
        ..moving(Pose { z_m, ..FINE.pose }, [0.0, 0.0, 0.7])
    };
    let ceiling = check(&climbs(2.9, up)).unwrap();
    assert_eq!(check(&climbs(2.8, up)), Some(ceiling));
    let still = Situation { sticks: ahead, ..moving(ceiling, [0.0; 3]) };
    assert_eq!(check(&still), None);
}

#[test]
fn by_hand_the_drone_may_rest_at_the_floor_and_at_the_ceiling_of_its_fence() {
    let FlightLimits { floor_m, ceiling_m, .. } = FlightLimits::default();
    for (z_m, up_m_s, stays) in [
        (floor_m, 0.0, true),
        (ceiling_m, 0.0, true),
        (floor_m, -0.1, false),
        (floor_m - 0.1, 0.1, true),
        (ceiling_m, 0.1, false),
        (ceiling_m + 0.1, -0.1, true),
        (floor_m - 0.1, 0.0, false),
        (ceiling_m + 0.1, 0.0, false),
    ] {
        let pose = Pose { z_m, ..FINE.pose };
        let now = moving(pose, [0.0, 0.0, up_m_s]);
        let (_, veto) = monitor().check(AgentCommand::Sticks, &now);
        assert_eq!(veto, (!stays).then_some(Veto::NearFence), "{z_m} {up_m_s}");
    }
}

#[test]
fn manual_control_stops_before_the_fence_and_may_fly_back() {
    let near_the_fence = Pose { x_m: 9.0, ..FINE.pose };
    let moving = |x, up| moving(near_the_fence, [x, 0.0, up]);
    let check = |now| monitor().check(AgentCommand::Sticks, &now).1;
    assert_eq!(check(moving(1.0, 0.0)), Some(Veto::NearFence));
    assert_eq!(check(moving(-1.0, 0.0)), None);
    assert_eq!(check(moving(0.4, 0.0)), None);
    assert_eq!(check(moving(0.0, 3.0)), Some(Veto::NearFence));
    // Nearer to the fence than it may rest, the drone may only come away from it.
    let nearer = |x| Situation {
        soon: Motion { pose: Pose { x_m: 9.8, ..FINE.pose }, velocity_m_s: [x, 0.0, 0.0] },
        ..FINE
    };
    assert_eq!(check(nearer(0.0)), Some(Veto::NearFence));
    assert_eq!(check(nearer(-0.1)), None);
}

#[test]
fn only_what_points_away_from_the_centre_is_outward() {
    let behind_right = Situation { pose: Pose { x_m: 6.0, y_m: -8.0, ..FINE.pose }, ..FINE };
    let outward = |now: &Situation, [right, forward]: [f64; 2]| {
        monitor().fence.border.outward(across(&now.pose)).dot(&Vector2::new(right, forward))
    };
    for (direction, outward_m_s) in
        [([1.2, -1.6], 2.0), ([-1.2, 1.6], -2.0), ([1.6, 1.2], 0.0), ([1.0, 0.0], 0.6)]
    {
        let found_m_s = outward(&behind_right, direction);
        assert!((found_m_s - outward_m_s).abs() < 1e-12, "{direction:?}: {found_m_s}");
    }
    assert!(outward(&FINE, [1.0, 1.0]).abs() < 1e-12, "at the centre no direction is outward");
}

/// Above the ceiling but not beyond the radius the drone cannot be carried further out by holding on.
#[test]
fn a_drone_that_is_only_too_high_is_flown_down_in_any_wind() {
    let radius_m = FlightLimits::default().border.furthest_m();
    for x_m in [0.0, radius_m] {
        let mut monitor = monitor();
        let lands = (0_u32..400).map(|tick| Duration::from_millis(30) * tick).find(|time| {
            let now = Situation {
                now: FINE.now + *time,
                pose: Pose { x_m, z_m: 3.5, ..FINE.pose },
                wind: Wind::steady([1.1, 0.0], 2.0),
                ..FINE
            };
            monitor.check(GO_TO, &now).0 == AgentCommand::Land
        });
        let tick = Duration::from_millis(30);
        let at_the_end = |time| time >= RETREAT && time < RETREAT + tick;
        assert!(lands.is_some_and(at_the_end), "{x_m}: {lands:?}");
    }
}

/// A target that moves with the drone leads it away by its own motion.
#[test]
fn a_drone_that_is_only_too_high_is_flown_down_where_it_was_found() {
    let mut monitor = monitor();
    for x_m in [0.2, 0.5, -0.4] {
        let now = Situation { pose: Pose { x_m, z_m: 3.5, ..FINE.pose }, ..FINE };
        let (command, veto) = monitor.check(GO_TO, &now);
        let AgentCommand::GoTo(target) = command else { panic!("{command:?}") };
        assert!((target.x_m - 0.2).abs() < 1e-9, "{target:?}");
        assert_eq!(veto, Some(Veto::OutsideFence));
    }
}

/// Outside the target is the nearest place inside, which the drone's drift along the fence moves.
#[test]
fn a_drone_outside_is_flown_to_the_nearest_place_inside() {
    let radius_m = FlightLimits::default().border.furthest_m();
    let mut monitor = monitor();
    let inside_m = radius_m - INSIDE_M;
    for (x_m, y_m, expected) in [
        (radius_m + 1.0, 0.0, [inside_m, 0.0]),
        (0.0, radius_m + 1.0, [0.0, inside_m]),
        (0.0, inside_m - 0.1, [0.0, inside_m]),
    ] {
        let now = Situation { pose: Pose { x_m, y_m, ..FINE.pose }, ..FINE };
        let (command, _) = monitor.check(GO_TO, &now);
        let AgentCommand::GoTo(Pose { x_m, y_m, .. }) = command else { panic!("{command:?}") };
        let [right_m, forward_m] = expected;
        assert!((x_m - right_m).hypot(y_m - forward_m) < 1e-9, "{x_m} {y_m}");
    }
}

#[test]
fn a_flight_back_ends_with_its_time() {
    let high = Situation { pose: Pose { z_m: 3.5, ..FINE.pose }, ..FINE };
    let at = |time| Situation { now: FINE.now + time, ..high };
    let mut monitor = monitor();
    assert_eq!(monitor.check(GO_TO, &high).1, Some(Veto::OutsideFence));
    let last = RETREAT.saturating_sub(Duration::from_millis(1));
    assert_ne!(monitor.check(GO_TO, &at(last)).0, AgentCommand::Land);
    assert_eq!(monitor.check(GO_TO, &at(RETREAT)).0, AgentCommand::Land);
}

#[test]
fn a_descent_against_the_wind_ends_at_its_height_and_with_its_time() {
    let at = |time, z_m| Situation {
        now: FINE.now + time,
        pose: Pose { y_m: -7.0, z_m, ..FINE.pose },
        velocity_m_s: [0.0, -1.0, 0.0],
        wind: Wind::steady([0.0, -1.1], 2.0),
        ..FINE
    };
    let descends = |time, z_m| {
        let mut monitor = monitor();
        assert_eq!(monitor.check(GO_TO, &at(Duration::ZERO, 1.8)).1, Some(Veto::CarriedOff));
        monitor.check(GO_TO, &at(time, z_m)).0 != AgentCommand::Land
    };
    let millis = Duration::from_millis;
    assert!(descends(millis(100), HIGH_M + 0.01));
    assert!(!descends(millis(100), HIGH_M), "from there it lands by itself");
    let whole = time_to_sink(1.8);
    assert!(descends(whole.saturating_sub(millis(1)), 1.8));
    assert!(!descends(whole, 1.8), "it does not sink");
}

#[test]
fn a_drone_stops_after_its_reaction_and_its_braking() {
    let pose = Pose { x_m: 1.0, y_m: 2.0, ..FINE.pose };
    let soon = Motion { pose, velocity_m_s: [1.2, -0.6, 0.3] };
    let Pose { x_m, y_m, z_m, .. } = stopping_place(&soon);
    for (stops_m, expected_m) in [(x_m, 2.8), (y_m, 1.4), (z_m, 1.225)] {
        assert!((stops_m - expected_m).abs() < 1e-9, "{stops_m} {expected_m}");
    }
}

#[test]
fn only_vetoes_that_land_are_reasons_for_a_landing() {
    use Veto::{
        Blind, CarriedOff, Emergency, Landing, NearFence, OutsideFence, StaleNavdata,
        TargetOutside, WayOutside,
    };
    let land = [Blind, OutsideFence, CarriedOff, Landing];
    assert!(land.into_iter().all(Veto::lands));
    let stay_up = [StaleNavdata, Emergency, TargetOutside, WayOutside, NearFence];
    assert!(!stay_up.into_iter().any(Veto::lands));
    for veto in land.into_iter().chain(stay_up) {
        assert_eq!(veto.name(), format!("{veto:?}"), "a log names the variant");
    }
}

#[test]
fn sticks_are_limited_and_do_not_jump() {
    let mut monitor = monitor();
    let full = Sticks { roll: 1.0, pitch: -3.0, gaz: f64::NAN, yaw: 0.2 };
    let limited = monitor.limit(&full, 0.6, 2.0, 0.7);
    assert_eq!(limited, Sticks { roll: 0.6, pitch: -0.6, gaz: 0.0, yaw: 0.2 });
    let limited = monitor.limit(&Sticks { roll: -1.0, ..full }, 1.0, 2.0, 0.7);
    assert!((limited.roll + 0.4).abs() < 1e-12, "{limited:?}");
    monitor.let_go();
    assert!((monitor.limit(&full, 1.0, 2.0, 0.7).roll - 1.0).abs() < 1e-12);
}

/// Every command in every state, on the ground and in the air, inside and outside: what may follow is what is drawn.
#[test]
fn the_drawing_of_the_monitors_states_is_what_they_are() {
    let name = |monitor: &SafetyMonitor| {
        let text = format!("{:?}", monitor.state);
        text.split([' ', '(']).next().unwrap_or_default().to_owned()
    };
    let outside = Situation { pose: Pose { x_m: 50.0, z_m: 2.0, ..FINE.pose }, ..FINE };
    let blind = Situation { blind_for: Duration::from_secs(9), ..FINE };
    let situations = [
        FINE,
        outside,
        blind,
        Situation { landing: true, ..FINE },
        Situation { airborne: false, ..FINE },
        Situation { emergency: true, ..FINE },
    ];
    let target = AgentCommand::GoTo(FINE.pose);
    let commands = [
        AgentCommand::Standby,
        AgentCommand::TakeOff,
        AgentCommand::Hover,
        AgentCommand::Sticks,
        AgentCommand::Land,
        target,
    ];
    let mut reached = vec![monitor()];
    let mut seen = std::collections::BTreeSet::new();
    for _ in 0..4 {
        for monitor in std::mem::take(&mut reached) {
            for (situation, command) in
                situations.iter().flat_map(|it| commands.iter().map(move |one| (it, one)))
            {
                for lands_here in [false, true] {
                    let mut next = monitor.clone();
                    if lands_here {
                        next.land_here();
                    } else {
                        next.check(*command, situation);
                    }
                    if seen.insert((name(&monitor), name(&next))) {
                        reached.push(next);
                    }
                }
            }
            reached.push(monitor);
        }
    }
    let text = include_str!("../../../ARCHITECTURE.md");
    let drawing = text.split("```").find(|block| block.contains("[*] --> Free")).unwrap();
    let drawn =
        drawing.lines().filter_map(|line| line.trim().split_once(':')?.0.split_once(" --> "));
    let drawn = drawn.map(|(from, to)| (from.to_owned(), to.to_owned()));
    assert_eq!(seen.into_iter().filter(|(from, to)| from != to).collect::<Vec<_>>(), {
        let mut drawn: Vec<_> = drawn.collect();
        drawn.sort();
        drawn
    });
}
