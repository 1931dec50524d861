//! Input that no well-behaved client sends, and clients that vanish.

use std::io::Write as _;
use std::process::{Command, Stdio};

use lsp_server::Message;
use serde_json::{Value, json};

use super::client::Client;

const NOT_INITIALIZED: i32 = -32002;
const INVALID_REQUEST: i32 = -32600;
const UNKNOWN_METHOD: i32 = -32601;
const INVALID_PARAMETERS: i32 = -32602;

fn refused(result: Result<Value, (i32, String)>) -> i32 {
    result.unwrap_err().0
}

#[test]
fn requests_have_their_time() {
    let mut client = Client::start();
    assert_eq!(refused(client.request("textDocument/hover", json!({}))), NOT_INITIALIZED);
    // Ignored, because there is no answer to a notification.
    client.notify("textDocument/didOpen", json!({ "textDocument": 3 }));
    let abilities = client.initialize();
    assert_eq!(abilities["serverInfo"]["name"], "asl2c");
    assert_eq!(refused(client.request("initialize", json!({}))), INVALID_REQUEST);
    assert_eq!(client.request("shutdown", Value::Null), Ok(Value::Null));
    assert_eq!(refused(client.request("textDocument/hover", json!({}))), INVALID_REQUEST);
    client.notify("exit", Value::Null);
    assert_eq!(client.wait_open(), 0);
}

#[test]
fn what_makes_no_sense_is_refused_and_the_session_goes_on() {
    let mut client = Client::with_files(&[]);
    assert_eq!(refused(client.request("textDocument/fly", json!({}))), UNKNOWN_METHOD);
    assert_eq!(refused(client.request("$/fly", json!([1]))), UNKNOWN_METHOD);
    assert_eq!(refused(client.request("textDocument/hover", json!([]))), INVALID_PARAMETERS);
    let nowhere = json!({ "textDocument": { "uri": "file:///no.asl" }, "position": { "line": 0, "character": 0 } });
    let (_, said) = client.request("textDocument/hover", nowhere).unwrap_err();
    assert_eq!(said, "file:///no.asl is not open");
    for params in [json!(null), json!({}), json!({ "textDocument": { "uri": 1 } })] {
        client.notify("textDocument/didChange", params.clone());
        client.notify("textDocument/didClose", params.clone());
        client.notify("no/such", params);
    }
    client.change("not-open.asl", 2, &json!({ "text": "x" }));
    assert_eq!(client.request("shutdown", Value::Null), Ok(Value::Null));
}

/// Read as bytes: the client of these tests cannot read answers without a number.
#[test]
fn malformed_messages_are_answered() {
    const BODIES: [&str; 5] = ["{", "[]", "null", "{\"jsonrpc\":\"2.0\"}", "\"\\ud800\""];
    let mut server = Command::new(env!("CARGO_BIN_EXE_asl2c"))
        .arg("lsp")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = server.stdin.take().unwrap();
    for body in BODIES {
        write!(input, "Content-Length: {}\r\n\r\n{body}", body.len()).unwrap();
    }
    drop(input);
    let output = server.wait_with_output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(text.matches("\"code\":-32700").count(), BODIES.len(), "{text}");
    assert_eq!(output.status.code(), Some(1));
}

#[test]
fn positions_outside_of_the_text_are_moved_into_it() {
    let mut client = Client::with_files(&[]);
    client.open("a.asl", "+!go <- on.");
    client.diagnostics("a.asl", Some(1));
    let far = json!({ "line": 99, "character": u32::MAX });
    let uri = client.uri("a.asl");
    for method in [
        "textDocument/hover",
        "textDocument/definition",
        "textDocument/completion",
        "textDocument/prepareRename",
    ] {
        let params = json!({ "textDocument": { "uri": uri }, "position": far });
        assert!(client.request(method, params).is_ok(), "{method}");
    }
    let range =
        json!({ "start": { "line": 7, "character": 1 }, "end": { "line": 3, "character": 0 } });
    client.change("a.asl", 2, &json!({ "range": range, "text": "\n+!go." }));
    // Both plans are there: only the missing configuration is reported.
    assert_eq!(client.diagnostics("a.asl", Some(2)).len(), 1);
    let numbers =
        json!({ "start": { "line": -1, "character": 0 }, "end": { "line": 1, "character": 0 } });
    client.change("a.asl", 3, &json!({ "range": numbers, "text": "x" }));
    assert!(client.request("shutdown", Value::Null).is_ok());
}

#[test]
fn the_exit_status_says_whether_the_client_left_in_order() {
    // Without `shutdown`, with nothing at all, and in the middle of a message.
    let mut client = Client::with_files(&[]);
    client.notify("exit", Value::Null);
    assert_eq!(client.wait_open(), 1);
    assert_eq!(Client::start().wait(), 1);
    let mut client = Client::with_files(&[]);
    client.write(b"Content-Length: 1000\r\n\r\n{");
    assert_eq!(client.wait(), 1);
    let mut client = Client::with_files(&[]);
    client.write(b"no header at all\r\n\r\n");
    assert_eq!(client.wait(), 1);
    // More than there is memory for, and lines without an end.
    for begin in ["Content-Length: 99999999999999\r\n\r\n{}".to_owned(), "x".repeat(10_000)] {
        let mut client = Client::with_files(&[]);
        client.write(begin.as_bytes());
        assert_eq!(client.wait(), 1);
    }
}

/// A text that is not open, or is no file, has diagnostics as well.
#[test]
fn a_text_without_a_file_is_checked() {
    let mut client = Client::with_files(&[]);
    let item = json!({ "uri": "untitled:x.asl", "languageId": "agentspeak", "version": 1, "text": "+!go <- " });
    client.notify("textDocument/didOpen", json!({ "textDocument": item }));
    let Message::Notification(said) = client.receive() else { panic!() };
    assert_eq!(said.params["uri"], "untitled:x.asl");
    assert_eq!(said.params["diagnostics"][0]["code"], "syntax");
    assert_eq!(said.params["diagnostics"][1]["code"], "no-configuration");
}
