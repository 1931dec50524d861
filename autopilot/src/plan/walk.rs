//! A plan on paper: where its targets are, as far as that is known before the flight.

use estimator::wrap_deg;
use pid::Pose;

use super::{Command, FlightLimits};

/// Follows the commands of a plan.
#[derive(Debug, Clone)]
pub(super) struct Walk {
    pub(super) airborne: bool,
    /// The take-off reference.
    origin: Pose,
    reference: Pose,
    /// Where the last command has led.
    pub(super) target: Pose,
}

impl Walk {
    pub(super) fn new(limits: &FlightLimits) -> Self {
        let z_m = limits.origin_height_m(FlightLimits::EXPECTED_HOVER_M);
        let origin = Pose { z_m, ..Pose::default() };
        Self { airborne: false, origin, reference: origin, target: Pose::default() }
    }

    /// Carries out a command; returns its target, if it has one.
    pub(super) fn step(&mut self, command: Command) -> Option<Pose> {
        let (from, by) = match command {
            Command::GoTo(pose) => (self.reference, pose),
            Command::MoveBy(pose) | Command::MoveByRelative(pose) => (self.target, pose),
            Command::TakeOff { .. } => {
                self.airborne = true;
                self.target = Pose { z_m: FlightLimits::EXPECTED_HOVER_M, ..self.target };
                return None;
            }
            Command::Land => {
                self.airborne = false;
                self.target = Pose { z_m: 0.0, ..self.target };
                return None;
            }
            Command::SetReference(pose) => {
                self.reference = offset(&self.origin, &pose);
                return None;
            }
            Command::SetReferenceHere => {
                self.reference = self.target;
                return None;
            }
            Command::SetReachDistance { .. }
            | Command::SetStayDistance { .. }
            | Command::SetStayTime { .. }
            | Command::SetMaxControl { .. } => return None,
        };
        self.target = offset(&from, &by);
        Some(self.target)
    }
}

/// The pose `by` away from `from`: displacements are along the world's axes, headings add up.
pub(crate) fn offset(from: &Pose, by: &Pose) -> Pose {
    Pose {
        x_m: from.x_m + by.x_m,
        y_m: from.y_m + by.y_m,
        z_m: from.z_m + by.z_m,
        yaw_deg: wrap_deg(from.yaw_deg + by.yaw_deg),
    }
}
