//! Parser of scenarios, line by line.

use std::ops::RangeInclusive;
use std::str::FromStr;
use std::time::Duration;

use ardrone_link::navdata::DroneState;
use diagnostic::{Diagnostic, Span};
use nalgebra::Vector2;

use super::{Action, Direction, Entry, VideoFault, When};
use crate::camera::FloorTag;
use crate::faults::{Quantity, SensorFault};
use crate::link::PAST;

const ACTIONS: &str = "loss, delay, duplicate, reorder, corrupt, outage, hold, burst, restart, \
                       propeller, freeze, stuck, dead, lie, ramp, noise, gain, nan, late, state, minor, motor, \
                       wind, battery, sag, second-pilot, video, tag, tag-moved, tag-gone";

/// Names of the quantities in navdata.
const QUANTITIES: [(&str, Quantity); 8] = [
    ("velocity-right", Quantity::VelocityRight),
    ("velocity-forward", Quantity::VelocityForward),
    ("altitude", Quantity::Altitude),
    ("yaw", Quantity::Yaw),
    ("heading", Quantity::Yaw),
    ("roll", Quantity::Roll),
    ("pitch", Quantity::Pitch),
    ("clock", Quantity::Clock),
];

/// Names of the faults of the video.
const VIDEO_FAULTS: [(&str, VideoFault); 4] = [
    ("cut", VideoFault::Cut),
    ("silent", VideoFault::Silent),
    ("garbage", VideoFault::Garbage),
    ("lie", VideoFault::Lie),
];

/// Parses all lines: the valid entries, and the errors of the others.
pub(super) fn parse(text: &str) -> (Vec<Entry>, Vec<Diagnostic>) {
    let mut entries = Vec::new();
    let mut diagnostics = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let mut words = Words::new(line, start);
        start += line.len();
        if words.peek().is_none() {
            continue;
        }
        match line_entries(&mut words) {
            Ok(more) => entries.extend(more),
            Err(diagnostic) => diagnostics.push(diagnostic),
        }
    }
    (entries, diagnostics)
}

fn line_entries(words: &mut Words<'_>) -> Result<Vec<Entry>, Diagnostic> {
    let (word, span) = words.next("a time")?;
    let time = word.parse().ok().filter(|seconds| (0.0..=36_000.0).contains(seconds));
    let Some(time) = time.map(Duration::from_secs_f64) else {
        return Err(Diagnostic::error(format!("`{word}` is not a time"), span)
            .help("seconds since the start, or with a plus since the first take-off"));
    };
    let when =
        if word.starts_with('+') { When::SinceTakeOff(time) } else { When::SinceStart(time) };
    let actions = actions(words)?;
    if let Ok((word, span)) = words.next("") {
        return Err(Diagnostic::error(format!("unexpected `{word}`"), span));
    }
    Ok(actions.into_iter().map(|action| Entry { when, action }).collect())
}

/// The actions of a line; a velocity fault in both directions is two actions.
fn actions(words: &mut Words<'_>) -> Result<Vec<Action>, Diagnostic> {
    let (word, span) = words.next("an action")?;
    let action = match word {
        "lie" if words.take("velocity") => return velocity_lie(words),
        "stuck" | "dead" | "lie" | "ramp" | "noise" | "gain" | "nan" | "late" => {
            sensor(word, words)?
        }
        "state" | "minor" => claim(word, words)?,
        "loss" | "delay" | "duplicate" | "reorder" | "corrupt" | "outage" | "hold" | "burst" => {
            link(word, words)?
        }
        "restart" => Action::Restart,
        "propeller" => Action::Propeller,
        "freeze" => Action::Freeze(words.seconds()?),
        "motor" => {
            let share = words.share()?;
            let within = if words.take("over") { words.seconds()? } else { Duration::ZERO };
            Action::Motor(share, within)
        }
        "wind" => {
            let steady_m_s = words.velocity()?;
            let gusts =
                if words.take("gusts") { words.number("metres a second", 0.0, 30.0)? } else { 0.0 };
            Action::Wind(steady_m_s, gusts)
        }
        "battery" => Action::Battery(words.number("a percentage", 0.0, 100.0)?),
        "sag" => Action::BatterySag(words.number("a percentage", 0.0, 100.0)?),
        "tag" => Action::LayTag(words.tag()?),
        "tag-moved" => {
            let number = words.whole("a tag's number", &(1..=99_usize))?;
            Action::MoveTag(number - 1, Some(words.tag()?))
        }
        "tag-gone" => Action::MoveTag(words.whole("a tag's number", &(1..=99_usize))? - 1, None),
        "second-pilot" => {
            let time = words.seconds()?;
            let first =
                if words.take("from") { words.whole("a number", &(1..=u32::MAX))? } else { 1 };
            Action::SecondPilot(time, first)
        }
        "video" => Action::Video(words.video_fault()?, words.for_seconds()?),
        _ => {
            return Err(Diagnostic::error(format!("unknown action `{word}`"), span)
                .help(format!("one of {ACTIONS}")));
        }
    };
    Ok(vec![action])
}

