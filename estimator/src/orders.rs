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

/// More than two seconds of ticks, and the longest delay of a link besides; nothing older is used.
const MEMORY: usize = 100;

/// The newest orders. All times are in seconds on the pilot's clock, as that of the samples: an order takes effect where
/// the samples would show it.
#[derive(Debug, Clone)]
pub(crate) struct Orders {
    dead_time_s: f64,
    /// Time on the link, to the drone and back.
    link_delay_s: f64,
    /// Until this time of the samples the drone took off or landed by itself, whatever it was sent.
    autonomous_until_s: f64,
    /// With the time at which each was sent.
    recent: VecDeque<(f64, Order)>,
}

impl Orders {
    pub(crate) fn new(dead_time: Duration) -> Self {
        Self {
            dead_time_s: dead_time.as_secs_f64(),
            link_delay_s: 0.0,
            autonomous_until_s: f64::NEG_INFINITY,
            recent: VecDeque::with_capacity(MEMORY),
        }
    }

    pub(crate) fn push(&mut self, sent_at: Duration, order: Order) {
        if self.recent.len() == MEMORY {
            self.recent.pop_front();
        }
        self.recent.push_back((sent_at.as_secs_f64(), order));
    }

    pub(crate) fn set_link_delay(&mut self, delay_s: f64) {
        self.link_delay_s = delay_s;
    }

    /// A sample shows that the drone takes off or lands by itself.
    pub(crate) fn set_autonomous(&mut self, time_s: f64) {
        self.autonomous_until_s = time_s;
    }

    /// Time from an order to its effect in the samples, by the present estimate of the link's delay.
    pub(crate) fn delay_s(&self) -> f64 {
        self.dead_time_s + self.link_delay_s
    }

    /// When the order in effect at a time was sent, if the link delays by this much.
    pub(crate) fn sent_s(&self, time_s: f64, link_delay_s: f64) -> f64 {
        time_s - self.dead_time_s - link_delay_s
    }

    /// The order in effect at a time.
    pub(crate) fn at(&self, time_s: f64) -> Order {
        if time_s <= self.autonomous_until_s {
            return Order::ByItself;
        }
        let sent_s = self.sent_s(time_s, self.link_delay_s);
        let newer = self.recent.partition_point(|(at_s, _)| *at_s <= sent_s + 1e-9);
        newer.checked_sub(1).and_then(|i| self.recent.get(i)).map_or(Order::ByItself, |o| o.1)
    }

    /// Whether the stick of the climb is at rest at a time.
    pub(crate) fn is_level(&self, time_s: f64) -> bool {
        matches!(self.at(time_s), Order::Sticks(Sticks { gaz: 0.0, .. }))
    }

    /// Whether the drone moved by itself at any time of an interval, whatever the link's delay is up to this one.
    pub(crate) fn may_move_by_itself(&self, time_s: f64, longest_delay_s: f64) -> bool {
        let [from_s, to_s] = [longest_delay_s, 0.0].map(|delay_s| self.sent_s(time_s, delay_s));
        let first = self.recent.partition_point(|(at_s, _)| *at_s <= from_s + 1e-9);
        if time_s <= self.autonomous_until_s {
            return true;
        }
        let Some(first) = first.checked_sub(1) else { return true };
        let mut during = self.recent.range(first..).take_while(|(at_s, _)| *at_s <= to_s);
        during.any(|(_, order)| *order == Order::ByItself)
    }

    /// How far the sticks moved in an interval, summed up, by the one that moved furthest; infinite if the drone moved by
    /// itself.
    pub(crate) fn variation(&self, from_s: f64, to_s: f64) -> f64 {
        let Order::Sticks(mut last) = self.at(from_s) else { return f64::INFINITY };
        let [from_s, to_s] = [from_s, to_s].map(|time_s| self.sent_s(time_s, self.link_delay_s));
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
        let delay_s = self.delay_s();
        self.steps_sent(from_s - delay_s, to_s - delay_s, |sent_s, step_s, order| {
            let at_s = sent_s + delay_s;
            let autonomous = at_s < self.autonomous_until_s;
            step(at_s, step_s, if autonomous { Order::ByItself } else { order });
        });
    }

    /// As [`Self::steps`], for an interval in which the orders were sent.
    pub(crate) fn steps_sent(&self, from_s: f64, to_s: f64, mut step: impl FnMut(f64, f64, Order)) {
        let mut now_s = from_s;
        let mut newer = self.recent.partition_point(|(at_s, _)| *at_s <= now_s + 1e-9);
        while now_s < to_s - 1e-9 {
            let order = newer.checked_sub(1).and_then(|i| self.recent.get(i));
            let change_s = self.recent.get(newer).map_or(f64::INFINITY, |(at_s, _)| *at_s);
            let end_s = (now_s + MAX_STEP_S).min(change_s).min(to_s);
            step(now_s, end_s - now_s, order.map_or(Order::ByItself, |(_, order)| *order));
            now_s = end_s;
            while self.recent.get(newer).is_some_and(|(at_s, _)| *at_s <= now_s + 1e-9) {
                newer += 1;
            }
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
