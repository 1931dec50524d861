//! What a flight over UDP is connected to: the sockets, the operators, and the clock.

use std::time::{Duration, Instant};

use autopilot::separation::Neighbour;
use autopilot::vehicle::{Input, Operator, OperatorOrder, Stage, Transmit};
use mission_agent::Said;

use super::LinkSummary;
use super::control_port::ControlPort;
use super::link::{Link, Trouble};
use super::orders::{Orders, Request};
use super::room::{RemoteAgents, Seat};
use crate::drive::{Heard, NoRoom, Surroundings, Take};
use crate::realtime::Realtime;
use crate::timing::{TickHealth, TickRecorder, TickSummary};

/// Receive buffer, larger than any navdata packet.
const BUFFER_BYTES: usize = 8192;
/// Maximum datagrams read in a tick; more than the socket's buffer holds.
const DATAGRAMS_PER_TICK: u32 = 1000;
/// Datagrams read even by a tick that is late.
const DATAGRAMS_IF_LATE: u32 = 32;

/// Origin of the flight's time.
pub(super) fn clock() -> Instant {
    Instant::now()
}

/// The surroundings of a flight in real time.
#[derive(Debug)]
pub(super) struct RealTime {
    link: Link,
    orders: Orders,
    control_port: ControlPort,
    /// Where other vehicles are heard.
    seat: Option<Seat>,
    /// Where the agents of vehicles elsewhere are reached.
    remote_agents: Option<Box<dyn RemoteAgents>>,
    start: Instant,
    buffer: Vec<u8>,
    /// Datagrams read in this tick.
    taken: u32,
    /// Handling navdata has lasted beyond the tick's deadline.
    held_up: bool,
    ticks: TickRecorder,
    /// When the last stage of the tick ended.
    stage_ended: Duration,
    flooded_ticks: u64,
    /// To be reported; once per flight is enough.
    flood: Option<Trouble>,
    /// A first request to exit was handled.
    stopping: bool,
}

impl RealTime {
    pub(super) fn new(
        link: Link,
        orders: Orders,
        control_port: ControlPort,
        seat: Option<Seat>,
        remote_agents: Option<Box<dyn RemoteAgents>>,
    ) -> Self {
        Self {
            link,
            orders,
            control_port,
            seat,
            remote_agents,
            start: clock(),
            buffer: vec![0_u8; BUFFER_BYTES],
            taken: 0,
            held_up: false,
            ticks: TickRecorder::default(),
            stage_ended: Duration::ZERO,
            flooded_ticks: 0,
            flood: None,
            stopping: false,
        }
    }

    /// Begins its time.
    pub(super) fn restart(&mut self) {
        self.start = clock();
    }

    /// Ends the measurement of a tick; returns the timing since the last one.
    pub(super) fn end_tick(&mut self) -> TickHealth {
        self.ticks.end();
        self.ticks.health()
    }

    /// The next problem to report.
    pub(super) fn poll_trouble(&mut self) -> Option<Trouble> {
        self.link.poll_trouble().or_else(|| self.flood.take())
    }

    /// How often the exit was requested.
    pub(super) fn stops(&self) -> u32 {
        self.orders.stops()
    }

    pub(super) fn summary(&self, realtime: Realtime) -> TickSummary {
        self.ticks.summary(realtime)
    }

    pub(super) fn link_summary(&self) -> LinkSummary {
        let (errors, bound_anew) = self.link.failures();
        let flooded_ticks = self.flooded_ticks;
        LinkSummary { errors, bound_anew, flooded_ticks, ..LinkSummary::default() }
    }

    /// Tells the other vehicles of this one.
    pub(super) fn tell(&self, neighbour: Option<Neighbour>) {
        if let (Some(seat), Some(neighbour)) = (&self.seat, neighbour) {
            seat.tell(self.start, neighbour);
        }
    }

    /// Tells them that its drone stays where it is, on the ground.
    pub(super) fn park(&self) {
        if let Some(seat) = &self.seat {
            seat.park();
        }
    }

    /// Sends a datagram of AT commands; returns whether the system accepted it.
    pub(super) fn send_datagram(&mut self, now: Duration, datagram: &[u8]) -> bool {
        self.link.send(now, datagram)
    }

