//! `asl2c --report --target`: an agent on a microcontroller.

use std::fmt::Write as _;

use super::CommandError;
use crate::agent::Agent;
use crate::target::{OnTarget, on_target};

/// Steps that are compared.
const STEPS: u32 = 5000;

/// Measures the agent on the target. Returns the text for the report, and whether the traces are equal.
pub(super) fn measured(agent: &Agent) -> Result<(String, bool), CommandError> {
    let mut exercise = translator::exercise(&agent.configuration, &agent.text)?;
    exercise.files.extend(agent.own_headers(&exercise.files)?);
    let found = on_target(&exercise, &exercise, STEPS)?;
    Ok((as_text(&found), found.difference.is_none()))
}

fn as_text(found: &OnTarget) -> String {
    let OnTarget { versions, text: code, library, state, observed, steps, lines, .. } = found;
    let mut text = format!("\non a Cortex-M4 ({versions})\n");
    let mut row = |label: &str, value: String| {
        // Writing to a string cannot fail.
        _ = writeln!(text, "  {label:<26}{value}");
    };
    row("code", format!("{code} bytes, and {library} of the compiler's library"));
    row("state", format!("{state} bytes"));
    for bound in &found.bounds {
        let path = match &bound.instructions {
            Ok(instructions) => format!("at most {instructions} instructions"),
            Err(reason) => format!("unknown number of instructions: {reason}"),
        };
        let stack = bound.stack;
        row(&format!("{}()", bound.function), format!("at most {stack} bytes of stack, {path}"));
    }
    let (count, stack) = (observed.instructions, observed.stack);
    row("costliest step found", format!("{stack} bytes of stack, {count} instructions (QEMU)"));
    let compared = match &found.difference {
        None => format!("the same as on this machine ({lines} lines)"),
        Some(difference) => {
            let (host, target) = (&difference.host, &difference.target);
            let line = difference.line;
            format!(
                "DIFFERS in line {line}\n    on this machine: {host}\n    on the target:   {target}"
            )
        }
    };
    row(&format!("trace of {steps} steps"), compared);
    text
}
