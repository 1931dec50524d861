//! Searches for counterexamples to what could not be proved.

use std::collections::BTreeSet;
use std::path::Path;
use std::time::{Duration, Instant};

use translator::configuration::Formula;
use translator::{CounterexampleStep, ParsedConfiguration};

use super::cbmc::{Cbmc, Failure};
use super::shrink::shortest;
use super::trace::Way;
use super::{Proof, ProveError};
use crate::run::{IDLE, Session};

/// Limits of the search.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    /// Maximum length: events raised, beliefs set and steps.
    pub(crate) transitions: u32,
    /// Total time limit.
    pub(crate) time: Duration,
}

/// Result of the search for one unproved assertion.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Searched {
    /// The property; `None` for a run-time error.
    pub(crate) property: Option<String>,
    /// CBMC's description.
    pub(crate) said: String,
    pub(crate) found: Found,
}

impl Searched {
    /// The script of a counterexample for `asl2c run`, if there is one.
    pub(crate) fn script(&self) -> Option<String> {
        let (Found::Way(way, _) | Found::Unconfirmed(way)) = &self.found else { return None };
        let what = self.property.as_deref().unwrap_or(&self.said);
        let lines = way.lines().map(|line| format!("{line}\n"));
        Some(std::iter::once(format!("// Counterexample: {what}\n")).chain(lines).collect())
    }
}

/// Result of the search.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Found {
    /// A confirmed counterexample: the actions of the environment, and the agent's steps.
    Way(Way, Vec<CounterexampleStep>),
    /// A trace of CBMC that the reference interpreter does not confirm.
    Unconfirmed(Way),
    /// There is no counterexample with at most this number of transitions.
    None(u32),
}

/// Searches for a counterexample to each failure of a proof that was made in `folder`.
pub(crate) fn search(
    proof: &Proof,
    configuration: &ParsedConfiguration,
    session: &Session,
    cbmc: &Cbmc,
    folder: &Path,
    limits: Limits,
) -> Result<Vec<Searched>, ProveError> {
    // A limit that no clock can show is none.
    let until = Instant::now().checked_add(limits.time);
    let fewest_of = |failure: &Failure| fewest_transitions(configuration, failure);
    let mut results: Vec<Searched> = proof
        .open
        .iter()
        .map(|failure| Searched {
            property: failure.property().map(str::to_owned),
            said: failure.said.clone(),
            found: Found::None((fewest_of(failure) - 1).min(limits.transitions)),
        })
        .collect();
    let declared = configuration.declarations();
    for length in lengths(proof.open.iter().map(fewest_of), limits.transitions) {
        let is_sought = |failure: &Failure, result: &Searched| {
            matches!(result.found, Found::None(_)) && fewest_of(failure) <= length
        };
        let open = |(failure, result): &(&Failure, &Searched)| is_sought(failure, result);
        let wanted = proof.open.iter().zip(&results).filter(open);
        let wanted: Vec<&Failure> = wanted.map(|(failure, _)| failure).collect();
        if wanted.is_empty() {
            continue;
        }
        let Some(traces) = cbmc.ways(folder, &wanted, length, until)? else { break };
        for (failure, result) in proof.open.iter().zip(&mut results) {
            if !is_sought(failure, result) {
                continue;
            }
            let trace = traces.iter().find(|trace| trace.name == failure.name);
            let way = trace.and_then(|trace| Way::new(trace, declared));
            let none = std::mem::replace(&mut result.found, Found::None(length));
            let Some(way) = way else { continue };
            result.found = confirm(way, failure, session);
            if let Found::None(none) = none {
                let fewer = |transitions| {
                    let traces = cbmc.ways(folder, &[failure], transitions, until)?;
                    Ok(traces.map(|traces| {
                        let way = traces.first().and_then(|trace| Way::new(trace, declared));
                        way.map_or(Found::None(transitions), |way| confirm(way, failure, session))
                    }))
                };
                fewest(&mut result.found, none, fewer)?;
            }
        }
    }
    Ok(results)
}

/// No execution of fewer events, beliefs and steps breaks what failed: after its cause, `within(n, ..)` waits for n steps.
fn fewest_transitions(configuration: &ParsedConfiguration, failure: &Failure) -> u32 {
    let properties = configuration.declarations().properties.iter();
    let mut named = properties.filter(|one| failure.property() == Some(one.name.text.as_str()));
    match named.next().map(|property| &property.formula) {
        Some(Formula::Within { steps, .. }) => (*steps).max(1),
        _ => 1,
    }
}

/// The lengths of the executions that are searched, each longer than the one before. What takes many transitions at least is
/// often broken soon after: the formula of a length twice as large takes several times as long.
fn lengths(fewest: impl Iterator<Item = u32>, most: u32) -> BTreeSet<u32> {
    let doubled = std::iter::successors(Some(4_u32), |length| length.checked_mul(2));
    let soon = fewest.filter(|fewest| *fewest > 4).map(|fewest| fewest.saturating_add(1));
    let all = doubled.chain(soon).chain([most]);
    all.filter(|length| *length <= most).collect()
}

/// Replaces a counterexample by one with the fewest transitions, as far as there is time. There is none with as many as
/// `none`; `search` looks for one with at most so many, and returns `None` when the time is over.
fn fewest(
    found: &mut Found,
    mut none: u32,
    search: impl Fn(u32) -> Result<Option<Found>, ProveError>,
) -> Result<(), ProveError> {
    while let Found::Way(way, _) = &*found
        && way.transitions() > none + 1
    {
        match search(none.midpoint(way.transitions()))? {
            Some(Found::None(transitions)) => none = transitions,
            Some(shorter @ Found::Way(..)) => *found = shorter,
            Some(Found::Unconfirmed(_)) | None => break,
        }
    }
    Ok(())
}

/// Replays the trace by the reference interpreter, as far as that can decide the failure.
fn confirm(way: Way, failure: &Failure, session: &Session) -> Found {
    let Some(property) = failure.property() else {
        // The interpreter has no run-time errors.
        let story = story_of(&way, session);
        return Found::Way(way, story);
    };
    match shortest(&way, property, session) {
        Some(way) => {
            let story = story_of(&way, session);
            Found::Way(way, story)
        }
        None => Found::Unconfirmed(way),
    }
}

/// The steps of a counterexample.
fn story_of(way: &Way, session: &Session) -> Vec<CounterexampleStep> {
    let mut session = session.clone();
    let mut story = Vec::new();
    let mut idle_from = None;
    for line in way.lines() {
        let happened = session.happenings(&line);
        let is_idle = happened.len() == 1 && happened[0].text.ends_with(IDLE);
        if !is_idle {
            idle_from = None;
        } else if let Some(first) = idle_from {
            // Consecutive steps without an event share one line.
            story.pop();
            let text = format!("steps {first} to {}: {IDLE}", session.steps());
            story.push(CounterexampleStep::new(0, None, text));
            continue;
        } else {
            idle_from = Some(session.steps());
        }
        story.extend(happened);
    }
    story
}
