//! The deliberation cycle: taking the next event, handling it.

use super::events::{UNROLLED, event_name, no_event, run, wrapped};
use super::messages;
use super::names::Names;
use super::state::{
    Slot, belief_value, external_count, external_name, handler_name, held, inbox_ring, limits,
    pending, perceived, queued, rings, slot_value,
};
use super::turns::{self, urgent_branch};
use crate::backend::writer::Writer;
use crate::program::{External, HandlerId, Program};
use crate::syntax::ast::Operator;
use crate::types::CType;

/// `take_event`, `handle_event` and `next_step`.
pub(super) fn cycle(writer: &mut Writer, program: &Program, names: &Names) {
    turns::take(writer, program, names);
    take_event(writer, program, names);
    handle_event(writer, program, names);
    next_step(writer, program, names);
}

fn take_event(writer: &mut Writer, program: &Program, names: &Names) {
    let (posted, aborted) = (names.field("posted"), names.field("aborted"));
    let none = no_event(names);
    let mut branches: Vec<(String, Vec<String>)> = Vec::new();
    let mut aborts = vec![
        format!("if (({posted} != {none}) && ({aborted} < UINT32_MAX))"),
        "{".to_owned(),
        format!("    {aborted} = {aborted} + 1U;"),
        "}".to_owned(),
        format!("{posted} = {none};"),
    ];
    aborts.extend(limits(program).map(|_| format!("{} = {none};", names.field("limited"))));
    for preempting in &program.configuration.preemptive {
        let raised = program.raised(preempting).map(|(_, external)| {
            let trigger = external_name(external);
            let flag = names.field(&pending(Slot::Preemptive, &trigger));
            let event = event_name(names, Slot::Preemptive, &trigger);
            (flag.clone(), vec![format!("event = {event};"), format!("{flag} = false;")])
        });
        let asked = urgent_branch(program, names, &preempting.name.text);
        branches.extend(raised.into_iter().chain(asked).map(|(waits, mut taken)| {
            taken.extend_from_slice(&aborts);
            (waits, taken)
        }));
    }
    let mut taken = vec![format!("event = {posted};"), format!("{posted} = {none};")];
    if let Some((clock, ctype)) = limits(program) {
        let (limited, deadline) = (names.field("limited"), names.field("deadline"));
        let function = names.action(program.basic(*clock));
        let now = format!("{function}({})", names.action_arguments(&[]));
        taken.extend([
            format!("if ({limited} != {none})"),
            "{".to_owned(),
            format!("    const {} current_time = {now};", ctype.name),
            String::new(),
            format!("    if (current_time >= {deadline})"),
            "    {".to_owned(),
            "        /* The deadline has passed. */".to_owned(),
            format!("        event = {limited};"),
            format!("        {limited} = {none};"),
            "    }".to_owned(),
            "}".to_owned(),
        ]);
    }
    branches.push((format!("{posted} != {none}"), taken));
    for (_, handler) in perceived(program) {
        let trigger = handler_name(program, handler);
        let flag = names.field(&pending(Slot::Perceived, &trigger));
        let taken = vec![
            format!("event = {};", event_name(names, Slot::Perceived, &trigger)),
            format!("{flag} = false;"),
        ];
        branches.push((flag, taken));
    }
    branches.extend(turns::branches(program, names));
    let inbox = inbox_ring(program).map(|ring| ring.field("queue"));
    for ring in rings(program) {
        let field = |part: &str| names.field(&ring.field(part));
        let (first, count) = (field("first"), field("count"));
        let mut taken = vec![
            format!("event = {}[{first}];", field("queue")),
            format!("{first} = {};", wrapped(&format!("{first} + 1U"), ring.length)),
            format!("{count} = {count} - 1U;"),
        ];
        if inbox.as_ref() == Some(&ring.field("queue")) {
            taken.insert(0, format!("{} = {first};", names.field("inbox_taken")));
        }
        branches.push((format!("{count} > 0U"), taken));
    }

    let none_types: [CType; 0] = [];
    writer.line("/* Pre-empting events first, then the posted one, then what was perceived, then those of the");
    writer.line(" * environment, then deferred goals.");
    writer.line(" */");
    writer.open(format!(
        "static {} take_event({})",
        names.interface("event_t"),
        names.parameters(&none_types)
    ));
    writer.line(format!("{} event = {none};", names.interface("event_t")));
    writer.line("");
    for (index, (condition, lines)) in branches.iter().enumerate() {
        let keyword = if index == 0 { "if" } else { "else if" };
        writer.open(format!("{keyword} ({condition})"));
        for line in lines {
            writer.line(line);
        }
        writer.close("}");
    }
    if branches.len() > 1 {
        writer.open("else");
        writer.line("/* Nothing to do. */");
        writer.close("}");
    }
    writer.line("return event;");
    writer.close("}");
    writer.line("");
}

