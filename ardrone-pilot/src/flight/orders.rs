//! The way of orders to the tick.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::time::Duration;

use autopilot::vehicle::{Operator, OperatorOrder, Refused, Station};
use crossbeam_channel::{Receiver, Sender, bounded};

/// Orders that may wait for the tick; all of them are taken in one.
const WAITING: usize = 64;
/// The longest wait for the tick's answer: many ticks.
const ANSWER_TIME: Duration = Duration::from_secs(1);

/// What gives orders to a vehicle, from any thread.
#[derive(Debug, Clone)]
pub struct Controls {
    urgent: Arc<Urgent>,
    others: Sender<Request>,
}

/// An order and whom to answer.
pub(super) struct Request {
    pub(super) by: Operator,
    pub(super) order: OperatorOrder,
    /// Called in the tick's thread: it must not wait.
    pub(super) answer: Option<Answer>,
}

type Answer = Box<dyn FnOnce(Result<(), Refused>) + Send>;

impl fmt::Debug for Request {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Request")
            .field("by", &self.by)
            .field("order", &self.order)
            .finish_non_exhaustive()
    }
}

impl Controls {
    /// Orders something without waiting for an answer. Landing and cutting the motors cannot be refused on
    /// the way: they are counters, not entries of a queue.
    ///
    /// # Errors
    /// [`Refused::Busy`] or [`Refused::Left`] if the vehicle will not hear of it.
    pub fn order(&self, by: Operator, order: OperatorOrder) -> Result<(), Refused> {
        self.send(by, order, None)
    }

    /// As [`Controls::order`]; `answer` is called with the vehicle's answer, in the tick's thread: it must not
    /// wait for anything. It is not called if there is an error.
    ///
    /// # Errors
    /// As [`Controls::order`].
    pub fn order_answered(
        &self,
        by: Operator,
        order: OperatorOrder,
        answer: impl FnOnce(Result<(), Refused>) + Send + 'static,
    ) -> Result<(), Refused> {
        self.send(by, order, Some(Box::new(answer)))
    }

    /// As [`Controls::order`], but waits for the vehicle's answer.
    ///
    /// # Errors
    /// Why the vehicle refuses, or will not hear of it.
    pub fn ask(&self, by: Operator, order: OperatorOrder) -> Result<(), Refused> {
        let (sender, answered) = bounded(1);
        self.order_answered(by, order, move |answer| {
            // There is room for it; and nobody may wait any more.
            _ = sender.try_send(answer);
        })?;
        answered
            .recv_timeout(ANSWER_TIME)
            .unwrap_or_else(|_| Err(if self.is_over() { Refused::Left } else { Refused::Busy }))
    }

    fn send(
        &self,
        by: Operator,
        order: OperatorOrder,
        answer: Option<Answer>,
    ) -> Result<(), Refused> {
        let counter = match &order {
            OperatorOrder::Land => Some(&self.urgent.landing),
            OperatorOrder::Cut => Some(&self.urgent.cut),
            _ => None,
        };
        if let Some(counter) = counter {
            counter.fetch_max(packed(by), Ordering::Relaxed);
        } else {
            let request = Request { by, order, answer };
            return match self.others.try_send(request) {
                Ok(()) if self.is_over() => Err(Refused::Left),
                Ok(()) => Ok(()),
                Err(error) if error.is_full() => Err(Refused::Busy),
                Err(_) => Err(Refused::Left),
            };
        }
        if self.is_over() {
            return Err(Refused::Left);
        }
        // Both are always accepted.
        if let Some(answer) = answer {
            answer(Ok(()));
        }
        Ok(())
    }

    /// Whether nobody flies any more.
    pub fn is_over(&self) -> bool {
        self.urgent.over.load(Ordering::Relaxed)
    }

    /// Does what Ctrl-C does: lands and leaves, and the second time leaves at once with the landing ordered.
    /// Returns whether the vehicle will hear of it.
    pub fn stop(&self) -> bool {
        self.urgent.stops.fetch_add(1, Ordering::Relaxed);
        !self.is_over()
    }

    /// Does the same as an operator's wish, not as an interruption.
    pub fn quit(&self) -> bool {
        self.urgent.quit.store(true, Ordering::Relaxed);
        self.stop()
    }

    /// Whether an operator wished to leave.
    pub fn has_quit(&self) -> bool {
        self.urgent.quit.load(Ordering::Relaxed)
    }
}

/// What must be heard whatever else waits. What is urgent has no queue that could be full: who ordered it
/// last is enough, a local operator before a remote one.
#[derive(Debug, Default)]
struct Urgent {
    stops: AtomicU32,
    /// See [`packed`]; 0 for no order.
    landing: AtomicU32,
    cut: AtomicU32,
    quit: AtomicBool,
    over: AtomicBool,
}

