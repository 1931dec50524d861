//! Which message of a peer comes next: senders are served in turn, so that none keeps another one waiting.

use super::events::{UNROLLED, event_name, no_event, wrapped};
use super::messages::{case, changed_flag, default_case, end_case};
use super::names::Names;
use super::said::{
    ASKED_TURN, TOLD_TURN, asked_name, asked_types, noticed, ring_field, told_name, urgent_turn,
};
use super::state::Slot;
use crate::backend::writer::Writer;
use crate::program::{Asked, Program};
use crate::types::CType;

/// Whether a peer waits with such a goal, as expressions.
fn asks(program: &Program, names: &Names, is_such: impl Fn(&Asked) -> bool) -> Vec<String> {
    let asked = program.asked.iter().filter(|asked| is_such(asked));
    let count = |asked| names.field(&ring_field(program, asked, "count"));
    asked.map(|asked| format!("({} > 0U)", count(asked))).collect()
}

/// Whether a peer waits to be heard, as expressions.
pub(super) fn waits(program: &Program, names: &Names) -> Vec<String> {
    let told = noticed(program).map(|told| changed_flag(program, names, told));
    asks(program, names, |_| true).into_iter().chain(told).collect()
}

/// Assignments after which no peer waits with a goal that pre-empts, or with one that does not.
pub(super) fn asks_nothing(program: &Program, names: &Names, preemptive: bool) -> Vec<String> {
    let asked = program.asked.iter().filter(|asked| asked.preemptive == preemptive);
    let count = |asked| names.field(&ring_field(program, asked, "count"));
    asked.map(|asked| format!("{} = 0U", count(asked))).collect()
}

/// Assignments after which no peer waits to be heard with what does not pre-empt.
pub(super) fn silence(program: &Program, names: &Names) -> Vec<String> {
    let told =
        noticed(program).map(|told| format!("{} = false", changed_flag(program, names, told)));
    asks_nothing(program, names, false).into_iter().chain(told).collect()
}

/// What comes next: whether something of a kind waits, and the call that takes it.
type Branch = (String, Vec<String>);

fn branch(names: &Names, waiting: &[String], function: &str) -> Option<Branch> {
    let taken = format!("event = {function}({});", names.arguments(std::iter::empty()));
    (!waiting.is_empty()).then(|| (waiting.join(" || "), vec![taken]))
}

/// What comes next of what does not pre-empt.
pub(super) fn branches(program: &Program, names: &Names) -> Vec<Branch> {
    let asked = asks(program, names, |asked| !asked.preemptive);
    let told: Vec<String> =
        noticed(program).map(|told| changed_flag(program, names, told)).collect();
    let kinds = [(asked, TAKE_ASKED), (told, TAKE_TOLD)].into_iter();
    kinds.filter_map(|(waiting, functions)| branch(names, &waiting, functions[0])).collect()
}

/// A goal that pre-empts if a peer asks for it.
pub(super) fn urgent_branch(program: &Program, names: &Names, goal: &str) -> Option<Branch> {
    let waiting = asks(program, names, |asked| asked.preemptive && asked.name == goal);
    let [function, _] = take_urgent(goal);
    branch(names, &waiting, &function)
}

/// The functions that take what the next sender says, and what one of them says.
const TAKE_ASKED: [&str; 2] = ["take_asked", "take_asked_from"];
const TAKE_TOLD: [&str; 2] = ["take_told", "take_told_from"];

fn take_urgent(goal: &str) -> [String; 2] {
    [format!("take_urgent_{goal}"), format!("hear_urgent_{goal}")]
}

/// What a sender may say: its number, the condition that it does, and how that is taken.
type Slots = Vec<(usize, String, Vec<String>)>;

fn asked_slots(program: &Program, names: &Names, is_such: impl Fn(&Asked) -> bool) -> Slots {
    let slot = |asked: &Asked| {
        let field = |part: &str| names.field(&ring_field(program, asked, part));
        let (first, count) = (field("first"), field("count"));
        let name = asked_name(program, asked);
        let mut lines = vec![format!("event = {};", event_name(names, Slot::Asked, &name))];
        if !asked_types(program, asked).is_empty() {
            lines.extend([
                format!("{} = {first};", names.field("asked_taken")),
                format!("{first} = {};", wrapped(&format!("{first} + 1U"), asked.room)),
            ]);
        }
        lines.push(format!("{count} = {count} - 1U;"));
        (asked.sender, format!("{count} > 0U"), lines)
    };
    program.asked.iter().filter(|asked| is_such(asked)).map(slot).collect()
}

