//! `asl2c fmt`: formats the texts of agents and of systems.

use std::io::Read as _;
use std::path::Path;
use std::process::ExitCode;

use translator::system::begins_system;
use translator::{format, format_system};

use super::arguments::{Fmt, is_json};
use super::{CommandError, complain, print};
use crate::agent::{self, ReadError, is_system};
use crate::written::rewrite;

/// Formats each file. The others are formatted if one fails.
pub(super) fn run(asked: &Fmt) -> Result<ExitCode, CommandError> {
    let mut fine = true;
    let mut listed: Vec<String> = Vec::new();
    for path in &asked.files {
        match one(path, asked.check) {
            Ok(true) => {}
            Ok(false) => {
                fine = false;
                listed.push(format!("{}\n", path.display()));
            }
            Err(error) => {
                fine = false;
                complain(&error, is_json(&asked.message_format));
            }
        }
    }
    print("the list of files", &listed.concat())?;
    Ok(if fine { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Formats a file, or only checks whether it is formatted. Returns `false` if it is not, and stays so.
fn one(path: &Path, check: bool) -> Result<bool, CommandError> {
    let piped = path == Path::new("-");
    let text = read(path, piped)?;
    let name = if piped { "input".to_owned() } else { path.display().to_string() };
    // What is piped has no name.
    let is_system = if piped { begins_system(&text) } else { is_system(path) };
    let formatted = if is_system { format_system(&name, &text) } else { format(&name, &text) }?;
    if check {
        return Ok(formatted == text);
    }
    if piped {
        print("the text", &formatted)?;
    } else if formatted != text {
        rewrite(path, &text, &formatted)?;
    }
    Ok(true)
}

fn read(path: &Path, piped: bool) -> Result<String, ReadError> {
    if !piped {
        return agent::read(path);
    }
    let mut bytes = Vec::new();
    let read = std::io::stdin().lock().read_to_end(&mut bytes);
    let read = read.and_then(|_| agent::text(bytes));
    read.map_err(|source| ReadError::File { path: path.to_owned(), source })
}
