//! Texts for people: `STATUSTEXT`.

use std::collections::VecDeque;
use std::fmt;
use std::fmt::Write as _;

use arrayvec::ArrayString;
use autopilot::vehicle::{FlightEvent, LandingReason};
use mavlink_core::types::CharArray;

use crate::dialect::{MavMessage, MavSeverity, STATUSTEXT_DATA};

/// Texts that may wait; older ones are more important than what comes in a flood.
const WAITING: usize = 16;
/// Bytes of one `STATUSTEXT`.
const CHUNK: usize = 50;
/// Bytes of a text: four chunks.
const LONGEST: usize = 4 * CHUNK;

/// How important an event is. QGroundControl shows what is at least an error; of a warning a red icon is all that is seen.
pub(crate) fn severity(event: &FlightEvent) -> MavSeverity {
    match event {
        FlightEvent::LandingOrdered(LandingReason::Operator) => MavSeverity::MAV_SEVERITY_INFO,
        FlightEvent::Emergency
        | FlightEvent::LinkLost
        | FlightEvent::CutOrdered
        | FlightEvent::LandingOrdered(_) => MavSeverity::MAV_SEVERITY_CRITICAL,
        // The drone does not what it was told to, or soon will not.
        FlightEvent::BatteryLow { .. }
        | FlightEvent::FlownByAnother
        | FlightEvent::ControlsTaken { .. }
        | FlightEvent::SetpointsSilent
        | FlightEvent::PausedForStation
        | FlightEvent::PlaceContradicted { .. } => MavSeverity::MAV_SEVERITY_ERROR,
        event if event.warns() => MavSeverity::MAV_SEVERITY_WARNING,
        _ => MavSeverity::MAV_SEVERITY_INFO,
    }
}

/// A queue of texts. It does not allocate once it was created.
#[derive(Debug)]
pub(crate) struct Texts {
    waiting: VecDeque<(MavSeverity, ArrayString<LONGEST>)>,
    /// Number of the next text with several chunks; 0 means one chunk.
    id: u16,
    /// Chunks of the first text that have been sent.
    sent: usize,
}

impl Default for Texts {
    fn default() -> Self {
        Self { waiting: VecDeque::with_capacity(WAITING), id: 1, sent: 0 }
    }
}

/// Cuts what is too long, at a character.
struct Cut<'a>(&'a mut ArrayString<LONGEST>);

impl fmt::Write for Cut<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for character in text.chars() {
            if self.0.try_push(character).is_err() {
                return Err(fmt::Error);
            }
        }
        Ok(())
    }
}

impl Texts {
    /// Queues a text; dropped if too many wait, or the very same.
    pub(crate) fn say(&mut self, severity: MavSeverity, text: fmt::Arguments<'_>) {
        if self.waiting.len() >= WAITING {
            return;
        }
        let mut cut = ArrayString::new();
        // An error means that it was cut.
        _ = Cut(&mut cut).write_fmt(text);
        if self.waiting.contains(&(severity, cut)) {
            return;
        }
        self.waiting.push_back((severity, cut));
    }

    /// The next message, if a text waits.
    pub(crate) fn next(&mut self) -> Option<MavMessage> {
        let (severity, text) = self.waiting.front()?;
        let bytes = text.as_bytes();
        let chunks = bytes.len().div_ceil(CHUNK).max(1);
        let from = self.sent * CHUNK;
        let part = bytes.get(from..bytes.len().min(from + CHUNK)).unwrap_or_default();
        let mut chunk = [0; CHUNK];
        chunk.iter_mut().zip(part).for_each(|(to, from)| *to = *from);
        let message = MavMessage::STATUSTEXT(STATUSTEXT_DATA {
            severity: *severity,
            text: CharArray::new(chunk),
            id: if chunks > 1 { self.id } else { 0 },
            chunk_seq: u8::try_from(self.sent).unwrap_or(u8::MAX),
        });
        self.sent += 1;
        // A text of full chunks ends with an empty one.
        let full = chunks > 1 && bytes.len().is_multiple_of(CHUNK);
        if self.sent >= chunks + usize::from(full) {
            self.sent = 0;
            self.id = if chunks > 1 { self.id.wrapping_add(1).max(1) } else { self.id };
            self.waiting.pop_front();
        }
        Some(message)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(texts: &mut Texts) -> Vec<(String, u16, u8)> {
        std::iter::from_fn(|| texts.next())
            .map(|message| {
                let MavMessage::STATUSTEXT(text) = message else { panic!("{message:?}") };
                (text.text.to_str().unwrap().to_owned(), text.id, text.chunk_seq)
            })
            .collect()
    }

    #[test]
    fn a_long_text_comes_in_chunks_and_a_short_one_alone() {
        let mut texts = Texts::default();
        texts.say(MavSeverity::MAV_SEVERITY_INFO, format_args!("landed"));
        let long = "x".repeat(60);
        texts.say(MavSeverity::MAV_SEVERITY_INFO, format_args!("{long}"));
        let said = said(&mut texts);
        assert_eq!(said[0], ("landed".to_owned(), 0, 0));
        assert_eq!(said[1], ("x".repeat(50), 1, 0));
        assert_eq!(said[2], ("x".repeat(10), 1, 1));
        assert_eq!(said.len(), 3);
    }

    #[test]
    fn floods_and_endless_texts_are_cut() {
        let mut texts = Texts::default();
        let endless = "ä".repeat(1000);
        for number in 0..100 {
            texts.say(MavSeverity::MAV_SEVERITY_INFO, format_args!("{number:02}{endless}"));
            texts.say(MavSeverity::MAV_SEVERITY_INFO, format_args!("{number:02}{endless}"));
        }
        assert_eq!(said(&mut texts).len(), WAITING * 5);
    }
}