fn handle_event(writer: &mut Writer, program: &Program, names: &Names) {
    writer.line("/* Handles one event completely; false for a mere update of a belief. */");
    let event_type = names.interface("event_t");
    let mut parameters = names.state_parameter();
    parameters.push(format!("{event_type} event"));
    writer.open(format!("static bool handle_event({})", parameters.join(", ")));
    writer.line("outcome_t outcome = OUTCOME_ACHIEVED;");
    writer.line("bool handled = true;");
    writer.line("");
    writer.line("switch (event)");
    writer.line("{");
    writer.indent();
    for id in &program.posted {
        let trigger = handler_name(program, *id);
        open_case(writer, names, Slot::Posted, &trigger);
        run(writer, program, names, *id, &slot_values(program, names, Slot::Posted, *id));
        close_case(writer);
    }
    for id in &program.limited {
        open_case(writer, names, Slot::Deadline, &handler_name(program, *id));
        match program.handler(*id).failure {
            Some(failure) => {
                let values = slot_values(program, names, Slot::Deadline, *id);
                run(writer, program, names, failure, &values);
            }
            None => writer.line("outcome = OUTCOME_FAILED;"),
        }
        close_case(writer);
    }
    for (belief, handler) in perceived(program) {
        open_case(writer, names, Slot::Perceived, &handler_name(program, handler));
        let values: Vec<String> = (0..belief.types.len())
            .map(|number| names.field(&belief_value(&belief.name, number)))
            .collect();
        let values = own(program, names, handler, values);
        if program.is_deleted(belief) {
            // A belief that has been deleted meanwhile raises no event.
            writer.open(format!("if ({})", names.field(&held(&belief.name))));
            run(writer, program, names, handler, &values);
            writer.close("}");
            writer.open("else");
            writer.line("handled = false;");
            writer.close("}");
        } else {
            run(writer, program, names, handler, &values);
        }
        close_case(writer);
    }
    messages::cases(writer, program, names);
    for external in &program.external {
        external_case(writer, program, names, external);
    }
    for id in &program.deferred {
        let trigger = handler_name(program, *id);
        open_case(writer, names, Slot::Deferred, &trigger);
        let mut values = slot_values(program, names, Slot::Deferred, *id);
        if program.configuration.settings.queue {
            let taken = names.field("inbox_taken");
            values = values.iter().map(|value| format!("{value}[{taken}]")).collect();
        } else {
            writer.line(format!("{} = false;", names.field(&pending(Slot::Deferred, &trigger))));
        }
        run(writer, program, names, *id, &values);
        close_case(writer);
    }
    writer.line(format!("case {}:", no_event(names)));
    writer.line("default:");
    writer.indent();
    writer.line("/* No event is pending. */");
    writer.line("break;");
    writer.dedent();
    writer.dedent();
    writer.line("}");
    if limits(program).is_some() {
        let (posted, limited) = (names.field("posted"), names.field("limited"));
        let none = no_event(names);
        writer.open(format!("if ({posted} == {none})"));
        writer.line("/* No goal is active any more. */");
        writer.line(format!("{limited} = {none};"));
        writer.close("}");
    }
    let unhandled = names.field("unhandled");
    writer.open(format!("if ((outcome != OUTCOME_ACHIEVED) && ({unhandled} < UINT32_MAX))"));
    writer.line(format!("{unhandled} = {unhandled} + 1U;"));
    writer.close("}");
    writer.line("return handled;");
    writer.close("}");
    writer.line("");
}

fn open_case(writer: &mut Writer, names: &Names, slot: Slot, trigger: &str) {
    writer.line(format!("case {}:", event_name(names, slot, trigger)));
    writer.indent();
}

fn close_case(writer: &mut Writer) {
    writer.line("break;");
    writer.dedent();
}

