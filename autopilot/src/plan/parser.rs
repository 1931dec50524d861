//! Parses the lines of a plan.

use diagnostic::{Diagnostic, Span, closest};
use estimator::SurveyedTag;
use kinematics::Pose;
use nalgebra::Vector2;

use super::{Command, Step};

/// Largest plan. A plan is read by people and flown on one battery.
const MAX_LINES: usize = 10_000;
/// Largest coordinate, beyond the range of the drone's Wi-Fi.
const MAX_DISTANCE_M: f64 = 100.0;
const MAX_ANGLE_DEG: f64 = 3600.0;

/// A command and its place in the text.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Line {
    pub(super) number: usize,
    pub(super) span: Span,
    pub(super) text: String,
    /// `None` for a keyword without effect in flight.
    pub(super) command: Option<Command>,
    /// The tag that a `tag` declares, which is no step.
    pub(super) tag: Option<SurveyedTag>,
    keyword: Keyword,
}

impl Line {
    /// Whether it drops the commands before it.
    pub(super) fn clears(&self) -> bool {
        matches!(self.keyword, Keyword::ClearCommands)
    }

    /// Converts it to a step; `None` for a keyword without effect in flight.
    pub(super) fn into_step(self) -> Option<Step> {
        Some(Step { command: self.command?, line: self.number, text: self.text })
    }
}

/// The first word of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Keyword {
    TakeOff,
    Land,
    GoTo,
    MoveBy,
    MoveByRel,
    SetReference,
    SetInitialReachDist,
    SetStayWithinDist,
    SetStayTime,
    SetSpeed,
    SetMaxControl,
    Tag,
    FindTag,
    LandOnTag,
    ClearCommands,
    AutoInit,
    AutoTakeover,
    LockScaleFp,
}

impl Keyword {
    /// All keywords. One that is missing here is never constructed, which the compiler reports as dead code.
    const ALL: [Self; 18] = [
        Self::TakeOff,
        Self::Land,
        Self::GoTo,
        Self::MoveBy,
        Self::MoveByRel,
        Self::SetReference,
        Self::SetInitialReachDist,
        Self::SetStayWithinDist,
        Self::SetStayTime,
        Self::SetSpeed,
        Self::SetMaxControl,
        Self::Tag,
        Self::FindTag,
        Self::LandOnTag,
        Self::ClearCommands,
        Self::AutoInit,
        Self::AutoTakeover,
        Self::LockScaleFp,
    ];

    /// Spelling in plans.
    fn name(self) -> &'static str {
        match self {
            Self::TakeOff => "takeoff",
            Self::Land => "land",
            Self::GoTo => "goto",
            Self::MoveBy => "moveBy",
            Self::MoveByRel => "moveByRel",
            Self::SetReference => "setReference",
            Self::SetInitialReachDist => "setInitialReachDist",
            Self::SetStayWithinDist => "setStayWithinDist",
            Self::SetStayTime => "setStayTime",
            Self::SetSpeed => "setSpeed",
            Self::SetMaxControl => "setMaxControl",
            Self::Tag => "tag",
            Self::FindTag => "findTag",
            Self::LandOnTag => "landOnTag",
            Self::ClearCommands => "clearCommands",
            Self::AutoInit => "autoInit",
            Self::AutoTakeover => "autoTakeover",
            Self::LockScaleFp => "lockScaleFP",
        }
    }

    /// Its arguments, for messages.
    fn usage(self) -> &'static str {
        match self {
            Self::TakeOff
            | Self::Land
            | Self::FindTag
            | Self::LandOnTag
            | Self::ClearCommands
            | Self::LockScaleFp => "",
            Self::Tag => "x y` or `tag x y heading",
            Self::GoTo | Self::MoveBy | Self::MoveByRel => "x y z yaw",
            Self::SetReference => "x y z yaw`, `setReference $POSE$` or `setReference $START$",
            Self::SetInitialReachDist | Self::SetStayWithinDist => "metres",
            Self::SetStayTime => "seconds",
            Self::SetSpeed => "m/s",
            Self::SetMaxControl => "fraction",
            Self::AutoInit | Self::AutoTakeover => "[numbers]",
        }
    }
}

/// Parses `text` into commands and problems.
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

/// Note about a command that has another meaning in `tum_ardrone`.
pub(super) fn note(line: &Line) -> Option<String> {
    let meaning = match line.keyword {
        Keyword::AutoInit => "takes off; there is no visual map to initialise",
        Keyword::AutoTakeover => "takes over, or takes off; there is no visual map to initialise",
        Keyword::LockScaleFp => "does nothing; there is no visual map to scale",
        Keyword::ClearCommands => "drops the commands before it",
        Keyword::TakeOff
        | Keyword::Land
        | Keyword::GoTo
        | Keyword::MoveBy
        | Keyword::MoveByRel
        | Keyword::SetReference
        | Keyword::SetInitialReachDist
        | Keyword::SetStayWithinDist
        | Keyword::SetStayTime
        | Keyword::SetSpeed
        | Keyword::SetMaxControl
        | Keyword::Tag
        | Keyword::FindTag
        | Keyword::LandOnTag => return None,
    };
    Some(format!("line {}: `{}` {meaning}", line.number, line.keyword.name()))
}

/// Applies `clearCommands`: only the commands behind the last one remain.
pub(super) fn clear_commands(mut lines: Vec<Line>) -> Vec<Line> {
    if let Some(last) = lines.iter().rposition(Line::clears) {
        lines.drain(..=last);
    }
    lines
}

