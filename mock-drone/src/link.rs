//! The radio link between pilot and drone, in one direction: loss, delay and corruption.

use std::collections::VecDeque;
use std::time::Duration;

use bytes::Bytes;
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

/// Faults of the link. Fractions are probabilities from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LinkFaults {
    /// Fraction of datagrams that are lost.
    pub loss: f64,
    /// Base latency.
    pub delay: Duration,
    /// Maximum random additional latency, which also reorders datagrams.
    pub jitter: Duration,
    /// Fraction of datagrams that arrive twice.
    pub duplication: f64,
    /// Fraction of datagrams that arrive after the next one.
    pub reordering: f64,
    /// Fraction of datagrams that are corrupted. Navdata arrive with a changed byte, as from real drones; AT
    /// commands are lost, because UDP's checksum drops them.
    pub corruption: f64,
}

/// Datagrams in transit, each with a label of the caller.
#[derive(Debug, Clone)]
pub(crate) struct Link<L> {
    pub(crate) faults: LinkFaults,
    /// Whether all datagrams are lost.
    pub(crate) out: bool,
    /// Whether corrupted datagrams are dropped.
    drops_spoiled: bool,
    random: ChaCha8Rng,
    /// In the order of arrival.
    waiting: VecDeque<Travelling<L>>,
    held_back: Option<(L, Bytes)>,
    /// Until then datagrams are held back, and then arrive at once.
    held_until: Duration,
    /// The last datagrams that arrived.
    past: VecDeque<(L, Bytes)>,
}

/// Maximum number of datagrams that can be repeated.
pub(crate) const PAST: usize = 256;

#[derive(Debug, Clone)]
struct Travelling<L> {
    due: Duration,
    label: L,
    datagram: Bytes,
}

impl<L: Copy> Link<L> {
    pub(crate) fn new(faults: LinkFaults, seed: u64) -> Self {
        Self {
            faults,
            out: false,
            drops_spoiled: false,
            random: ChaCha8Rng::seed_from_u64(seed ^ 0x6c69_6e6b),
            waiting: VecDeque::new(),
            held_back: None,
            held_until: Duration::ZERO,
            past: VecDeque::with_capacity(PAST),
        }
    }

    /// The same link, but corrupted datagrams are dropped.
    pub(crate) fn dropping_spoiled(mut self) -> Self {
        self.drops_spoiled = true;
        self
    }

    /// Sends a datagram.
    pub(crate) fn send(&mut self, now: Duration, label: L, datagram: Bytes) {
        if self.out || self.happens(self.faults.loss) {
            return;
        }
        let spoiled = self.happens(self.faults.corruption);
        if spoiled && self.drops_spoiled {
            return;
        }
        let datagram = if spoiled && !datagram.is_empty() {
            let mut spoiled = datagram.to_vec();
            let index = self.random.random_range(0..spoiled.len());
            spoiled[index] ^= self.random.random_range(1..=u8::MAX);
            Bytes::from(spoiled)
        } else {
            datagram
        };
        if self.held_back.is_none() && self.happens(self.faults.reordering) {
            self.held_back = Some((label, datagram));
            return;
        }
        if self.happens(self.faults.duplication) {
            self.travel(now, label, datagram.clone());
        }
        self.travel(now, label, datagram);
        if let Some((label, datagram)) = self.held_back.take() {
            self.travel(now, label, datagram);
        }
    }

    fn travel(&mut self, now: Duration, label: L, datagram: Bytes) {
        let mut due = now + self.faults.delay;
        if !self.faults.jitter.is_zero() {
            due += self.random.random_range(Duration::ZERO..self.faults.jitter);
        }
        let place = self.waiting.partition_point(|other| other.due <= due);
        self.waiting.insert(place, Travelling { due, label, datagram });
    }

    /// Holds datagrams back until `time`; then they arrive at once.
    pub(crate) fn hold_until(&mut self, time: Duration) {
        self.held_until = self.held_until.max(time);
    }

    /// Repeats the last datagrams that arrived, at most [`PAST`], in their old order.
    pub(crate) fn repeat(&mut self, now: Duration, count: usize) {
        for (label, datagram) in self.past.iter().skip(self.past.len().saturating_sub(count)) {
            let place = self.waiting.partition_point(|other| other.due <= now);
            let again = Travelling { due: now, label: *label, datagram: datagram.clone() };
            self.waiting.insert(place, again);
        }
    }

    /// When the next datagram arrives.
    pub(crate) fn next_due(&self) -> Option<Duration> {
        self.waiting.front().map(|next| next.due.max(self.held_until))
    }

