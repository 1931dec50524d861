//! The client's side of the protocol: a state machine with time and bytes as inputs.
//!
//! A shell owns the sockets and the clock. It passes everything that arrives to [`Session::handle`]: navdata
//! datagrams, bytes from the control port, requests, and every 30 ms a tick with its order. After each input
//! it polls the outputs ([`Session::poll`]): datagrams for the drone, events, and decoded navdata.
//!
//! Rules of the drone that are enforced here (from Parrot's developer guide and the experience of other
//! clients):
//! - REF and PCMD are levels and must be in every datagram.
//! - The drone always accepts sequence number 1, and other numbers only if they are greater than the last. So
//!   that any datagram may be lost, every one starts with number 1 until the drone shows that it receives
//!   them; from then on numbers only rise, also after a loss and after a restart of the drone. Where a landing is
//!   not obeyed for a second every other datagram starts with number 1 again: another client may have counted
//!   further than we can know.
//! - A drone that has restarted or was lost must never take off because of an old order: the take-off bit is
//!   withheld until take-off is ordered again.
//! - Navdata whose sequence number is not higher than the last is dropped, unless the drone has evidently
//!   restarted.

mod config;
mod emergency;
mod handshake;
mod protocol;
mod sequence;
mod settings;
mod silence;
mod take_off;
mod tick;

use std::collections::VecDeque;
use std::time::Duration;

pub use self::config::SessionConfig;
use self::emergency::{EmergencySwitch, EmergencyWish};
pub use self::protocol::{Event, FlightOrder, Input, Order, Output, Request, Statistics, Transmit};
use self::sequence::SequenceNumbers;
use self::settings::Settings;
use self::silence::Heard;
use self::take_off::TakeOffLatch;
use crate::at::Datagram;
use crate::navdata::{ControlState, DroneState, Navdata, NavdataError};

/// Event queue capacity; preallocated, because a tick must not allocate.
const EVENTS: usize = 32;

/// A client's session with one drone.
#[derive(Debug)]
pub struct Session {
    timeouts: Timeouts,
    link: Link,
    settings: Settings,
    sequence: SequenceNumbers,
    state: DroneState,
    last_navdata: Option<Heard>,
    last_wake_up: Option<Duration>,
    flat_trim_due: bool,
    take_off: TakeOffLatch,
    /// Start of a take-off order to a drone on the ground.
    taking_off_since: Option<Duration>,
    /// Start of a landing order to a drone in the air, and whether it has begun to land.
    landing_since: Option<Duration>,
    lands: bool,
    /// The final landing orders have begun, see [`Input::Part`].
    parts: bool,
    emergency: EmergencySwitch,
    /// Datagram of the last tick; its buffer is allocated once.
    datagram: Datagram,
    events: VecDeque<Event>,
    pending: Pending,
    statistics: Statistics,
}

/// Limits of a session's configuration that are checked in each tick.
#[derive(Debug, Clone, Copy)]
struct Timeouts {
    wake_up: Duration,
    loss: Duration,
    take_off: Duration,
}

/// Outputs besides events that have not been polled yet.
#[derive(Debug, Default)]
struct Pending {
    command: bool,
    wake_up: bool,
    /// Result of the last datagram that was not stale.
    received: Option<Result<Navdata, NavdataError>>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Link {
    /// No navdata yet, or none since a loss.
    Silent,
    Alive,
}

impl Session {
    /// A session that has not received anything yet.
    pub fn new(config: SessionConfig) -> Self {
        Self {
            timeouts: Timeouts {
                wake_up: config.wake_up_interval,
                loss: config.loss_timeout,
                take_off: config.take_off_timeout,
            },
            link: Link::Silent,
            settings: Settings::new(config.settings, config.identity, config.read_back),
            sequence: SequenceNumbers::new(),
            state: DroneState::empty(),
            last_navdata: None,
            last_wake_up: None,
            flat_trim_due: false,
            take_off: TakeOffLatch::default(),
            taking_off_since: None,
            landing_since: None,
            lands: false,
            parts: false,
            emergency: EmergencySwitch::default(),
            datagram: Datagram::new(),
            events: VecDeque::with_capacity(EVENTS),
            pending: Pending::default(),
            statistics: Statistics::default(),
        }
    }

    /// Handles one input. `now` is the time since any fixed moment and must not run backwards. Poll the
    /// outputs before the next input: a datagram or packet that was not polled is replaced by the next.
    pub fn handle(&mut self, now: Duration, input: Input<'_>) {
        match input {
            Input::Navdata(datagram) => self.handle_navdata(now, datagram),
            Input::Control(bytes) => self.settings.handle_control(bytes, &mut self.events),
            Input::Request(request) => self.handle_request(request),
            Input::Tick(order) => self.with_datagram(|session| session.tick(now, order)),
            Input::Listen => self.with_datagram(|session| session.listen(now)),
            Input::Part => self.with_datagram(|session| session.part(now)),
        }
    }

    /// The next output: datagrams first, because they must not wait for the rest, and navdata before the
    /// events that they led to. Call it after each input until it returns `None`.
    pub fn poll(&mut self) -> Option<Output<'_>> {
        if self.pending.command || self.pending.wake_up {
            return self.poll_transmit().map(Output::Transmit);
        }
        match self.pending.received.take() {
            Some(Ok(navdata)) => Some(Output::Navdata(navdata)),
            Some(Err(error)) => Some(Output::Damaged(error)),
            None => self.events.pop_front().map(Output::Event),
        }
    }

