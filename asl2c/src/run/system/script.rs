//! The lines of a system's script: lines of its agents, and commands for the channels and rounds.

use diagnostic::{Diagnostic, Span, closest};
use translator::system::System;

/// One line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Command<'a> {
    /// `first: set_charge(20); next_step();`
    Agent {
        member: usize,
        line: &'a str,
        /// Where the agent's line begins.
        start: usize,
    },
    /// `step 3`
    Step(u32),
    /// `deliver first second`: a message arrives, counted from 1 in the order of sending.
    Deliver(usize, usize, usize),
    /// `lose first second`
    Lose(usize, usize, usize),
    /// `mind`, `mind first`
    Mind(Option<usize>),
    /// `channels`
    Channels,
    /// `undo`
    Undo(u32),
    /// `help`
    Help,
    /// `quit`
    Quit,
}

const COMMANDS: [&str; 8] = ["step", "deliver", "lose", "mind", "channels", "undo", "help", "quit"];
/// Maximum number of rounds of one command.
const MOST: u32 = 10_000;

/// All possible beginnings of a line.
pub(super) fn words(system: &System) -> Vec<String> {
    let agents = system.members.iter().map(|member| format!("{}: ", member.name));
    agents.chain(COMMANDS.map(str::to_owned)).collect()
}

/// Parses a line.
pub(super) fn parse<'a>(line: &'a str, system: &System) -> Result<Command<'a>, Diagnostic> {
    let text = line.split("//").next().unwrap_or_default();
    if let Some((name, rest)) = text.split_once(':')
        && let Some(member) = system.member(name.trim())
    {
        let start = text.len() - rest.len();
        // What follows may contain `//` in a string.
        return Ok(Command::Agent { member, line: &line[start..], start });
    }
    let mut words = Words { text: text.trim_end().trim_end_matches(';'), at: 0, system };
    let (word, span) = words.next();
    let command = match word {
        "step" => Command::Step(words.number(1)?),
        "deliver" | "lose" => {
            let (from, to) = (words.member()?, words.member()?);
            let number = words.number(1)? as usize;
            if word == "deliver" {
                Command::Deliver(from, to, number)
            } else {
                Command::Lose(from, to, number)
            }
        }
        "mind" => Command::Mind(if words.is_at_end() { None } else { Some(words.member()?) }),
        "channels" => Command::Channels,
        "undo" => Command::Undo(words.number(1)?),
        "help" => Command::Help,
        "quit" | "exit" => Command::Quit,
        _ => {
            let known = self::words(system);
            let names = known.iter().map(|word| word.trim_end_matches([':', ' ']));
            let word = word.trim_end_matches(':');
            let message = format!("there is no command and no agent `{word}`");
            let error = Diagnostic::error(message, span);
            return Err(match closest(word, names.clone()) {
                Some(near) => error.help(format!("did you mean `{near}`?")),
                None => error.help(format!("there are {}", names.collect::<Vec<_>>().join(", "))),
            });
        }
    };
    match words.next() {
        ("", _) => Ok(command),
        (_, span) => Err(Diagnostic::error("expected the end of the line", span)),
    }
}

struct Words<'a> {
    text: &'a str,
    at: usize,
    system: &'a System,
}

impl<'a> Words<'a> {
    fn skip(&mut self) {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
    }

    fn is_at_end(&mut self) -> bool {
        self.skip();
        self.at >= self.text.len()
    }

    fn next(&mut self) -> (&'a str, Span) {
        self.skip();
        let rest = &self.text[self.at..];
        let word = rest.split_whitespace().next().unwrap_or_default();
        let start = self.at;
        self.at += word.len();
        (word, start..self.at)
    }

    fn member(&mut self) -> Result<usize, Diagnostic> {
        let (word, span) = self.next();
        self.system.member(word).ok_or_else(|| {
            let names: Vec<&str> =
                self.system.members.iter().map(|member| member.name.as_str()).collect();
            Diagnostic::error("expected an agent", span)
                .help(format!("there are {}", names.join(", ")))
        })
    }

    fn number(&mut self, usual: u32) -> Result<u32, Diagnostic> {
        if self.is_at_end() {
            return Ok(usual);
        }
        let (word, span) = self.next();
        let number = word.parse().ok().filter(|number| (1..=MOST).contains(number));
        number.ok_or_else(|| Diagnostic::error(format!("expected a number from 1 to {MOST}"), span))
    }
}
