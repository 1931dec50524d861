//! When the drone was last heard, and whether a packet shows that it has restarted.

use std::time::Duration;

use crate::navdata::{DroneState, Navdata};

/// Silence after which the drone may have restarted unnoticed, so it must not be sent anything that lifts it.
pub(super) const UNHEARD: Duration = Duration::from_millis(300);
/// Packets that arrive within this time after a silence may have been delayed since before a restart.
pub(super) const HELD_UP: Duration = Duration::from_millis(100);

/// The newest packet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Heard {
    pub(super) at: Duration,
    pub(super) sequence: u32,
    pub(super) bootstrapping: bool,
    /// End of the last silence, while packets may still have been delayed since before it.
    pub(super) returned_at: Option<Duration>,
}

impl Heard {
    /// End of the last silence for a packet that arrives now.
    pub(super) fn returned_at(&self, now: Duration) -> Option<Duration> {
        if now.saturating_sub(self.at) >= UNHEARD {
            return Some(now);
        }
        self.returned_at.filter(|at| now.saturating_sub(*at) < HELD_UP)
    }

    /// Whether the drone cannot have restarted unnoticed. A silent drone may have, and stand on the ground:
    /// commands that could lift it are left out. One that still flies sees this as a lost datagram.
    pub(super) fn is_fresh(&self, now: Duration) -> bool {
        self.returned_at.is_none() && now.saturating_sub(self.at) < UNHEARD
    }

    /// Whether a packet with a lower sequence number shows a restart rather than a late or repeated packet.
    /// After a restart the drone is in bootstrap mode, or counts from the very start, and there was a silence
    /// while it started; old packets that are repeated among new ones come without a silence.
    pub(super) fn is_before_restart(&self, now: Duration, navdata: &Navdata) -> bool {
        const FIRST_PACKETS: u32 = 3;
        /// Maximum number of packets by which a packet can be overtaken.
        const OVERTAKEN: u32 = 32;
        let behind = self.sequence.saturating_sub(navdata.sequence);
        if behind == 0 || self.returned_at(now).is_none() {
            return false;
        }
        let bootstrapping = navdata.state.contains(DroneState::NAVDATA_BOOTSTRAP);
        // A drone that was already in bootstrap mode may just have had a packet overtaken.
        let is_new = !self.bootstrapping || behind > OVERTAKEN;
        let from_the_start =
            navdata.sequence <= FIRST_PACKETS && self.sequence > 10 * FIRST_PACKETS;
        bootstrapping && is_new || from_the_start
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The exact limits of the silence.
    #[test]
    fn a_drone_is_heard_for_as_long_as_it_was_silent_for_less_than_the_limit() {
        let just_before = |limit: Duration| limit.saturating_sub(Duration::from_millis(1));
        let heard = |at| Heard { at, sequence: 1, bootstrapping: false, returned_at: None };
        let start = Duration::from_secs(5);
        assert_eq!(heard(start).returned_at(start + just_before(UNHEARD)), None);
        let back = start + UNHEARD;
        assert_eq!(heard(start).returned_at(back), Some(back));
        let returned = Heard { returned_at: Some(back), ..heard(back) };
        assert_eq!(returned.returned_at(back + just_before(HELD_UP)), Some(back));
        assert_eq!(returned.returned_at(back + HELD_UP), None);
        assert!(heard(start).is_fresh(start + just_before(UNHEARD)));
        assert!(!heard(start).is_fresh(back));
        assert!(!returned.is_fresh(back));
    }

    fn packet(sequence: u32, bootstrapping: bool) -> Navdata {
        let bit = DroneState::NAVDATA_BOOTSTRAP;
        let state = if bootstrapping { bit } else { DroneState::empty() };
        let mut bytes = bytes::BytesMut::new();
        crate::navdata::PacketWriter::new(&mut bytes, state, sequence, 0).finish();
        Navdata::decode(&bytes).unwrap()
    }

    /// The exact limits of the numbers.
    #[test]
    fn a_lower_number_is_a_restart_in_bootstrap_mode_or_from_the_very_start() {
        let at = Duration::from_secs(5);
        for (last, was_bootstrapping, next, bootstrapping, expected) in [
            (100, false, 50, true, true),
            (100, false, 50, false, false),
            (100, false, 100, true, false),
            // At most 32 packets are overtaken by one.
            (100, true, 68, true, false),
            (100, true, 67, true, true),
            // A drone counts from 1; the last number must lie clearly above.
            (31, false, 3, false, true),
            (31, false, 4, false, false),
            (30, false, 3, false, false),
            (12, false, 1, false, false),
        ] {
            let heard =
                Heard { at, sequence: last, bootstrapping: was_bootstrapping, returned_at: None };
            let next = packet(next, bootstrapping);
            let found = heard.is_before_restart(at + UNHEARD, &next);
            assert_eq!(found, expected, "{last} then {}, {bootstrapping}", next.sequence);
            assert!(!heard.is_before_restart(at, &next), "without a silence there is no restart");
        }
    }
}
