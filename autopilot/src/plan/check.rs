//! Checks of a plan that was parsed: the order of its commands, and targets inside the fence.

use diagnostic::{Diagnostic, Span};
use kinematics::Pose;

use super::Command;
use super::dry_run::DryRun;
use super::interpreter::AgentOrder;
use super::parser::Line;
use crate::fence::{FlightLimits, ZOrigin};

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