const LOCAL: u32 = 1 << 31;
const STATION_SHIFT: u32 = 16;

/// An operator as a number that is not 0: local ones are greater than remote ones.
fn packed(by: Operator) -> u32 {
    let station = Station::ALL.iter().position(|station| *station == by.station).unwrap_or(0);
    // There are few stations.
    let station = u32::try_from(station + 1).unwrap_or(1);
    (u32::from(by.local) * LOCAL) | (station << STATION_SHIFT) | u32::from(by.number)
}

fn unpacked(number: u32) -> Option<Operator> {
    let station = ((number & !LOCAL) >> STATION_SHIFT).checked_sub(1)?;
    let station = *Station::ALL.get(usize::try_from(station).ok()?)?;
    // The lower half is the number.
    let number_of_station = u16::try_from(number & 0xffff).ok()?;
    Some(Operator { station, number: number_of_station, local: number & LOCAL != 0 })
}

/// The tick's end of it.
#[derive(Debug)]
pub(super) struct Orders {
    urgent: Arc<Urgent>,
    others: Receiver<Request>,
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
    pub(super) fn poll(&self) -> impl Iterator<Item = Request> + '_ {
        let raised = |operator: &AtomicU32, order| {
            let by = unpacked(operator.swap(0, Ordering::Relaxed))?;
            Some(Request { by, order, answer: None })
        };
        let others = self.others.try_iter().take(WAITING);
        let landing =
            std::iter::once_with(move || raised(&self.urgent.landing, OperatorOrder::Land));
        let cut = std::iter::once_with(move || raised(&self.urgent.cut, OperatorOrder::Cut));
        others.chain(landing.flatten()).chain(cut.flatten())
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

    const BY: Operator = Operator::TERMINAL;
    const REMOTE: Operator = Operator { station: Station::Mavlink, number: 3, local: false };

    #[test]
    fn landing_cutting_and_stopping_are_heard_when_nothing_else_is() {
        let (orders, controls) = Orders::new();
        while controls.order(BY, OperatorOrder::Hold).is_ok() {}
        assert_eq!(controls.order(BY, OperatorOrder::Hold), Err(Refused::Busy));
        assert_eq!(controls.ask(REMOTE, OperatorOrder::Cut), Ok(()));
        assert_eq!(controls.ask(BY, OperatorOrder::Land), Ok(()));
        assert_eq!(controls.order(REMOTE, OperatorOrder::Land), Ok(()));
        assert!(controls.stop());
        assert!(controls.clone().stop());
        assert_eq!(orders.stops(), 2);
        let taken: Vec<Request> = orders.poll().collect();
        assert_eq!(taken.len(), WAITING + 2);
        assert_eq!((taken[WAITING].by, taken[WAITING].order.clone()), (BY, OperatorOrder::Land));
        assert_eq!(
            (taken[WAITING + 1].by, taken[WAITING + 1].order.clone()),
            (REMOTE, OperatorOrder::Cut)
        );
        assert_eq!(orders.poll().count(), 0);
    }

    #[test]
    fn a_flight_that_is_over_hears_nothing() {
        let (orders, controls) = Orders::new();
        assert!(!controls.is_over());
        drop(orders);
        assert_eq!(controls.order(BY, OperatorOrder::Land), Err(Refused::Left));
        assert_eq!(controls.ask(BY, OperatorOrder::Hold), Err(Refused::Left));
        assert!(!controls.stop());
        assert!(controls.is_over());
    }

    #[test]
    fn operators_survive_being_packed() {
        for station in Station::ALL {
            for (number, local) in [(0, true), (1, false), (u16::MAX, true)] {
                let operator = Operator { station, number, local };
                assert_eq!(unpacked(packed(operator)), Some(operator));
            }
        }
        assert_eq!(unpacked(0), None);
        assert!(packed(Operator::TERMINAL) > packed(REMOTE));
    }

    #[test]
    fn an_answer_comes_back() {
        let (orders, controls) = Orders::new();
        let asked = std::thread::spawn(move || controls.ask(REMOTE, OperatorOrder::Clear));
        let request = loop {
            if let Some(request) = orders.poll().next() {
                break request;
            }
        };
        assert_eq!((request.by, &request.order), (REMOTE, &OperatorOrder::Clear));
        request.answer.unwrap()(Err(Refused::NoMission));
        assert_eq!(asked.join().unwrap(), Err(Refused::NoMission));
    }
}
