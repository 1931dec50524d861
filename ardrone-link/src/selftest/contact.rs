//! Talking with the drone.

use std::time::Duration;

use bytes::Bytes;

use super::report::Refusal;
use crate::at::{Command, Config, ControlMode, Datagram};
use crate::navdata::{DroneState, NavdataError, Packet};

/// What a drone sends.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Heard {
    /// A datagram from the navdata port.
    Navdata(Bytes),
    /// Bytes from the control port.
    Control(Bytes),
    /// Bytes from the video port, after [`Contact::watch`].
    Video(Bytes),
}

/// The ports of a drone, and a clock.
pub trait Contact {
    /// Time since the contact began.
    fn now(&self) -> Duration;
    /// Sends a datagram to the AT port.
    fn send(&mut self, datagram: &[u8]);
    /// Asks for navdata.
    fn wake(&mut self);
    /// Waits for what comes next, until `until` at the latest.
    fn next(&mut self, until: Duration) -> Option<Heard>;
    /// Asks for the video; false if this contact has no video port.
    fn watch(&mut self) -> bool;
    /// The content of `version.txt` on the drone's FTP server; `None` if this contact cannot ask.
    fn version(&mut self) -> Option<Result<String, String>>;
}

/// A navdata packet and its time of arrival.
#[derive(Debug, Clone)]
pub(super) struct Arrived {
    pub(super) at: Duration,
    pub(super) packet: Bytes,
}

impl Arrived {
    /// The packet, decoded: only packets that can be are kept.
    pub(super) fn packet(&self) -> Option<Packet<'_>> {
        Packet::decode(&self.packet).ok()
    }
}

/// What has come in a while.
#[derive(Debug, Clone, Default)]
pub(super) struct Window {
    pub(super) packets: Vec<Arrived>,
    pub(super) damaged: Vec<NavdataError>,
    pub(super) control: Vec<u8>,
    pub(super) video: Vec<Bytes>,
}

impl Window {
    /// Packets a second between the first and the last one.
    pub(super) fn rate_hz(&self) -> f64 {
        let (Some(first), Some(last)) = (self.packets.first(), self.packets.last()) else {
            return 0.0;
        };
        let seconds = last.at.saturating_sub(first.at).as_secs_f64();
        let intervals = u32::try_from(self.packets.len().saturating_sub(1)).unwrap_or(u32::MAX);
        if seconds > 0.0 { f64::from(intervals) / seconds } else { 0.0 }
    }
}

/// Interval at which something is sent, so that the drone does not count the link as lost.
const PERIOD: Duration = Duration::from_millis(30);
/// Interval of requests that were not answered.
const AGAIN: Duration = Duration::from_millis(120);
/// How long an acknowledgement may take.
pub(super) const ANSWER: Duration = Duration::from_millis(500);

/// Whether something is sent while it is waited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Meanwhile {
    /// COMWDG, which has no effect but that the drone hears us.
    Present,
    /// Nothing.
    Silent,
}

/// Commands, numbered, and what the drone last said of its state.
#[derive(Debug)]
pub(super) struct Examiner<'a, C> {
    pub(super) contact: &'a mut C,
    pub(super) number: u32,
    pub(super) state: Option<DroneState>,
    sent_at: Duration,
}

impl<'a, C: Contact> Examiner<'a, C> {
    pub(super) fn new(contact: &'a mut C) -> Self {
        Self { contact, number: 0, state: None, sent_at: Duration::ZERO }
    }

    /// Listens to the drone, without sending it a command.
    pub(super) fn find(&mut self, limit: Duration, listening: Duration) -> Result<(), Refusal> {
        let end = self.contact.now() + limit;
        while self.state.is_none() && self.contact.now() < end {
            self.contact.wake();
            self.wait(AGAIN, Meanwhile::Silent, |_| true);
        }
        if self.state.is_none() {
            return Err(Refusal::Silent);
        }
        // The watchdog of a drone that nobody commands may take a moment.
        self.listen(listening, Meanwhile::Silent);
        let state = self.state.unwrap_or_default();
        if state.contains(DroneState::FLYING) {
            return Err(Refusal::Flies);
        }
        let unheard = DroneState::COMMUNICATION_WATCHDOG
            | DroneState::NAVDATA_BOOTSTRAP
            | DroneState::COMMUNICATION_LOST;
        if !state.intersects(unheard) {
            return Err(Refusal::Commanded);
        }
        Ok(())
    }

