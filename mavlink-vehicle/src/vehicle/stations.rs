//! The stations that were heard: ground stations and programs, by system and component; and when one counts as gone.
//!
//! That is judged here alone, by [`GONE_AFTER`], and means that another station may have its controls. Other silences are
//! those of something else, and are judged where that is known:
//!
//! | silence | means | judged by |
//! |---|---|---|
//! | of the operator for whom the drone flies | tell, hold, land | the agent (SAF-9 of `docs/safety.md`). The core measures it by orders, of which [`OperatorOrder::Present`](autopilot::vehicle::OperatorOrder) says that a station is heard |
//! | of setpoints or sticks | they cannot be followed; whoever sent them may be there | [`following`](super::following), and the agent in flight |
//! | of the partner of a mission's upload | an item is asked for again | [`Transfer`](crate::mission::Transfer) |
//! | of a peer's address | its place is another's. Its stations are gone at once: nothing can be sent to them | the shell, which knows addresses |

use std::time::Duration;

use arrayvec::ArrayVec;
use autopilot::vehicle::{Operator, Station as Kind};

/// Stations that are remembered.
const MOST: usize = 16;
/// After this silence another station may take the place of one that has the controls.
const GONE_AFTER: Duration = Duration::from_secs(5);
/// The vehicle hears so often of a station that is heard.
const PRESENT_EVERY: Duration = Duration::from_millis(250);

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
pub(super) struct Stations {
    known: ArrayVec<(Duration, Station), MOST>,
    /// The operator who gave the last order, and where.
    ordered: Option<(Operator, u8)>,
    /// When the vehicle was last told that a station is there.
    told: Option<Duration>,
}

impl Stations {
    /// A station was heard. The one that has been silent longest gives way to a new one.
    pub(super) fn heard(&mut self, now: Duration, station: Station) {
        if let Some(known) = self.known.iter_mut().find(|(_, known)| *known == station) {
            *known = (now, station);
            return;
        }
        if self.known.is_full() {
            let oldest = self.known.iter().enumerate().min_by_key(|(_, (at, _))| *at);
            if let Some(index) = oldest.map(|(index, _)| index) {
                self.known.swap_remove(index);
            }
        }
        self.known.push((now, station));
    }

    /// A station gives an order.
    pub(super) fn orders(&mut self, station: Station) {
        self.ordered = Some((station.operator(), station.peer));
    }

    /// The operator who gave the last order.
    pub(super) fn ordered(&self) -> Option<Operator> {
        self.ordered.map(|(by, _)| by)
    }

    /// When an operator was last heard. Two programs that give themselves the same numbers are one operator, but where one
    /// of them has ordered the other does not speak for it.
    fn last_heard(&self, operator: Operator) -> Option<Duration> {
        let ordered = self.ordered.filter(|(by, _)| *by == operator);
        let there = |station: &Station| ordered.is_none_or(|(_, peer)| station.peer == peer);
        let heard = self.known.iter().filter(|(_, station)| station.operator() == operator);
        heard.filter(|(_, station)| there(station)).map(|(at, _)| *at).max()
    }

    /// Whether an operator at a `MAVLink` station has been silent for so long that another may have the controls.
    pub(super) fn is_gone(&self, now: Duration, operator: Operator) -> bool {
        let heard = self.last_heard(operator);
        operator.station == Kind::Mavlink
            && heard.is_none_or(|at| now.saturating_sub(at) >= GONE_AFTER)
    }

    /// Whether the vehicle is to be told now that an operator is there: now and then, if that one was heard meanwhile.
    pub(super) fn tells_presence(&mut self, now: Duration, operator: Operator) -> bool {
        let is_news = |at| {
            self.told.is_none_or(|told| at > told && now.saturating_sub(told) >= PRESENT_EVERY)
        };
        let tells = self.last_heard(operator).is_some_and(is_news);
        if tells {
            self.told = Some(now);
        }
        tells
    }

    /// Where a station is to be answered.
    pub(super) fn peer(&self, system: u8, component: u8) -> Option<u8> {
        let is = |known: &Station| known.system == system && known.component == component;
        let heard = self.known.iter().filter(|(_, known)| is(known));
        heard.max_by_key(|(at, _)| *at).map(|(_, known)| known.peer)
    }

    /// Nobody is at this peer any more.
    pub(super) fn forget_peer(&mut self, peer: u8) {
        self.known.retain(|(_, station)| station.peer != peer);
    }
}
