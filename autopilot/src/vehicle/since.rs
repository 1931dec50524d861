//! For how long something is so.

use std::time::Duration;

/// Since when something is so without a break.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Since(Option<Duration>);

impl Since {
    /// Takes in whether it is so now. Returns whether it has been for this time.
    pub(super) fn lasts(&mut self, now: Duration, is_so: bool, time: Duration) -> bool {
        self.0 = is_so.then(|| self.0.unwrap_or(now));
        self.0.is_some_and(|since| now.saturating_sub(since) >= time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_break_begins_anew() {
        let second = Duration::from_secs;
        let mut since = Since::default();
        let mut lasts = |at, is_so| since.lasts(second(at), is_so, second(2));
        assert_eq!([lasts(1, true), lasts(2, true), lasts(3, true)], [false, false, true]);
        assert_eq!([lasts(4, false), lasts(5, true), lasts(7, true)], [false, false, true]);
    }
}