fn slot_values(program: &Program, names: &Names, slot: Slot, id: HandlerId) -> Vec<String> {
    let trigger = handler_name(program, id);
    (0..program.handler(id).types.len())
        .map(|index| names.field(&slot_value(slot, &trigger, index)))
        .collect()
}

/// The values of an event that the agent or its environment causes.
fn own(program: &Program, names: &Names, id: HandlerId, mut values: Vec<String>) -> Vec<String> {
    values.extend(program.handler(id).sourced.then(|| names.field("me")));
    values
}

fn external_case(writer: &mut Writer, program: &Program, names: &Names, external: &External) {
    let trigger = external_name(external);
    let slot = if external.preemptive { Slot::Preemptive } else { Slot::Inbox };
    let index = if external.preemptive {
        String::new()
    } else {
        format!("[{}]", names.field("inbox_taken"))
    };
    let mut values: Vec<String> = (0..external.types.len())
        .map(|number| format!("{}{index}", names.field(&slot_value(slot, &trigger, number))))
        .collect();
    open_case(writer, names, slot, &trigger);
    if slot == Slot::Inbox && program.configuration.settings.queue {
        let waiting = names.field(external_count(program));
        writer.line(format!("{waiting} = {waiting} - 1U;"));
    }
    if let Some(belief) = external.belief {
        let belief = program.belief(belief);
        let fields: Vec<String> = (0..belief.types.len())
            .map(|number| names.field(&belief_value(&belief.name, number)))
            .collect();
        let held = names.field(&held(&belief.name));
        if external.operator == Operator::Delete {
            // Deleting a belief that is not held has no effect.
            writer.open(format!("if ({held})"));
            writer.line(format!("{held} = false;"));
            match external.handler {
                Some(handler) => {
                    run(writer, program, names, handler, &own(program, names, handler, fields));
                }
                None => writer.line("handled = false;"),
            }
            writer.close("}");
            writer.open("else");
            writer.line("handled = false;");
            writer.close("}");
            close_case(writer);
            return;
        }
        for (field, value) in fields.iter().zip(&values) {
            writer.line(format!("{field} = {value};"));
        }
        writer.line(format!("{held} = true;"));
        values = fields;
    }
    match external.handler {
        Some(handler) => {
            run(writer, program, names, handler, &own(program, names, handler, values));
        }
        None => writer.line("handled = false;"),
    }
    close_case(writer);
}

fn next_step(writer: &mut Writer, program: &Program, names: &Names) {
    let none: [CType; 0] = [];
    writer.open(format!("void {}({})", names.interface("next_step"), names.parameters(&none)));
    let update = names.interface("updateBeliefs");
    let update_arguments = if names.is_context() { "self, self->environment" } else { "" };
    let no_arguments = || names.arguments(std::iter::empty());
    let handle =
        format!("handle_event({})", names.arguments([format!("take_event({})", no_arguments())]));
    let most = updates(program);
    if most == 0 {
        writer.line(format!("{update}({update_arguments});"));
        writer.line(format!("(void){handle};"));
    } else {
        writer.line("bool handled = false;");
        writer.line("");
        writer.line(format!("{update}({update_arguments});"));
        writer.line(format!("handled = {handle};"));
        writer.line("/* What only updates a belief takes no step. */");
        if most <= UNROLLED {
            // Without a loop, the compiled code has a longest path.
            for round in 1..=most {
                let result = if round < most { "handled = " } else { "(void)" };
                writer.open("if (!handled)");
                writer.line(format!("{result}{handle};"));
                writer.close("}");
            }
        } else {
            writer.open(format!(
                "for (uint32_t round = 0U; (round < {most}U) && (!handled); round++)"
            ));
            writer.line(format!("handled = {handle};"));
            writer.close("}");
        }
    }
    writer.close("}");
    writer.line("");
}

/// The largest number of events that a step can take without handling one: each takes an event away.
fn updates(program: &Program) -> usize {
    let is_update =
        |external: &External| external.handler.is_none() || external.operator == Operator::Delete;
    let deleted = perceived(program).filter(|(belief, _)| program.is_deleted(belief)).count();
    let inbox = program.configuration.settings.inbox as usize;
    deleted + messages::unnoticed(program) + if queued(program).any(is_update) { inbox } else { 0 }
}
