//! Input of a model checker for comparing an agent's C with a second, plain translation.

use std::fmt::Write as _;

use crate::GeneratedFile;

use crate::backend::c::NO_OWN_STATE;
pub use crate::backend::c::{END, ENOUGH_ROOM, ROOM};

/// The file of a comparison that includes all others.
pub const COMPARISON: &str = "comparison.c";

/// An agent's C, and a plain translation of the same agent beside it.
///
/// The functions `plain_base`, `plain_case_N` and `plain_interface` of [`COMPARISON`] assert that both start in
/// related states, and that a step, or another call of the environment, from any related states makes the same
/// calls and leads to related states; `plain_cover` asserts that each state is one from which some `plain_case_N`
/// starts. `main` is an execution from the start.
///
/// Other variables with static lifetime must be arbitrary in all of them but `main`, because the relation does
/// not know them. In each but `plain_cover` the assertion [`END`] must fail.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
#[must_use = "the comparison has to be proved"]
pub struct Comparison {
    /// The C of the agent first, then its headers, then [`COMPARISON`].
    pub files: Vec<GeneratedFile>,
    /// The functions `plain_case_0`, `plain_case_1`, ..: one for each event that can be the next, which is named here.
    pub cases: Vec<String>,
    /// A bound for all loops of the functions, but for that of `main`.
    pub unwinding: usize,
    /// Whether one of the two computes floating-point numbers: [`ANY_FLOATS`](crate::ANY_FLOATS) changes nothing otherwise.
    pub computes_floats: bool,
}

impl Comparison {
    /// Compares another C file in place of the translation, with statements that give any value to all objects that the
    /// relation does not know, and the names in the file: none of them may be a macro. Whether it `computes_floats` is
    /// told, too.
    ///
    /// The C must be of a language that is known, because a model checker may misjudge other C: the crate `judged-c`
    /// parses and prints it.
    pub fn replace_c(
        &mut self,
        text: String,
        arbitrary: &str,
        names: &[String],
        computes_floats: bool,
    ) {
        self.computes_floats |= computes_floats;
        let c = &mut self.files[0];
        c.text = text;
        let included = format!("#include \"{}\"\n", c.name);
        let mut guarded = included.clone();
        for name in names {
            _ = writeln!(
                guarded,
                "#ifdef {name}\n#error \"a header defines a macro of this name, which the C uses\"\n#endif"
            );
        }
        let own_state = format!("static void plain_own(void)\n{{\n{arbitrary}}}\n");
        if let Some(compared) = self.files.iter_mut().find(|file| file.name == COMPARISON) {
            let text = compared.text.replacen(&included, &guarded, 1);
            compared.text = text.replacen(NO_OWN_STATE, &own_state, 1);
        }
    }
}
