//! Checks of a plan that was parsed: the order of its commands, and targets inside the fence.

use diagnostic::{Diagnostic, Figures, Span};
use kinematics::Pose;

use super::Command;
use super::dry_run::DryRun;
use super::interpreter::AgentOrder;
use super::parser::Line;
use crate::fence::{FlightLimits, ZOrigin, across};

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
        let (from, was_airborne) = (self.run.place(), self.run.is_airborne());
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
            self.way(&from, &target.pose, span);
        }
    }

    /// A straight flight between two places inside a fence that is not convex may leave it.
    fn way(&mut self, from: &Pose, to: &Pose, span: &Span) {
        let tolerance_m = FlightLimits::TOLERANCE_M;
        if let Some(stop) = self.limits.stop_before(from, to, tolerance_m, 0.0) {
            self.diagnostics.push(
                Diagnostic::error(
                    format!(
                        "the straight way to this target leaves the fence at {:.2} {:.2}",
                        stop.x_m, stop.y_m
                    ),
                    span.clone(),
                )
                .help("put a target before it, from which the way stays inside"),
            );
        }
    }

    fn target(&mut self, target: &Pose, span: &Span) {
        if self.limits.outside_m(target) > FlightLimits::TOLERANCE_M {
            let how = self.limits.border.how_far(across(target));
            self.diagnostics.push(
                Diagnostic::error(format!("target {how}"), span.clone())
                    .help("the fence is `[fence]` of the settings"),
            );
        }
        let height_m = target.z_m;
        let (low, high) = (self.limits.floor_m, self.limits.ceiling_m);
        let limit = if height_m < low - FlightLimits::TOLERANCE_M {
            format!("below the lowest of {} m", Figures(low))
        } else if height_m > high + FlightLimits::TOLERANCE_M {
            format!("above the ceiling of {} m", Figures(high))
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
                format!("target {:.2} m above the floor, {limit}", Figures(height_m)),
                span.clone(),
            )
            .help(origin),
        );
    }
}