/// The functions that take what the next sender asks for or tells.
pub(super) fn take(writer: &mut Writer, program: &Program, names: &Names) {
    for goal in program.urgent() {
        let slots = asked_slots(program, names, |asked| asked.preemptive && asked.name == goal);
        let functions = take_urgent(goal);
        let functions = [&functions[0], &functions[1]].map(String::as_str);
        take_in_turn(writer, program, names, functions, &urgent_turn(goal), &slots);
    }
    let told: Slots = noticed(program)
        .map(|told| {
            let flag = changed_flag(program, names, told);
            let event = event_name(names, Slot::Told, told_name(program, told));
            let lines = vec![format!("event = {event};"), format!("{flag} = false;")];
            (told.sender, flag, lines)
        })
        .collect();
    let asked = asked_slots(program, names, |asked| !asked.preemptive);
    for (functions, turn, slots) in [(TAKE_ASKED, ASKED_TURN, asked), (TAKE_TOLD, TOLD_TURN, told)]
    {
        if !slots.is_empty() {
            take_in_turn(writer, program, names, functions, turn, &slots);
        }
    }
}

fn take_in_turn(
    writer: &mut Writer,
    program: &Program,
    names: &Names,
    [function, function_from]: [&str; 2],
    turn: &str,
    slots: &Slots,
) {
    let none: [CType; 0] = [];
    let peers = program.configuration.peers.len();
    let (event_type, turn) = (names.interface("event_t"), names.field(turn));
    let mut parameters = names.state_parameter();
    parameters.push("uint32_t value".to_owned());
    writer.line("/* What this peer says, if it says anything. */");
    writer.open(format!("static {event_type} {function_from}({})", parameters.join(", ")));
    writer.line(format!("{event_type} event = {};", no_event(names)));
    writer.line("");
    writer.line("switch (value)");
    writer.line("{");
    writer.indent();
    for peer in 0..peers {
        let own: Vec<_> = slots.iter().filter(|(sender, ..)| *sender == peer).collect();
        if own.is_empty() {
            continue;
        }
        case(writer, program, peer);
        for (index, (_, condition, lines)) in own.iter().enumerate() {
            let keyword = if index == 0 { "if" } else { "else if" };
            writer.open(format!("{keyword} ({condition})"));
            for line in lines {
                writer.line(line);
            }
            writer.close("}");
        }
        if own.len() > 1 {
            writer.open("else");
            writer.line("/* It has said nothing. */");
            writer.close("}");
        }
        end_case(writer);
    }
    default_case(writer, "/* It says nothing of this kind. */");
    writer.open(format!("if (event != {})", no_event(names)));
    writer.line("/* The next time, the one behind it is heard first. */");
    writer.line(format!("{turn} = (value + 1U) % {peers}U;"));
    writer.close("}");
    writer.line("return event;");
    writer.close("}");
    writer.line("");
    let from = |offset: &str| {
        let value = format!("({turn} + {offset}) % {peers}U");
        format!("event = {function_from}({});", names.arguments([value]))
    };
    writer.line("/* What the peer says whose turn it is, or one behind it. */");
    writer.open(format!("static {event_type} {function}({})", names.parameters(&none)));
    writer.line(format!("{event_type} event = {};", no_event(names)));
    writer.line("");
    if peers <= UNROLLED {
        // Without a loop, the compiled code has a longest path.
        writer.line(from("0U"));
        for offset in 1..peers {
            writer.open(format!("if (event == {})", no_event(names)));
            writer.line(from(&format!("{offset}U")));
            writer.close("}");
        }
    } else {
        let going_on = format!("(round < {peers}U) && (event == {})", no_event(names));
        writer.open(format!("for (uint32_t round = 0U; {going_on}; round++)"));
        writer.line(from("round"));
        writer.close("}");
    }
    writer.line("return event;");
    writer.close("}");
    writer.line("");
}
