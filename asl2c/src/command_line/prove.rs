//! `asl2c prove`: the proof, and counterexamples.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use serde_json::{Value, json};
use translator::{DeclaredProperty, ParsedConfiguration, ROUNDED, obligations};

use super::arguments::Prove;
use super::validate::to_replay;
use super::{CommandError, NOT_CHECKED, print, stop};
use crate::JSON_VERSION;
use crate::agent::{Agent, read};
use crate::current::check_current;
use crate::prove::{
    Cbmc, Found, Limits, Proof, ProveError, Searched, prove_beginning_with, search,
};
use crate::run::Session;
use crate::written::{WriteError, check_script, write_script};

/// A result, with its saved counterexample.
struct Saved {
    /// Result of the search.
    searched: Searched,
    /// The script, if there is a counterexample. That it cannot be written is no reason to lose the result.
    path: Option<Result<PathBuf, WriteError>>,
}

/// Proves what can be proved, searches for counterexamples to the rest, and saves them.
pub(super) fn run(asked: &Prove) -> Result<ExitCode, CommandError> {
    let agent = Agent::read(&asked.configuration)?;
    let Agent { configuration, text, .. } = &agent;
    let mut obligations = obligations(configuration, text)?;
    let own = agent.own_headers(&obligations.files)?;
    let output = asked.output.as_deref().unwrap_or(agent.folder());
    check_current(&agent, &own, output, None)?;
    obligations.files.extend(own);
    for property in &obligations.properties {
        // Not after the proof, whose result would be lost.
        check_script(output, &script_name(&asked.configuration, &property.name))?;
    }
    let known = known_conditions(asked.invariant.as_deref())?;
    let cbmc = Cbmc::find(asked.cbmc.as_deref())?.stopped_by(stop::flag()?);
    let folder = tempfile::tempdir()
        .map_err(|source| ProveError::Io { what: "no temporary folder".to_owned(), source })?;
    let proof = prove_beginning_with(&known, &obligations, &cbmc, folder.path())?;
    let mut found = Vec::new();
    if !proof.holds() {
        let session = Session::new(configuration, text)?;
        let limits = Limits { transitions: asked.length, time: Duration::from_secs(asked.time) };
        found = search(&proof, configuration, &session, &cbmc, folder.path(), limits)?;
    }
    let mut saved = Vec::new();
    for (index, searched) in found.into_iter().enumerate() {
        let path = save(&searched, index, &asked.configuration, output);
        saved.push(Saved { searched, path });
    }
    let mut text = if asked.json {
        as_json(&proof, &saved)
    } else {
        as_text(&proof, &saved, configuration, asked)
    };
    // The C says it in its head, where it matters.
    if !asked.json && !asked.quiet && obligations.files[0].text.contains(ROUNDED) {
        _ = writeln!(text, "(of the C as compiled with {ROUNDED})");
    }
    print("the result", &text)?;
    Ok(status(&proof, &saved))
}

/// The conditions of an invariant that was found earlier, one a line.
pub(super) fn known_conditions(file: Option<&Path>) -> Result<Vec<String>, CommandError> {
    let text = file.map_or(Ok(String::new()), read)?;
    Ok(text.lines().map(str::to_owned).collect())
}

fn status(proof: &Proof, saved: &[Saved]) -> ExitCode {
    if proof.holds() {
        ExitCode::SUCCESS
    } else if saved.iter().any(|saved| matches!(saved.searched.found, Found::Way(..))) {
        ExitCode::FAILURE
    } else {
        NOT_CHECKED.into()
    }
}

/// Writes a counterexample as a script, if there is one. Returns its path.
fn save(
    searched: &Searched,
    index: usize,
    configuration: &Path,
    folder: &Path,
) -> Option<Result<PathBuf, WriteError>> {
    let text = searched.script()?;
    let what = searched.property.clone().unwrap_or_else(|| format!("run_time_{}", index + 1));
    Some(write_script(folder, &script_name(configuration, &what), &text))
}

/// The path of its script.
fn written(saved: &Saved) -> Option<String> {
    let path = saved.path.as_ref()?.as_ref().ok()?;
    Some(path.display().to_string())
}

fn script_name(configuration: &Path, what: &str) -> String {
    let stem = configuration.file_stem().unwrap_or_default().to_string_lossy();
    format!("{stem}.{what}.script")
}

