//! Lines of text that the agents of vehicles on different machines say to each other.
//!
//! The side of a vehicle ([`Talk`]) never waits, and allocates nothing: both directions are bounded queues. What does not fit is
//! dropped, the newest first, and counted.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use arrayvec::ArrayString;
use autopilot::vehicle::VehicleName;
use crossbeam_channel::{Receiver, Sender, TrySendError, bounded};

use super::refused::Refused;
use super::roster::Roster;

/// Longest line.
pub const LONGEST_LINE_BYTES: usize = 512;
/// Most lines that wait, in each direction, for each vehicle.
pub const WAITING: usize = 64;

/// A line from one vehicle's agent to another's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Line {
    /// Who says it.
    pub from: VehicleName,
    /// To whom.
    pub to: VehicleName,
    /// It, without the end of the line.
    pub text: ArrayString<LONGEST_LINE_BYTES>,
}

/// Why a text is no line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NoLine {
    /// It is too long.
    #[error("an agent's line has at most {LONGEST_LINE_BYTES} bytes")]
    TooLong,
    /// It is empty, or has control characters.
    #[error("an agent's line is one line of text, which is not empty")]
    NotOneLine,
}

/// Why a line was not taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LineError {
    /// It is none.
    #[error(transparent)]
    NoLine(#[from] NoLine),
    /// Too many wait; this one is dropped, and counted.
    #[error("{WAITING} lines of this vehicle's agent wait for the network already")]
    Full,
    /// The network has been left.
    #[error("the network has been left")]
    Left,
}

fn line(text: &str) -> Result<ArrayString<LONGEST_LINE_BYTES>, NoLine> {
    let line = ArrayString::from(text).map_err(|_| NoLine::TooLong)?;
    if text.is_empty() || text.chars().any(char::is_control) {
        return Err(NoLine::NotOneLine);
    }
    Ok(line)
}

/// A vehicle's side: what its agent says, and what is said to it.
#[derive(Debug)]
pub struct Talk {
    vehicle: VehicleName,
    said: Sender<Line>,
    heard: Receiver<Line>,
    unsaid: u64,
    dropped: Arc<AtomicU64>,
}

impl Talk {
    /// Says something to another vehicle's agent.
    ///
    /// # Errors
    /// [`LineError`] if it is no line, or cannot be taken.
    pub fn say(&mut self, to: VehicleName, text: &str) -> Result<(), LineError> {
        let said = Line { from: self.vehicle, to, text: line(text)? };
        self.said.try_send(said).map_err(|error| match error {
            TrySendError::Full(_) => {
                self.unsaid += 1;
                LineError::Full
            }
            TrySendError::Disconnected(_) => LineError::Left,
        })
    }

    /// The next line that was said to this vehicle's agent.
    pub fn next_line(&self) -> Option<Line> {
        self.heard.try_recv().ok()
    }

    /// How many lines were dropped: those that it wanted to say, and those that were said to it.
    pub fn dropped(&self) -> [u64; 2] {
        [self.unsaid, self.dropped.load(Ordering::Relaxed)]
    }
}

/// The network's side of what one vehicle's agent hears.
#[derive(Debug)]
pub struct Inbox {
    vehicle: VehicleName,
    heard: Sender<Line>,
    dropped: Arc<AtomicU64>,
}

/// The network's side of what one vehicle's agent says.
pub type Outbox = Receiver<Line>;

impl Inbox {
    /// Both sides of one vehicle.
    pub fn new(vehicle: VehicleName) -> (Self, Outbox, Talk) {
        let ((said, outbox), (heard, inbox)) = (bounded(WAITING), bounded(WAITING));
        let dropped = Arc::<AtomicU64>::default();
        let talk = Talk { vehicle, said, heard: inbox, unsaid: 0, dropped: Arc::clone(&dropped) };
        (Self { vehicle, heard, dropped }, outbox, talk)
    }

