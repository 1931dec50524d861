//! Inputs and outputs of the vehicle. They are the same for a flight over UDP, a simulated flight and a
//! replay; recording is a tee on both.

use std::sync::Arc;
use std::time::Duration;

use ardrone_link::session;

use super::{
    Decision, FlightEvent, FlightReport, NotReady, Operator, OperatorOrder, Refused, Stage, Status,
    Vehicle, Waypoint,
};
use crate::outcome::Outcome;
use crate::plan::{MissionId, Step};
use crate::separation::Neighbour;

/// Ticks between two status.
const STATUS_TICKS: u32 = 3;

/// An input of the vehicle.
#[derive(Debug, Clone, PartialEq)]
pub enum Input<'a> {
    /// A datagram from the drone's navdata port.
    Navdata(&'a [u8]),
    /// Bytes from the drone's control port.
    Control(&'a [u8]),
    /// An operator's order.
    Order(Operator, OperatorOrder),
    /// Another vehicle in the same room tells of itself.
    Neighbour(Neighbour),
    /// It is time to decide what the drone shall do: once every [`TICK`](super::TICK).
    Tick,
    /// Likewise for a program that is about to exit: the session alone orders the landing, so that it works whatever state
    /// the agent and the estimator are in. See [`session::Input::Part`].
    Part,
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

/// What the vehicle tells whoever watches it.
#[derive(Debug, Clone, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "a box would be asked for in flight")]
pub enum Telemetry {
    /// Something happened.
    Event(FlightEvent),
    /// The mission has changed.
    Mission {
        /// Name of the loaded plan; empty without one.
        name: String,
        /// The number that its maker gave it; none for a plan, and once it is extended.
        id: Option<MissionId>,
        /// All its steps.
        steps: Vec<Step>,
        /// How many of them are done, in the current or last flight; `None` if they are for the next one.
        steps_done: Option<usize>,
    },
    /// A target of the mission was reached and held for its stay time.
    Waypoint(Waypoint),
    /// The reasons not to take off have changed; all of them.
    Readiness(Arc<[NotReady]>),
    /// Several times a second.
    Status(Status),
    /// A flight has ended: the last that is told of it.
    Ended(Outcome, Arc<FlightReport>),
}

/// An output of the vehicle.
#[derive(Debug, Clone, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "a box would be asked for in flight")]
pub enum Output<'a> {
    /// A datagram for the drone.
    Transmit(Transmit<'a>),
    /// What is told.
    Telemetry(Telemetry),
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
    pub(super) status: bool,
    /// Ticks since the last status.
    ticks: u32,
    /// Time of the last tick.
    at: Duration,
    /// Number of this flight's waypoints that have been polled.
    pub(super) waypoints: usize,
}

impl Pending {
    /// Begins a tick. A datagram that was not sent is outdated.
    fn begin_tick(&mut self, now: Duration) {
        (self.command, self.wake_up) = (false, false);
        self.status |= self.ticks.is_multiple_of(STATUS_TICKS);
        self.ticks = self.ticks.wrapping_add(1);
        self.at = now;
    }
}

impl Vehicle {
    /// Handles an input. `now` is the time since the program started, and must not run backwards. What arrives takes effect in
    /// the next tick; poll the outputs after each tick.
    ///
    /// # Errors
    /// [`Refused`] for an order that is not accepted, a datagram that is damaged or old, and a neighbour that is not believed.
    /// Nothing has changed then but counts, with three exceptions: an operator to whom the controls were due has them, whatever
    /// else the order was refused for; a neighbour that [`Jumps`](crate::separation::NotHeard::Jumps) is kept apart from; and the
    /// flight of a drone that is down for good ends before an order that changes the mission, as the next tick would end it.
    pub fn handle(&mut self, now: Duration, input: Input<'_>) -> Result<(), Refused> {
        self.handle_timed(now, input, |_| {})
    }

    /// As [`Vehicle::handle`]; `done` is called at the end of each stage of a tick.
    ///
    /// # Errors
    /// As [`Vehicle::handle`].
    pub fn handle_timed(
        &mut self,
        now: Duration,
        input: Input<'_>,
        done: impl FnMut(Stage),
    ) -> Result<(), Refused> {
        match input {
            Input::Navdata(datagram) => return self.handle_navdata(now, datagram),
            Input::Control(bytes) => self.handle_control(now, bytes),
            Input::Order(by, order) => return self.order(now, by, order),
            Input::Neighbour(neighbour) => return self.hear(neighbour),
            Input::Tick => {
                self.pending.begin_tick(now);
                self.decide(now, done);
            }
            Input::Part => {
                self.session.handle(now, session::Input::Part);
                let transmit = self.session.poll_transmit();
                let command = matches!(transmit, Some(session::Transmit::Command(_)));
                self.pending = Pending { command, ..Pending::default() };
            }
        }
        Ok(())
    }

    /// The next output, until there is none. The command comes first, because it must not wait for the rest.
    pub fn poll(&mut self) -> Option<Output<'_>> {
        if std::mem::take(&mut self.pending.command) {
            let datagram = self.session.datagram();
            let decision = self.decision.as_ref();
            return Some(Output::Transmit(Transmit::Command { datagram, decision }));
        }
        if std::mem::take(&mut self.pending.wake_up) {
            return Some(Output::Transmit(Transmit::WakeUp));
        }
        self.poll_telemetry().map(Output::Telemetry)
    }

    fn poll_telemetry(&mut self) -> Option<Telemetry> {
        // Before anything of the flight that has begun since.
        if let Some((outcome, report)) = self.untold.pop_front() {
            return Some(Telemetry::Ended(outcome, report));
        }
        if std::mem::take(&mut self.pending.mission) {
            return Some(Telemetry::Mission {
                name: self.mission.name().to_owned(),
                id: self.mission.id(),
                steps: self.mission.steps().to_vec(),
                steps_done: self.steps_done(),
            });
        }
        if let Some(event) = self.events.pop_front() {
            return Some(Telemetry::Event(event));
        }
        if let Some(waypoint) = self.flight.report().waypoints.get(self.pending.waypoints) {
            self.pending.waypoints += 1;
            return Some(Telemetry::Waypoint(*waypoint));
        }
        if std::mem::take(&mut self.pending.readiness) {
            return Some(Telemetry::Readiness(Arc::clone(&self.readiness)));
        }
        if std::mem::take(&mut self.pending.status) {
            return Some(Telemetry::Status(self.status(self.pending.at)));
        }
        let (outcome, report) = self.end_to_tell()?;
        Some(Telemetry::Ended(outcome, report))
    }

    /// The end of this flight, unless it was told already.
    pub(super) fn end_to_tell(&mut self) -> Option<(Outcome, Arc<FlightReport>)> {
        let outcome = self.flight.outcome.as_ref();
        let outcome = outcome.filter(|_| std::mem::take(&mut self.pending.outcome))?.clone();
        Some((outcome, Arc::clone(self.flight.report())))
    }
}
