//! What must never happen.

use std::fmt;
use std::time::Duration;

use mock_drone::firmware::Phase;

/// Something that brings a flight down.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Danger {
    /// The battery is nearly empty.
    Battery,
    /// Navdata do not arrive.
    Blind,
    /// Navdata say nothing that could be so.
    Worthless,
    /// The drone reports a fault of its own.
    Broken,
    /// The drone sees or hears no floor.
    NoFloor,
    /// The wind is stronger than the airframe.
    Wind,
    /// The estimate itself says that the place is lost.
    Lost,
}

impl fmt::Display for Danger {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Battery => "battery nearly empty",
            Self::Blind => "no navdata",
            Self::Worthless => "worthless navdata",
            Self::Broken => "a fault bit",
            Self::NoFloor => "no floor seen or heard",
            Self::Wind => "wind stronger than the airframe",
            Self::Lost => "place lost",
        })
    }
}

/// What must never happen.
#[derive(Debug, Clone, PartialEq)]
pub enum Fault {
    /// The drone was neither on the ground nor in its emergency at the end.
    StillFlying {
        /// What it was doing.
        phase: Phase,
    },
    /// It was too far outside the fence.
    OutsideFence {
        /// How far, less what healthy sensors were wrong by.
        outside_m: f64,
        /// How far it could get by itself where it did not hear us, or we did not hear it.
        allowed_m: f64,
    },
    /// It met the floor while it was to fly.
    FloorContact {
        /// How fast it sank.
        speed_m_s: f64,
    },
    /// It stood or slid on the floor while it was to fly.
    Scraping,
    /// It was so high that it would have met a ceiling.
    CeilingContact {
        /// How high.
        height_m: f64,
    },
    /// It came down too fast.
    HardTouchDown {
        /// How fast.
        speed_m_s: f64,
    },
    /// It was not brought down for a danger.
    DangerIgnored {
        /// Which.
        danger: Danger,
        /// For how long it could have been.
        after: Duration,
    },
    /// It was to land and did not.
    EndlessLanding {
        /// For how long.
        after: Duration,
    },
    /// It was moved while nothing could be known of its place.
    BlindSticks {
        /// For how long nothing had been.
        blind_for: Duration,
    },
    /// What the operator ordered had no effect.
    OrderIgnored {
        /// What it was.
        order: &'static str,
    },
    /// The estimate was further off than it said that it could be.
    Overconfident {
        /// Whether it is about the height, else about the place.
        vertical: bool,
        /// How far off it was.
        error_m: f64,
        /// The standard deviation that it claimed.
        claimed_m: f64,
    },
    /// A flight was called a success although a target was not reached.
    TargetMissed {
        /// The step of the plan.
        step: usize,
        /// How far off the drone really was.
        error_m: f64,
    },
    /// A flight was called a success although the drone had not flown its plan.
    NotFlown,
    /// On a fair day the plan was not flown to its end.
    GivenUpForNothing,
    /// The pilot called the flight over and the drone down while it flew.
    EndedInTheAir {
        /// What it was doing.
        phase: Phase,
    },
    /// It took off without being told to by the plan.
    UncommandedTakeOff,
    /// Its level reference was set in the air.
    TrimmedInFlight,
    /// The flight took longer than any flight does.
    Hanging,
}

impl Fault {
    /// What it is, without its numbers.
    pub fn kind(&self) -> String {
        match self {
            Self::StillFlying { .. } => "still flying at the end".to_owned(),
            Self::OutsideFence { .. } => "outside the fence".to_owned(),
            Self::FloorContact { .. } => "contact with the floor".to_owned(),
            Self::Scraping => "scraping along the floor".to_owned(),
            Self::CeilingContact { .. } => "contact with the ceiling".to_owned(),
            Self::HardTouchDown { .. } => "hard touch-down".to_owned(),
            Self::DangerIgnored { danger, .. } => format!("not landed: {danger}"),
            Self::EndlessLanding { .. } => "endless landing".to_owned(),
            Self::BlindSticks { .. } => "moved blindly".to_owned(),
            Self::OrderIgnored { order } => format!("order ignored: {order}"),
            Self::Overconfident { vertical: true, .. } => "overconfident of the height".to_owned(),
            Self::Overconfident { vertical: false, .. } => "overconfident of the place".to_owned(),
            Self::TargetMissed { .. } => "success without its target".to_owned(),
            Self::NotFlown => "success without a flight".to_owned(),
            Self::GivenUpForNothing => "given up on a fair day".to_owned(),
            Self::EndedInTheAir { .. } => "called over in the air".to_owned(),
            Self::UncommandedTakeOff => "uncommanded take-off".to_owned(),
            Self::TrimmedInFlight => "trimmed in flight".to_owned(),
            Self::Hanging => "hanging".to_owned(),
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.kind())?;
        match self {
            Self::StillFlying { phase } | Self::EndedInTheAir { phase } => write!(f, ", {phase:?}"),
            Self::OutsideFence { outside_m, allowed_m } => {
                write!(f, " by {outside_m:.2} m, {allowed_m:.2} m allowed")
            }
            Self::FloorContact { speed_m_s } | Self::HardTouchDown { speed_m_s } => {
                write!(f, " at {speed_m_s:.2} m/s")
            }
            Self::CeilingContact { height_m } => write!(f, " at {height_m:.2} m"),
            Self::DangerIgnored { after, .. } | Self::EndlessLanding { after } => {
                write!(f, " for {:.1} s", after.as_secs_f64())
            }
            Self::BlindSticks { blind_for } => write!(f, " for {:.1} s", blind_for.as_secs_f64()),
            Self::Overconfident { error_m, claimed_m, .. } => {
                write!(f, ": {error_m:.2} m off, {claimed_m:.2} m claimed")
            }
            Self::TargetMissed { step, error_m } => {
                write!(f, ", step {} by {error_m:.2} m", step + 1)
            }
            Self::Scraping
            | Self::OrderIgnored { .. }
            | Self::NotFlown
            | Self::GivenUpForNothing
            | Self::UncommandedTakeOff
            | Self::TrimmedInFlight
            | Self::Hanging => Ok(()),
        }
    }
}
