//! Sequence numbers of AT commands.

/// Assigns sequence numbers to commands.
#[derive(Debug, Clone, Copy)]
pub(super) struct SequenceNumbers {
    next: u32,
    /// The greatest number used.
    greatest: u32,
    /// The drone has shown that it receives our commands.
    confirmed: bool,
    /// Another client's numbers may be above ours. Whether the last datagram began the count anew.
    contested: Option<bool>,
    /// They have leapt since they were last settled.
    leapt: bool,
    /// They are contested in the next datagram.
    insists: bool,
}

impl SequenceNumbers {
    const FIRST: u32 = 1;

    pub(super) fn new() -> Self {
        Self {
            next: Self::FIRST,
            greatest: 0,
            confirmed: false,
            contested: None,
            leapt: false,
            insists: false,
        }
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
    ///
    /// While the numbers are contested every other datagram begins with number 1, which the drone always accepts,
    /// whatever another client has counted to and however often it says so. The one after it has our far number
    /// again, so that no old datagram that was delayed is accepted for longer than a tick.
    pub(super) fn begin_datagram(&mut self) {
        let anew = self.contested.as_mut().is_some_and(|anew| {
            *anew = !*anew;
            *anew
        });
        let continues = self.confirmed || self.contested.is_some();
        self.next = match self.greatest.checked_add(1) {
            Some(next) if continues && !anew => next,
            _ => Self::FIRST,
        };
    }

    /// The drone does not obey although our numbers have leapt, or there is no time to see whether it does.
    pub(super) fn contest(&mut self) {
        self.contested.get_or_insert(false);
        // What is sent later may still be below the other's numbers.
        self.confirmed = false;
    }

    /// The drone does not obey: the numbers leap, and if that is not enough, they are contested.
    pub(super) fn escalate(&mut self) {
        if self.leapt { self.contest() } else { self.leap() }
    }

    /// The drone does not do what it is told: the numbers are contested for one datagram more, and in a landing until it is
    /// down. A drone that obeys again has heard our far number, so that the numbers go on behind it.
    pub(super) fn insist(&mut self) {
        self.insists = true;
        self.contested.get_or_insert(false);
    }

    /// The drone has obeyed, or need not any more.
    pub(super) fn settle(&mut self) {
        if !std::mem::take(&mut self.insists) {
            self.contested = None;
            self.leapt = false;
        }
    }

    /// Skips beyond the numbers that another client has reached in minutes. Number 1 would be accepted as well, but
    /// so would any delayed old datagram after it.
    pub(super) fn leap(&mut self) {
        const FAR: u32 = 1 << 20;
        self.leapt = true;
        self.greatest = self.greatest.saturating_add(FAR);
    }

    pub(super) fn take(&mut self) -> u32 {
        let number = self.next;
        self.greatest = self.greatest.max(number);
        self.next = number.saturating_add(1);
        number
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First numbers of datagrams with one command each.
    fn first(numbers: &mut SequenceNumbers, insists: bool) -> u32 {
        if insists {
            numbers.insist();
        }
        numbers.settle();
        numbers.begin_datagram();
        numbers.take()
    }

    /// Were each datagram begun with number 1 from then on, any old one that is late would be obeyed.
    #[test]
    fn numbers_go_on_once_the_drone_obeys_again() {
        let mut numbers = SequenceNumbers::new();
        numbers.confirm(true);
        assert_eq!([1, 2, 3], [(); 3].map(|()| first(&mut numbers, false)));
        assert_eq!([1, 4, 1, 5], [(); 4].map(|()| first(&mut numbers, true)));
        assert_eq!([6, 7], [(); 2].map(|()| first(&mut numbers, false)));
    }
}