/// A word of a line and its place in the text.
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
    let known = Keyword::ALL.into_iter().find(|keyword| keyword.name() == command.text);
    let Some(keyword) = known else { return Err(unknown(&command)) };
    let end = arguments.last().map_or(command.span.end, |last| last.span.end);
    let arguments = Arguments { keyword, command: &command, words: &arguments };
    let (parsed, tag) = match keyword {
        Keyword::Tag => (None, Some(arguments.tag()?)),
        _ => (arguments.command()?, None),
    };
    Ok(Some(Line {
        number,
        span: command.span.start..end,
        text: code.split_whitespace().collect::<Vec<_>>().join(" "),
        command: parsed,
        tag,
        keyword,
    }))
}

fn words(code: &str, start: usize) -> impl Iterator<Item = Word<'_>> {
    code.split_whitespace().map(move |text| {
        // The word is a slice of the line, so the difference of their addresses is its offset.
        let offset = start + (text.as_ptr().addr() - code.as_ptr().addr());
        Word { text, span: offset..offset + text.len() }
    })
}

fn unknown(word: &Word<'_>) -> Diagnostic {
    let shown: String = word.text.chars().take(40).flat_map(char::escape_debug).collect();
    let names = Keyword::ALL.into_iter().map(Keyword::name);
    let help = match closest(word.text, names.clone()) {
        Some(candidate) => format!("did you mean `{candidate}`?"),
        None => format!("commands are: {}", names.collect::<Vec<_>>().join(", ")),
    };
    Diagnostic::error(format!("unknown command `{shown}`"), word.span.clone()).help(help)
}

struct Arguments<'a> {
    keyword: Keyword,
    command: &'a Word<'a>,
    words: &'a [Word<'a>],
}

impl Arguments<'_> {
    fn command(&self) -> Result<Option<Command>, Diagnostic> {
        let command = match self.keyword {
            Keyword::TakeOff => self.none(Command::TakeOff { take_over: false })?,
            Keyword::Land => self.none(Command::Land)?,
            Keyword::GoTo => Command::GoTo(self.pose()?),
            Keyword::MoveBy => Command::MoveBy(self.pose()?),
            Keyword::MoveByRel => Command::MoveByRelative(self.pose()?),
            Keyword::SetReference if matches!(self.words, [word] if word.text == "$POSE$") => {
                Command::SetReferenceHere
            }
            Keyword::SetReference if matches!(self.words, [word] if word.text == "$START$") => {
                Command::SetReferenceStart
            }
            Keyword::SetReference => Command::SetReference(self.pose()?),
            Keyword::SetInitialReachDist => {
                Command::SetReachDistance { distance_m: self.one(0.01, 10.0)? }
            }
            Keyword::SetStayWithinDist => {
                Command::SetStayDistance { distance_m: self.one(0.01, 10.0)? }
            }
            Keyword::SetStayTime => Command::SetStayTime { time_s: self.one(0.0, 600.0)? },
            Keyword::SetSpeed => Command::SetSpeed { speed_m_s: self.one(0.05, 10.0)? },
            Keyword::SetMaxControl => Command::SetMaxControl { fraction: self.one(0.05, 1.0)? },
            Keyword::AutoInit => self.numbers(Command::TakeOff { take_over: false })?,
            Keyword::AutoTakeover => self.numbers(Command::TakeOff { take_over: true })?,
            Keyword::FindTag => self.none(Command::FindTag)?,
            Keyword::LandOnTag => self.none(Command::LandOnTag)?,
            // A tag is no step; `clearCommands` is handled by `clear_commands`; `lockScaleFP` belongs to visual
            // mapping, which is not supported.
            Keyword::Tag | Keyword::ClearCommands | Keyword::LockScaleFp => {
                self.count(0)?;
                return Ok(None);
            }
        };
        Ok(Some(command))
    }

    /// Accepts any number of numeric arguments, which have no meaning here.
    fn numbers(&self, command: Command) -> Result<Command, Diagnostic> {
        for word in self.words {
            self.number(word)?;
        }
        Ok(command)
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

    /// Right and forward of the start, and the heading if it was measured.
    fn tag(&self) -> Result<SurveyedTag, Diagnostic> {
        let metres = |word| self.in_range(word, -MAX_DISTANCE_M, MAX_DISTANCE_M);
        let (x, y, heading) = match self.words {
            [x, y] => (x, y, None),
            [x, y, heading] => (x, y, Some(heading)),
            _ => return Err(self.usage_error()),
        };
        let degrees = heading.map(|word| self.in_range(word, -360.0, 360.0));
        Ok(SurveyedTag {
            place_m: Vector2::new(metres(x)?, metres(y)?),
            heading_deg: degrees.transpose()?,
        })
    }

    fn count(&self, expected: usize) -> Result<(), Diagnostic> {
        if self.words.len() == expected { Ok(()) } else { Err(self.usage_error()) }
    }

    fn usage_error(&self) -> Diagnostic {
        let end = self.words.last().map_or(self.command.span.end, |word| word.span.end);
        let name = self.command.text;
        let usage = match self.keyword.usage() {
            "" => format!("write `{name}` alone"),
            usage => format!("write `{name} {usage}`"),
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
            .help(format!("write `{} {}`", self.command.text, self.keyword.usage()))),
        }
    }
}
