//! Whether navdata can be believed, and which part of them cannot.

use std::fmt;

/// What navdata tell of the drone's motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Velocity across the ground, from the optical flow.
    Velocity,
    /// Height above the ground, from the ultrasound.
    Altitude,
    /// Heading.
    Heading,
    /// Roll and pitch.
    Attitude,
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Velocity => "velocity",
            Self::Altitude => "altitude",
            Self::Heading => "heading",
            Self::Attitude => "attitude",
        })
    }
}

/// Whether navdata can be believed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Trust {
    /// They look like those of a drone that flies.
    #[default]
    Sound,
    /// Packets keep coming, but a quantity does not change: its sensor or the drone's computer hangs.
    Frozen(Quantity),
    /// A quantity has values that no AR.Drone can have, or jumps as none can.
    Implausible(Quantity),
    /// A quantity does not follow the commands: the drone is told to move and it shows no motion.
    Unresponsive(Quantity),
    /// The drone itself says that it has lost a quantity.
    Reported(Quantity),
}

impl fmt::Display for Trust {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sound => f.write_str("navdata are sound"),
            Self::Frozen(quantity) => write!(f, "the {quantity} in navdata is frozen"),
            Self::Implausible(quantity) => write!(f, "the {quantity} in navdata is implausible"),
            Self::Unresponsive(quantity) => {
                write!(f, "the {quantity} in navdata does not follow the commands")
            }
            Self::Reported(quantity) => write!(f, "the drone reports that it lost its {quantity}"),
        }
    }
}
