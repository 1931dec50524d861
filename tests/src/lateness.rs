//! How late the machine itself is, measured beside a program in real time, so that a limit on the time of the program
//! is not a limit on the speed of the machine.
#![expect(clippy::disallowed_methods, reason = "it measures")]

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use ardrone_pilot::realtime::Realtime;
use autopilot::vehicle::TICK;

/// Measures until it is asked for its result.
#[derive(Debug)]
pub struct Lateness {
    over: Arc<AtomicBool>,
    thread: JoinHandle<Vec<Duration>>,
}

impl Lateness {
    /// That of ordinary threads.
    pub fn measure() -> Self {
        Self::with(Duration::from_millis(10), || {})
    }

    /// That of a thread which is scheduled as the one of the ticks is, and wakes up as often.
    pub fn of_ticks() -> Self {
        Self::with(TICK, || _ = Realtime::acquire())
    }

    fn with(nap: Duration, prepare: impl FnOnce() + Send + 'static) -> Self {
        let over = Arc::new(AtomicBool::new(false));
        let thread = std::thread::spawn({
            let over = Arc::clone(&over);
            move || {
                prepare();
                until(&over, nap)
            }
        });
        Self { over, thread }
    }

    /// The delays with which a thread that only sleeps woke up.
    ///
    /// # Panics
    /// If the thread did.
    #[must_use]
    pub fn delays(self) -> Vec<Duration> {
        self.over.store(true, Ordering::Relaxed);
        self.thread.join().expect("the thread only sleeps, and remembers")
    }

    /// The longest of the delays.
    #[must_use]
    pub fn worst(self) -> Duration {
        self.delays().into_iter().max().unwrap_or_default()
    }
}

fn until(over: &AtomicBool, nap: Duration) -> Vec<Duration> {
    let mut delays = Vec::new();
    while !over.load(Ordering::Relaxed) {
        let before = Instant::now();
        std::thread::sleep(nap);
        delays.push(before.elapsed().saturating_sub(nap));
    }
    delays
}
