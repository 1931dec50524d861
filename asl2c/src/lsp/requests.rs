//! Which module answers which request.

use serde_json::Value;

use super::answers::{Answer, Refusal};
use super::server::Server;
use super::{completion, formatting, navigation, rename, symbols, tokens};

/// Answers a request.
pub(super) fn asked(server: &mut Server, method: &str, params: Value) -> Answer {
    match method {
        "textDocument/hover" => navigation::hover(server, params),
        "textDocument/definition" => navigation::definition(server, params),
        "textDocument/declaration" => navigation::declaration(server, params),
        "textDocument/references" => navigation::references(server, params),
        "textDocument/prepareRename" => rename::prepare(server, params),
        "textDocument/rename" => rename::rename(server, params),
        "textDocument/completion" => completion::complete(server, params),
        "textDocument/formatting" => formatting::format(server, params),
        "textDocument/documentSymbol" => symbols::symbols(server, params),
        "textDocument/semanticTokens/full" => tokens::all(server, params),
        "textDocument/semanticTokens/full/delta" => tokens::changed(server, params),
        "textDocument/semanticTokens/range" => tokens::of_range(server, params),
        _ => Err(Refusal::unknown(method)),
    }
}
