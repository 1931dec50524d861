//! The trusted base: the programs that were used, and what else has to be believed.

use super::evidence::Tool;
use crate::eva::FRAMA_C;
use crate::prove::Cbmc;
use crate::tool::{ToolError, version};

/// The programs, with their versions.
///
/// # Errors
/// If one is missing.
pub(super) fn tools(cbmc: &Cbmc) -> Result<Vec<Tool>, ToolError> {
    let tool = |name: &str, version: String, trust: &str| Tool {
        name: name.to_owned(),
        version,
        trust: trust.to_owned(),
    };
    Ok(vec![
        tool(
            "asl2c",
            env!("CARGO_PKG_VERSION").to_owned(),
            "Not the translator: its C is compared with the agent's text. But the second, plain translation is the \
             specification in that comparison, the reference interpreter tells what tests expect, and both read \
             the texts by one parser; the translator states what the proofs assert.",
        ),
        tool(
            "CBMC",
            cbmc.version().to_owned(),
            "All proofs: its reading of C, its bit-precise arithmetic and its solver.",
        ),
        tool(
            "Frama-C",
            version(FRAMA_C)?,
            "Nothing alone: its EVA looks for errors at run time beside CBMC, in another way. What one of the two cannot \
             exclude is open.",
        ),
        tool(
            "gcc",
            version("gcc")?,
            "The preprocessor of the proofs; the code of the tests; stack and longest path, which hold for code of \
             this compiler with these options and no other.",
        ),
        tool("gcov", version("gcov")?, "The counts of executed lines and conditions."),
        tool(
            "cppcheck",
            version("cppcheck")?,
            "The rules of MISRA C:2012, of which its addon checks most, not all.",
        ),
        tool(
            "valgrind",
            version("valgrind")?,
            "The costliest step that was found. It is no bound.",
        ),
    ])
}

/// What else has to be believed.
pub(super) fn assumptions() -> Vec<String> {
    [
        "The properties say what is meant: they are read and agreed with by people.",
        "The environment calls the agent's functions one after the other, never one inside another \
         but for set_b() in updateBeliefs(), and its own \
         functions return. In the proofs it may do anything else: raise every event with any arguments, set beliefs \
         to any values, and answer each query differently. All proofs have calls of clear() and of init() at any time; \
         after them nothing is due.",
        "In the proofs of properties the agent's state is passed in; where the C has a static state they hold for the same \
         plans and the same cycle with the other access to the state. The comparison is of the C as it is.",
        "An int has 32 bits, integers are two's complement, and floats and doubles are those of IEEE 754, as on all \
         usual machines. Each operation is rounded: gcc and clang do so with -ffp-contract=off, with which everything \
         here was compiled.",
        "The compiler of the product, its options and the processor do what the C says. asl2c --report --target \
         runs the compiled C of a microcontroller.",
        "What the environment's functions do is not part of this evidence.",
    ]
    .map(str::to_owned)
    .to_vec()
}
