//! What a pilot needs of a packet, as a value of its own.

use std::time::Duration;

use super::options::Demo;
use super::packet::{NavdataError, Packet};
use super::state::DroneState;

/// The part of a packet that every pilot needs. What was not sent is `None`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Navdata {
    /// The state bits.
    pub state: DroneState,
    /// Counts packets; starts again when the drone does.
    pub sequence: u32,
    /// The header's vision word.
    pub vision: u32,
    /// Attitude, altitude, velocity, battery.
    pub demo: Option<Demo>,
    /// The drone's clock, which wraps after 2048 s.
    pub time: Option<Duration>,
}

impl Navdata {
    /// Reads a packet.
    ///
    /// # Errors
    /// [`NavdataError`]: nothing of a damaged packet is used.
    pub fn decode(packet: &[u8]) -> Result<Self, NavdataError> {
        Packet::decode(packet).map(|packet| Self::from(&packet))
    }
}

impl From<&Packet<'_>> for Navdata {
    fn from(packet: &Packet<'_>) -> Self {
        Self {
            state: packet.state,
            sequence: packet.sequence,
            vision: packet.vision,
            demo: packet.demo(),
            time: packet.time().map(|time| time.since_start),
        }
    }
}
