use std::time::Duration;

use kinematics::GRAVITY_M_S2;

use super::axis::LEANS_S;
use super::*;

const PERIOD_MS: u64 = 60;

/// When a quantity is found to ignore the sticks, in seconds, within `seconds`.
fn found(
    sticks: Sticks,
    seconds: u64,
    measured: impl Fn(f64) -> Measured,
) -> Option<(f64, Quantity)> {
    let mut orders = Orders::new(Duration::ZERO);
    let mut response = Response::new();
    let limits = DroneLimits::default();
    (0..1000 * seconds / PERIOD_MS).find_map(|i| {
        let now = Duration::from_millis(PERIOD_MS * i);
        orders.push(now, Order::Sticks(sticks));
        let at_s = now.as_secs_f64();
        response.watch(&measured(at_s), &orders, &limits).map(|quantity| (at_s, quantity))
    })
}

/// Whether the velocity is found to be dead, whatever is found besides.
fn finds_a_dead_velocity(measured: impl Fn(f64) -> Measured) -> bool {
    let mut orders = Orders::new(Duration::ZERO);
    orders.push(Duration::ZERO, Order::Sticks(Sticks::default()));
    let mut response = Response::new();
    (0..300).any(|i| {
        let measured = measured((PERIOD_MS * i) as f64 / 1000.0);
        let found = response.watch(&measured, &orders, &DroneLimits::default());
        found == Some(Quantity::Velocity)
    })
}

fn still(at_s: f64) -> Measured {
    Measured {
        at_s,
        altitude_m: 1.0,
        yaw_deg: 0.0,
        velocity_m_s: Vector2::zeros(),
        tilt_rad: Vector2::zeros(),
    }
}

#[test]
fn a_drone_that_is_told_to_move_and_shows_no_motion_is_noticed_within_two_seconds() {
    let none = Sticks::default();
    let cases = [
        (Sticks { gaz: 1.0, ..none }, Quantity::Altitude),
        (Sticks { gaz: -1.0, ..none }, Quantity::Altitude),
        (Sticks { yaw: -0.6, ..none }, Quantity::Heading),
    ];
    for (sticks, quantity) in cases {
        let (at_s, which) = found(sticks, 5, still).unwrap();
        assert_eq!(which, quantity);
        assert!(at_s < 1.8, "{quantity}: {at_s}");
    }
    assert_eq!(found(none, 60, still), None);
}

#[test]
fn a_drift_that_the_sticks_hide_is_noticed() {
    // The controller holds the measured height: the drone sinks as fast as the sensor climbs.
    let sinking = Sticks { gaz: -0.3, ..Sticks::default() };
    let (at_s, which) = found(sinking, 10, still).unwrap();
    assert!(which == Quantity::Altitude && at_s < 6.0, "{at_s}");
}

#[test]
fn the_most_sluggish_airframes_are_not_accused() {
    let up = Sticks { gaz: 1.0, roll: 1.0, yaw: 0.6, ..Sticks::default() };
    let lag = |at_s: f64, lag_s: f64| at_s - lag_s * (1.0 - (-at_s / lag_s).exp());
    let sluggish = |at_s: f64| Measured {
        altitude_m: 1.0 + 0.7 * lag(at_s, 1.25),
        yaw_deg: wrap_deg(0.7 * 60.0 * lag(at_s, 0.5)),
        // Half of gravity's component at full tilt, and the largest drag.
        velocity_m_s: Vector2::new(1.04 / 1.95 * (1.0 - (-1.95 * at_s).exp()), 0.0),
        ..still(at_s)
    };
    assert_eq!(found(up, 20, sluggish), None);
}

#[test]
fn a_drone_that_leans_against_a_rising_wind_is_not_accused() {
    let leaning = Sticks { roll: 0.85, ..Sticks::default() };
    let gently = |at_s: f64| Measured {
        tilt_rad: Vector2::new(0.18 * (at_s / 20.0).min(1.0), 0.0),
        ..still(at_s)
    };
    // A faster rise is a storm, in which the drone lands in any case.
    assert_eq!(found(leaning, 40, gently), None);
}

