//! Configuration after connecting: each key is set, acknowledged and cleared, then all are read back.

use std::collections::VecDeque;
use std::time::Duration;

use super::Event;
use crate::at::{Command, Config, ControlMode};
use crate::configuration::Configuration;
use crate::navdata::DroneState;

/// Interval at which an unacknowledged key is sent again.
const RESEND_INTERVAL: Duration = Duration::from_millis(150);
/// Time after which an unacknowledged key is given up.
const KEY_TIMEOUT: Duration = Duration::from_secs(2);
/// Interval between requests for the configuration.
const READ_INTERVAL: Duration = Duration::from_millis(500);
/// Time after which the read-back is given up.
const READ_TIMEOUT: Duration = Duration::from_secs(6);
/// Maximum size of a dump; a real one has about 4 kB.
const MAX_DUMP_BYTES: usize = 65_536;

#[derive(Debug)]
pub(super) struct Handshake {
    step: Step,
    /// When the current step first sent something.
    since: Option<Duration>,
    last_sent: Option<Duration>,
    keys: usize,
    read_back: bool,
    /// This handshake makes the session ready.
    first: bool,
    dump: Vec<u8>,
    /// Shortest time from a key to its acknowledgement.
    round_trip: Option<Duration>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    /// Clear the acknowledge bit before key number `.0`.
    Clear(usize),
    /// Send key number `.0` until it is acknowledged.
    Set(usize),
    /// Request the configuration until it has arrived.
    Read,
    Done,
}

impl Handshake {
    /// Handshake for all settings of a session, after which it is ready.
    pub(super) fn new(keys: usize, read_back: bool) -> Self {
        Self {
            step: Step::Clear(0),
            since: None,
            last_sent: None,
            keys,
            read_back,
            first: true,
            dump: Vec::new(),
            round_trip: None,
        }
    }

    /// Shortest time from a key to its acknowledgement. A key that had to be sent again counts from the first time,
    /// because either may have been acknowledged.
    pub(super) fn round_trip(&self) -> Option<Duration> {
        self.round_trip
    }

    /// Handshake for one setting of a session that is already ready.
    pub(super) fn change() -> Self {
        Self { first: false, ..Self::new(1, false) }
    }

    pub(super) fn is_done(&self) -> bool {
        self.step == Step::Done
    }

    /// Checks the acknowledge bit of a new packet; returns whether the drone has acknowledged one of our
    /// keys.
    pub(super) fn handle_state(
        &mut self,
        now: Duration,
        state: DroneState,
        settings: &[Config],
        events: &mut VecDeque<Event>,
    ) -> bool {
        let acknowledged = state.contains(DroneState::COMMAND_ACKNOWLEDGE);
        match self.step {
            Step::Clear(key) if !acknowledged => {
                if key < self.keys {
                    self.enter(Step::Set(key));
                } else if self.read_back {
                    self.enter(Step::Read);
                } else {
                    self.finish(events);
                }
            }
            // Only an acknowledgement after the key was sent can refer to this key.
            Step::Set(key) if acknowledged && self.last_sent.is_some() => {
                let taken = self.since.map(|since| now.saturating_sub(since));
                self.round_trip = self.round_trip.into_iter().chain(taken).min();
                let name = settings[key].key().to_owned();
                events.push_back(Event::Configured { key: name });
                self.enter(Step::Clear(key + 1));
                return true;
            }
            _ => {}
        }
        false
    }

    /// Collects a dump up to its terminating NUL.
    pub(super) fn handle_control(&mut self, bytes: &[u8], events: &mut VecDeque<Event>) {
        if self.step != Step::Read {
            return;
        }
        let room = MAX_DUMP_BYTES - self.dump.len();
        self.dump.extend_from_slice(&bytes[..bytes.len().min(room)]);
        if let Some(end) = self.dump.iter().position(|byte| *byte == 0) {
            let text = String::from_utf8_lossy(&self.dump[..end]);
            events.push_back(Event::ConfigurationRead(Configuration::parse(&text)));
            self.finish(events);
        }
    }

    /// The command that this tick adds to the datagram.
    pub(super) fn command(
        &mut self,
        now: Duration,
        state: DroneState,
        settings: &[Config],
        events: &mut VecDeque<Event>,
    ) -> Option<Command> {
        let since = *self.since.get_or_insert(now);
        let elapsed = now.saturating_sub(since);
        let due = |last: Option<Duration>, interval: Duration| {
            last.is_none_or(|last| now.saturating_sub(last) >= interval)
        };
        match self.step {
            Step::Clear(_) => state
                .contains(DroneState::COMMAND_ACKNOWLEDGE)
                .then_some(Command::Control(ControlMode::ClearAcknowledge)),
            Step::Set(key) if elapsed >= KEY_TIMEOUT => {
                let name = settings[key].key().to_owned();
                events.push_back(Event::ConfigurationTimedOut { key: name });
                self.enter(Step::Clear(key + 1));
                None
            }
            Step::Set(key) => due(self.last_sent, RESEND_INTERVAL).then(|| {
                self.last_sent = Some(now);
                Command::Config(settings[key].clone())
            }),
            Step::Read if elapsed >= READ_TIMEOUT => {
                events.push_back(Event::ConfigurationNotRead);
                self.finish(events);
                None
            }
            Step::Read => due(self.last_sent, READ_INTERVAL).then(|| {
                self.last_sent = Some(now);
                Command::Control(ControlMode::SendConfiguration)
            }),
            Step::Done => None,
        }
    }

    fn enter(&mut self, step: Step) {
        self.step = step;
        self.since = None;
        self.last_sent = None;
    }

    fn finish(&mut self, events: &mut VecDeque<Event>) {
        self.enter(Step::Done);
        if self.first {
            events.push_back(Event::Ready);
        }
    }
}
