//! Plausibility of navdata, and the quantity that is not plausible.

use std::fmt;

/// Quantities of the drone's motion in navdata.
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

impl Quantity {
    /// All quantities.
    pub const ALL: [Self; 4] = [Self::Velocity, Self::Altitude, Self::Heading, Self::Attitude];
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

/// Whether navdata are plausible.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Trust {
    /// Plausible.
    #[default]
    Sound,
    /// Packets keep coming, but a quantity is constant: its sensor or the drone's computer hangs.
    Frozen(Quantity),
    /// A quantity has impossible values for an AR.Drone, or jumps.
    Implausible(Quantity),
    /// A quantity has more noise than its sensor.
    Noisy(Quantity),
    /// A quantity does not follow the commands: the drone is commanded to move and shows no motion.
    Unresponsive(Quantity),
    /// The drone itself reports that it has lost a quantity.
    Reported(Quantity),
}

impl fmt::Display for Trust {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sound => f.write_str("navdata are sound"),
            Self::Frozen(quantity) => write!(f, "the {quantity} in navdata is frozen"),
            Self::Implausible(quantity) => write!(f, "the {quantity} in navdata is implausible"),
            Self::Noisy(quantity) => write!(f, "the {quantity} in navdata is noisy"),
            Self::Unresponsive(quantity) => {
                write!(f, "the {quantity} in navdata does not follow the commands")
            }
            Self::Reported(quantity) => write!(f, "the drone reports that it lost its {quantity}"),
        }
    }
}

/// What a quantity in navdata is worth by the evidence against it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Worth {
    /// Nothing speaks against it.
    #[default]
    Sound,
    /// Something does, but not for long enough.
    Suspect,
    /// It is wrong, and how that shows.
    Disproved(Trust),
}

impl Worth {
    /// In one word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sound | Self::Disproved(Trust::Sound) => "sound",
            Self::Suspect => "suspect",
            Self::Disproved(Trust::Frozen(_)) => "frozen",
            Self::Disproved(Trust::Implausible(_)) => "implausible",
            Self::Disproved(Trust::Noisy(_)) => "noisy",
            Self::Disproved(Trust::Unresponsive(_)) => "unresponsive",
            Self::Disproved(Trust::Reported(_)) => "lost",
        }
    }
}
