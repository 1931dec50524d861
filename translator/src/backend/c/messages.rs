//! Messages between agents: what a peer tells or asks for, and which of it comes next.
//!
//! A belief that peers tell has a slot for each of them; a goal that they ask for, a ring for each of them. Senders are
//! served in turn, so that none keeps another one waiting.

use super::events::{UNROLLED, else_count, event_name, no_event, run, wrapped};
use super::helpers::Helpers;
use super::names::{Names, argument, argument_names};
use super::said::{
    TURNS, asked_name, asked_types, has_values, noticed, ring_field, ring_parts, told_name,
};
use super::spelling::conjunction;
use super::state::{Slot, belief_value, held, pending, slot_value};
use crate::backend::writer::Writer;
use crate::program::{Asked, Belief, Program, Told};
use crate::syntax::ast::Performative;
use crate::types::CType;

/// The functions for messages that arrive.
pub(crate) fn received(program: &Program) -> Vec<Received> {
    let functions = program.configuration.receiving().into_iter();
    functions
        .map(|(name, performative, message)| Received {
            name,
            performative,
            about: message.name.text.clone(),
            types: message.said(performative),
        })
        .collect()
}

/// A function for a message that arrives.
pub(crate) struct Received {
    /// `receive_tell_at`
    pub(crate) name: String,
    pub(crate) performative: Performative,
    /// The belief or goal.
    pub(crate) about: String,
    /// The types of its arguments: the sender, and what it says.
    pub(crate) types: Vec<CType>,
}

impl Received {
    /// What it does.
    pub(crate) fn comment(&self) -> &'static str {
        match self.performative {
            Performative::Tell => "Believed at once. Returns whether this peer may tell it.",
            Performative::Untell => "Believed no more. Returns whether this peer may tell it.",
            Performative::Achieve => "Returns whether the goal of this peer was accepted.",
            Performative::Unachieve => {
                "Forgets what this peer has asked for. Returns whether it may ask for it."
            }
        }
    }

    fn hears_told(&self, told: &Told) -> bool {
        self.performative.declared() == Performative::Tell && told.name == self.about
    }

    fn hears_asked(&self, asked: &Asked) -> bool {
        self.performative.declared() == Performative::Achieve && asked.name == self.about
    }

    /// `bool receive_tell_at(peer_t argument1, double argument2)`
    pub(super) fn head(&self, names: &Names) -> String {
        let parameters = names.parameters(&self.types);
        format!("bool {}({parameters})", names.interface(&self.name))
    }
}

/// All functions for messages that arrive.
pub(super) fn receive(
    writer: &mut Writer,
    program: &Program,
    names: &Names,
    helpers: &mut Helpers,
) {
    for function in received(program) {
        writer.line("");
        writer.open(function.head(names));
        let is_heard = program.told.iter().any(|told| function.hears_told(told))
            || program.asked.iter().any(|asked| function.hears_asked(asked));
        if !is_heard {
            for argument in argument_names(&function.types) {
                writer.line(format!("(void){argument};"));
            }
            if names.is_context() {
                writer.line("(void)self;");
            }
            writer.line("/* The agent has no plans for it. */");
            writer.line("return false;");
            writer.close("}");
            continue;
        }
        writer.line("bool accepted = false;");
        writer.line("");
        let from = argument(0);
        writer.open(format!("if ({from} != {})", names.field("me")));
        writer.line(format!("const uint32_t value = {from};"));
        writer.line("");
        writer.line("switch (value)");
        writer.line("{");
        writer.indent();
        for told in program.told.iter().filter(|told| function.hears_told(told)) {
            case(writer, program, told.sender);
            if function.performative == Performative::Tell {
                tell(writer, program, names, helpers, told);
            } else {
                untell(writer, program, names, told);
            }
            end_case(writer);
        }
        for asked in program.asked.iter().filter(|asked| function.hears_asked(asked)) {
            case(writer, program, asked.sender);
            if function.performative == Performative::Achieve {
                achieve(writer, program, names, asked);
            } else {
                let count = names.field(&ring_field(program, asked, "count"));
                writer.line(format!("{count} = 0U;"));
                writer.line("accepted = true;");
            }
            end_case(writer);
        }
        default_case(writer, "/* This peer does not send it. */");
        writer.close("}");
        writer.line("return accepted;");
        writer.close("}");
    }
}

fn case(writer: &mut Writer, program: &Program, sender: usize) {
    writer.line(format!("case {}:", program.peer(sender)));
    writer.indent();
}

fn end_case(writer: &mut Writer) {
    writer.line("break;");
    writer.dedent();
}

