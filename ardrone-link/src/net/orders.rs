//! The client's order for each tick, and how each call ends. Pure: times and the session's state are inputs.

use std::time::Duration;

use tokio::sync::oneshot;

use super::error::{FlightError, Refusal};
use super::limits::{EMERGENCY_LIMIT, Limits};
use crate::at::Motion;
use crate::navdata::{ControlState, DroneState};
use crate::session::{Event, FlightOrder, Order};

/// Channel on which a caller learns how its order ended.
pub(super) type Reply = oneshot::Sender<Result<(), FlightError>>;

/// For this time after the last take-off order, a drone on the ground may still be about to take off.
const SETTLE: Duration = Duration::from_secs(1);

/// The drone's state as known to the session.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Seen {
    /// Navdata arrived within the loss timeout.
    pub(super) alive: bool,
    /// Connected and configured.
    pub(super) ready: bool,
    pub(super) state: DroneState,
    /// Control state, if the newest packet contains it.
    pub(super) control_state: Option<ControlState>,
    pub(super) battery_percent: Option<u32>,
    /// Arrival of the newest packet.
    pub(super) heard_at: Option<Duration>,
}

impl Seen {
    fn flies(&self) -> bool {
        self.state.contains(DroneState::FLYING)
    }

    fn is_in_emergency(&self) -> bool {
        self.state.contains(DroneState::EMERGENCY)
    }

    /// In the air, and past the automatic climb of the take-off.
    fn hovers(&self) -> bool {
        let complete =
            matches!(self.control_state, Some(ControlState::Hovering | ControlState::Flying));
        self.flies() && complete
    }

