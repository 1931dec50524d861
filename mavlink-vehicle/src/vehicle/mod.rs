//! The vehicle as its `MAVLink` clients see it: datagrams in, datagrams and orders out.
//!
//! [`MavlinkVehicle`] is a pure state machine. The shell passes in what arrives ([`MavlinkVehicle::handle`]): datagrams, what
//! the vehicle tells of itself, and its answers to orders. Every 20 ms it calls [`MavlinkVehicle::tick`], and sends and orders
//! what comes out ([`MavlinkVehicle::poll`]). Sources: the MAVLink developer guide and PX4's documentation of flight modes.

mod commands;
mod modes;
mod orders;
mod parameters;
mod protocol;
mod received;
mod setpoints;
mod stations;
mod telemetry;
mod texts;

use std::collections::VecDeque;
use std::time::Duration;

use arrayvec::{ArrayString, ArrayVec};
use autopilot::plan::FlightLimits;
use autopilot::vehicle::{FlightEvent, NotReady, Operator, OperatorOrder, Setpoint, Status};

use self::modes::{Doing, Mode, Purpose};
use self::orders::{Awaited, Pending};
use self::parameters::Parameters;
pub use self::protocol::{Autopilot, Config, Input, Output, Ticket, To};
use self::setpoints::Joystick;
use self::stations::Stations;
use self::telemetry::Schedule;
use self::texts::Texts;
use crate::dialect::{MavMessage, MavSeverity};
use crate::frame::{Buffer, Encoder, LONGEST_FRAME, frames};
use crate::mission::{Fence, Rules, Transfer};
use crate::place::Origin;
use crate::signing::Signing;

/// Our system and component: an autopilot.
pub(crate) const SYSTEM: u8 = 1;
pub(crate) const COMPONENT: u8 = 1;
/// Messages that may wait to be sent.
const MESSAGES: usize = 256;
/// Orders that may wait to be given.
const ORDERS: usize = 32;
/// After this time without news of the vehicle nothing is told of it any more.
const NEWS_TIME: Duration = Duration::from_secs(3);

/// A mission that was handed to the vehicle.
#[derive(Debug, Clone)]
struct Handed {
    purpose: Purpose,
    /// Its commands, by which it is recognised.
    lines: Vec<String>,
    /// The item of each command.
    items: Vec<u16>,
    /// The stored mission from which it was made.
    id: u32,
}

/// How far the mission of [`Handed`] is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Progress {
    /// The vehicle has another mission.
    Other,
    /// It has this one.
    Ours,
    /// .. and has flown it to its end.
    Complete,
}

/// State machine of a `MAVLink` vehicle.
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
    stations: Stations,
    schedule: Schedule,
    parameters: Parameters,
    transfer: Transfer,
    handed: Option<Handed>,
    progress: Progress,
    /// The item with which the mission begins next time.
    first_item: u16,
    /// The item of the mission that the vehicle flew last, as long as it has it.
    item: Option<u16>,
    /// The item that was reported as reached last.
    reached: Option<u16>,
    awaited: ArrayVec<Awaited, 16>,
    /// The operator who gave the last order, and where.
    ordered_at: Option<(Operator, u8)>,
    /// When the vehicle was last told that the station with the controls is there.
    presence: Option<Duration>,
    next_ticket: u32,
    /// Until when the vehicle is armed on the ground, and by whom.
    armed: Option<(Duration, Operator)>,
    /// What will be done when it is armed.
    pending: Option<Pending>,
    /// The last set-point, whose it was and when it came.
    setpoint: Option<(Duration, Operator, Setpoint)>,
    /// The operator whose set-points are followed, or were until they stopped.
    follows: Option<Operator>,
    /// The last that sticks asked for, whose they are and when it came.
    sticks: Option<(Duration, Operator, Setpoint)>,
    /// The operator whose sticks are followed, or were until they stopped.
    by_hand: Option<Operator>,
    joystick: Joystick,
    /// Mode and arming that were told last.
    told: Option<(Mode, bool)>,
    /// A landing that nobody has ordered, or worse.
    failsafe: bool,
    emergency: bool,
    refused_setpoint_told: Option<Duration>,
}

impl MavlinkVehicle {
    /// A vehicle of which nothing is known yet.
    pub fn new(config: Config) -> Self {
        let parameters = Parameters::new(&config);
        let origin = config.origin;
        let signing = config.key.clone().map(|key| Signing::new(key, 0, config.unix_time, 0));
        Self {
            origin,
            encoder: Encoder::new(SYSTEM, COMPONENT),
            signing,
            messages: VecDeque::with_capacity(MESSAGES),
            orders: VecDeque::with_capacity(ORDERS),
            buffer: [0; LONGEST_FRAME],
            texts: Texts::default(),
            status: None,
            not_ready: None,
            stations: Stations::default(),
            schedule: Schedule::new(&config),
            parameters,
            transfer: Transfer::default(),
            handed: None,
            progress: Progress::Other,
            first_item: 0,
            item: None,
            reached: None,
            awaited: ArrayVec::new(),
            ordered_at: None,
            presence: None,
            next_ticket: 0,
            armed: None,
            pending: None,
            setpoint: None,
            follows: None,
            sticks: None,
            by_hand: None,
            joystick: Joystick::default(),
            told: None,
            failsafe: false,
            emergency: false,
            refused_setpoint_told: None,
            config,
        }
    }

