//! What is told while proofs run, and how long they may.

use std::time::{Duration, Instant};

/// Somebody who follows proofs, and may stop them. They run in several threads.
pub trait Watch: Sync {
    /// A part begins.
    fn begins(&self, _part: &Part) {}
    /// A part ended.
    fn ends(&self, _part: &Part, _end: End, _took: Duration) {}
    /// Whether to stop. Asked every few milliseconds for each part that runs.
    fn stops(&self) -> bool {
        false
    }
}

/// Nobody.
impl Watch for () {}

/// One of several proofs.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Part {
    /// Its number, from 0.
    pub number: usize,
    /// How many there are.
    pub of: usize,
    /// What is proved.
    pub what: String,
}

/// How a part ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum End {
    /// It is proved.
    Proved,
    /// It is not.
    Open,
    /// It reached a time limit, was stopped, or is not needed any more.
    GivenUp,
}

/// Limited time.
#[derive(Debug, Clone, Copy)]
pub struct Budget {
    each: Duration,
    end: Option<Instant>,
}

impl Budget {
    /// Time for each part, and from now on for all, if that is limited.
    pub fn begin(each: Duration, total: Option<Duration>) -> Self {
        // A limit that no clock can show is none.
        let end = total.and_then(|total| Instant::now().checked_add(total));
        Self { each, end }
    }

    /// The same, but from now on no longer than `most` for all.
    pub(crate) fn at_most(self, most: Duration) -> Self {
        let end = Instant::now().checked_add(most);
        Self { end: [end, self.end].into_iter().flatten().min(), ..self }
    }

    /// When a part that begins now has to end; `None` if no clock can show that.
    fn until(&self) -> Option<Instant> {
        let each = Instant::now().checked_add(self.each);
        [each, self.end].into_iter().flatten().min()
    }

    /// Whether the time for all is over.
    pub(crate) fn is_over(&self) -> bool {
        self.end.is_some_and(|end| Instant::now() >= end)
    }

    /// Whether to give up a part that begins now, each time it is asked.
    pub(super) fn late(&self, watch: &dyn Watch) -> impl Fn() -> bool {
        let until = self.until();
        move || watch.stops() || until.is_some_and(|until| Instant::now() >= until)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Stopped;

    impl Watch for Stopped {
        fn stops(&self) -> bool {
            true
        }
    }

    #[test]
    fn each_limit_ends_a_part() {
        let hour = Duration::from_hours(1);
        assert!(!Budget::begin(hour, Some(hour)).late(&())());
        assert!(!Budget::begin(Duration::MAX, Some(Duration::MAX)).late(&())());
        assert!(Budget::begin(Duration::ZERO, Some(hour)).late(&())());
        assert!(Budget::begin(hour, Some(Duration::ZERO)).late(&())());
        assert!(Budget::begin(hour, None).late(&Stopped)());
        assert!(Budget::begin(hour, Some(Duration::ZERO)).is_over());
        assert!(!Budget::begin(Duration::ZERO, None).is_over());
    }
}
