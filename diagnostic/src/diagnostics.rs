//! Diagnostics about several source texts.

use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use crate::{Diagnostic, MAX_RENDERED, Severity, Source, line_column, more};

/// A source text with its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SourceText {
    /// The file's name as the user gave it.
    pub name: String,
    /// The whole text.
    pub text: String,
}

impl From<Source<'_>> for SourceText {
    fn from(Source { name, text }: Source<'_>) -> Self {
        Self { name: name.to_owned(), text: text.to_owned() }
    }
}

/// A list of [`Diagnostic`]s with their source texts: data for programs, and rendered by `Display` for
/// people. It dereferences to the list.
///
/// The texts are shared, so that a list can be filtered without copying them.
#[derive(Clone, PartialEq, Eq, Default)]
#[must_use]
pub struct Diagnostics {
    sources: Arc<[SourceText]>,
    list: Vec<Diagnostic>,
}

impl Diagnostics {
    /// Diagnostics about `sources`; [`Diagnostic::source`] is the index into them.
    pub fn new(sources: impl IntoIterator<Item = SourceText>, list: Vec<Diagnostic>) -> Self {
        Self { sources: sources.into_iter().collect(), list }
    }

    /// Other diagnostics about the same texts.
    pub fn with(&self, list: Vec<Diagnostic>) -> Self {
        Self { sources: Arc::clone(&self.sources), list }
    }

    /// Whether one of them is an error.
    pub fn has_errors(&self) -> bool {
        self.list.iter().any(|diagnostic| diagnostic.severity == Severity::Error)
    }

    /// The diagnostics with their places, in the order of the list. A source that is not there has no name and no text.
    pub fn located(&self) -> impl ExactSizeIterator<Item = Located<'_>> {
        self.list.iter().map(|diagnostic| {
            let source = self.sources.get(diagnostic.source);
            let source = source.map_or(Source { name: "", text: "" }, |source| Source {
                name: &source.name,
                text: &source.text,
            });
            Located { diagnostic, source }
        })
    }

    /// The list without the texts.
    pub fn into_vec(self) -> Vec<Diagnostic> {
        self.list
    }
}

impl Deref for Diagnostics {
    type Target = [Diagnostic];

    fn deref(&self) -> &[Diagnostic] {
        &self.list
    }
}

/// Only the list, because the texts may be long.
impl fmt::Debug for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(&self.list).finish()
    }
}

/// All diagnostics [rendered](Diagnostic::render), separated by empty lines. Of very many, the first are
/// shown and the rest counted.
impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shown = self.located().take(MAX_RENDERED);
        let mut rendered: Vec<String> =
            shown.map(|located| located.render().trim_end().to_owned()).collect();
        rendered.extend(more(self.list.len()));
        f.write_str(&rendered.join("\n\n"))
    }
}

/// A diagnostic with its source text.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Located<'a> {
    /// The diagnostic.
    pub diagnostic: &'a Diagnostic,
    /// The text.
    pub source: Source<'a>,
}

impl Located<'_> {
    /// Line and column of its begin, both from 1; columns count characters.
    pub fn start(&self) -> (usize, usize) {
        line_column(self.source.text, self.diagnostic.span.start)
    }

    /// Line of its end, and the column behind it.
    pub fn end(&self) -> (usize, usize) {
        line_column(self.source.text, self.diagnostic.span.end)
    }

    /// As [`Diagnostic::render`].
    pub fn render(&self) -> String {
        self.diagnostic.render(&self.source)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_texts() -> Diagnostics {
        let text = |name: &str, text: &str| SourceText { name: name.into(), text: text.into() };
        let mut second = Diagnostic::error("wrong", 3..5);
        second.source = 1;
        let list = vec![Diagnostic::warning("odd", 0..1).lint("odd-thing"), second];
        Diagnostics::new([text("a.conf", "abc"), text("a.asl", "x\nyz\n")], list)
    }

    #[test]
    fn each_is_shown_in_its_text() {
        let found = two_texts();
        let text = found.to_string();
        assert!(text.starts_with("warning[odd-thing]: odd\n --> a.conf:1:1"), "{text}");
        assert!(text.contains("\n\nerror: wrong\n --> a.asl:2:2"), "{text}");
        let places: Vec<_> = found.located().map(|found| (found.start(), found.end())).collect();
        assert_eq!(places, [((1, 1), (1, 2)), ((2, 2), (3, 1))]);
        assert!(found.has_errors() && !found.with(vec![found[0].clone()]).has_errors());
    }

    #[test]
    fn a_message_about_no_text_is_shown_all_the_same() {
        let mut found = two_texts().into_vec();
        found[0].source = 9;
        assert!(two_texts().with(found).to_string().contains("odd"));
    }

    #[test]
    fn of_very_many_the_first_are_shown() {
        let list = vec![Diagnostic::error("wrong", 0..1); MAX_RENDERED + 2];
        let text = two_texts().with(list).to_string();
        assert_eq!(text.matches("error: wrong").count(), MAX_RENDERED);
        assert!(text.ends_with("\n\n... and 2 more"), "{text}");
    }
}
