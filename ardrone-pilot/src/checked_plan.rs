//! A checked plan as JSON: its expected course, and everything that is wrong or unwise.

use autopilot::plan::{
    Expectation, FlightLimits, Plan, TagUse, battery_percent, given_tag_warnings,
};
use autopilot::vehicle::SurveyedTag;
use diagnostic::{Diagnostic, Severity, line_column};
use serde_json::{Value, json};

use crate::recording::Place;

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
}

impl CheckedPlan {
    /// Checks a plan for a flight with these tags of the settings, or without tags.
    pub(crate) fn new(text: &str, limits: &FlightLimits, surveyed: Option<&[SurveyedTag]>) -> Self {
        let given = given_tag_warnings(surveyed.unwrap_or_default(), limits);
        let tags = surveyed.map_or(TagUse::Off, TagUse::On);
        let (plan, mut diagnostics) = Plan::review_with_tags(text, limits, tags);
        diagnostics.sort_by_key(|diagnostic| diagnostic.span.start);
        let expectations = plan.as_ref().map_or(Vec::new(), |plan| plan.expectations(limits));
        Self { plan, diagnostics, given, expectations }
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
