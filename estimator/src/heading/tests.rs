use std::time::Duration;

use super::*;
use kinematics::Sticks;

fn turning() -> (Heading, Orders) {
    let mut orders = Orders::new(Duration::ZERO);
    orders.push(Duration::ZERO, Order::Sticks(Sticks { yaw: 0.5, ..Sticks::default() }));
    let mut heading = Heading::new(0.0);
    let (airframe, limits) = (Airframe::default(), DroneLimits::default());
    // 50 degrees per second from 171 degrees, across the wrap.
    for i in 0..=30 {
        let at_s = f64::from(i) * 0.1;
        heading.update(at_s, wrap_deg(171.0 + 50.0 * at_s), &orders, &airframe, &limits);
    }
    (heading, orders)
}

#[test]
fn it_counts_on_across_the_jump_and_fills_the_time_between() {
    let (heading, orders) = turning();
    let at = |time_s| heading.at(time_s, &orders, &Airframe::default(), &DroneLimits::default());
    assert!((at(2.95) - 147.5).abs() < 1e-6);
    assert!((at(0.72) - 36.0).abs() < 1e-6);
    assert!((at(-1.0)).abs() < 1e-9);
}

#[test]
fn a_step_that_no_turn_explains_does_not_turn_the_world() {
    for step_deg in [160.0, -60.0, 10.0, 6.5] {
        let (mut heading, orders) = turning();
        let (airframe, limits) = (Airframe::default(), DroneLimits::default());
        let mut steps = 0;
        for i in 31..=60 {
            let at_s = f64::from(i) * 0.1;
            let lie_deg = if (40..50).contains(&i) { step_deg } else { 0.0 };
            let compass_deg = wrap_deg(171.0 + 50.0 * at_s + lie_deg);
            let stepped = heading.update(at_s, compass_deg, &orders, &airframe, &limits);
            steps += u32::from(stepped);
        }
        let error_deg = heading.at(6.0, &orders, &airframe, &limits) - 300.0;
        let small = step_deg.abs() < 7.0;
        assert_eq!(steps, if small { 0 } else { 2 }, "there and back: {step_deg}");
        assert!(error_deg.abs() < 1.0, "{step_deg}: {error_deg}");
    }
}

#[test]
fn it_goes_on_as_the_sticks_tell() {
    let (heading, orders) = turning();
    let deg = heading.at(3.2, &orders, &Airframe::default(), &DroneLimits::default());
    assert!((deg - 160.0).abs() < 0.1, "{deg}");
}

const LIMITS: DroneLimits = DroneLimits { tilt_rad: 0.2, climb_m_s: 0.7, turn_deg_s: 100.0 };

/// A heading with these measurements, and orders that ask for nothing.
fn measured(measured: &[(f64, f64)]) -> (Heading, Orders, Vec<bool>) {
    let (mut heading, orders) = (Heading::new(0.0), Orders::new(Duration::ZERO));
    let steps = measured
        .iter()
        .map(|(at_s, deg)| heading.update(*at_s, *deg, &orders, &Airframe::default(), &LIMITS))
        .collect();
    (heading, orders, steps)
}

#[test]
fn a_step_is_more_than_noise_and_the_fastest_turn() {
    for sign in [-1.0, 1.0] {
        // 6 degrees, plus 10 degrees per second.
        for (at_s, deg, is_step) in
            [(0.1, 6.9, false), (0.1, 7.1, true), (0.5, 10.9, false), (0.5, 11.1, true)]
        {
            let (heading, _, steps) = measured(&[(0.0, 0.0), (at_s, sign * deg)]);
            assert_eq!(steps, [false, is_step], "{deg}");
            let expected_deg = if is_step { 0.0 } else { sign * deg };
            assert!((heading.newest_deg() - expected_deg).abs() < 1e-9);
        }
    }
    assert_eq!(measured(&[(0.0, 0.0), (0.0, MAX_SURPRISE_DEG)]).2, [false, false]);
}

#[test]
fn of_two_headings_the_later_one_counts() {
    let (heading, ..) = measured(&[(0.0, 10.0), (0.1, 12.0), (0.05, 14.0)]);
    assert!((heading.newest_deg() - 2.0).abs() < 1e-9, "an older one is ignored");
    let (heading, ..) = measured(&[(0.0, 10.0), (0.1, 12.0), (0.1, 14.0)]);
    assert!((heading.newest_deg() - 4.0).abs() < 1e-9);
}

