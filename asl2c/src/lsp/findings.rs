//! Diagnostics: those of the command line, for each text that an edit concerns.
//!
//! An agent is checked with each configuration that names it. Without one its syntax is checked, and a note says so. An open
//! system is checked when it or one of its agents changes.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use diagnostic::Span;
use gen_lsp_types::{
    Code, Diagnostic, DiagnosticSeverity, DiagnosticTag, Message, PublishDiagnosticsParams, Uri,
};
use translator::syntax::Document;
use translator::system::compose;
use translator::{Findings, ParsedConfiguration, Severity, findings, parse_configuration};

use super::files::{File, Files};
use crate::agent::ReadError;

/// Findings by file.
pub(super) type Found = BTreeMap<PathBuf, Vec<translator::Diagnostic>>;

/// A finding without a code of the translator.
const NO_CONFIGURATION: &str = "no-configuration";

/// All findings in some files, their agents and configurations.
pub(super) fn look(files: &mut Files, changed: &BTreeSet<PathBuf>) -> Found {
    let mut found = Found::new();
    let mut agents: BTreeSet<PathBuf> = BTreeSet::new();
    let (systems, members) = systems(files, changed);
    for path in changed.union(&members) {
        match files.get(path) {
            Some(file) if file.agent().is_some() => _ = agents.insert(path.clone()),
            Some(file) if file.configuration().is_some() => {
                let own = configuration_errors(files, path);
                let refused = !own.is_empty();
                found.entry(path.clone()).or_default().extend(own);
                match files.agent_of(path) {
                    Some((agent, Ok(()))) => _ = agents.insert(agent),
                    Some((_, Err(error))) if !refused => {
                        let error = not_read(files, path, &error);
                        found.entry(path.clone()).or_default().extend(error);
                    }
                    _ => {}
                }
            }
            _ => {}
        }
    }
    for agent in agents {
        look_at_agent(files, &agent, &mut found);
    }
    for system in systems {
        let errors = system_errors(files, &system);
        found.insert(system, errors);
    }
    found
}

/// The open systems that a change concerns, and the configurations of those that have changed themselves: whoever opens a
/// system is shown what is wrong with its agents.
fn systems(files: &mut Files, changed: &BTreeSet<PathBuf>) -> (Vec<PathBuf>, BTreeSet<PathBuf>) {
    let is_system = |path: &&Path| files.get(path).is_some_and(|file| file.system().is_some());
    let open: Vec<PathBuf> = files.opened().filter(is_system).map(Path::to_owned).collect();
    let (mut systems, mut members) = (Vec::new(), BTreeSet::new());
    for system in open {
        let own: BTreeSet<PathBuf> =
            files.members_of(&system).into_iter().map(|(path, _)| path).collect();
        let agents: Vec<PathBuf> =
            own.iter().filter_map(|path| Some(files.agent_of(path)?.0)).collect();
        if changed.contains(&system) {
            members.extend(own);
        } else if !own.iter().chain(&agents).any(|path| changed.contains(path)) {
            continue;
        }
        systems.push(system);
    }
    (systems, members)
}

/// The errors of a system, and at its entries that their files have some.
fn system_errors(files: &mut Files, path: &Path) -> Vec<translator::Diagnostic> {
    let text = files.get(path).and_then(File::system);
    if let Some(text) = text.filter(|text| !text.errors.is_empty()) {
        return text.errors.clone();
    }
    let members = files.members_of(path);
    let read: Vec<_> = members.into_iter().map(|(path, read)| member(files, &path, read)).collect();
    let Some(text) = files.get(path).and_then(File::system) else { return Vec::new() };
    let (mut found, mut agents) = (Vec::new(), Vec::new());
    for (entry, read) in text.tree.agents().iter().zip(read) {
        match read {
            Ok(agent) => agents.push(agent),
            Err(error) => found.push(at(error, entry.place.clone())),
        }
    }
    if found.is_empty()
        && let Err(refused) = compose(&text.tree, agents)
    {
        return refused.diagnostics().to_vec();
    }
    found
}

/// A configuration of a system, and the text of its agent.
///
/// # Errors
/// The first error in these files, without its place there.
fn member(
    files: &mut Files,
    path: &Path,
    read: Result<(), ReadError>,
) -> Result<(ParsedConfiguration, String), translator::Diagnostic> {
    read.map_err(|error| cannot_read(&error))?;
    let text = files.get(path).map(File::text).unwrap_or_default();
    let configuration = parse_configuration("", text)
        .map_err(|refused| has_errors(path, refused.diagnostics().first()))?;
    let Some((agent, read)) = files.agent_of(path) else {
        // The configuration of this name was read as something else.
        return Err(has_errors(path, None));
    };
    read.map_err(|error| cannot_read(&error))?;
    let file = files.get(&agent);
    let text = file.map(File::text).unwrap_or_default().to_owned();
    let found = match file.and_then(File::agent) {
        Some(document) => findings(&configuration, document),
        None => findings(&configuration, &Document::new(text.clone())),
    };
    let first = |found: &[translator::Diagnostic]| {
        found.iter().find(|found| found.severity == Severity::Error).cloned()
    };
    if let Some(error) = first(&found.configuration) {
        return Err(has_errors(path, Some(&error)));
    }
    match first(&found.agent) {
        Some(error) => Err(has_errors(&agent, Some(&error))),
        None => Ok((configuration, text)),
    }
}

/// Says that a file of a system has errors; the first has its place in that file.
fn has_errors(path: &Path, first: Option<&translator::Diagnostic>) -> translator::Diagnostic {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let (message, code) = first
        .map_or(("it is no configuration", translator::Code::NotRead.name()), |first| {
            (first.message.as_str(), first.code)
        });
    translator::Diagnostic::error(format!("`{name}` has errors: {message}"), 0..0).code(code)
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
fn not_read(files: &Files, path: &Path, error: &ReadError) -> Option<translator::Diagnostic> {
    let settings = &files.get(path)?.configuration()?.tree.settings;
    let place = settings.places.get("input").cloned().unwrap_or_default();
    Some(match error {
        ReadError::File { source, .. } => {
            translator::not_read(&settings.input, &source.to_string(), place)
        }
        error @ ReadError::Configuration(_) => at(cannot_read(error), place),
    })
}

fn cannot_read(error: &ReadError) -> translator::Diagnostic {
    translator::Diagnostic::error(error.to_string(), 0..0).code(translator::Code::NotRead.name())
}

fn at(mut found: translator::Diagnostic, place: Span) -> translator::Diagnostic {
    found.span = place;
    found
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