#[test]
fn a_drone_that_begins_to_lean_and_seems_to_stand_is_noticed_before_its_way_is_forgotten() {
    const DIES_S: f64 = 6.0;
    let flies = swinging(0.6);
    let dies = |rattle_m_s: f64| {
        let flies = &flies;
        move |at_s: f64| match at_s {
            ..DIES_S => flies(at_s),
            _ => Measured {
                tilt_rad: Vector2::new(0.2, 0.0),
                velocity_m_s: Vector2::new(rattle_m_s * (31.0 * at_s).sin(), 0.0),
                ..still(at_s)
            },
        }
    };
    // The flight before it fills the windows of three and eight seconds.
    let (at_s, which) = found(Sticks::default(), 12, dies(0.01)).unwrap();
    assert_eq!(which, Quantity::Velocity);
    assert!((DIES_S + LEANS_S - 0.2..DIES_S + LEANS_S + 0.3).contains(&at_s), "{at_s}");
}

/// The tilt varies by 12 degrees, and the velocity follows with a fraction of gravity's component, plus
/// noise.
fn swinging(thrust: f64) -> impl Fn(f64) -> Measured {
    move |at_s| {
        let (sin, cos) = (2.0 * at_s).sin_cos();
        let tilt_rad = 0.21 * cos;
        let noise_m_s = 0.05 * (97.0 * at_s).sin();
        let velocity_m_s = thrust * GRAVITY_M_S2 * 0.21 * sin / 2.0 + noise_m_s;
        Measured {
            velocity_m_s: Vector2::new(velocity_m_s, noise_m_s),
            tilt_rad: Vector2::new(tilt_rad, 0.0),
            ..still(at_s)
        }
    }
}

/// Two turns in a steady wind, against which the drone leans: its velocity is healthy and hardly changes.
#[test]
fn a_drone_that_turns_in_a_steady_wind_is_not_accused() {
    for (lean_rad, turn_deg_s) in [(0.04, 60.0), (0.1, 60.0), (0.1, 90.0)] {
        let turning = |at_s: f64| {
            let yaw_deg = turn_deg_s * (at_s - 3.0).clamp(0.0, 540.0 / turn_deg_s);
            let wind_rad = Vector2::new(lean_rad, 0.0);
            Measured {
                yaw_deg,
                tilt_rad: kinematics::body_from_world(wind_rad, yaw_deg),
                velocity_m_s: Vector2::new(0.01 * (31.0 * at_s).sin(), 0.01 * (29.0 * at_s).cos()),
                ..still(at_s)
            }
        };
        assert!(!finds_a_dead_velocity(turning), "{lean_rad}");
    }
}

/// A flow that is dead while the drone swings is found although the drone turns.
#[test]
fn a_dead_flow_is_noticed_in_a_turn_too() {
    for share in [0.0, 0.6] {
        let swings = swinging(share);
        let turning = |at_s: f64| {
            let straight = swings(at_s);
            let yaw_deg = 40.0 * at_s;
            let body = |world| kinematics::body_from_world(world, yaw_deg);
            Measured {
                yaw_deg,
                tilt_rad: body(straight.tilt_rad),
                velocity_m_s: body(straight.velocity_m_s),
                ..straight
            }
        };
        assert_eq!(finds_a_dead_velocity(turning), share < 0.1, "{share}");
    }
}

#[test]
fn a_dead_flow_that_rattles_is_noticed_when_the_drone_tilts() {
    let gently = Sticks { roll: 0.5, ..Sticks::default() };
    let (at_s, which) = found(gently, 10, swinging(0.0)).unwrap();
    assert!(which == Quantity::Velocity && at_s < 3.0, "{at_s}");
    for thrust in [0.5, 0.75, 1.03] {
        assert_eq!(found(gently, 60, swinging(thrust)), None, "{thrust}");
    }
}

#[test]
fn a_slow_drift_of_the_altitude_is_noticed() {
    let sinking = Sticks { gaz: -0.15, ..Sticks::default() };
    let (at_s, which) = found(sinking, 20, still).unwrap();
    assert!(which == Quantity::Altitude && at_s < 9.0, "{at_s}");
}

/// The reaction is a climb too fast to be judged as a slow one.
#[test]
fn an_altitude_that_drifts_down_is_noticed_before_the_drone_has_climbed_a_metre() {
    let climbing = Sticks { gaz: 0.37, ..Sticks::default() };
    let (at_s, which) = found(climbing, 10, still).unwrap();
    let climbed_m = 0.37 * DroneLimits::default().climb_m_s * at_s;
    assert!(which == Quantity::Altitude && climbed_m < 1.0, "{at_s} s, {climbed_m} m");
}

