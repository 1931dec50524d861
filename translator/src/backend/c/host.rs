//! What all programs around an agent's C have in common: they define the environment's functions and call the agent's. They
//! differ in where values come from, and in what is recorded.

use super::messages::{Received, received};
use super::names::{Names, argument_names, constant};
use super::state::{counters, external_name};
use crate::backend::writer::Writer;
use crate::configuration::Basic;
use crate::program::{Belief, External, Program};
use crate::types::{CType, TypeKind};

/// Name in a trace of CBMC for calls by the environment, with their arguments.
pub const CALLS: &str = "calls";
/// Name in a trace of CBMC for results of functions.
pub const ANSWERS: &str = "answers";
/// Name in a trace of CBMC for steps of the agent.
pub const STEPS: &str = "steps";

/// A call that the environment makes outside of steps.
pub(super) enum Call<'a> {
    /// With the event's number.
    Raise(usize, &'a External),
    Set(&'a Belief),
    /// A peer says something.
    Receive(Received),
    Clear,
    /// Whether there is room for an event.
    Room,
    /// With the field that is counted.
    Count(&'static str),
}

impl Call<'_> {
    /// The function of the interface.
    pub(super) fn name(&self) -> String {
        match self {
            Self::Raise(_, external) => external_name(external),
            Self::Set(belief) => format!("set_{}", belief.name),
            Self::Receive(function) => function.name.clone(),
            Self::Clear => "clear".to_owned(),
            Self::Room => "can_add_event".to_owned(),
            Self::Count(counter) => format!("{counter}_events"),
        }
    }

    pub(super) fn types(&self) -> &[CType] {
        match self {
            Self::Raise(_, external) => &external.types,
            Self::Set(belief) => &belief.types,
            Self::Receive(function) => &function.types,
            Self::Clear | Self::Room | Self::Count(_) => &[],
        }
    }
}

/// Calls that raise an event, set a belief or say something.
pub(super) fn changes(program: &Program) -> impl Iterator<Item = Call<'_>> {
    let events = program.external.iter().enumerate();
    let events = events.map(|(number, external)| Call::Raise(number, external));
    let said = received(program).into_iter().map(Call::Receive);
    events.chain(program.settable().map(Call::Set)).chain(said)
}

/// Calls that ask for each counter.
pub(super) fn counts(program: &Program) -> impl Iterator<Item = Call<'_>> {
    counters(program).map(|counter| Call::Count(counter.name))
}

/// The type of a value that the environment has to create, if there is one like this.
pub(super) fn created(program: &Program, is_wanted: impl Fn(TypeKind) -> bool) -> Option<String> {
    let results = program.configuration.basics.iter().map(|basic| &basic.result);
    let arguments = program.settable().flat_map(|belief| &belief.types);
    let events = program.external.iter().flat_map(|external| &external.types);
    let messages = program.configuration.messages.iter();
    let said = messages.flat_map(|message| &message.parameters);
    let mut all = results.chain(arguments).chain(events).chain(said);
    all.find(|ctype| is_wanted(ctype.kind)).map(|ctype| ctype.name.clone())
}

/// Records a call by the environment for a trace of CBMC.
pub(super) fn record(writer: &mut Writer, call: &str, arguments: &[String]) {
    let values = if arguments.is_empty() { "0U".to_owned() } else { arguments.join(", ") };
    writer.line(format!("__CPROVER_output(\"{CALLS} {call}\", {values});"));
}

/// `updateBeliefs()`, which does nothing.
pub(super) fn update(writer: &mut Writer, names: &Names) {
    writer.line("/* Beliefs are set between the steps. */");
    writer.open(names.update_head());
    if names.is_context() {
        writer.line("(void)agent;");
        writer.line("(void)environment;");
    }
    writer.close("}");
    writer.line("");
}

/// One of these calls, as `choice` says, with values by `any`; `make` gets the names of its arguments.
pub(super) fn choose<'a>(
    writer: &mut Writer,
    choice: &str,
    calls: impl Iterator<Item = Call<'a>>,
    any: impl Fn(&CType) -> String,
    make: impl Fn(&mut Writer, &Call<'a>, Vec<String>),
    otherwise: &[String],
) {
    writer.open(format!("switch ({choice})"));
    for (case, call) in calls.enumerate() {
        writer.line(format!("case {case}U:"));
        // A block for the arguments; CBMC chooses another counterexample if `clear()` has one too.
        let is_block = !matches!(call, Call::Clear);
        if is_block {
            writer.open_bare();
        } else {
            writer.indent();
        }
        let arguments: Vec<String> = argument_names(call.types()).collect();
        for (ctype, argument) in call.types().iter().zip(&arguments) {
            writer.line(format!("{} = {};", constant(ctype, argument), any(ctype)));
        }
        make(writer, &call, arguments);
        writer.line("break;");
        if is_block { writer.close("}") } else { writer.dedent() }
    }
    writer.line("default:");
    for line in otherwise {
        writer.line(format!("    {line}"));
    }
    writer.line("    break;");
    writer.close("}");
}

/// A program around an agent's C.
pub(super) trait Host {
    /// Declarations for the basic action of this number.
    fn declare(&self, _writer: &mut Writer, _number: usize, _basic: &Basic) {}

    /// What is done when it is called.
    fn called(&self, writer: &mut Writer, number: usize, basic: &Basic);

    /// Its answer, as an expression.
    fn answer(&self, number: usize, basic: &Basic) -> String;

    /// What is done with `result`, its answer, if it has one.
    fn answered(&self, _writer: &mut Writer, _basic: &Basic) {}

    /// All basic actions.
    fn basics(&self, writer: &mut Writer, program: &Program, names: &Names) {
        for (number, basic) in program.configuration.basics.iter().enumerate() {
            self.declare(writer, number, basic);
            writer.open(names.action_head(basic));
            if names.is_context() {
                writer.line("(void)environment;");
            }
            self.called(writer, number, basic);
            let answers = basic.result.kind != TypeKind::Void;
            if answers {
                let answer = self.answer(number, basic);
                writer.line(format!("{} = {answer};", constant(&basic.result, "result")));
            }
            self.answered(writer, basic);
            if answers {
                writer.line("return result;");
            }
            writer.close("}");
            writer.line("");
        }
    }
}
