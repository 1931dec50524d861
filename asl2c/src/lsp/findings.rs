//! Diagnostics: those of the command line, for each text that an edit concerns.
//!
//! An agent is checked with each configuration that names it. Without one its syntax is checked, and a note says so.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use gen_lsp_types::{
    Code, Diagnostic, DiagnosticSeverity, DiagnosticTag, Message, PublishDiagnosticsParams, Uri,
};
use translator::{Findings, Severity, findings};

use super::files::{File, Files};

/// Findings by file.
pub(super) type Found = BTreeMap<PathBuf, Vec<translator::Diagnostic>>;

/// A finding without a code of the translator.
const NO_CONFIGURATION: &str = "no-configuration";
const NOT_READ: &str = "not-read";

/// All findings in some files, their agents and configurations.
pub(super) fn look(files: &mut Files, changed: &BTreeSet<PathBuf>) -> Found {
    let mut found = Found::new();
    let mut agents: BTreeSet<PathBuf> = BTreeSet::new();
    for path in changed {
        match files.get(path) {
            Some(file) if file.agent().is_some() => _ = agents.insert(path.clone()),
            Some(_) => {
                let own = configuration_errors(files, path);
                let refused = !own.is_empty();
                found.entry(path.clone()).or_default().extend(own);
                match files.agent_of(path) {
                    Some((agent, Ok(()))) => _ = agents.insert(agent),
                    Some((agent, Err(error))) if !refused => {
                        let error = not_read(files, path, &agent, &error);
                        found.entry(path.clone()).or_default().extend(error);
                    }
                    _ => {}
                }
            }
            None => {}
        }
    }
    for agent in agents {
        look_at_agent(files, &agent, &mut found);
    }
    found
}

/// The findings in an agent and its configurations.
fn look_at_agent(files: &mut Files, path: &Path, found: &mut Found) {
    let configurations = files.configurations_of(path);
    let Some(file) = files.get(path) else { return };
    let Some(document) = file.agent() else { return };
    let mut own: Vec<translator::Diagnostic> = Vec::new();
    // Nobody has asked for an agent that only was named before.
    if configurations.is_empty() && file.open.is_some() {
        own = document.errors();
        own.push(no_configuration(path));
    }
    for configuration in configurations {
        let text = files.get(&configuration).and_then(File::configuration);
        match text.map(|text| &text.parsed) {
            Some(Ok(parsed)) => {
                let Findings { configuration: others, agent, .. } = findings(parsed, document);
                found.insert(configuration, others);
                own.extend(agent);
            }
            // Without a configuration only the syntax can be checked.
            Some(Err(_)) => {
                found.insert(configuration.clone(), configuration_errors(files, &configuration));
                own.extend(document.errors());
            }
            None => {}
        }
    }
    // Several configurations may have the same to say.
    let mut seen: BTreeSet<(usize, usize, String)> = BTreeSet::new();
    own.retain(|d| seen.insert((d.span.start, d.span.end, d.message.clone())));
    found.insert(path.to_owned(), own);
}

/// The errors of a configuration that cannot be used.
fn configuration_errors(files: &Files, path: &Path) -> Vec<translator::Diagnostic> {
    let text = files.get(path).and_then(File::configuration);
    let error = text.and_then(|text| text.parsed.as_ref().err());
    error.map(|error| error.diagnostics().to_vec()).unwrap_or_default()
}

/// Says why only the syntax of an agent is checked.
fn no_configuration(agent: &Path) -> translator::Diagnostic {
    let name = agent.file_name().unwrap_or_default().to_string_lossy();
    let message = format!("only the syntax is checked: no configuration names `{name}`");
    translator::Diagnostic::warning(message, 0..0)
        .code(NO_CONFIGURATION)
        .help(format!("write `input = {name};` in the `settings` of a .conf file in this folder"))
}

/// Says that the agent of a configuration cannot be read.
fn not_read(
    files: &Files,
    path: &Path,
    agent: &Path,
    error: &std::io::Error,
) -> Option<translator::Diagnostic> {
    let settings = &files.get(path)?.configuration()?.tree.settings;
    let place = settings.places.get("input").cloned().unwrap_or_default();
    let message = format!("cannot read {}: {error}", agent.display());
    Some(translator::Diagnostic::error(message, place).code(NOT_READ))
}

/// The diagnostics of a text for the editor.
pub(super) fn message(
    files: &Files,
    path: &Path,
    found: &[translator::Diagnostic],
) -> PublishDiagnosticsParams {
    let file = files.get(path);
    let version = file.and_then(|file| file.open.as_ref()).map(|open| open.version);
    let diagnostics =
        file.into_iter().flat_map(|file| found.iter().map(|one| converted(file, one)));
    PublishDiagnosticsParams {
        uri: Uri(files.uri(path)),
        version,
        diagnostics: diagnostics.collect(),
    }
}

fn converted(file: &File, found: &translator::Diagnostic) -> Diagnostic {
    let severity = match (found.code, found.severity) {
        (NO_CONFIGURATION, _) => DiagnosticSeverity::Information,
        (_, Severity::Error) => DiagnosticSeverity::Error,
        (_, Severity::Warning) => DiagnosticSeverity::Warning,
    };
    let mut text = found.message.clone();
    if !found.label.is_empty() {
        text = format!("{text}\n{}", found.label);
    }
    if let Some(help) = &found.help {
        text = format!("{text}\nhelp: {help}");
    }
    Diagnostic {
        range: file.place(&found.span),
        severity: Some(severity),
        code: Some(Code::String(found.code.to_owned())),
        source: Some("asl2c".to_owned()),
        message: Message::String(text),
        tags: found.code.starts_with("unused-").then(|| vec![DiagnosticTag::Unnecessary]),
        ..Diagnostic::default()
    }
}
