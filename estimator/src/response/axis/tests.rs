//! Whether the velocity follows the tilt.

use super::*;

const FULL_RAD: f64 = 0.2;

fn assert_near(value: f64, expected: f64) {
    assert!((value - expected).abs() < 1e-9, "{value} is not {expected}");
}

#[test]
fn what_is_remembered_turns_with_the_body() {
    let (mut right, mut forward) = (axis([(0.0, 0.1, 1.0, 2.0)]), axis([(0.0, 0.2, 3.0, 4.0)]));
    (right.least_m_s, forward.least_m_s) = ([5.0; 2], [6.0; 2]);
    (right.expected_m_s, forward.expected_m_s) = ([9.0; 2], [10.0; 2]);
    (right.measured_m_s, forward.measured_m_s) = (7.0, 8.0);
    // A quarter to the right: what was forward is to the left now, and what was to the right is ahead.
    Axis::turn(&mut right, &mut forward, 90.0);
    for (axis, [tilt_rad, expected_m_s, measured_m_s], now_m_s) in [
        (&right, [-0.2, -3.0, -4.0], [-6.0, -8.0, -10.0]),
        (&forward, [0.1, 1.0, 2.0], [5.0, 7.0, 9.0]),
    ] {
        let moment = axis.recent[0];
        assert_near(moment.tilt_rad, tilt_rad);
        assert_near(moment.measured_m_s, measured_m_s);
        assert_near(axis.measured_m_s, now_m_s[1]);
        for drag in 0..2 {
            assert_near(moment.expected_m_s[drag], expected_m_s);
            assert_near(axis.least_m_s[drag], now_m_s[0]);
            assert_near(axis.expected_m_s[drag], now_m_s[2]);
        }
    }
}

#[test]
fn the_weakest_airframe_accelerates_by_its_tilt_and_is_slowed_by_drag() {
    let mut axis = Axis::new();
    // By the mean of the tilts before and after.
    axis.tilt_rad = 0.1;
    let pull_m_s2 = LEAST_THRUST * GRAVITY_M_S2 * 0.2_f64.tan();
    axis.watch(0.0, 0.2, 1.0, 0.3, FULL_RAD);
    let share = 1.0 - (-1_f64).exp();
    assert_near(axis.measured_m_s, share);
    for drag in 0..2 {
        assert_near(axis.least_m_s[drag], pull_m_s2 * 0.2);
        assert_near(axis.expected_m_s[drag], share * pull_m_s2 * 0.2);
    }
    axis.watch(0.2, 0.2, -1.0, -0.7, FULL_RAD);
    let before_m_s = pull_m_s2 * 0.2;
    for (drag, drag_1_s) in [0.45, 1.95].into_iter().enumerate() {
        let slower_m_s = (pull_m_s2 + drag_1_s * before_m_s) * 0.2;
        assert_near(axis.least_m_s[drag], before_m_s - slower_m_s);
    }
    assert_near(axis.measured_m_s, share + (-1.0 - share) * share);
}

#[test]
fn moments_are_kept_at_intervals_within_a_window() {
    let mut axis = Axis::new();
    for (at_s, kept) in [(0.0, 1), (0.049, 1), (0.05, 2), (0.099, 2), (0.101, 3)] {
        axis.watch(at_s, 0.01, 0.0, 0.0, FULL_RAD);
        assert_eq!(axis.recent.len(), kept, "{at_s}");
    }
    for i in 1..1000 {
        axis.watch(f64::from(i), 1.0, 0.0, 0.0, FULL_RAD);
    }
    assert_eq!(axis.recent.len(), AXIS_MEMORY);
    let times: Vec<f64> = axis.within(999.0, 2.0).map(|moment| moment.at_s).collect();
    assert_eq!(times, [997.0, 998.0, 999.0]);
}

/// An axis with these moments: time, tilt, velocity of the weakest airframe and measured velocity.
fn axis(moments: impl IntoIterator<Item = (f64, f64, f64, f64)>) -> Axis {
    let moment = |(at_s, tilt_rad, expected_m_s, measured_m_s)| Moment {
        at_s,
        tilt_rad,
        expected_m_s: [expected_m_s; 2],
        measured_m_s,
    };
    Axis { recent: moments.into_iter().map(moment).collect(), ..Axis::new() }
}

