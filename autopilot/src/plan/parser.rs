//! Lines to commands.

use diagnostic::{Diagnostic, Span, closest};
use pid::Pose;

use super::Command;

/// A plan is read by people and flown on one battery.
const MAX_LINES: usize = 10_000;
/// Further than the drone's network reaches.
const MAX_DISTANCE_M: f64 = 100.0;
const MAX_ANGLE_DEG: f64 = 3600.0;

/// A command and where it stands.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Line {
    pub(super) number: usize,
    pub(super) span: Span,
    pub(super) text: String,
    /// Nothing for commands that only tell something.
    pub(super) command: Option<Command>,
    name: &'static str,
}

/// The commands of a plan and their arguments, for messages.
const COMMANDS: [(&str, &str); 14] = [
    ("takeoff", ""),
    ("land", ""),
    ("goto", "x y z yaw"),
    ("moveBy", "x y z yaw"),
    ("moveByRel", "x y z yaw"),
    ("setReference", "x y z yaw` or `setReference $POSE$"),
    ("setInitialReachDist", "metres"),
    ("setStayWithinDist", "metres"),
    ("setStayTime", "seconds"),
    ("setMaxControl", "fraction"),
    ("clearCommands", ""),
    ("autoInit", "[numbers]"),
    ("autoTakeover", "[numbers]"),
    ("lockScaleFP", ""),
];

/// The commands of `text` and what is wrong with it.
pub(super) fn parse(text: &str) -> (Vec<Line>, Vec<Diagnostic>) {
    let mut lines = Vec::new();
    let mut diagnostics = Vec::new();
    let mut start = 0;
    for (index, raw) in text.split('\n').enumerate() {
        if index >= MAX_LINES {
            diagnostics.push(
                Diagnostic::error(format!("more than {MAX_LINES} lines"), start..start)
                    .help("no battery lasts that long: is this a flight plan?"),
            );
            break;
        }
        match parse_line(raw, start, index + 1) {
            Ok(line) => lines.extend(line),
            Err(diagnostic) => diagnostics.push(diagnostic),
        }
        start += raw.len() + 1;
    }
    (lines, diagnostics)
}

/// What to tell about a command that means something else in `tum_ardrone`.
pub(super) fn note(line: &Line) -> Option<String> {
    let meaning = match line.name {
        "autoInit" => "takes off; there is no visual map to initialise",
        "autoTakeover" => "takes over, or takes off; there is no visual map to initialise",
        "lockScaleFP" => "does nothing; there is no visual map to scale",
        "clearCommands" => "drops the commands before it",
        _ => return None,
    };
    Some(format!("line {}: `{}` {meaning}", line.number, line.name))
}

/// `clearCommands` empties the queue: only what stands behind the last one is flown.
pub(super) fn clear_commands(mut lines: Vec<Line>) -> Vec<Line> {
    if let Some(last) = lines.iter().rposition(|line| line.name == "clearCommands") {
        lines.drain(..=last);
    }
    lines
}

/// A word of a line and where it stands in the text.
#[derive(Debug, Clone)]
struct Word<'a> {
    text: &'a str,
    span: Span,
}

fn parse_line(raw: &str, start: usize, number: usize) -> Result<Option<Line>, Diagnostic> {
    let code = raw.split('#').next().unwrap_or_default();
    let code = code.split("//").next().unwrap_or_default();
    let mut words = words(code, start);
    let Some(command) = words.next() else { return Ok(None) };
    let arguments: Vec<Word<'_>> = words.collect();
    let known = COMMANDS.iter().find(|(name, _)| *name == command.text);
    let Some((name, usage)) = known else { return Err(unknown(&command)) };
    let end = arguments.last().map_or(command.span.end, |last| last.span.end);
    let parsed = Arguments { command: &command, usage, words: &arguments }.command()?;
    Ok(Some(Line {
        number,
        span: command.span.start..end,
        text: code.split_whitespace().collect::<Vec<_>>().join(" "),
        command: parsed,
        name,
    }))
}

fn words(code: &str, start: usize) -> impl Iterator<Item = Word<'_>> {
    code.split_whitespace().map(move |text| {
        // The word is a slice of the line.
        let offset = start + (text.as_ptr().addr() - code.as_ptr().addr());
        Word { text, span: offset..offset + text.len() }
    })
}

