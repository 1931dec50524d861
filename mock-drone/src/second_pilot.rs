//! Another client of the same drone, which keeps commanding it to hover.

use std::time::Duration;

use ardrone_link::at::{Command, Datagram, Motion, Ref};

/// Same period as the autopilot's.
const PERIOD: Duration = Duration::from_millis(30);

/// A client with its own sequence numbers, which receives nothing.
#[derive(Debug, Clone)]
pub(crate) struct SecondPilot {
    next: Duration,
    ends: Duration,
    sequence: u32,
}

impl SecondPilot {
    /// A client that sends from `now` on, for `time`; `sequence` numbers its first command.
    pub(crate) fn new(now: Duration, time: Duration, sequence: u32) -> Self {
        Self { next: now, ends: now + time, sequence }
    }

    /// When it sends next; `None` when it has finished.
    pub(crate) fn next_due(&self) -> Option<Duration> {
        (self.next < self.ends).then_some(self.next)
    }

    /// Its datagram at `now`.
    pub(crate) fn datagram(&mut self, now: Duration) -> Option<Datagram> {
        self.next_due().filter(|due| *due <= now)?;
        self.next += PERIOD;
        let mut datagram = Datagram::new();
        for command in [Command::Ref(Ref::TakeOff), Command::Pcmd(Motion::Hover)] {
            // Two commands are much shorter than a datagram may be.
            datagram.push(self.sequence, &command).ok()?;
            self.sequence = self.sequence.wrapping_add(1);
        }
        Some(datagram)
    }
}
