//! Semantic colours: names by their meaning. Numbers, strings, comments and symbols need no analysis; the editor's grammar
//! colours them.

use std::collections::HashSet;
use std::path::PathBuf;

use diagnostic::Span;
use gen_lsp_types::{SemanticTokensDeltaParams, SemanticTokensParams, SemanticTokensRangeParams};
use serde_json::{Value, json};
use translator::configuration::Configuration;
use translator::names::{Meaning, Occurrence, Usage};
use translator::syntax::ast::TriggerKind;

use super::answers::{Answer, Refusal, parameters, result};
use super::places::{in_file, related};
use super::server::Server;
use super::token_lists::encoded;

/// Kinds of tokens: a belief is a property, a goal an event, an action or function a function.
const TYPES: [&str; 6] = ["property", "event", "function", "variable", "class", "decorator"];
const PROPERTY: u32 = 0;
const EVENT: u32 = 1;
const FUNCTION: u32 = 2;
const VARIABLE: u32 = 3;
const CLASS: u32 = 4;
const DECORATOR: u32 = 5;

/// Where a name is declared or a belief changed.
const MODIFIERS: [&str; 2] = ["declaration", "modification"];
const DECLARATION: u32 = 1;
const MODIFICATION: u32 = 2;

/// What the numbers of tokens mean.
pub(super) fn legend() -> Value {
    json!({ "tokenTypes": TYPES, "tokenModifiers": MODIFIERS })
}

pub(super) fn all(server: &mut Server, params: Value) -> Answer {
    let params: SemanticTokensParams = parameters(params)?;
    let (path, data) = tokens_in(server, &params.text_document.uri.0, None)?;
    let answer = json!(data);
    let id = server.tokens.remember(path, data);
    result(json!({ "resultId": id, "data": answer }))
}

/// Only what has changed since the last answer: a keystroke changes few of very many tokens.
pub(super) fn changed(server: &mut Server, params: Value) -> Answer {
    let params: SemanticTokensDeltaParams = parameters(params)?;
    let (path, data) = tokens_in(server, &params.text_document.uri.0, None)?;
    let edits = server.tokens.changes(&path, &params.previous_result_id, &data);
    let all = edits.is_none().then(|| json!(data));
    let id = server.tokens.remember(path, data);
    match edits {
        Some(edits) => result(json!({ "resultId": id, "edits": edits })),
        None => result(json!({ "resultId": id, "data": all })),
    }
}

/// Those of a part of the text.
pub(super) fn of_range(server: &mut Server, params: Value) -> Answer {
    let params: SemanticTokensRangeParams = parameters(params)?;
    let uri = &params.text_document.uri.0;
    let span = server.file(uri)?.1.span(params.range);
    let (_, data) = tokens_in(server, uri, Some(&span))?;
    result(json!({ "data": data }))
}

/// The tokens of a text, or of a part of it, as in the protocol.
fn tokens_in(
    server: &mut Server,
    uri: &str,
    within: Option<&Span>,
) -> Result<(PathBuf, Vec<u32>), Refusal> {
    let (path, _) = server.file(uri)?;
    let texts = related(&mut server.files, &path);
    let (_, file) = server.file(uri)?;
    let mut known = texts.iter().filter_map(|path| server.files.get(path)?.configuration());
    let basics = known.next().map(|text| basics(&text.tree)).unwrap_or_default();
    let mut tokens: Vec<(Span, u32, u32)> = Vec::new();
    in_file(file, &mut |occurrence| {
        let span = &occurrence.name.span;
        if within.is_none_or(|within| span.start < within.end && within.start < span.end) {
            let (kind, modifiers) = kind_of(occurrence, &basics);
            tokens.push((span.clone(), kind, modifiers));
        }
    });
    tokens.sort_by_key(|(span, ..)| span.start);
    // The setting `trace` also declares its function.
    tokens.dedup_by(|one, other| one.0 == other.0);
    Ok((path, encoded(file, &tokens)))
}

fn basics(configuration: &Configuration) -> HashSet<&str> {
    configuration.basics.iter().map(|basic| basic.name.text.as_str()).collect()
}

fn kind_of(occurrence: Occurrence<'_>, basics: &HashSet<&str>) -> (u32, u32) {
    let Occurrence { name, meaning, usage } = occurrence;
    let kind = match (meaning, usage) {
        (Meaning::Variable, _) => VARIABLE,
        (Meaning::Class, _) => CLASS,
        (Meaning::Label | Meaning::Property, _) => DECORATOR,
        (Meaning::Declared, _) if basics.contains(name.text.as_str()) => FUNCTION,
        (Meaning::Declared, Usage::Action) => FUNCTION,
        (Meaning::Declared, Usage::Goal | Usage::Trigger(_, TriggerKind::Achieve)) => EVENT,
        (Meaning::Declared, _) => PROPERTY,
    };
    let modifiers = match usage {
        Usage::Declaration => DECLARATION,
        Usage::Change(_) => MODIFICATION,
        _ => 0,
    };
    (kind, modifiers)
}
