//! The functions that the environment calls.

use std::collections::{BTreeMap, HashSet};

use super::events::{else_count, event_name, no_event, wrapped};
use super::header::init_prototype;
use super::helpers::Helpers;
use super::messages;
use super::names::{Names, argument, argument_names};
use super::posting::store;
use super::spelling::conjunction;
use super::state::{
    Counter, FieldType, Slot, belief_value, counters, external_count, external_name, handler_name,
    held, inbox_ring, layout, limits, pending, perceived, queued, rings, slot_value,
};
use crate::backend::writer::Writer;
use crate::program::{Belief, External, Program, Value};
use crate::types::{CType, TypeKind};

pub(super) fn interface(
    writer: &mut Writer,
    program: &Program,
    names: &Names,
    helpers: &mut Helpers,
) {
    forget_events(writer, program, names);
    init(writer, program, names);
    let none: [CType; 0] = [];
    let no_parameters = names.parameters(&none);
    writer.open(format!("bool {}({no_parameters})", names.interface("can_add_event")));
    if queued(program).next().is_some() {
        let inbox = program.configuration.settings.inbox;
        writer.line(format!("return {} < {inbox}U;", names.field(external_count(program))));
    } else {
        if names.is_context() {
            writer.line("(void)self;");
        }
        writer.line("return true;");
    }
    writer.close("}");
    writer.line("");
    for Counter { name, .. } in counters(program) {
        let function = names.interface(&format!("{name}_events"));
        writer.open(format!("uint32_t {function}({no_parameters})"));
        writer.line(format!("return {};", names.field(name)));
        writer.close("}");
        writer.line("");
    }
    for external in &program.external {
        writer.line("");
        raise(writer, program, names, external);
    }
    for belief in program.settable() {
        writer.line("");
        set(writer, program, names, helpers, belief);
    }
    messages::receive(writer, program, names, helpers);
}

/// Drops all events and posts the initial goal.
fn forget_events(writer: &mut Writer, program: &Program, names: &Names) {
    let none: [CType; 0] = [];
    writer.open(format!("static void forget_events({})", names.parameters(&none)));
    match &program.initial_goal {
        Some((handler, values)) => {
            let trigger = handler_name(program, *handler);
            for (index, value) in values.iter().enumerate() {
                let field = names.field(&slot_value(Slot::Posted, &trigger, index));
                match value {
                    Value::Me => writer.line(format!("{field} = {};", names.field("me"))),
                    value => writer.line(format!("{field} = {};", constant_text(value))),
                }
            }
            let event = event_name(names, Slot::Posted, &trigger);
            writer.line(format!("{} = {event};", names.field("posted")));
        }
        None => writer.line(format!("{} = {};", names.field("posted"), no_event(names))),
    }
    if limits(program).is_some() {
        writer.line(format!("{} = {};", names.field("limited"), no_event(names)));
    }
    for ring in rings(program) {
        for part in ["count", "first"] {
            writer.line(format!("{} = 0U;", names.field(&ring.field(part))));
        }
    }
    if inbox_ring(program).is_some() {
        writer.line(format!("{} = 0U;", names.field("inbox_taken")));
        if program.configuration.settings.queue {
            writer.line(format!("{} = 0U;", names.field(external_count(program))));
        }
    }
    messages::forget(writer, program, names);
    for external in program.external.iter().filter(|external| external.preemptive) {
        let flag = pending(Slot::Preemptive, &external_name(external));
        writer.line(format!("{} = false;", names.field(&flag)));
    }
    for (_, handler) in perceived(program) {
        let flag = pending(Slot::Perceived, &handler_name(program, handler));
        writer.line(format!("{} = false;", names.field(&flag)));
    }
    let queue = program.configuration.settings.queue;
    for id in program.deferred.iter().filter(|_| !queue) {
        let flag = pending(Slot::Deferred, &handler_name(program, *id));
        writer.line(format!("{} = false;", names.field(&flag)));
    }
    writer.close("}");
    writer.line("");
}

fn init(writer: &mut Writer, program: &Program, names: &Names) {
    writer.open(init_prototype(program, names));
    if names.is_context() {
        writer.line("self->environment = environment;");
    }
    if program.has_peers() {
        writer.line(format!("{} = me;", names.field("me")));
    }
    nothing_is_left(writer, program, names);
    for belief in &program.beliefs {
        let held = names.field(&held(&belief.name));
        if let Some(initial) = &belief.initial {
            for (index, value) in initial.iter().enumerate() {
                let field = names.field(&belief_value(&belief.name, index));
                writer.line(format!("{field} = {};", constant_text(value)));
            }
        }
        writer.line(format!("{held} = {};", belief.initial.is_some()));
    }
    for counter in counters(program) {
        writer.line(format!("{} = 0U;", names.field(counter.name)));
    }
    let forget = format!("forget_events({});", names.arguments(std::iter::empty()));
    writer.line(&forget);
    writer.close("}");
    writer.line("");
    let none: [CType; 0] = [];
    writer.open(format!("void {}({})", names.interface("clear"), names.parameters(&none)));
    writer.line(&forget);
    writer.close("}");
    writer.line("");
}

