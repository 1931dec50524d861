//! Delivery of orders to the tick loop.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::time::Duration;

use autopilot::vehicle::{Operator, OperatorOrder, Refused, Station, VehicleName};
use crossbeam_channel::{Receiver, Sender, bounded};

use crate::runtime::UnderWay;

/// Capacity of the order queue; one tick handles all of them.
const WAITING: usize = 64;
/// A tick handles no further order after this many steps of plans and commands, because each is tried before it is taken.
const STEPS_PER_TICK: usize = 1000;
/// Longest wait for the tick's answer: many ticks.
const ANSWER_TIME: Duration = Duration::from_secs(1);

/// Gives orders to a vehicle, from any thread.
#[derive(Debug, Clone)]
pub struct Controls {
    vehicle: VehicleName,
    urgent: Arc<Urgent>,
    others: Sender<Request>,
}

/// An order with its answer callback.
pub(super) struct Request {
    pub(super) by: Operator,
    pub(super) order: OperatorOrder,
    /// Called in the tick's thread: it must not block.
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
    /// Those of a vehicle that has been left.
    #[cfg(test)]
    pub(crate) fn of_nobody(vehicle: VehicleName) -> Self {
        Orders::new(vehicle, crate::runtime::Ending::default().begin_flight()).1
    }

    /// The vehicle that gets the orders.
    pub fn vehicle(&self) -> VehicleName {
        self.vehicle
    }

    /// Gives an order without waiting for an answer. Landing and cutting the motors cannot be lost on the
    /// way: they are counters, not entries of a queue.
    ///
    /// # Errors
    /// [`Refused::Busy`] if 64 orders wait for the tick, [`Refused::Left`] if the vehicle has been left.
    pub fn order(&self, by: Operator, order: OperatorOrder) -> Result<(), Refused> {
        self.send(by, order, None)
    }

    /// As [`Controls::order`]; `answer` is called with the vehicle's answer, in the tick's thread, where it
    /// must not block. Landing and cutting the motors are always accepted: then it is called at once, in this thread. It is not
    /// called if an error is returned.
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

