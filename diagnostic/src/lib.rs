//! Diagnostics with places in a source text.
//!
//! Agents and flight plans are both texts that people write, with mistakes. They share one [`Diagnostic`]
//! type, so that errors in either look the same: the message, the file with line and column, the source line
//! with a caret under the exact span, and advice.
//!
//! ```
//! use diagnostic::{Diagnostic, Source};
//!
//! let source = Source { name: "flight.txt", text: "takeof\n" };
//! let error = Diagnostic::error("unknown command `takeof`", 0..6)
//!     .label("not a flight plan command")
//!     .help("did you mean `takeoff`?");
//! let text = error.render(&source);
//! assert!(text.contains("flight.txt:1:1"));
//! ```
#![forbid(unsafe_code)]

mod diagnostics;
mod figures;
mod printable;

use std::fmt;
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

pub use diagnostics::{Diagnostics, Located, SourceText};
pub use figures::{Figures, beyond};
pub use printable::{is_printable, printable, printable_lines};

/// A byte range of a source text.
pub type Span = Range<usize>;

/// A named text that spans refer to.
#[derive(Debug, Clone, Copy)]
pub struct Source<'a> {
    /// The file's name as the user gave it.
    pub name: &'a str,
    /// The whole text.
    pub text: &'a str,
}

/// Severity of a [`Diagnostic`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Legal, but probably a mistake.
    Warning,
    /// The source cannot be used.
    Error,
}

/// A message about a place in a source text.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Diagnostic {
    /// Error or warning.
    pub severity: Severity,
    /// The problem, in one line without a full stop.
    pub message: String,
    /// Index of its source text in a [`Diagnostics`]; 0 if there is only one.
    pub source: usize,
    /// Its place: bytes of the source text.
    pub span: Span,
    /// Text under the caret; may be empty.
    pub label: String,
    /// Advice.
    pub help: Option<String>,
    /// Stable identifier of this kind of diagnostic, for programs; may be empty.
    pub code: &'static str,
    /// Whether users can silence this kind by its code, which the rendered text then shows.
    is_lint: bool,
}

impl Diagnostic {
    /// An error at `span`.
    pub fn error(message: impl Into<String>, span: Span) -> Self {
        Self {
            severity: Severity::Error,
            message: message.into(),
            source: 0,
            span,
            label: String::new(),
            help: None,
            code: "",
            is_lint: false,
        }
    }

    /// A warning at `span`.
    pub fn warning(message: impl Into<String>, span: Span) -> Self {
        Self { severity: Severity::Warning, ..Self::error(message, span) }
    }

    /// Sets the text under the caret.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// Sets the advice below the source line.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Sets the stable identifier of this kind of diagnostic.
    #[must_use]
    pub fn code(mut self, code: &'static str) -> Self {
        self.code = code;
        self
    }

    /// Sets the identifier by which users silence it; it is shown behind `warning`.
    #[must_use]
    pub fn lint(mut self, code: &'static str) -> Self {
        self.code = code;
        self.is_lint = true;
        self
    }

    /// Renders the message with file, line, column, source line and caret, in the style of rustc, without
    /// colours. The result is [printable](printable_lines) whatever the text contains. A span outside the
    /// text is moved to the nearest place inside.
    pub fn render(&self, source: &Source<'_>) -> String {
        let level = match self.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        let mut annotation = AnnotationKind::Primary.span(clamp_span(&self.span, source.text));
        if !self.label.is_empty() {
            annotation = annotation.label(self.label.as_str());
        }
        let mut title = level.primary_title(self.message.as_str());
        if self.is_lint {
            title = title.id(self.code);
        }
        let mut group =
            title.element(Snippet::source(source.text).path(source.name).annotation(annotation));
        if let Some(help) = &self.help {
            group = group.element(Level::HELP.message(help.as_str()));
        }
        // Names and quoted text may contain any character; the renderer escapes only some of them.
        printable_lines(&Renderer::plain().render(&[group])).into_owned()
    }
}

/// Maximum number of rendered diagnostics; further ones are counted. Nobody reads more, and each costs a scan
/// of the text.
pub const MAX_RENDERED: usize = 50;

/// Renders `diagnostics` in the order of the text, separated by empty lines. Of very many, the first are
/// shown and the rest counted; errors come before warnings then.
pub fn render_all(diagnostics: &[Diagnostic], source: &Source<'_>) -> String {
    let mut shown: Vec<&Diagnostic> = diagnostics.iter().collect();
    shown.sort_by_key(|diagnostic| diagnostic.span.start);
    if shown.len() > MAX_RENDERED {
        shown.sort_by_key(|diagnostic| std::cmp::Reverse(diagnostic.severity));
        shown.truncate(MAX_RENDERED);
    }
    let mut rendered: Vec<String> =
        shown.iter().map(|diagnostic| diagnostic.render(source)).collect();
    rendered.extend(more(diagnostics.len()));
    rendered.join("\n\n")
}