fn as_text(
    proof: &Proof,
    saved: &[Saved],
    configuration: &ParsedConfiguration,
    asked: &Prove,
) -> String {
    let mut text = String::new();
    for (property, holds) in &proof.properties {
        let tags = match property.requirements.as_slice() {
            [] => String::new(),
            tags => format!(" [{}]", tags.join(", ")),
        };
        let DeclaredProperty { name, formula, .. } = property;
        let of_this = |saved: &&Saved| saved.searched.property.as_deref() == Some(name.as_str());
        if *holds && !asked.quiet {
            _ = writeln!(text, "{name}{tags}: holds in every environment");
        } else if let Some(saved) = saved.iter().find(of_this).filter(|_| !holds) {
            tell(&mut text, &format!("{name}{tags}"), Some(formula), saved, configuration, asked);
        }
    }
    let run_time = saved.iter().filter(|saved| saved.searched.property.is_none());
    for saved in run_time {
        let head = format!("no `{}`", saved.searched.said);
        tell(&mut text, &head, None, saved, configuration, asked);
    }
    if proof.run_time.is_empty() && !asked.quiet {
        text += "no error at run time: holds in every environment\n";
    }
    if !asked.quiet {
        let (kept, all) = (proof.invariant.len(), proof.candidates);
        _ = writeln!(text, "(by an invariant of {kept} conditions, out of {all} candidates)");
    }
    text
}

fn tell(
    text: &mut String,
    head: &str,
    formula: Option<&str>,
    saved: &Saved,
    configuration: &ParsedConfiguration,
    asked: &Prove,
) {
    let formula = formula.map_or(String::new(), |formula| format!("  {formula}\n"));
    match &saved.searched.found {
        Found::Way(_, story) => {
            _ = writeln!(
                text,
                "{head}: DOES NOT HOLD\n{formula}  counterexample ({}):",
                configuration.input()
            );
            for happening in story {
                _ = writeln!(text, "    {happening}");
            }
            let replay = saved.path.as_ref().map(|path| to_replay(&asked.configuration, path));
            _ = writeln!(text, "  {}", replay.unwrap_or_default());
        }
        Found::Unconfirmed(_) => {
            let path = written(saved).unwrap_or_else(|| "which could not be written".to_owned());
            _ = writeln!(
                text,
                "{head}: NOT DECIDED\n{formula}  CBMC found a counterexample in the C, {path}, that the reference \
                 interpreter does not confirm: C and interpreter differ"
            );
        }
        Found::None(length) => {
            _ = writeln!(
                text,
                "{head}: NOT DECIDED\n{formula}  not proved, and no counterexample found within {length} events, beliefs \
                 and steps (--length, --time)"
            );
        }
    }
}

fn as_json(proof: &Proof, saved: &[Saved]) -> String {
    let verdict = |holds: bool, saved: Option<&Saved>| {
        let found = saved.map(|saved| &saved.searched.found);
        let (named, trace) = match found {
            _ if holds => ("holds", Value::Null),
            Some(Found::Way(_, story)) => ("fails", json!(story)),
            _ => ("undecided", Value::Null),
        };
        let script = saved.and_then(written);
        (named, trace, script)
    };
    let properties = proof.properties.iter().map(|(property, holds)| {
        let mut of_this = saved.iter();
        let of_this =
            of_this.find(|saved| saved.searched.property.as_ref() == Some(&property.name));
        let (named, trace, script) = verdict(*holds, of_this);
        json!({
            "name": property.name,
            "requirements": property.requirements,
            "formula": property.formula,
            "verdict": named,
            "trace": trace,
            "script": script,
        })
    });
    let run_time = saved.iter().filter(|saved| saved.searched.property.is_none()).map(|saved| {
        let (named, trace, script) = verdict(false, Some(saved));
        json!({ "error": saved.searched.said, "verdict": named, "trace": trace, "script": script })
    });
    let object = json!({
        "version": JSON_VERSION,
        "properties": properties.collect::<Vec<_>>(),
        "run_time": run_time.collect::<Vec<_>>(),
        "invariant": proof.invariant,
        "candidates": proof.candidates,
    });
    format!("{object:#}\n")
}
