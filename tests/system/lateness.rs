//! How late the machine itself is, measured beside a test in real time, so that a limit on the time of a program
//! is not a limit on the speed of the machine.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Measures until it is asked for its result.
pub(crate) struct Lateness {
    over: Arc<AtomicBool>,
    thread: JoinHandle<Duration>,
}

impl Lateness {
    pub(crate) fn measure() -> Self {
        let over = Arc::new(AtomicBool::new(false));
        let thread = std::thread::spawn({
            let over = Arc::clone(&over);
            move || until(&over)
        });
        Self { over, thread }
    }

    /// The longest delay with which a thread that only sleeps woke up.
    pub(crate) fn worst(self) -> Duration {
        self.over.store(true, Ordering::Relaxed);
        self.thread.join().unwrap()
    }
}

fn until(over: &AtomicBool) -> Duration {
    const NAP: Duration = Duration::from_millis(10);
    let mut worst = Duration::ZERO;
    while !over.load(Ordering::Relaxed) {
        let before = Instant::now();
        std::thread::sleep(NAP);
        worst = worst.max(before.elapsed().saturating_sub(NAP));
    }
    worst
}
