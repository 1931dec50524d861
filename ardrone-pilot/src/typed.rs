//! Orders typed by an operator.

use std::path::Path;

use ardrone_link::settings::Camera;
use autopilot::plan::{Commands, FlightLimits, Plan, PlanError};
use autopilot::vehicle::{Operator, OperatorOrder, Refused};

use crate::flight::Controls;

/// Words that are orders of their own; everything else is a command of the plan language.
const ORDERS: [&str; 15] = [
    "load", "append", "clear", "start", "hold", "resume", "land", "cut", "recover", "take",
    "release", "front", "bottom", "quit", "help",
];
/// Commands of the plan language, for completion.
const COMMANDS: [&str; 15] = [
    "takeoff",
    "goto",
    "moveBy",
    "moveByRel",
    "setReference",
    "setInitialReachDist",
    "setStayWithinDist",
    "setStayTime",
    "setMaxControl",
    "findTag",
    "landOnTag",
    "clearCommands",
    "autoInit",
    "autoTakeover",
    "lockScaleFP",
];

/// Summary of the orders.
pub(crate) const HELP: &str = "load FILE, start, hold, resume, clear, land, cut, recover (after an \
    emergency), take or release (the controls), front or bottom (camera), quit; anything else is appended to the mission: takeoff, \
    goto x y z yaw, moveBy, moveByRel, setReference, setStayTime, findTag, landOnTag, ...; `append land` appends a landing";

/// Why a typed line was not carried out.
#[derive(Debug, thiserror::Error)]
pub(crate) enum TypedError {
    #[error("cannot read the plan {path}")]
    Read { path: String, source: std::io::Error },
    #[error(transparent)]
    Plan(#[from] PlanError),
    #[error("`{0}` takes no argument")]
    Alone(String),
    #[error("write `load FILE`")]
    NoFile,
    #[error("`{0}` is for the terminal in which the program runs")]
    Here(String),
    #[error("{HELP}")]
    Help,
    #[error(transparent)]
    Refused(#[from] Refused),
}

/// A parsed line.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Typed {
    Order(OperatorOrder),
    Quit,
}

/// Carries out a typed line and waits for the vehicle's answer.
///
/// # Errors
/// [`TypedError`] if it was not carried out.
pub(crate) fn obey(
    line: &str,
    limits: &FlightLimits,
    controls: &Controls,
    by: Operator,
) -> Result<(), TypedError> {
    match parse(line, limits)? {
        Typed::Quit => {
            // If the tick loop has ended there is nothing left to do.
            controls.quit();
            Ok(())
        }
        Typed::Order(order) => Ok(controls.ask(by, order)?),
    }
}

/// Parses a line.
///
/// # Errors
/// [`TypedError`] if it is no order.
pub(crate) fn parse(line: &str, limits: &FlightLimits) -> Result<Typed, TypedError> {
    let (word, rest) = line.trim().split_once(char::is_whitespace).unwrap_or((line.trim(), ""));
    let rest = rest.trim();
    let order = match word {
        "load" if rest.is_empty() => return Err(TypedError::NoFile),
        "load" => OperatorOrder::Load(read(rest, limits)?),
        "append" => OperatorOrder::Append(Commands::parse("command", rest)?),
        _ if ORDERS.contains(&word) && !rest.is_empty() => {
            return Err(TypedError::Alone(word.to_owned()));
        }
        "clear" => OperatorOrder::Clear,
        "start" => OperatorOrder::Start { when_ready: false },
        "hold" => OperatorOrder::Hold,
        "resume" => OperatorOrder::Resume,
        "land" => OperatorOrder::Land,
        "cut" => OperatorOrder::Cut,
        "recover" => OperatorOrder::Recover,
        "front" => OperatorOrder::Camera(Camera::Front),
        "bottom" => OperatorOrder::Camera(Camera::Bottom),
        "take" => OperatorOrder::Take,
        "release" => OperatorOrder::Release,
        "quit" => return Ok(Typed::Quit),
        "help" => return Err(TypedError::Help),
        _ => OperatorOrder::Append(Commands::parse("command", line)?),
    };
    Ok(Typed::Order(order))
}

/// As [`parse`], of a line from elsewhere: nothing that reads files here or ends the program.
///
/// # Errors
/// [`TypedError`] if it is no order.
pub(crate) fn parse_remote(line: &str, limits: &FlightLimits) -> Result<OperatorOrder, TypedError> {
    match line.split_whitespace().next() {
        Some(word @ ("load" | "quit")) => Err(TypedError::Here(word.to_owned())),
        _ => match parse(line, limits)? {
            Typed::Order(order) => Ok(order),
            Typed::Quit => Err(TypedError::Here("quit".to_owned())),
        },
    }
}

/// The words that a line can begin with, other than those of [`TypedError::Here`].
pub(crate) fn remote_words() -> impl Iterator<Item = &'static str> {
    let here = |word: &&str| !matches!(*word, "load" | "quit" | "help");
    ORDERS.into_iter().filter(here).chain(COMMANDS)
}

