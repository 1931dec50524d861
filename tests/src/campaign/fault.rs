//! Faults: what must never happen.

use std::fmt;
use std::time::Duration;

use mock_drone::firmware::Phase;

/// A danger for which the drone must be landed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Danger {
    /// The battery is nearly empty.
    Battery,
    /// No navdata arrive.
    Blind,
    /// Navdata are not plausible.
    Worthless,
    /// The drone reports a fault.
    Broken,
    /// The drone measures neither velocity nor altitude.
    NoFloor,
    /// The wind is too strong for the airframe.
    Wind,
    /// The estimate's own position uncertainty is too large.
    Lost,
    /// The ground station that has the controls has been silent for too long.
    Station,
    /// The setpoints that were followed have not come for too long.
    Setpoints,
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
            Self::Station => "station gone",
            Self::Setpoints => "setpoints gone",
        })
    }
}

/// A fault of a flight.
#[derive(Debug, Clone, PartialEq)]
pub enum Fault {
    /// At the end the drone is neither on the ground nor in its emergency state.
    StillFlying {
        /// Its phase.
        phase: Phase,
    },
    /// The drone was too far outside the fence.
    OutsideFence {
        /// Distance, corrected by the error of healthy sensors.
        outside_m: f64,
        /// Distance that it could cover by itself while it did not receive us, or we did not receive it.
        allowed_m: f64,
    },
    /// The drone hit the floor while it was to fly.
    FloorContact {
        /// Vertical speed.
        speed_m_s: f64,
    },
    /// The drone stood or slid on the floor while it was to fly.
    Scraping,
    /// The drone was high enough to hit a ceiling.
    CeilingContact {
        /// Its height.
        height_m: f64,
    },
    /// The drone touched down too fast.
    HardTouchDown {
        /// Its vertical speed.
        speed_m_s: f64,
    },
    /// The drone was not landed for a danger.
    DangerIgnored {
        /// The danger.
        danger: Danger,
        /// Time for which it could have been.
        after: Duration,
    },
    /// A landing was ordered but did not end.
    EndlessLanding {
        /// Time since the order.
        after: Duration,
    },
    /// The drone was moved by sticks without usable navdata.
    BlindSticks {
        /// Time without usable navdata.
        blind_for: Duration,
    },
    /// An operator's order had no effect.
    OrderIgnored {
        /// The order.
        order: &'static str,
    },
    /// The drone was flown on although nobody may have been there any more who ordered it.
    FlownForNobody {
        /// Whether setpoints had stopped, or else the station was lost.
        setpoints: bool,
    },
    /// The estimate's error exceeded its claimed uncertainty.
    Overconfident {
        /// Whether in height, or else in position.
        vertical: bool,
        /// Its error.
        error_m: f64,
        /// Its claimed standard deviation.
        claimed_m: f64,
    },
    /// A flight counted as completed although a target was not reached.
    TargetMissed {
        /// Index of the step.
        step: usize,
        /// True distance from the target.
        error_m: f64,
    },
    /// A flight counted as completed although its plan was not flown.
    NotFlown,
    /// The plan was not completed although nothing prevented it.
    GivenUpForNothing,
    /// The position was called contradicted although nothing was wrong with it.
    ContradictedForNothing,
    /// The flight ended, and the drone was reported as down, while it was in the air.
    EndedInTheAir {
        /// Its phase.
        phase: Phase,
    },
    /// The drone took off without an order of the plan.
    UncommandedTakeOff,
    /// The level reference was set in the air.
    TrimmedInFlight,
    /// The flight took longer than any plan.
    Hanging,
}

impl Fault {
    /// The kind of fault, without its numbers.
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
            Self::FlownForNobody { setpoints: true } => "flown on without setpoints".to_owned(),
            Self::FlownForNobody { setpoints: false } => "flown for a lost station".to_owned(),
            Self::Overconfident { vertical: true, .. } => "overconfident of the height".to_owned(),
            Self::Overconfident { vertical: false, .. } => "overconfident of the place".to_owned(),
            Self::TargetMissed { .. } => "success without its target".to_owned(),
            Self::NotFlown => "success without a flight".to_owned(),
            Self::GivenUpForNothing => "given up on a fair day".to_owned(),
            Self::ContradictedForNothing => "contradicted for nothing".to_owned(),
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
            | Self::FlownForNobody { .. }
            | Self::NotFlown
            | Self::GivenUpForNothing
            | Self::ContradictedForNothing
            | Self::UncommandedTakeOff
            | Self::TrimmedInFlight
            | Self::Hanging => Ok(()),
        }
    }
}
