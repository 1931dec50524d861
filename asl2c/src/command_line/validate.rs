//! `asl2c validate`: the comparison of an agent's C with a second translation.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use judged_c::judge;
use serde_json::json;
use translator::{CounterexampleStep, ROUNDED, comparison};

use super::arguments::{Validate, is_json};
use super::difference::{Search, Way};
use super::progress::Progress;
use super::{CommandError, NOT_CHECKED, print, stop};
use crate::JSON_VERSION;
use crate::agent::{Agent, read};
use crate::current::check_current;
use crate::prove::{Budget, Cbmc, Difference, ProveError, Validated, Watch as _, validate_watched};
use crate::run::Session;
use crate::written::{WriteError, check_script, write_script};

/// A difference, what the agent does on the way to it, and its script.
struct Shown {
    way: Way,
    story: Vec<CounterexampleStep>,
    path: Result<PathBuf, WriteError>,
}

/// Compares, searches for a way to what differs, and saves it.
pub(super) fn run(asked: &Validate) -> Result<ExitCode, CommandError> {
    let agent = Agent::read(&asked.configuration)?;
    let Agent { configuration, text, .. } = &agent;
    let mut comparison = comparison(configuration, text)?;
    let c = match &asked.c {
        Some(c) => read(c)?,
        None => comparison.files[0].text.clone(),
    };
    // From here on there is only C of a known language: it is compared and, in the search, executed.
    let own = agent.own_headers(&comparison.files)?;
    let output = asked.output.as_deref().unwrap_or(agent.folder());
    check_current(&agent, &own, output, asked.c.as_deref())?;
    let judged = judge(&comparison, &c, own.iter().map(|header| header.text.as_str()))?;
    let compiled = judged.may_be_contracted().then_some(ROUNDED);
    judged.put_into(&mut comparison);
    comparison.files.extend(own);
    // Not after the proofs, whose result would be lost.
    check_script(output, &script_name(&asked.configuration))?;
    let cbmc = Cbmc::find(asked.cbmc.as_deref())?;
    let folder = tempfile::tempdir()
        .map_err(|source| ProveError::Io { what: "no temporary folder".to_owned(), source })?;
    let [each, total] = [asked.time, asked.total].map(Duration::from_secs);
    let budget = Budget::begin(each, Some(total));
    let quiet = asked.quiet || is_json(&asked.message_format);
    let progress = Progress::new(quiet, stop::flag()?);
    let validated = validate_watched(&comparison, &cbmc, folder.path(), budget, &progress)?;
    let mut none = 0;
    let mut shown = None;
    if validated.differs() {
        let search = Search {
            agent: &agent,
            comparison: &comparison,
            validated: &validated,
            cbmc: &cbmc,
            folder: folder.path(),
            length: asked.length,
            budget,
            watch: &progress,
        };
        let way;
        (way, none) = search.way()?;
        if let Some(way) = way {
            let session = Session::new(configuration, text)?;
            let (story, path) = show(&way.difference, &session, &asked.configuration, output);
            shown = Some(Shown { way, story, path });
        }
    }
    let c = match &asked.c {
        Some(c) => c.display().to_string(),
        None => comparison.files[0].name.clone(),
    };
    progress.close();
    let text = if asked.json {
        as_json(&c, &validated, shown.as_ref(), compiled)
    } else {
        as_text((&c, compiled), &validated, (shown.as_ref(), none), &agent, progress.stops())
    };
    print("the result", &text)?;
    Ok(if shown.is_some() {
        ExitCode::FAILURE
    } else if validated.is_proved() {
        ExitCode::SUCCESS
    } else {
        NOT_CHECKED.into()
    })
}

/// How a script is replayed, or why it is not there.
pub(super) fn to_replay(agent: &Path, script: &Result<PathBuf, WriteError>) -> String {
    match script {
        Ok(path) => {
            format!("to replay it: asl2c run {} --script {}", agent.display(), path.display())
        }
        Err(error) => format!("there is no script to replay it: {error}"),
    }
}

fn script_name(configuration: &Path) -> String {
    let stem = configuration.file_stem().unwrap_or_default().to_string_lossy();
    format!("{stem}.differs.script")
}

/// Writes the way to a difference as a script. Returns what the agent does on it, and the script's path; that it cannot be
/// written is no reason to lose the result.
fn show(
    difference: &Difference,
    session: &Session,
    configuration: &Path,
    folder: &Path,
) -> (Vec<CounterexampleStep>, Result<PathBuf, WriteError>) {
    let mut text = format!("// The C differs: {}\n", difference.said);
    for line in &difference.lines {
        // Writing to a string cannot fail.
        _ = writeln!(text, "{line}");
    }
    let path = write_script(folder, &script_name(configuration), &text);
    let mut session = session.clone();
    let story = difference.lines.iter().flat_map(|line| session.happenings(line)).collect();
    (story, path)
}

fn as_text(
    (c, compiled): (&str, Option<&str>),
    validated: &Validated,
    (shown, none): (Option<&Shown>, u32),
    agent: &Agent,
    stopped: bool,
) -> String {
    let mut text = String::new();
    let input = agent.configuration.input();
    if let Some(Shown { way, story, path }) = shown {
        let Way { difference, is_shortest } = way;
        _ = writeln!(text, "{c}: DIFFERS from {input}\n  what the agent does ({input}):");
        for happening in story {
            _ = writeln!(text, "    {happening}");
        }
        _ = writeln!(text, "  in the last of these, the C differs: {}", difference.said);
        if !is_shortest {
            _ = writeln!(
                text,
                "  (there may be a shorter way, of more than {none} events, beliefs and steps)"
            );
        }
        _ = writeln!(text, "  {}", to_replay(&agent.path, path));
    } else if validated.is_proved() {
        let compiled =
            compiled.map_or(String::new(), |option| format!(", if compiled with {option}"));
        _ = writeln!(text, "{c}: does what {input} says, in every environment{compiled}");
        _ = writeln!(
            text,
            "({} proofs, with up to {} answers of an action in a step)",
            validated.proofs, validated.calls
        );
    } else {
        _ = writeln!(text, "{c}: NOT DECIDED");
        for open in &validated.open {
            _ = writeln!(text, "  in some state, {open}");
        }
        if validated.timeouts > 0 {
            let Validated { timeouts, proofs, .. } = validated;
            let why = if stopped { "before the stop" } else { "in time (--time, --total)" };
            _ = writeln!(text, "  {timeouts} of {proofs} proofs were not finished {why}");
        }
        if validated.differs() {
            _ = writeln!(
                text,
                "  no way from the start to such a state was found: tests of the agent do not reach one, and there is \
                 none within {none} events, beliefs and steps (--length, --time, --total)"
            );
        }
    }
    text
}

fn as_json(
    c: &str,
    validated: &Validated,
    shown: Option<&Shown>,
    compiled: Option<&str>,
) -> String {
    let verdict = match shown {
        Some(_) => "differs",
        None if validated.is_proved() => "proved",
        None => "undecided",
    };
    let object = json!({
        "version": JSON_VERSION,
        "c": c,
        "verdict": verdict,
        "proofs": validated.proofs,
        "timeouts": validated.timeouts,
        "calls": validated.calls,
        "compile_with": compiled,
        "open": validated.open,
        "is_shortest": shown.map(|shown| shown.way.is_shortest),
        "difference": shown.map(|shown| &shown.way.difference.said),
        "trace": shown.map(|shown| &shown.story),
        "script": shown.and_then(|shown| shown.path.as_ref().ok()).map(|path| path.display().to_string()),
    });
    format!("{object:#}\n")
}
