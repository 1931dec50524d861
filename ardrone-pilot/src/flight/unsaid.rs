//! Lines of an agent that are lost: they are counted, and told once a second at most for each cause.

use std::time::Duration;

use crate::drive::NoRoom;

/// Between two times at which the same cause is told.
const APART: Duration = Duration::from_secs(1);

/// What was lost, and is to be told.
#[derive(Debug, Default)]
pub(super) struct Unsaid([Lost; NoRoom::ALL.len()]);

#[derive(Debug, Clone, Copy, Default)]
struct Lost {
    count: u64,
    /// When it was told last.
    told: Option<Duration>,
}

impl Unsaid {
    /// So many more are lost.
    pub(super) fn add(&mut self, why: NoRoom, count: u64) {
        for (cause, lost) in NoRoom::ALL.into_iter().zip(&mut self.0) {
            if cause == why {
                lost.count += count;
            }
        }
    }

    /// Why so many were lost since that was told last; nothing if none were, or it was told just now.
    pub(super) fn due(&mut self, now: Duration) -> Option<(NoRoom, u64)> {
        let is_due = |lost: &Lost| {
            lost.count > 0 && lost.told.is_none_or(|told| now.saturating_sub(told) >= APART)
        };
        let mut all = NoRoom::ALL.into_iter().zip(&mut self.0);
        let (why, lost) = all.find(|(_, lost)| is_due(lost))?;
        lost.told = Some(now);
        Some((why, std::mem::take(&mut lost.count)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_lost_is_told_at_once_and_then_once_a_second_for_each_cause() {
        let mut unsaid = Unsaid::default();
        let ms = Duration::from_millis;
        assert_eq!(unsaid.due(ms(0)), None);
        unsaid.add(NoRoom::Mailbox, 1);
        assert_eq!(unsaid.due(ms(30)), Some((NoRoom::Mailbox, 1)));
        for tick in 2..30 {
            unsaid.add(NoRoom::Mailbox, 2);
            assert_eq!(unsaid.due(ms(30 * tick)), None);
        }
        unsaid.add(NoRoom::Step, 3);
        assert_eq!(unsaid.due(ms(900)), Some((NoRoom::Step, 3)), "another cause");
        assert_eq!(unsaid.due(ms(900)), None);
        // Also if no more are lost by then.
        assert_eq!(unsaid.due(ms(1029)), None);
        assert_eq!(unsaid.due(ms(1030)), Some((NoRoom::Mailbox, 56)));
        assert_eq!(unsaid.due(ms(9000)), None);
    }
}