fn read(path: &str, limits: &FlightLimits) -> Result<Plan, TypedError> {
    let bytes =
        std::fs::read(path).map_err(|source| TypedError::Read { path: path.to_owned(), source })?;
    Ok(Plan::parse_within(path, &String::from_utf8_lossy(&bytes), limits)?)
}

/// Completions of a line: orders, commands, and files after `load`.
pub(crate) fn completions(line: &str) -> Vec<String> {
    if let Some(path) = line.strip_prefix("load ") {
        return files(path).into_iter().map(|path| format!("load {path}")).collect();
    }
    let words = ORDERS.iter().chain(&COMMANDS).filter(|word| word.starts_with(line));
    words.map(ToString::to_string).collect()
}

fn files(start: &str) -> Vec<String> {
    let folder = start.rsplit_once('/').map_or("", |(folder, _)| folder);
    let searched = match folder {
        "" if start.starts_with('/') => Path::new("/"),
        "" => Path::new("."),
        folder => Path::new(folder),
    };
    // A folder that cannot be read has no completions.
    let Ok(entries) = std::fs::read_dir(searched) else { return Vec::new() };
    let named = entries.flatten().filter_map(|entry| {
        let name = entry.file_name().into_string().ok()?;
        let slash = if entry.path().is_dir() { "/" } else { "" };
        let before = if start.contains('/') { format!("{folder}/") } else { String::new() };
        Some(format!("{before}{name}{slash}"))
    });
    named.filter(|path| path.starts_with(start)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn typed(line: &str) -> Result<Typed, String> {
        parse(line, &FlightLimits::default()).map_err(|error| error.to_string())
    }

    #[test]
    fn words_are_orders_and_the_rest_is_appended() {
        assert_eq!(typed("land"), Ok(Typed::Order(OperatorOrder::Land)));
        assert_eq!(typed(" start "), Ok(Typed::Order(OperatorOrder::Start { when_ready: false })));
        assert_eq!(typed("quit"), Ok(Typed::Quit));
        for line in ["goto 0 1 0 0", "append land", "takeoff"] {
            assert!(matches!(typed(line), Ok(Typed::Order(OperatorOrder::Append(_)))), "{line}");
        }
        assert!(typed("gotoo 0 1 0 0").unwrap_err().contains("did you mean `goto`?"));
        assert!(typed("land now").unwrap_err().contains("takes no argument"));
        assert!(typed("load").unwrap_err().contains("load FILE"));
        assert!(typed("load no/such/file").unwrap_err().contains("no/such/file"));
    }

    #[test]
    fn lines_from_elsewhere_read_no_file_and_do_not_end_the_program() {
        let typed = |line| parse_remote(line, &FlightLimits::default());
        assert!(matches!(typed("hold"), Ok(OperatorOrder::Hold)));
        for line in ["load /etc/passwd", " quit", "load"] {
            assert!(matches!(typed(line), Err(TypedError::Here(_))), "{line}");
        }
        assert!(
            remote_words().all(|word| word != "load") && remote_words().any(|word| word == "goto")
        );
    }

    #[test]
    fn orders_commands_and_files_are_completed() {
        assert_eq!(completions("res"), ["resume"]);
        assert_eq!(completions("moveByR"), ["moveByRel"]);
        let files = completions("load src/cli/term");
        assert_eq!(files, ["load src/cli/terminal.rs"]);
        assert!(completions("load src/cl").contains(&"load src/cli/".to_owned()));
        assert!(completions("load /no/such/folder/").is_empty());
    }

    #[test]
    fn all_commands_can_be_completed() {
        for command in COMMANDS {
            let error = Commands::parse("command", command).err().map(|error| error.to_string());
            assert!(!error.is_some_and(|error| error.contains("unknown command")), "{command}");
        }
    }
}