    /// On the ground, and not about to take off.
    pub(super) fn stands(&self) -> bool {
        let moves = matches!(
            self.control_state,
            Some(
                ControlState::TakingOff
                    | ControlState::Flying
                    | ControlState::Hovering
                    | ControlState::GoingToFixPoint
                    | ControlState::Landing
                    | ControlState::Looping
            )
        );
        !self.flies() && !moves
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Flight {
    /// Landing is ordered; the initial state.
    Down,
    TakingOff {
        deadline: Duration,
        /// The session has had a landing order first, which makes the take-off a new order.
        renewed: bool,
    },
    Airborne,
}

#[derive(Debug)]
struct Waiting {
    since: Duration,
    deadline: Duration,
    reply: Reply,
}

#[derive(Debug, Clone, Copy)]
struct Steered {
    since: Duration,
    duration: Duration,
    motion: Motion,
}

#[derive(Debug)]
pub(super) struct Orders {
    limits: Limits,
    flight: Flight,
    steered: Option<Steered>,
    taking_off: Vec<Reply>,
    landing: Vec<Waiting>,
    stopping: Vec<Waiting>,
    resetting: Vec<Waiting>,
    take_off_sent: Option<Duration>,
}

impl Orders {
    pub(super) fn new(limits: Limits) -> Self {
        Self {
            limits,
            flight: Flight::Down,
            steered: None,
            taking_off: Vec::new(),
            landing: Vec::new(),
            stopping: Vec::new(),
            resetting: Vec::new(),
            take_off_sent: None,
        }
    }

    /// A take-off has completed, and nothing has ended the flight since.
    pub(super) fn is_airborne(&self) -> bool {
        self.flight == Flight::Airborne
    }

    /// The order for this tick.
    pub(super) fn order(&mut self, now: Duration, seen: &Seen) -> Order {
        match &mut self.flight {
            Flight::Down => Order::LAND,
            Flight::TakingOff { renewed, .. } if !*renewed => {
                *renewed = true;
                Order::LAND
            }
            Flight::TakingOff { .. } => {
                self.take_off_sent = Some(now);
                // Once the drone flies, it is no longer sent an order that could lift it again after a landing.
                let flight =
                    if seen.flies() { FlightOrder::StayAirborne } else { FlightOrder::TakeOff };
                Order { flight, motion: Motion::Hover }
            }
            Flight::Airborne => {
                self.take_off_sent = Some(now);
                let steered = self.steered.filter(|it| now.saturating_sub(it.since) < it.duration);
                let motion = steered.map_or(Motion::Hover, |steered| steered.motion);
                Order { flight: FlightOrder::StayAirborne, motion }
            }
        }
    }

    pub(super) fn take_off(&mut self, now: Duration, seen: &Seen, reply: Reply) {
        // A caller that has stopped waiting does not want the take-off.
        if reply.is_closed() {
            return;
        }
        match self.flight {
            Flight::Airborne => answer(reply, Ok(())),
            Flight::TakingOff { .. } => self.taking_off.push(reply),
            Flight::Down => {
                if let Some(refusal) = refusal(seen) {
                    return answer(reply, Err(refusal.into()));
                }
                let deadline = now.saturating_add(self.limits.take_off);
                self.flight = Flight::TakingOff { deadline, renewed: false };
                self.steered = None;
                self.taking_off.push(reply);
            }
        }
    }

    pub(super) fn land(&mut self, now: Duration, reply: Reply) {
        self.come_down(&FlightError::Landing);
        let deadline = now.saturating_add(self.limits.landing);
        self.landing.push(Waiting { since: now, deadline, reply });
    }

    pub(super) fn stop(&mut self, now: Duration, reply: Reply) {
        self.come_down(&FlightError::Emergency);
        let deadline = now.saturating_add(EMERGENCY_LIMIT);
        self.stopping.push(Waiting { since: now, deadline, reply });
    }

    pub(super) fn reset(&mut self, now: Duration, reply: Reply) {
        let deadline = now.saturating_add(EMERGENCY_LIMIT);
        self.resetting.push(Waiting { since: now, deadline, reply });
    }

    /// Steers a drone in flight from `since` for `duration`; [`Motion::Hover`] ends steering.
    pub(super) fn steer(&mut self, since: Duration, duration: Duration, motion: Motion) {
        if self.is_airborne() {
            self.steered = Some(Steered { since, duration, motion });
        }
    }

    /// Handles an event of the session.
    pub(super) fn event(&mut self, event: &Event, seen: &Seen) {
        let error = match event {
            Event::LinkLost => FlightError::LinkLost,
            Event::DroneRestarted => FlightError::DroneRestarted,
            Event::Emergency => FlightError::Emergency,
            Event::Landed => FlightError::Landing,
            Event::TakeOffTimedOut => self.take_off_timed_out(seen),
            _ => return,
        };
        self.come_down(&error);
        // The end of a landing is detected from the drone's state, below.
        if matches!(event, Event::LinkLost | Event::DroneRestarted | Event::Emergency) {
            answer_all(&mut self.landing, &error);
        }
        if *event == Event::LinkLost {
            answer_all(&mut self.stopping, &error);
            answer_all(&mut self.resetting, &error);
        }
    }

    /// Updates the state, and answers callers whose order has ended or timed out.
    pub(super) fn observe(&mut self, now: Duration, seen: &Seen) {
        if self.flight != Flight::Down && !seen.ready {
            self.come_down(&FlightError::LinkLost);
        }
        if let Flight::TakingOff { deadline, .. } = self.flight {
            self.taking_off.retain(|reply| !reply.is_closed());
            if seen.hovers() {
                self.flight = Flight::Airborne;
                for reply in self.taking_off.drain(..) {
                    answer(reply, Ok(()));
                }
            } else if now >= deadline {
                let error = self.take_off_timed_out(seen);
                self.come_down(&error);
            } else if self.taking_off.is_empty() {
                // A program that has stopped waiting does not know that its drone is in the air.
                self.flight = Flight::Down;
            }
        }
        self.watch_landing(now, seen);
        let limit = EMERGENCY_LIMIT;
        let cut = seen.is_in_emergency();
        for (waiting, done) in [(&mut self.stopping, cut), (&mut self.resetting, !cut)] {
            settle(waiting, now, &FlightError::EmergencyTimedOut { limit }, |waiting| {
                (done && heard_since(seen, waiting.since)).then_some(Ok(()))
            });
        }
    }

    fn watch_landing(&mut self, now: Duration, seen: &Seen) {
        let settled = self.take_off_sent.is_none_or(|sent| now.saturating_sub(sent) >= SETTLE);
        let timed_out = FlightError::LandingTimedOut { limit: self.limits.landing };
        settle(&mut self.landing, now, &timed_out, |waiting| {
            if !seen.alive {
                Some(Err(FlightError::LinkLost))
            } else if !heard_since(seen, waiting.since) {
                None
            } else if seen.is_in_emergency() {
                Some(Err(FlightError::Emergency))
            } else {
                (settled && seen.stands()).then_some(Ok(()))
            }
        });
    }

    /// Drops all callers' channels, by which they learn that the client has ended.
    pub(super) fn end(&mut self) {
        self.flight = Flight::Down;
        self.taking_off.clear();
        for waiting in [&mut self.landing, &mut self.stopping, &mut self.resetting] {
            waiting.clear();
        }
    }

    fn take_off_timed_out(&self, seen: &Seen) -> FlightError {
        let (limit, battery_percent) = (self.limits.take_off, seen.battery_percent);
        FlightError::TakeOffTimedOut { limit, battery_percent }
    }

    /// Orders the landing from now on, and fails a take-off in progress.
    fn come_down(&mut self, error: &FlightError) {
        self.flight = Flight::Down;
        self.steered = None;
        for reply in self.taking_off.drain(..) {
            answer(reply, Err(error.clone()));
        }
    }
}

/// Why a take-off must be refused.
fn refusal(seen: &Seen) -> Option<Refusal> {
    // The emergency comes first, because it needs attention.
    if seen.is_in_emergency() {
        Some(Refusal::Emergency)
    } else if !seen.ready {
        Some(Refusal::NotReady)
    } else if !seen.stands() {
        Some(Refusal::Landing)
    } else if seen.state.contains(DroneState::BATTERY_LOW) {
        Some(Refusal::BatteryLow)
    } else {
        None
    }
}

fn heard_since(seen: &Seen, since: Duration) -> bool {
    seen.heard_at.is_some_and(|at| at > since)
}

/// Answers a caller, which may have stopped waiting.
fn answer(reply: Reply, result: Result<(), FlightError>) {
    _ = reply.send(result);
}

fn answer_all(waiting: &mut Vec<Waiting>, error: &FlightError) {
    for waiting in waiting.drain(..) {
        answer(waiting.reply, Err(error.clone()));
    }
}

/// Answers callers whose order has ended, and those that have timed out.
fn settle(
    all: &mut Vec<Waiting>,
    now: Duration,
    timed_out: &FlightError,
    end: impl Fn(&Waiting) -> Option<Result<(), FlightError>>,
) {
    let late = |waiting: &Waiting| (now >= waiting.deadline).then(|| Err(timed_out.clone()));
    for waiting in std::mem::take(all) {
        match end(&waiting).or_else(|| late(&waiting)) {
            Some(result) => answer(waiting.reply, result),
            None => all.push(waiting),
        }
    }
}

#[cfg(test)]
mod tests;
