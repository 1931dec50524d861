//! Orders typed by an operator.

use std::path::Path;

use ardrone_link::settings::Camera;
use autopilot::plan::{Commands, FlightLimits, LANGUAGE, Plan, PlanError};
use autopilot::vehicle::{Operator, OperatorOrder, Refused};

use crate::flight::Controls;
use crate::text_file;

/// A word that is an order of its own; every other line is commands of the plan language.
struct Word {
    name: &'static str,
    /// What to say of it besides its name.
    note: &'static str,
    means: Means,
}

/// What a word means.
enum Means {
    /// This order, without an argument.
    Order(OperatorOrder),
    /// To load the file behind it.
    Load,
    /// To append the commands behind it.
    Append,
    /// To end the program.
    Quit,
    /// To be told of the others.
    Help,
}

const fn word(name: &'static str, note: &'static str, means: Means) -> Word {
    Word { name, note, means }
}

static WORDS: [Word; 15] = [
    word("load", " FILE", Means::Load),
    word("start", "", Means::Order(OperatorOrder::Start { when_ready: false })),
    word("hold", "", Means::Order(OperatorOrder::Hold)),
    word("resume", "", Means::Order(OperatorOrder::Resume)),
    word("clear", "", Means::Order(OperatorOrder::Clear)),
    word("land", "", Means::Order(OperatorOrder::Land)),
    word("cut", " (the motors)", Means::Order(OperatorOrder::Cut)),
    word("recover", " (after an emergency)", Means::Order(OperatorOrder::Recover)),
    word("take", " (the controls)", Means::Order(OperatorOrder::Take)),
    word("release", " (them)", Means::Order(OperatorOrder::Release)),
    word("front", " (camera)", Means::Order(OperatorOrder::Camera { camera: Camera::Front })),
    word("bottom", " (camera)", Means::Order(OperatorOrder::Camera { camera: Camera::Bottom })),
    word("append", " COMMANDS", Means::Append),
    word("quit", "", Means::Quit),
    word("help", "", Means::Help),
];

/// Whether a line that begins with this word is an order, or a command of the plan language.
pub(crate) fn is_order(first: &str) -> bool {
    words().any(|word| word == first)
}

/// Where a line was typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Typist {
    /// In the terminal in which the program runs.
    Here,
    /// Anywhere else.
    Elsewhere,
}

/// Summary of the orders and commands.
fn help(typist: Typist) -> String {
    let words = WORDS.iter().filter(|word| typist == Typist::Here || !is_here(&word.means));
    let words = words.map(|Word { name, note, .. }| format!("{name}{note}"));
    let commands = LANGUAGE.iter().map(|declared| declared.name);
    format!(
        "orders:\n  {}\ncommands, which are appended to the mission:\n  {}",
        words.collect::<Vec<_>>().join(", "),
        commands.collect::<Vec<_>>().join(", ")
    )
}

/// Words that are for the terminal in which the program runs.
fn is_here(means: &Means) -> bool {
    matches!(means, Means::Load | Means::Quit)
}

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
    #[error("{}", help(*.0))]
    Help(Typist),
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
    // `hold` is an order, and `hold 5` a command.
    let known = WORDS.iter().find(|known| known.name == word);
    let order = match known.map(|known| &known.means) {
        Some(Means::Load) if rest.is_empty() => return Err(TypedError::NoFile),
        Some(Means::Load) => OperatorOrder::Load(read(rest, limits)?),
        Some(Means::Append) => OperatorOrder::Append(Commands::parse("command", rest)?),
        Some(Means::Order(order)) if rest.is_empty() => order.clone(),
        Some(Means::Quit) if rest.is_empty() => return Ok(Typed::Quit),
        Some(Means::Help) if rest.is_empty() => return Err(TypedError::Help(Typist::Here)),
        Some(_) if !takes_numbers(word) => return Err(TypedError::Alone(word.to_owned())),
        _ => OperatorOrder::Append(Commands::parse("command", line)?),
    };
    Ok(Typed::Order(order))
}

fn takes_numbers(word: &str) -> bool {
    LANGUAGE.iter().any(|declared| declared.name == word && !declared.numbers.is_empty())
}

/// As [`parse`], of a line from elsewhere: nothing that reads files here or ends the program.
///
/// # Errors
/// [`TypedError`] if it is no order.
pub(crate) fn parse_remote(line: &str, limits: &FlightLimits) -> Result<OperatorOrder, TypedError> {
    let word = line.split_whitespace().next().unwrap_or_default();
    if WORDS.iter().any(|known| known.name == word && is_here(&known.means)) {
        return Err(TypedError::Here(word.to_owned()));
    }
    match parse(line, limits) {
        Ok(Typed::Order(order)) => Ok(order),
        Ok(Typed::Quit) => Err(TypedError::Here(word.to_owned())),
        Err(TypedError::Help(_)) => Err(TypedError::Help(Typist::Elsewhere)),
        Err(error) => Err(error),
    }
}

/// The words that a line can begin with, other than those of [`TypedError::Here`].
pub(crate) fn remote_words() -> impl Iterator<Item = &'static str> {
    let orders = WORDS.iter().filter(|word| !is_here(&word.means)).map(|word| word.name);
    orders.chain(commands())
}

/// All words that a line can begin with.
fn words() -> impl Iterator<Item = &'static str> {
    WORDS.iter().map(|word| word.name).chain(commands())
}

/// Commands of the plan language that are not also orders.
fn commands() -> impl Iterator<Item = &'static str> {
    let is_order = |name: &str| WORDS.iter().any(|word| word.name == name);
    LANGUAGE.iter().map(|declared| declared.name).filter(move |name| !is_order(name))
}

fn read(path: &str, limits: &FlightLimits) -> Result<Plan, TypedError> {
    let text = text_file::read(Path::new(path));
    let text = text.map_err(|source| TypedError::Read { path: path.to_owned(), source })?;
    Ok(Plan::parse_within(path, &text, limits)?)
}

/// Completions of a line: orders, commands, and files after `load`.
pub(crate) fn completions(line: &str) -> Vec<String> {
    if let Some(path) = line.strip_prefix("load ") {
        return files(path).into_iter().map(|path| format!("load {path}")).collect();
    }
    words().filter(|word| word.starts_with(line)).map(str::to_owned).collect()
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
        let help = typed("help").unwrap_err().to_string();
        assert!(help.contains("resume") && !help.contains("load") && !help.contains("quit"));
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
    fn a_word_may_be_an_order_and_a_command() {
        assert_eq!(typed("hold"), Ok(Typed::Order(OperatorOrder::Hold)));
        assert!(matches!(typed("hold 5"), Ok(Typed::Order(OperatorOrder::Append(_)))));
        assert_eq!(completions("hol"), ["hold"]);
    }

    #[test]
    fn all_that_can_be_typed_is_completed_and_told() {
        for name in WORDS.iter().map(|word| word.name).chain(LANGUAGE.iter().map(|it| it.name)) {
            assert!(completions(name).contains(&name.to_owned()), "{name}");
            assert!(help(Typist::Here).contains(name), "{name}");
        }
    }
}
