//! Outcomes of flights and their exit statuses.

use std::fmt;

use crate::vehicle::CrossCheck;

/// How a flight ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// The plan was flown to its end and the drone has landed.
    Completed,
    /// The plan was flown to its end and the drone has landed, but the place by which it was flown is contradicted.
    Contradicted {
        /// What contradicts it.
        by: CrossCheck,
    },
    /// No drone answered.
    NoDrone,
    /// The drone stopped answering in flight.
    LinkLost,
    /// The flight was refused before take-off.
    PreflightRefused {
        /// All reasons.
        reasons: Vec<String>,
    },
    /// A failsafe ended the flight.
    Failsafe {
        /// The reason.
        reason: String,
    },
    /// The drone cut its motors.
    Emergency,
    /// An operator called the flight off before it began.
    CalledOff,
    /// An operator ordered the landing, and the drone has landed.
    Interrupted,
    /// An operator ordered the landing, and the program ended before the drone confirmed that it is down.
    LeftLanding,
}

impl Outcome {
    /// The process's exit status.
    pub fn exit_status(&self) -> u8 {
        match self {
            Self::Completed => 0,
            Self::NoDrone | Self::LinkLost => 10,
            Self::PreflightRefused { .. } => 30,
            Self::Failsafe { .. } => 40,
            Self::Emergency => 50,
            Self::Contradicted { .. } => 60,
            Self::CalledOff | Self::Interrupted | Self::LeftLanding => 130,
        }
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Completed => f.write_str("plan flown to its end"),
            Self::Contradicted { by } => write!(
                f,
                "all steps flown, but {by} contradicts the position: the targets may not have been reached"
            ),
            Self::NoDrone => f.write_str(
                "no drone answered: is this machine on the drone's Wi-Fi, and the address right?",
            ),
            Self::LinkLost => f.write_str(
                "the drone stopped answering: it hovers and lands by itself after 2 s of silence",
            ),
            Self::PreflightRefused { reasons } => {
                write!(f, "not flown: {}", reasons.join("; "))
            }
            Self::Failsafe { reason } => write!(f, "landed by a failsafe: {reason}"),
            Self::Emergency => f.write_str("emergency: the drone has cut its motors"),
            Self::CalledOff => f.write_str("called off by the operator before take-off"),
            Self::Interrupted => f.write_str("landed on the operator's order"),
            Self::LeftLanding => f.write_str(
                "left while the drone was landing on the operator's order: it has not confirmed that it is down",
            ),
        }
    }
}
