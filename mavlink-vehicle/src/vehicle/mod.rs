//! The vehicle as its `MAVLink` clients see it: datagrams in, datagrams and orders out.
//!
//! [`MavlinkVehicle`] is a pure state machine. The shell passes in what arrives ([`MavlinkVehicle::handle`]): datagrams, what
//! the vehicle tells of itself, and its answers to orders. Every 20 ms it calls [`MavlinkVehicle::tick`], and sends and orders
//! what comes out ([`MavlinkVehicle::poll`]). Sources: the MAVLink developer guide and PX4's documentation of flight modes.

mod arming;
mod commands;
mod flown;
mod following;
mod guided;
mod modes;
mod numbers;
mod orders;
mod parameters;
mod prearm;
mod protocol;
mod received;
mod schedule;
mod setpoints;
mod stations;
mod telemetry;
mod texts;

use std::collections::VecDeque;
use std::time::Duration;

use arrayvec::{ArrayString, ArrayVec};
use autopilot::vehicle::{
    FlightEvent, NotReady, Operator, OperatorOrder, Station as Kind, Status, Telemetry,
};

use autopilot::safety::Veto;

use self::arming::Arming;
use self::flown::Flown;
use self::following::{Following, Source};
use self::modes::{Doing, Mode};
use self::orders::Awaited;
use self::parameters::Parameters;
use self::prearm::Prearm;
pub use self::protocol::{Autopilot, Config, Input, Output, Ticket, To};
use self::schedule::Schedule;
use self::stations::Stations;
use self::texts::Texts;
use crate::dialect::{MISSION_ITEM_REACHED_DATA, MavMessage, MavSeverity};
use crate::frame::{Buffer, Encoder, LONGEST_FRAME, frames};
use crate::mission::{Rules, Transfer};
use crate::place::Origin;
use crate::signing::Signing;

/// Our component: an autopilot.
pub(crate) const COMPONENT: u8 = 1;
/// Messages that may wait to be sent.
const MESSAGES: usize = 256;
/// Orders that may wait to be given.
const ORDERS: usize = 32;
/// After this time without news of the vehicle nothing is told of it any more.
const NEWS_TIME: Duration = Duration::from_secs(3);

/// State machine of a `MAVLink` vehicle. Each `now` is the time since the beginning of the vehicle's time, at which it was
/// [`Config::unix_time`], and never goes back.
#[derive(Debug)]
pub struct MavlinkVehicle {
    config: Config,
    origin: Origin,
    encoder: Encoder,
    signing: Option<Signing>,
    messages: VecDeque<(To, MavMessage)>,
    orders: VecDeque<(Ticket, Operator, OperatorOrder)>,
    buffer: Buffer,
    texts: Texts,
    status: Option<(Duration, Status)>,
    /// Why the vehicle cannot take off; `None` until that is known, empty if it can.
    not_ready: Option<ArrayString<150>>,
    prearm: Prearm,
    stations: Stations,
    schedule: Schedule,
    parameters: Parameters,
    transfer: Transfer,
    flown: Flown,
    arming: Arming,
    following: Following,
    awaited: ArrayVec<Awaited, 16>,
    next_ticket: u32,
    /// Mode and arming that were told last.
    told: Option<(Mode, bool)>,
}

impl MavlinkVehicle {
    /// A vehicle of which nothing is known yet.
    pub fn new(config: Config) -> Self {
        let parameters = Parameters::new(&config);
        let origin = config.origin;
        let signing = config.key.clone().map(|key| Signing::new(key, 0, config.unix_time, 0));
        Self {
            origin,
            encoder: Encoder::new(config.system, COMPONENT),
            signing,
            messages: VecDeque::with_capacity(MESSAGES),
            orders: VecDeque::with_capacity(ORDERS),
            buffer: [0; LONGEST_FRAME],
            texts: Texts::default(),
            status: None,
            not_ready: None,
            prearm: Prearm::default(),
            stations: Stations::default(),
            schedule: Schedule::new(&config),
            parameters,
            transfer: Transfer::default(),
            flown: Flown::default(),
            arming: Arming::default(),
            following: Following::default(),
            awaited: ArrayVec::new(),
            next_ticket: 0,
            told: None,
            config,
        }
    }

    /// Handles what arrives. What follows from it comes out of [`Self::poll`].
    pub fn handle(&mut self, now: Duration, input: Input<'_>) {
        match input {
            Input::Datagram { peer, local, bytes } => {
                for frame in frames(bytes).flatten() {
                    self.receive(now, peer, local, &frame);
                }
            }
            Input::Telemetry(telemetry) => match telemetry {
                Telemetry::Status(status) => self.take_status(now, status),
                Telemetry::Readiness(reasons) => self.take_readiness(reasons),
                Telemetry::Event(event) => self.take_event(event),
                Telemetry::Mission { id, .. } => self.flown.recognise(*id),
                Telemetry::Waypoint(_) | Telemetry::Ended(..) => {}
            },
            Input::Answer { ticket, answer } => self.take_answer(now, ticket, &answer),
            Input::PeerGone(peer) => self.stations.forget_peer(peer),
        }
    }

