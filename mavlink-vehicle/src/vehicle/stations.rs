//! The stations that were heard: ground stations and programs, by system and component.

use std::time::Duration;

use arrayvec::ArrayVec;
use autopilot::vehicle::{Operator, Station as Kind};

/// Stations that are remembered.
const MOST: usize = 16;
/// After this silence another station may take the place of one that has the controls.
pub(super) const GONE_AFTER: Duration = Duration::from_secs(5);

/// A station.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Station {
    pub(super) system: u8,
    pub(super) component: u8,
    /// Where it was last heard.
    pub(super) peer: u8,
    /// Whether that is this machine.
    pub(super) local: bool,
}

impl Station {
    /// The operator at this station.
    pub(super) fn operator(self) -> Operator {
        let number = u16::from_be_bytes([self.system, self.component]);
        Operator { station: Kind::Mavlink, number, local: self.local }
    }
}

/// All stations, and when they were heard.
#[derive(Debug, Default)]
pub(super) struct Stations(ArrayVec<(Duration, Station), MOST>);

impl Stations {
    /// A station was heard. The one that has been silent longest gives way to a new one.
    pub(super) fn heard(&mut self, now: Duration, station: Station) {
        if let Some(known) = self.0.iter_mut().find(|(_, known)| *known == station) {
            *known = (now, station);
            return;
        }
        if self.0.is_full() {
            let oldest = self.0.iter().enumerate().min_by_key(|(_, (at, _))| *at);
            if let Some(index) = oldest.map(|(index, _)| index) {
                self.0.swap_remove(index);
            }
        }
        self.0.push((now, station));
    }

    /// When an operator was last heard, at one peer or anywhere. Two programs that give themselves the same numbers are
    /// one operator, but where one of them has ordered the other does not speak for it.
    pub(super) fn last_heard(&self, operator: Operator, peer: Option<u8>) -> Option<Duration> {
        let there = |station: &Station| peer.is_none_or(|peer| station.peer == peer);
        let heard = self.0.iter().filter(|(_, station)| station.operator() == operator);
        heard.filter(|(_, station)| there(station)).map(|(at, _)| *at).max()
    }

    /// Where a station is to be answered.
    pub(super) fn peer(&self, system: u8, component: u8) -> Option<u8> {
        let is = |known: &Station| known.system == system && known.component == component;
        let heard = self.0.iter().filter(|(_, known)| is(known));
        heard.max_by_key(|(at, _)| *at).map(|(_, known)| known.peer)
    }

    /// Nobody is at this peer any more.
    pub(super) fn forget_peer(&mut self, peer: u8) {
        self.0.retain(|(_, station)| station.peer != peer);
    }
}
