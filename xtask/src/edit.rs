//! Mistakes that are made on purpose, to see that they are found: each replaces an exact text of a source.

/// A text of a file and its replacement.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Edit {
    /// Path relative to the workspace, or the name of a generated file.
    pub(crate) file: &'static str,
    pub(crate) from: &'static str,
    pub(crate) to: &'static str,
}

impl Edit {
    /// The changed text of its file.
    ///
    /// # Errors
    /// How often the text to be replaced occurs, if that is not once.
    pub(crate) fn apply(&self, text: &str) -> Result<String, usize> {
        match text.matches(self.from).count() {
            1 => Ok(text.replacen(self.from, self.to, 1)),
            times => Err(times),
        }
    }
}

pub(crate) const fn edit(file: &'static str, from: &'static str, to: &'static str) -> Edit {
    Edit { file, from, to }
}

/// Sources with one mistake, and what must come of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mutant<E> {
    /// Description of the mistake.
    pub(crate) name: &'static str,
    pub(crate) first: Edit,
    /// Further edits: where two layers protect against a danger, both are disabled.
    pub(crate) more: &'static [Edit],
    pub(crate) expected: E,
}

impl<E> Mutant<E> {
    pub(crate) fn edits(&self) -> impl Iterator<Item = &Edit> {
        std::iter::once(&self.first).chain(self.more)
    }
}

/// A mutant with further edits.
pub(crate) const fn layered<E: Copy>(mutant: Mutant<E>, more: &'static [Edit]) -> Mutant<E> {
    Mutant { more, ..mutant }
}
