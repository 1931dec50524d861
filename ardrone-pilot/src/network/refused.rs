//! Why something that a network carries is not believed.

use autopilot::vehicle::VehicleName;

use super::state::Unreadable;

/// Why a state, or a line of an agent, is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, thiserror::Error)]
pub enum Refused {
    /// The key is none of the fleet's, or not that of the vehicle in the text.
    #[error("it is at the key of another one")]
    Key,
    /// It is too long.
    #[error("it is too long")]
    TooLong,
    /// It is no JSON with the fields of a state, or no line of text.
    #[error("it cannot be read")]
    Malformed,
    /// Its version is not ours.
    #[error(
        "it has version {0}, and this program reads version 1: fly all vehicles with one version"
    )]
    Version(u32),
    /// A number makes no sense.
    #[error("a number in it makes no sense")]
    Absurd,
    /// Its program has read a file with other names, systems or starts.
    #[error("its program flies another fleet: give all programs the same FLEET.toml")]
    OtherFleet,
    /// It is of no vehicle of the fleet.
    #[error("there is no such vehicle in this fleet")]
    Unknown,
    /// It is of a vehicle that is flown here.
    #[error("it is flown here: two programs fly one vehicle, or somebody lies")]
    FlownHere,
    /// Another program tells of the same vehicle.
    #[error("two programs tell of it: fly each vehicle with one")]
    TwoPrograms,
    /// It is not newer than the last one.
    #[error("it is out of order")]
    OutOfOrder,
    /// Its program has answered no stamp of ours, so that nobody knows how old it is.
    #[error("nobody knows how old it is")]
    Unanswered,
    /// It may be too old.
    #[error("it may be more than 2 s old")]
    TooOld,
    /// What is known of its clock contradicts itself.
    #[error("its clock has jumped")]
    Clock,
    /// More lines of agents arrive than are read.
    #[error("more lines of agents arrive than are read")]
    Full,
}

impl Refused {
    /// Whether an operator need not know: it happens wherever programs begin, and where datagrams overtake each other.
    pub fn is_usual(self) -> bool {
        matches!(self, Self::Unanswered | Self::OutOfOrder)
    }

    /// Its name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Key => "key",
            Self::TooLong => "too_long",
            Self::Malformed => "malformed",
            Self::Version(_) => "version",
            Self::Absurd => "absurd",
            Self::OtherFleet => "other_fleet",
            Self::Unknown => "unknown",
            Self::FlownHere => "flown_here",
            Self::TwoPrograms => "two_programs",
            Self::OutOfOrder => "out_of_order",
            Self::Unanswered => "unanswered",
            Self::TooOld => "too_old",
            Self::Clock => "clock",
            Self::Full => "full",
        }
    }
}

impl From<Unreadable> for Refused {
    fn from(unreadable: Unreadable) -> Self {
        match unreadable {
            Unreadable::TooLong => Self::TooLong,
            Unreadable::Malformed => Self::Malformed,
            Unreadable::Version(version) => Self::Version(version),
            Unreadable::Absurd => Self::Absurd,
        }
    }
}

/// How often something was refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Count {
    /// Of whom, if it is a vehicle of the fleet.
    pub vehicle: Option<VehicleName>,
    /// Why.
    pub why: Refused,
    /// How often.
    pub count: u64,
}
