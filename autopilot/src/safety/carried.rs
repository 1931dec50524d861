//! Detects a drone that the wind carries over the fence: it moves outward and cannot brake in time.
//!
//! A drone that is landed only after it has left the fence has been carried towards it for a while, and its
//! own landing drifts further the higher it begins. Landing is therefore ordered as soon as this is detected.

use std::time::Duration;

use super::{BRAKES, BRAKES_M_S, GUST, MARGIN_M, REACTION_S, Situation, outward};

/// Outward speed up to which a drone counts as holding its position, in m/s.
const SLOW_M_S: f64 = 0.3;

/// How long the drone has been carried outward faster than it can brake.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct CarriedOff {
    since: Option<Duration>,
    /// Largest outward speed since it last fell, and until when a braking drone is given time.
    away_m_s: f64,
    brakes_until: Duration,
}

impl CarriedOff {
    /// Handles the motion of one tick in a fence of this radius.
    pub(super) fn see(&mut self, now: &Situation, radius_m: f64) {
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

    /// Since when the drone is being carried off.
    pub(super) fn since(&self) -> Option<Duration> {
        self.since
    }

    /// Whether it has lasted longer than a gust.
    pub(super) fn lasts(&self, now: Duration) -> bool {
        self.since.is_some_and(|since| now.saturating_sub(since) >= GUST)
            && now >= self.brakes_until
    }

    /// Whether the drone comes to rest inside the fence at full tilt against its motion. Assumed if navdata
    /// are too old to tell.
    fn stops(now: &Situation, away_m_s: f64, radius_m: f64) -> bool {
        let room_m = radius_m + MARGIN_M - now.pose.x_m.hypot(now.pose.y_m);
        // The disturbance refers to a drone at rest; one that moves with the wind experiences less of it.
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

    /// Time until a drone is carried off that is 3 m inside its fence and moves backward at the given speed.
    fn carried_off_after(
        change: impl Fn(Situation) -> Situation,
        away_m_s: impl Fn(f64) -> f64,
    ) -> Option<Duration> {
        let mut carried = CarriedOff::default();
        (0_u32..100).map(|tick| Duration::from_millis(30) * tick).find(|time| {
            let mut now = change(Situation { now: FINE.now + *time, ..FINE });
            now.pose.y_m = 3.0 - RADIUS_M;
            now.velocity_m_s = [0.0, -away_m_s(time.as_secs_f64()), 0.0];
            carried.see(&now, RADIUS_M);
            carried.lasts(now.now)
        })
    }

    #[test]
    fn a_storm_carries_off_what_cannot_brake_before_the_fence() {
        let after =
            |wind, away_m_s| carried_off_after(|now| Situation { wind, ..now }, |_| away_m_s);
        let soon = Some(GUST);
        let within = |time: Option<Duration>| time.is_some_and(|time| time <= GUST * 2);
        assert!(after(STORM, 1.0) >= soon && within(after(STORM, 1.0)));
        assert!(within(after([0.0, -0.98], 1.0)), "it leans against more, but not enough");
        assert_eq!(after(STORM, 0.2), None, "it holds its place");
        assert_eq!(after([0.0, -0.5], 1.0), None, "it can brake");
        assert_eq!(after([0.0, 1.1], 1.0), None, "the wind brakes it");
        assert_eq!(after([1.1, 0.0], 1.0), None, "the wind comes from the side");
        let blind = |now| Situation { wind: STORM, blind_for: Duration::from_secs(1), ..now };
        assert_eq!(carried_off_after(blind, |_| 1.0), None, "nobody knows");
    }

    #[test]
    fn a_gust_passes() {
        let wind = |now: Situation| {
            let gust_ends = FINE.now + GUST.saturating_sub(Duration::from_millis(60));
            Situation { wind: if now.now < gust_ends { STORM } else { [0.0; 2] }, ..now }
        };
        assert_eq!(carried_off_after(wind, |_| 1.0), None);
        // While the drone decelerates, a gust is not taken for a storm.
        let storm = |now| Situation { wind: STORM, ..now };
        let braking = |s: f64| (3.0 - 1.2 * s).max(0.0);
        assert_eq!(carried_off_after(storm, braking), None);
    }
}
