//! What a plan that reads well must fulfil to be flown.

use diagnostic::{Diagnostic, Span};
use pid::Pose;

use super::Command;
use super::parser::Line;

/// Where z = 0 is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ZOrigin {
    /// At the height of the hover after take-off, as in `tum_ardrone`'s plans.
    #[default]
    Hover,
    /// At the floor.
    Floor,
}

/// Heights between which the drone may fly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightLimits {
    /// Targets below this are refused. Above the floor.
    pub floor_m: f64,
    /// Targets above this are refused. Above the floor.
    pub ceiling_m: f64,
    /// What z means in the plan.
    pub z_origin: ZOrigin,
}

impl Default for FlightLimits {
    fn default() -> Self {
        Self { floor_m: 0.3, ceiling_m: 3.0, z_origin: ZOrigin::Hover }
    }
}

impl FlightLimits {
    /// Where the drone hovers after take-off, as far as it is known before the flight. The true
    /// height is known only then, and targets are checked against it once more.
    const EXPECTED_HOVER_M: f64 = 0.85;

    /// The height above the floor of z = 0 of the take-off reference.
    pub fn origin_height_m(&self, hover_m: f64) -> f64 {
        match self.z_origin {
            ZOrigin::Hover => hover_m,
            ZOrigin::Floor => 0.0,
        }
    }
}

/// Heights are typed with a few digits; a target on the limit is inside.
const TOLERANCE_M: f64 = 1e-9;

/// Flies the plan on paper: order of commands, heights of targets.
pub(super) fn check(lines: &[Line], text: &str, limits: &FlightLimits) -> Vec<Diagnostic> {
    let end = text.trim_end().len();
    let mut check = Check {
        limits,
        airborne: false,
        origin_m: limits.origin_height_m(FlightLimits::EXPECTED_HOVER_M),
        reference_m: 0.0,
        target_m: 0.0,
        diagnostics: Vec::new(),
    };
    check.reference_m = check.origin_m;
    let mut flies = false;
    for line in lines {
        if let Some(command) = line.command {
            flies |= matches!(command, Command::TakeOff { .. });
            check.step(command, &line.span);
        }
    }
    if !flies && check.diagnostics.is_empty() {
        check.diagnostics.push(
            Diagnostic::error("the plan never takes off", end..end)
                .help("begin with `takeoff` and end with `land`"),
        );
    }
    check.diagnostics
}

struct Check<'a> {
    limits: &'a FlightLimits,
    airborne: bool,
    origin_m: f64,
    reference_m: f64,
    target_m: f64,
    diagnostics: Vec<Diagnostic>,
}

impl Check<'_> {
    fn step(&mut self, command: Command, span: &Span) {
        match command {
            Command::TakeOff { .. } => {
                self.airborne = true;
                self.target_m = FlightLimits::EXPECTED_HOVER_M;
            }
            Command::Land => self.airborne = false,
            Command::GoTo(pose) => self.target(self.reference_m, &pose, span),
            Command::MoveBy(pose) | Command::MoveByRelative(pose) => {
                self.target(self.target_m, &pose, span);
            }
            Command::SetReference(pose) => self.reference_m = self.origin_m + pose.z_m,
            Command::SetReferenceHere => self.reference_m = self.target_m,
            Command::SetReachDistance { .. }
            | Command::SetStayDistance { .. }
            | Command::SetStayTime { .. }
            | Command::SetMaxControl { .. } => {}
        }
    }

    fn target(&mut self, from_m: f64, pose: &Pose, span: &Span) {
        self.target_m = from_m + pose.z_m;
        if !self.airborne {
            self.diagnostics.push(
                Diagnostic::error("the drone is on the ground here", span.clone())
                    .help("put `takeoff` before it"),
            );
        }
        let height_m = self.target_m;
        let (low, high) = (self.limits.floor_m, self.limits.ceiling_m);
        let limit = if height_m < low - TOLERANCE_M {
            format!("below the lowest of {low} m")
        } else if height_m > high + TOLERANCE_M {
            format!("above the ceiling of {high} m")
        } else {
            return;
        };
        let origin = match self.limits.z_origin {
            ZOrigin::Hover => format!(
                "z = 0 is where the drone hovers after take-off, about {} m above the floor",
                FlightLimits::EXPECTED_HOVER_M
            ),
            ZOrigin::Floor => "z = 0 is the floor".to_owned(),
        };
        self.diagnostics.push(
            Diagnostic::error(
                format!("target {height_m:.2} m above the floor, {limit}"),
                span.clone(),
            )
            .help(origin),
        );
    }
}