    /// Something arrives at the key of a line.
    ///
    /// # Errors
    /// [`Refused`], with who is said to have said it, if it is no line of a vehicle elsewhere to this one, or does not fit.
    pub fn take(
        &self,
        roster: &Roster,
        key: &str,
        text: &[u8],
    ) -> Result<(), (Option<VehicleName>, Refused)> {
        let [from, to] = roster.of_line_key(key).ok_or((None, Refused::Key))?;
        let Some(place) = roster.place(from) else { return Err((None, Refused::Unknown)) };
        let refused = |why| (Some(from), why);
        if to != self.vehicle {
            return Err(refused(Refused::Key));
        }
        if roster.vehicles[place].is_here {
            return Err(refused(Refused::FlownHere));
        }
        if text.len() > LONGEST_LINE_BYTES {
            return Err(refused(Refused::TooLong));
        }
        let text = std::str::from_utf8(text).map_err(|_| refused(Refused::Malformed))?;
        let text = line(text).map_err(|_| refused(Refused::Malformed))?;
        // The vehicle may have left; then nobody misses it.
        if let Err(TrySendError::Full(_)) = self.heard.try_send(Line { from, to, text }) {
            self.dropped.fetch_add(1, Ordering::Relaxed);
            return Err(refused(Refused::Full));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::roster::tests::two;
    use super::*;

    const KEY: &str = "ardrone/two/right/agent/left";

    fn left() -> VehicleName {
        "left".parse().unwrap()
    }

    fn right() -> VehicleName {
        "right".parse().unwrap()
    }

    #[test]
    fn lines_go_both_ways_in_order() {
        let (inbox, outbox, mut talk) = Inbox::new(left());
        assert_eq!(talk.next_line(), None);
        for text in ["tell held(3)", "\u{e4}"] {
            talk.say(right(), text).unwrap();
            let said = outbox.try_recv().unwrap();
            assert_eq!((said.from, said.to, said.text.as_str()), (left(), right(), text));
            inbox.take(&two(&["left"]), KEY, text.as_bytes()).unwrap();
            let heard = talk.next_line().unwrap();
            assert_eq!((heard.from, heard.to, heard.text.as_str()), (right(), left(), text));
        }
    }

    #[test]
    fn what_is_no_line_is_refused_both_ways() {
        let (inbox, outbox, mut talk) = Inbox::new(left());
        let longest = "x".repeat(LONGEST_LINE_BYTES);
        assert_eq!(talk.say(right(), &longest), Ok(()));
        assert_eq!(outbox.len(), 1);
        assert_eq!(talk.say(right(), &(longest.clone() + "x")), Err(NoLine::TooLong.into()));
        for text in ["", "a\nb", "a\u{1b}[2J", "a\u{9b}"] {
            assert_eq!(talk.say(right(), text), Err(NoLine::NotOneLine.into()), "{text:?}");
        }
        let roster = two(&["left"]);
        let take = |key: &str, text: &[u8]| inbox.take(&roster, key, text).map_err(|(_, why)| why);
        assert_eq!(take(KEY, longest.as_bytes()), Ok(()));
        assert_eq!(take(KEY, (longest + "x").as_bytes()), Err(Refused::TooLong));
        for text in [&b""[..], b"a\n", b"\xff"] {
            assert_eq!(take(KEY, text), Err(Refused::Malformed));
        }
        for (key, why) in [
            ("ardrone/two/left/agent/right", Refused::Key),
            ("ardrone/two/left/agent/left", Refused::FlownHere),
            ("ardrone/two/up/agent/left", Refused::Unknown),
            ("ardrone/two/right/state", Refused::Key),
        ] {
            assert_eq!(take(key, b"a"), Err(why), "{key}");
        }
        assert!(talk.next_line().is_some() && talk.next_line().is_none());
    }

    #[test]
    fn the_newest_lines_are_dropped_and_counted() {
        let (inbox, outbox, mut talk) = Inbox::new(left());
        let roster = two(&["left"]);
        for number in 0..WAITING + 3 {
            let text = number.to_string();
            assert_eq!(talk.say(right(), &text).is_ok(), number < WAITING);
            assert_eq!(inbox.take(&roster, KEY, text.as_bytes()).is_ok(), number < WAITING);
        }
        assert_eq!(talk.dropped(), [3, 3]);
        assert_eq!(outbox.try_recv().unwrap().text.as_str(), "0");
        assert_eq!(talk.next_line().unwrap().text.as_str(), "0");
        drop(outbox);
        assert_eq!(talk.say(right(), "a"), Err(LineError::Left));
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in proptest::collection::vec(any::<u8>(), 0..600), key in ".{0,40}") {
            let (inbox, _outbox, talk) = Inbox::new(left());
            let taken = [KEY, key.as_str()].map(|key| inbox.take(&two(&["left"]), key, &bytes));
            prop_assert_eq!(taken[0].is_ok(), talk.next_line().is_some());
        }
    }
}
