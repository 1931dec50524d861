//! The C back end: MISRA-style C99 without heap, recursion or unbounded loops.
//!
//! Each plan becomes one function, each trigger one function that tries its plans in order, and `next_step()`
//! handles at most one event completely. All state is in one struct: static in the C file or passed in,
//! depending on the configuration's `instance`.

mod cycle;
mod emitter;
mod equivalence;
mod events;
mod exercise;
mod expression;
mod handlers;
mod harness;
mod header;
mod helpers;
mod host;
mod interface;
mod literal;
mod locals;
mod messages;
mod names;
mod plan;
mod posting;
mod said;
mod scripted;
mod spelling;
mod state;
mod trace;
mod turns;

use self::names::Names;
use self::state::StateLayout;
use super::writer::Writer;
use crate::program::Program;

pub use self::equivalence::{END, ENOUGH_ROOM, ROOM};
pub(crate) use self::equivalence::{NO_OWN_STATE, cases, comparison, unwinding};
pub use self::exercise::{EXERCISE_SEED, EXERCISE_STATE, EXERCISE_STEPS};
pub(crate) use self::exercise::{
    environment_symbols, exercise, interface_symbols, uncreatable_type,
};
pub(crate) use self::handlers::plan_name;
pub(crate) use self::harness::{Moment, harness, unknown_type};
pub use self::host::{ANSWERS, CALLS, STEPS};
pub(crate) use self::messages::{Received, received};
pub use self::names::include_path;
pub(crate) use self::names::{action_symbol, comment_safe, symbol_prefix};
pub(crate) use self::scripted::scripted;
pub(crate) use self::state::{Counter, Field, FieldType, counters, handler_name, layout};
pub use self::trace::traced;

/// The option of gcc and clang without which a product and a sum of floating-point numbers may be rounded only once, where
/// the processor has an instruction for both. The rules of AgentSpeak, and all proofs, round each.
pub const ROUNDED: &str = "-ffp-contract=off";

/// The generated C texts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Files {
    pub(crate) source: String,
    pub(crate) header: String,
    pub(crate) basics: String,
}

/// Translates `program`; `input` is the name of its source for comments.
pub(crate) fn emit(program: &Program, input: &str) -> Files {
    let names = Names::new(program);
    let layout = layout(program);
    Files {
        source: source(program, &names, &layout, input),
        header: header::agent_header(program, &names, &layout, input),
        basics: header::basics_header(program, &names, input),
    }
}

fn source(program: &Program, names: &Names, layout: &StateLayout, input: &str) -> String {
    // Emitted first, because plans and interface determine the helpers.
    let mut plans = Writer::default();
    let mut helpers = handlers::handlers(&mut plans, program, names, input);
    let mut rest = Writer::default();
    cycle::cycle(&mut rest, program, names);
    interface::interface(&mut rest, program, names, &mut helpers);

    let mut writer = Writer::default();
    header::banner(&mut writer, program, input);
    if helpers.may_be_contracted() {
        writer.line(format!(
            "/* Compile with {ROUNDED}: each operation on floating-point numbers is rounded. */"
        ));
    }
    writer.line("");
    let settings = &program.configuration.settings;
    for included in [&settings.header, &settings.basics] {
        writer.line(format!("#include \"{}\"", include_path(&settings.output, included)));
    }
    writer.line("");
    header::private_types(&mut writer, names, layout);
    handlers::prototypes(&mut writer, program, names);
    helpers.emit(&mut writer, &program.configuration.structs);
    posting::posting(&mut writer, program, names);
    let mut text = writer.finish();
    text.push_str(&plans.finish());
    text.push_str(&rest.finish());
    text
}
