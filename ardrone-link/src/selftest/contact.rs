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
    /// Whether somebody wants the examination to end.
    fn is_stopped(&self) -> bool {
        false
    }
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
    video_bytes: usize,
}

impl Window {
    /// The watchdog bit of each packet.
    fn watchdog(&self) -> Vec<bool> {
        let packets = self.packets.iter().filter_map(Arrived::packet);
        packets.map(|packet| packet.state.contains(DroneState::COMMUNICATION_WATCHDOG)).collect()
    }

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
/// A configuration has 4 kB; what is longer is none. Of pictures there are 2 MB in the time in which they are watched.
const MOST_CONTROL_BYTES: usize = 64 << 10;
const MOST_VIDEO_BYTES: usize = 8 << 20;
/// A drone that is silent for so long has gone.
const GONE: Duration = Duration::from_millis(1500);
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
    heard_at: Duration,
    /// It flies: no command is sent any more.
    flies: bool,
}

impl<'a, C: Contact> Examiner<'a, C> {
    pub(super) fn new(contact: &'a mut C) -> Self {
        Self {
            contact,
            number: 0,
            state: None,
            sent_at: Duration::ZERO,
            heard_at: Duration::ZERO,
            flies: false,
        }
    }

    /// Finds the drone, and that nobody else commands it.
    pub(super) fn find(&mut self, limit: Duration) -> Result<(), Refusal> {
        /// How long a drone is only listened to, and how long after a single command: a client that sends 5 commands a second clears
        /// the watchdog for 50 ms each time, so that 30 packets will not miss it.
        const LISTENING: Duration = Duration::from_millis(500);
        const ALONE: Duration = Duration::from_secs(2);
        /// When the watchdog must have risen after our command.
        const RISEN: Duration = Duration::from_millis(400);
        let end = self.contact.now() + limit;
        while self.state.is_none() && self.contact.now() < end {
            self.contact.wake();
            self.wait(AGAIN, Meanwhile::Silent, |_| true);
        }
        if self.state.is_none() {
            return Err(Refusal::Silent);
        }
        let before = self.listen(LISTENING, Meanwhile::Silent);
        self.refusal()?;
        // Where somebody clears it, it is on and off.
        let changes = before.watchdog();
        if changes.contains(&true) && changes.contains(&false) {
            return Err(Refusal::Commanded);
        }
        // One of them may be lost.
        for _ in 0..3 {
            self.command(&Command::CommunicationWatchdog);
            self.listen(PERIOD, Meanwhile::Silent);
        }
        let sent_at = self.contact.now();
        let after = self.listen(ALONE, Meanwhile::Silent);
        self.refusal()?;
        let late = after.packets.iter().filter(|came| came.at > sent_at + RISEN);
        let is_risen = |came: &Arrived| {
            came.packet()
                .is_some_and(|packet| packet.state.contains(DroneState::COMMUNICATION_WATCHDOG))
        };
        if late.clone().count() == 0 || !late.into_iter().all(is_risen) {
            return Err(Refusal::Commanded);
        }
        Ok(())
    }

    /// Why nothing more may be asked.
    pub(super) fn refusal(&self) -> Result<(), Refusal> {
        if self.flies {
            return Err(Refusal::Flies);
        }
        if self.contact.is_stopped() {
            return Err(Refusal::Stopped);
        }
        if self.contact.now().saturating_sub(self.heard_at) > GONE {
            return Err(Refusal::Gone);
        }
        Ok(())
    }

    /// Whether it was seen to fly.
    pub(super) fn flies(&self) -> bool {
        self.flies
    }

    /// Sends a command with the next number.
    pub(super) fn command(&mut self, command: &Command) {
        self.number += 1;
        self.send(&[(self.number, command)]);
    }

    /// Sends a command with this number.
    pub(super) fn command_with(&mut self, number: u32, command: &Command) {
        self.send(&[(number, command)]);
    }

    fn send(&mut self, commands: &[(u32, &Command)]) {
        if self.flies {
            return;
        }
        let mut datagram = Datagram::new();
        // Two commands are shorter than a datagram: a `Config` is made only of texts that fit.
        if commands.iter().all(|(number, command)| datagram.push(*number, command).is_ok()) {
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
        while self.contact.now() < start + limit && !self.flies {
            // As in a flight, where a setting is never alone in its datagram.
            self.number += 2;
            let numbered =
                [(self.number - 1, &Command::CommunicationWatchdog), (self.number, command)];
            self.send(&numbered);
            if self.wait(AGAIN, Meanwhile::Present, &is_so).is_some() {
                return Some(self.contact.now().saturating_sub(start));
            }
        }
        None
    }

    /// Clears the acknowledgement of an earlier setting; how long it took, or `None` if it stays.
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
            // Nothing is to be learnt of a drone that flies.
            if now >= until || self.flies {
                return None;
            }
            let due = self.sent_at + PERIOD;
            let is_present = meanwhile == Meanwhile::Present;
            if is_present && now >= due {
                self.command(&Command::CommunicationWatchdog);
                continue;
            }
            let wait = if is_present { until.min(due) } else { until };
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
                    self.heard_at = at;
                    self.flies |= state.contains(DroneState::FLYING);
                    window.packets.push(Arrived { at, packet });
                }
                Err(error) => window.damaged.push(error),
            },
            Heard::Control(bytes) if window.control.len() < MOST_CONTROL_BYTES => {
                window.control.extend_from_slice(&bytes);
            }
            Heard::Video(bytes) if window.video_bytes < MOST_VIDEO_BYTES => {
                window.video_bytes += bytes.len();
                window.video.push(bytes);
            }
            Heard::Control(_) | Heard::Video(_) => {}
        }
    }
}
