//! The program with its page, in a folder of its own.

use std::io::{ErrorKind, Read as _, Write as _};
use std::net::TcpStream;
use std::process::{Child, Stdio};
use std::time::Duration;

use crate::processes::{program, with_page};

/// A program, killed when dropped.
pub(crate) struct Station {
    pub(crate) child: Child,
    /// Address of the page as printed, with the token if there is one.
    pub(crate) url: String,
    /// Where it runs: its recording is `flights.mcap`.
    pub(crate) folder: tempfile::TempDir,
}

impl Station {
    /// Starts it with these arguments, among these files (name and text).
    pub(crate) fn start(arguments: &[&str], files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        let mut pilot = program("ardrone-pilot");
        pilot.current_dir(folder.path()).args(["--plain", "--log", "flights.mcap"]).args(arguments);
        let (child, url) = with_page(pilot.stdin(Stdio::null()).stdout(Stdio::null()));
        Self { child, url, folder }
    }

    /// A file of its folder.
    pub(crate) fn file(&self, name: &str) -> String {
        std::fs::read_to_string(self.folder.path().join(name)).unwrap()
    }
}

impl Drop for Station {
    fn drop(&mut self) {
        // The process may have ended already.
        _ = self.child.kill();
        _ = self.child.wait();
    }
}

/// A server's complete response to what is sent.
pub(crate) fn response(host: &str, request: &[u8]) -> String {
    let mut stream = TcpStream::connect(host).unwrap();
    stream.set_read_timeout(Some(Duration::from_mins(2))).unwrap();
    stream.write_all(request).unwrap();
    let mut response = Vec::new();
    // Whose request is refused half read may find the connection reset.
    if let Err(error) = stream.read_to_end(&mut response) {
        assert_eq!(error.kind(), ErrorKind::ConnectionReset, "{}", request.escape_ascii());
    }
    String::from_utf8_lossy(&response).into_owned()
}
