//! Warnings about commands that are legal but unwise.

use std::time::Duration;

use diagnostic::{Diagnostic, Figures, Span};
use kinematics::{Pose, wrap_deg};

use super::expectation::Expectations;
use super::parser::Line;
use super::{Command, FlightLimits, battery_percent};
use crate::agent::LANDING_BATTERY_PERCENT;

/// Distance from the fence, in metres, below which overshoot in wind would trigger the safety monitor.
const NEAR_FENCE_M: f64 = 0.5;
/// Height, in metres, below which the propellers' downwash disturbs the drone.
const LOW_M: f64 = 0.4;
/// Stay time, in seconds, beyond which an estimate from navdata alone drifts far.
const LONG_STAY_S: f64 = 60.0;
/// Largest advisable use of a new battery, in percent; an old or cold one holds less.
const CAREFUL_PERCENT: f64 = 70.0;

/// All warnings about these lines.
pub(super) fn warnings(lines: &[Line], limits: &FlightLimits) -> Vec<Diagnostic> {
    let mut review =
        Review { limits, expectations: Expectations::new(limits), diagnostics: Vec::new() };
    let mut time = Duration::ZERO;
    let mut end: Option<&Line> = None;
    for line in lines {
        if let Some(command) = line.command {
            time += review.step(command, &line.span);
            end = Some(line);
        }
    }
    if let Some(end) = end {
        review.battery(time, &end.span);
    }
    review.unused_settings(lines);
    review.diagnostics
}

struct Review<'a> {
    limits: &'a FlightLimits,
    expectations: Expectations,
    diagnostics: Vec<Diagnostic>,
}

impl Review<'_> {
    fn warn(&mut self, message: impl Into<String>, span: &Span, help: impl Into<String>) {
        self.diagnostics.push(Diagnostic::warning(message, span.clone()).help(help));
    }

    /// Checks a step and returns its expected duration.
    fn step(&mut self, command: Command, span: &Span) -> Duration {
        let before = self.expectations.place();
        let expected = self.expectations.step(command);
        let settings = self.expectations.settings();
        match command {
            Command::SetReachDistance { .. } | Command::SetStayDistance { .. }
                if settings.stay_distance_m < settings.reach_distance_m =>
            {
                self.warn(
                    "the drone may stray less while it stays than when it arrives",
                    span,
                    "each stay would restart until the drone is that near: make `setStayWithinDist` larger than \
                     `setInitialReachDist`",
                );
            }
            Command::SetStayTime { time_s } if time_s > LONG_STAY_S => self.warn(
                format!("the drone stays for {} s at each target", Figures(time_s)),
                span,
                "its position is known by navdata alone: the uncertainty grows the longer it hovers",
            ),
            _ => {}
        }
        // A target outside the fence is an error already.
        if let Some(target) = expected.target.filter(|_| !expected.outside) {
            self.target(&before, &target, expected.leg_m, span);
        }
        expected.time
    }

    fn target(&mut self, before: &Pose, target: &Pose, leg_m: f64, span: &Span) {
        let turns = wrap_deg(target.yaw_deg - before.yaw_deg).abs() > 5.0;
        let reach_m = self.expectations.settings().reach_distance_m;
        if leg_m > 0.0 && leg_m <= reach_m && !turns {
            self.warn(
                format!(
                    "the target is {leg_m:.2} m away, and counts as reached from {} m",
                    Figures(reach_m)
                ),
                span,
                "the drone will hardly move: make `setInitialReachDist` smaller",
            );
        }
        let to_fence_m = (-self.limits.outside_m(target)).max(0.0);
        if to_fence_m < NEAR_FENCE_M {
            self.warn(
                format!("the target is {to_fence_m:.2} m from the fence"),
                span,
                "a drone that the wind pushes over it is turned back: leave half a metre",
            );
        }
        if (self.limits.floor_m..LOW_M).contains(&target.z_m) {
            self.warn(
                format!("the target is {:.2} m above the floor", target.z_m),
                span,
                "so low the drone's own wind shakes it",
            );
        }
    }

    fn battery(&mut self, time: Duration, span: &Span) {
        let percent = battery_percent(time);
        let left = 100.0 - f64::from(LANDING_BATTERY_PERCENT);
        if percent > left {
            self.warn(
                format!("the plan takes about {percent:.0} % of a new battery, which lands at {LANDING_BATTERY_PERCENT} %"),
                span,
                "it will not be flown to its end: divide it",
            );
        } else if percent > CAREFUL_PERCENT {
            self.warn(
                format!("the plan takes about {percent:.0} % of a new battery"),
                span,
                "an old or cold battery will not carry it to its end",
            );
        }
    }

    /// Warns of settings behind the last target, which have no effect.
    fn unused_settings(&mut self, lines: &[Line]) {
        let before = self.diagnostics.len();
        for line in lines.iter().rev() {
            match line.command.and_then(Command::concerns_targets) {
                Some(true) => break,
                Some(false) => {
                    self.warn(
                        "no target comes after this",
                        &line.span,
                        "put it before the targets",
                    );
                }
                None => {}
            }
        }
        self.diagnostics[before..].reverse();
    }
}

