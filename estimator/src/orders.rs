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
}
