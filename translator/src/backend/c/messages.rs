//! Messages between agents: what a peer tells or asks for.
//!
//! A belief that peers tell has a slot for each of them; a goal that they ask for, a ring for each of them.

use super::events::{else_count, event_name, run, wrapped};
use super::helpers::Helpers;
use super::names::{Names, argument, argument_names};
use super::said::{
    TOLD_TURN, asked_name, asked_turns, asked_types, has_values, noticed, ring_field, ring_parts,
    told_name,
};
use super::spelling::conjunction;
use super::state::{Slot, belief_value, held, pending, slot_value, told_at};
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
            preempts: performative == Performative::Achieve
                && program.urgent().any(|goal| goal == message.name.text),
            asks_time: performative == Performative::Tell
                && program.told.iter().any(|told| told.timed && told.name == message.name.text),
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
    /// Whether it aborts the pending event.
    pub(crate) preempts: bool,
    /// Whether it calls the clock.
    pub(crate) asks_time: bool,
}

impl Received {
    /// What it does.
    pub(crate) fn comment(&self) -> &'static str {
        match self.performative {
            Performative::Tell if self.asks_time => {
                "Believed at once; calls the clock. Returns whether this peer may tell it."
            }
            Performative::Tell => "Believed at once. Returns whether this peer may tell it.",
            Performative::Untell => "Believed no more. Returns whether this peer may tell it.",
            Performative::Achieve if self.preempts => {
                "Returns whether the goal of this peer was accepted; it comes before whatever is running."
            }
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

pub(super) fn case(writer: &mut Writer, program: &Program, sender: usize) {
    writer.line(format!("case {}:", program.peer(sender)));
    writer.indent();
}

pub(super) fn end_case(writer: &mut Writer) {
    writer.line("break;");
    writer.dedent();
}

/// The end of a switch over peers.
pub(super) fn default_case(writer: &mut Writer, comment: &str) {
    writer.line("default:");
    writer.indent();
    writer.line(comment);
    writer.line("break;");
    writer.dedent();
    writer.dedent();
    writer.line("}");
}

pub(super) fn changed_flag(program: &Program, names: &Names, told: &Told) -> String {
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
    if let Some((clock, _)) = program.timing(told) {
        let clock = names.action(program.basic(*clock));
        let (place, arguments) = (told_at(&belief.name), names.action_arguments(&[]));
        writer.line(format!("{} = {clock}({arguments});", names.field(&place)));
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
    for turn in asked_turns(program) {
        writer.line(format!("{} = 0U;", names.field(&turn)));
    }
    if has_values(program) {
        writer.line(format!("{} = 0U;", names.field("asked_taken")));
    }
    if noticed(program).next().is_some() {
        writer.line(format!("{} = 0U;", names.field(TOLD_TURN)));
    }
}
