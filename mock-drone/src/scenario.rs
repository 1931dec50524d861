//! Faults over time, as a text that anybody can write.
//!
//! ```text
//! # seconds since the start, or with a plus since the first take-off
//! 0     delay 20 jitter 15       # milliseconds
//! +2    loss 30                  # percent
//! +5    outage 1.2               # seconds
//! +8    lie altitude 0.5 for 3   # metres, seconds
//! +12   wind 1.5 -0.5 gusts 0.4  # metres a second towards right and forward
//! +20   restart
//! ```

use std::time::Duration;

use diagnostic::{Diagnostic, Source, Span, render_all};
use nalgebra::Vector2;

use crate::drone::Lie;

/// What happens, and when.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Scenario {
    entries: Vec<Entry>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Entry {
    when: When,
    action: Action,
}

/// When something happens.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum When {
    /// So long after the start.
    SinceStart(Duration),
    /// So long after the first take-off.
    SinceTakeOff(Duration),
}

/// Something that happens. Shares are probabilities from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Action {
    /// Datagrams are lost.
    Loss(f64),
    /// Datagrams take so long, and up to so much more.
    Delay(Duration, Duration),
    /// Datagrams arrive twice.
    Duplication(f64),
    /// Datagrams change their order.
    Reordering(f64),
    /// Datagrams are spoiled.
    Corruption(f64),
    /// Nothing arrives for a while.
    Outage(Duration),
    /// The drone is switched off and on again.
    Restart,
    /// Something stops a propeller.
    Propeller,
    /// The sensors read the same for a while.
    Freeze(Duration),
    /// The sensors read something wrong for a while.
    Lie(Lie, Duration),
    /// The wind towards (right, forward), and the deviation of its gusts.
    Wind(Vector2<f64>, f64),
    /// The charge in percent.
    Battery(f64),
}

/// A scenario that could not be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{rendered}")]
pub struct ScenarioError {
    /// Everything that is wrong, with line and column.
    pub rendered: String,
}

const ACTIONS: &str = "loss, delay, duplicate, reorder, corrupt, outage, restart, propeller, \
                       freeze, lie, wind, battery";

impl Scenario {
    /// A scenario of one action.
    #[must_use]
    pub fn and(mut self, when: When, action: Action) -> Self {
        self.entries.push(Entry { when, action });
        self
    }

    /// Reads a scenario; `name` is its file's name for messages.
    ///
    /// # Errors
    /// [`ScenarioError`] with everything that is wrong.
    pub fn parse(name: &str, text: &str) -> Result<Self, ScenarioError> {
        let mut scenario = Self::default();
        let mut diagnostics = Vec::new();
        let mut start = 0;
        for line in text.split_inclusive('\n') {
            let mut words = Words::new(line, start);
            start += line.len();
            if words.peek().is_none() {
                continue;
            }
            match entry(&mut words) {
                Ok(entry) => scenario.entries.push(entry),
                Err(diagnostic) => diagnostics.push(diagnostic),
            }
        }
        if diagnostics.is_empty() {
            return Ok(scenario);
        }
        let rendered = render_all(&diagnostics, &Source { name, text });
        Err(ScenarioError { rendered })
    }

    /// Takes out what is due, in the order in which it was written.
    pub(crate) fn due(&mut self, now: Duration, take_off: Option<Duration>) -> Vec<Action> {
        let is_due = |entry: &mut Entry| entry.time(take_off).is_some_and(|time| time <= now);
        self.entries.extract_if(.., is_due).map(|entry| entry.action).collect()
    }

    /// When the next action is due, as far as that is known.
    pub(crate) fn next_due(&self, take_off: Option<Duration>) -> Option<Duration> {
        self.entries.iter().filter_map(|entry| entry.time(take_off)).min()
    }
}

impl Entry {
    fn time(&self, take_off: Option<Duration>) -> Option<Duration> {
        match self.when {
            When::SinceStart(time) => Some(time),
            When::SinceTakeOff(time) => take_off.map(|take_off| take_off + time),
        }
    }
}