    /// As [`Controls::order`], but waits for the vehicle's answer, for at most 1 s.
    ///
    /// # Errors
    /// [`Refused`] if the vehicle refuses the order or it cannot be delivered; [`Refused::Busy`] also if no answer comes, though
    /// the order may be taken later.
    pub fn ask(&self, by: Operator, order: OperatorOrder) -> Result<(), Refused> {
        let (sender, answered) = bounded(1);
        self.order_answered(by, order, move |answer| {
            // The channel has room for one answer; the receiver may have timed out.
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

    /// Whether the tick loop has ended.
    pub fn is_over(&self) -> bool {
        self.urgent.over.load(Ordering::Relaxed)
    }

    /// Same as Ctrl-C: lands and exits; the second time exits at once with the landing ordered. Returns
    /// whether the request was delivered.
    pub fn stop(&self) -> bool {
        self.urgent.stops.fetch_add(1, Ordering::Relaxed);
        !self.is_over()
    }

    /// As [`Controls::stop`], but counted as an operator's request rather than an interruption.
    pub fn quit(&self) -> bool {
        self.urgent.quit.store(true, Ordering::Relaxed);
        self.stop()
    }

    /// Whether an operator has requested the exit.
    pub fn has_quit(&self) -> bool {
        self.urgent.quit.load(Ordering::Relaxed)
    }
}

/// The answer to an order that several vehicles got: a refusal only if all refuse, and then the first one's.
///
/// # Errors
/// That refusal.
pub(crate) fn answer_of_all(
    answers: impl IntoIterator<Item = Result<(), Refused>>,
) -> Result<(), Refused> {
    // Each must be asked, also behind one that has accepted.
    let answers: Vec<_> = answers.into_iter().collect();
    let is_taken = answers.iter().any(Result::is_ok);
    answers.into_iter().find(|answer| answer.is_ok() == is_taken).unwrap_or(Ok(()))
}

/// Orders that must be delivered whatever else is queued. They need no queue, which could be full: only the
/// last operator who ordered them matters, a local one before a remote one.
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

/// Packs an operator into a number other than 0; local operators are greater than remote ones.
fn packed(by: Operator) -> u32 {
    let station = Station::ALL.iter().position(|station| *station == by.station).unwrap_or(0);
    // There are only a few stations.
    let station = u32::try_from(station + 1).unwrap_or(1);
    (u32::from(by.local) * LOCAL) | (station << STATION_SHIFT) | u32::from(by.number)
}

fn unpacked(number: u32) -> Option<Operator> {
    let station = ((number & !LOCAL) >> STATION_SHIFT).checked_sub(1)?;
    let station = *Station::ALL.get(usize::try_from(station).ok()?)?;
    // The lower half is the operator's number.
    let number_of_station = u16::try_from(number & 0xffff).ok()?;
    Some(Operator { station, number: number_of_station, local: number & LOCAL != 0 })
}

/// The tick loop's end of the channel.
#[derive(Debug)]
pub(super) struct Orders {
    urgent: Arc<Urgent>,
    others: Receiver<Request>,
    under_way: UnderWay,
}

impl Orders {
    /// Creates both ends.
    pub(super) fn new(vehicle: VehicleName, under_way: UnderWay) -> (Self, Controls) {
        let urgent = Arc::new(Urgent::default());
        let (sender, others) = bounded(WAITING);
        (
            Self { urgent: Arc::clone(&urgent), others, under_way },
            Controls { vehicle, urgent, others: sender },
        )
    }

    /// Orders since the last tick, at most as many as the queue holds and as a tick has time for. Urgent orders come last,
    /// so that they take precedence.
    pub(super) fn poll(&self) -> impl Iterator<Item = Request> + '_ {
        let raised = |operator: &AtomicU32, order| {
            let by = unpacked(operator.swap(0, Ordering::Relaxed))?;
            Some(Request { by, order, answer: None })
        };
        let mut steps = 0;
        let others = std::iter::from_fn(move || {
            let request = (steps < STEPS_PER_TICK).then(|| self.others.try_recv().ok())??;
            steps += request.order.steps();
            Some(request)
        });
        let others = others.take(WAITING);
        let landing =
            std::iter::once_with(move || raised(&self.urgent.landing, OperatorOrder::Land));
        let cut = std::iter::once_with(move || raised(&self.urgent.cut, OperatorOrder::Cut));
        others.chain(landing.flatten()).chain(cut.flatten())
    }

    /// How often the exit was requested, of this vehicle or by a signal of all.
    pub(super) fn stops(&self) -> u32 {
        self.urgent.stops.load(Ordering::Relaxed).saturating_add(self.under_way.signals())
    }
}

impl Drop for Orders {
    fn drop(&mut self) {
        self.urgent.over.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use autopilot::plan::Commands;

    use super::*;
    use crate::runtime::Ending;

    const BY: Operator = Operator::TERMINAL;
    const REMOTE: Operator = Operator { station: Station::Mavlink, number: 3, local: false };

    #[test]
    fn landing_cutting_and_stopping_are_heard_when_nothing_else_is() {
        let (orders, controls) =
            Orders::new(VehicleName::default(), Ending::default().begin_flight());
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
    fn a_tick_takes_few_orders_that_are_long_and_no_landing_waits_for_them() {
        let (orders, controls) =
            Orders::new(VehicleName::default(), Ending::default().begin_flight());
        let long = Commands::parse("commands", &"hold 0\n".repeat(STEPS_PER_TICK)).unwrap();
        for _ in 0..2 {
            controls.order(BY, OperatorOrder::Append(long.clone())).unwrap();
        }
        controls.order(BY, OperatorOrder::Land).unwrap();
        let names = || orders.poll().map(|request| request.order.name()).collect::<Vec<_>>();
        assert_eq!([names(), names(), names()], [vec!["append", "land"], vec!["append"], vec![]]);
    }

    #[test]
    fn a_flight_that_is_over_hears_nothing() {
        let (orders, controls) =
            Orders::new(VehicleName::default(), Ending::default().begin_flight());
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
        let (orders, controls) =
            Orders::new(VehicleName::default(), Ending::default().begin_flight());
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
