//! What is printed while proofs run.

use std::io::{IsTerminal as _, Write as _};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use crate::prove::{End, Part, Watch};

/// Columns that any terminal has.
const COLUMNS: usize = 79;
/// Time between two updates of the line.
const UPDATE: Duration = Duration::from_millis(200);

/// Prints to standard error: on a terminal one line that changes, otherwise a line for each part that ended.
pub(super) struct Progress {
    shown: Shown,
    state: Mutex<State>,
    stopped: Arc<AtomicBool>,
}

#[derive(Clone, Copy, PartialEq)]
enum Shown {
    Nothing,
    Lines,
    Line,
}

struct State {
    begun: Instant,
    updated: Instant,
    ended: usize,
    of: usize,
    running: Vec<(Part, Instant)>,
}

impl Progress {
    /// `stopped` is the flag of [`super::stop::flag`].
    pub(super) fn new(quiet: bool, stopped: Arc<AtomicBool>) -> Self {
        let shown = match (quiet, std::io::stderr().is_terminal()) {
            (true, _) => Shown::Nothing,
            (false, true) => Shown::Line,
            (false, false) => Shown::Lines,
        };
        let now = Instant::now();
        let state = State { begun: now, updated: now, ended: 0, of: 0, running: Vec::new() };
        Self { shown, state: Mutex::new(state), stopped }
    }

    /// Removes the line.
    pub(super) fn close(&self) {
        if self.shown == Shown::Line {
            say("\r\x1b[K");
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Watch for Progress {
    fn begins(&self, part: &Part) {
        let mut state = self.state();
        if part.number == 0 {
            // Of another series of parts.
            state.ended = 0;
        }
        state.of = part.of;
        state.running.push((part.clone(), Instant::now()));
        if self.shown == Shown::Line {
            state.print();
        }
    }

    fn ends(&self, part: &Part, end: End, took: Duration) {
        let mut state = self.state();
        state.ended += 1;
        state.running.retain(|(running, _)| running != part);
        match self.shown {
            Shown::Nothing => {}
            Shown::Line => state.print(),
            Shown::Lines => say(&line(state.ended, part, end, took)),
        }
    }

    fn stops(&self) -> bool {
        if self.shown == Shown::Line {
            let mut state = self.state();
            if state.updated.elapsed() >= UPDATE {
                state.print();
            }
        }
        self.stopped.load(Ordering::Relaxed)
    }
}

impl State {
    fn print(&mut self) {
        self.updated = Instant::now();
        let running = self.running.iter().map(|(part, begun)| (part, begun.elapsed()));
        say(&format!("\r\x1b[K{}", status((self.ended, self.of), self.begun.elapsed(), running)));
    }
}

/// The line of a part that ended.
fn line(ended: usize, part: &Part, end: End, took: Duration) -> String {
    let end = match end {
        End::Proved => "proved",
        End::Open => "open",
        End::GivenUp => "given up",
    };
    format!("[{ended}/{}] {}: {end} ({:.1} s)\n", part.of, part.what, took.as_secs_f64())
}

/// The line of what runs, cut off where a terminal could end.
fn status<'a>(
    (ended, of): (usize, usize),
    time: Duration,
    running: impl Iterator<Item = (&'a Part, Duration)>,
) -> String {
    let parts = running.map(|(part, time)| format!("{} ({} s)", part.what, time.as_secs()));
    let parts: Vec<String> = parts.collect();
    let text = format!("[{ended}/{of}] {} s: {}", time.as_secs(), parts.join(", "));
    text.chars().take(COLUMNS).collect()
}

/// Prints; nobody needs it so much that the proof should end.
fn say(text: &str) {
    let mut stderr = std::io::stderr().lock();
    _ = stderr.write_all(text.as_bytes()).and_then(|()| stderr.flush());
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(what: &str) -> Part {
        Part { number: 2, of: 20, what: what.to_owned() }
    }

    #[test]
    fn a_part_that_ended_is_one_line() {
        let took = Duration::from_millis(1234);
        let said = line(3, &part("step: +!land pre-empts"), End::Proved, took);
        assert_eq!(said, "[3/20] step: +!land pre-empts: proved (1.2 s)\n");
        assert!(line(3, &part("the start"), End::GivenUp, took).contains("given up"));
    }

    #[test]
    fn a_terminal_shows_what_runs_in_one_line() {
        let (one, two) = (part("the start"), part("step: nothing happens"));
        let second = Duration::from_secs(1);
        let said = status((4, 20), second * 9, [(&one, second), (&two, second * 2)].into_iter());
        assert_eq!(said, "[4/20] 9 s: the start (1 s), step: nothing happens (2 s)");
        let long = part(&"x".repeat(200));
        assert_eq!(status((4, 20), second, [(&long, second)].into_iter()).len(), COLUMNS);
    }
}
