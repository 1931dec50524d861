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
/// Maximum length of a message and of the lines before it.
const LONGEST_MESSAGE: u64 = 256 << 20;
const LONGEST_HEAD: u64 = 4096;

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
    let head = head(stream)?;
    match Message::read(&mut head.as_bytes().chain(stream)) {
        Ok(message) => message.map(Incoming::Message),
        Err(error) if error.kind() == ErrorKind::InvalidData => {
            Some(Incoming::Malformed(shortened(&error.to_string())))
        }
        Err(_) => None,
    }
}

/// The lines before a message, to the empty one; `None` at the end of the stream, or if there is no end of them, or if they
/// announce more than any message has: the memory for it is taken before it comes.
fn head(stream: &mut impl BufRead) -> Option<String> {
    let mut head = String::new();
    loop {
        let start = head.len();
        let length = stream.take(LONGEST_HEAD).read_line(&mut head).ok()?;
        if length == 0 || head.len() as u64 > LONGEST_HEAD {
            return None;
        }
        let line = head[start..].trim();
        if line.is_empty() {
            return Some(head);
        }
        let (name, value) = line.split_once(':').unwrap_or_default();
        let announced = value.trim().parse::<u64>();
        if name.eq_ignore_ascii_case("content-length")
            && announced.is_ok_and(|bytes| bytes > LONGEST_MESSAGE)
        {
            return None;
        }
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
