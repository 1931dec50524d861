//! Scripts, and transcripts: scripts with their expected output.

use std::fmt::Write as _;

use diagnostic::{Diagnostic, Source};
use translator::Act;
use translator::configuration::Configuration;

use super::script::{acts, is_skipped};

/// An agent or a system that is run line by line.
pub trait Runs {
    /// Executes a line and returns its output. Actions are shown as calls; lines that begin with `//` are
    /// comments.
    ///
    /// # Errors
    /// The error in the line, with its span. Nothing of the line is executed then, or, if a step is too long,
    /// nothing from that step on.
    fn execute(&mut self, line: &str) -> Result<Vec<String>, Diagnostic>;
    /// Names of the properties that the last line violated.
    fn broken(&self) -> &[String];
    /// Whether `quit` was executed.
    fn is_ended(&self) -> bool;
    /// Possible beginnings of a line, for completion.
    fn words(&self) -> Vec<String>;
}

/// Result of a script.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Replay {
    /// Each line behind `> ` with its output, and errors where they occurred.
    pub shown: String,
    /// Number of errors, and of differences from the transcript.
    pub errors: usize,
    /// Violated properties that are not expected by a transcript.
    pub broken: Vec<String>,
}

impl Replay {
    /// Whether there were no errors, differences or violations.
    pub fn is_fine(&self) -> bool {
        self.errors == 0 && self.broken.is_empty()
    }
}

/// Runs a script of this name. If some of its lines begin with `>` it is a transcript: those lines are
/// executed, and the lines between them are the expected output. Comments, `// ..`, may be missing from a
/// transcript.
pub fn replay(session: &mut dyn Runs, name: &str, text: &str) -> Replay {
    let mut replay = Replay { shown: String::new(), errors: 0, broken: Vec::new() };
    let is_transcript = text.lines().any(|line| line.starts_with('>'));
    let source = Source { name, text };
    let mut lines = places(text).peekable();
    while let Some((start, line)) = lines.next() {
        let command = if is_transcript {
            let Some(command) = line.strip_prefix('>') else { continue };
            command
        } else {
            line
        };
        let mut expected: Vec<&str> = Vec::new();
        while is_transcript && lines.peek().is_some_and(|(_, line)| !line.starts_with('>')) {
            expected.extend(lines.next().map(|(_, line)| line.trim_end()));
        }
        if is_skipped(command) {
            // A comment stays, so that a script becomes a transcript by redirecting the output.
            if !command.trim().is_empty() {
                _ = writeln!(replay.shown, "> {}", command.trim());
            }
            continue;
        }
        let start = start + line.len() - command.len();
        replay.line(session, &source, (start, command), is_transcript.then_some(&expected));
        if session.is_ended() {
            break;
        }
    }
    replay
}

/// What the environment does in a transcript, or in a script.
///
/// # Errors
/// The errors in its lines, as text with their places.
pub(crate) fn test_acts(
    name: &str,
    text: &str,
    configuration: &Configuration,
) -> Result<Vec<Act>, String> {
    let is_transcript = text.lines().any(|line| line.starts_with('>'));
    let source = Source { name, text };
    let mut made = Vec::new();
    for (start, line) in places(text) {
        let command = if is_transcript { line.strip_prefix('>') } else { Some(line) };
        let Some(command) = command.filter(|command| !is_skipped(command)) else { continue };
        let start = start + line.len() - command.len();
        made.extend(acts(command, configuration).map_err(|mut error| {
            error.span = start + error.span.start..start + error.span.end;
            error.render(&source)
        })?);
    }
    Ok(made)
}

impl Replay {
    fn line(
        &mut self,
        session: &mut dyn Runs,
        source: &Source<'_>,
        (start, command): (usize, &str),
        expected: Option<&Vec<&str>>,
    ) {
        // Writing to a string cannot fail.
        _ = writeln!(self.shown, "> {}", command.trim());
        let shown = match session.execute(command) {
            Ok(shown) => shown,
            Err(error) => return self.error(error, start, source),
        };
        for line in &shown {
            _ = writeln!(self.shown, "{line}");
        }
        let Some(expected) = expected else {
            self.broken.extend_from_slice(session.broken());
            return;
        };
        let is_note = |line: &&str| line.starts_with("//");
        let blank = |line: &&str| !line.is_empty();
        let expected: Vec<&str> = expected.iter().copied().filter(blank).collect();
        let shown = shown.iter().map(String::as_str);
        let shown: Vec<&str> = if expected.iter().any(is_note) {
            shown.collect()
        } else {
            self.broken.extend_from_slice(session.broken());
            shown.filter(|line| !is_note(line)).collect()
        };
        if shown != expected {
            let same =
                shown.iter().zip(&expected).take_while(|(shown, expected)| shown == expected);
            let first = same.count();
            let at = |lines: &[&str]| match lines.get(first) {
                Some(line) => format!("`{line}`"),
                None => "the end".to_owned(),
            };
            let (line, found, wanted) = (first + 1, at(&shown), at(&expected));
            let message = format!("the output differs in line {line}: {found} instead of {wanted}");
            let error = Diagnostic::error(message, 0..command.len());
            let expected = expected.join("\n");
            self.error(error.help(format!("expected\n{expected}")), start, source);
        }
    }

    fn error(&mut self, mut error: Diagnostic, start: usize, source: &Source<'_>) {
        error.span = start + error.span.start..start + error.span.end;
        _ = writeln!(self.shown, "{}", error.render(source).trim_end());
        self.errors += 1;
    }
}

/// The lines, with the offset of each.
fn places(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut start = 0;
    text.split_inclusive('\n').map(move |line| {
        let place = start;
        start += line.len();
        (place, line.trim_end_matches(['\n', '\r']))
    })
}
