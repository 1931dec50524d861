//! `asl2c certify`: the evidence for an agent, in a folder.

use std::fmt::Write as _;
use std::process::ExitCode;
use std::time::Duration;

use super::arguments::Certify;
use super::{CommandError, NOT_CHECKED, complain_of, print, stop};
use crate::agent::Agent;
use crate::certify::{Evidence, Limits, Status, Verdict, certify, check_folder, write};
use crate::prove::Cbmc;

/// Gathers the evidence, writes it and prints a summary.
pub(super) fn run(asked: &Certify) -> Result<ExitCode, CommandError> {
    let agent = Agent::read(&asked.configuration)?;
    // Not after an hour of proofs.
    check_folder(&asked.output)?;
    let cbmc = Cbmc::find(asked.cbmc.as_deref())?.stopped_by(stop::flag()?);
    let limits = Limits { time: Duration::from_secs(asked.time), transitions: asked.length };
    let mut tell = |doing: &str| {
        if !asked.quiet {
            complain_of(&format!("asl2c {doing}"));
        }
    };
    let certified = certify(&agent, &cbmc, limits, &mut tell)?;
    write(&certified, &asked.output)?;
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

fn as_text(evidence: &Evidence) -> String {
    let proved = evidence.properties.iter().filter(|p| p.verdict == Verdict::Proved).count();
    let proved = format!("{proved} of {}", evidence.properties.len());
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
    text
}
