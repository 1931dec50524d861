//! The fault campaign: thousands of flights with random faults, and a table of their outcomes.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use autopilot::outcome::Outcome;
use autopilot::vehicle::LandingReason;
use system_tests::airframes::Airframes;
use system_tests::campaign::{Fault, Verdict, fly_of};
use system_tests::sim::SimulationError;

use crate::parallel;

/// Flies seeds from `first` and returns the report; the second value is whether no fault was found.
pub(crate) fn run(
    airframes: Airframes,
    flights: u64,
    first: u64,
) -> Result<(String, bool), SimulationError> {
    let seeds: Vec<u64> = (first..first.saturating_add(flights)).collect();
    let verdicts = parallel::map(&seeds, |seed| fly_of(airframes, seed))?;
    let good = verdicts.iter().all(|verdict| verdict.faults.is_empty());
    let text = match verdicts.as_slice() {
        [verdict] => describe(verdict),
        _ => table(&verdicts) + &faults(&verdicts),
    };
    Ok((text, good))
}

/// Description of one flight.
fn describe(verdict: &Verdict) -> String {
    let mut text = String::new();
    for line in &verdict.circumstances {
        _ = writeln!(text, "{line}");
    }
    let events = verdict.events.iter().map(|(at, event)| (*at, event.to_string()));
    let faults = verdict.faults.iter().map(|(at, fault)| (*at, format!("FAULT: {fault}")));
    let mut lines: Vec<_> = events.chain(faults).collect();
    lines.sort_by_key(|(at, _)| *at);
    for (at, line) in lines {
        _ = writeln!(text, "{:>8.2} s  {line}", at.as_secs_f64());
    }
    _ = writeln!(text, "{}", verdict.outcome);
    let Verdict { outside_m, wrong_m, .. } = verdict;
    _ = writeln!(
        text,
        "{outside_m:.2} m outside the fence, healthy sensors wrong by {wrong_m:.2} m"
    );
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
        "{:<50}{:>8}{:>8}{:>10}{:>10}{:>8}\n",
        "how it ended", "flights", "vetoes", "outside", "wrong", "faulty"
    );
    let largest = |verdicts: &[&Verdict], of: fn(&Verdict) -> f64| {
        verdicts.iter().map(|verdict| of(verdict)).fold(0.0, f64::max)
    };
    let all: Vec<&Verdict> = verdicts.iter().collect();
    for (end, verdicts) in rows.into_iter().chain([("all".to_owned(), all)]) {
        _ = writeln!(
            text,
            "{end:<50}{:>8}{:>8}{:>8.2} m{:>8.2} m{:>8}",
            verdicts.len(),
            verdicts.iter().filter(|verdict| verdict.vetoed).count(),
            largest(&verdicts, |verdict| verdict.outside_m),
            largest(&verdicts, |verdict| verdict.wrong_m),
            verdicts.iter().filter(|verdict| !verdict.faults.is_empty()).count(),
        );
    }
    text
}

/// Faults found: how often, and the first flights with each.
fn faults(verdicts: &[Verdict]) -> String {
    /// Maximum number of flights listed for each kind.
    const NAMED: usize = 20;
    let mut by_kind: BTreeMap<String, Vec<(u64, &Fault)>> = BTreeMap::new();
    for verdict in verdicts {
        for (_, fault) in &verdict.faults {
            by_kind.entry(fault.kind()).or_default().push((verdict.seed, fault));
        }
    }
    let mut kinds: Vec<_> = by_kind.into_iter().collect();
    kinds.sort_by_key(|(_, found)| std::cmp::Reverse(found.len()));
    let mut text = String::new();
    for (kind, found) in kinds {
        _ = writeln!(text, "{kind}: {} flights", found.len());
        for (seed, fault) in found.iter().take(NAMED) {
            _ = writeln!(text, "  seed {seed}: {fault}");
        }
    }
    text
}

/// One line for flights with the same outcome.
fn end(verdict: &Verdict) -> String {
    match (&verdict.outcome, verdict.landing) {
        (Outcome::PreflightRefused { .. }, _) => "refused before take-off".to_owned(),
        (Outcome::Completed, _) => "plan flown to its end".to_owned(),
        (Outcome::Emergency, _) => "the drone's own emergency".to_owned(),
        (Outcome::NoDrone, _) => "no drone before take-off".to_owned(),
        (_, Some(LandingReason::Operator)) => "landed: the operator's order".to_owned(),
        (_, Some(LandingReason::Battery { .. })) => "landed: battery".to_owned(),
        (_, Some(LandingReason::StepFailed { .. })) => "landed: a step failed".to_owned(),
        (_, Some(LandingReason::StepTimedOut { .. })) => "landed: no progress".to_owned(),
        (_, Some(reason)) => format!("landed: {reason}"),
        (outcome, None) => outcome.to_string(),
    }
}
