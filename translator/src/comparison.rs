//! Input of a model checker for comparing an agent's C with a second, plain translation.

use crate::GeneratedFile;

pub use crate::backend::c::{ENOUGH_ROOM, ROOM};

/// The file of a comparison that includes all others.
pub const COMPARISON: &str = "comparison.c";

/// An agent's C, and a plain translation of the same agent beside it.
///
/// The functions `base`, `step_N` and `interface` of [`COMPARISON`] assert that both start in related states,
/// and that a step, or another call of the environment, from any related states makes the same calls and
/// leads to related states; `cover` asserts that each state is one from which some `step_N` starts. `main` is
/// an execution from the start.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
#[must_use = "the comparison has to be proved"]
pub struct Comparison {
    /// The C of the agent first, then its headers, then [`COMPARISON`].
    pub files: Vec<GeneratedFile>,
    /// Number of the functions `step_0`, `step_1`, ..: one for each event that can be the next.
    pub steps: usize,
    /// A bound for all loops of the functions, but for that of `main`.
    pub unwinding: usize,
}

impl Comparison {
    /// Judges another C file in place of the translation.
    pub fn replace_c(&mut self, text: String) {
        self.files[0].text = text;
    }
}
