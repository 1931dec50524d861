//! Output of `asl2c verify`.

use std::fmt::Write as _;
use std::process::ExitCode;

use serde_json::{Value, json};
use translator::{DeclaredProperty, Model};

use super::NOT_CHECKED;
use crate::spin::Verdict;
use crate::verify::Checked;

/// Form of the output.
#[derive(Debug, Clone, Copy)]
pub(super) enum Detail {
    /// All properties, as text.
    All,
    /// Properties that do not hold or are undecided, as text.
    Failures,
    /// All properties, as JSON.
    Json,
}

/// The verdicts as text or JSON.
pub(super) fn printed(model: &Model, checked: &[Checked], detail: Detail) -> String {
    match detail {
        Detail::Json => json(checked),
        Detail::All => text(model, checked),
        Detail::Failures => {
            text(model, checked.iter().filter(|checked| !checked.verdict.is_proved()))
        }
    }
}

/// Exit status: success only if everything holds.
pub(super) fn status(checked: &[Checked]) -> ExitCode {
    let any = |wanted: fn(&Verdict) -> bool| checked.iter().any(|checked| wanted(&checked.verdict));
    if any(|verdict| matches!(verdict, Verdict::Fails(_))) {
        ExitCode::FAILURE
    } else if any(|verdict| matches!(verdict, Verdict::Undecided(_))) {
        NOT_CHECKED.into()
    } else {
        ExitCode::SUCCESS
    }
}

fn text<'a>(model: &Model, checked: impl IntoIterator<Item = &'a Checked>) -> String {
    let mut text = String::new();
    let (mut holds, mut fails) = (false, false);
    // Writing to a string cannot fail.
    for Checked { property, verdict } in checked {
        let tags = match property.requirements.as_slice() {
            [] => String::new(),
            tags => format!(" [{}]", tags.join(", ")),
        };
        let head = format!("{}{tags}", property.name);
        match verdict {
            Verdict::Holds => {
                holds = true;
                _ = writeln!(text, "{head}: holds in every environment");
            }
            Verdict::Undecided(reason) => {
                _ = writeln!(text, "{head}: NOT DECIDED: {reason}");
            }
            Verdict::Fails(happenings) => {
                fails = true;
                let DeclaredProperty { formula, .. } = property;
                _ = writeln!(text, "{head}: DOES NOT HOLD\n  {formula}");
                _ = writeln!(text, "  counterexample ({}):", model.input());
                for happening in happenings {
                    _ = writeln!(text, "    {happening}");
                }
            }
        }
    }
    if holds {
        text += "(environments that call init() again, or clear(), are not in the model: `asl2c prove` has them)\n";
    }
    if fails {
        text += "(a counterexample is one of the model, which has no values: `asl2c prove` tells whether the agent does it)\n";
    }
    text
}

fn json(checked: &[Checked]) -> String {
    let properties: Vec<Value> = checked
        .iter()
        .map(|Checked { property, verdict }| {
            let named = match verdict {
                Verdict::Holds => "holds",
                Verdict::Fails(_) => "fails",
                Verdict::Undecided(_) => "undecided",
            };
            json!({
                "name": property.name,
                "requirements": property.requirements,
                "formula": property.formula,
                "verdict": named,
                "trace": verdict.counterexample(),
            })
        })
        .collect();
    format!("{:#}\n", json!({ "properties": properties }))
}