#[test]
fn it_remembers_the_newest_headings_only() {
    let line: Vec<(f64, f64)> = (0..200).map(|i| (0.1 * f64::from(i), 0.0)).collect();
    let (heading, ..) = measured(&line);
    assert_eq!(heading.measured.len(), MEMORY);
    assert!((heading.measured.back().unwrap().0 - 19.9).abs() < 1e-9);
}

#[test]
fn the_turn_follows_the_stick_with_the_airframes_gain_and_lag() {
    let airframe = Airframe { turn_gain: 0.8, ..Airframe::default() };
    let (mut heading, _, _) = measured(&[(0.0, 10.0)]);
    let mut orders = Orders::new(Duration::ZERO);
    orders.push(Duration::ZERO, Order::Sticks(Sticks { yaw: 0.5, ..Sticks::default() }));
    orders.push(Duration::from_millis(150), Order::ByItself);
    let lag_s = airframe.turn_lag_s;
    let followed = 1.0 - (-1_f64).exp();
    let rate = |at_s| heading.turn_deg_s(at_s, &orders, &airframe, &LIMITS);
    assert!((rate(lag_s) - 40.0 * followed).abs() < 1e-6, "{}", rate(lag_s));
    assert!((rate(2.0 * lag_s) - 40.0 * followed * (1.0 - followed)).abs() < 1e-6);
    // The angle is the integral of the rate, here within half a step.
    let angle_deg = 40.0 * lag_s * (1.0 - followed);
    let deg = heading.at(lag_s, &orders, &airframe, &LIMITS);
    assert!((angle_deg..angle_deg + 0.2).contains(&deg), "{deg}, {angle_deg}");
    // The next heading takes the rate over.
    assert!(!heading.update(lag_s, 10.0 + deg, &orders, &airframe, &LIMITS));
    assert!((heading.newest_turn_deg_s() - 40.0 * followed).abs() < 1e-6);
    let before_deg = heading.newest_deg();
    assert!(before_deg > 1.0);
    heading.handle_restart();
    let is_as_before = |heading: &Heading| (heading.newest_deg() - before_deg).abs() < 1e-9;
    assert!(heading.newest_turn_deg_s().abs() < 1e-9 && is_as_before(&heading));
    assert!(!heading.update(0.0, -100.0, &orders, &airframe, &LIMITS), "a new baseline");
    assert!(is_as_before(&heading), "and the same heading");
}

/// Yaw sticks, each from a time in milliseconds on.
fn turns_from(sticks: &[(u64, f64)]) -> (Heading, Orders) {
    let mut orders = Orders::new(Duration::ZERO);
    for (at_ms, yaw) in sticks {
        let sticks = Sticks { yaw: *yaw, ..Sticks::default() };
        orders.push(Duration::from_millis(*at_ms), Order::Sticks(sticks));
    }
    (Heading::new(0.0), orders)
}

/// The compass is right, but the drone does not do what the prediction expects.
#[test]
fn a_drone_that_does_not_hear_that_its_turn_ends_is_still_believed() {
    let (mut heading, orders) = turns_from(&[(0, 1.0), (1000, -1.0)]);
    let rate_deg_s = 100.0 * Airframe::default().turn_gain;
    for packet in 0..30 {
        let at_s = 0.066 * f64::from(packet);
        let compass_deg = wrap_deg(rate_deg_s * at_s);
        let stepped = heading.update(at_s, compass_deg, &orders, &Airframe::default(), &LIMITS);
        assert!(!stepped, "{at_s}");
    }
    let turned_deg = rate_deg_s * 0.066 * 29.0;
    assert!((heading.newest_deg() - turned_deg).abs() < 1e-6, "{}", heading.newest_deg());
}

