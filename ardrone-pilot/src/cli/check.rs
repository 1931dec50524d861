//! `ardrone-pilot check`: expected course of a plan, its errors and warnings.

use std::fmt;
use std::path::Path;
use std::time::Duration;

use autopilot::plan::{Expectation, Plan, battery_percent};
use diagnostic::{Severity, Source, render_all};
use kinematics::Pose;

use super::arguments::CheckPlan;
use super::{CommandError, terminal};
use crate::checked_plan::CheckedPlan;
use crate::json;
use crate::plan_drawing;

/// Checks a plan, prints the findings, and draws it if asked to. The exit status is 20 for a plan that cannot
/// be flown.
pub(super) fn run(arguments: &CheckPlan) -> Result<u8, CommandError> {
    let mut settings = super::read_settings(arguments.config.as_deref())?;
    if arguments.tags || !arguments.tag.is_empty() {
        settings.use_tags(&arguments.tag)?;
    }
    let config = settings.pilot_config(arguments.z_origin.into());
    let limits = config.limits;
    let text = super::read("the plan", &arguments.plan)?;
    let name = arguments.plan.display().to_string();
    let source = Source { name: &name, text: &text };
    let surveyed = settings.surveyed_tags();
    let mut checked = CheckedPlan::new(&text, &limits, surveyed.as_deref());
    checked.simulate(&text, &config);
    let printed = if arguments.json {
        json::text_in_lines(&checked.json(&name, &text)) + "\n"
    } else {
        let CheckedPlan { plan, diagnostics, given, expectations, falls_short } = &checked;
        let table = plan.as_ref().map(|plan| Table { plan, expectations }.to_string());
        let table = table.unwrap_or_default();
        let problems = render_all(diagnostics, &source);
        let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error).count();
        let verdict = match (errors, diagnostics.len() + given.len()) {
            (0, warnings) if *falls_short => {
                let plural = if warnings == 1 { "" } else { "s" };
                format!("{name} can be flown, but not to its end; {warnings} warning{plural}")
            }
            (0, 0) => format!("{name} can be flown"),
            (0, 1) => format!("{name} can be flown; 1 warning"),
            (0, warnings) => format!("{name} can be flown; {warnings} warnings"),
            (1, _) => format!("{name} cannot be flown: 1 error"),
            (errors, _) => format!("{name} cannot be flown: {errors} errors"),
        };
        let given: Vec<String> = given.iter().map(|text| format!("warning: {text}")).collect();
        let parts = [table, given.join("\n"), problems, verdict];
        let parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        parts.join("\n\n") + "\n"
    };
    terminal::print(printed);
    let Some(plan) = checked.plan else { return Ok(20) };
    if let Some(path) = &arguments.svg {
        write_drawing(path, &plan_drawing::svg(&name, &plan, &limits)?)?;
    }
    Ok(0)
}

/// Writes what was drawn.
pub(super) fn write_drawing(path: &Path, drawing: &str) -> Result<(), CommandError> {
    std::fs::write(path, drawing).map_err(|source| CommandError::Write {
        what: "the drawing",
        path: path.display().to_string(),
        source,
    })
}

/// A plan with its expected course.
struct Table<'a> {
    plan: &'a Plan,
    expectations: &'a [Expectation],
}

impl fmt::Display for Table<'_> {
    /// A table of steps, with the totals below.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let steps = || self.plan.steps().iter().zip(self.expectations);
        let width = steps().map(|(step, _)| step.text.chars().count()).max().unwrap_or(0).max(7);
        writeln!(
            f,
            "line  {:<width$}  {:>7} {:>7} {:>7} {:>6}  {:>6} {:>7} {:>7}",
            "command", "x", "y", "z", "yaw", "leg", "time", "battery"
        )?;
        for (step, expected) in steps() {
            let line = if step.line == 0 { "-".to_owned() } else { step.line.to_string() };
            let target = expected.target.map(|Pose { x_m, y_m, z_m, yaw_deg }| {
                format!("{x_m:>7.2} {y_m:>7.2} {z_m:>7.2} {yaw_deg:>6.0}")
            });
            let cost = (expected.time > Duration::ZERO).then(|| {
                let (seconds, percent) =
                    (expected.time.as_secs_f64(), battery_percent(expected.time));
                format!("{:>4.1} m {seconds:>5.1} s {percent:>5.1} %", expected.leg_m)
            });
            let (target, cost) = (target.unwrap_or_default(), cost.unwrap_or_default());
            let row = format!("{line:>4}  {:<width$}  {target:>30}  {cost}", step.text);
            writeln!(f, "{}", row.trim_end())?;
        }
        let leg_m: f64 = self.expectations.iter().map(|expected| expected.leg_m).sum();
        let time: Duration = self.expectations.iter().map(|expected| expected.time).sum();
        write!(
            f,
            "      {:<width$}  {:>30}  {leg_m:>4.1} m {:>5.1} s {:>5.1} %",
            "together",
            "",
            time.as_secs_f64(),
            battery_percent(time)
        )?;
        write!(
            f,
            "\n\nm above the floor, right and forward of the take-off; yaw in degrees, clockwise; of a new battery"
        )?;
        for note in self.plan.notes() {
            write!(f, "\nnote: {note}")?;
        }
        Ok(())
    }
}