/// `loss up 30`, `hold 2`, `burst 20` and similar.
fn link(word: &str, words: &mut Words<'_>) -> Result<Action, Diagnostic> {
    Ok(match word {
        "loss" => Action::Loss(words.direction(), words.share()?),
        "outage" => Action::Outage(words.direction(), words.seconds()?),
        "hold" => Action::Hold(words.direction(), words.seconds()?),
        "burst" => Action::Burst(words.whole("a number of packets", &(1..=PAST))?),
        "duplicate" => Action::Duplication(words.share()?),
        "reorder" => Action::Reordering(words.share()?),
        "corrupt" => Action::Corruption(words.share()?),
        _ => {
            let delay = words.milliseconds()?;
            let jitter = if words.take("jitter") { words.milliseconds()? } else { Duration::ZERO };
            Action::Delay(delay, jitter)
        }
    })
}

/// `lie velocity 0.5 -1 for 3`
fn velocity_lie(words: &mut Words<'_>) -> Result<Vec<Action>, Diagnostic> {
    let offset_m_s = words.velocity()?;
    let time = words.for_seconds()?;
    let lie = |quantity, offset| Action::Sensor(quantity, SensorFault::Offset(offset), time);
    Ok(vec![
        lie(Quantity::VelocityRight, offset_m_s.x),
        lie(Quantity::VelocityForward, offset_m_s.y),
    ])
}

/// `stuck yaw for 3`, `dead altitude at 1 for 3` and similar.
fn sensor(word: &str, words: &mut Words<'_>) -> Result<Action, Diagnostic> {
    let (quantity, name, span) = words.quantity()?;
    let at = |words: &mut Words<'_>| words.take("at").then(|| words.value(quantity)).transpose();
    let fault = match word {
        "stuck" => at(words)?.map_or(SensorFault::Stuck, SensorFault::StuckAt),
        "dead" => SensorFault::DeadAt(at(words)?.unwrap_or(0.0)),
        "lie" => SensorFault::Offset(words.value(quantity)?),
        "ramp" => SensorFault::Ramp(words.value(quantity)?),
        "noise" => SensorFault::Noise(words.number("a standard deviation", 0.0, 180.0)?),
        "gain" => SensorFault::Gain(words.number("a factor", -100.0, 100.0)?),
        "nan" if quantity.is_float() => SensorFault::NotANumber,
        "nan" => {
            return Err(Diagnostic::error(format!("{name} is always a number"), span)
                .help("it is an integer on the wire, which cannot be NaN"));
        }
        _ => SensorFault::Late(words.seconds()?),
    };
    Ok(Action::Sensor(quantity, fault, words.for_seconds()?))
}

/// `state ultrasound-deaf for 3`, `minor 6 for 3`
fn claim(word: &str, words: &mut Words<'_>) -> Result<Action, Diagnostic> {
    if word == "minor" {
        let minor = words.whole("a minor control state", &(0..=u16::MAX))?;
        return Ok(Action::Minor(minor, words.for_seconds()?));
    }
    let (name, span) = words.next("a state")?;
    let bits = DroneState::from_name(&name.to_uppercase().replace('-', "_"));
    let Some(bits) = bits else {
        let names: Vec<String> = DroneState::all()
            .iter_names()
            .map(|(name, _)| name.to_lowercase().replace('_', "-"))
            .collect();
        return Err(Diagnostic::error(format!("unknown state `{name}`"), span)
            .help(format!("one of {}", names.join(", "))));
    };
    Ok(Action::State(bits, words.for_seconds()?))
}

/// The words of a line, with their positions in the text.
struct Words<'a> {
    all: Vec<(&'a str, Span)>,
    next: usize,
    end: usize,
}

