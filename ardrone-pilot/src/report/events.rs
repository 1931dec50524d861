//! Everything that happened in a flight, in the order of time: what was told, orders, decisions, what was believed, and what the
//! drone said of itself.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::time::Duration;

use diagnostic::printable;
use mission_agent::SAID_AGAIN_WITHIN;
use serde::Serialize;

use super::rows::Row;
use super::spans::{Level, Strip};
use super::words::{self, spoken};
use crate::recording::{AgentMessage, Entry, Log};

/// Most events of a page.
const MOST_EVENTS: usize = 3000;
/// Maximum length of an event's text.
const LONGEST_TEXT: usize = 400;
/// Orders that repeat themselves are one event while they follow each other within this time.
const REPEATED_WITHIN: Duration = Duration::from_secs(1);

/// What an event is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Kind {
    /// What the operators were told.
    Event,
    /// One that warns.
    Warning,
    /// An operator's order.
    Order,
    /// What a mission agent said to that of another vehicle, or heard from it.
    Message,
    /// What the agent ordered the drone to do.
    Decision,
    /// A danger that the agent reported, or a veto of the safety monitor.
    Danger,
    /// What is believed of navdata has changed.
    Belief,
    /// What the drone says of itself has changed.
    Drone,
}

impl Kind {
    /// For people.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Event => "event",
            Self::Warning => "warning",
            Self::Order => "order",
            Self::Message => "message",
            Self::Decision => "agent",
            Self::Danger => "danger",
            Self::Belief => "navdata",
            Self::Drone => "drone",
        }
    }

    /// Whether something is wrong.
    pub(super) fn warns(self) -> bool {
        matches!(self, Self::Warning | Self::Danger)
    }
}

/// Something that happened.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Event {
    /// Seconds since the recording's start.
    pub(super) at_s: f64,
    pub(super) kind: Kind,
    /// Printable, in one line.
    pub(super) text: String,
}

impl Event {
    fn new(at_s: f64, kind: Kind, text: &str) -> Self {
        let text: String = text.chars().take(LONGEST_TEXT).collect();
        Self { at_s, kind, text: printable(&text).into_owned() }
    }
}

/// All events of a part of a recording.
pub(super) fn events(
    log: &Log,
    (from, until): (Duration, Duration),
    rows: &[Row<'_>],
    beliefs: &[Strip],
    states: &[Strip],
) -> Vec<Event> {
    let mut events = Vec::new();
    let mut repeated: Option<(Duration, String)> = None;
    let mut messages = Messages::new(log.vehicle.as_str());
    for (at, entry) in log.entries.iter().filter(|(at, _)| (from..=until).contains(at)) {
        let at_s = at.as_secs_f64();
        let kind = |warns: bool| if warns { Kind::Warning } else { Kind::Event };
        match entry {
            Entry::Event { warns, text } => events.push(Event::new(at_s, kind(*warns), text)),
            Entry::Outcome { warns, text } => {
                events.push(Event::new(at_s, kind(*warns), &format!("outcome: {text}")));
            }
            Entry::Message(message) => messages.take_in(&mut events, *at, message),
            Entry::Order(order) => {
                let text = order.text();
                let again = repeated.take().is_some_and(|(last, of)| {
                    of == text && at.saturating_sub(last) <= REPEATED_WITHIN
                });
                if order.repeats() {
                    repeated = Some((*at, text.clone()));
                }
                if !again {
                    events.push(Event::new(at_s, Kind::Order, &text));
                }
            }
            _ => {}
        }
    }
    messages.end(&mut events);
    decisions(&mut events, rows);
    for strip in beliefs {
        changes(&mut events, strip, Kind::Belief, Level::Wrong);
    }
    for strip in states {
        changes(&mut events, strip, Kind::Drone, Level::Plain);
    }
    events.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
    events.truncate(MOST_EVENTS);
    events
}

/// Messages of mission agents. One that is said again and again, with other numbers perhaps, is one event.
struct Messages<'a> {
    /// The vehicle whose log it is.
    vehicle: &'a str,
    /// By whom it is said or heard, and what without its numbers.
    last: BTreeMap<String, Repeated>,
}

/// A message that is said again and again.
struct Repeated {
    /// The index of its event.
    event: usize,
    last: Duration,
    count: u32,
}

impl<'a> Messages<'a> {
    fn new(vehicle: &'a str) -> Self {
        Self { vehicle, last: BTreeMap::new() }
    }

    fn take_in(&mut self, events: &mut Vec<Event>, at: Duration, message: &AgentMessage<'_>) {
        let text = match message.parts() {
            Some((from, text)) if from == self.vehicle => format!("to {}: {text}", message.to),
            Some((from, text)) => format!("from {from}: {text}"),
            None => format!("to {}: {}", message.to, message.line),
        };
        let kind = mission_agent::kind(&text).to_owned();
        if let Some(said) = self.last.get_mut(&kind)
            && at.saturating_sub(said.last) < SAID_AGAIN_WITHIN
        {
            (said.last, said.count) = (at, said.count.saturating_add(1));
            return;
        }
        self.end_of(events, &kind);
        self.last.insert(kind, Repeated { event: events.len(), last: at, count: 1 });
        events.push(Event::new(at.as_secs_f64(), Kind::Message, &text));
    }

    /// Says how often a message was said that is not said again.
    fn end_of(&mut self, events: &mut [Event], kind: &str) {
        let Some(Repeated { event, last, count }) = self.last.remove(kind) else { return };
        if let (Some(event), 2..) = (events.get_mut(event), count) {
            // Writing to a string cannot fail.
            _ = write!(event.text, ", {count} times until {:.1} s", last.as_secs_f64());
        }
    }

    fn end(mut self, events: &mut [Event]) {
        let kinds: Vec<String> = self.last.keys().cloned().collect();
        for kind in &kinds {
            self.end_of(events, kind);
        }
    }
}

/// What the agent ordered, and what it or the safety monitor said, when it changed.
fn decisions(events: &mut Vec<Event>, rows: &[Row<'_>]) {
    let (mut command, mut danger, mut veto) = (None, None, None);
    for row in rows {
        let agent = &row.tick.agent;
        if command.replace(agent.command.as_str()).is_some_and(|last| last != agent.command) {
            let because = agent.plans.first().map(|plan| format!(" (line {})", plan.line));
            let text = format!("{}{}", spoken(&agent.command), because.unwrap_or_default());
            events.push(Event::new(row.at_s, Kind::Decision, &text));
        }
        if agent.danger != danger {
            danger.clone_from(&agent.danger);
            if let Some(danger) = &danger {
                events.push(Event::new(row.at_s, Kind::Danger, &words::danger(danger)));
            }
        }
        if row.tick.veto != veto {
            veto.clone_from(&row.tick.veto);
            let text = match &veto {
                Some(veto) => words::veto(veto),
                None => words::NO_VETO.to_owned(),
            };
            events.push(Event::new(row.at_s, Kind::Danger, &text));
        }
    }
}

/// The beginnings of a strip's spans that are at least this serious, and what follows them.
fn changes(events: &mut Vec<Event>, strip: &Strip, kind: Kind, least: Level) {
    let serious = |level: Level| level as u8 >= least as u8;
    let mut last: Option<Level> = None;
    for span in &strip.spans {
        let follows = last.replace(span.level).is_some_and(serious);
        if serious(span.level) || follows {
            let text = format!("{}: {}", strip.name, span.text);
            events.push(Event::new(span.from_s, kind, &text));
        }
    }
}
