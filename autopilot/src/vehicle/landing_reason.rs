//! Why a drone is landed.

use std::fmt;

use estimator::Trust;

use crate::safety::Veto;

/// Why the drone is landed before the end of the plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LandingReason {
    /// An operator ordered it.
    Operator,
    /// The battery is nearly empty.
    Battery {
        /// Remaining charge.
        percent: u32,
    },
    /// The drone stopped answering.
    LinkLost,
    /// Packets arrive, but what they tell is old, or they are dated wrongly.
    NavdataLate,
    /// The drone has restarted.
    DroneRestarted,
    /// The agent could not carry out a step.
    StepFailed {
        /// Index of the step.
        step: usize,
    },
    /// A step took too long.
    StepTimedOut {
        /// Index of the step.
        step: usize,
    },
    /// The operator's manual target was not reached in time.
    ManualTargetTimedOut,
    /// The navdata are not plausible.
    Distrust(Trust),
    /// The position uncertainty is too large.
    PlaceUncertain,
    /// The wind is stronger than the drone.
    Wind,
    /// The operator's setpoints have not come for too long.
    SetpointsGone,
    /// The ground station that has the controls has been silent for too long.
    StationGone,
    /// The drone reports a fault of its own.
    DroneFault(&'static str),
    /// A drone that was taken over in the air must not be flown on.
    TakeOverRefused,
    /// The safety layer lands the drone.
    Safety(Veto),
}

impl fmt::Display for LandingReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Operator => f.write_str("the operator's order"),
            Self::Battery { percent } => write!(f, "battery at {percent} %"),
            Self::LinkLost => f.write_str("link lost"),
            Self::NavdataLate => {
                f.write_str("navdata are out of date, or the drone's clock is wrong")
            }
            Self::DroneRestarted => f.write_str("the drone has restarted"),
            Self::StepFailed { step } => write!(f, "step {} failed", step + 1),
            Self::StepTimedOut { step } => write!(f, "step {} exceeded its time limit", step + 1),
            Self::ManualTargetTimedOut => f.write_str("the manual target was not reached in time"),
            Self::Distrust(trust) => trust.fmt(f),
            Self::PlaceUncertain => f.write_str("the position uncertainty is too large"),
            Self::Wind => f.write_str(
                "the drone does not hold its position: too much wind, or a wrong velocity",
            ),
            Self::SetpointsGone => f.write_str("no setpoints for too long"),
            Self::StationGone => f.write_str("the ground station has been silent for too long"),
            Self::DroneFault(fault) => f.write_str(fault),
            Self::TakeOverRefused => f.write_str("the drone must not continue to fly"),
            Self::Safety(Veto::OutsideFence) => f.write_str("the drone has left the fence"),
            Self::Safety(Veto::CarriedOff) => {
                f.write_str("the wind carries the drone over the fence")
            }
            Self::Safety(Veto::Landing) => f.write_str("the drone lands by itself"),
            Self::Safety(Veto::KeepsApart) => {
                f.write_str("another vehicle was in the way for too long")
            }
            Self::Safety(Veto::Crowded) => f.write_str("another vehicle was too near, or silent"),
            Self::Safety(_) => f.write_str("no navdata for too long"),
        }
    }
}