    /// Time passes. Call this every 20 ms or so.
    pub fn tick(&mut self, now: Duration) {
        self.watch_orders(now);
        self.watch_arming(now);
        self.watch_stations(now);
        if let Some(partner) = self.transfer.uploading() {
            let handled = self.transfer.tick(now);
            self.transferred(partner, &handled);
        }
        if let Some(partner) = self.transfer.sending_fence() {
            let handled = self.transfer.tick_fence(now);
            self.transferred(partner, &handled);
        }
        if self.has_news(now) {
            self.tell_prearm(now);
            self.tell(now);
        }
    }

    /// The next datagram to send or order to give; `None` if there is nothing left to do. Orders come first. At most 256
    /// messages wait to be fetched; further ones are dropped.
    pub fn poll(&mut self, now: Duration) -> Option<Output<'_>> {
        if let Some((ticket, by, order)) = self.orders.pop_front() {
            return Some(Output::Order { ticket, by, order });
        }
        let (to, message) = match self.messages.pop_front() {
            Some(next) => next,
            None => (To::All, self.texts.next()?),
        };
        let bytes = self.encoder.encode(&message, self.signing.as_mut(), now, &mut self.buffer);
        Some(Output::Datagram { to, bytes })
    }

    /// Whether news of the vehicle are fresh enough to be passed on.
    fn has_news(&self, now: Duration) -> bool {
        self.status.as_ref().is_some_and(|(at, _)| now.saturating_sub(*at) <= NEWS_TIME)
    }

    fn present(&self) -> Option<&Status> {
        self.status.as_ref().map(|(_, status)| status)
    }

    fn send(&mut self, to: To, message: MavMessage) {
        // What nobody fetches is dropped.
        if self.messages.len() < MESSAGES {
            self.messages.push_back((to, message));
        }
    }

    fn say(&mut self, severity: MavSeverity, text: std::fmt::Arguments<'_>) {
        self.texts.say(severity, text);
    }

    fn error(&mut self, text: std::fmt::Arguments<'_>) {
        self.say(MavSeverity::MAV_SEVERITY_ERROR, text);
    }

    fn warn(&mut self, text: std::fmt::Arguments<'_>) {
        self.say(MavSeverity::MAV_SEVERITY_WARNING, text);
    }

    /// The rules by which missions are judged.
    fn rules(&self) -> Rules {
        Rules {
            origin: self.origin,
            fence: self.config.limits,
            max_speed_m_s: self.parameters.value(parameters::CRUISE_SPEED),
        }
    }

    fn take_status(&mut self, now: Duration, status: &Status) {
        let flew = self.is_flying();
        self.status = Some((now, *status));
        self.arming.controls = None;
        // Somebody elsewhere has stepped in, who does not expect that a take-off follows.
        if status.controls.is_some_and(|holder| holder.station != Kind::Mavlink) {
            self.arming.give_up();
        }
        let flies = self.is_flying();
        if let Some(step) = status.step {
            self.flown.at_step(step);
        }
        if flies {
            self.arming = Arming::default();
        } else if flew {
            self.disarm();
        }
    }

    fn take_readiness(&mut self, reasons: &[NotReady]) {
        let mut text = ArrayString::new();
        for reason in reasons {
            let separator = if text.is_empty() { "" } else { "; " };
            // What does not fit is cut.
            _ = std::fmt::Write::write_fmt(&mut text, format_args!("{separator}{reason}"));
        }
        if self.not_ready != Some(text) {
            self.prearm = Prearm::default();
        }
        self.not_ready = Some(text);
    }

    fn take_event(&mut self, event: &FlightEvent) {
        match event {
            FlightEvent::StepStarted { .. } => return,
            // Whoever takes the controls does not expect that another's take-off follows.
            FlightEvent::ControlsTaken { by } => self.arming = Arming::of_another(*by),
            FlightEvent::StepDone { step } => {
                if let Some(seq) = self.flown.step_done(*step) {
                    let reached = MISSION_ITEM_REACHED_DATA { seq };
                    self.send(To::All, MavMessage::MISSION_ITEM_REACHED(reached));
                }
                return;
            }
            _ => {}
        }
        if *event == FlightEvent::Veto(Veto::TargetOutside) && self.is_a_little_high() {
            // It holds where it is, which nobody has asked for.
            return;
        }
        if matches!(event, FlightEvent::LinkLost) && !self.is_flying() {
            // Nothing lands that is on the ground.
            return self.warn(format_args!("link lost"));
        }
        self.say(texts::severity(event), format_args!("{event}"));
    }

    /// Whether a flight goes on or is about to begin.
    fn is_flying(&self) -> bool {
        use autopilot::vehicle::Phase;
        let flies = |status: &Status| matches!(status.phase, Phase::Flying | Phase::Landing);
        self.present().is_some_and(flies)
    }

    fn is_airborne(&self) -> bool {
        self.present().is_some_and(|status| status.airborne)
    }

    fn is_armed(&self) -> bool {
        self.is_flying() || self.arming.is_armed()
    }

    fn mode(&self) -> Mode {
        let by_hand = matches!(self.following.followed(), Some((Source::Sticks, _)));
        let (purpose, goes_on) = (self.flown.purpose(), self.flown.goes_on());
        let doing = Doing { purpose, by_hand, goes_on, begins: self.arming.begins() };
        self.present().map_or(Mode::Hold, |status| modes::mode(status, doing))
    }
}

#[cfg(test)]
mod tests;
