//! What was found wrong, one by one, for programs and for those who want to hear of some things only.

use diagnostic::{Diagnostic, Severity, Source, line_column};
use serde::Serialize;

/// All kinds of warnings, the most important first.
pub const CODES: [&str; 8] = [
    "unseen-failure",
    "no-plan",
    "never-tried",
    "never-believed",
    "never-triggered",
    "never-asked",
    "unused-variable",
    "unused-declaration",
];

/// The code of errors: no agent is translated in spite of them.
pub const REFUSED: &str = "refused";

/// More messages than this are counted, not shown: nobody reads them, and each costs a look at the whole text.
const MOST_SHOWN: usize = 50;

/// An error or a warning.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// `error` or `warning`.
    pub severity: &'static str,
    /// One of [`CODES`] for warnings, [`REFUSED`] for errors.
    pub code: &'static str,
    /// What is wrong, in one line without a full stop.
    pub message: String,
    /// The file that it is wrong in.
    pub file: String,
    /// Where it begins, from 1.
    pub line: usize,
    /// Where it begins, in characters from 1.
    pub column: usize,
    /// Where it ends.
    pub end_line: usize,
    /// The column behind its end.
    pub end_column: usize,
    /// What stands under the caret; may be empty.
    pub label: String,
    /// What to do about it.
    pub help: Option<String>,
    /// The whole with source line and caret.
    pub rendered: String,
}

impl Finding {
    /// A warning as the error that it is to those who deny it.
    #[must_use]
    pub fn denied(mut self) -> Self {
        self.severity = "error";
        if let Some(rest) = self.rendered.strip_prefix("warning") {
            self.rendered = format!("error{rest}");
        }
        self
    }
}

/// Everything that was found in some texts, rendered and one by one: errors before warnings, the most important of
/// these first, and otherwise in the order of the texts.
pub(crate) fn gather(sources: &[(&[Diagnostic], Source<'_>)]) -> (String, Vec<Finding>) {
    let rank = |diagnostic: &Diagnostic| {
        let rank = CODES.iter().position(|code| *code == diagnostic.code);
        (std::cmp::Reverse(diagnostic.severity), rank)
    };
    let mut all: Vec<(usize, &Diagnostic)> = sources
        .iter()
        .enumerate()
        .flat_map(|(source, (diagnostics, _))| diagnostics.iter().map(move |found| (source, found)))
        .collect();
    all.sort_by_key(|(source, found)| (rank(found), *source, found.span.start));
    let more = all.len().saturating_sub(MOST_SHOWN);
    all.truncate(MOST_SHOWN);
    let findings: Vec<Finding> =
        all.into_iter().map(|(source, found)| finding(found, &sources[source].1)).collect();
    let mut rendered: Vec<String> =
        findings.iter().map(|finding| finding.rendered.trim_end().to_owned()).collect();
    if more > 0 {
        rendered.push(format!("... and {more} more"));
    }
    (rendered.join("\n\n"), findings)
}

fn finding(found: &Diagnostic, source: &Source<'_>) -> Finding {
    let (line, column) = line_column(source.text, found.span.start);
    let (end_line, end_column) = line_column(source.text, found.span.end);
    Finding {
        severity: if found.severity == Severity::Error { "error" } else { "warning" },
        code: if found.code.is_empty() { REFUSED } else { found.code },
        message: found.message.clone(),
        file: source.name.to_owned(),
        line,
        column,
        end_line,
        end_column,
        label: found.label.clone(),
        help: found.help.clone(),
        rendered: found.render(source),
    }
}
