//! From `initialize` to `exit`.

use std::io::{Read, Write};

use crossbeam_channel::TryRecvError;
use lsp_server::{ErrorCode, Message, Request, Response};
use serde_json::{Value, json};

use super::server::Server;
use super::transport::{Incoming, read_messages, write_malformed, write_message};
use super::{requests, tokens};

/// Serves one client until it says `exit`, or closes its stream. Returns whether it shut the server down before.
///
/// # Errors
/// If the client does not read any more.
pub(crate) fn serve(
    input: impl Read + Send + 'static,
    output: &mut impl Write,
) -> std::io::Result<bool> {
    let incoming = read_messages(input);
    let mut phase = Phase::New;
    let mut server = Server::default();
    loop {
        // Without messages there is time for the diagnostics.
        let next = match incoming.try_recv() {
            Err(TryRecvError::Empty) if server.is_behind() => {
                server.publish();
                send(&mut server, output)?;
                continue;
            }
            Err(TryRecvError::Empty) => incoming.recv().ok(),
            Err(TryRecvError::Disconnected) => None,
            Ok(incoming) => Some(incoming),
        };
        match next {
            None => return Ok(phase == Phase::ShutDown),
            Some(Incoming::Malformed(reason)) => write_malformed(output, &reason)?,
            Some(Incoming::Message(Message::Notification(said))) if said.method == "exit" => {
                return Ok(phase == Phase::ShutDown);
            }
            Some(Incoming::Message(Message::Notification(said))) => {
                if phase == Phase::Running {
                    server.told(&said.method, said.params);
                }
            }
            Some(Incoming::Message(Message::Request(asked))) => {
                let response = answer(&mut phase, &mut server, asked);
                write_message(output, &response.into())?;
            }
            // Answers to the server's own requests.
            Some(Incoming::Message(Message::Response(_))) => {}
        }
        send(&mut server, output)?;
    }
}

fn send(server: &mut Server, output: &mut impl Write) -> std::io::Result<()> {
    server.outgoing().try_for_each(|message| write_message(output, &message))
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    New,
    Running,
    ShutDown,
}

fn answer(phase: &mut Phase, server: &mut Server, asked: Request) -> Response {
    let Request { id, method, params } = asked;
    let refuse = |code: ErrorCode, message: &str| {
        Response::new_err(id.clone(), code as i32, message.to_owned())
    };
    match (*phase, method.as_str()) {
        (Phase::New, "initialize") => {
            *phase = Phase::Running;
            server.initialize(&params);
            Response::new_ok(id, capabilities())
        }
        (Phase::New, _) => refuse(ErrorCode::ServerNotInitialized, "`initialize` comes first"),
        (Phase::ShutDown, _) => refuse(ErrorCode::InvalidRequest, "the server is shut down"),
        (Phase::Running, "initialize") => {
            refuse(ErrorCode::InvalidRequest, "the server is initialized already")
        }
        (Phase::Running, "shutdown") => {
            *phase = Phase::ShutDown;
            Response::new_ok(id, Value::Null)
        }
        (Phase::Running, method) => match requests::asked(server, method, params) {
            Ok(result) => Response::new_ok(id, result),
            Err(refusal) => Response::new_err(id, refusal.code as i32, refusal.message),
        },
    }
}

/// What the server can do.
fn capabilities() -> Value {
    const INCREMENTAL: u32 = 2;
    json!({
        "capabilities": {
            "positionEncoding": "utf-16",
            "textDocumentSync": { "openClose": true, "change": INCREMENTAL, "save": true },
            "hoverProvider": true,
            "definitionProvider": true,
            "declarationProvider": true,
            "referencesProvider": true,
            "renameProvider": { "prepareProvider": true },
            "completionProvider": { "triggerCharacters": ["!", "?", "+", "-", "@", "."] },
            "documentFormattingProvider": true,
            "documentSymbolProvider": true,
            "semanticTokensProvider": {
                "legend": tokens::legend(),
                "range": true,
                "full": { "delta": true },
            },
        },
        "serverInfo": { "name": "asl2c", "version": env!("CARGO_PKG_VERSION") },
    })
}
