//! Earlier states of a run, for `undo`.

use std::collections::VecDeque;

/// Number of states that are kept.
const KEPT: usize = 500;

/// The last states, each from before a line that changed something.
#[derive(Debug, Clone)]
pub(super) struct History<T>(VecDeque<T>);

impl<T> History<T> {
    pub(super) fn new() -> Self {
        Self(VecDeque::new())
    }

    pub(super) fn push(&mut self, state: T) {
        self.0.push_back(state);
        if self.0.len() > KEPT {
            self.0.pop_front();
        }
    }

    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    /// Takes back so many lines. Returns the state before them; of more than there are, none is taken back.
    pub(super) fn undo(&mut self, count: u32) -> Result<Option<T>, String> {
        let left = self.0.len().checked_sub(count as usize);
        let left = left.ok_or("there is not so much to undo")?;
        Ok(self.0.drain(left..).next())
    }
}