/// Last line if only the first of `count` diagnostics are shown.
fn more(count: usize) -> Option<String> {
    let more = count.saturating_sub(MAX_RENDERED);
    (more > 0).then(|| format!("... and {more} more"))
}

/// Line and column of a byte of `text`, both from 1; columns count characters.
pub fn line_column(text: &str, offset: usize) -> (usize, usize) {
    let offset = floor_char_boundary(text, offset);
    let before = &text[..offset];
    let line = before.matches('\n').count() + 1;
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (line, before[line_start..].chars().count() + 1)
}

/// The candidate most similar to `name`, if any is similar enough to suggest a typing error; of several the first
/// in the alphabet, in whatever order they are given.
pub fn closest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let length = name.chars().count();
    let limit = (length / 3).max(1);
    candidates
        .into_iter()
        .map(|candidate| (edit_distance(name, candidate), candidate))
        .filter(|(distance, _)| *distance <= limit && *distance < length)
        .min()
        .map(|(_, candidate)| candidate)
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

fn clamp_span(span: &Span, text: &str) -> Span {
    let start = floor_char_boundary(text, span.start);
    let end = floor_char_boundary(text, span.end.max(start));
    start..end
}

fn floor_char_boundary(text: &str, offset: usize) -> usize {
    let mut offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    offset
}

/// Levenshtein distance, ignoring case.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().flat_map(char::to_lowercase).collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, a_char) in a.chars().flat_map(char::to_lowercase).enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, b_char) in b.iter().enumerate() {
            let substitution = diagonal + usize::from(a_char != *b_char);
            diagonal = row[j + 1];
            row[j + 1] = substitution.min(row[j] + 1).min(row[j + 1] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_and_column_count_from_one_and_in_characters() {
        assert_eq!(line_column("ab\ncd", 0), (1, 1));
        assert_eq!(line_column("ab\ncd", 4), (2, 2));
        assert_eq!(line_column("äb", 2), (1, 2));
        assert_eq!(line_column("ab", 99), (1, 3));
    }

    #[test]
    fn a_span_outside_the_text_or_inside_a_character_is_rendered_all_the_same() {
        let source = Source { name: "x", text: "ä" };
        for span in [0..1, 1..2, 5..9, 2..2] {
            assert!(Diagnostic::error("bad", span).render(&source).contains("bad"));
        }
    }

    #[test]
    fn the_closest_candidate_is_a_slip_of_the_pen_not_a_guess() {
        let commands = ["takeoff", "land", "goto"];
        assert_eq!(closest("takeof", commands), Some("takeoff"));
        assert_eq!(closest("GOTO", commands), Some("goto"));
        assert_eq!(closest("hover", commands), None);
        assert_eq!(closest("tip", ["top", "tap"]), closest("tip", ["tap", "top"]));
        // Every other letter is as similar.
        assert_eq!(closest("k", ["d", "h"]), None);
    }

    #[test]
    fn of_very_many_messages_the_first_errors_are_shown() {
        let source = Source { name: "x", text: "abc" };
        let mut many = vec![Diagnostic::warning("odd", 0..1); 100];
        many.push(Diagnostic::error("wrong", 2..3));
        let text = render_all(&many, &source);
        assert!(text.starts_with("error: wrong"), "{text}");
        assert!(text.ends_with("... and 51 more"), "{text}");
        assert_eq!(render_all(&many[..3], &source).matches("warning").count(), 3);
    }

    /// Neither the text nor its name nor the message may control the terminal.
    #[test]
    fn rendered_errors_hold_no_control_characters() {
        let text = "go\x1b[2J \u{9b}2J\u{202e} \u{200b}\n";
        let source = Source { name: "a\x1b]0;x\x07.txt", text };
        let error = Diagnostic::error("no \u{9d}0;x\u{9c}", 0..2).label("\x08").help("\u{85}");
        let rendered = error.render(&source);
        let odd = rendered.chars().find(|c| *c != '\n' && !is_printable(*c));
        assert_eq!(odd, None, "{rendered:?}");
    }

    #[test]
    fn rendered_errors_show_place_caret_and_advice() {
        let source = Source { name: "flight.txt", text: "takeoff\ngoto 1 2\n" };
        let text = Diagnostic::error("too few numbers", 8..16)
            .label("2 of 4")
            .help("write `goto x y z yaw`")
            .render(&source);
        assert_eq!(
            text,
            "error: too few numbers\n --> flight.txt:2:1\n  |\n2 | goto 1 2\n  | ^^^^^^^^ 2 of 4\n  |\n  = help: write `goto x y z yaw`"
        );
    }
}
