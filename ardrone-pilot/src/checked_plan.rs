//! A checked plan as JSON: its expected course, and everything that is wrong or unwise.

use std::ops::Range;
use std::time::Duration;

use autopilot::plan::{
    Expectation, FlightLimits, Plan, TagUse, battery_percent, given_tag_warnings,
};
use autopilot::vehicle::{SurveyedTag, VehicleConfig};
use diagnostic::{Diagnostic, Severity, line_column};
use serde_json::{Value, json};

use crate::recording::Place;
use crate::simulation::{self, SimulatedFlight};

/// A checked plan.
#[derive(Debug)]
pub(crate) struct CheckedPlan {
    /// The plan, if it can be flown.
    pub(crate) plan: Option<Plan>,
    /// What is wrong or unwise in it, in the order of its text.
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// What is unwise in the tags of the settings, which have no place in the text.
    pub(crate) given: Vec<String>,
    /// The expected course of each step.
    pub(crate) expectations: Vec<Expectation>,
    /// Whether it was flown on a simulated drone, and not to its end.
    pub(crate) falls_short: bool,
}

impl CheckedPlan {
    /// Checks a plan for a flight with these tags of the settings, or without tags.
    pub(crate) fn new(text: &str, limits: &FlightLimits, surveyed: Option<&[SurveyedTag]>) -> Self {
        let given = given_tag_warnings(surveyed.unwrap_or_default(), limits);
        let tags = surveyed.map_or(TagUse::Off, TagUse::On);
        let (plan, mut diagnostics) = Plan::review_with_tags(text, limits, tags);
        diagnostics.sort_by_key(|diagnostic| diagnostic.span.start);
        let expectations = plan.as_ref().map_or(Vec::new(), |plan| plan.expectations(limits));
        Self { plan, diagnostics, given, expectations, falls_short: false }
    }

    /// Flies the plan on a simulated drone, and warns at the step behind which it is not flown as planned: what adds up over a
    /// flight is seen by no look at a step.
    pub(crate) fn simulate(&mut self, text: &str, config: &VehicleConfig) {
        let Some(plan) = self.plan.clone() else { return };
        let steps = plan.steps().to_vec();
        let world = simulation::world(config, Some(&plan));
        let (step, message) = match simulation::fly(plan, config, &world) {
            Ok(SimulatedFlight { outcome: Some(outcome), .. }) if outcome.exit_status() == 0 => {
                return;
            }
            Ok(flight) => (flight.step, falls_short(&flight, steps.len())),
            Err(refused) => (None, format!("it cannot be flown on a simulated drone: {refused}")),
        };
        let line = step.and_then(|step| steps.get(step)).map_or(0, |step| step.line);
        let help = "fly it with `--mock`, or in the page with Simulate; a shorter plan, or tags on the floor, may help";
        self.diagnostics.push(Diagnostic::warning(message, line_span(text, line)).help(help));
        self.diagnostics.sort_by_key(|diagnostic| diagnostic.span.start);
        self.falls_short = true;
    }

    /// All as an object; the steps are null if the plan cannot be flown. `text` is the plan's.
    pub(crate) fn json(&self, name: &str, text: &str) -> Value {
        let problems: Vec<Value> = (self.given.iter().map(|text| given_problem(text)))
            .chain(self.diagnostics.iter().map(|diagnostic| problem(diagnostic, text)))
            .collect();
        let steps = self.plan.as_ref().map(|plan| self.steps(plan));
        json!({ "plan": name, "steps": steps, "problems": problems })
    }

    fn steps(&self, plan: &Plan) -> Vec<Value> {
        let steps = plan.steps().iter().zip(&self.expectations);
        steps
            .map(|(step, expected)| {
                json!({
                    "line": (step.line > 0).then_some(step.line),
                    "command": step.text,
                    "target": expected.target.map(|pose| Place::from(&pose)),
                    "leg_m": expected.leg_m,
                    "time_s": expected.time.as_secs_f64(),
                    "battery_percent": battery_percent(expected.time),
                })
            })
            .collect()
    }
}

/// What became of a simulated flight that was not flown to its end.
fn falls_short(flight: &SimulatedFlight, steps: usize) -> String {
    let outcome = match &flight.outcome {
        Some(outcome) => outcome.to_string(),
        None => "it did not end within 20 minutes".to_owned(),
    };
    match flight.step {
        Some(step) if flight.duration > Duration::ZERO => format!(
            "flown on a simulated drone, it ends here after {:.0} s in the air, at step {} of {steps}: {outcome}",
            flight.duration.as_secs_f64(),
            step + 1
        ),
        _ => format!("flown on a simulated drone, it does not take off: {outcome}"),
    }
}

/// The text of a line, from 1; the end of the text if there is none.
fn line_span(text: &str, line: usize) -> Range<usize> {
    let mut start = 0;
    for (index, whole) in text.split_inclusive('\n').enumerate() {
        let code = whole.trim_end();
        if index + 1 == line {
            return start..start + code.len();
        }
        start += whole.len();
    }
    let end = text.trim_end().len();
    end..end
}

/// An error or a warning as JSON.
fn problem(diagnostic: &Diagnostic, text: &str) -> Value {
    let (line, column) = line_column(text, diagnostic.span.start);
    let severity = match diagnostic.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    json!({
        "severity": severity,
        "line": line,
        "column": column,
        "message": diagnostic.message,
        "help": diagnostic.help,
    })
}

/// A warning about the settings as JSON: it has no place in the plan.
fn given_problem(text: &str) -> Value {
    json!({ "severity": "warning", "line": null, "column": null, "message": text, "help": null })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checked(text: &str) -> CheckedPlan {
        let config = VehicleConfig::default();
        let mut checked = CheckedPlan::new(text, &config.limits, None);
        checked.simulate(text, &config);
        checked
    }

    /// Sixty targets over five minutes, each of which is good: the place is known worse with every metre.
    #[test]
    fn a_plan_that_is_landed_on_the_way_is_told_at_the_step() {
        let round = "goto 0 2 0 0\ngoto 2 2 0 0\ngoto 2 0 0 0\ngoto 0 0 0 0\n";
        let text = format!("takeoff\nsetStayTime 2\n{}land\n", round.repeat(15));
        let long = checked(&text);
        assert!(long.plan.is_some() && long.falls_short);
        let [warning] = &long.diagnostics[..] else { panic!("{:?}", long.diagnostics) };
        assert_eq!(warning.severity, Severity::Warning);
        assert!(warning.message.contains("position uncertainty is too large"), "{warning:?}");
        let here = &text[warning.span.clone()];
        assert!(here.starts_with("goto") && !here.contains('\n'), "{here}");
        assert_eq!(long.json("plan", &text)["problems"].as_array().map(Vec::len), Some(1));
        let short = checked("takeoff\ngoto 0 1 0 0\nland\n");
        assert!(!short.falls_short && short.diagnostics.is_empty());
    }

    #[test]
    fn lines_are_found_in_a_text() {
        let text = "takeoff\n\n  land \n";
        assert_eq!(&text[line_span(text, 3)], "  land");
        assert_eq!(line_span(text, 9), 15..15);
    }
}
