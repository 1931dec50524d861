//! Parses the lines of a plan.

use diagnostic::{Diagnostic, Figures, Span, beyond, closest};
use estimator::SurveyedTag;

use super::language::{Declaration, LANGUAGE, Meaning, Number, VERSION};
use super::{Command, Step};

/// Largest plan. A plan is read by people and flown on one battery.
pub(super) const MAX_LINES: usize = 10_000;

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
    /// The version of the language that it names.
    version: Option<f64>,
    /// It drops the commands before it.
    pub(super) clears: bool,
    /// Why somebody who knows `tum_ardrone` may be surprised.
    note: Option<&'static str>,
}

impl Line {
    /// The line with this text, which means this by its declaration.
    pub(super) fn new(
        number: usize,
        span: Span,
        text: String,
        declaration: &Declaration,
        meaning: Meaning,
    ) -> Self {
        Self {
            number,
            span,
            text,
            command: if let Meaning::Step(command) = meaning { Some(command) } else { None },
            tag: if let Meaning::Tag(tag) = meaning { Some(tag) } else { None },
            version: if let Meaning::Version(number) = meaning { Some(number) } else { None },
            clears: meaning == Meaning::Clears,
            note: declaration.note,
        }
    }

    /// Converts it to a step; `None` for a keyword without effect in flight.
    pub(super) fn into_step(self) -> Option<Step> {
        Some(Step { command: self.command?, line: self.number, text: self.text })
    }
}

/// Parses `text` into commands and problems.
pub(super) fn parse(text: &str) -> (Vec<Line>, Vec<Diagnostic>) {
    let mut lines = Vec::new();
    let mut diagnostics = Vec::new();
    let mut start = 0;
    let mut is_begun = false;
    for (index, raw) in text.split('\n').enumerate() {
        if index >= MAX_LINES {
            diagnostics.push(too_long(start));
            break;
        }
        match parse_line(raw, start, index + 1) {
            Ok(None) => {}
            Ok(Some(line)) => {
                match line.version {
                    Some(_) if is_begun => diagnostics.push(late_version(&line)),
                    Some(version) if version.total_cmp(&f64::from(VERSION)).is_ne() => {
                        // Nothing of a text of another version can be relied on.
                        return (Vec::new(), vec![other_version(version, &line)]);
                    }
                    _ => lines.push(line),
                }
                is_begun = true;
            }
            Err(diagnostic) => {
                diagnostics.push(diagnostic);
                is_begun = true;
            }
        }
        start += raw.len() + 1;
    }
    (lines, diagnostics)
}

fn late_version(line: &Line) -> Diagnostic {
    Diagnostic::error("the version stands behind another command", line.span.clone())
        .help("put it before all commands")
}

fn other_version(version: f64, line: &Line) -> Diagnostic {
    let message = format!("this plan has version {} of its language", Figures(version));
    Diagnostic::error(message, line.span.clone())
        .help(format!("this program reads version {VERSION}"))
}

/// The problem of a text that goes on at `start` behind its last line.
pub(super) fn too_long(start: usize) -> Diagnostic {
    Diagnostic::error(format!("more than {MAX_LINES} lines"), start..start)
        .help("no battery lasts that long: is this a flight plan?")
}

/// Note about a command that has another meaning in `tum_ardrone`.
pub(super) fn note(line: &Line) -> Option<String> {
    let name = line.text.split(' ').next().unwrap_or_default();
    line.note.map(|note| format!("line {}: `{name}` {note}", line.number))
}

/// Applies `clearCommands`: only the commands behind the last one remain.
pub(super) fn clear_commands(mut lines: Vec<Line>) -> Vec<Line> {
    if let Some(last) = lines.iter().rposition(|line| line.clears) {
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
    let Some(declaration) = LANGUAGE.iter().find(|known| known.name == command.text) else {
        return Err(unknown(&command));
    };
    let end = arguments.last().map_or(command.span.end, |last| last.span.end);
    let span = command.span.start..end;
    let meaning = meaning(declaration, &arguments, &span)?;
    let text = code.split_whitespace().collect::<Vec<_>>().join(" ");
    Ok(Some(Line::new(number, span, text, declaration, meaning)))
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
    let names = LANGUAGE.iter().map(|known| known.name);
    let help = match closest(word.text, names.clone()) {
        Some(candidate) => format!("did you mean `{candidate}`?"),
        None => format!("commands are: {}", names.collect::<Vec<_>>().join(", ")),
    };
    Diagnostic::error(format!("unknown command `{shown}`"), word.span.clone()).help(help)
}

fn meaning(
    declaration: &Declaration,
    arguments: &[Word<'_>],
    span: &Span,
) -> Result<Meaning, Diagnostic> {
    let Declaration { name, numbers, optional, words, .. } = declaration;
    if let [argument] = arguments
        && let Some((_, command)) = words.iter().find(|(word, _)| *word == argument.text)
    {
        return Ok(Meaning::Step(*command));
    }
    if !(numbers.len() - optional..=numbers.len()).contains(&arguments.len()) {
        let message = format!("`{name}` with {} arguments", arguments.len());
        return Err(Diagnostic::error(message, span.clone()).help(declaration.usage()));
    }
    let mut values = [f64::NAN; _];
    for ((value, argument), number) in values.iter_mut().zip(arguments).zip(*numbers) {
        *value = read(argument, number, declaration)?;
    }
    Ok((declaration.meaning)(values))
}

fn read(word: &Word<'_>, number: &Number, declaration: &Declaration) -> Result<f64, Diagnostic> {
    match word.text.parse::<f64>() {
        Ok(value) if value.is_finite() => check(value, number, &word.span).map(|()| value),
        _ => {
            let message = format!("`{}` is not a number", word.text.escape_debug());
            Err(Diagnostic::error(message, word.span.clone()).help(declaration.usage()))
        }
    }
}

/// Checks that a number is one that its command takes.
pub(super) fn check(value: f64, number: &Number, span: &Span) -> Result<(), Diagnostic> {
    let Number { low, high, .. } = *number;
    if (low..=high).contains(&value) {
        return Ok(());
    }
    let shown = beyond(value, &(low..=high));
    let (low, high) = (Figures(low), Figures(high));
    Err(Diagnostic::error(format!("{shown} is out of range"), span.clone())
        .help(format!("expected a number from {low} to {high}")))
}
