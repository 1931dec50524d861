//! The C in which agents are written: a listed part of the language, in which C that was edited by hand is judged.
//!
//! `asl2c validate --c FILE` has to be right about any text. Therefore nothing is forbidden piece by piece: [`judge`]
//! parses the constructs that the translator itself writes, and a few that people write in their place, checks their
//! names, types and order of evaluation, and refuses everything else with its place. What a model checker or compiler
//! gets is printed from the tree, never the given text.
//!
//! Nothing here reads a file or starts a program.

mod check;
mod header;
mod language;
mod lexer;
mod parser;
mod print;
mod refused;
mod tree;
mod types;

use std::collections::HashSet;

use translator::Comparison;

pub use self::header::judge_header;
use self::language::Language;
pub use self::print::{CHECKED_INDEX, macros, words};
pub use self::refused::{Refused, Rule};

/// C of the language.
#[derive(Debug, Clone, PartialEq, Eq)]
#[must_use = "it has to be compared"]
pub struct Judged {
    text: String,
    compared: String,
    arbitrary: String,
    names: Vec<String>,
    computes_floats: bool,
}

impl Judged {
    /// The C, printed from its tree.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether it multiplies and may have floating-point numbers, so that a compiler may contract operations on them.
    pub fn may_be_contracted(&self) -> bool {
        let words = words(&self.text);
        self.text.contains(" * ") && ["float", "double"].iter().any(|word| words.contains(*word))
    }

    /// Statements of a model checker that make all objects arbitrary which outlive a call, but for the agent's state.
    pub fn arbitrary(&self) -> &str {
        &self.arbitrary
    }

    /// Puts the C in the place of the translation, with checks that each index is inside its array, and with the
    /// comparison's functions in place of floating-point operators.
    pub fn put_into(self, comparison: &mut Comparison) {
        comparison.replace_c(self.compared, &self.arbitrary, &self.names, self.computes_floats);
    }
}

/// Judges C in the place of the translation in a comparison. `headers` are the texts of all headers of the environment
/// that the generated ones include: their macros must not have names that the C uses.
///
/// # Errors
/// If something in it is not of the language: the first one, with its place. [`Rule::Translation`] if the translation that
/// the comparison has is not of the language itself.
pub fn judge<'a>(
    comparison: &Comparison,
    text: &str,
    headers: impl IntoIterator<Item = &'a str>,
) -> Result<Judged, Refused> {
    let mut files = comparison.files.iter();
    let own = files.next().map_or("", |file| file.text.as_str());
    let generated = files.filter(|file| !file.setting.is_empty());
    let generated: Vec<&str> = generated.map(|file| file.text.as_str()).collect();
    let language = Language::new(own, &generated).map_err(|refused| Refused {
        line: 1,
        column: 1,
        rule: Rule::Translation,
        ..refused
    })?;
    let macros: HashSet<String> = headers.into_iter().flat_map(macros).collect();
    let unit = parser::parse(text, &language.types())?;
    let known = check::check(&unit, &language, &macros)?;
    let (text, arbitrary) = print::print(&unit, &language, None);
    let (compared, _) = print::print(&unit, &language, Some(&known.floats));
    let names = known.names.into_keys().collect();
    Ok(Judged { text, compared, arbitrary, names, computes_floats: !known.floats.is_empty() })
}
