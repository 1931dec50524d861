//! The server's state, and what changes it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use gen_lsp_types::{
    DidChangeTextDocumentParams, DidCloseTextDocumentParams, DidOpenTextDocumentParams,
    TextDocumentContentChangeEvent, TextDocumentItem, TextDocumentPositionParams,
};
use lsp_server::{Message, Notification, Request, RequestId};
use serde_json::{Value, json};
use translator::names::{Found, at_agent, at_configuration};

use super::answers::{Refusal, parameters};
use super::files::{File, Files, Kind, Open};
use super::token_lists::SentTokens;
use super::{findings, uri};

/// What the server knows of its client and of the texts.
#[derive(Debug, Default)]
pub(super) struct Server {
    pub(super) files: Files,
    /// Texts that have changed since they were analysed.
    changed: BTreeSet<PathBuf>,
    /// Texts with diagnostics in the editor.
    marked: BTreeSet<PathBuf>,
    /// Colours as they were last asked for.
    pub(super) tokens: SentTokens,
    outgoing: Vec<Message>,
}

impl Server {
    /// Asks for changes of files on disk, if the client can watch them.
    pub(super) fn initialize(&mut self, params: &Value) {
        const WATCHING: &str = "/capabilities/workspace/didChangeWatchedFiles/dynamicRegistration";
        if params.pointer(WATCHING) == Some(&Value::Bool(true)) {
            let watchers =
                ["**/*.asl", "**/*.conf", "**/*.system"].map(|glob| json!({ "globPattern": glob }));
            let registration = json!({ "registrations": [{
                "id": "files",
                "method": "workspace/didChangeWatchedFiles",
                "registerOptions": { "watchers": watchers },
            }] });
            let method = "client/registerCapability".to_owned();
            self.outgoing.push(
                Request::new(RequestId::from("files".to_owned()), method, registration).into(),
            );
        }
    }

    /// Messages for the client.
    pub(super) fn outgoing(&mut self) -> impl Iterator<Item = Message> {
        std::mem::take(&mut self.outgoing).into_iter()
    }

    /// Whether there is something to analyse.
    pub(super) fn is_behind(&self) -> bool {
        !self.changed.is_empty()
    }

    /// Analyses what has changed, and reports the findings.
    pub(super) fn publish(&mut self) {
        let changed = std::mem::take(&mut self.changed);
        let mut found = findings::look(&mut self.files, &changed);
        for path in changed {
            found.entry(path).or_default();
        }
        for (path, found) in found {
            let open = self.files.get(&path).is_some_and(|file| file.open.is_some());
            let was_marked = self.marked.remove(&path);
            if !found.is_empty() {
                self.marked.insert(path.clone());
            } else if !open && !was_marked {
                continue;
            }
            let params = findings::message(&self.files, &path, &found);
            let method = "textDocument/publishDiagnostics".to_owned();
            self.outgoing.push(Notification::new(method, params).into());
        }
    }

    /// Handles a notification. One that cannot be understood is ignored, as the protocol asks.
    pub(super) fn told(&mut self, method: &str, params: Value) {
        _ = match method {
            "textDocument/didOpen" => self.opened(params),
            "textDocument/didChange" => self.edited(params),
            "textDocument/didClose" => self.closed(params),
            "textDocument/didSave" | "workspace/didChangeWatchedFiles" => {
                self.look_again();
                Ok(())
            }
            _ => Ok(()),
        };
    }

    fn opened(&mut self, params: Value) -> Result<(), Refusal> {
        let DidOpenTextDocumentParams { text_document } = parameters(params)?;
        let TextDocumentItem { uri, version, text, language_id } = text_document;
        let path = path_of(&uri.0);
        // Its configuration may be new.
        self.files.forget();
        let kind = Kind::of(&path, &language_id.to_string());
        self.files.open(&path, kind, text, Open { uri: uri.0, version });
        if kind == Kind::Configuration {
            // It may name another agent than on disk.
            self.look_at_all();
        }
        self.changed.insert(path);
        Ok(())
    }

    fn edited(&mut self, params: Value) -> Result<(), Refusal> {
        let DidChangeTextDocumentParams { text_document, content_changes } = parameters(params)?;
        let path = path_of(&text_document.text_document_identifier.uri.0);
        for change in content_changes {
            let (place, text) = match change {
                TextDocumentContentChangeEvent::TextDocumentContentChangePartial(part) => {
                    (Some(part.range), part.text)
                }
                TextDocumentContentChangeEvent::TextDocumentContentChangeWholeDocument(whole) => {
                    (None, whole.text)
                }
            };
            self.files.edit(&path, text_document.version, place, &text);
        }
        if self.files.get(&path).and_then(File::configuration).is_some() {
            // It may name another agent than before.
            self.look_at_all();
        }
        self.changed.insert(path);
        Ok(())
    }

    fn closed(&mut self, params: Value) -> Result<(), Refusal> {
        let DidCloseTextDocumentParams { text_document } = parameters(params)?;
        let path = path_of(&text_document.uri.0);
        self.files.close(&path);
        self.tokens.forget(&path);
        self.changed.insert(path);
        self.look_again();
        Ok(())
    }

    /// Reads again what is on disk.
    fn look_again(&mut self) {
        self.files.forget();
        self.look_at_all();
    }

    /// Analyses everything that is open, or has diagnostics.
    fn look_at_all(&mut self) {
        self.changed.extend(self.files.opened().map(Path::to_owned));
        self.changed.extend(self.marked.iter().cloned());
    }

    /// The open text that a request is about.
    pub(super) fn file(&self, uri: &str) -> Result<(PathBuf, &File), Refusal> {
        let path = path_of(uri);
        match self.files.get(&path) {
            Some(file) if file.open.is_some() => Ok((path, file)),
            _ => Err(Refusal::because(format!("{uri} is not open"))),
        }
    }

    /// The text and the byte that a request is about.
    pub(super) fn cursor(
        &self,
        at: &TextDocumentPositionParams,
    ) -> Result<(PathBuf, &File, usize), Refusal> {
        let (path, file) = self.file(&at.text_document.uri.0)?;
        Ok((path, file, file.offset(at.position)))
    }
}

/// The name under a cursor.
pub(super) fn name_at(file: &File, offset: usize) -> Option<Found<'_>> {
    match (file.agent(), file.configuration()) {
        (Some(document), _) => at_agent(document, offset),
        (_, Some(configuration)) => at_configuration(&configuration.tree, offset),
        _ => None,
    }
}

/// The path of a text; a text that is no file yet is known by its URI.
fn path_of(uri: &str) -> PathBuf {
    uri::path_of(uri).unwrap_or_else(|| PathBuf::from(uri))
}
