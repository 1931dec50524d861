//! Heading of the drone: in the past, now, and predicted.

use std::collections::VecDeque;

use crate::orders::{Order, Orders};
use kinematics::wrap_deg;
use kinematics::{Airframe, DroneLimits};

/// A heading that differs from the prediction by more than this, plus this much per second since the last
/// one, is a step of the compass and not a turn. The firmware has been seen to step by 160°.
const MAX_SURPRISE_DEG: f64 = 6.0;
const MAX_SURPRISE_DEG_S: f64 = 20.0;
/// A drone that does not receive its orders turns on while the prediction brakes the turn, up to twice as fast as was
/// last asked for: that is no step. For how long it may (time constant).
const UNHEARD_TURNS: f64 = 2.0;
const UNHEARD_S: f64 = 1.0;
/// A compass that repeats its value while the drone should have turned by this has measured nothing new.
const STUCK_DEG: f64 = 0.5;
/// Covers the delay of the velocity at 200 packets per second.
const MEMORY: usize = 64;

/// Unwrapped headings, relative to the first, with their times of measurement.
#[derive(Debug, Clone)]
pub(crate) struct Heading {
    baseline_deg: Option<f64>,
    measured: VecDeque<(f64, f64)>,
    /// Turn rate predicted from the sticks, at the newest measurement.
    turn_deg_s: f64,
    /// The fastest such rate of the last second or two.
    recent_deg_s: f64,
    compass_deg: f64,
}

impl Heading {
    pub(crate) fn new() -> Self {
        Self {
            baseline_deg: None,
            measured: VecDeque::with_capacity(MEMORY),
            turn_deg_s: 0.0,
            recent_deg_s: 0.0,
            compass_deg: f64::NAN,
        }
    }

    /// Adds a compass heading with its time of measurement. Returns whether the compass made a step; a step
    /// does not change the heading.
    pub(crate) fn update(
        &mut self,
        at_s: f64,
        compass_deg: f64,
        orders: &Orders,
        airframe: &Airframe,
        limits: &DroneLimits,
    ) -> bool {
        let baseline_deg = *self.baseline_deg.get_or_insert(compass_deg);
        let last = self.measured.back().copied();
        if last.is_some_and(|(last_s, _)| at_s < last_s) {
            return false;
        }
        let turned_deg = wrap_deg(compass_deg - baseline_deg);
        let (mut deg, mut stepped) = (turned_deg, false);
        if let Some((last_s, last_deg)) = last {
            let (rate_deg_s, angle_deg) =
                turned(self.turn_deg_s, last_s, at_s, orders, airframe, limits);
            #[allow(clippy::float_cmp, reason = "the very same number, not a near one")]
            let repeated = compass_deg == std::mem::replace(&mut self.compass_deg, compass_deg);
            if repeated && angle_deg.abs() > STUCK_DEG {
                return false;
            }
            let step_s = at_s - last_s;
            self.turn_deg_s = rate_deg_s;
            self.recent_deg_s *= (-step_s / UNHEARD_S).exp();
            // In a gap it may have turned and stopped again.
            let mean_deg_s = if step_s > 0.0 { angle_deg / step_s } else { 0.0 };
            self.recent_deg_s = self.recent_deg_s.max(rate_deg_s.abs()).max(mean_deg_s.abs());
            let expected_deg = last_deg + angle_deg;
            let surprise_deg = wrap_deg(turned_deg - expected_deg);
            let unheard_deg_s = UNHEARD_TURNS * self.recent_deg_s;
            stepped = surprise_deg.abs()
                > MAX_SURPRISE_DEG + (MAX_SURPRISE_DEG_S + unheard_deg_s) * step_s;
            if stepped {
                self.baseline_deg = Some(baseline_deg + surprise_deg);
                deg = expected_deg;
            } else {
                // Unwrapped, so that it does not jump at half a turn.
                deg = last_deg + wrap_deg(turned_deg - last_deg);
            }
        }
        if self.measured.len() == MEMORY {
            self.measured.pop_front();
        }
        self.measured.push_back((at_s, deg));
        stepped
    }

    /// Interpolates between measurements; predicts from the sticks after the last one.
    pub(crate) fn at(
        &self,
        time_s: f64,
        orders: &Orders,
        airframe: &Airframe,
        limits: &DroneLimits,
    ) -> f64 {
        let after = self.measured.partition_point(|(at_s, _)| *at_s <= time_s);
        let before = after.checked_sub(1).and_then(|i| self.measured.get(i));
        match (before, self.measured.get(after)) {
            (Some((from_s, from)), Some((to_s, to))) => {
                from + (to - from) * (time_s - from_s) / (to_s - from_s).max(1e-9)
            }
            (Some((from_s, from)), None) => {
                from + turned(self.turn_deg_s, *from_s, time_s, orders, airframe, limits).1
            }
            (None, Some((_, first))) => *first,
            (None, None) => 0.0,
        }
    }

    /// Turn rate at a time after the newest measurement, predicted from the sticks.
    pub(crate) fn turn_deg_s(
        &self,
        time_s: f64,
        orders: &Orders,
        airframe: &Airframe,
        limits: &DroneLimits,
    ) -> f64 {
        self.measured.back().map_or(0.0, |(from_s, _)| {
            turned(self.turn_deg_s, *from_s, time_s, orders, airframe, limits).0
        })
    }

    /// The newest measured heading.
    pub(crate) fn newest_deg(&self) -> f64 {
        self.measured.back().map_or(0.0, |(_, deg)| *deg)
    }

    /// The turn rate at the newest measurement, predicted from the sticks.
    pub(crate) fn newest_turn_deg_s(&self) -> f64 {
        self.turn_deg_s
    }

