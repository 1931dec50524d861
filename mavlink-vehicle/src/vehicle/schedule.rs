//! How often the vehicle tells what.

use std::time::Duration;

use super::Config;
use crate::dialect::{MESSAGE_INTERVAL_DATA, MavMessage};

/// The vehicle's status comes no more often than this.
const SHORTEST: Duration = Duration::from_millis(90);
/// A heartbeat comes at least so often, whatever anybody asks for.
const HEARTBEAT_EVERY: Duration = Duration::from_secs(1);
/// The number of the heartbeat's message.
pub(super) const HEARTBEAT: u32 = 0;

/// One kind of message.
#[derive(Debug, Clone, Copy)]
struct Stream {
    id: u32,
    /// By default; `None` for only on request.
    usual: Option<Duration>,
    every: Option<Duration>,
    next: Duration,
}

/// When each kind of message is due.
#[derive(Debug)]
pub(super) struct Schedule(Vec<Stream>);

impl Schedule {
    pub(super) fn new(config: &Config) -> Self {
        let stream = |(id, ms): (u32, u64)| {
            let usual = (ms > 0).then(|| Duration::from_millis(ms));
            Stream { id, usual, every: usual, next: Duration::ZERO }
        };
        let gps_ms = if config.pretend_gps { 1000 } else { 0 };
        let usual = [
            (HEARTBEAT, 1000),
            (1, 1000),
            (2, 1000),
            (24, gps_ms),
            (30, 90),
            (31, 0),
            (32, 90),
            (33, 180),
            (42, 1000),
            (49, 0),
            (74, 250),
            (85, 0),
            (132, 180),
            // QGroundControl shows no other height once it has heard one of these.
            (141, 180),
            (147, 1000),
            (148, 0),
            (230, 1000),
            (242, 2000),
            (245, 1000),
            (300, 0),
            (436, 2000),
        ];
        Self(usual.into_iter().map(stream).collect())
    }

    /// Sets an interval in microseconds, 0 for the usual one and less for never. Returns whether there is such a message.
    pub(super) fn set(&mut self, id: u32, interval_us: i32) -> bool {
        let Some(stream) = self.0.iter_mut().find(|stream| stream.id == id) else { return false };
        stream.every = match u64::try_from(interval_us) {
            Ok(0) => stream.usual,
            Ok(us) => Some(Duration::from_micros(us).max(SHORTEST)),
            Err(_) => None,
        };
        if id == HEARTBEAT {
            stream.every = Some(stream.every.unwrap_or(HEARTBEAT_EVERY).min(HEARTBEAT_EVERY));
        }
        true
    }

    /// The message that tells an interval: 0 for what this vehicle does not have.
    pub(super) fn interval(&self, message_id: u16) -> MavMessage {
        let stream = self.0.iter().find(|stream| stream.id == message_id.into());
        let interval_us = match stream.map(|stream| stream.every) {
            None => 0,
            Some(None) => -1,
            Some(Some(every)) => i32::try_from(every.as_micros()).unwrap_or(i32::MAX),
        };
        MavMessage::MESSAGE_INTERVAL(MESSAGE_INTERVAL_DATA { interval_us, message_id })
    }

    /// The message at `index` if it is due; then it is due again after its interval.
    pub(super) fn due(&mut self, index: usize, now: Duration) -> Option<u32> {
        let stream = self.0.get_mut(index)?;
        let every = stream.every?;
        if now < stream.next {
            return None;
        }
        // Without catching up what was missed.
        let next = stream.next + every;
        stream.next = if next > now { next } else { now + every };
        Some(stream.id)
    }

    /// How many kinds there are.
    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    /// Makes a message due at once.
    pub(super) fn hasten(&mut self, id: u32) {
        if let Some(stream) = self.0.iter_mut().find(|stream| stream.id == id) {
            stream.next = Duration::ZERO;
        }
    }
}
