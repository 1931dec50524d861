//! Inputs and outputs of the vehicle. They are the same for a flight over UDP, a simulated flight and a
//! replay; recording is a tee on both.

use std::time::Duration;

use super::{Decision, FlightEvent, NotReady, Operator, OperatorOrder, Vehicle, Waypoint};
use crate::outcome::Outcome;
use crate::plan::{MissionId, Step};

/// An input of the vehicle.
#[derive(Debug, Clone, PartialEq)]
pub enum Input<'a> {
    /// A datagram from the drone's navdata port.
    Navdata(&'a [u8]),
    /// Bytes from the drone's control port.
    Control(&'a [u8]),
    /// An operator's order. Use [`Vehicle::order`] instead to learn whether it was accepted.
    Order(Operator, OperatorOrder),
}

/// Something to send to the drone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Transmit<'a> {
    /// Datagram of this tick for the AT port, with the decision behind it. There is none before the drone is
    /// heard, nor while another pilot flies it: a REF command would land the drone or compete with that
    /// pilot.
    Command {
        /// Encoded AT commands.
        datagram: &'a [u8],
        /// The decision that led to it.
        decision: Option<&'a Decision>,
    },
    /// [`ardrone_link::WAKE_UP`], to the navdata port.
    WakeUp,
}

/// An output of the vehicle.
#[derive(Debug, Clone, PartialEq)]
pub enum Output<'a> {
    /// A datagram for the drone.
    Transmit(Transmit<'a>),
    /// An event of the flight.
    Event(FlightEvent),
    /// The mission has changed.
    Mission {
        /// Name of the loaded plan; empty without one.
        name: &'a str,
        /// The number that its maker gave it; none for a plan, and once it is extended.
        id: Option<MissionId>,
        /// All its steps.
        steps: &'a [Step],
    },
    /// A target of the mission was reached.
    Waypoint(Waypoint),
    /// The reasons not to take off have changed; all of them.
    Readiness(&'a [NotReady]),
    /// The flight's outcome. Returned once per flight, as the last output of a tick.
    Ended(&'a Outcome),
}

/// Outputs that have not been polled yet.
#[allow(clippy::struct_excessive_bools, reason = "each is an output of its own")]
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Pending {
    pub(super) command: bool,
    pub(super) wake_up: bool,
    pub(super) mission: bool,
    pub(super) readiness: bool,
    pub(super) outcome: bool,
    /// Number of this flight's waypoints that have been polled.
    pub(super) waypoints: usize,
}

impl Vehicle {
    /// Handles one input, which takes effect in the next tick. `now` must not run backwards.
    pub fn handle(&mut self, now: Duration, input: Input<'_>) {
        match input {
            Input::Navdata(datagram) => self.handle_navdata(now, datagram),
            Input::Control(bytes) => self.handle_control(now, bytes),
            // A refused order changes nothing; callers who need the reason call `order`.
            Input::Order(by, order) => _ = self.order(now, by, order),
        }
    }

    /// Decides what the drone shall do. Call it every [`TICK`](super::TICK), then poll the outputs.
    pub fn tick(&mut self, now: Duration) {
        self.tick_timed(now, |_| {});
    }

    /// The next datagram to send. The command comes first, because it must not wait for the rest.
    pub fn poll_transmit(&mut self) -> Option<Transmit<'_>> {
        if std::mem::take(&mut self.pending.command) {
            let datagram = self.session.datagram();
            return Some(Transmit::Command { datagram, decision: self.decision.as_ref() });
        }
        std::mem::take(&mut self.pending.wake_up).then_some(Transmit::WakeUp)
    }

    /// The next output, datagrams first. Call it after each tick until it returns `None`.
    pub fn poll(&mut self) -> Option<Output<'_>> {
        if self.pending.command || self.pending.wake_up {
            return self.poll_transmit().map(Output::Transmit);
        }
        if std::mem::take(&mut self.pending.mission) {
            return Some(Output::Mission {
                name: self.mission.name(),
                id: self.mission.id(),
                steps: self.mission.steps(),
            });
        }
        if let Some(event) = self.events.pop_front() {
            return Some(Output::Event(event));
        }
        if let Some(waypoint) = self.flight.report.waypoints.get(self.pending.waypoints) {
            self.pending.waypoints += 1;
            return Some(Output::Waypoint(*waypoint));
        }
        if std::mem::take(&mut self.pending.readiness) {
            return Some(Output::Readiness(&self.readiness));
        }
        let outcome = self.flight.outcome.as_ref();
        outcome.filter(|_| std::mem::take(&mut self.pending.outcome)).map(Output::Ended)
    }
}
