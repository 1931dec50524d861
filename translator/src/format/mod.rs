//! Formats the text of an agent or of a system in one canonical style.
//!
//! The formatter works on tokens, not on the tree: it changes only what is between them, so it can neither lose
//! a comment nor change the meaning. As in gofmt, the author decides where lines are broken, and the formatter
//! where they may be: see [`format()`].

mod comments;
mod layout;
mod lines;
mod roles;
mod sections;

use diagnostic::{Diagnostic, Source};

use self::comments::Gap;
use self::layout::Layout;
use crate::TranslateError;
use crate::gather::gather;
use crate::syntax::lexer::tokenize;
use crate::syntax::parse;
use crate::system::parse_system;

/// Maximum number of characters in a line, if there is a place to break it. Comments are never broken.
const WIDTH: usize = 120;

/// The text of an agent in canonical style; `name` is its file's name for messages.
///
/// - Each initial belief, goal and plan begins in the first column, a plan's label has a line of its own.
/// - A plan is one line, or its head, and its body from `<-` in a new line. A body is one line, or one line for
///   each formula. Contexts are broken before `&` and `|`.
/// - Where the author breaks one of these it stays broken, and a line of more than 120 characters is broken.
/// - Comments stay where they are; of several empty lines one is kept.
///
/// The meaning stays the same, and formatted text is not changed.
///
/// # Errors
/// [`TranslateError::Refused`] with all errors of a text that cannot be parsed.
pub fn format(name: &str, text: &str) -> Result<String, TranslateError> {
    formatted(text)
        .map_err(|found| TranslateError::Refused(gather([(found, Source { name, text })])))
}

/// The text of a system in canonical style; `name` is its file's name for messages.
///
/// - A section is one line, or each of its entries begins a line. An entry is broken behind the commas of a formula.
/// - Where the author breaks one of these it stays broken, and a line of more than 120 characters is broken.
/// - Comments stay where they are; of several empty lines one is kept, and none at the begin and the end of a section.
///
/// The meaning stays the same, and formatted text is not changed.
///
/// # Errors
/// [`TranslateError::Refused`] with all errors of a text that cannot be parsed.
pub fn format_system(name: &str, text: &str) -> Result<String, TranslateError> {
    parse_system(name, text).map(|_| sections::formatted(text))
}

/// As [`format()`].
fn formatted(text: &str) -> Result<String, Vec<Diagnostic>> {
    let (_, found) = parse(text);
    if !found.is_empty() {
        return Err(found);
    }
    let (mut tokens, _) = tokenize(text);
    let end = tokens.pop().map_or(text.len(), |end| end.span.start);
    let roles = roles::roles(&tokens);
    let mut gaps = Vec::with_capacity(tokens.len() + 1);
    let mut last = 0;
    for token in &tokens {
        gaps.push(Gap::new(&text[last..token.span.start]));
        last = token.span.end;
    }
    gaps.push(Gap::new(&text[last..end]));
    Ok(Layout { text, tokens: &tokens, roles: &roles, gaps: &gaps }.text())
}

#[cfg(test)]
mod tests;