fn unknown(word: &Word<'_>) -> Diagnostic {
    let shown: String = word.text.chars().take(40).flat_map(char::escape_debug).collect();
    let names = COMMANDS.iter().map(|(name, _)| *name);
    let help = match closest(word.text, names.clone()) {
        Some(candidate) => format!("did you mean `{candidate}`?"),
        None => format!("commands are: {}", names.collect::<Vec<_>>().join(", ")),
    };
    Diagnostic::error(format!("unknown command `{shown}`"), word.span.clone()).help(help)
}

struct Arguments<'a> {
    command: &'a Word<'a>,
    usage: &'static str,
    words: &'a [Word<'a>],
}

impl Arguments<'_> {
    fn command(&self) -> Result<Option<Command>, Diagnostic> {
        let command = match self.command.text {
            "takeoff" => self.none(Command::TakeOff { take_over: false })?,
            "land" => self.none(Command::Land)?,
            "goto" => Command::GoTo(self.pose()?),
            "moveBy" => Command::MoveBy(self.pose()?),
            "moveByRel" => Command::MoveByRelative(self.pose()?),
            "setReference" if matches!(self.words, [word] if word.text == "$POSE$") => {
                Command::SetReferenceHere
            }
            "setReference" => Command::SetReference(self.pose()?),
            "setInitialReachDist" => {
                Command::SetReachDistance { distance_m: self.one(0.01, 10.0)? }
            }
            "setStayWithinDist" => Command::SetStayDistance { distance_m: self.one(0.01, 10.0)? },
            "setStayTime" => Command::SetStayTime { time_s: self.one(0.0, 600.0)? },
            "setMaxControl" => Command::SetMaxControl { fraction: self.one(0.05, 1.0)? },
            "autoInit" | "autoTakeover" => {
                for word in self.words {
                    self.number(word)?;
                }
                Command::TakeOff { take_over: self.command.text == "autoTakeover" }
            }
            // `clearCommands` and `lockScaleFP` order nothing.
            _ => {
                self.count(0)?;
                return Ok(None);
            }
        };
        Ok(Some(command))
    }

    fn none(&self, command: Command) -> Result<Command, Diagnostic> {
        self.count(0)?;
        Ok(command)
    }

    fn one(&self, low: f64, high: f64) -> Result<f64, Diagnostic> {
        self.count(1)?;
        self.words.iter().map(|word| self.in_range(word, low, high)).sum()
    }

    fn pose(&self) -> Result<Pose, Diagnostic> {
        self.count(4)?;
        let [x, y, z, yaw] = self.words else { return Err(self.usage_error()) };
        let metres = |word| self.in_range(word, -MAX_DISTANCE_M, MAX_DISTANCE_M);
        Ok(Pose {
            x_m: metres(x)?,
            y_m: metres(y)?,
            z_m: metres(z)?,
            yaw_deg: self.in_range(yaw, -MAX_ANGLE_DEG, MAX_ANGLE_DEG)?,
        })
    }

    fn count(&self, expected: usize) -> Result<(), Diagnostic> {
        if self.words.len() == expected { Ok(()) } else { Err(self.usage_error()) }
    }

    fn usage_error(&self) -> Diagnostic {
        let end = self.words.last().map_or(self.command.span.end, |word| word.span.end);
        let name = self.command.text;
        let usage = if self.usage.is_empty() {
            format!("write `{name}` alone")
        } else {
            format!("write `{name} {}`", self.usage)
        };
        Diagnostic::error(
            format!("`{name}` with {} arguments", self.words.len()),
            self.command.span.start..end,
        )
        .help(usage)
    }

    fn in_range(&self, word: &Word<'_>, low: f64, high: f64) -> Result<f64, Diagnostic> {
        let value = self.number(word)?;
        if (low..=high).contains(&value) {
            return Ok(value);
        }
        Err(Diagnostic::error(format!("{value} is out of range"), word.span.clone())
            .help(format!("expected a number from {low} to {high}")))
    }

    fn number(&self, word: &Word<'_>) -> Result<f64, Diagnostic> {
        match word.text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(Diagnostic::error(
                format!("`{}` is not a number", word.text.escape_debug()),
                word.span.clone(),
            )
            .help(format!("write `{} {}`", self.command.text, self.usage))),
        }
    }
}
