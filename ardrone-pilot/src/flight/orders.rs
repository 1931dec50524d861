//! The way of orders to the tick.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use autopilot::pilot::PilotOrder;
use crossbeam_channel::{Receiver, Sender, bounded};

/// Orders that may wait for the tick; all of them are taken in one.
const WAITING: usize = 64;

/// The pilot's hand on a flight that goes on.
#[derive(Debug, Clone)]
pub struct Controls {
    urgent: Arc<Urgent>,
    others: Sender<PilotOrder>,
}

impl Controls {
    /// Orders something; returns whether the flight will hear of it. Landing and cutting the motors are
    /// always heard; anything else is refused if too much waits. A flight that is over hears nothing.
    pub fn order(&self, order: PilotOrder) -> bool {
        match order {
            PilotOrder::Land => self.urgent.raise(&self.urgent.landings),
            PilotOrder::Cut => self.urgent.raise(&self.urgent.cuts),
            other => self.others.try_send(other).is_ok(),
        }
    }

    /// Whether the flight is over.
    pub fn is_over(&self) -> bool {
        self.urgent.over.load(Ordering::Relaxed)
    }

    /// Does what Ctrl-C does: lands, and the second time leaves at once with the landing ordered.
    /// Returns whether the flight will hear of it.
    pub fn stop(&self) -> bool {
        self.urgent.raise(&self.urgent.stops)
    }
}

/// What must be heard whatever else waits: counters cannot be full.
#[derive(Debug, Default)]
struct Urgent {
    stops: AtomicU32,
    landings: AtomicU32,
    cuts: AtomicU32,
    over: AtomicBool,
}

impl Urgent {
    fn raise(&self, counter: &AtomicU32) -> bool {
        counter.fetch_add(1, Ordering::Relaxed);
        !self.over.load(Ordering::Relaxed)
    }
}

/// The tick's end of it.
#[derive(Debug)]
pub(super) struct Orders {
    urgent: Arc<Urgent>,
    others: Receiver<PilotOrder>,
}

impl Orders {
    /// Both ends.
    pub(super) fn new() -> (Self, Controls) {
        let urgent = Arc::new(Urgent::default());
        let (sender, others) = bounded(WAITING);
        (Self { urgent: Arc::clone(&urgent), others }, Controls { urgent, others: sender })
    }

    /// What was ordered since the last tick, never more than can wait. What is urgent comes last and has
    /// the last word.
    pub(super) fn poll(&self) -> impl Iterator<Item = PilotOrder> + '_ {
        let raised = |counter: &AtomicU32| counter.swap(0, Ordering::Relaxed) > 0;
        let others = self.others.try_iter().take(WAITING);
        let landing = std::iter::once_with(move || raised(&self.urgent.landings));
        let cut = std::iter::once_with(move || raised(&self.urgent.cuts));
        others
            .chain(landing.filter(|raised| *raised).map(|_| PilotOrder::Land))
            .chain(cut.filter(|raised| *raised).map(|_| PilotOrder::Cut))
    }

    /// How often the end was asked for.
    pub(super) fn stops(&self) -> u32 {
        self.urgent.stops.load(Ordering::Relaxed)
    }
}

impl Drop for Orders {
    fn drop(&mut self) {
        self.urgent.over.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn landing_cutting_and_stopping_are_heard_when_nothing_else_is() {
        let (orders, controls) = Orders::new();
        while controls.order(PilotOrder::Hold) {}
        assert!(controls.order(PilotOrder::Cut));
        assert!(controls.order(PilotOrder::Land));
        assert!(controls.stop());
        assert!(controls.clone().stop());
        assert_eq!(orders.stops(), 2);
        let taken: Vec<PilotOrder> = orders.poll().collect();
        assert_eq!(taken.len(), WAITING + 2);
        assert_eq!(taken[WAITING..], [PilotOrder::Land, PilotOrder::Cut]);
        assert_eq!(orders.poll().count(), 0);
    }

    #[test]
    fn a_flight_that_is_over_hears_nothing() {
        let (orders, controls) = Orders::new();
        assert!(!controls.is_over());
        drop(orders);
        assert!(!controls.order(PilotOrder::Land));
        assert!(!controls.order(PilotOrder::Hold));
        assert!(!controls.stop());
        assert!(controls.is_over());
    }
}
