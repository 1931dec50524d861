//! The part of a packet that every client needs, as a value of its own.

use std::time::Duration;

use super::options::Demo;
use super::packet::{NavdataError, Packet};
use super::state::DroneState;

/// The part of a packet that every client needs. Options that were not sent are `None`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Navdata {
    /// The state bits.
    pub state: DroneState,
    /// Sequence number; restarts when the drone does.
    pub sequence: u32,
    /// The header's vision word.
    pub vision: u32,
    /// Attitude, altitude, velocity, battery.
    pub demo: Option<Demo>,
    /// The drone's clock, which wraps after 2048 s.
    pub time: Option<Duration>,
    /// Voltage of the battery, in millivolts.
    pub battery_mv: Option<u32>,
}

impl Navdata {
    /// Decodes a packet.
    ///
    /// # Errors
    /// [`NavdataError`] if the packet is damaged; none of it is used then.
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
            battery_mv: packet.battery_mv(),
        }
    }
}