impl<'a> Words<'a> {
    fn new(line: &'a str, start: usize) -> Self {
        let content = line.split('#').next().unwrap_or_default();
        let words = content.split_whitespace().map(|word| {
            // Each word is a slice of its line.
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

    fn whole<N: FromStr + PartialOrd + std::fmt::Display>(
        &mut self,
        expected: &str,
        range: &RangeInclusive<N>,
    ) -> Result<N, Diagnostic> {
        let (word, span) = self.next(expected)?;
        word.parse().ok().filter(|number| range.contains(number)).ok_or_else(|| {
            let message = format!("expected {expected}, found `{word}`");
            Diagnostic::error(message, span).help(format!(
                "a whole number from {} to {}",
                range.start(),
                range.end()
            ))
        })
    }

    /// A percentage, as a fraction.
    fn share(&mut self) -> Result<f64, Diagnostic> {
        Ok(self.number("a percentage", 0.0, 100.0)? / 100.0)
    }

    fn seconds(&mut self) -> Result<Duration, Diagnostic> {
        self.number("seconds", 0.0, 3600.0).map(Duration::from_secs_f64)
    }

    /// `for 3`
    fn for_seconds(&mut self) -> Result<Duration, Diagnostic> {
        if !self.take("for") {
            self.next("`for` and seconds").and_then(|(word, span)| {
                Err(Diagnostic::error(format!("expected `for`, found `{word}`"), span))
            })?;
        }
        self.seconds()
    }

    fn milliseconds(&mut self) -> Result<Duration, Diagnostic> {
        let milliseconds = self.number("milliseconds", 0.0, 10_000.0)?;
        Ok(Duration::from_secs_f64(milliseconds / 1000.0))
    }

    /// (right, forward)
    fn velocity(&mut self) -> Result<Vector2<f64>, Diagnostic> {
        let right = self.number("metres a second", -30.0, 30.0)?;
        let forward = self.number("metres a second", -30.0, 30.0)?;
        Ok(Vector2::new(right, forward))
    }

    /// `1 -0.5 90`: right, forward, heading.
    fn tag(&mut self) -> Result<FloorTag, Diagnostic> {
        let right_m = self.number("metres", -100.0, 100.0)?;
        let forward_m = self.number("metres", -100.0, 100.0)?;
        let heading_deg =
            if self.peek().is_some() { self.number("degrees", -360.0, 360.0)? } else { 0.0 };
        Ok(FloorTag::new(right_m, forward_m, heading_deg))
    }

    fn direction(&mut self) -> Direction {
        if self.take("up") {
            Direction::Up
        } else if self.take("down") {
            Direction::Down
        } else {
            Direction::Both
        }
    }

    fn quantity(&mut self) -> Result<(Quantity, &'a str, Span), Diagnostic> {
        let (word, span) = self.next("a quantity in navdata")?;
        let Some((_, quantity)) = QUANTITIES.iter().find(|(name, _)| *name == word) else {
            let names = QUANTITIES.map(|(name, _)| name).join(", ");
            let message = format!("unknown quantity `{word}`");
            return Err(Diagnostic::error(message, span).help(format!("one of {names}")));
        };
        Ok((*quantity, word, span))
    }

    fn video_fault(&mut self) -> Result<VideoFault, Diagnostic> {
        let (word, span) = self.next("a fault of the video")?;
        let fault = VIDEO_FAULTS.iter().find(|(name, _)| *name == word).map(|(_, fault)| *fault);
        fault.ok_or_else(|| {
            let names = VIDEO_FAULTS.map(|(name, _)| name).join(", ");
            let message = format!("unknown fault of the video `{word}`");
            Diagnostic::error(message, span).help(format!("one of {names}"))
        })
    }

    /// A value of a quantity, or its change.
    fn value(&mut self, quantity: Quantity) -> Result<f64, Diagnostic> {
        match quantity {
            Quantity::VelocityRight | Quantity::VelocityForward => {
                self.number("metres a second", -30.0, 30.0)
            }
            Quantity::Altitude => self.number("metres", -100.0, 100.0),
            Quantity::Yaw | Quantity::Roll | Quantity::Pitch => {
                self.number("degrees", -180.0, 180.0)
            }
            Quantity::Clock => self.number("seconds", -2048.0, 2048.0),
        }
    }
}
