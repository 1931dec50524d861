//! Events: their names in C, and how their plans are run.

use super::names::Names;
use super::state::{Slot, event, handler_name};
use crate::backend::writer::Writer;
use crate::program::{HandlerId, Program};
use crate::syntax::ast::TriggerKind;

/// Up to this number of rounds there is no loop: of updates before a step handles an event, and of peers.
pub(super) const UNROLLED: usize = 8;

/// Enumerator of an event, with the prefix of the agent.
pub(super) fn event_name(names: &Names, slot: Slot, trigger: &str) -> String {
    format!("{}{}", names.interface("").to_uppercase(), event(slot, trigger))
}

/// Enumerator for no event.
pub(super) fn no_event(names: &Names) -> String {
    format!("{}EVENT_NONE", names.interface("").to_uppercase())
}

/// Wraps an index into a ring of `length` elements.
pub(super) fn wrapped(index: &str, length: usize) -> String {
    if length == 1 { "0U".to_owned() } else { format!("({index}) % {length}U") }
}

/// Runs the plans of an event.
pub(super) fn run(
    writer: &mut Writer,
    program: &Program,
    names: &Names,
    id: HandlerId,
    values: &[String],
) {
    let trigger = handler_name(program, id);
    let arguments = names.arguments(values.iter().cloned());
    writer.line(format!("outcome = run_{trigger}({arguments});"));
    if program.handler(id).kind == TriggerKind::Belief {
        // A percept without an applicable plan is not a failure.
        writer.open("if (outcome == OUTCOME_NOT_APPLICABLE)");
        writer.line("outcome = OUTCOME_ACHIEVED;");
        writer.close("}");
    }
}

/// The other branches of an `if` that takes something in: what finds no room is counted in a field of the state.
pub(super) fn else_count(writer: &mut Writer, counter: &str) {
    writer.open(format!("else if ({counter} < UINT32_MAX)"));
    writer.line(format!("{counter} = {counter} + 1U;"));
    writer.close("}");
    writer.open("else");
    writer.line("/* The counter saturates. */");
    writer.close("}");
}
