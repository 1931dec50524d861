//! A client of the language server: the other end of its pipes.

use std::io::{BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use lsp_server::{Message, Notification, Request, RequestId, Response};
use serde_json::{Value, json};

/// No answer takes this long, however busy the machine is.
const LIMIT: Duration = Duration::from_mins(2);

pub(crate) struct Client {
    server: Child,
    input: Option<ChildStdin>,
    messages: Receiver<Message>,
    /// Diagnostics that came in before they were asked for.
    published: Vec<Value>,
    requests: i32,
    pub(crate) folder: tempfile::TempDir,
}

impl Client {
    /// A server in an empty folder, before `initialize`.
    pub(crate) fn start() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mut server = Command::new(env!("CARGO_BIN_EXE_asl2c"))
            .args(["lsp", "--stdio"])
            .current_dir(folder.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let input = server.stdin.take();
        let mut output = BufReader::new(server.stdout.take().unwrap());
        let (sender, messages) = channel();
        std::thread::spawn(move || {
            while let Ok(Some(message)) = Message::read(&mut output) {
                if sender.send(message).is_err() {
                    break;
                }
            }
        });
        Self { server, input, messages, published: Vec::new(), requests: 0, folder }
    }

    /// A server with these files in its folder, after `initialize`.
    pub(crate) fn with_files(files: &[(&str, &str)]) -> Self {
        let mut client = Self::start();
        for (name, text) in files {
            std::fs::write(client.folder.path().join(name), text).unwrap();
        }
        client.initialize();
        client
    }

    pub(crate) fn initialize(&mut self) -> Value {
        let result = self.request("initialize", json!({ "capabilities": {} })).unwrap();
        self.notify("initialized", json!({}));
        result
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().canonicalize().unwrap().join(name)
    }

    pub(crate) fn uri(&self, name: &str) -> String {
        format!("file://{}", self.path(name).display())
    }

    pub(crate) fn write(&mut self, bytes: &[u8]) {
        let input = self.input.as_mut().unwrap();
        input.write_all(bytes).and_then(|()| input.flush()).unwrap();
    }

    pub(crate) fn send(&mut self, message: &Message) {
        message.write(self.input.as_mut().unwrap()).unwrap();
    }

    pub(crate) fn notify(&mut self, method: &str, params: Value) {
        self.send(&Notification::new(method.to_owned(), params).into());
    }

    /// The result of a request, or code and message of the refusal.
    pub(crate) fn request(&mut self, method: &str, params: Value) -> Result<Value, (i32, String)> {
        self.requests += 1;
        let id = RequestId::from(self.requests);
        self.send(&Request::new(id.clone(), method.to_owned(), params).into());
        loop {
            match self.receive() {
                Message::Response(Response { id: of, response_result }) if of == id => {
                    return response_result.map_err(|error| (error.code, error.message));
                }
                Message::Notification(Notification { params, .. }) => self.published.push(params),
                other => panic!("unexpected {other:?}"),
            }
        }
    }

    pub(crate) fn receive(&mut self) -> Message {
        self.messages.recv_timeout(LIMIT).unwrap()
    }

    /// The diagnostics of a file: those of this version, if it is open.
    pub(crate) fn diagnostics(&mut self, name: &str, version: Option<i32>) -> Vec<Value> {
        let uri = self.uri(name);
        let is_wanted = |one: &Value| one["uri"] == uri && one["version"] == json!(version);
        loop {
            if let Some(index) = self.published.iter().position(is_wanted) {
                return self.published.remove(index)["diagnostics"].as_array().unwrap().clone();
            }
            match self.receive() {
                Message::Notification(Notification { params, .. }) => self.published.push(params),
                other => panic!("unexpected {other:?}"),
            }
        }
    }

    /// The last diagnostics of a file that were sent so far, those of this version.
    pub(crate) fn last_diagnostics(&mut self, name: &str, version: i32) -> Vec<Value> {
        // Answers come in order: whatever was sent is here with the next one.
        _ = self.request("$/nothing", json!({}));
        let uri = self.uri(name);
        let published = std::mem::take(&mut self.published).into_iter();
        let mut of_file = published.filter(|one| one["uri"] == uri && one["version"] == version);
        of_file.next_back().unwrap()["diagnostics"].as_array().unwrap().clone()
    }

    pub(crate) fn open(&mut self, name: &str, text: &str) {
        let item = json!({ "uri": self.uri(name), "languageId": "x", "version": 1, "text": text });
        self.notify("textDocument/didOpen", json!({ "textDocument": item }));
    }

    /// Opens a file of the folder.
    pub(crate) fn open_file(&mut self, name: &str) -> String {
        let text = std::fs::read_to_string(self.path(name)).unwrap();
        self.open(name, &text);
        text
    }

    /// Replaces a whole text.
    pub(crate) fn replace(&mut self, name: &str, version: i32, text: &str) {
        self.change(name, version, &json!({ "text": text }));
    }

    pub(crate) fn change(&mut self, name: &str, version: i32, change: &Value) {
        let document = json!({ "uri": self.uri(name), "version": version });
        self.notify(
            "textDocument/didChange",
            json!({ "textDocument": document, "contentChanges": [change] }),
        );
    }

    /// A request about a place: the first occurrence of `text`, with the cursor at `|`.
    pub(crate) fn ask(&mut self, method: &str, name: &str, text: &str, marked: &str) -> Value {
        self.try_ask(method, name, text, marked, &json!({})).unwrap()
    }

    /// As [`Self::ask`], with further parameters.
    pub(crate) fn try_ask(
        &mut self,
        method: &str,
        name: &str,
        text: &str,
        marked: &str,
        further: &Value,
    ) -> Result<Value, (i32, String)> {
        let (line, character) = position(text, marked);
        let mut params = json!({
            "textDocument": { "uri": self.uri(name) },
            "position": { "line": line, "character": character },
        });
        params.as_object_mut().unwrap().extend(further.as_object().unwrap().clone());
        self.request(method, params)
    }

    /// Closes the pipes, or some of them, and waits. Returns the exit status.
    pub(crate) fn wait(mut self) -> i32 {
        drop(self.input.take());
        self.server.wait().unwrap().code().unwrap()
    }

    /// As [`Self::wait`], but the server still has its input.
    pub(crate) fn wait_open(mut self) -> i32 {
        let input = self.input.take();
        let status = self.server.wait().unwrap().code().unwrap();
        drop(input);
        status
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        // Only after a failed test is it still running.
        _ = self.server.kill();
        _ = self.server.wait();
    }
}

/// Line and column, in UTF-16, of a place in a text; `|` is the cursor.
pub(crate) fn position(text: &str, marked: &str) -> (usize, usize) {
    let (before, behind) = marked.split_once('|').unwrap();
    let start = text.find(&format!("{before}{behind}")).unwrap_or_else(|| panic!("{marked}"));
    let before = &text[..start + before.len()];
    let line = before.matches('\n').count();
    let column = before.rsplit('\n').next().unwrap().encode_utf16().count();
    (line, column)
}

/// A file's name and its content.
pub(crate) fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}
