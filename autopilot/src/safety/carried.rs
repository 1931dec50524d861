//! Whether the wind carries the drone over its fence: it moves outward, and cannot brake before.
//!
//! A storm is met best where it begins. A drone that is landed only when it has left its fence was carried
//! towards it all the while, and its own landing drifts on for as long as it was high.

use std::time::Duration;

use super::{BRAKES, BRAKES_M_S, Circumstances, GUST, MARGIN_M, REACTION_S, outward};

/// A drone that goes outward no faster than this holds its place, or nearly.
const SLOW_M_S: f64 = 0.3;

/// For how long the drone has been carried outward, faster than it can brake.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct CarriedOff {
    since: Option<Duration>,
    /// How fast it went outward when it last began to lose speed, and until when it is waited for because it
    /// has lost much of it.
    away_m_s: f64,
    brakes_until: Duration,
}

impl CarriedOff {
    /// Takes in how the drone moves in a fence of this radius.
    pub(super) fn see(&mut self, now: &Circumstances, radius_m: f64) {
        let [right_m_s, forward_m_s, _] = now.velocity_m_s;
        let away_m_s = outward(now, [right_m_s, forward_m_s]);
        if Self::stops(now, away_m_s, radius_m) {
            *self = Self::default();
            return;
        }
        if self.since.is_none() {
            *self = Self { since: Some(now.now), away_m_s, brakes_until: Duration::ZERO };
        }
        if away_m_s < self.away_m_s - BRAKES_M_S {
            self.away_m_s = away_m_s;
            self.brakes_until = now.now + BRAKES;
        }
        self.away_m_s = self.away_m_s.max(away_m_s);
    }

    /// Since when, if it is.
    pub(super) fn since(&self) -> Option<Duration> {
        self.since
    }

    /// Whether it has been for so long that it is no gust.
    pub(super) fn lasts(&self, now: Duration) -> bool {
        self.since.is_some_and(|since| now.saturating_sub(since) >= GUST)
            && now >= self.brakes_until
    }

    /// Whether it comes to rest inside, leaning against its motion as far as it can. Where it is not seen
    /// nobody knows.
    fn stops(now: &Circumstances, away_m_s: f64, radius_m: f64) -> bool {
        let room_m = radius_m + MARGIN_M - now.pose.x_m.hypot(now.pose.y_m);
        // What pushes it is told as that of a drone at rest: one that flies with the wind is pushed less.
        let dragged_m_s2 = now.drag_1_s * away_m_s / 2.0;
        let braking_m_s2 = now.full_tilt_m_s2 * (1.0 - outward(now, now.wind)) + dragged_m_s2;
        let way_m = away_m_s * REACTION_S + away_m_s * away_m_s / (2.0 * braking_m_s2);
        away_m_s <= SLOW_M_S
            || now.blind_for > super::STALE
            || braking_m_s2 > 0.0 && way_m <= room_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::safety::tests::FINE;

    const RADIUS_M: f64 = 10.0;
    const STORM: [f64; 2] = [0.0, -1.1];

    /// After how long a drone is carried off that is 3 m inside its fence, and goes backward so fast.
    fn carried_off_after(
        change: impl Fn(Circumstances) -> Circumstances,
        away_m_s: impl Fn(f64) -> f64,
    ) -> Option<Duration> {
        let mut carried = CarriedOff::default();
        (0_u32..100).map(|tick| Duration::from_millis(30) * tick).find(|time| {
            let mut now = change(Circumstances { now: FINE.now + *time, ..FINE });
            now.pose.y_m = 3.0 - RADIUS_M;
            now.velocity_m_s = [0.0, -away_m_s(time.as_secs_f64()), 0.0];
            carried.see(&now, RADIUS_M);
            carried.lasts(now.now)
        })
    }

    #[test]
    fn a_storm_carries_off_what_cannot_brake_before_the_fence() {
        let after =
            |wind, away_m_s| carried_off_after(|now| Circumstances { wind, ..now }, |_| away_m_s);
        let soon = Some(GUST);
        let within = |time: Option<Duration>| time.is_some_and(|time| time <= GUST * 2);
        assert!(after(STORM, 1.0) >= soon && within(after(STORM, 1.0)));
        assert!(within(after([0.0, -0.98], 1.0)), "it leans against more, but not enough");
        assert_eq!(after(STORM, 0.2), None, "it holds its place");
        assert_eq!(after([0.0, -0.5], 1.0), None, "it can brake");
        assert_eq!(after([0.0, 1.1], 1.0), None, "the wind brakes it");
        assert_eq!(after([1.1, 0.0], 1.0), None, "the wind comes from the side");
        let blind = |now| Circumstances { wind: STORM, blind_for: Duration::from_secs(1), ..now };
        assert_eq!(carried_off_after(blind, |_| 1.0), None, "nobody knows");
    }

    #[test]
    fn a_gust_passes() {
        let wind = |now: Circumstances| {
            let gust_ends = FINE.now + GUST.saturating_sub(Duration::from_millis(60));
            Circumstances { wind: if now.now < gust_ends { STORM } else { [0.0; 2] }, ..now }
        };
        assert_eq!(carried_off_after(wind, |_| 1.0), None);
        // What is taken for a storm is none while the drone loses its speed.
        let storm = |now| Circumstances { wind: STORM, ..now };
        let braking = |s: f64| (3.0 - 1.2 * s).max(0.0);
        assert_eq!(carried_off_after(storm, braking), None);
    }
}
