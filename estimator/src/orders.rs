//! Orders sent to the drone, and when they take effect.

use std::collections::VecDeque;
use std::time::Duration;

use kinematics::Sticks;

/// An order to the drone.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Order {
    /// The drone stands, takes off, lands or holds its position by itself.
    #[default]
    ByItself,
    /// The drone follows the sticks.
    Sticks(Sticks),
}

/// More than two seconds of ticks; nothing older is used.
const MEMORY: usize = 80;

/// The newest orders, each with the time from which it takes effect, in seconds on the pilot's clock.
#[derive(Debug, Clone)]
pub(crate) struct Orders {
    dead_time_s: f64,
    recent: VecDeque<(f64, Order)>,
}

impl Orders {
    pub(crate) fn new(dead_time: Duration) -> Self {
        Self { dead_time_s: dead_time.as_secs_f64(), recent: VecDeque::with_capacity(MEMORY) }
    }

    pub(crate) fn push(&mut self, sent_at: Duration, order: Order) {
        if self.recent.len() == MEMORY {
            self.recent.pop_front();
        }
        self.recent.push_back((sent_at.as_secs_f64() + self.dead_time_s, order));
    }

    /// The order in effect at a time.
    pub(crate) fn at(&self, time_s: f64) -> Order {
        let newer = self.recent.partition_point(|(from_s, _)| *from_s <= time_s + 1e-9);
        newer.checked_sub(1).and_then(|i| self.recent.get(i)).map_or(Order::ByItself, |o| o.1)
    }

    /// How far the sticks moved in an interval, summed up, by the one that moved furthest; infinite if the drone moved by
    /// itself.
    pub(crate) fn variation(&self, from_s: f64, to_s: f64) -> f64 {
        let Order::Sticks(mut last) = self.at(from_s) else { return f64::INFINITY };
        let first = self.recent.partition_point(|(at_s, _)| *at_s <= from_s);
        let mut variation = [0.0; 4];
        for (_, order) in self.recent.range(first..).take_while(|(at_s, _)| *at_s <= to_s) {
            let Order::Sticks(sticks) = *order else { return f64::INFINITY };
            let moved = [
                sticks.roll - last.roll,
                sticks.pitch - last.pitch,
                sticks.gaz - last.gaz,
                sticks.yaw - last.yaw,
            ];
            variation.iter_mut().zip(moved).for_each(|(sum, moved)| *sum += moved.abs());
            last = sticks;
        }
        variation.into_iter().fold(0.0, f64::max)
    }

    /// Splits an interval into steps with one order each.
    pub(crate) fn steps(&self, from_s: f64, to_s: f64, mut step: impl FnMut(f64, f64, Order)) {
        let mut now_s = from_s;
        while now_s < to_s - 1e-9 {
            let newer = self.recent.partition_point(|(from_s, _)| *from_s <= now_s + 1e-9);
            let change_s = self.recent.get(newer).map_or(f64::INFINITY, |(from_s, _)| *from_s);
            let end_s = (now_s + MAX_STEP_S).min(change_s).min(to_s);
            step(now_s, end_s - now_s, self.at(now_s));
            now_s = end_s;
        }
    }
}

/// Fine enough for the shortest time constant.
const MAX_STEP_S: f64 = 0.01;

#[cfg(test)]
mod tests {
    use super::*;

    fn forward(forward: f64) -> Order {
        Order::Sticks(Sticks { pitch: -forward, ..Sticks::default() })
    }

    #[test]
    fn an_order_acts_after_the_dead_time_until_the_next_one() {
        let mut orders = Orders::new(Duration::from_millis(60));
        orders.push(Duration::from_millis(30), forward(0.3));
        orders.push(Duration::from_millis(60), forward(0.6));
        assert_eq!(orders.at(0.08), Order::ByItself);
        assert_eq!(orders.at(0.09), forward(0.3));
        assert_eq!(orders.at(5.0), forward(0.6));
        let mut sum = 0.0;
        let mut whole_s = 0.0;
        orders.steps(0.075, 0.15, |_, step_s, order| {
            whole_s += step_s;
            if let Order::Sticks(sticks) = order {
                sum += sticks.tilt().y * step_s;
            }
        });
        assert!((whole_s - 0.075).abs() < 1e-9);
        assert!((sum - (0.3 * 0.03 + 0.6 * 0.03)).abs() < 1e-9, "{sum}");
    }

    #[test]
    fn only_the_newest_orders_are_kept() {
        let mut orders = Orders::new(Duration::ZERO);
        for i in 0..1000 {
            orders.push(Duration::from_millis(30 * i), forward(0.1));
        }
        assert_eq!(orders.recent.len(), MEMORY);
    }

    #[test]
    fn an_interval_is_split_at_each_order_and_at_least_every_ten_milliseconds() {
        let mut orders = Orders::new(Duration::ZERO);
        orders.push(Duration::from_millis(25), forward(0.3));
        orders.push(Duration::from_millis(60), forward(0.6));
        let mut steps = Vec::new();
        orders.steps(0.01, 0.065, |at_s, step_s, order| steps.push((at_s, step_s, order)));
        let (none, slow, fast) = (Order::ByItself, forward(0.3), forward(0.6));
        let expected = [
            (0.01, 0.01, none),
            (0.02, 0.005, none),
            (0.025, 0.01, slow),
            (0.035, 0.01, slow),
            (0.045, 0.01, slow),
            (0.055, 0.005, slow),
            (0.06, 0.005, fast),
        ];
        assert_eq!(steps.len(), expected.len(), "{steps:?}");
        for (step, (at_s, step_s, order)) in steps.iter().zip(expected) {
            assert!((step.0 - at_s).abs() < 1e-9 && (step.1 - step_s).abs() < 1e-9, "{step:?}");
            assert_eq!(step.2, order, "at {at_s}");
        }
        orders.steps(0.1, 0.1, |_, _, _| panic!("no time has passed"));
    }

    /// Times are sums of decimal fractions, which are not exact: a nanosecond is the same moment.
    #[test]
    fn an_order_acts_at_its_moment_whatever_the_rounding() {
        let mut orders = Orders::new(Duration::ZERO);
        orders.push(Duration::from_secs(1), forward(0.3));
        assert_eq!(orders.at(1.0 - 0.5e-9), forward(0.3));
        assert_eq!(orders.at(1.0 - 2e-9), Order::ByItself);
        let mut steps = Vec::new();
        orders.steps(1.0 - 0.5e-9, 1.005, |_, step_s, order| steps.push((step_s, order)));
        assert_eq!(steps.len(), 1, "{steps:?}");
        assert_eq!(steps[0].1, forward(0.3));
        for now_s in [1.0 - 0.5e-9, 1.0 - 1e-9] {
            orders.steps(now_s, 1.0, |_, _, _| panic!("it is the same moment"));
        }
    }
}
