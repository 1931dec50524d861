//! Evaluates the errors of a datagram socket, for a conversation that must survive them.

use std::io::{Error, ErrorKind};
use std::time::Duration;

/// Duration of errors after which the socket itself is considered broken and is reopened.
const PATIENCE: Duration = Duration::from_millis(300);
/// A problem is reported again if there was none for this time.
const QUIET: Duration = Duration::from_secs(5);

/// Monitors a datagram socket: counts its errors, reports a problem once, and decides when the socket must be
/// reopened. It uses neither a socket nor a clock itself.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct SocketHealth {
    errors: u64,
    failing_since: Option<Duration>,
    lost: bool,
    last_trouble: Option<Duration>,
    bound_at: Option<Duration>,
}

impl SocketHealth {
    /// Records a successful call.
    pub fn succeeded(&mut self) {
        self.failing_since = None;
        self.lost = false;
    }

    /// Records a failed call at `now`, the time since any fixed moment; returns whether to report it. A refusal by the
    /// drone, or a call that had nothing to do, is not reported; of other errors the first is, and one after 5 s without any.
    pub fn failed(&mut self, now: Duration, error: &Error) -> bool {
        match error.kind() {
            // Nothing to read, or no buffer space at the moment.
            ErrorKind::WouldBlock | ErrorKind::Interrupted => return false,
            // The drone is not there at the moment; the session monitors its silence.
            ErrorKind::ConnectionRefused | ErrorKind::ConnectionReset => {
                self.errors += 1;
                return false;
            }
            _ => self.errors += 1,
        }
        self.failing_since.get_or_insert(now);
        self.lost |= matches!(error.kind(), ErrorKind::AddrNotAvailable | ErrorKind::NetworkDown);
        let last = self.last_trouble.replace(now);
        last.is_none_or(|last| now.saturating_sub(last) >= QUIET)
    }

    /// Whether the socket must be reopened now; true at most once in 300 ms.
    pub fn rebind_due(&mut self, now: Duration) -> bool {
        let Some(since) = self.failing_since else { return false };
        let lasts = |since: Duration| now.saturating_sub(since) >= PATIENCE;
        let due = (self.lost || lasts(since)) && self.bound_at.is_none_or(lasts);
        if due {
            self.bound_at = Some(now);
        }
        due
    }

    /// Number of failed calls, except those that merely had nothing to do.
    pub fn errors(&self) -> u64 {
        self.errors
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    #[test]
    fn a_refusal_is_reported_once_and_one_that_lasts_asks_for_a_new_socket() {
        let mut health = SocketHealth::default();
        let refused = Error::from(ErrorKind::PermissionDenied);
        assert!(health.failed(Duration::ZERO, &refused));
        for tick in 1..10 {
            assert!(!health.failed(30 * MS * tick, &refused));
            assert!(!health.rebind_due(30 * MS * tick));
        }
        assert!(!health.failed(300 * MS, &refused));
        assert!(health.rebind_due(300 * MS));
        // The new socket fails too: it gets its own waiting time.
        assert!(!health.failed(330 * MS, &refused) && !health.rebind_due(330 * MS));
        assert!(!health.failed(600 * MS, &refused) && health.rebind_due(600 * MS));
        health.succeeded();
        assert!(!health.rebind_due(10_000 * MS));
        assert!(health.failed(10_000 * MS, &refused), "trouble that comes again is told again");
        assert_eq!(health.errors(), 14);
    }

    #[test]
    fn a_lost_address_does_not_wait() {
        let mut health = SocketHealth::default();
        health.failed(5 * MS, &Error::from(ErrorKind::AddrNotAvailable));
        assert!(health.rebind_due(5 * MS));
        assert!(!health.rebind_due(35 * MS));
    }

    #[test]
    fn a_drone_that_is_not_there_is_no_fault_of_the_socket() {
        let mut health = SocketHealth::default();
        for tick in 0..100 {
            for kind in [ErrorKind::ConnectionRefused, ErrorKind::WouldBlock] {
                assert!(!health.failed(30 * MS * tick, &Error::from(kind)));
            }
            assert!(!health.rebind_due(30 * MS * tick));
        }
        assert_eq!(health.errors(), 100);
    }
}
