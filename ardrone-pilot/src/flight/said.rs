//! Which of an agent's messages are worth showing: one that is said again and again, with other numbers perhaps, is shown once.

use std::time::Duration;

use arrayvec::ArrayVec;
use mission_agent::{Line, SAID_AGAIN_WITHIN, Said, kind};

/// Kinds of messages that are told apart; of further ones each is shown.
const KINDS: usize = 32;

/// What an agent has said last.
#[derive(Debug, Default)]
pub(super) struct SaidLast(ArrayVec<(Said, Duration), KINDS>);

impl SaidLast {
    /// Whether the same has been said to the same peer shortly before.
    pub(super) fn is_said_again(&mut self, at: Duration, said: Said) -> bool {
        let kind = Said { line: Line::from(kind(&said.line)).unwrap_or_default(), ..said };
        if let Some((_, last)) = self.0.iter_mut().find(|(before, _)| *before == kind) {
            return at.saturating_sub(std::mem::replace(last, at)) < SAID_AGAIN_WITHIN;
        }
        // Without room for it, it is shown.
        _ = self.0.try_push((kind, at));
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_told_all_the_time_is_shown_once() {
        let mut last = SaidLast::default();
        let said = |to, text: &str| Said { to, line: Line::from(text).unwrap() };
        let mut again =
            |ms, to, text| last.is_said_again(Duration::from_millis(ms), said(to, text));
        assert!(!again(0, "b", "0 a tell at(1.0, 2.0)"));
        assert!(again(200, "b", "0 a tell at(1.1, 2.0)"));
        assert!(!again(200, "c", "0 a tell at(1.1, 2.0)"), "somebody else");
        assert!(!again(300, "b", "0 a tell low"), "something else");
        assert!(!again(3300, "b", "0 a tell low"), "long ago");
        assert!(again(3199, "b", "0 a tell at(5.0, 2.0)"));
    }
}
