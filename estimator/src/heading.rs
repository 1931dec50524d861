//! Which way the drone points: now, a little ago, and soon.

use std::collections::VecDeque;

use crate::airframe::{Airframe, DroneLimits};
use crate::angle::wrap_deg;
use crate::orders::{Order, Orders};

/// Enough for the delay of the velocity at 200 packets a second.
const MEMORY: usize = 64;

/// Headings from the first one, not wrapped, by the time they were measured at.
#[derive(Debug, Clone)]
pub(crate) struct Heading {
    baseline_deg: Option<f64>,
    measured: VecDeque<(f64, f64)>,
    /// How fast it turns as far as the sticks tell, at the newest measurement.
    turn_deg_s: f64,
}

impl Heading {
    pub(crate) fn new() -> Self {
        Self { baseline_deg: None, measured: VecDeque::with_capacity(MEMORY), turn_deg_s: 0.0 }
    }

    /// Takes in a compass heading that was measured at a time.
    pub(crate) fn update(
        &mut self,
        at_s: f64,
        compass_deg: f64,
        orders: &Orders,
        airframe: &Airframe,
        limits: &DroneLimits,
    ) {
        let baseline_deg = *self.baseline_deg.get_or_insert(compass_deg);
        let last = self.measured.back().copied();
        if last.is_some_and(|(last_s, _)| at_s < last_s) {
            return;
        }
        let turned_deg = wrap_deg(compass_deg - baseline_deg);
        // Nearest to the last one, so that it does not jump at half a turn.
        let deg = last.map_or(turned_deg, |(_, last)| last + wrap_deg(turned_deg - last));
        if let Some((last_s, _)) = last {
            self.turn_deg_s = turned(self.turn_deg_s, last_s, at_s, orders, airframe, limits).0;
        }
        if self.measured.len() == MEMORY {
            self.measured.pop_front();
        }
        self.measured.push_back((at_s, deg));
    }

    /// Between two measurements the line between them; after the last one what the sticks tell.
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

    /// How fast it turns at a time after the newest measurement, as far as the sticks tell.
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

    /// The heading when the drone's compass starts anew: the next one continues the last.
    pub(crate) fn handle_restart(&mut self) {
        self.baseline_deg = None;
        self.measured.clear();
        self.turn_deg_s = 0.0;
    }
}

/// The rate at the end and the angle of a turn.
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
            Order::Sticks(sticks) => sticks.clockwise * limits.turn_deg_s * airframe.turn_gain,
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
    use crate::orders::Sticks;

    fn turning() -> (Heading, Orders) {
        let mut orders = Orders::new(Duration::ZERO);
        orders.push(Duration::ZERO, Order::Sticks(Sticks { clockwise: 0.5, ..Sticks::default() }));
        let mut heading = Heading::new();
        let (airframe, limits) = (Airframe::default(), DroneLimits::default());
        // 50 degrees a second from 171 degrees, across the jump.
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
    fn it_goes_on_as_the_sticks_tell() {
        let (heading, orders) = turning();
        let deg = heading.at(3.2, &orders, &Airframe::default(), &DroneLimits::default());
        assert!((deg - 160.0).abs() < 0.1, "{deg}");
    }
}