    /// The next datagram to send, the command first.
    pub fn poll_transmit(&mut self) -> Option<Transmit<'_>> {
        if std::mem::take(&mut self.pending.command) {
            return Some(Transmit::Command(self.datagram.as_bytes()));
        }
        std::mem::take(&mut self.pending.wake_up).then_some(Transmit::WakeUp)
    }

    /// The datagram of the last tick; empty if nothing was to be sent.
    pub fn datagram(&self) -> &[u8] {
        self.datagram.as_bytes()
    }

    /// Whether the drone is connected and [`Event::Ready`] has been said of it.
    pub fn is_ready(&self) -> bool {
        self.link == Link::Alive && self.settings.are_applied()
    }

    /// Whether the drone is connected.
    pub fn is_alive(&self) -> bool {
        self.link == Link::Alive
    }

    /// The state bits of the newest accepted packet; none before the first.
    pub fn state(&self) -> DroneState {
        self.state
    }

    /// Time since the newest accepted packet; `None` if there was none.
    pub fn silence(&self, now: Duration) -> Option<Duration> {
        self.last_navdata.map(|heard| now.saturating_sub(heard.at))
    }

    /// Shortest time from a setting to its acknowledgement, since all settings were last applied: the time on the link
    /// there and back, besides what the drone needed and up to one interval of navdata.
    pub fn round_trip(&self) -> Option<Duration> {
        self.settings.round_trip()
    }

    /// Counters since the start.
    pub fn statistics(&self) -> Statistics {
        self.statistics
    }

    /// Runs a tick, which fills the empty datagram.
    fn with_datagram(&mut self, tick: impl FnOnce(&mut Self)) {
        self.datagram.clear();
        tick(self);
        self.pending.command = !self.datagram.as_bytes().is_empty();
    }

    fn handle_request(&mut self, request: Request) {
        match request {
            Request::Setting(config) => self.settings.request(config),
            Request::AllSettings => self.settings.apply_again(),
            Request::FlatTrim => self.flat_trim_due = true,
            Request::EmergencyStop => {
                self.take_off.withhold();
                self.emergency.request(EmergencyWish::Stop);
            }
            Request::Insist => self.sequence.insist(),
            Request::EmergencyReset => self.emergency.request(EmergencyWish::Reset),
        }
    }

    fn handle_navdata(&mut self, now: Duration, datagram: &[u8]) {
        let navdata = match Navdata::decode(datagram) {
            Ok(navdata) => navdata,
            Err(error) => {
                self.statistics.damaged += 1;
                self.pending.received = Some(Err(error));
                return;
            }
        };
        if let Some(last) = self.last_navdata.filter(|_| self.link == Link::Alive)
            && navdata.sequence <= last.sequence
        {
            if !last.is_before_restart(now, &navdata) {
                self.statistics.stale += 1;
                return;
            }
            self.events.push_back(Event::DroneRestarted);
            self.state = DroneState::empty();
            self.configure_anew();
        }
        let returned_at = self.last_navdata.and_then(|last| last.returned_at(now));
        let bootstrapping = navdata.state.contains(DroneState::NAVDATA_BOOTSTRAP);
        let sequence = navdata.sequence;
        self.last_navdata = Some(Heard { at: now, sequence, bootstrapping, returned_at });
        self.statistics.received += 1;
        if self.link == Link::Silent {
            self.link = Link::Alive;
            self.events.push_back(Event::Connected);
        }
        self.watch_state(&navdata);
        if bootstrapping && self.settings.are_applied() {
            // The drone has lost its client and waits to be configured again.
            self.configure_anew();
        }
        let acknowledged = self.settings.handle_state(now, navdata.state, &mut self.events);
        self.sequence.confirm(acknowledged);
        self.pending.received = Some(Ok(navdata));
    }

    /// The drone has lost its configuration, and older orders with it.
    fn configure_anew(&mut self) {
        self.take_off.withhold();
        self.settings.apply_again();
    }

    fn watch_state(&mut self, navdata: &Navdata) {
        let emergency = |state: DroneState| state.contains(DroneState::EMERGENCY);
        match (emergency(self.state), emergency(navdata.state)) {
            (false, true) => {
                self.events.push_back(Event::Emergency);
                self.take_off.withhold();
            }
            (true, false) => self.events.push_back(Event::EmergencyCleared),
            _ => {}
        }
        let flying = |state: DroneState| state.contains(DroneState::FLYING);
        match (flying(self.state), flying(navdata.state)) {
            (false, true) => {
                // The drone obeys the take-off order, so it receives our commands.
                self.sequence.confirm(self.taking_off_since.is_some());
                self.events.push_back(Event::Airborne);
            }
            // With its motors cut it falls instead of landing.
            (true, false) if !emergency(navdata.state) => self.events.push_back(Event::Landed),
            _ => {}
        }
        self.state = navdata.state;
        let reports = |state| navdata.demo.is_some_and(|demo| demo.control_state == state);
        self.lands = reports(ControlState::Landing);
        self.take_off.observe(flying(navdata.state), reports(ControlState::Landed));
    }
}

#[cfg(test)]
mod tests;
