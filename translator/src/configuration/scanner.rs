//! Scanner for words and symbols of a configuration.

use diagnostic::{Diagnostic, Span};

use super::ExternalTrigger;
use crate::code::Code;
use crate::syntax::ast::{Name, Operator, TriggerKind};

/// The version of the language of configurations and systems that is read and may be written in them: `version 1;`.
pub const VERSION: u32 = 1;

/// What was read, or the error at its place.
pub(crate) type Parsed<T> = Result<T, Diagnostic>;

/// A text of declarations, and how far it is read.
pub(crate) struct Scanner<'a> {
    /// The whole text.
    pub(crate) text: &'a str,
    /// What is read next, in bytes from the start of the text.
    pub(crate) position: usize,
}

impl<'a> Scanner<'a> {
    /// The text that is not read yet.
    pub(crate) fn rest(&self) -> &'a str {
        &self.text[self.position..]
    }

    /// Reads `symbol` if the text goes on with it, and returns whether it does.
    pub(crate) fn take(&mut self, symbol: &str) -> bool {
        let found = self.rest().starts_with(symbol);
        if found {
            self.position += symbol.len();
        }
        found
    }

    /// Reads `symbol`, which must be next but for blanks.
    pub(crate) fn expect(&mut self, symbol: &str) -> Parsed<()> {
        self.skip_blanks()?;
        if self.take(symbol) { Ok(()) } else { Err(self.unexpected(&format!("`{symbol}`"))) }
    }

    /// Reads a word, which must be next but for blanks: a letter or `_`, and then letters, digits or `_`. `expected` is what
    /// an error says in its place.
    pub(crate) fn word(&mut self, expected: &str) -> Parsed<Name> {
        self.skip_blanks()?;
        if !self.rest().starts_with(is_word_start) {
            return Err(self.unexpected(expected));
        }
        let length = self.rest().find(|c| !is_word(c)).unwrap_or(self.rest().len());
        let span = self.position..self.position + length;
        self.position = span.end;
        Ok(Name { text: self.text[span.clone()].to_owned(), span })
    }

    /// Reads blanks and comments, `// ..` and `/* .. */`; an error if one is not closed.
    pub(crate) fn skip_blanks(&mut self) -> Parsed<()> {
        loop {
            let trimmed = self.rest().trim_start();
            self.position = self.text.len() - trimmed.len();
            if trimmed.starts_with("//") {
                self.position += trimmed.find('\n').unwrap_or(trimmed.len());
            } else if let Some(comment) = trimmed.strip_prefix("/*") {
                let start = self.position;
                let Some(length) = comment.find("*/") else {
                    self.position = self.text.len();
                    return Err(Code::NotClosed
                        .at("comment is never closed", start..start + 2)
                        .help("close it with `*/`"));
                };
                self.position += length + 4;
            } else {
                return Ok(());
            }
        }
    }

    /// Reads `version 1;`, which may stand before all sections. Another version is an error, because nothing in its text can be
    /// relied on.
    pub(crate) fn version(&mut self) -> Parsed<()> {
        let begin = self.position;
        // A comment that is not closed is told when sections are looked for.
        let is_there = self.word("").is_ok_and(|word| word.text == "version");
        if !is_there {
            self.position = begin;
            return Ok(());
        }
        self.skip_blanks()?;
        let rest = self.rest();
        let length = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
        if length == 0 {
            return Err(self.unexpected("the number of a version"));
        }
        let (number, place) = (&rest[..length], self.position..self.position + length);
        self.position = place.end;
        self.expect(";")?;
        if number.parse() == Ok(VERSION) {
            return Ok(());
        }
        let shown: String = number.chars().take(12).collect();
        Err(Code::OtherVersion
            .at(format!("this text has version {shown} of its language"), place)
            .help(format!("this program reads version {VERSION}")))
    }

    /// Continues behind the next `;`, before the `}` that ends the section, or at the end of the text.
    pub(crate) fn skip_entry(&mut self) {
        match self.rest().find([';', '}']) {
            Some(offset) if self.rest()[offset..].starts_with(';') => self.position += offset + 1,
            Some(offset) => self.position += offset,
            None => self.position = self.text.len(),
        }
    }

    /// Reads `+!goal`, `+belief` or `-belief`, which must be next.
    pub(crate) fn trigger(&mut self) -> Parsed<ExternalTrigger> {
        let start = self.position;
        let operator = if self.take("+") {
            Operator::Add
        } else if self.take("-") {
            Operator::Delete
        } else {
            return Err(self.unexpected("`+!goal`, `+belief` or `-belief`"));
        };
        let kind = if self.take("!") {
            TriggerKind::Achieve
        } else if self.rest().starts_with('?') {
            return Err(self.unexpected("`+!goal`, `+belief` or `-belief`"));
        } else {
            TriggerKind::Belief
        };
        let name = self.word("a name")?;
        let span = start..self.position;
        if operator == Operator::Delete && kind == TriggerKind::Achieve {
            return Err(Code::NotTriggerable
                .at("`-!goal` cannot be raised from outside", span)
                .help("failure plans run when their goal fails"));
        }
        Ok(ExternalTrigger { operator, kind, name, source: None, span })
    }

    /// The error that `expected` should stand here, and what does.
    pub(crate) fn unexpected(&self, expected: &str) -> Diagnostic {
        let word = self.rest().find(|c| !is_word(c)).unwrap_or(self.rest().len());
        match self.rest().chars().next() {
            Some(_) if word > 0 => Code::Syntax.at(
                format!("expected {expected}, found `{}`", &self.rest()[..word]),
                self.position..self.position + word,
            ),
            Some(found) => Code::Syntax.at(
                format!("expected {expected}, found `{}`", found.escape_debug()),
                span_of(self.position, found),
            ),
            None => Code::Syntax.at(
                format!("expected {expected}, found the end of the file"),
                self.position..self.position,
            ),
        }
    }
}

fn span_of(position: usize, character: char) -> Span {
    position..position + character.len_utf8()
}

/// Whether a word may begin with it.
pub(crate) fn is_word_start(character: char) -> bool {
    character.is_ascii_alphabetic() || character == '_'
}

/// Whether it may be in a word.
pub(crate) fn is_word(character: char) -> bool {
    character.is_ascii_alphanumeric() || character == '_'
}

/// The error that a section of this name is none of the `known` ones.
pub(crate) fn unknown_section(name: Name, known: &[&str]) -> Diagnostic {
    let help = if name.text == "version" {
        "the version stands before all sections".to_owned()
    } else {
        advice(&name.text, known)
    };
    Code::UnknownSection.at(format!("unknown section `{}`", name.text), name.span).help(help)
}

/// Help for an unknown word: the `known` one that resembles it, or all of them.
pub(crate) fn advice(word: &str, known: &[&str]) -> String {
    match diagnostic::closest(word, known.iter().copied()) {
        Some(candidate) => format!("did you mean `{candidate}`?"),
        None => format!("known are: {}", known.join(", ")),
    }
}
