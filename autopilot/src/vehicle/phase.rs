//! Phases of a flight, from the first packet to the ground.

use std::fmt;

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
    /// All phases.
    pub const ALL: [Self; 7] = [
        Self::Connecting,
        Self::Observing,
        Self::Configuring,
        Self::Trimming,
        Self::Standby,
        Self::Flying,
        Self::Landing,
    ];

    /// The phases that may follow.
    pub fn next(self) -> &'static [Self] {
        match self {
            Self::Connecting => &[Self::Observing, Self::Configuring],
            Self::Observing => &[Self::Connecting, Self::Configuring],
            Self::Configuring => {
                &[Self::Connecting, Self::Observing, Self::Trimming, Self::Landing]
            }
            Self::Trimming => &[
                Self::Connecting,
                Self::Observing,
                Self::Configuring,
                Self::Standby,
                Self::Flying,
                Self::Landing,
            ],
            Self::Standby => &[
                Self::Connecting,
                Self::Observing,
                Self::Configuring,
                Self::Trimming,
                Self::Landing,
            ],
            Self::Flying => &[Self::Configuring, Self::Standby, Self::Landing],
            Self::Landing => &[Self::Configuring, Self::Standby],
        }
    }

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