    /// Handles incoming navdata until the next tick is due.
    fn receive_navdata(&mut self, begun: Duration, until: Duration, take: &mut impl Take) {
        let mut now = begun;
        while now < until {
            if self.taken >= DATAGRAMS_PER_TICK {
                // Leaves the rest of the tick to other threads.
                self.link.rest();
                if self.flooded_ticks == 0 {
                    self.flood = Some(Trouble::Flood);
                }
                self.flooded_ticks += 1;
                break;
            }
            if !self.receive_datagram(now, take) {
                break;
            }
            now = self.now();
        }
        self.held_up = begun < until && self.now() >= until;
    }

    /// Returns whether there was a datagram.
    fn receive_datagram(&mut self, now: Duration, take: &mut impl Take) -> bool {
        let Some(length) = self.link.receive(now, &mut self.buffer) else { return false };
        self.taken += 1;
        // What is damaged is only counted.
        _ = take(now, Input::Navdata(self.buffer.get(..length).unwrap_or_default()));
        true
    }

    fn receive_orders(&mut self, now: Duration, take: &mut impl Take) {
        if let Some(seat) = &mut self.seat {
            for neighbour in seat.hear(self.start, now) {
                // What is not believed is recorded, and its vehicle avoided as one that is not heard.
                _ = take(now, Input::Neighbour(neighbour));
            }
        }
        for bytes in self.control_port.poll() {
            _ = take(now, Input::Control(&bytes));
        }
        for Request { by, order, answer } in self.orders.poll() {
            let answered = take(now, Input::Order(by, order));
            if let Some(answer) = answer {
                answer(answered);
            }
        }
        if self.stops() > 0 && !std::mem::replace(&mut self.stopping, true) {
            // Landing is never refused.
            _ = take(now, Input::Order(Operator::TERMINAL, OperatorOrder::Land));
        }
    }
}

impl Surroundings for RealTime {
    fn now(&self) -> Duration {
        self.start.elapsed()
    }

    fn wait(&mut self, until: Duration) {
        let rest = until.saturating_sub(self.now());
        if !rest.is_zero() {
            self.link.wait(rest);
        }
    }

    fn begin_tick(&mut self, now: Duration, deadline: Duration, missed: u64) {
        self.ticks.begin(now, deadline, missed, std::mem::take(&mut self.held_up));
        self.link.begin_tick();
        self.taken = 0;
    }

    fn receive(&mut self, now: Duration, until: Option<Duration>, mut take: impl Take) {
        if let Some(until) = until {
            self.receive_navdata(now, until, &mut take);
        } else {
            // Navdata that arrived before a tick that is late, so that it does not decide without them.
            for _ in 0..DATAGRAMS_IF_LATE {
                if !self.receive_datagram(self.now(), &mut take) {
                    break;
                }
            }
        }
        self.stage_ended = self.now();
        self.ticks.spend(Stage::Estimate, self.stage_ended.saturating_sub(now));
        if until.is_none() {
            self.receive_orders(now, &mut take);
            self.stage_ended = self.now();
        }
    }

    fn done(&mut self, stage: Stage) {
        let now = self.now();
        self.ticks.spend(stage, now.saturating_sub(self.stage_ended));
        self.stage_ended = now;
    }

    fn send(&mut self, now: Duration, transmit: Transmit<'_>) {
        match transmit {
            Transmit::Command { datagram, .. } => _ = self.link.send(now, datagram),
            Transmit::WakeUp => self.link.wake_up(now),
        }
        self.done(Stage::Send);
    }

    fn hear(&mut self) -> Option<Heard> {
        let near = self.seat.as_ref().and_then(Seat::next_line);
        let mut far = || self.remote_agents.as_mut()?.next_line();
        let near = near.map(|line| Heard { line, is_far: false });
        near.or_else(|| far().map(|line| Heard { line, is_far: true }))
    }

    fn say(&mut self, said: Said) -> Result<(), NoRoom> {
        match (self.seat.as_ref().and_then(|seat| seat.say(said)), &mut self.remote_agents) {
            (Some(taken), _) => taken,
            (None, Some(far)) => far.say(&said),
            // Nobody is there who could hear it.
            (None, None) => Ok(()),
        }
    }
}