/// The end of a switch over peers.
fn default_case(writer: &mut Writer, comment: &str) {
    writer.line("default:");
    writer.indent();
    writer.line(comment);
    writer.line("break;");
    writer.dedent();
    writer.dedent();
    writer.line("}");
}

fn changed_flag(program: &Program, names: &Names, told: &Told) -> String {
    names.field(&pending(Slot::Told, told_name(program, told)))
}

fn tell(writer: &mut Writer, program: &Program, names: &Names, helpers: &mut Helpers, told: &Told) {
    let belief: &Belief = program.belief(told.belief);
    let held = names.field(&held(&belief.name));
    let field = |index| names.field(&belief_value(&belief.name, index));
    if told.added.is_some() || told.removed.is_some() {
        // A belief that cannot be compared always counts as changed.
        if belief.types.iter().all(CType::has_equality) {
            let mut same = vec![held.clone()];
            for (index, ctype) in belief.types.iter().enumerate() {
                same.push(helpers.equality(ctype, &field(index), &argument(index + 1)));
            }
            writer.open(format!("if (!({}))", conjunction(&same)));
        } else {
            writer.open_bare();
        }
        writer.line(format!("{} = true;", changed_flag(program, names, told)));
        writer.close("}");
    }
    for index in 0..belief.types.len() {
        writer.line(format!("{} = {};", field(index), argument(index + 1)));
    }
    writer.line(format!("{held} = true;"));
    writer.line("accepted = true;");
}

fn untell(writer: &mut Writer, program: &Program, names: &Names, told: &Told) {
    let held = names.field(&held(told_name(program, told)));
    if told.added.is_some() || told.removed.is_some() {
        writer.open(format!("if ({held})"));
        writer.line(format!("{} = true;", changed_flag(program, names, told)));
        writer.close("}");
    }
    writer.line(format!("{held} = false;"));
    writer.line("accepted = true;");
}

fn achieve(writer: &mut Writer, program: &Program, names: &Names, asked: &Asked) {
    let field = |part: &str| names.field(&ring_field(program, asked, part));
    let (first, count) = (field("first"), field("count"));
    writer.open(format!("if ({count} < {}U)", asked.room));
    if !asked_types(program, asked).is_empty() {
        let slot = wrapped(&format!("{first} + {count}"), asked.room);
        writer.line(format!("const uint32_t slot = {slot};"));
        writer.line("");
    }
    for index in 0..asked_types(program, asked).len() {
        let place = names.field(&slot_value(Slot::Asked, &asked_name(program, asked), index));
        writer.line(format!("{place}[slot] = {};", argument(index + 1)));
    }
    writer.line(format!("{count} = {count} + 1U;"));
    writer.line("accepted = true;");
    writer.close("}");
    else_count(writer, &names.field("refused"));
}

/// Whether a peer waits to be heard, as expressions: with a goal, and with a belief.
fn waiting(program: &Program, names: &Names) -> [Vec<String>; 2] {
    let asked = program.asked.iter();
    let count = |asked| names.field(&ring_field(program, asked, "count"));
    [
        asked.map(|asked| format!("({} > 0U)", count(asked))).collect(),
        noticed(program).map(|told| changed_flag(program, names, told)).collect(),
    ]
}

/// Whether a peer waits to be heard, as expressions.
pub(super) fn waits(program: &Program, names: &Names) -> Vec<String> {
    waiting(program, names).concat()
}

/// Assignments after which no peer waits to be heard.
pub(super) fn silence(program: &Program, names: &Names) -> Vec<String> {
    let asked = program.asked.iter();
    let asked =
        asked.map(|asked| format!("{} = 0U", names.field(&ring_field(program, asked, "count"))));
    let told =
        noticed(program).map(|told| format!("{} = false", changed_flag(program, names, told)));
    asked.chain(told).collect()
}

/// What comes next: whether something of a kind waits, and the call that takes it.
pub(super) fn branches(program: &Program, names: &Names) -> Vec<(String, Vec<String>)> {
    let [asked, told] = waiting(program, names);
    let kinds = [(asked, "take_asked"), (told, "take_told")].into_iter();
    kinds
        .filter(|(waiting, _)| !waiting.is_empty())
        .map(|(waiting, function)| {
            let taken = format!("event = {function}({});", names.arguments(std::iter::empty()));
            (waiting.join(" || "), vec![taken])
        })
        .collect()
}

