//! `asl2c verify`: the verdicts, and counterexamples of systems as scripts.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use serde_json::{Value, json};
use translator::system::System;
use translator::{DeclaredProperty, Model};

use super::arguments::Verify;
use super::validate::to_replay;
use super::{CommandError, NOT_CHECKED, print};
use crate::JSON_VERSION;
use crate::agent::{Agent, folder, is_system, read_system};
use crate::run::{NetworkConditions, SystemSession, repeat};
use crate::spin::Verdict;
use crate::verify::{Checked, verify};
use crate::written::{WriteError, check_script, write_script};

/// A property with its verdict, and its counterexample as a script.
struct Shown {
    checked: Checked,
    script: Script,
}

/// The script of a counterexample.
enum Script {
    /// There is no counterexample, or it is that of one agent.
    None,
    /// No values were found with which the agents do what the model does.
    NoValues,
    /// Its path. That it cannot be written is no reason to lose the result.
    Written(Result<PathBuf, WriteError>),
}

/// Checks properties of an agent or of a system.
pub(super) fn run(asked: &Verify) -> Result<ExitCode, CommandError> {
    let path = &asked.configuration;
    let model = if is_system(path) {
        Model::of_system(&path.display().to_string(), read_system(path)?)
    } else {
        let Agent { configuration, text, .. } = Agent::read(path)?;
        translator::model(&configuration, &text)?
    };
    if asked.model {
        print("the model", &model.promela())?;
        return Ok(ExitCode::SUCCESS);
    }
    let output = asked.output.as_deref().unwrap_or(folder(path));
    if model.system().is_some() {
        for property in &model.properties {
            // Not after the search, whose result would be lost.
            check_script(output, &script_name(asked, &property.name))?;
        }
    }
    let only: Vec<&str> = asked.only.iter().map(String::as_str).collect();
    let mut shown = Vec::new();
    for checked in verify(&model, &only)? {
        let script = match (&checked.verdict, model.system()) {
            (Verdict::Fails(_), Some(system)) => script(asked, system, &checked)?,
            _ => Script::None,
        };
        shown.push(Shown { checked, script });
    }
    let text = if asked.json {
        json(&shown)
    } else {
        let wanted = |shown: &&Shown| !asked.quiet || !shown.checked.verdict.is_proved();
        text(&model, asked, shown.iter().filter(wanted))
    };
    print("the result", &text)?;
    Ok(status(&shown))
}

fn script_name(asked: &Verify, property: &str) -> String {
    let stem = asked.configuration.file_stem().unwrap_or_default().to_string_lossy();
    format!("{stem}.{property}.script")
}

/// Repeats the counterexample of a system with values, and saves it.
fn script(asked: &Verify, system: &System, checked: &Checked) -> Result<Script, CommandError> {
    let Verdict::Fails(way) = &checked.verdict else { return Ok(Script::None) };
    let mut session = SystemSession::new(system, NetworkConditions::PERFECT)?;
    let name = &checked.property.name;
    let Some(text) = repeat(&mut session, &way.moves, name) else { return Ok(Script::NoValues) };
    let output = asked.output.as_deref().unwrap_or(folder(&asked.configuration));
    let text = format!("// breaks `{name}`: {}\n{text}", checked.property.formula);
    Ok(Script::Written(write_script(output, &script_name(asked, name), &text)))
}

/// Exit status: success only if everything holds.
fn status(shown: &[Shown]) -> ExitCode {
    let any =
        |wanted: fn(&Verdict) -> bool| shown.iter().any(|shown| wanted(&shown.checked.verdict));
    if any(|verdict| matches!(verdict, Verdict::Fails(_))) {
        ExitCode::FAILURE
    } else if any(|verdict| matches!(verdict, Verdict::Undecided(_))) {
        NOT_CHECKED.into()
    } else {
        ExitCode::SUCCESS
    }
}

fn text<'a>(model: &Model, asked: &Verify, shown: impl Iterator<Item = &'a Shown>) -> String {
    let mut text = String::new();
    let (mut holds, mut fails) = (false, false);
    // Writing to a string cannot fail.
    for Shown { checked: Checked { property, verdict }, script } in shown {
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
            Verdict::Fails(way) => {
                fails = true;
                let DeclaredProperty { formula, .. } = property;
                _ = writeln!(text, "{head}: DOES NOT HOLD\n  {formula}");
                _ = writeln!(text, "  counterexample ({}):", model.input());
                for happening in &way.steps {
                    _ = writeln!(text, "    {happening}");
                }
                match script {
                    Script::None => {}
                    Script::NoValues => {
                        text += "  no values were found with which the agents do this: it may be one of the model only\n";
                    }
                    Script::Written(path) => {
                        _ = writeln!(text, "  {}", to_replay(&asked.configuration, path));
                    }
                }
            }
        }
    }
    if holds && model.system().is_some() {
        text +=
            "(the agents hear each other and nobody else, and each makes one step in a round)\n";
    } else if holds {
        text += "(environments that call init() again, or clear(), are not in the model: `asl2c prove` has them)\n";
    }
    if fails && model.system().is_none() {
        text += "(a counterexample is one of the model, which has no values: `asl2c prove` tells whether the agent does it)\n";
    }
    text
}

fn json(shown: &[Shown]) -> String {
    let properties: Vec<Value> = shown
        .iter()
        .map(|Shown { checked: Checked { property, verdict }, script }| {
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
                "script": match script {
                    Script::Written(Ok(path)) => Some(path.display().to_string()),
                    _ => None,
                },
            })
        })
        .collect();
    format!("{:#}\n", json!({ "version": JSON_VERSION, "properties": properties }))
}