/// The words of a line, with their places in the text.
struct Words<'a> {
    all: Vec<(&'a str, Span)>,
    next: usize,
    end: usize,
}

impl<'a> Words<'a> {
    fn new(line: &'a str, start: usize) -> Self {
        let content = line.split('#').next().unwrap_or_default();
        let words = content.split_whitespace().map(|word| {
            // A word is a part of the line that it came from.
            let offset = start + (word.as_ptr().addr() - line.as_ptr().addr());
            (word, offset..offset + word.len())
        });
        Self { all: words.collect(), next: 0, end: start + content.trim_end().len() }
    }

    fn peek(&self) -> Option<&'a str> {
        self.all.get(self.next).map(|(word, _)| *word)
    }

    fn next(&mut self, expected: &str) -> Result<(&'a str, Span), Diagnostic> {
        let Some((word, span)) = self.all.get(self.next).cloned() else {
            let message = format!("expected {expected}, found the end of the line");
            return Err(Diagnostic::error(message, self.end..self.end));
        };
        self.next += 1;
        Ok((word, span))
    }

    fn take(&mut self, word: &str) -> bool {
        let found = self.peek() == Some(word);
        self.next += usize::from(found);
        found
    }

    fn number(&mut self, expected: &str, from: f64, to: f64) -> Result<f64, Diagnostic> {
        let (word, span) = self.next(expected)?;
        word.parse().ok().filter(|number| (from..=to).contains(number)).ok_or_else(|| {
            let message = format!("expected {expected}, found `{word}`");
            Diagnostic::error(message, span).help(format!("a number from {from} to {to}"))
        })
    }

    /// A percentage as a share.
    fn share(&mut self) -> Result<f64, Diagnostic> {
        Ok(self.number("a percentage", 0.0, 100.0)? / 100.0)
    }

    fn seconds(&mut self) -> Result<Duration, Diagnostic> {
        self.number("seconds", 0.0, 3600.0).map(Duration::from_secs_f64)
    }

    fn milliseconds(&mut self) -> Result<Duration, Diagnostic> {
        let milliseconds = self.number("milliseconds", 0.0, 10_000.0)?;
        Ok(Duration::from_secs_f64(milliseconds / 1000.0))
    }
}

fn entry(words: &mut Words<'_>) -> Result<Entry, Diagnostic> {
    let (word, span) = words.next("a time")?;
    let time = word.parse().ok().filter(|seconds| (0.0..=36_000.0).contains(seconds));
    let Some(time) = time.map(Duration::from_secs_f64) else {
        return Err(Diagnostic::error(format!("`{word}` is no time"), span)
            .help("seconds since the start, or with a plus since the first take-off"));
    };
    let when =
        if word.starts_with('+') { When::SinceTakeOff(time) } else { When::SinceStart(time) };
    let action = action(words)?;
    if let Ok((word, span)) = words.next("") {
        return Err(Diagnostic::error(format!("`{word}` is one word too many"), span));
    }
    Ok(Entry { when, action })
}

fn action(words: &mut Words<'_>) -> Result<Action, Diagnostic> {
    let (word, span) = words.next("an action")?;
    Ok(match word {
        "loss" => Action::Loss(words.share()?),
        "delay" => {
            let delay = words.milliseconds()?;
            let jitter = if words.take("jitter") { words.milliseconds()? } else { Duration::ZERO };
            Action::Delay(delay, jitter)
        }
        "duplicate" => Action::Duplication(words.share()?),
        "reorder" => Action::Reordering(words.share()?),
        "corrupt" => Action::Corruption(words.share()?),
        "outage" => Action::Outage(words.seconds()?),
        "restart" => Action::Restart,
        "propeller" => Action::Propeller,
        "freeze" => Action::Freeze(words.seconds()?),
        "lie" => lie(words)?,
        "wind" => {
            let right = words.number("metres a second", -30.0, 30.0)?;
            let forward = words.number("metres a second", -30.0, 30.0)?;
            let gusts =
                if words.take("gusts") { words.number("metres a second", 0.0, 30.0)? } else { 0.0 };
            Action::Wind(Vector2::new(right, forward), gusts)
        }
        "battery" => Action::Battery(words.number("a percentage", 0.0, 100.0)?),
        _ => {
            return Err(Diagnostic::error(format!("unknown action `{word}`"), span)
                .help(format!("one of {ACTIONS}")));
        }
    })
}

