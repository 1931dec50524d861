//! `asl2c run`: lines from a script, a pipe or a terminal.

use std::io::{BufRead as _, IsTerminal as _};
use std::process::ExitCode;

use diagnostic::{Diagnostic, Source};
use translator::system::Channels;

use super::arguments::Run;
use super::prompt::Prompt;
use super::{CommandError, complain_of, print};
use crate::agent::{self, Agent, is_system, read_system};
use crate::run::{NetworkConditions, Runs, Session, SystemSession, is_skipped, replay};

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
    if is_system(&asked.configuration) {
        let system = read_system(&asked.configuration)?;
        let conditions = conditions(asked, system.channels)?;
        return execute(asked, &mut SystemSession::new(&system, conditions)?);
    }
    if asked.loss.is_some() || asked.delay.is_some() || asked.seed.is_some() {
        let refused = "only the channels of a system have `--loss`, `--delay` and `--seed`";
        return Err(CommandError::Usage(refused.to_owned()));
    }
    let Agent { configuration, text, .. } = Agent::read(&asked.configuration)?;
    execute(asked, &mut Session::new(&configuration, &text)?)
}

/// What the channels do, which is within their bounds.
fn conditions(asked: &Run, channels: Channels) -> Result<NetworkConditions, CommandError> {
    let conditions = NetworkConditions {
        loss_percent: asked.loss.unwrap_or(0),
        delay_rounds: asked.delay.unwrap_or(0),
        seed: asked.seed.unwrap_or(1),
    };
    let refused = |what: String| Err(CommandError::Usage(what));
    if conditions.loss_percent > 0 && channels.losses == Some(0) {
        return refused("the channels of this system lose nothing: leave `--loss` out".to_owned());
    }
    if let Some(most) = channels.delay.filter(|most| conditions.delay_rounds > *most) {
        return refused(format!("in this system a message is at most {most} rounds late"));
    }
    Ok(conditions)
}

fn execute(asked: &Run, session: &mut dyn Runs) -> Result<ExitCode, CommandError> {
    if let Some(path) = &asked.script {
        let script = agent::read(path)?;
        let replayed = replay(session, &path.display().to_string(), &script);
        print("the output", &replayed.shown)?;
        return Ok(status(replayed.is_fine()));
    }
    if std::io::stdin().is_terminal() {
        talk(session)?;
        return Ok(ExitCode::SUCCESS);
    }
    follow(session)
}

fn status(is_fine: bool) -> ExitCode {
    if is_fine { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Executes piped input, each line as it arrives.
fn follow(session: &mut dyn Runs) -> Result<ExitCode, CommandError> {
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
fn talk(session: &mut dyn Runs) -> Result<(), CommandError> {
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
fn show(session: &mut dyn Runs, text: &str, start: usize) -> Result<bool, CommandError> {
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
