//! Errors and warnings as lines of JSON.

use std::path::Path;

use serde_json::{Value, json};
use translator::{Code, Diagnostics, Located, Severity, TranslateError};

use super::CommandError;
use crate::JSON_VERSION;
use crate::agent::ReadError;
use crate::certify::CertifyError;
use crate::current::StaleError;
use crate::output::OutputError;

/// Maximum number of printed messages; each costs a scan of the text.
const MOST: usize = 50;

/// An error as lines of JSON.
pub(super) fn error_lines(error: &CommandError) -> String {
    let general = |code: &str, file: Option<&Path>| line("error", code, &error.to_string(), file);
    match error {
        CommandError::Translate(refused)
        | CommandError::Read(ReadError::Configuration(refused))
        | CommandError::Output(OutputError::Refused(refused)) => match refused {
            TranslateError::Refused(found) => lines(found),
            _ => general("unprovable", None),
        },
        CommandError::Denied(found) => {
            format!("{}\n{}", lines(found), line("error", "denied", &denied(found), None))
        }
        CommandError::Read(ReadError::File { path, .. }) => {
            general(Code::NotRead.name(), Some(path))
        }
        CommandError::Output(OutputError::Write(error)) | CommandError::Write(error) => {
            general("not-written", Some(error.path()))
        }
        CommandError::Print { .. } => general("not-printed", None),
        CommandError::Typed(_) => general(Code::NotRead.name(), None),
        CommandError::Usage(_) => general("usage", None),
        CommandError::New(_) => general("not-made", None),
        CommandError::Certify(CertifyError::Io { .. } | CertifyError::Occupied { .. }) => {
            general("not-written", None)
        }
        CommandError::Certify(CertifyError::Unlikely { path } | CertifyError::Input { path }) => {
            general("not-written", Some(path))
        }
        CommandError::Stale(StaleError::Differs { path, .. }) => general("stale", Some(path)),
        CommandError::Header(_)
        | CommandError::Stale(_)
        | CommandError::Verify(_)
        | CommandError::Prove(_)
        | CommandError::Tool(_)
        | CommandError::Certify(_)
        | CommandError::Target(_)
        | CommandError::Refused(_) => general("not-checked", None),
    }
}

/// Diagnostics as lines of JSON.
pub(super) fn lines(found: &Diagnostics) -> String {
    found.located().take(MOST).map(|found| located(&found)).collect::<Vec<_>>().join("\n")
}

fn located(found: &Located<'_>) -> String {
    let ((line, column), (end_line, end_column)) = (found.start(), found.end());
    let diagnostic = found.diagnostic;
    json!({
        "version": JSON_VERSION,
        "severity": if diagnostic.severity == Severity::Error { "error" } else { "warning" },
        "code": diagnostic.code,
        "message": diagnostic.message,
        "file": found.source.name,
        "line": line,
        "column": column,
        "end_line": end_line,
        "end_column": end_column,
        "label": diagnostic.label,
        "help": diagnostic.help,
        "rendered": found.render(),
    })
    .to_string()
}

/// A message without a location, as a line of JSON with the same keys.
pub(super) fn line(severity: &str, code: &str, message: &str, file: Option<&Path>) -> String {
    json!({
        "version": JSON_VERSION,
        "severity": severity,
        "code": code,
        "message": message,
        "file": file.map(|file| file.display().to_string()),
        "line": Value::Null,
        "column": Value::Null,
        "end_line": Value::Null,
        "end_column": Value::Null,
        "label": "",
        "help": Value::Null,
        "rendered": format!("{severity}: {message}"),
    })
    .to_string()
}

/// States how many warnings count as errors.
pub(super) fn denied(found: &Diagnostics) -> String {
    let denied = found.iter().filter(|found| found.severity == Severity::Error).count();
    format!("{denied} of these are denied as errors: nothing is translated")
}
