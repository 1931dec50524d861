//! Posting events: for the next step, for later, and with a deadline.

use super::events::{else_count, event_name, wrapped};
use super::names::{Names, argument};
use super::state::{
    Ring, Slot, deferred_ring, external_count, handler_name, limited_types, limits, pending,
    slot_value,
};
use crate::backend::writer::Writer;
use crate::program::{HandlerId, Program};
use crate::types::CType;

/// Functions that post an event for the next step or defer a goal.
pub(super) fn posting(writer: &mut Writer, program: &Program, names: &Names) {
    for id in &program.posted_by_plans {
        let trigger = handler_name(program, *id);
        let types = &program.handler(*id).types;
        writer.line("/* The event of the next step. */");
        writer.open(format!("static void post_{trigger}({})", names.parameters(types)));
        store(writer, names, Slot::Posted, &trigger, types, "");
        writer.line(format!(
            "{} = {};",
            names.field("posted"),
            event_name(names, Slot::Posted, &trigger)
        ));
        writer.close("}");
        writer.line("");
    }
    for id in &program.limited {
        limiting(writer, program, names, *id);
    }
    for id in &program.deferred {
        deferring(writer, program, names, *id);
    }
}

/// The function that sets the deadline of a goal.
fn limiting(writer: &mut Writer, program: &Program, names: &Names, id: HandlerId) {
    let Some((_, time)) = limits(program) else { return };
    let trigger = handler_name(program, id);
    let kept = limited_types(program, id);
    let mut types = kept.to_vec();
    types.push(time.clone());
    let limited = names.field("limited");
    let event = event_name(names, Slot::Deadline, &trigger);
    writer.line(
        "/* Sets the deadline of a goal. A goal that posts itself again keeps its deadline. */",
    );
    writer.open(format!("static void limit_{trigger}({})", names.parameters(&types)));
    writer.open(format!("if ({limited} != {event})"));
    store(writer, names, Slot::Deadline, &trigger, kept, "");
    writer.line(format!("{} = {};", names.field("deadline"), argument(kept.len())));
    writer.line(format!("{limited} = {event};"));
    writer.close("}");
    writer.close("}");
    writer.line("");
}

fn deferring(writer: &mut Writer, program: &Program, names: &Names, id: HandlerId) {
    let trigger = handler_name(program, id);
    let types = &program.handler(id).types;
    let Some(ring) = deferred_ring(program) else { return };
    if program.configuration.settings.queue {
        queueing(writer, program, names, &trigger, types, &ring);
        return;
    }
    let flag = names.field(&pending(Slot::Deferred, &trigger));
    writer.line("/* One slot for this goal: posted again, it keeps its place. */");
    writer.open(format!("static void defer_{trigger}({})", names.parameters(types)));
    store(writer, names, Slot::Deferred, &trigger, types, "");
    writer.open(format!("if (!{flag})"));
    let first = names.field(&ring.field("first"));
    let count = names.field(&ring.field("count"));
    let slot = wrapped(&format!("{first} + {count}"), ring.length);
    writer.line(format!("const uint32_t slot = {slot};"));
    writer.line(format!("{flag} = true;"));
    writer.line(format!(
        "{}[slot] = {};",
        names.field(&ring.field("queue")),
        event_name(names, Slot::Deferred, &trigger)
    ));
    writer.line(format!("{count} = {count} + 1U;"));
    writer.close("}");
    writer.close("}");
    writer.line("");
}

/// The function that posts a goal with `!!` if all goals share one queue, each in its own element.
fn queueing(
    writer: &mut Writer,
    program: &Program,
    names: &Names,
    trigger: &str,
    types: &[CType],
    ring: &Ring,
) {
    let field = |part: &str| names.field(&ring.field(part));
    let (first, count) = (field("first"), field("count"));
    let external = names.field(external_count(program));
    writer.line("/* Appends the goal. One that does not fit is dropped and counted. */");
    writer.open(format!("static void defer_{trigger}({})", names.parameters(types)));
    writer.open(format!("if (({count} - {external}) < {}U)", program.deferred_room));
    let slot = wrapped(&format!("{first} + {count}"), ring.length);
    writer.line(format!("const uint32_t slot = {slot};"));
    writer.line("");
    store(writer, names, Slot::Deferred, trigger, types, "[slot]");
    let event = event_name(names, Slot::Deferred, trigger);
    writer.line(format!("{}[slot] = {event};", field("queue")));
    writer.line(format!("{count} = {count} + 1U;"));
    writer.close("}");
    else_count(writer, &names.field("unhandled"));
    writer.close("}");
    writer.line("");
}

/// Stores a function's arguments in the slot of an event.
pub(super) fn store(
    writer: &mut Writer,
    names: &Names,
    slot: Slot,
    trigger: &str,
    types: &[CType],
    index: &str,
) {
    for number in 0..types.len() {
        let field = names.field(&slot_value(slot, trigger, number));
        writer.line(format!("{field}{index} = {};", argument(number)));
    }
}
