//! `asl2c verify`: tells which properties hold in every environment.

use std::fmt::Write as _;
use std::io::Write as _;
use std::process::ExitCode;

use serde_json::{Value, json};
use translator::{Model, Promise};

use crate::spin::{self, SpinError, Verdict};

/// Why nothing was checked.
#[derive(Debug, thiserror::Error)]
pub(crate) enum VerifyError {
    #[error(transparent)]
    Spin(#[from] SpinError),
    #[error("the configuration has no property `{name}`")]
    Unknown { name: String },
}

/// Prints the model.
pub(crate) fn print(model: &Model) -> ExitCode {
    // What cannot be printed has nowhere else to go.
    _ = write!(std::io::stdout(), "{}", model.promela());
    ExitCode::SUCCESS
}

/// Checks and prints; fails unless everything holds.
pub(crate) fn run(model: &Model, only: &[String], as_json: bool) -> Result<ExitCode, VerifyError> {
    let verdicts = spin::check(model, &numbers(model, only)?)?;
    let text = if as_json { json(&verdicts) } else { text(model, &verdicts) };
    _ = write!(std::io::stdout(), "{text}");
    let holds = verdicts.iter().all(|(_, verdict)| matches!(verdict, Verdict::Holds));
    Ok(if holds { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// The numbers of the properties to check: of all, unless some are named.
fn numbers(model: &Model, only: &[String]) -> Result<Vec<usize>, VerifyError> {
    if only.is_empty() {
        return Ok((1..=model.properties.len()).collect());
    }
    let number = |name: &String| {
        let index = model.properties.iter().position(|promise| promise.name == *name);
        index.map(|index| index + 1).ok_or_else(|| VerifyError::Unknown { name: name.clone() })
    };
    only.iter().map(number).collect()
}

fn text(model: &Model, verdicts: &[(Promise, Verdict)]) -> String {
    if verdicts.is_empty() {
        return "the configuration has no properties\n".to_owned();
    }
    let mut text = String::new();
    // Writing to a string cannot fail.
    for (promise, verdict) in verdicts {
        let tags = match promise.requirements.as_slice() {
            [] => String::new(),
            tags => format!(" [{}]", tags.join(", ")),
        };
        let head = format!("{}{tags}", promise.name);
        match verdict {
            Verdict::Holds => _ = writeln!(text, "{head}: holds in every environment"),
            Verdict::Undecided(reason) => {
                _ = writeln!(text, "{head}: NOT DECIDED: {reason}");
            }
            Verdict::Fails(happenings) => {
                let Promise { formula, .. } = promise;
                _ = writeln!(text, "{head}: DOES NOT HOLD\n  {formula}");
                _ = writeln!(text, "  for this can happen ({}):", model.input());
                for happening in happenings {
                    _ = writeln!(text, "    {happening}");
                }
            }
        }
    }
    text
}

fn json(verdicts: &[(Promise, Verdict)]) -> String {
    let properties: Vec<Value> = verdicts
        .iter()
        .map(|(promise, verdict)| {
            let (verdict, happenings) = match verdict {
                Verdict::Holds => ("holds", [].as_slice()),
                Verdict::Fails(happenings) => ("fails", happenings.as_slice()),
                Verdict::Undecided(_) => ("undecided", [].as_slice()),
            };
            json!({
                "name": promise.name,
                "requirements": promise.requirements,
                "formula": promise.formula,
                "verdict": verdict,
                "trace": happenings,
            })
        })
        .collect();
    format!("{:#}\n", json!({ "properties": properties }))
}