#[cfg(test)]
mod tests {
    use diagnostic::{Severity, line_column};

    use crate::plan::{FlightLimits, Plan};

    /// Line and message of each warning.
    fn warned(text: &str) -> Vec<(usize, String)> {
        let (plan, diagnostics) = Plan::review(text, &FlightLimits::default());
        assert!(plan.is_some(), "{diagnostics:?}");
        assert!(diagnostics.iter().all(|diagnostic| diagnostic.severity == Severity::Warning));
        let place = |start| line_column(text, start).0;
        diagnostics.into_iter().map(|d| (place(d.span.start), d.message)).collect()
    }

    #[test]
    fn legal_but_unwise_commands_are_reported() {
        for (lines, message) in [
            ("goto 9.7 0 0 0", "the target is 0.30 m from the fence"),
            ("goto 0 0 -0.5 0", "the target is 0.35 m above the floor"),
            ("moveBy 0.1 0 0 0", "the target is 0.10 m away, and counts as reached from 0.2 m"),
            ("setStayTime 61\ngoto 0 1 0 0", "the drone stays for 61 s at each target"),
            (
                "setStayWithinDist 0.1\ngoto 0 1 0 0",
                "the drone may stray less while it stays than when it arrives",
            ),
            ("goto 0 1 0 0\nsetInitialReachDist 0.1", "no target comes after this"),
            ("goto 10 0 0 0", "the target is 0.00 m from the fence"),
        ] {
            let warned = warned(&format!("takeoff\n{lines}\nland\n"));
            assert_eq!(warned.len(), 1, "{lines}: {warned:?}");
            assert_eq!(warned[0].1, message);
        }
    }

    #[test]
    fn a_plan_that_takes_most_of_a_battery_is_reported_at_its_end() {
        let hover = "goto 0 1 0 0\ngoto 0 0 0 0\n".repeat(65);
        let warned = warned(&format!("takeoff\n{hover}land\n"));
        assert_eq!(warned, [(132, "the plan takes about 73 % of a new battery".to_owned())]);
    }

    #[test]
    fn every_setting_behind_the_last_target_is_named_in_order() {
        let text =
            "takeoff\ngoto 0 1 0 0\nsetStayTime 1\nsetMaxControl 1\nsetReference $POSE$\nland\n";
        let lines: Vec<usize> = warned(text).into_iter().map(|(line, _)| line).collect();
        assert_eq!(lines, [3, 5]);
    }

    #[test]
    fn good_plans_are_left_alone() {
        assert_eq!(warned("takeoff\ngoto 0 0 0 0\nmoveBy 0 0 0 90\ngoto 0 1 0 0\nland\n"), []);
    }

    #[test]
    fn the_operator_sees_that_there_are_warnings() {
        let notes = |text| Plan::parse("p.txt", text).unwrap().notes().to_vec();
        assert!(notes("takeoff\ngoto 0 1 0 0\nland\n").is_empty());
        let low = notes("takeoff\ngoto 0 0 -0.5 0\nland\n");
        assert_eq!(low, ["there is a warning: run `ardrone-pilot check p.txt`"]);
    }

    /// Lines before one that cannot be parsed are checked too.
    #[test]
    fn all_problems_are_reported_at_once() {
        let text = "takeoff\ngoto 50 0 0 0\nfly\ngoto 60 0 0 0\ngoto 1\n";
        let (plan, diagnostics) = Plan::review(text, &FlightLimits::default());
        assert!(plan.is_none());
        let mut lines: Vec<usize> =
            diagnostics.iter().map(|d| line_column(text, d.span.start).0).collect();
        lines.sort_unstable();
        assert_eq!(lines, [2, 3, 5]);
    }
}