    /// Handles what arrives.
    pub fn handle(&mut self, now: Duration, input: Input<'_>) {
        match input {
            Input::Datagram { peer, local, bytes } => {
                for frame in frames(bytes).flatten() {
                    self.receive(now, peer, local, &frame);
                }
            }
            Input::Status(status) => self.take_status(now, status),
            Input::Readiness(reasons) => self.take_readiness(reasons),
            Input::Event(event) => self.take_event(event),
            Input::Mission(steps) => {
                let steps = steps.iter().map(|step| step.text.as_str());
                let ours = self.handed.as_ref().is_some_and(|handed| {
                    !handed.lines.is_empty() && steps.eq(handed.lines.iter().map(String::as_str))
                });
                self.progress = if ours { Progress::Ours } else { Progress::Other };
            }
            Input::Answer { ticket, answer } => self.take_answer(now, ticket, &answer),
            Input::PeerGone(peer) => self.stations.forget_peer(peer),
        }
    }

    /// Time passes. Call this every 20 ms or so.
    pub fn tick(&mut self, now: Duration) {
        self.watch_orders(now);
        self.watch_stations(now);
        let handled = self.transfer.tick(now);
        self.transferred(&handled);
        if self.has_news(now) {
            self.tell(now);
        }
    }

    /// The next datagram to send or order to give.
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

    fn warn(&mut self, text: std::fmt::Arguments<'_>) {
        self.say(MavSeverity::MAV_SEVERITY_WARNING, text);
    }

    /// The rules by which missions are judged.
    fn rules(&self) -> Rules {
        let FlightLimits { floor_m, ceiling_m, radius_m, .. } = self.config.limits;
        Rules {
            origin: self.origin,
            fence: Fence { floor_m, ceiling_m, radius_m },
            max_speed_m_s: self.parameters.value(parameters::CRUISE_SPEED),
        }
    }

    fn take_status(&mut self, now: Duration, status: &Status) {
        let flew = self.is_flying();
        self.status = Some((now, *status));
        let flies = self.is_flying();
        let handed = self.handed.as_ref().filter(|_| self.progress == Progress::Ours);
        if let Some(item) =
            handed.zip(status.step).and_then(|(handed, step)| handed.items.get(step))
        {
            self.item = Some(*item);
        }
        if flies {
            self.armed = None;
            self.pending = None;
            self.emergency = false;
        } else if flew {
            self.flight_ended();
        }
        if !flies {
            self.failsafe = false;
        }
    }

    fn take_readiness(&mut self, reasons: &[NotReady]) {
        let mut text = ArrayString::new();
        for reason in reasons {
            let separator = if text.is_empty() { "" } else { "; " };
            // What does not fit is cut.
            _ = std::fmt::Write::write_fmt(&mut text, format_args!("{separator}{reason}"));
        }
        self.not_ready = Some(text);
    }

    fn take_event(&mut self, event: &FlightEvent) {
        use autopilot::vehicle::LandingReason;
        match event {
            FlightEvent::StepStarted { .. } => return,
            // Whoever takes the controls does not expect that another's take-off follows.
            FlightEvent::ControlsTaken { .. } => {
                self.pending = None;
                self.armed = None;
            }
            FlightEvent::StepDone { step } => return self.step_done(*step),
            FlightEvent::LandingOrdered(LandingReason::Operator) => {}
            FlightEvent::LandingOrdered(_) | FlightEvent::LinkLost => self.failsafe = true,
            FlightEvent::Emergency => self.emergency = true,
            FlightEvent::EmergencyCleared => self.emergency = false,
            _ => {}
        }
        let severity = match event {
            FlightEvent::Emergency | FlightEvent::LinkLost | FlightEvent::CutOrdered => {
                MavSeverity::MAV_SEVERITY_CRITICAL
            }
            event if event.warns() => MavSeverity::MAV_SEVERITY_WARNING,
            _ => MavSeverity::MAV_SEVERITY_INFO,
        };
        self.say(severity, format_args!("{event}"));
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
        self.is_flying() || self.armed.is_some()
    }

    fn mode(&self) -> Mode {
        let purpose = match (&self.handed, self.progress) {
            (Some(handed), Progress::Ours | Progress::Complete) => handed.purpose,
            _ => Purpose::Mission,
        };
        let doing = Doing {
            purpose,
            by_hand: self.by_hand.is_some(),
            goes_on: self.progress == Progress::Ours,
        };
        self.present().map_or(Mode::Hold, |status| modes::mode(status, doing))
    }
}

#[cfg(test)]
mod tests;
