//! Output to standard output and standard error. Much of it contains text from a drone or a file. It is made
//! [printable](printable_lines) here, so that such text cannot control the terminal.

use std::error::Error;
use std::fmt::{self, Display};
use std::io::{Write as _, stderr, stdout};
use std::sync::Once;

use diagnostic::{printable, printable_lines};
use serde_json::Value;

use crate::json;

/// Returns to the start of the line and clears it.
const CLEAR: &str = "\r\x1b[K";

/// Prints a result.
pub(super) fn print(result: impl Display) {
    print_own(printable_lines(&result.to_string()).as_bytes());
}

/// Prints the program's own text unchanged.
pub(super) fn print_own(result: &[u8]) {
    let mut stdout = stdout().lock();
    // If the pipe was closed nobody reads the rest; the flight goes on.
    _ = stdout.write_all(result).and_then(|()| stdout.flush());
}

/// Prints one JSON line; before the first one, the line that says of what kind they are. Whoever prints first waits for who
/// reads: nobody does before the flight has begun.
pub(super) fn print_object(object: &Value) {
    static HELLO: Once = Once::new();
    HELLO.call_once(|| print(format_args!("{}\n", json::text(&json::hello()))));
    print(format_args!("{}\n", json::text(object)));
}

/// Prints a message for people on standard error, line by line.
pub(super) fn print_message(message: impl Display) {
    write(&format!("{}\n", printable_lines(&message.to_string())));
}

/// Prints lines in place of the overwritten status line.
pub(super) fn replace_line(lines: &str) {
    write(&format!("{CLEAR}{}\n", printable_lines(lines)));
}

/// Shows a status line that will be overwritten.
pub(super) fn show(line: &str) {
    write(&format!("{CLEAR}{}", printable(line)));
}

/// Clears the status line.
pub(super) fn clear() {
    write(CLEAR);
}

fn write(text: &str) {
    let mut stderr = stderr().lock();
    // If standard error was closed nobody reads it; the flight goes on.
    _ = stderr.write_all(text.as_bytes()).and_then(|()| stderr.flush());
}

/// An error with all its causes, on one line.
pub(super) struct Causes<'a>(pub(super) &'a dyn Error);

impl Display for Causes<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)?;
        let mut cause = self.0.source();
        while let Some(error) = cause {
            write!(f, ": {error}")?;
            cause = error.source();
        }
        Ok(())
    }
}