    /// The next datagram that has arrived by now, with its time of arrival.
    pub(crate) fn receive(&mut self, now: Duration) -> Option<(Duration, L, Bytes)> {
        let next = self.waiting.pop_front_if(|next| next.due.max(self.held_until) <= now)?;
        if self.past.len() == PAST {
            self.past.pop_front();
        }
        self.past.push_back((next.label, next.datagram.clone()));
        Some((next.due.max(self.held_until), next.label, next.datagram))
    }

    fn happens(&mut self, share: f64) -> bool {
        share > 0.0 && self.random.random_bool(share.min(1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: fn(u64) -> Duration = Duration::from_millis;

    /// Sends the numbers 0 to 255, ten times, one per millisecond; returns the datagrams that arrived.
    fn numbers(faults: LinkFaults) -> Vec<(Duration, Bytes)> {
        let mut link = Link::new(faults, 5);
        let mut arrived = Vec::new();
        for now in 0..2560_u64 {
            let number = u8::try_from(now % 256).unwrap();
            link.send(MS(now), (), Bytes::from(vec![number]));
            while let Some((due, (), datagram)) = link.receive(MS(now)) {
                arrived.push((due, datagram));
            }
        }
        while let Some((due, (), datagram)) = link.receive(Duration::MAX) {
            arrived.push((due, datagram));
        }
        arrived
    }

    fn out_of_order(arrived: &[(Duration, Bytes)]) -> usize {
        arrived.windows(2).filter(|pair| pair[1].1[0] != pair[0].1[0].wrapping_add(1)).count()
    }

    #[test]
    fn without_faults_everything_arrives_at_once_and_in_order() {
        let arrived = numbers(LinkFaults::default());
        assert_eq!(arrived.len(), 2560);
        assert_eq!(out_of_order(&arrived), 0);
    }

    #[test]
    fn each_fault_happens_as_often_as_it_should() {
        let lost = numbers(LinkFaults { loss: 0.3, ..LinkFaults::default() });
        assert!((1650..1930).contains(&lost.len()), "{}", lost.len());
        let doubled = numbers(LinkFaults { duplication: 0.2, ..LinkFaults::default() });
        assert!((2950..3190).contains(&doubled.len()), "{}", doubled.len());
        let swapped = numbers(LinkFaults { reordering: 0.1, ..LinkFaults::default() });
        // The last one may still wait for its successor.
        assert!(swapped.len() >= 2559);
        assert!(out_of_order(&swapped) > 300);
        let spoiled = numbers(LinkFaults { corruption: 0.1, ..LinkFaults::default() });
        assert_eq!(spoiled.len(), 2560);
        assert!(out_of_order(&spoiled) > 300);
        let jittery =
            numbers(LinkFaults { delay: MS(20), jitter: MS(30), ..LinkFaults::default() });
        assert_eq!(jittery.len(), 2560);
        assert!(out_of_order(&jittery) > 1000);
        assert!(jittery[0].0 >= MS(20) && jittery.last().unwrap().0 < MS(2610));
    }

    #[test]
    fn what_is_held_arrives_late_and_all_at_once() {
        let mut link = Link::new(LinkFaults::default(), 1);
        link.send(MS(0), (), Bytes::from_static(b"1"));
        link.hold_until(MS(50));
        link.send(MS(10), (), Bytes::from_static(b"2"));
        assert_eq!(link.next_due(), Some(MS(50)));
        assert_eq!(link.receive(MS(49)), None);
        for expected in [b"1", b"2"] {
            let (due, (), datagram) = link.receive(MS(60)).unwrap();
            assert_eq!((due, datagram.as_ref()), (MS(50), expected.as_slice()));
        }
    }

    #[test]
    fn old_datagrams_arrive_again_in_their_order() {
        let mut link = Link::new(LinkFaults::default(), 1);
        for text in [&b"1"[..], b"2", b"3"] {
            link.send(MS(0), (), Bytes::from_static(text));
            assert!(link.receive(MS(0)).is_some());
        }
        link.repeat(MS(10), 2);
        for expected in [&b"2"[..], b"3"] {
            assert_eq!(link.receive(MS(10)).unwrap().2, expected);
        }
        assert_eq!(link.receive(MS(10)), None);
        link.repeat(MS(20), 1000);
        assert_eq!(std::iter::from_fn(|| link.receive(MS(20))).count(), 5);
    }

    #[test]
    fn nothing_sets_out_during_an_outage() {
        let mut link = Link::new(LinkFaults::default(), 1);
        link.out = true;
        link.send(MS(0), (), Bytes::from_static(b"x"));
        link.out = false;
        assert_eq!(link.receive(MS(100)), None);
    }
}
