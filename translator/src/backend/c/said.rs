//! What peers say, in the state of an agent: the names of its fields and events.

use crate::program::{Asked, Program, Told};
use crate::types::CType;

/// The field that says whose turn it is among those who ask.
pub(super) const ASKED_TURN: &str = "asked_turn";
/// The field that says whose turn it is among those who tell.
pub(super) const TOLD_TURN: &str = "told_turn";

/// The field that says whose turn it is among those who ask for a goal that pre-empts. Each has its own: with a common one,
/// a sender of the first goal could always pass the turn to the same sender of the second.
pub(super) fn urgent_turn(goal: &str) -> String {
    format!("urgent_turn_{goal}")
}

/// The fields that say whose turn it is among those who ask.
pub(super) fn asked_turns(program: &Program) -> Vec<String> {
    let waits = program.asked.iter().any(|asked| !asked.preemptive);
    let usual = waits.then(|| ASKED_TURN.to_owned());
    usual.into_iter().chain(program.urgent().map(urgent_turn)).collect()
}

/// All fields that say whose turn it is.
pub(super) fn turns(program: &Program) -> Vec<String> {
    let told = noticed(program).next().map(|_| TOLD_TURN.to_owned());
    asked_turns(program).into_iter().chain(told).collect()
}

/// `at_from_leader`: what one peer says, in names of events and fields.
pub(super) fn asked_name(program: &Program, asked: &Asked) -> String {
    format!("{}_from_{}", asked.name, program.configuration.peers[asked.sender].text)
}

/// The belief that a peer tells, whose change is an event.
pub(super) fn told_name<'a>(program: &'a Program, told: &Told) -> &'a str {
    &program.belief(told.belief).name
}

/// What is told with plans for its change.
pub(super) fn noticed(program: &Program) -> impl Iterator<Item = &Told> {
    program.told.iter().filter(|told| told.added.is_some() || told.removed.is_some())
}

/// The types of a goal's arguments, without its source.
pub(super) fn asked_types<'a>(program: &'a Program, asked: &Asked) -> &'a [CType] {
    let types = &program.handler(asked.handler).types;
    &types[..types.len() - 1]
}

/// Whether a goal that a peer asks for has arguments.
pub(super) fn has_values(program: &Program) -> bool {
    program.asked.iter().any(|asked| !asked_types(program, asked).is_empty())
}

/// The counters of a ring; without values it has no first element.
pub(super) fn ring_parts(program: &Program, asked: &Asked) -> &'static [&'static str] {
    if asked_types(program, asked).is_empty() { &["count"] } else { &["count", "first"] }
}

/// A field of a ring: `first` or `count`.
pub(super) fn ring_field(program: &Program, asked: &Asked, part: &str) -> String {
    format!("asked_{}_{part}", asked_name(program, asked))
}
