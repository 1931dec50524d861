//! The client's side of the video connection.

use std::collections::VecDeque;
use std::time::Duration;

use super::continuity::Continuity;
use super::reader::{Picture, Reader};

/// Pause between two attempts to connect.
const PAUSE: Duration = Duration::from_secs(1);
/// A connection on which nothing arrives for this time is closed and opened again.
const SILENCE: Duration = Duration::from_secs(2);
/// Time for connecting.
const CONNECTING: Duration = Duration::from_secs(2);

/// What the connection does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Input<'a> {
    /// It is open.
    Opened,
    /// Bytes arrived.
    Received(&'a [u8]),
    /// It could not be opened, or has ended.
    Closed,
    /// Nothing, but time passes.
    Tick,
}

/// What to do.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Output {
    /// Open a connection.
    Open,
    /// Close it, or give up opening it. The answer is not [`Input::Closed`].
    Close,
    /// A picture that can be shown after all those before it.
    Picture(Picture),
    /// Something that a person may want to know.
    Event(VideoEvent),
}

/// An event of the video stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum VideoEvent {
    /// The first picture since the beginning, or since [`VideoEvent::Lost`].
    Begun,
    /// No more pictures: the connection ended, or nothing arrives.
    Lost,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    /// Since then no connection; another attempt follows.
    Pause { since: Duration },
    /// Since then a connection is being opened.
    Opening { since: Duration },
    /// Open; the last bytes arrived then.
    Open { heard: Duration },
}

/// Keeps the stream alive: connects, reconnects after silence or an end, and passes on what can be shown.
///
/// It is driven like the session: [`Self::handle`] for each input, then [`Self::poll`] until it returns `None`. An
/// [`Input::Tick`] every 100 ms is enough.
#[derive(Debug)]
pub struct VideoSession {
    phase: Phase,
    reader: Reader,
    continuity: Continuity,
    is_shown: bool,
    left_out: u64,
    outputs: VecDeque<Output>,
}

impl Default for VideoSession {
    fn default() -> Self {
        Self::new(Duration::ZERO)
    }
}

impl VideoSession {
    /// A session that connects at once.
    pub fn new(now: Duration) -> Self {
        Self {
            phase: Phase::Opening { since: now },
            reader: Reader::default(),
            continuity: Continuity::default(),
            is_shown: false,
            left_out: 0,
            outputs: VecDeque::from([Output::Open]),
        }
    }

    /// Takes an input. `now` is the time since any fixed moment, the same as in [`Self::new`].
    pub fn handle(&mut self, now: Duration, input: Input<'_>) {
        match input {
            Input::Opened => {
                if let Phase::Opening { .. } = self.phase {
                    self.phase = Phase::Open { heard: now };
                }
            }
            Input::Received(bytes) => {
                if let Phase::Open { heard } = &mut self.phase {
                    *heard = now;
                    self.read(bytes);
                }
            }
            Input::Closed => self.pause(now),
            Input::Tick => {}
        }
        self.watch_the_time(now);
    }

    /// The next thing to do.
    pub fn poll(&mut self) -> Option<Output> {
        self.outputs.pop_front()
    }

    /// Pictures that could not be shown, because one that they depend on is missing.
    pub fn left_out(&self) -> u64 {
        self.left_out
    }

    /// Bytes that belonged to no picture.
    pub fn garbage_bytes(&self) -> u64 {
        self.reader.garbage_bytes()
    }

    fn read(&mut self, bytes: &[u8]) {
        self.reader.push(bytes);
        while let Some(picture) = self.reader.next() {
            if !self.continuity.passes(&picture) {
                self.left_out += 1;
                continue;
            }
            if !std::mem::replace(&mut self.is_shown, true) {
                self.outputs.push_back(Output::Event(VideoEvent::Begun));
            }
            self.outputs.push_back(Output::Picture(picture));
        }
    }

    fn watch_the_time(&mut self, now: Duration) {
        let since = |then: Duration| now.saturating_sub(then);
        match self.phase {
            Phase::Pause { since: then } if since(then) >= PAUSE => {
                self.phase = Phase::Opening { since: now };
                self.outputs.push_back(Output::Open);
            }
            Phase::Opening { since: then } if since(then) >= CONNECTING => self.close(now),
            Phase::Open { heard } if since(heard) >= SILENCE => self.close(now),
            _ => {}
        }
    }

    fn close(&mut self, now: Duration) {
        self.outputs.push_back(Output::Close);
        self.pause(now);
    }

