//! The fault campaign: thousands of flights on which anything may go wrong, and a table of how they
//! ended.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use autopilot::outcome::Outcome;
use autopilot::pilot::LandingReason;
use autopilot::sim::SimulationError;
use system_tests::campaign::{Verdict, fly};

use crate::parallel;

/// Flies seeds from `first`, and tells; the second value is whether nothing happened that must not.
pub(crate) fn run(flights: u64, first: u64) -> Result<(String, bool), SimulationError> {
    let seeds: Vec<u64> = (first..first.saturating_add(flights)).collect();
    let verdicts = parallel::map(&seeds, fly)?;
    let faulty = verdicts.iter().filter(|verdict| !verdict.faults.is_empty()).count();
    let story = match verdicts.as_slice() {
        [verdict] => story(verdict),
        _ => String::new(),
    };
    Ok((story + &table(&verdicts), faulty == 0))
}

/// What happened on one flight.
fn story(verdict: &Verdict) -> String {
    let mut text = String::new();
    for (at, event) in &verdict.events {
        _ = writeln!(text, "{:>8.2} s  {event}", at.as_secs_f64());
    }
    text
}

fn table(verdicts: &[Verdict]) -> String {
    let mut by_end: BTreeMap<String, Vec<&Verdict>> = BTreeMap::new();
    for verdict in verdicts {
        by_end.entry(end(verdict)).or_default().push(verdict);
    }
    let mut rows: Vec<_> = by_end.into_iter().collect();
    rows.sort_by_key(|(_, verdicts)| std::cmp::Reverse(verdicts.len()));
    let mut text = format!(
        "{:<50}{:>8}{:>8}{:>10}{:>10}{:>10}{:>8}\n",
        "how it ended", "flights", "vetoes", "outside", "unseen", "wrong", "faults"
    );
    let largest = |verdicts: &[&Verdict], of: fn(&Verdict) -> f64| {
        verdicts.iter().map(|verdict| of(verdict)).fold(0.0, f64::max)
    };
    let all: Vec<&Verdict> = verdicts.iter().collect();
    for (end, verdicts) in rows.into_iter().chain([("all".to_owned(), all)]) {
        _ = writeln!(
            text,
            "{end:<50}{:>8}{:>8}{:>8.2} m{:>8.2} m{:>8.2} m{:>8}",
            verdicts.len(),
            verdicts.iter().filter(|verdict| verdict.vetoed).count(),
            largest(&verdicts, |verdict| verdict.outside_m),
            largest(&verdicts, |verdict| verdict.unseen_m),
            largest(&verdicts, |verdict| verdict.wrong_m),
            verdicts.iter().filter(|verdict| !verdict.faults.is_empty()).count(),
        );
    }
    for verdict in verdicts.iter().filter(|verdict| !verdict.faults.is_empty()).take(20) {
        let faults: Vec<String> = verdict.faults.iter().map(ToString::to_string).collect();
        let (outside_m, wrong_m) = (verdict.outside_m, verdict.wrong_m);
        _ = writeln!(
            text,
            "seed {}: {}; {}, {outside_m:.2} m outside, navdata wrong by {wrong_m:.2} m",
            verdict.seed,
            faults.join(", "),
            end(verdict),
        );
    }
    text
}

/// One line for flights that ended alike.
fn end(verdict: &Verdict) -> String {
    match (&verdict.outcome, verdict.landing) {
        (Outcome::PreflightRefused { .. }, _) => "refused before take-off".to_owned(),
        (Outcome::Completed, _) => "plan flown to its end".to_owned(),
        (Outcome::Emergency, _) => "the drone's own emergency".to_owned(),
        (Outcome::NoDrone, _) => "no drone before take-off".to_owned(),
        (_, Some(LandingReason::Pilot)) => "landed: the pilot's order".to_owned(),
        (_, Some(LandingReason::Battery { .. })) => "landed: battery".to_owned(),
        (_, Some(LandingReason::StepFailed { .. })) => "landed: a step failed".to_owned(),
        (_, Some(LandingReason::StepTimedOut { .. })) => "landed: no progress".to_owned(),
        (_, Some(reason)) => format!("landed: {reason}"),
        (outcome, None) => outcome.to_string(),
    }
}