/// Whether the compass makes a step if it shows `deg` at `to_s`, after it followed the orders until `from_s`, and
/// whether packets arrived meanwhile.
fn steps_after_a_gap(
    sticks: &[(u64, f64)],
    from_s: f64,
    to_s: f64,
    deg: impl Fn(f64) -> f64,
    with_packets: bool,
) -> bool {
    let airframe = Airframe::default();
    let (mut heading, orders) = turns_from(sticks);
    let model = Turning { orders: &orders, airframe: &airframe, limits: &LIMITS };
    let truth = |at_s| model.turned(0.0, 0.0, at_s).1;
    let mut at_s = 0.0;
    while at_s < to_s {
        if at_s <= from_s {
            heading.hear(at_s);
            assert!(!heading.update(at_s, wrap_deg(truth(at_s)), &orders, &airframe, &LIMITS));
        } else if with_packets {
            heading.hear(at_s);
        }
        at_s += 0.05;
    }
    heading.hear(to_s);
    let before_deg = heading.newest_deg();
    let compass_deg = wrap_deg(deg(truth(to_s)));
    let stepped = heading.update(to_s, compass_deg, &orders, &airframe, &LIMITS);
    let expected_deg = if stepped { truth(to_s) } else { deg(truth(to_s)) };
    let error_deg = wrap_deg(heading.newest_deg() - expected_deg);
    assert!(error_deg.abs() < 5.0, "{before_deg} {error_deg}");
    stepped
}

#[test]
fn a_step_in_a_turn_is_one_however_fast_the_turn() {
    let turn = [(0, 1.0)];
    for off_deg in [-18.0, -12.0, 12.0, 18.0] {
        let off = |deg: f64| deg + off_deg;
        assert!(steps_after_a_gap(&turn, 1.0, 1.06, off, true), "{off_deg}");
    }
    for off_deg in [-6.0, 6.0] {
        assert!(!steps_after_a_gap(&turn, 1.0, 1.06, |deg| deg + off_deg, true), "{off_deg}");
    }
    // While only the compass is missing, the drone hears its orders: it turned on by some 30 degrees.
    for off_deg in [-30.0, -20.0, 20.0, 60.0] {
        let off = |deg: f64| deg + off_deg;
        assert!(steps_after_a_gap(&turn, 1.0, 1.3, off, true), "{off_deg}");
    }
}

#[test]
fn a_turn_that_was_not_heard_in_a_gap_is_no_step() {
    // It was asked for and stopped within the gap; the drone did neither, or heard only the first.
    let turn = [(0, 0.0), (1000, 1.0), (2000, 0.0)];
    let shown = |deg: f64| move |_| deg;
    for (deg, stepped) in [(2.0, false), (170.0, false), (-50.0, true), (-100.0, true)] {
        assert_eq!(steps_after_a_gap(&turn, 0.9, 2.9, shown(deg), false), stepped, "{deg}");
    }
    // Packets without a heading arrive, so it was heard.
    assert!(steps_after_a_gap(&turn, 0.9, 2.9, shown(2.0), true));
    // That a turn was stopped or begun the other way was not heard: it went on, by some 77 degrees.
    for then in [0.0, -1.0] {
        let turn = [(0, 1.0), (1000, then)];
        let model_deg = 100.0 * Airframe::default().turn_gain;
        let went_on = |off_deg: f64| move |_| model_deg * 1.7 + off_deg;
        assert!(!steps_after_a_gap(&turn, 1.0, 1.8, went_on(0.0), false));
        assert!(steps_after_a_gap(&turn, 1.0, 1.8, went_on(60.0), false));
    }
}

#[test]
fn a_compass_that_hangs_in_a_turn_does_not_turn_the_world() {
    let (mut heading, orders) = turns_from(&[(0, 1.0)]);
    let (airframe, mut steps) = (Airframe::default(), 0);
    let model = Turning { orders: &orders, airframe: &airframe, limits: &LIMITS };
    let truth = |at_s| model.turned(0.0, 0.0, at_s).1;
    for packet in 0..30 {
        let at_s = 0.066 * f64::from(packet);
        let hangs = (10..16).contains(&packet);
        let compass_deg = wrap_deg(truth(if hangs { 0.066 * 9.0 } else { at_s }));
        steps += u32::from(heading.update(at_s, compass_deg, &orders, &airframe, &LIMITS));
        // What it did not measure teaches nothing of how the drone turns.
        assert_eq!(heading.measured_deg(at_s).is_some(), !hangs, "{packet}");
    }
    assert_eq!(steps, 0);
    let error_deg = heading.newest_deg() - truth(0.066 * 29.0);
    assert!(error_deg.abs() < 1.0, "{error_deg}");
}
