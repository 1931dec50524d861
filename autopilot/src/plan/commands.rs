//! Commands that are ordered one by one.

use diagnostic::Diagnostic;

use super::dry_run::DryRun;
use super::language::Meaning;
use super::parser::{self, Line};
use super::{Command, FlightLimits, MissionId, PlanError, Step, check, writer};

/// Commands of the plan language, to be appended to a mission. Only their syntax is checked here; whether
/// they lead outside the fence depends on the mission before them.
#[derive(Debug, Clone, PartialEq)]
pub struct Commands {
    text: String,
    lines: Vec<Line>,
    clears: bool,
    id: Option<MissionId>,
}

impl Commands {
    /// How many there are.
    pub fn count(&self) -> usize {
        self.lines.len()
    }

    /// Parses commands, one per line; `name` stands for the source in messages.
    ///
    /// # Errors
    /// [`PlanError`] with all problems; a text without commands is one.
    pub fn parse(name: &str, text: &str) -> Result<Self, PlanError> {
        let (lines, diagnostics) = parser::parse(text);
        Self::checked(name, text.to_owned(), lines, diagnostics)
    }

    /// Commands of a program that makes a mission of them; with `clears` they replace the one before. Their text is written
    /// here, and means the same when it is read; the number is not in it.
    ///
    /// # Errors
    /// As [`Commands::parse`].
    pub fn new(
        name: &str,
        id: MissionId,
        clears: bool,
        commands: impl IntoIterator<Item = Command>,
    ) -> Result<Self, PlanError> {
        let meant = commands.into_iter().map(Meaning::Step);
        let (text, lines, diagnostics) =
            writer::write(clears.then_some(Meaning::Clears).into_iter().chain(meant));
        Ok(Self { id: Some(id), ..Self::checked(name, text, lines, diagnostics)? })
    }

    fn checked(
        name: &str,
        text: String,
        lines: Vec<Line>,
        mut diagnostics: Vec<Diagnostic>,
    ) -> Result<Self, PlanError> {
        if lines.is_empty() && diagnostics.is_empty() {
            diagnostics
                .push(Diagnostic::error("no command", 0..0).help("write one, as `goto 0 1 0 0`"));
        }
        diagnostics.extend(lines.iter().filter(|line| line.tag.is_some()).map(|line| {
            Diagnostic::error("`tag` is not a command for a flight", line.span.clone())
                .help("put it into a plan, before its take-off")
        }));
        if !diagnostics.is_empty() {
            return Err(PlanError::new(name, &text, &diagnostics));
        }
        let clears = lines.iter().any(|line| line.clears);
        let lines = parser::clear_commands(lines);
        Ok(Self { text, lines, clears, id: None })
    }

    /// The parsed text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether they contain `clearCommands`, which drops the commands before it.
    pub fn clears(&self) -> bool {
        self.clears
    }

    /// The number of the mission that they are; none for those from a text.
    pub fn id(&self) -> Option<MissionId> {
        self.id
    }

    /// Reasons why they cannot follow `run`, one sentence each.
    pub(crate) fn problems_behind(&self, run: DryRun, limits: &FlightLimits) -> Vec<String> {
        let diagnostics = check::check_places_behind(run, &self.lines, limits);
        let sentence = |diagnostic: Diagnostic| match diagnostic.help {
            Some(help) => format!("{}: {help}", diagnostic.message),
            None => diagnostic.message,
        };
        diagnostics.into_iter().map(sentence).collect()
    }

    pub(crate) fn into_steps(self) -> Vec<Step> {
        self.lines.into_iter().filter_map(Line::into_step).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_read_as_in_a_plan() {
        let commands = Commands::parse("command", "goto 0 1 0 0 # there").unwrap();
        assert!(!commands.clears());
        assert_eq!(commands.into_steps()[0].text, "goto 0 1 0 0");
        assert!(Commands::parse("command", "clearCommands").unwrap().clears());
        let error = Commands::parse("command", "gotoo 0 1 0 0").unwrap_err().to_string();
        assert!(error.contains("did you mean `goto`?"), "{error}");
        assert!(Commands::parse("command", " # nothing").is_err());
    }
}
