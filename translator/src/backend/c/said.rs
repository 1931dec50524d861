//! What peers say, in the state of an agent: the names of its fields and events.

use crate::program::{Asked, Program, Told};
use crate::types::CType;

/// The fields that say whose turn it is: among those who ask, and among those who tell.
pub(super) const TURNS: [&str; 2] = ["asked_turn", "told_turn"];

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