/// No field is read before it is written. The values are set anyway, so that tools need not infer that.
fn nothing_is_left(writer: &mut Writer, program: &Program, names: &Names) {
    let initial = initial_fields(program);
    let fields = layout(program).fields;
    let mut arrays: BTreeMap<usize, Vec<String>> = BTreeMap::new();
    for field in fields.iter().filter(|field| !initial.contains(&field.name)) {
        let nothing = match &field.content {
            FieldType::Value(ctype) => match zero(ctype) {
                Some(zero) => zero.to_owned(),
                None => continue,
            },
            FieldType::Event if field.length.is_some() => no_event(names),
            FieldType::Event | FieldType::Environment | FieldType::Flag | FieldType::Count => {
                continue;
            }
        };
        let place = names.field(&field.name);
        match field.length {
            Some(1) => writer.line(format!("{place}[0] = {nothing};")),
            Some(length) => {
                arrays.entry(length).or_default().push(format!("{place}[slot] = {nothing};"));
            }
            None => writer.line(format!("{place} = {nothing};")),
        }
    }
    for (length, lines) in arrays {
        writer.open(format!("for (uint32_t slot = 0U; slot < {length}U; slot++)"));
        for line in lines {
            writer.line(line);
        }
        writer.close("}");
    }
}

/// Fields that initial beliefs and the initial goal set.
fn initial_fields(program: &Program) -> HashSet<String> {
    let beliefs = program.beliefs.iter().filter(|belief| belief.initial.is_some());
    let mut fields: HashSet<String> = beliefs
        .flat_map(|belief| (0..belief.types.len()).map(|index| belief_value(&belief.name, index)))
        .collect();
    if let Some((handler, values)) = &program.initial_goal {
        let trigger = handler_name(program, *handler);
        fields.extend((0..values.len()).map(|index| slot_value(Slot::Posted, &trigger, index)));
    }
    fields.extend(program.has_peers().then(|| "me".to_owned()));
    fields
}

/// Zero of a type with constants.
fn zero(ctype: &CType) -> Option<&'static str> {
    match ctype.kind {
        TypeKind::Bool => Some("false"),
        TypeKind::Float32 => Some("0.0F"),
        TypeKind::Float64 => Some("0.0"),
        TypeKind::Signed { bits: 64 } => Some("0LL"),
        TypeKind::Unsigned { bits: 64 } => Some("0ULL"),
        TypeKind::Signed { .. } => Some("0"),
        TypeKind::Unsigned { .. } => Some("0U"),
        TypeKind::Void | TypeKind::Text | TypeKind::Struct | TypeKind::Opaque => None,
    }
}

/// Initial beliefs and goals contain only constants.
fn constant_text(value: &Value) -> &str {
    match value {
        Value::Constant(text, _) => text,
        Value::Variable(_)
        | Value::Me
        | Value::ToldAt(_)
        | Value::Call(_)
        | Value::Negate(_)
        | Value::Arithmetic(_) => {
            unreachable!("analysis lets only constants into initial beliefs and goals")
        }
    }
}

fn raise(writer: &mut Writer, program: &Program, names: &Names, external: &External) {
    let trigger = external_name(external);
    let head = format!("bool {}({})", names.interface(&trigger), names.parameters(&external.types));
    writer.open(head);
    if external.preemptive {
        store(writer, names, Slot::Preemptive, &trigger, &external.types, "");
        let flag = names.field(&pending(Slot::Preemptive, &trigger));
        writer.line(format!("{flag} = true;"));
        writer.line("return true;");
    } else if let Some(ring) = inbox_ring(program) {
        let inbox = program.configuration.settings.inbox;
        let field = |part: &str| names.field(&ring.field(part));
        let (first, count) = (field("first"), field("count"));
        let waiting = names.field(external_count(program));
        writer.line(format!("const bool accepted = {waiting} < {inbox}U;"));
        writer.line("");
        writer.open("if (accepted)");
        let slot = wrapped(&format!("{first} + {count}"), ring.length);
        writer.line(format!("const uint32_t slot = {slot};"));
        store(writer, names, Slot::Inbox, &trigger, &external.types, "[slot]");
        let event = event_name(names, Slot::Inbox, &trigger);
        writer.line(format!("{}[slot] = {event};", field("queue")));
        writer.line(format!("{count} = {count} + 1U;"));
        if waiting != count {
            writer.line(format!("{waiting} = {waiting} + 1U;"));
        }
        writer.close("}");
        else_count(writer, &names.field("refused"));
        writer.line("return accepted;");
    }
    writer.close("}");
}

fn set(
    writer: &mut Writer,
    program: &Program,
    names: &Names,
    helpers: &mut Helpers,
    belief: &Belief,
) {
    let name = names.interface(&format!("set_{}", belief.name));
    let held = names.field(&held(&belief.name));
    let field = |index| names.field(&belief_value(&belief.name, index));
    writer.open(format!("void {name}({})", names.parameters(&belief.types)));
    let flag = belief
        .perceived
        .map(|handler| names.field(&pending(Slot::Perceived, &handler_name(program, handler))));
    if flag.is_some() {
        // A belief that cannot be compared always counts as changed.
        let comparable = belief.types.iter().all(CType::has_equality);
        let condition = if comparable {
            let mut unchanged = vec![held.clone()];
            for (index, ctype) in belief.types.iter().enumerate() {
                unchanged.push(helpers.equality(ctype, &field(index), &argument(index)));
            }
            format!("!({})", conjunction(&unchanged))
        } else {
            "true".to_owned()
        };
        writer.line(format!("const bool changed = {condition};"));
        writer.line("");
    }
    for (index, argument) in argument_names(&belief.types).enumerate() {
        writer.line(format!("{} = {argument};", field(index)));
    }
    writer.line(format!("{held} = true;"));
    if let Some(flag) = flag {
        writer.open("if (changed)");
        writer.line(format!("{flag} = true;"));
        writer.close("}");
    }
    writer.close("}");
}