/// The functions that take what the next sender asks for or tells.
pub(super) fn take(writer: &mut Writer, program: &Program, names: &Names) {
    let asked: Vec<(usize, String, Vec<String>)> = (program.asked.iter())
        .map(|asked| {
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
        })
        .collect();
    let told: Vec<(usize, String, Vec<String>)> = noticed(program)
        .map(|told| {
            let flag = changed_flag(program, names, told);
            let event = event_name(names, Slot::Told, told_name(program, told));
            (
                told.sender,
                flag.clone(),
                vec![format!("event = {event};"), format!("{flag} = false;")],
            )
        })
        .collect();
    let [asked_turn, told_turn] = TURNS;
    for (function, turn, slots) in
        [("take_asked", asked_turn, asked), ("take_told", told_turn, told)]
    {
        if !slots.is_empty() {
            take_in_turn(writer, program, names, (function, turn), &slots);
        }
    }
}

fn take_in_turn(
    writer: &mut Writer,
    program: &Program,
    names: &Names,
    (function, turn): (&str, &str),
    slots: &[(usize, String, Vec<String>)],
) {
    let none: [CType; 0] = [];
    let peers = program.configuration.peers.len();
    let (event_type, turn) = (names.interface("event_t"), names.field(turn));
    let mut parameters = names.state_parameter();
    parameters.push("uint32_t value".to_owned());
    writer.line("/* What this peer says, if it says anything. */");
    writer.open(format!("static {event_type} {function}_from({})", parameters.join(", ")));
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
        format!("event = {function}_from({});", names.arguments([value]))
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

/// The cases that handle what peers say.
pub(super) fn cases(writer: &mut Writer, program: &Program, names: &Names) {
    for asked in &program.asked {
        let name = asked_name(program, asked);
        writer.line(format!("case {}:", event_name(names, Slot::Asked, &name)));
        writer.indent();
        let taken = names.field("asked_taken");
        let mut values: Vec<String> = (0..asked_types(program, asked).len())
            .map(|index| {
                format!("{}[{taken}]", names.field(&slot_value(Slot::Asked, &name, index)))
            })
            .collect();
        values.push(program.peer(asked.sender));
        run(writer, program, names, asked.handler, &values);
        end_case(writer);
    }
    for told in noticed(program) {
        let belief = program.belief(told.belief);
        writer.line(format!("case {}:", event_name(names, Slot::Told, &belief.name)));
        writer.indent();
        let mut values: Vec<String> = (0..belief.types.len())
            .map(|index| names.field(&belief_value(&belief.name, index)))
            .collect();
        values.push(program.peer(told.sender));
        writer.open(format!("if ({})", names.field(&held(&belief.name))));
        match told.added {
            Some(handler) => run(writer, program, names, handler, &values),
            None => writer.line("handled = false;"),
        }
        writer.close("}");
        writer.open("else");
        match told.removed {
            Some(handler) => run(writer, program, names, handler, &values),
            None => writer.line("handled = false;"),
        }
        writer.close("}");
        end_case(writer);
    }
}

/// How many changes a step can take away without handling one.
pub(super) fn unnoticed(program: &Program) -> usize {
    noticed(program).filter(|told| told.added.is_none() || told.removed.is_none()).count()
}

/// The type of peers and their constants.
pub(super) fn peer_type(writer: &mut Writer, program: &Program) {
    if !program.has_peers() {
        return;
    }
    // Headers of several agents may be included together.
    writer.line("/* Agents that talk with each other. */");
    writer.line("#ifndef ASL2C_PEER_T");
    writer.line("#define ASL2C_PEER_T");
    writer.line(format!("typedef uint8_t {};", CType::peer().name));
    writer.line("#endif");
    for number in 0..program.configuration.peers.len() {
        writer.line(format!("#define {} {number}U", program.peer(number)));
    }
    writer.line("");
}

/// Forgets all messages that wait.
pub(super) fn forget(writer: &mut Writer, program: &Program, names: &Names) {
    for asked in &program.asked {
        for part in ring_parts(program, asked) {
            writer.line(format!("{} = 0U;", names.field(&ring_field(program, asked, part))));
        }
    }
    for told in noticed(program) {
        writer.line(format!("{} = false;", changed_flag(program, names, told)));
    }
    let [asked_turn, told_turn] = TURNS;
    if !program.asked.is_empty() {
        writer.line(format!("{} = 0U;", names.field(asked_turn)));
    }
    if has_values(program) {
        writer.line(format!("{} = 0U;", names.field("asked_taken")));
    }
    if noticed(program).next().is_some() {
        writer.line(format!("{} = 0U;", names.field(told_turn)));
    }
}
