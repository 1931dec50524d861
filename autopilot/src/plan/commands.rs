//! Commands that are ordered one by one, as they are typed.

use diagnostic::Diagnostic;

use super::dry_run::DryRun;
use super::parser::{self, Line};
use super::{FlightLimits, PlanError, Step, check};

/// Commands of the plan language, to be appended to a mission. They are read by themselves; whether they fit
/// behind a mission is known only there.
#[derive(Debug, Clone, PartialEq)]
pub struct Commands {
    text: String,
    lines: Vec<Line>,
    clears: bool,
}

impl Commands {
    /// Reads commands, one a line; `name` is what they are called in messages.
    ///
    /// # Errors
    /// [`PlanError`] with everything that is wrong, also if there is none.
    pub fn parse(name: &str, text: &str) -> Result<Self, PlanError> {
        let (lines, mut diagnostics) = parser::parse(text);
        if lines.is_empty() && diagnostics.is_empty() {
            diagnostics
                .push(Diagnostic::error("no command", 0..0).help("write one, as `goto 0 1 0 0`"));
        }
        if !diagnostics.is_empty() {
            return Err(PlanError::new(name, text, &diagnostics));
        }
        let clears = lines.iter().any(Line::clears);
        let lines = parser::clear_commands(lines);
        Ok(Self { text: text.to_owned(), lines, clears })
    }

    /// The text that was read.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether `clearCommands` is among them: what waited before them is dropped.
    pub fn clears(&self) -> bool {
        self.clears
    }

    /// Why they cannot stand behind `run`, in one sentence each.
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