    fn pause(&mut self, now: Duration) {
        if let Phase::Pause { .. } = self.phase {
            return;
        }
        self.phase = Phase::Pause { since: now };
        // The rest of a picture does not come on the next connection.
        self.reader.restart();
        self.continuity.interrupt();
        if std::mem::take(&mut self.is_shown) {
            self.outputs.push_back(Output::Event(VideoEvent::Lost));
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const LONG: &[u8] = include_bytes!("../../../tests/fixtures/video/pave.bin");

    const fn at(milliseconds: u64) -> Duration {
        Duration::from_millis(milliseconds)
    }

    /// Outputs, with the numbers of the pictures.
    fn outputs(session: &mut VideoSession) -> String {
        let word = |output: Output| match output {
            Output::Picture(picture) => picture.header.number.to_string(),
            Output::Event(event) => format!("{event:?}"),
            other => format!("{other:?}"),
        };
        std::iter::from_fn(|| session.poll()).map(word).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn pictures_begin_with_a_key_picture() {
        let mut session = VideoSession::default();
        assert_eq!(outputs(&mut session), "Open");
        session.handle(at(10), Input::Opened);
        session.handle(at(20), Input::Received(&LONG[..40_000]));
        assert_eq!(outputs(&mut session), "Begun 17565 17566 17567 17568");
        session.handle(at(30), Input::Received(&LONG[40_000..]));
        assert!(outputs(&mut session).starts_with("17569 17570 "));
        assert_eq!(session.left_out(), 3);
    }

    #[test]
    fn it_connects_again_after_an_end_and_after_silence() {
        let mut session = VideoSession::default();
        let mut step = |time: u64, input: Input<'_>| {
            session.handle(at(time), input);
            outputs(&mut session)
        };
        // Refused; then a server that accepts and sends nothing.
        assert_eq!(step(5, Input::Closed), "Open");
        assert_eq!(step(900, Input::Tick), "");
        assert_eq!(step(1005, Input::Tick), "Open");
        assert_eq!(step(1010, Input::Opened), "");
        assert_eq!(step(3009, Input::Tick), "");
        assert_eq!(step(3010, Input::Tick), "Close");
        // A drone that does not answer.
        assert_eq!(step(4010, Input::Tick), "Open");
        assert_eq!(step(6010, Input::Tick), "Close");
        assert_eq!(step(7010, Input::Tick), "Open");
        assert_eq!(step(7020, Input::Opened), "");
        let shown = step(7030, Input::Received(LONG));
        assert!(shown.starts_with("Begun 17565"), "{shown}");
        assert_eq!(step(7100, Input::Closed), "Lost");
        assert_eq!(step(7110, Input::Closed), "");
        assert_eq!(step(8110, Input::Tick), "Open");
        // Nothing is received before it is open.
        assert_eq!(step(8120, Input::Received(LONG)), "");
        assert_eq!(step(8130, Input::Opened), "");
        // The picture that was cut in half does not disturb.
        assert_eq!(step(8140, Input::Received(&LONG[..5000])), "");
        assert_eq!(step(8150, Input::Closed), "");
        assert_eq!(step(9150, Input::Tick), "Open");
        step(9160, Input::Opened);
        assert!(step(9170, Input::Received(LONG)).starts_with("Begun 17565"));
    }

    proptest! {
        /// Whatever happens in whatever order, there is at most one connection, and it is tried again.
        #[test]
        fn connections_are_opened_one_at_a_time(steps in prop::collection::vec((0_u64..900, 0..5), 1..200)) {
            let mut session = VideoSession::default();
            prop_assert_eq!(session.poll(), Some(Output::Open));
            let (mut now, mut is_open) = (0, true);
            for (later, input) in steps {
                now += later;
                let input = match input {
                    0 => Input::Opened,
                    1 => Input::Received(LONG),
                    2 => Input::Received(b"PaVE garbage"),
                    3 => Input::Closed,
                    _ => Input::Tick,
                };
                is_open &= input != Input::Closed;
                session.handle(at(now), input);
                while let Some(output) = session.poll() {
                    match output {
                        Output::Open => prop_assert!(!std::mem::replace(&mut is_open, true)),
                        Output::Close => prop_assert!(std::mem::replace(&mut is_open, false)),
                        _ => {}
                    }
                }
            }
            for _ in 0..40 {
                now += 100;
                session.handle(at(now), Input::Tick);
                while let Some(output) = session.poll() {
                    is_open |= output == Output::Open;
                }
            }
            prop_assert!(is_open);
        }
    }
}
