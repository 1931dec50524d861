//! The emergency bit, whose rising edge cuts the motors or clears an emergency.

use std::time::Duration;

/// Time for which the bit stays up. A drone that has not reacted by then has missed the edge.
const UP: Duration = Duration::from_millis(500);
/// Time for which the bit stays down before it rises again.
const DOWN: Duration = Duration::from_millis(120);
/// After this time the request is given up.
const TIMEOUT: Duration = Duration::from_secs(5);

/// A request to change the drone's emergency state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum EmergencyWish {
    /// Cut the motors.
    Stop,
    /// Clear the emergency.
    Reset,
}

/// Raises and lowers the bit until the request is fulfilled.
#[derive(Debug, Default)]
pub(super) struct EmergencySwitch {
    wish: Option<EmergencyWish>,
    /// Time of the request's first tick.
    since: Option<Duration>,
}

impl EmergencySwitch {
    pub(super) fn request(&mut self, wish: EmergencyWish) {
        self.wish = Some(wish);
        self.since = None;
    }

    /// Whether the bit is up now; `emergency` is the drone's reported state.
    pub(super) fn level(&mut self, now: Duration, emergency: bool) -> bool {
        let Some(wish) = self.wish else { return false };
        let since = *self.since.get_or_insert(now);
        let elapsed = now.saturating_sub(since);
        let come_true = emergency == (wish == EmergencyWish::Stop);
        if come_true || elapsed >= TIMEOUT {
            // The bit must not stay up after the request.
            self.wish = None;
            return false;
        }
        elapsed.as_millis() % (UP + DOWN).as_millis() < UP.as_millis()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: fn(u64) -> Duration = Duration::from_millis;

    #[test]
    fn the_bit_is_up_until_the_drone_says_so_and_never_longer() {
        let mut switch = EmergencySwitch::default();
        assert!(!switch.level(MS(0), false));
        switch.request(EmergencyWish::Stop);
        assert!(switch.level(MS(30), false));
        assert!(switch.level(MS(60), false));
        assert!(!switch.level(MS(90), true));
        // The request does not come back when the emergency ends.
        assert!(!switch.level(MS(120), false));
    }

    #[test]
    fn an_edge_that_was_missed_is_made_again_but_not_for_ever() {
        let mut switch = EmergencySwitch::default();
        switch.request(EmergencyWish::Reset);
        let levels: Vec<bool> = (0..300).map(|tick| switch.level(MS(30) * tick, true)).collect();
        let edges = levels.windows(2).filter(|pair| pair == &[false, true]).count();
        assert!((5..10).contains(&edges), "{edges}");
        assert!(levels[170..].iter().all(|level| !level));
    }

    #[test]
    fn the_bit_is_up_for_half_a_second_and_down_for_a_moment() {
        for (elapsed_ms, is_up) in [
            (0, true),
            (499, true),
            (500, false),
            (619, false),
            (620, true),
            (1119, true),
            (1120, false),
        ] {
            let mut switch = EmergencySwitch::default();
            switch.request(EmergencyWish::Stop);
            switch.level(MS(7000), false);
            assert_eq!(switch.level(MS(7000 + elapsed_ms), false), is_up, "{elapsed_ms} ms");
        }
    }

    #[test]
    fn a_wish_that_is_true_already_raises_nothing() {
        let mut switch = EmergencySwitch::default();
        switch.request(EmergencyWish::Reset);
        assert!(!switch.level(MS(0), false));
        switch.request(EmergencyWish::Stop);
        assert!(!switch.level(MS(0), true));
    }
}
