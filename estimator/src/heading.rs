//! Heading of the drone: in the past, now, and predicted.

use std::collections::VecDeque;

use crate::orders::{Order, Orders};
use kinematics::wrap_deg;
use kinematics::{Airframe, DroneLimits};

/// A heading that differs from the prediction by more than this, plus this much per second since the last
/// one, is a step of the compass and not a turn. The firmware has been seen to step by 160°.
const MAX_SURPRISE_DEG: f64 = 6.0;
const MAX_SURPRISE_DEG_S: f64 = 60.0;
/// Covers the delay of the velocity at 200 packets per second.
const MEMORY: usize = 64;

/// Unwrapped headings, relative to the first, with their times of measurement.
#[derive(Debug, Clone)]
pub(crate) struct Heading {
    baseline_deg: Option<f64>,
    measured: VecDeque<(f64, f64)>,
    /// Turn rate predicted from the sticks, at the newest measurement.
    turn_deg_s: f64,
}

impl Heading {
    pub(crate) fn new() -> Self {
        Self { baseline_deg: None, measured: VecDeque::with_capacity(MEMORY), turn_deg_s: 0.0 }
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
            self.turn_deg_s = rate_deg_s;
            let expected_deg = last_deg + angle_deg;
            let surprise_deg = wrap_deg(turned_deg - expected_deg);
            stepped = surprise_deg.abs() > MAX_SURPRISE_DEG + MAX_SURPRISE_DEG_S * (at_s - last_s);
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
            // 6 degrees, plus 60 degrees per second.
            for (at_s, deg, is_step) in
                [(0.1, 11.9, false), (0.1, 12.1, true), (0.5, 35.9, false), (0.5, 36.1, true)]
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
        // Full stick for half a second: some 35 degrees, and 36 more or less are allowed.
        for (deg, is_step) in [(35.0, false), (35.0 + 38.0, true), (35.0 - 38.0, true)] {
            let (mut heading, mut orders) = (Heading::new(), Orders::new(Duration::ZERO));
            let full = Sticks { yaw: 1.0, ..Sticks::default() };
            orders.push(Duration::ZERO, Order::Sticks(full));
            let mut update =
                |at_s, deg| heading.update(at_s, deg, &orders, &Airframe::default(), &LIMITS);
            update(0.0, 0.0);
            assert_eq!(update(0.5, deg), is_step, "{deg}");
        }
    }
}