/// `lie altitude 0.5 for 3`
fn lie(words: &mut Words<'_>) -> Result<Action, Diagnostic> {
    let (what, span) = words.next("altitude, velocity or yaw")?;
    let lie = match what {
        "altitude" => Lie { altitude_m: words.number("metres", -100.0, 100.0)?, ..Lie::default() },
        "velocity" => {
            let right = words.number("metres a second", -30.0, 30.0)?;
            let forward = words.number("metres a second", -30.0, 30.0)?;
            Lie { velocity_m_s: Vector2::new(right, forward), ..Lie::default() }
        }
        "yaw" => Lie { yaw_deg: words.number("degrees", -180.0, 180.0)?, ..Lie::default() },
        _ => {
            return Err(Diagnostic::error(format!("the drone cannot lie about `{what}`"), span)
                .help("altitude, velocity or yaw"));
        }
    };
    if !words.take("for") {
        words.next("`for` and seconds").and_then(|(word, span)| {
            Err(Diagnostic::error(format!("expected `for`, found `{word}`"), span))
        })?;
    }
    Ok(Action::Lie(lie, words.seconds()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scenario_is_read_and_its_actions_come_when_they_are_due() {
        let text = "# faults\n0 delay 20 jitter 15\n+2 loss 30\n\n+5.5 outage 1.2 # gone\n\
                    1 wind 1.5 -0.5 gusts 0.4\n+8 lie altitude 0.5 for 3\n+9 restart\n";
        let mut scenario = Scenario::parse("s.txt", text).unwrap();
        let seconds = Duration::from_secs_f64;
        assert_eq!(scenario.next_due(None), Some(Duration::ZERO));
        let delay = Action::Delay(seconds(0.02), seconds(0.015));
        let wind = Action::Wind(Vector2::new(1.5, -0.5), 0.4);
        assert_eq!(scenario.due(seconds(1.0), None), [delay, wind]);
        assert_eq!(scenario.due(seconds(100.0), None), []);
        assert_eq!(scenario.next_due(Some(seconds(100.0))), Some(seconds(102.0)));
        assert_eq!(scenario.due(seconds(102.0), Some(seconds(100.0))), [Action::Loss(0.3)]);
        assert_eq!(scenario.due(seconds(200.0), Some(seconds(100.0))).len(), 3);
        assert_eq!(scenario, Scenario::default());
    }

    #[test]
    fn every_mistake_is_shown_with_its_place() {
        let text = "soon loss 3\n1 los 3\n2 loss 300\n3 loss\n4 restart now\n5 lie roll 3 for 1\n\
                    6 lie yaw 3 1\n-7 restart\nNaN restart";
        let error = Scenario::parse("s.txt", text).unwrap_err().rendered;
        let places: Vec<&str> = error.lines().filter(|line| line.starts_with("error")).collect();
        assert_eq!(
            places,
            [
                "error: `soon` is no time",
                "error: unknown action `los`",
                "error: expected a percentage, found `300`",
                "error: expected a percentage, found the end of the line",
                "error: `now` is one word too many",
                "error: the drone cannot lie about `roll`",
                "error: expected `for`, found `1`",
                "error: `-7` is no time",
                "error: `NaN` is no time",
            ]
        );
        assert!(error.contains("s.txt:3:8"), "{error}");
    }
}
