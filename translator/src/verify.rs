//! `asl2c verify`: tells which properties hold in every environment.

use std::fmt::Write as _;
use std::process::ExitCode;

use serde_json::{Value, json};
use translator::{Model, Promise};

use crate::NOT_CHECKED;
use crate::spin::{self, SpinError, Verdict};

/// Why nothing was checked.
#[derive(Debug, thiserror::Error)]
pub(crate) enum VerifyError {
    #[error(transparent)]
    Spin(#[from] SpinError),
    #[error("the configuration has no properties: there is nothing to check")]
    Nothing,
    #[error("the configuration has no property `{name}`")]
    Unknown { name: String },
}

/// What is told of the properties.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Told {
    /// Each, for people.
    All,
    /// Those that do not hold or are not decided, for people.
    Failures,
    /// Each, for programs.
    Json,
}

/// Checks, and says what was found and how to exit: well only if everything holds.
pub(crate) fn run(
    model: &Model,
    only: &[String],
    told: Told,
) -> Result<(String, ExitCode), VerifyError> {
    if model.properties.is_empty() {
        return Err(VerifyError::Nothing);
    }
    let verdicts = spin::check(model, &numbers(model, only)?)?;
    let text = match told {
        Told::Json => json(&verdicts),
        Told::All => text(model, &verdicts),
        Told::Failures => {
            let holds = |verdict: &Verdict| matches!(verdict, Verdict::Holds);
            let failed: Vec<_> = verdicts.iter().filter(|(_, verdict)| !holds(verdict)).collect();
            text(model, failed)
        }
    };
    let any = |wanted: fn(&Verdict) -> bool| verdicts.iter().any(|(_, verdict)| wanted(verdict));
    let status = if any(|verdict| matches!(verdict, Verdict::Fails(_))) {
        ExitCode::FAILURE
    } else if any(|verdict| matches!(verdict, Verdict::Undecided(_))) {
        NOT_CHECKED.into()
    } else {
        ExitCode::SUCCESS
    };
    Ok((text, status))
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

fn text<'a>(model: &Model, verdicts: impl IntoIterator<Item = &'a (Promise, Verdict)>) -> String {
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
