//! `asl2c certify`: the evidence for an agent, in a folder.

use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;

use super::arguments::Certify;
use super::prove::known_conditions;
use super::{CommandError, NOT_CHECKED, complain_of, print, stop};
use crate::agent::{Agent, read};
use crate::certify::{
    CertifyError, Evidence, Limits, Status, Verdict, certify, check_folder, find_tools,
};
use crate::coverage::OwnTest;
use crate::current::check_current;

/// Gathers the evidence, writes it and prints a summary.
pub(super) fn run(asked: &Certify) -> Result<ExitCode, CommandError> {
    let agent = Agent::read(&asked.configuration)?;
    let own_tests = asked.tests.as_deref().map_or(Ok(Vec::new()), own_tests)?;
    let tests = asked.tests.as_deref().unwrap_or(agent.folder());
    let mut inputs = agent.inputs().map_err(CertifyError::from)?;
    inputs.extend(own_tests.iter().map(|test| tests.join(&test.name)));
    // Not after an hour of proofs.
    check_folder(&asked.output, &inputs)?;
    check_current(&agent, &[], agent.folder(), None)?;
    let cbmc = find_tools(asked.cbmc.as_deref())?.stopped_by(stop::flag()?);
    let known = known_conditions(asked.invariant.as_deref())?;
    let limits = Limits { time: Duration::from_secs(asked.time), transitions: asked.length };
    let mut tell = |doing: &str| {
        if !asked.quiet {
            complain_of(&format!("asl2c {doing}"));
        }
    };
    let certified = certify(&agent, &own_tests, &cbmc, limits, &known, &mut tell)?;
    certified.write(&asked.output, &inputs)?;
    let evidence = &certified.evidence;
    let mut text = as_text(evidence);
    // Writing to a string cannot fail.
    _ = writeln!(text, "evidence: {}", asked.output.join("index.html").display());
    print("the result", &text)?;
    Ok(match evidence.status() {
        Status::Shown => ExitCode::SUCCESS,
        Status::Refuted => ExitCode::FAILURE,
        Status::Undecided => NOT_CHECKED.into(),
    })
}

/// The transcripts of a folder, by their names.
fn own_tests(folder: &Path) -> Result<Vec<OwnTest>, CommandError> {
    let unread =
        |source| CertifyError::Io { what: format!("cannot read {}", folder.display()), source };
    let mut tests = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unread)? {
        let path = entry.map_err(unread)?.path();
        if path.extension().is_some_and(|extension| extension == "transcript") {
            let transcript = read(&path)?;
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            tests.push(OwnTest { name, transcript });
        }
    }
    if tests.is_empty() {
        let folder = folder.display();
        let none = format!("{folder} has no file NAME.transcript");
        return Err(CertifyError::Test(none).into());
    }
    tests.sort_by(|left, right| left.name.cmp(&right.name));
    Ok(tests)
}

fn as_text(evidence: &Evidence) -> String {
    let proved = evidence.properties.iter().filter(|p| p.verdict == Verdict::Proved).count();
    let proved = if evidence.properties.is_empty() {
        "none is stated: the section `properties` of the configuration says what must hold"
            .to_owned()
    } else {
        format!("{proved} of {}", evidence.properties.len())
    };
    let outcomes = evidence.reach.outcomes;
    let tests = format!(
        "{} tests; of {} outcomes of conditions {} tested, {} unreachable, {} open",
        evidence.tests.len(),
        outcomes.all,
        outcomes.tested,
        outcomes.unreachable,
        outcomes.open()
    );
    let proofs = format!("{} proofs", evidence.validation.proofs);
    let rows = [
        ("C and text", evidence.validation.status, proofs),
        ("properties", evidence.properties_status(), proved),
        ("run time", evidence.run_time_status(), String::new()),
        (
            "MISRA C:2012",
            evidence.rules_status(),
            format!("{} deviations", evidence.deviations.len()),
        ),
        ("bounds", evidence.bounds_status(), evidence.bounds.missing.join("; ")),
        ("tests", evidence.tests_status(), tests),
    ];
    let untested = evidence.untested_plans();
    let mut text = String::new();
    for (what, status, detail) in rows {
        let word = match status {
            Status::Shown => "shown",
            Status::Undecided => "NOT DECIDED",
            Status::Refuted => "REFUTED",
        };
        let detail = if detail.is_empty() { detail } else { format!(" ({detail})") };
        _ = writeln!(text, "{what:<14}{word}{detail}");
    }
    if !untested.is_empty() {
        let lines: Vec<String> = untested.iter().map(|plan| plan.lines.0.to_string()).collect();
        let file = &evidence.agent;
        _ = writeln!(
            text,
            "no test chooses the plans in these lines of {file}: {}",
            lines.join(", ")
        );
    }
    text
}
