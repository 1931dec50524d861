//! Looks for ways to what could not be proved.

use std::path::Path;
use std::time::{Duration, Instant};

use translator::{Happening, ParsedConfiguration};

use super::cbmc::{Cbmc, Failure};
use super::shrink::shortest;
use super::trace::Way;
use super::{Proof, ProveError};
use crate::run::{IDLE, Session};

/// How far ways are looked for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    /// Transitions of the longest way: events raised, beliefs set and steps.
    pub(crate) transitions: u32,
    /// For all of them together.
    pub(crate) time: Duration,
}

/// What is known of something that is not proved.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Searched {
    /// The property; nothing for an error at run time.
    pub(crate) property: Option<String>,
    /// What CBMC says of it.
    pub(crate) said: String,
    pub(crate) found: Found,
}

/// Whether there is a way to a failure.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Found {
    /// This one: what the environment does, and what the agent does then.
    Way(Way, Vec<Happening>),
    /// CBMC found one that the reference interpreter does not take.
    Unconfirmed(Way),
    /// None has at most so many transitions.
    None(u32),
}

/// Looks for a way to each failure of a proof that was made in `folder`.
pub(crate) fn search(
    proof: &Proof,
    configuration: &ParsedConfiguration,
    session: &Session,
    cbmc: &Cbmc,
    folder: &Path,
    limits: Limits,
) -> Result<Vec<Searched>, ProveError> {
    let until = Instant::now() + limits.time;
    let mut results: Vec<Searched> = proof
        .open
        .iter()
        .map(|failure| Searched {
            property: failure.property().map(str::to_owned),
            said: failure.said.clone(),
            found: Found::None(0),
        })
        .collect();
    let mut length = 0;
    while length < limits.transitions {
        length = if length == 0 { 4 } else { length * 2 }.min(limits.transitions);
        let open = |(_, result): &(&Failure, &Searched)| matches!(result.found, Found::None(_));
        let wanted = proof.open.iter().zip(&results).filter(open);
        let wanted: Vec<&Failure> = wanted.map(|(failure, _)| failure).collect();
        if wanted.is_empty() {
            break;
        }
        let Some(traces) = cbmc.ways(folder, &wanted, length, until)? else { break };
        for (failure, result) in proof.open.iter().zip(&mut results) {
            if !matches!(result.found, Found::None(_)) {
                continue;
            }
            let trace = traces.iter().find(|trace| trace.name == failure.name);
            let way = trace.and_then(|trace| Way::new(trace, configuration.declarations()));
            result.found = way.map_or(Found::None(length), |way| confirm(way, failure, session));
        }
    }
    Ok(results)
}

/// The reference interpreter goes the way, as far as it can tell whether that is one.
fn confirm(way: Way, failure: &Failure, session: &Session) -> Found {
    let Some(property) = failure.property() else {
        // The interpreter has no errors at run time.
        let story = told(&way, session);
        return Found::Way(way, story);
    };
    match shortest(&way, property, session) {
        Some(way) => {
            let story = told(&way, session);
            Found::Way(way, story)
        }
        None => Found::Unconfirmed(way),
    }
}

/// What happens on a way, in the agent's words.
fn told(way: &Way, session: &Session) -> Vec<Happening> {
    let mut session = session.clone();
    let mut story = Vec::new();
    let mut idle_from = None;
    for line in way.lines() {
        let told = session.told(&line);
        let is_idle = told.len() == 1 && told[0].text.ends_with(IDLE);
        if !is_idle {
            idle_from = None;
        } else if let Some(first) = idle_from {
            // One line for all steps in which nothing waits.
            story.pop();
            let text = format!("steps {first} to {}: {IDLE}", session.steps());
            story.push(Happening::new(0, None, text));
            continue;
        } else {
            idle_from = Some(session.steps());
        }
        story.extend(told);
    }
    story
}
