//! Hover, definition, declaration and references.

use gen_lsp_types::{
    Contents, DefinitionParams, Hover, HoverParams, Location, MarkupContent, MarkupKind,
    ReferenceParams, TextDocumentPositionParams, Uri,
};
use serde_json::Value;
use translator::names::{Meaning, Usage, describe};
use translator::syntax::ast::{Operator, TriggerKind};
use translator::system::Agent;

use super::answers::{Answer, parameters, result};
use super::files::{File, Files, member_path};
use super::places::{Spot, places, related};
use super::server::{Server, name_at};

pub(super) fn hover(server: &mut Server, params: Value) -> Answer {
    let params: HoverParams = parameters(params)?;
    let at = params.text_document_position_params;
    let (path, ..) = server.cursor(&at)?;
    let texts = related(&mut server.files, &path);
    let (_, file, offset) = server.cursor(&at)?;
    let files: Vec<&File> = texts.iter().filter_map(|path| server.files.get(path)).collect();
    let configuration = file.configuration();
    let configuration =
        configuration.or_else(|| files.iter().find_map(|file| file.configuration()));
    let agent = file.agent().or_else(|| files.iter().find_map(|file| file.agent()));
    let hover = name_at(file, offset).and_then(|found| {
        let agent = agent.map(translator::syntax::Document::agent);
        let value = describe(&found, configuration.map(|text| &text.tree), agent)?;
        let kind = MarkupKind::Markdown;
        Some(Hover {
            contents: Contents::MarkupContent(MarkupContent { kind, value }),
            range: Some(file.place(&found.span)),
        })
    });
    result(hover)
}

/// Where a name gets its meaning: the plans of a goal or test goal in a body, otherwise the declaration; of an agent of a
/// system its configuration.
pub(super) fn definition(server: &mut Server, params: Value) -> Answer {
    let params: DefinitionParams = parameters(params)?;
    let at = params.text_document_position_params;
    let (path, file, offset) = server.cursor(&at)?;
    if let Some(system) = file.system() {
        let is_here = |agent: &&Agent| (agent.peer.span.start..=agent.place.end).contains(&offset);
        let agent = system.tree.agents().iter().find(is_here);
        return result(agent.map(|agent| Location {
            uri: Uri(server.files.uri(&member_path(&path, agent))),
            range: file.place(&(0..0)),
        }));
    }
    let (usage, spots) = spots(server, &at)?;
    let wanted = match usage {
        Some(Usage::Goal) => Some(Usage::Trigger(Operator::Add, TriggerKind::Achieve)),
        Some(Usage::Question) => Some(Usage::Trigger(Operator::Add, TriggerKind::Test)),
        _ => None,
    };
    let plans: Vec<Spot> =
        spots.iter().filter(|spot| Some(spot.usage) == wanted).cloned().collect();
    let chosen = if plans.is_empty() { declared(spots) } else { plans };
    result(locations(&server.files, chosen))
}

/// The declaration in the configuration, or a variable's first place.
pub(super) fn declaration(server: &mut Server, params: Value) -> Answer {
    let params: DefinitionParams = parameters(params)?;
    let (_, spots) = spots(server, &params.text_document_position_params)?;
    result(locations(&server.files, declared(spots)))
}

pub(super) fn references(server: &mut Server, params: Value) -> Answer {
    let params: ReferenceParams = parameters(params)?;
    let (_, mut spots) = spots(server, &params.text_document_position_params)?;
    if !params.context.include_declaration {
        spots.retain(|spot| spot.usage != Usage::Declaration);
    }
    result(locations(&server.files, spots))
}

/// How the name under the cursor is used, and all its places.
fn spots(
    server: &mut Server,
    at: &TextDocumentPositionParams,
) -> Result<(Option<Usage>, Vec<Spot>), super::answers::Refusal> {
    let (path, ..) = server.cursor(at)?;
    let texts = related(&mut server.files, &path);
    let (_, file, offset) = server.cursor(at)?;
    let Some(found) = name_at(file, offset) else { return Ok((None, Vec::new())) };
    let mut spots = places(&server.files, &path, &found, &texts);
    if found.meaning == Meaning::Variable
        && let Some(first) = spots.first_mut()
    {
        first.usage = Usage::Declaration;
    }
    Ok((found.usage, spots))
}

fn declared(mut spots: Vec<Spot>) -> Vec<Spot> {
    spots.retain(|spot| spot.usage == Usage::Declaration);
    spots
}

fn locations(files: &Files, spots: Vec<Spot>) -> Vec<Location> {
    let places = spots.into_iter().filter_map(|Spot { path, span, .. }| {
        let range = files.get(&path)?.place(&span);
        Some(Location { uri: Uri(files.uri(&path)), range })
    });
    places.collect()
}
