//! Those to whom we speak: the remotes that were given, and others who have spoken to us.
//!
//! A silence here is that of an address, whose slot is needed for others. When an operator counts as gone is judged by
//! `mavlink-vehicle`'s stations.

use std::net::SocketAddr;
use std::time::Duration;

/// Most peers at a time.
pub(super) const MOST: usize = 16;
/// After this silence one that was not given is forgotten.
const FORGOTTEN_AFTER: Duration = Duration::from_secs(10);
/// Age from which a silent peer is evicted when all slots are used. Heartbeats come every second.
const GIVES_WAY_AFTER: Duration = Duration::from_secs(3);
/// Datagrams of one peer that are taken at once, and how many more in each tick of 20 ms: half of what all may send. One that
/// sends more for long floods, and takes no more room from others. A client that asks for one thing after the other as fast as it
/// is answered, as for the items of a mission, must lose nothing.
const AT_ONCE: u16 = 2048;
const PER_TICK: u16 = 32;

#[derive(Debug, Clone, Copy)]
struct Peer {
    address: SocketAddr,
    /// When it was heard last; `None` for a remote, which is never forgotten.
    heard: Option<Duration>,
    /// Datagrams that it may still send.
    allowance: u16,
}

/// Peers by their numbers.
#[derive(Debug)]
pub(super) struct Peers {
    places: [Option<Peer>; MOST],
}

impl Peers {
    /// The remotes alone, each once.
    pub(super) fn new(remotes: &[SocketAddr]) -> Self {
        let mut peers = Self { places: [None; MOST] };
        for remote in remotes {
            if peers.number(*remote).is_none() {
                peers.place(Peer { address: *remote, heard: None, allowance: AT_ONCE });
            }
        }
        peers
    }

    /// The number of the peer at this address.
    pub(super) fn number(&self, address: SocketAddr) -> Option<u8> {
        let is = |peer: &Option<Peer>| peer.is_some_and(|peer| peer.address == address);
        self.places.iter().position(is).and_then(|number| u8::try_from(number).ok())
    }

    pub(super) fn address(&self, number: u8) -> Option<SocketAddr> {
        let place = self.places.get(usize::from(number)).copied().flatten();
        place.map(|peer| peer.address)
    }

    pub(super) fn addresses(&self) -> impl Iterator<Item = SocketAddr> + '_ {
        self.places.iter().flatten().map(|peer| peer.address)
    }

    pub(super) fn has_room(&self) -> bool {
        self.places.iter().any(Option::is_none)
    }

    /// Someone who was not known speaks MAVLink: its number, if there is room.
    pub(super) fn learn(&mut self, now: Duration, address: SocketAddr) -> Option<u8> {
        self.place(Peer { address, heard: Some(now), allowance: AT_ONCE - 1 })
    }

    /// A peer has sent a datagram; returns whether it may be taken.
    pub(super) fn hear(&mut self, now: Duration, number: u8) -> bool {
        let Some(Some(peer)) = self.places.get_mut(usize::from(number)) else { return false };
        peer.heard = peer.heard.map(|_| now);
        let may = peer.allowance > 0;
        peer.allowance = peer.allowance.saturating_sub(1);
        may
    }

    /// A tick has passed.
    pub(super) fn tick(&mut self) {
        for peer in self.places.iter_mut().flatten() {
            peer.allowance = peer.allowance.saturating_add(PER_TICK).min(AT_ONCE);
        }
    }

    /// Forgets one of those who have been silent for too long, and returns its number.
    pub(super) fn forget(&mut self, now: Duration) -> Option<u8> {
        self.forget_silent(now, FORGOTTEN_AFTER)
    }

    /// Forgets one who gives way to another if there is no room, and returns its number.
    pub(super) fn make_room(&mut self, now: Duration) -> Option<u8> {
        if self.has_room() { None } else { self.forget_silent(now, GIVES_WAY_AFTER) }
    }

    /// Forgets the one who has been silent longest, if it has been for so long.
    fn forget_silent(&mut self, now: Duration, patience: Duration) -> Option<u8> {
        let heard = |place: &Option<Peer>| place.and_then(|peer| peer.heard);
        let silent = self.places.iter().enumerate();
        let silent = silent.filter_map(|(number, place)| heard(place).map(|at| (at, number)));
        let (at, number) = silent.min()?;
        if now.saturating_sub(at) < patience {
            return None;
        }
        *self.places.get_mut(number)? = None;
        u8::try_from(number).ok()
    }

    fn place(&mut self, peer: Peer) -> Option<u8> {
        let number = self.places.iter().position(Option::is_none)?;
        *self.places.get_mut(number)? = Some(peer);
        u8::try_from(number).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(port: u16) -> SocketAddr {
        SocketAddr::from(([127, 0, 0, 1], port))
    }

    const SECOND: Duration = Duration::from_secs(1);

    #[test]
    fn remotes_stay_and_others_are_forgotten_when_silent() {
        let mut peers = Peers::new(&[at(14550), at(14540), at(14550)]);
        assert_eq!(peers.addresses().collect::<Vec<_>>(), [at(14550), at(14540)]);
        assert_eq!(peers.learn(SECOND, at(5000)), Some(2));
        assert_eq!(peers.learn(2 * SECOND, at(6000)), Some(3));
        assert!(peers.hear(5 * SECOND, 2) && peers.hear(5 * SECOND, 0));
        assert_eq!(peers.forget(11 * SECOND), None);
        assert_eq!(peers.forget(12 * SECOND), Some(3));
        assert_eq!((peers.forget(12 * SECOND), peers.address(3)), (None, None));
        // Its number is that of the next one.
        assert_eq!(peers.learn(12 * SECOND, at(7000)), Some(3));
        assert_eq!((peers.number(at(7000)), peers.number(at(6000))), (Some(3), None));
        assert_eq!(peers.forget(1000 * SECOND), Some(2));
        assert_eq!(peers.forget(1000 * SECOND), Some(3));
        assert_eq!(peers.forget(1000 * SECOND), None);
        assert_eq!(peers.addresses().count(), 2);
    }

    #[test]
    fn there_are_eight_at_most() {
        let mut peers = Peers::new(&[at(1)]);
        let learnt = (2..100).filter(|port| peers.learn(SECOND, at(*port)).is_some()).count();
        assert_eq!((learnt, peers.has_room()), (MOST - 1, false));
        assert!(!peers.hear(SECOND, 200));
        assert_eq!(peers.address(200), None);
    }

    #[test]
    fn one_that_floods_is_not_heard_any_more() {
        let mut peers = Peers::new(&[at(1), at(2)]);
        let taken = |peers: &mut Peers| (0..3000).filter(|_| peers.hear(SECOND, 0)).count();
        assert_eq!(taken(&mut peers), usize::from(AT_ONCE));
        peers.tick();
        assert_eq!(taken(&mut peers), usize::from(PER_TICK));
        assert!(peers.hear(SECOND, 1), "the other is");
        for _ in 0..100 {
            peers.tick();
        }
        assert_eq!(taken(&mut peers), usize::from(AT_ONCE));
    }
}
