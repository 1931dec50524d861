//! Phases of a flight, from the first packet to the ground.

use std::fmt;
use std::time::Duration;

/// Phase of the flight, with the data that belongs to it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum FlightPhase {
    /// Waiting for the first navdata.
    Connecting,
    /// The drone was found in the air: it is monitored without sending anything until it is decided whether
    /// to take it over.
    Observing {
        /// When the drone was first heard.
        since: Duration,
        /// Navdata packets received before that.
        received: u64,
    },
    /// Setting the drone's configuration.
    Configuring {
        /// When the drone was first heard.
        since: Duration,
    },
    /// Setting the level reference (flat trim).
    Settling {
        /// When flat trim was sent.
        since: Duration,
        /// Navdata packets received before that.
        received: u64,
    },
    /// On the ground, configured: waiting for an order to fly.
    Standby {
        /// Start of this phase.
        since: Duration,
    },
    /// Flying the mission, or waiting in the air for more of it.
    Flying,
    /// Landing for a reason outside the mission. The phase lasts until the drone is certainly down, even if
    /// the flight's outcome is known earlier.
    Landing {
        /// When the landing was ordered.
        since: Duration,
    },
}

impl FlightPhase {
    /// The phase without its data.
    pub(super) fn phase(&self) -> Phase {
        match self {
            Self::Connecting => Phase::Connecting,
            Self::Observing { .. } => Phase::Observing,
            Self::Configuring { .. } => Phase::Configuring,
            Self::Settling { .. } => Phase::Trimming,
            Self::Standby { .. } => Phase::Standby,
            Self::Flying => Phase::Flying,
            Self::Landing { .. } => Phase::Landing,
        }
    }
}

/// Phase of the flight, for displays and logs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Phase {
    /// No navdata yet.
    Connecting,
    /// The drone was found in the air. It is monitored, and nothing is sent to it.
    Observing,
    /// The drone's settings are being set and read back.
    Configuring,
    /// The level reference is being set, and the last pre-flight checks are made.
    Trimming,
    /// On the ground, configured: waiting for an order to fly.
    Standby,
    /// The agent flies the mission or an operator's orders.
    Flying,
    /// The drone is landing for good.
    Landing,
}

impl Phase {
    /// Its name in logs, JSON and on the screen.
    pub fn name(self) -> &'static str {
        match self {
            Self::Connecting => "connecting",
            Self::Observing => "observing",
            Self::Configuring => "configuring",
            Self::Trimming => "trimming",
            Self::Standby => "standby",
            Self::Flying => "flying",
            Self::Landing => "landing",
        }
    }
}

impl fmt::Display for Phase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
