//! The way to standard output and standard error. What was heard of a drone, or read in a file, is somewhere in
//! much of what is said; here it is made [printable](printable_lines), so that no text can do anything to the
//! terminal but be read.

use std::error::Error;
use std::fmt::{self, Display};
use std::io::{Write as _, stderr, stdout};

use diagnostic::{printable, printable_lines};

/// Clears the line that is overwritten.
const CLEAR: &str = "\r\x1b[K";

/// Prints a result.
pub(super) fn print(result: impl Display) {
    print_own(printable_lines(&result.to_string()).as_bytes());
}

/// Prints what has nothing in it from elsewhere, as it is.
pub(super) fn print_own(result: &[u8]) {
    let mut stdout = stdout().lock();
    // Whoever closed the pipe does not want the rest: the flight goes on.
    _ = stdout.write_all(result).and_then(|()| stdout.flush());
}

/// Tells people something, in lines.
pub(super) fn tell(said: impl Display) {
    write(&format!("{}\n", printable_lines(&said.to_string())));
}

/// Tells people one line, in the place of one that is to be overwritten.
pub(super) fn tell_over(line: &str) {
    write(&format!("{CLEAR}{}\n", printable(line)));
}

/// Shows a line that is to be overwritten.
pub(super) fn show(line: &str) {
    write(&format!("{CLEAR}{}", printable(line)));
}

/// Takes such a line away.
pub(super) fn clear() {
    write(CLEAR);
}

fn write(text: &str) {
    let mut stderr = stderr().lock();
    // Nobody watches any more: the flight goes on.
    _ = stderr.write_all(text.as_bytes()).and_then(|()| stderr.flush());
}

/// An error with everything that led to it, on one line.
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
