//! Sequence numbers of AT commands.

/// Assigns sequence numbers to commands.
#[derive(Debug, Clone, Copy)]
pub(super) struct SequenceNumbers {
    next: u32,
    /// The greatest number used.
    greatest: u32,
    /// The drone has shown that it receives our commands.
    confirmed: bool,
}

impl SequenceNumbers {
    const FIRST: u32 = 1;

    pub(super) fn new() -> Self {
        Self { next: Self::FIRST, greatest: 0, confirmed: false }
    }

    /// Whether any number was used.
    pub(super) fn has_begun(&self) -> bool {
        self.greatest > 0
    }

    /// Takes in whether the drone has just shown that it receives our commands.
    pub(super) fn confirm(&mut self, received: bool) {
        self.confirmed |= received;
    }

    /// Starts a datagram. Until the drone has confirmed our numbering it may still expect numbers above those
    /// of another client, and the datagram that resets them may be lost.
    pub(super) fn begin_datagram(&mut self) {
        self.next = match self.greatest.checked_add(1) {
            Some(next) if self.confirmed => next,
            _ => Self::FIRST,
        };
    }

    /// Skips beyond any number that another client may have reached. Number 1 would be accepted as well, but
    /// so would any delayed old datagram after it.
    pub(super) fn leap(&mut self) {
        const FAR: u32 = 1 << 20;
        self.greatest = self.greatest.saturating_add(FAR);
    }

    pub(super) fn take(&mut self) -> u32 {
        let number = self.next;
        self.greatest = self.greatest.max(number);
        self.next = number.saturating_add(1);
        number
    }
}
