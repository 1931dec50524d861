//! What goes into the vehicle and what comes out of it: the same for a flight over UDP, a simulated one and a
//! replay. Recording is a tee on both.

use std::time::Duration;

use ardrone_link::at::EncodeError;

use super::{Decision, FlightEvent, NotReady, Operator, OperatorOrder, Vehicle, Waypoint};
use crate::outcome::Outcome;
use crate::plan::Step;

/// Something that reaches the vehicle.
#[derive(Debug, Clone, PartialEq)]
pub enum Input<'a> {
    /// A datagram from the drone's navdata port.
    Navdata(&'a [u8]),
    /// Bytes from the drone's control port.
    Control(&'a [u8]),
    /// An operator's order. [`Vehicle::order`] says besides whether it was accepted.
    Order(Operator, OperatorOrder),
}

/// Something to send to the drone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Transmit<'a> {
    /// This tick's datagram, to the AT port, and the decision behind it. There is none until the drone is heard,
    /// nor while another pilot flies it: any REF of ours would land it, or fight for it.
    Command {
        /// AT commands, as they go on the wire.
        datagram: &'a [u8],
        /// Why.
        decision: Option<&'a Decision>,
    },
    /// [`ardrone_link::WAKE_UP`], to the navdata port.
    WakeUp,
}

/// Something that the vehicle says.
#[derive(Debug, Clone, PartialEq)]
pub enum Output<'a> {
    /// To the drone.
    Transmit(Transmit<'a>),
    /// Something has happened.
    Event(FlightEvent),
    /// The mission is another: all its steps.
    Mission(&'a [Step]),
    /// A target of the mission has been reached.
    Waypoint(Waypoint),
    /// Whether the vehicle could take off has changed: every reason why not.
    Readiness(&'a [NotReady]),
    /// The flight's outcome. Said once a flight; the last output of a tick.
    Ended(&'a Outcome),
}

/// What has not been polled yet.
#[allow(clippy::struct_excessive_bools, reason = "each is an output of its own")]
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Pending {
    pub(super) command: bool,
    pub(super) wake_up: bool,
    pub(super) mission: bool,
    pub(super) readiness: bool,
    pub(super) outcome: bool,
    /// Waypoints of this flight that have been said.
    pub(super) waypoints: usize,
}

impl Vehicle {
    /// Takes in one input. It is acted on in the next tick. `now` must not run backwards.
    pub fn handle(&mut self, now: Duration, input: Input<'_>) {
        match input {
            Input::Navdata(datagram) => self.handle_navdata(now, datagram),
            Input::Control(bytes) => self.handle_control(now, bytes),
            // What is refused changes nothing; whoever wants the reason calls `order`.
            Input::Order(by, order) => _ = self.order(now, by, order),
        }
    }

    /// The next tick is due, every [`TICK`](super::TICK): decides what the drone is to do. Then poll.
    ///
    /// # Errors
    /// See [`Session::tick`](ardrone_link::session::Session::tick).
    pub fn tick(&mut self, now: Duration) -> Result<(), EncodeError> {
        self.tick_timed(now, |_| {})
    }

    /// What is to be sent to the drone, first the command: it is not to wait for the rest.
    pub fn poll_transmit(&mut self) -> Option<Transmit<'_>> {
        if std::mem::take(&mut self.pending.command) {
            let datagram = self.datagram.as_bytes();
            return Some(Transmit::Command { datagram, decision: self.decision.as_ref() });
        }
        std::mem::take(&mut self.pending.wake_up).then_some(Transmit::WakeUp)
    }

    /// Everything that the vehicle says, what is to be sent first. To be called after each tick until there is
    /// nothing more.
    pub fn poll(&mut self) -> Option<Output<'_>> {
        if self.pending.command || self.pending.wake_up {
            return self.poll_transmit().map(Output::Transmit);
        }
        if std::mem::take(&mut self.pending.mission) {
            return Some(Output::Mission(self.mission.steps()));
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