    /// The drone's compass has restarted: its next heading is the new zero.
    pub(crate) fn handle_restart(&mut self) {
        self.baseline_deg = None;
        self.measured.clear();
        self.turn_deg_s = 0.0;
        self.recent_deg_s = 0.0;
    }
}

/// Final rate and angle of a turn.
fn turned(
    rate_deg_s: f64,
    from_s: f64,
    to_s: f64,
    orders: &Orders,
    airframe: &Airframe,
    limits: &DroneLimits,
) -> (f64, f64) {
    let (mut rate_deg_s, mut angle_deg) = (rate_deg_s, 0.0);
    orders.steps(from_s, to_s, |_, step_s, order| {
        let wanted_deg_s = match order {
            Order::Sticks(sticks) => sticks.yaw * limits.turn_deg_s * airframe.turn_gain,
            Order::ByItself => 0.0,
        };
        rate_deg_s += (wanted_deg_s - rate_deg_s) * (1.0 - (-step_s / airframe.turn_lag_s).exp());
        angle_deg += rate_deg_s * step_s;
    });
    (rate_deg_s, angle_deg)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use kinematics::Sticks;

    fn turning() -> (Heading, Orders) {
        let mut orders = Orders::new(Duration::ZERO);
        orders.push(Duration::ZERO, Order::Sticks(Sticks { yaw: 0.5, ..Sticks::default() }));
        let mut heading = Heading::new();
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
        let at =
            |time_s| heading.at(time_s, &orders, &Airframe::default(), &DroneLimits::default());
        assert!((at(2.95) - 147.5).abs() < 1e-6);
        assert!((at(0.72) - 36.0).abs() < 1e-6);
        assert!((at(-1.0)).abs() < 1e-9);
    }

    #[test]
    fn a_step_that_no_turn_explains_does_not_turn_the_world() {
        for step_deg in [160.0, -60.0, 10.0] {
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
            let small = step_deg.abs() < 12.0;
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
        let (mut heading, orders) = (Heading::new(), Orders::new(Duration::ZERO));
        let steps = measured
            .iter()
            .map(|(at_s, deg)| heading.update(*at_s, *deg, &orders, &Airframe::default(), &LIMITS))
            .collect();
        (heading, orders, steps)
    }

    #[test]
    fn a_step_is_more_than_noise_and_the_fastest_turn() {
        for sign in [-1.0, 1.0] {
            // 6 degrees, plus 20 degrees per second.
            for (at_s, deg, is_step) in
                [(0.1, 7.9, false), (0.1, 8.1, true), (0.5, 15.9, false), (0.5, 16.1, true)]
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
        heading.handle_restart();
        assert!(heading.newest_turn_deg_s().abs() < 1e-9 && heading.newest_deg().abs() < 1e-9);
        assert!(!heading.update(0.0, -100.0, &orders, &airframe, &LIMITS), "a new baseline");
        assert!(heading.newest_deg().abs() < 1e-9);
    }

    #[test]
    fn a_turn_that_was_asked_for_is_no_step() {
        let airframe = Airframe::default();
        let rate_deg_s = 100.0 * airframe.turn_gain * (1.0 - (-0.5 / airframe.turn_lag_s).exp());
        // 6 degrees, and 20 degrees per second plus twice the rate, for half a second.
        let allowed_deg = 16.0 + rate_deg_s;
        for (off_deg, is_step) in [(-1.0, false), (1.0, true)] {
            let (mut heading, orders) = turns_from(&[(0, 1.0)]);
            let mut update = |at_s, deg| heading.update(at_s, deg, &orders, &airframe, &LIMITS);
            update(0.0, 0.0);
            let (_, angle_deg) = turned(0.0, 0.0, 0.5, &orders, &airframe, &LIMITS);
            assert_eq!(update(0.5, angle_deg - allowed_deg - off_deg), is_step, "{off_deg}");
        }
    }

    /// Yaw sticks, each from a time in milliseconds on.
    fn turns_from(sticks: &[(u64, f64)]) -> (Heading, Orders) {
        let mut orders = Orders::new(Duration::ZERO);
        for (at_ms, yaw) in sticks {
            let sticks = Sticks { yaw: *yaw, ..Sticks::default() };
            orders.push(Duration::from_millis(*at_ms), Order::Sticks(sticks));
        }
        (Heading::new(), orders)
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

    #[test]
    fn a_turn_that_was_not_heard_in_a_gap_is_no_step() {
        // The turn was asked for and stopped within the gap; the drone did neither.
        let (mut heading, orders) = turns_from(&[(1000, 1.0), (2000, 0.0)]);
        let mut update =
            |at_s, deg| heading.update(at_s, deg, &orders, &Airframe::default(), &LIMITS);
        assert!(!update(0.9, 10.0));
        assert!(!update(2.9, 12.0));
        assert!((heading.newest_deg() - 2.0).abs() < 1e-9);
    }

    #[test]
    fn a_compass_that_hangs_in_a_turn_does_not_turn_the_world() {
        let (mut heading, orders) = turns_from(&[(0, 1.0)]);
        let (airframe, mut steps) = (Airframe::default(), 0);
        let truth = |at_s| turned(0.0, 0.0, at_s, &orders, &airframe, &LIMITS).1;
        for packet in 0..30 {
            let at_s = 0.066 * f64::from(packet);
            let hangs = (10..16).contains(&packet);
            let compass_deg = wrap_deg(truth(if hangs { 0.066 * 9.0 } else { at_s }));
            steps += u32::from(heading.update(at_s, compass_deg, &orders, &airframe, &LIMITS));
        }
        assert_eq!(steps, 0);
        let error_deg = heading.newest_deg() - truth(0.066 * 29.0);
        assert!(error_deg.abs() < 1.0, "{error_deg}");
    }
}
