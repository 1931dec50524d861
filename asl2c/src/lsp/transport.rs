//! Messages of the protocol from a stream and to a stream.

use std::io::{BufRead, BufReader, ErrorKind, Read, Write};

use crossbeam_channel::{Receiver, bounded};
use lsp_server::{ErrorCode, Message};
use serde_json::json;

/// What was read.
#[derive(Debug)]
pub(super) enum Incoming {
    /// A message.
    Message(Message),
    /// A message that is not one of the protocol, and why.
    Malformed(String),
}

/// Messages that wait to be handled. An editor that writes more than this waits for the server.
const QUEUE: usize = 1024;

/// Reads messages in a thread. The channel is closed at the end of the stream.
///
/// The transport of `lsp_server` ends with the first malformed message; here it is answered like any other.
pub(super) fn read_messages(stream: impl Read + Send + 'static) -> Receiver<Incoming> {
    let (sender, receiver) = bounded(QUEUE);
    std::thread::spawn(move || {
        let mut stream = BufReader::new(stream);
        while let Some(incoming) = next(&mut stream) {
            if sender.send(incoming).is_err() {
                break;
            }
        }
    });
    receiver
}

/// The next message; `None` at the end of the stream, or if it cannot be read.
fn next(stream: &mut impl BufRead) -> Option<Incoming> {
    match Message::read(stream) {
        Ok(message) => message.map(Incoming::Message),
        Err(error) if error.kind() == ErrorKind::InvalidData => {
            Some(Incoming::Malformed(shortened(&error.to_string())))
        }
        Err(_) => None,
    }
}

/// The begin of a text: a malformed message may be of any length.
fn shortened(text: &str) -> String {
    const MOST: usize = 200;
    text.chars().take(MOST).collect()
}

/// Writes a message.
pub(super) fn write_message(stream: &mut impl Write, message: &Message) -> std::io::Result<()> {
    message.write(stream)
}

/// Answers a message that could not be read: its number is unknown.
pub(super) fn write_malformed(stream: &mut impl Write, reason: &str) -> std::io::Result<()> {
    let error = json!({ "code": ErrorCode::ParseError as i32, "message": reason });
    let text = json!({ "jsonrpc": "2.0", "id": null, "error": error }).to_string();
    write!(stream, "Content-Length: {}\r\n\r\n{text}", text.len())?;
    stream.flush()
}
