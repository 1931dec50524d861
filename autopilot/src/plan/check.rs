//! Checks of a plan that was parsed: the order of its commands, and targets inside the fence.

use diagnostic::{Diagnostic, Span};
use kinematics::Pose;

use super::Command;
use super::dry_run::DryRun;
use super::interpreter::AgentOrder;
use super::parser::Line;

/// Origin of a plan's heights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ZOrigin {
    /// Height of the hover after take-off, as in `tum_ardrone`'s plans.
    #[default]
    Hover,
    /// The floor.
    Floor,
}

impl ZOrigin {
    /// Its name on the command line and in logs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Hover => "hover",
            Self::Floor => "floor",
        }
    }

    /// The origin with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Hover, Self::Floor].into_iter().find(|origin| origin.name() == name)
    }
}

/// The fence: lowest and highest height and the radius within which the drone may fly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightLimits {
    /// Lowest target height above the floor, in metres.
    pub floor_m: f64,
    /// Highest target height above the floor, in metres.
    pub ceiling_m: f64,
    /// Largest horizontal distance of a target from the start, in metres.
    pub radius_m: f64,
    /// Origin of the plan's heights.
    pub z_origin: ZOrigin,
}

impl Default for FlightLimits {
    fn default() -> Self {
        Self { floor_m: 0.3, ceiling_m: 3.0, radius_m: 10.0, z_origin: ZOrigin::Hover }
    }
}

impl FlightLimits {
    /// Expected hover height after take-off, in metres. The true height is known only after take-off, and
    /// targets are checked against the fence again then.
    pub(super) const EXPECTED_HOVER_M: f64 = 0.85;

    /// Tolerance of the fence check: heights are typed with a few digits, and a target on the limit is
    /// inside.
    pub(super) const TOLERANCE_M: f64 = 1e-9;

    /// Height above the floor of z = 0 in the take-off reference, in metres.
    pub fn origin_height_m(&self, hover_m: f64) -> f64 {
        match self.z_origin {
            ZOrigin::Hover => hover_m,
            ZOrigin::Floor => 0.0,
        }
    }

    /// Clamps a place to the fence, shrunk horizontally by `by_m`.
    pub fn nearest_inside(&self, place: &Pose, by_m: f64) -> Pose {
        let away_m = place.x_m.hypot(place.y_m);
        let allowed_m = (self.radius_m - by_m).max(0.0);
        let share = if away_m > allowed_m { allowed_m / away_m } else { 1.0 };
        Pose {
            x_m: place.x_m * share,
            y_m: place.y_m * share,
            z_m: place.z_m.clamp(self.floor_m, self.ceiling_m),
            ..*place
        }
    }
}

/// Checks the whole plan in a dry run: order of commands and places of targets.
pub(super) fn check(lines: &[Line], text: &str, limits: &FlightLimits) -> Vec<Diagnostic> {
    let end = text.trim_end().len();
    let mut diagnostics = check_places(lines, limits);
    let flies = lines.iter().any(|line| matches!(line.command, Some(Command::TakeOff { .. })));
    if !flies && diagnostics.is_empty() {
        diagnostics.push(
            Diagnostic::error("the plan never takes off", end..end)
                .help("begin with `takeoff` and end with `land`"),
        );
    }
    diagnostics
}

/// Checks the places that the commands lead to.
pub(super) fn check_places(lines: &[Line], limits: &FlightLimits) -> Vec<Diagnostic> {
    check_places_behind(DryRun::new(limits), lines, limits)
}

/// Checks the places of commands that follow others; `run` is the dry run of those.
pub(super) fn check_places_behind(
    run: DryRun,
    lines: &[Line],
    limits: &FlightLimits,
) -> Vec<Diagnostic> {
    let mut check = Check { limits, run, diagnostics: Vec::new() };
    for line in lines {
        if let Some(command) = line.command {
            check.step(command, &line.span);
        }
    }
    check.diagnostics
}

struct Check<'a> {
    limits: &'a FlightLimits,
    run: DryRun,
    diagnostics: Vec<Diagnostic>,
}

impl Check<'_> {
    fn step(&mut self, command: Command, span: &Span) {
        let was_airborne = self.run.is_airborne();
        let order = self.run.step(command);
        let flies = matches!(
            order,
            Some(AgentOrder::GoTo(_) | AgentOrder::FindTag | AgentOrder::LandOnTag)
        );
        if flies && !was_airborne {
            self.diagnostics.push(
                Diagnostic::error("the drone is on the ground here", span.clone())
                    .help("put `takeoff` before it"),
            );
        }
        if let Some(AgentOrder::GoTo(target)) = order {
            self.target(&target.wanted, span);
        }
    }

    fn target(&mut self, target: &Pose, span: &Span) {
        let away_m = target.x_m.hypot(target.y_m);
        if away_m > self.limits.radius_m + FlightLimits::TOLERANCE_M {
            self.diagnostics.push(
                Diagnostic::error(
                    format!(
                        "target {away_m:.2} m away from the start, beyond the fence of {} m",
                        self.limits.radius_m
                    ),
                    span.clone(),
                )
                .help("the fence is `fence.radius_m` of the settings"),
            );
        }
        let height_m = target.z_m;
        let (low, high) = (self.limits.floor_m, self.limits.ceiling_m);
        let limit = if height_m < low - FlightLimits::TOLERANCE_M {
            format!("below the lowest of {low} m")
        } else if height_m > high + FlightLimits::TOLERANCE_M {
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
