//! A second translation to C, as plain as possible, to which the C back end's is compared.
//!
//! It shares no code with the back end, and has another structure: lists in place of rings, jumps in place of
//! nested blocks, wide integers in place of checks before each operation. Its functions call `plain_call_N(..)` for
//! the basic action `N`, and `plain_update()` in place of `updateBeliefs()`.

mod cycle;
mod floats;
mod messages;
mod plans;

use std::fmt::Write as _;

pub(crate) use self::cycle::{event_number, goal_number, is_queue, length, perceived, preempting};
pub use self::floats::{ANY_FLOATS, float_function, float_operators};
pub(crate) use self::floats::{calls_float_functions, float_functions};
pub(crate) use self::messages::TURNS;
use crate::program::Program;

/// The declaration of the state `plain`, of type `struct plain_state`.
pub(crate) fn state(program: &Program) -> String {
    let mut text = String::from("enum { PLAIN_NO_PLAN, PLAIN_FAILED, PLAIN_ACHIEVED };\n");
    _ = writeln!(text, "enum {{ PLAIN_LENGTH = {} }};", length(program));
    _ = writeln!(text, "enum {{ PLAIN_DEFERRED = {} }};", program.deferred.len().max(1));
    for declared in &program.configuration.structs {
        let name = &declared.name.text;
        _ = writeln!(text, "static bool plain_equal_{name}({name} a, {name} b)\n{{");
        let fields = declared.fields.iter();
        let same: Vec<String> =
            fields.map(|(field, _)| format!("a.{0} == b.{0}", field.text)).collect();
        _ = writeln!(text, "    return {};\n}}\n", same.join(" && "));
    }
    text + &cycle::state(program)
}

/// Its functions: `plain_init()`, `plain_clear()`, `plain_step()`, `plain_has_room()`, `plain_raise_N(..)` for the external
/// event `N`, and `plain_set_B(..)` for the belief `B`.
pub(crate) fn functions(program: &Program) -> String {
    cycle::posting(program)
        + &plans::plans(program)
        + &cycle::step(program)
        + &cycle::interface(program)
}
