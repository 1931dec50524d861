//! Errors and warnings as text and as lines of JSON.

use std::path::Path;

use serde_json::json;
use translator::{Finding, REFUSED, TranslateError};

use super::CommandError;
use crate::agent::ReadError;
use crate::output::OutputError;

/// An error as lines of JSON.
pub(super) fn lines_of(error: &CommandError) -> String {
    let general = |code: &str, file: Option<&Path>| line("error", code, &error.to_string(), file);
    match error {
        CommandError::Translate(refused)
        | CommandError::Read(ReadError::Configuration(refused))
        | CommandError::Output(OutputError::Refused(refused)) => match refused {
            TranslateError::Configuration { findings, .. }
            | TranslateError::Agent { findings, .. } => lines(findings),
            TranslateError::Unprovable { .. } | TranslateError::Matrix { .. } => {
                general(REFUSED, None)
            }
        },
        CommandError::Denied(findings) => {
            format!("{}\n{}", lines(findings), line("error", "denied", &denied(findings), None))
        }
        CommandError::Read(ReadError::File { path, .. }) => general("not-read", Some(path)),
        CommandError::Output(OutputError::Write { path, .. }) => general("not-written", Some(path)),
        CommandError::Print { .. } => general("not-printed", None),
        CommandError::New(_) => general("not-made", None),
        CommandError::Verify(_) => general("not-checked", None),
    }
}

/// Findings as lines of JSON.
pub(super) fn lines(findings: &[Finding]) -> String {
    findings.iter().map(|finding| json!(finding).to_string()).collect::<Vec<_>>().join("\n")
}

/// What is said of no place in a text, as a line of JSON with the keys of a finding.
pub(super) fn line(severity: &str, code: &str, message: &str, file: Option<&Path>) -> String {
    let nothing = serde_json::Value::Null;
    json!({
        "severity": severity,
        "code": code,
        "message": message,
        "file": file.map(|file| file.display().to_string()),
        "line": nothing,
        "column": nothing,
        "end_line": nothing,
        "end_column": nothing,
        "label": "",
        "help": nothing,
        "rendered": format!("{severity}: {message}"),
    })
    .to_string()
}

/// Findings as people read them.
pub(super) fn rendered(findings: &[Finding]) -> String {
    findings.iter().map(|finding| finding.rendered.trim_end()).collect::<Vec<_>>().join("\n\n")
}

/// How many of the findings forbid translation.
pub(super) fn denied(findings: &[Finding]) -> String {
    let denied = findings.iter().filter(|finding| finding.severity == "error").count();
    format!("{denied} of these are denied: nothing is translated")
}
