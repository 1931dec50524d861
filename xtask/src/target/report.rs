//! Reports the results on the terminal and in `docs/cortex-m4.md`.

use std::fmt::Write as _;

use asl2c::Bound;

use super::Measured;

/// Report for the terminal.
pub(super) fn lines(measured: &[Measured]) -> String {
    let mut text = String::from("agents on a Cortex-M4: stack and instructions of next_step()\n");
    for Measured { name, found, called, seen } in measured {
        let Some(step) = found.bounds.first() else { continue };
        let observed = &found.observed;
        // Writing to a string cannot fail.
        _ = writeln!(
            text,
            "  {name:<15}{:>4} of {:>4} bytes, {:>4} of {:>5} instructions, {}; {} of {} changes seen, {} of {} \
             actions and functions called",
            observed.stack,
            step.stack,
            observed.instructions,
            path(step),
            if found.difference.is_none() { "same trace" } else { "TRACE DIFFERS" },
            seen.0,
            seen.1,
            called.0,
            called.1
        );
        if let Some(difference) = &found.difference {
            let (line, host, target) = (difference.line, &difference.host, &difference.target);
            _ = writeln!(text, "    line {line}: here `{host}`, on the target `{target}`");
        }
    }
    text
}

/// Report for `docs/cortex-m4.md`.
pub(super) fn markdown(measured: &[Measured]) -> String {
    let mut text = String::from(INTRODUCTION);
    let versions = measured.first().map_or("", |first| &first.found.versions);
    _ = writeln!(text, "Measured with {versions}.\n");
    text += SIZES;
    for Measured { name, found, .. } in measured {
        let Some((step, others)) = found.bounds.split_first() else { continue };
        let stack = others.iter().map(|bound| bound.stack).max().unwrap_or(0);
        let longest =
            others.iter().max_by_key(|bound| bound.instructions.clone().unwrap_or(u64::MAX));
        let (state, code, library) = (found.state, found.text, found.library);
        let (own, most) = (step.stack, path(step));
        let other = longest
            .map_or_else(String::new, |bound| format!("{} (`{}`)", path(bound), bound.function));
        _ = writeln!(
            text,
            "| {name} | {code} | {library} | {state} | {own} | {most} | {stack} | {other} |"
        );
    }
    text += TRACES;
    for Measured { name, found, called, seen } in measured {
        let (lines, observed) = (found.lines, &found.observed);
        _ = writeln!(
            text,
            "| {name} | equal, {lines} lines | {} of {} | {} bytes, {} instructions | {} of {} |",
            called.0, called.1, observed.stack, observed.instructions, seen.0, seen.1
        );
    }
    text += LIMITS;
    text
}

/// Instructions of the longest path.
fn path(bound: &Bound) -> String {
    bound.instructions.as_ref().map_or_else(|_| "unknown".to_owned(), u64::to_string)
}

const INTRODUCTION: &str = "\
# Agents on a Cortex-M4

`cargo xtask target` compiles the generated C of the shipped agent and of [the gallery](../translator/agents/README.md) for
an Arm Cortex-M4 with a single-precision floating-point unit, without an operating system or C library, measures that code,
runs it under QEMU, and writes this page if the traces are those of the same C on the translating machine and no
step exceeded its bounds. For another agent, `asl2c --report --target cortex-m4 agent.conf` prints these figures
([Cost](agentspeak.md#cost)).

";

const SIZES: &str = "\
## Size, stack and longest path

The bounds come from the disassembly of the linked image, not from the C or the compiler's intermediate code. Every
instruction is followed from the call of a function to its return, also into the compiler's library (operations on `double`,
for which this processor has no instructions). An indirect jump or call, or recursion, would be an error, and a loop would
leave the path unknown: there is none in any of these agents. The longest path in the flow graph is therefore an upper bound of the
instructions; an `it` and the instructions that it skips count. The stack is that of the deepest path; the frames that the
compiler itself reports (`-fstack-usage`) must be the same. What the environment's functions take comes in addition.

Bytes and instructions; the library is the part of libgcc that the agent needs. State is the agent's struct, whether it is
static or passed in.

| agent | code | library | state | stack of `next_step()` | longest path of it | deepest stack of the other functions | their longest path |
|---|---|---|---|---|---|---|---|
";

const TRACES: &str = "
## The same trace

A generated program without libraries calls each agent's interface at random: events, beliefs with values close to the
numbers in its text and at the ends of ranges (also infinity and NaN), `init()`, `clear()` and `next_step()`, ten
thousand times the latter. The environment's functions return random answers. It prints every call in both directions
with all values, the bits of floating-point numbers included (only the bits of NaN are left out, which C does not
fix). The output of QEMU (machine `mps2-an386`, semihosting) must be that of gcc's code on the translating machine, byte for byte.

QEMU also logs each instruction of the agent in 500 steps: the costliest `next_step()` of these is in the last but one
column, and must not exceed the bounds above.

To see that the trace shows differences, one character of the C is changed: one comparison, `+` or `-`, at even
distances in the file. Whether a change that is not seen is in code that the random steps do not reach, or changes nothing
(such as a check that always holds), was not examined one by one.

| agent | traces | actions and functions called | costliest step found | changes seen |
|---|---|---|---|---|
";

const LIMITS: &str = "
## Limits

- Instructions are counted, not cycles: these depend on the memory's wait states, which are the board's.
- The figures hold for this version of the compiler and these options (`-O2 -fno-jump-tables -ffp-contract=off`). The last one is needed for
  `float` on a Cortex-M4F, whose multiply-add rounds once: the result is not the one that was proved then.
- An agent that multiplies or divides `double`s or divides 64-bit integers uses functions of libgcc with loops: its longest
  path is reported as unknown, its stack is not.
- An interrupt needs stack of its own, which is not included.
- QEMU executes instructions; it is not a model of the processor's timing or of the board.
";
