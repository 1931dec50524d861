//! `asl2c run`: lines from a script, a pipe or a terminal.

use std::io::{BufRead as _, IsTerminal as _};
use std::process::ExitCode;

use diagnostic::{Diagnostic, Source};

use super::arguments::Run;
use super::prompt::Prompt;
use super::{CommandError, complain_of, print};
use crate::agent::{self, Agent};
use crate::run::{Session, is_skipped, replay};

/// Plans may be nested deeper than the usual stack allows.
const STACK_BYTES: usize = 256 << 20;

/// Runs the agent until its input ends.
pub(super) fn run(asked: &Run) -> Result<ExitCode, CommandError> {
    let work = || converse(asked);
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(STACK_BYTES).spawn_scoped(scope, work);
        let thread = thread.map_err(|error| CommandError::Typed(error.to_string()))?;
        thread.join().unwrap_or_else(|_| Err(CommandError::Typed("the thread ended".to_owned())))
    })
}

fn converse(asked: &Run) -> Result<ExitCode, CommandError> {
    let Agent { configuration, text, .. } = Agent::read(&asked.configuration)?;
    let mut session = Session::new(&configuration, &text)?;
    if let Some(path) = &asked.script {
        let script = agent::read(path)?;
        let replayed = replay(&mut session, &path.display().to_string(), &script);
        print("the output", &replayed.shown)?;
        return Ok(status(replayed.is_fine()));
    }
    if std::io::stdin().is_terminal() {
        talk(&mut session)?;
        return Ok(ExitCode::SUCCESS);
    }
    follow(&mut session)
}

fn status(is_fine: bool) -> ExitCode {
    if is_fine { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Executes piped input, each line as it arrives.
fn follow(session: &mut Session) -> Result<ExitCode, CommandError> {
    let mut fine = true;
    for (index, line) in std::io::stdin().lock().lines().enumerate() {
        let line = line.map_err(|error| CommandError::Typed(error.to_string()))?;
        if is_skipped(&line) {
            continue;
        }
        let text = format!("{}{line}", "\n".repeat(index));
        print("the output", &format!("> {}\n", line.trim()))?;
        fine &= show(session, &text, index)? && session.broken().is_empty();
        if session.is_ended() {
            break;
        }
    }
    Ok(status(fine))
}

/// Executes lines from a terminal. Their errors do not change the exit status.
fn talk(session: &mut Session) -> Result<(), CommandError> {
    let mut prompt =
        Prompt::new(session.words()).map_err(|error| CommandError::Typed(error.to_string()))?;
    while !session.is_ended() {
        let line = prompt.line().map_err(|error| CommandError::Typed(error.to_string()))?;
        let Some(line) = line else { break };
        if !is_skipped(&line) {
            show(session, &line, 0)?;
        }
    }
    Ok(())
}

/// Executes the last line of a text and prints its output. Returns whether it had no error.
fn show(session: &mut Session, text: &str, start: usize) -> Result<bool, CommandError> {
    match session.execute(&text[start..]) {
        Ok(lines) => {
            let mut shown = lines.join("\n");
            if !lines.is_empty() {
                shown.push('\n');
            }
            print("the output", &shown)?;
            Ok(true)
        }
        Err(mut error) => {
            error.span = start + error.span.start..start + error.span.end;
            complain_of(&rendered(&error, text));
            Ok(false)
        }
    }
}

fn rendered(error: &Diagnostic, text: &str) -> String {
    error.render(&Source { name: "input", text }).trim_end().to_owned()
}