#[test]
fn a_flow_that_shows_less_than_a_share_of_the_swings_is_dead() {
    // A window of moments at which both velocities swing by these.
    let swings = |from_s: f64, to_s: f64, least_m_s: f64, measured_m_s: f64| {
        let moments = (0..32).map(|i| {
            let at_s = from_s + (to_s - from_s) * f64::from(i) / 31.0;
            let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
            (at_s, 0.0, sign * least_m_s, sign * measured_m_s)
        });
        axis(moments).misses_swings(to_s)
    };
    assert!(swings(0.0, 3.0, AXIS_DEVIATION_M_S + 1e-3, 0.0));
    assert!(!swings(0.0, 3.0, AXIS_DEVIATION_M_S - 1e-3, 0.0));
    assert!(swings(0.0, 3.0, 0.125, AXIS_SHARE * 0.125 - 1e-3));
    assert!(!swings(0.0, 3.0, 0.125, AXIS_SHARE * 0.125));
    // Slow ones need the window of eight seconds: half of the time this way, half that.
    let slow = |seconds: f64| {
        let moments = (0..64).map(|i| {
            let at_s = seconds * f64::from(i) / 63.0;
            (at_s, 0.0, if i < 32 { 0.1 } else { -0.1 }, 0.0)
        });
        axis(moments).misses_swings(seconds)
    };
    assert!(slow(7.5) && !slow(20.0));
}

/// A drone that brakes to a standstill, seen from when it still tilts.
#[test]
fn a_standstill_that_any_drag_explains_is_no_dead_flow() {
    let braked = |measured_m_s: &dyn Fn(f64) -> f64| {
        let mut axis = Axis::new();
        (0..120).any(|i| {
            let at_s = 0.05 * f64::from(i);
            let tilt_rad = match at_s {
                ..1.0 => 0.2,
                ..2.1 => -0.2,
                _ => 0.0,
            };
            axis.watch(at_s, 0.05, measured_m_s(at_s), tilt_rad, FULL_RAD);
            at_s > 4.9 && axis.is_dead()
        })
    };
    // With little drag it is at rest when the tilt ends, and with much it would fly back.
    assert!(!braked(&|at_s| if at_s < 2.1 { 0.8 - (at_s - 1.0).abs() * 0.8 } else { 0.0 }));
}

#[test]
fn a_drone_that_begins_to_lean_moves() {
    const NOW_S: f64 = 5.0;
    // Level until some time ago, then tilted by this share of full tilt, with these velocities in turns.
    let stands = |level_ago_s: [f64; 2], lean: f64, velocities_m_s: [f64; 2]| {
        let level = (NOW_S - level_ago_s[0], 0.0, 0.0, 0.0);
        let leaning = (0..20).map(|i| {
            let at_s = NOW_S - level_ago_s[1] * (1.0 - i as f64 / 19.0);
            (at_s, lean * FULL_RAD, 0.0, velocities_m_s[i % 2])
        });
        axis(std::iter::once(level).chain(leaning)).stands_while_leaning(NOW_S, FULL_RAD)
    };
    let dead = [0.0; 2];
    for sign in [-1.0, 1.0] {
        assert!(stands([2.1, 2.0], sign * 0.81, dead));
        assert!(!stands([2.1, 2.0], sign * 0.79, dead), "gently");
        assert!(
            stands([2.1, 1.95], sign, dead) && !stands([2.1, 1.85], sign, dead),
            "for too short"
        );
        assert!(
            stands([4.9, 2.0], sign, dead) && !stands([5.1, 2.0], sign, dead),
            "against the wind"
        );
        // The flow shows a motion on the average...
        for m_s in [-STILL_M_S, STILL_M_S] {
            assert!(stands([2.1, 2.0], sign, [m_s * 0.99; 2]));
            assert!(!stands([2.1, 2.0], sign, [m_s * 1.01; 2]));
        }
        // ...or it varies.
        let varies = |m_s: f64| stands([2.1, 2.0], sign, [m_s, -m_s]);
        assert!(varies(STILL_DEVIATION_M_S - 1e-3) && !varies(STILL_DEVIATION_M_S));
    }
    // A drone that leant the other way before has begun to lean too.
    let turns = [(1.0, -0.1, 0.0, 0.0), (3.0, 0.2, 0.0, 0.0), (NOW_S, 0.2, 0.0, 0.0)];
    assert!(axis(turns).stands_while_leaning(NOW_S, FULL_RAD));
    let unlevelled = [(1.0, 0.01, 0.0, 0.0), (3.0, 0.2, 0.0, 0.0), (NOW_S, 0.2, 0.0, 0.0)];
    assert!(!axis(unlevelled).stands_while_leaning(NOW_S, FULL_RAD));
    assert!(!Axis::new().stands_while_leaning(NOW_S, FULL_RAD), "nothing is known yet");
    let at_limit = [(1.0, 0.0, 0.0, 0.0), (3.0, 0.2, 0.0, STILL_M_S), (NOW_S, 0.2, 0.0, STILL_M_S)];
    assert!(!axis(at_limit).stands_while_leaning(NOW_S, FULL_RAD));
}