#[test]
fn a_heading_that_turns_twice_as_far_is_noticed_before_a_right_angle() {
    let sticks = Sticks { yaw: 0.5, ..Sticks::default() };
    let turning = |gain: f64| {
        found(sticks, 3, move |at_s| Measured {
            yaw_deg: wrap_deg(gain * lagged(50.0, 0.15, at_s)),
            ..still(at_s)
        })
    };
    assert!(
        matches!(turning(2.0), Some((at_s, Quantity::Heading)) if at_s < 0.9),
        "{:?}",
        turning(2.0)
    );
    for published in [0.7, 1.0] {
        assert_eq!(turning(published), None);
    }
}

/// The way of a rate that follows a constant command with a lag.
fn lagged(rate: f64, lag_s: f64, at_s: f64) -> f64 {
    rate * (at_s - lag_s * (1.0 - (-at_s / lag_s).exp()))
}

#[test]
fn what_was_missing_is_forgotten_once_the_drone_moves_by_itself() {
    let up = Order::Sticks(Sticks { gaz: 1.0, roll: 0.5, ..Sticks::default() });
    // Until `sticks_s` the drone follows the sticks, then for a second it does not. The watch begins at `from_s`.
    let found_after = |from_s: f64, sticks_s: f64, measured: &dyn Fn(f64) -> Measured| {
        let (mut orders, mut response) = (Orders::new(Duration::ZERO), Response::new());
        (0..400_u64).find_map(|i| {
            let at_s = 0.06 * i as f64;
            let by_itself = at_s > sticks_s && at_s <= sticks_s + 1.0;
            let order = if by_itself { Order::ByItself } else { up };
            orders.push(Duration::from_millis(60 * i), order);
            let is_watched = at_s > from_s;
            let found = is_watched
                && response.watch(&measured(at_s), &orders, &DroneLimits::default()).is_some();
            found.then_some(at_s)
        })
    };
    let climbing = |at_s: f64| Measured { altitude_m: 1.0 + lagged(0.7, 0.5, at_s), ..still(at_s) };
    let dead_flow = |at_s: f64| Measured {
        velocity_m_s: Vector2::zeros(),
        altitude_m: climbing(at_s).altitude_m,
        ..swinging(0.0)(at_s)
    };
    for measured in [&still as &dyn Fn(f64) -> Measured, &dead_flow] {
        let at_once_s = found_after(-1.0, 100.0, measured).unwrap();
        let sticks_s = at_once_s - 0.1;
        let interrupted_s = found_after(-1.0, sticks_s, measured).unwrap();
        // As by one that has seen nothing of the time before.
        assert_eq!(Some(interrupted_s), found_after(sticks_s, sticks_s, measured), "{at_once_s}");
    }
}

#[test]
fn longer_gaps_are_not_judged() {
    let found = |gap_s: f64| {
        let mut orders = Orders::new(Duration::ZERO);
        orders.push(Duration::ZERO, Order::Sticks(Sticks { gaz: 1.0, ..Sticks::default() }));
        let mut response = Response::new();
        (0..20).find_map(|i| {
            let measured = still(gap_s * f64::from(i));
            response.watch(&measured, &orders, &DroneLimits::default())
        })
    };
    assert_eq!(found(GAP_S - 0.01), Some(Quantity::Altitude));
    assert_eq!(found(GAP_S + 0.01), None);
}

#[test]
fn a_drone_that_stood_may_be_anywhere_when_it_is_next_seen_to_fly() {
    let is_accused = |stands: bool| {
        let (mut orders, mut response) = (Orders::new(Duration::ZERO), Response::new());
        (0..40_u64).any(|i| {
            let now = Duration::from_millis(PERIOD_MS * i);
            orders.push(now, Order::Sticks(Sticks { gaz: 0.05, ..Sticks::default() }));
            let at_s = now.as_secs_f64();
            let height_m = if i < 20 { 0.1 } else { 0.9 };
            let measured = Measured { altitude_m: height_m, ..still(at_s) };
            if stands && i == 19 {
                response.stand();
                return false;
            }
            response.watch(&measured, &orders, &DroneLimits::default()).is_some()
        })
    };
    assert!(is_accused(false) && !is_accused(true));
}