    /// Sends a command with the next number.
    pub(super) fn command(&mut self, command: &Command) {
        self.number += 1;
        self.command_with(self.number, command);
    }

    /// Sends a command with this number.
    pub(super) fn command_with(&mut self, number: u32, command: &Command) {
        let mut datagram = Datagram::new();
        // One command is shorter than a datagram: a `Config` is made only of texts that fit.
        if datagram.push(number, command).is_ok() {
            self.sent_at = self.contact.now();
            self.contact.send(datagram.as_bytes());
        }
    }

    /// Takes in what comes for a while.
    pub(super) fn listen(&mut self, time: Duration, meanwhile: Meanwhile) -> Window {
        let end = self.contact.now() + time;
        let mut window = Window::default();
        while let Some(heard) = self.next(end, meanwhile) {
            self.take(heard, &mut window);
        }
        window
    }

    /// Waits until the state is so; the time that it took, or `None` if it did not come in time.
    pub(super) fn wait(
        &mut self,
        limit: Duration,
        meanwhile: Meanwhile,
        is_so: impl Fn(DroneState) -> bool,
    ) -> Option<Duration> {
        let start = self.contact.now();
        let mut window = Window::default();
        while let Some(heard) = self.next(start + limit, meanwhile) {
            let is_navdata = matches!(heard, Heard::Navdata(_));
            let before = window.packets.len();
            self.take(heard, &mut window);
            if is_navdata && window.packets.len() > before && self.state.is_some_and(&is_so) {
                return Some(self.contact.now().saturating_sub(start));
            }
        }
        None
    }

    /// Repeats a request until the state is so, for `limit`.
    pub(super) fn ask(
        &mut self,
        limit: Duration,
        command: &Command,
        is_so: impl Fn(DroneState) -> bool,
    ) -> Option<Duration> {
        let start = self.contact.now();
        while self.contact.now() < start + limit {
            self.command(command);
            if self.wait(AGAIN, Meanwhile::Present, &is_so).is_some() {
                return Some(self.contact.now().saturating_sub(start));
            }
        }
        None
    }

    /// Clears the acknowledgement of an earlier setting; false if it stays.
    pub(super) fn clear(&mut self) -> Option<Duration> {
        let clear = Command::Control(ControlMode::ClearAcknowledge);
        self.ask(ANSWER, &clear, |state| !state.contains(DroneState::COMMAND_ACKNOWLEDGE))
    }

    /// Sets a key; how long its acknowledgement took.
    pub(super) fn set(&mut self, config: &Config) -> Option<Duration> {
        self.clear();
        let acknowledged = self.ask(ANSWER, &Command::Config(config.clone()), |state| {
            state.contains(DroneState::COMMAND_ACKNOWLEDGE)
        });
        self.clear();
        acknowledged
    }

    /// Sets a key of which the text is known to fit.
    pub(super) fn set_text(&mut self, key: &str, value: &str) -> Option<Duration> {
        Config::new(key, value).ok().and_then(|config| self.set(&config))
    }

    fn next(&mut self, until: Duration, meanwhile: Meanwhile) -> Option<Heard> {
        loop {
            let now = self.contact.now();
            if now >= until {
                return None;
            }
            let due = self.sent_at + PERIOD;
            if meanwhile == Meanwhile::Present && now >= due {
                self.command(&Command::CommunicationWatchdog);
                continue;
            }
            let wait = if meanwhile == Meanwhile::Present { until.min(due) } else { until };
            if let Some(heard) = self.contact.next(wait) {
                return Some(heard);
            }
        }
    }

    fn take(&mut self, heard: Heard, window: &mut Window) {
        let at = self.contact.now();
        match heard {
            Heard::Navdata(packet) => match Packet::decode(&packet).map(|decoded| decoded.state) {
                Ok(state) => {
                    self.state = Some(state);
                    window.packets.push(Arrived { at, packet });
                }
                Err(error) => window.damaged.push(error),
            },
            Heard::Control(bytes) => window.control.extend_from_slice(&bytes),
            Heard::Video(bytes) => window.video.push(bytes),
        }
    }
}
