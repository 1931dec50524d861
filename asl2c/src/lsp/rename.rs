//! Renaming: in the agent and in all its configurations, and only if nothing is wrong afterwards that was not before.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use gen_lsp_types::{
    PrepareRenameParams, PrepareRenamePlaceholder, RenameParams, TextEdit, Uri, WorkspaceEdit,
};
use serde_json::Value;
use translator::names::{Found, Meaning};
use translator::syntax::Document;
use translator::{Diagnostic, Severity, findings, parse_configuration};

use super::answers::{Answer, Refusal, parameters, result};
use super::files::{File, Files};
use super::places::{Spot, in_file, places, related};
use super::server::{Server, name_at};

/// Words that are no names in an agent.
const KEYWORDS: [&str; 4] = ["true", "false", "not", "mod"];

pub(super) fn prepare(server: &mut Server, params: Value) -> Answer {
    let params: PrepareRenameParams = parameters(params)?;
    let (_, file, offset) = server.cursor(&params.text_document_position_params)?;
    let found = name_at(file, offset);
    result(found.map(|found| PrepareRenamePlaceholder {
        range: file.place(&found.span),
        placeholder: found.text.to_owned(),
    }))
}

pub(super) fn rename(server: &mut Server, params: Value) -> Answer {
    let RenameParams { new_name, text_document_position_params: at, .. } = parameters(params)?;
    let (path, ..) = server.cursor(&at)?;
    let texts = related(&mut server.files, &path);
    let (_, file, offset) = server.cursor(&at)?;
    let Some(found) = name_at(file, offset) else {
        return Err(Refusal::because("there is no name here"));
    };
    check_name(&new_name, found.meaning)?;
    let files = &server.files;
    check_free(files, &found, &new_name, &texts)?;
    let spots = places(files, &path, &found, &texts);
    check_result(files, &texts, &spots, &new_name)?;
    let mut changes: HashMap<Uri, Vec<TextEdit>> = HashMap::new();
    for Spot { path, span, .. } in spots {
        let Some(file) = files.get(&path) else { continue };
        let edit = TextEdit { range: file.place(&span), new_text: new_name.clone() };
        changes.entry(Uri(files.uri(&path))).or_default().push(edit);
    }
    result(WorkspaceEdit { changes: Some(changes), ..WorkspaceEdit::default() })
}

fn check_name(name: &str, meaning: Meaning) -> Result<(), Refusal> {
    let first = |c: char| match meaning {
        Meaning::Variable => c.is_ascii_uppercase(),
        Meaning::Declared | Meaning::Label => c.is_ascii_lowercase(),
        Meaning::Class | Meaning::Property => c.is_ascii_alphabetic() || c == '_',
    };
    let rest = |c: char| c.is_ascii_alphanumeric() || c == '_';
    if name.starts_with(first) && name.chars().all(rest) && !KEYWORDS.contains(&name) {
        return Ok(());
    }
    let begin = match meaning {
        Meaning::Variable => "an upper-case letter",
        Meaning::Declared | Meaning::Label => "a lower-case letter",
        Meaning::Class | Meaning::Property => "a letter",
    };
    Err(Refusal::because(format!(
        "`{name}` is not a name: write {begin}, then letters, digits and `_`"
    )))
}

/// Two names would become one.
fn check_free(
    files: &Files,
    found: &Found<'_>,
    name: &str,
    texts: &[PathBuf],
) -> Result<(), Refusal> {
    let mut taken = false;
    let mut look = |other: translator::names::Occurrence<'_>| {
        taken |= other.meaning == found.meaning && other.name.text == name;
    };
    match found.plan.filter(|_| found.meaning == Meaning::Variable) {
        Some(plan) => translator::names::in_plan(plan, &mut look),
        None => {
            for file in texts.iter().filter_map(|path| files.get(path)) {
                in_file(file, &mut look);
            }
        }
    }
    if taken { Err(Refusal::because(format!("there is a `{name}` already"))) } else { Ok(()) }
}

/// Refuses a name that C reserves, one that another meaning of it forbids, and the like: whatever the checks find.
fn check_result(
    files: &Files,
    texts: &[PathBuf],
    spots: &[Spot],
    name: &str,
) -> Result<(), Refusal> {
    let syntax = |file: &File| file.agent().is_some_and(|document| !document.errors().is_empty());
    if texts.iter().filter_map(|path| files.get(path)).any(syntax) {
        return Err(Refusal::because(
            "the agent has syntax errors: names in them would not be renamed",
        ));
    }
    let old = errors(files, texts, |file, _| file.text().to_owned());
    let new = errors(files, texts, |file, path| {
        let mut text = file.text().to_owned();
        let mut own: Vec<&Spot> = spots.iter().filter(|spot| spot.path == path).collect();
        own.sort_by_key(|spot| spot.span.start);
        for spot in own.into_iter().rev() {
            text.replace_range(spot.span.clone(), name);
        }
        text
    });
    match new.first() {
        Some(error) if new.len() > old.len() => {
            Err(Refusal::because(format!("after that: {error}")))
        }
        _ => Ok(()),
    }
}

/// All errors in some texts that belong together.
fn errors(
    files: &Files,
    texts: &[PathBuf],
    text: impl Fn(&File, &Path) -> String,
) -> Vec<Diagnostic> {
    let known = || texts.iter().filter_map(|path| Some((path, files.get(path)?)));
    let agents = known().filter(|(_, file)| file.agent().is_some());
    let agents: Vec<Document> =
        agents.map(|(path, file)| Document::new(text(file, path))).collect();
    let mut errors = Vec::new();
    for (path, file) in known().filter(|(_, file)| file.configuration().is_some()) {
        match parse_configuration("", &text(file, path)) {
            Ok(parsed) => {
                for agent in &agents {
                    let found = findings(&parsed, agent);
                    errors.extend(found.configuration.into_iter().chain(found.agent));
                }
            }
            Err(refused) => errors.extend(refused.diagnostics().iter().cloned()),
        }
    }
    errors.retain(|found| found.severity == Severity::Error);
    errors
}
