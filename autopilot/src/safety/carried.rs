//! Detects a drone that the wind carries over the fence: it moves outward and cannot brake in time.
//!
//! A drone that is landed only after it has left the fence has been carried towards it for a while, and its
//! own landing drifts further the higher it begins. Landing is therefore ordered as soon as this is detected.

use std::time::Duration;

use super::{BRAKES, BRAKES_M_S, GUST, MARGIN_M, REACTION_S, Situation, Stopping};
use crate::fence::{Border, across};

/// Speed up to which a drone counts as holding its position, in m/s.
const SLOW_M_S: f64 = 0.3;

/// Smallest wind in the direction of motion that carries a drone off, as a fraction of the acceleration at full
/// tilt. In less wind a drone that cannot brake before the fence is too fast by its own sticks, and turns or
/// brakes by them.
const STORM: f64 = 0.7;
/// Time after which a drone that could brake again is no longer carried off: leaning against a storm stops it
/// for a moment.
const LULL: Duration = Duration::from_millis(500);
/// A storm is leant against once it would carry the drone over the fence within this time at its speed.
const SOON_S: f64 = 6.0;

/// How long the drone has been carried outward faster than it can brake.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct CarriedOff {
    since: Option<Duration>,
    /// Since when the drone could brake again.
    stops_since: Option<Duration>,
    /// Largest speed since it last fell, and until when a braking drone is given time.
    away_m_s: f64,
    brakes_until: Duration,
    /// Whether the fence is so near that the drone must lean against the wind at once.
    near_fence: bool,
    /// Whether it has been so near since the storm began.
    was_near: bool,
}

impl CarriedOff {
    /// Handles the motion of one tick within this border.
    pub(super) fn see(&mut self, now: &Situation, border: &Border) {
        let motion = Motion::of(now);
        let away_m_s = motion.speed_m_s;
        if now.blind_for > super::STALE {
            *self = Self::default();
            return;
        }
        if motion.stops(now, border) {
            let stops_since = *self.stops_since.get_or_insert(now.now);
            if now.now.saturating_sub(stops_since) >= LULL {
                *self = Self::default();
            }
            return;
        }
        self.stops_since = None;
        if self.since.is_none() {
            *self = Self { since: Some(now.now), ..Self::default() };
        }
        self.near_fence = motion.room_m(now, border, 0.0) <= motion.speed_m_s * SOON_S;
        self.was_near |= self.near_fence;
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

    /// Whether the drone must lean against the wind before it is known to last.
    pub(super) fn leans(&self) -> bool {
        self.since.is_some() && self.near_fence
    }

    /// Whether it has lasted longer than a gust. A storm that does not lead to the fence soon is left to the agent,
    /// which lands when the sticks stay saturated: the gusts of a fair day are storms to a drone that hardly tilts.
    pub(super) fn lasts(&self, now: Duration) -> bool {
        self.was_near
            && self.since.is_some_and(|since| now.saturating_sub(since) >= GUST)
            && now >= self.brakes_until
            && self.stops_since.is_none()
    }
}

/// Horizontal motion of the drone.
#[derive(Debug, Clone, Copy)]
struct Motion {
    speed_m_s: f64,
    /// Unit vector towards right and forward; zero at rest.
    heading: [f64; 2],
}

impl Motion {
    fn of(now: &Situation) -> Self {
        let [right_m_s, forward_m_s, _] = now.velocity_m_s;
        let speed_m_s = right_m_s.hypot(forward_m_s);
        let share = 1.0 / speed_m_s.max(f64::EPSILON);
        Self { speed_m_s, heading: [right_m_s * share, forward_m_s * share] }
    }

    /// Whether no storm keeps the drone from coming to rest inside the fence at full tilt against its motion.
    fn stops(&self, now: &Situation, border: &Border) -> bool {
        // The disturbance refers to a drone at rest; one that moves with the wind experiences less of it.
        let dragged_m_s2 = now.drag_1_s * self.speed_m_s / 2.0;
        let braking_m_s2 = now.full_tilt_m_s2 * (1.0 - self.along(now.wind)) + dragged_m_s2;
        let way_m = Stopping { delay_s: REACTION_S, braking_m_s2 }.way_m(self.speed_m_s);
        self.speed_m_s <= SLOW_M_S
            || self.along(now.wind) < STORM
            || braking_m_s2 > 0.0 && way_m <= self.room_m(now, border, MARGIN_M)
    }

    /// Distance in the direction of motion until the drone is this far outside.
    fn room_m(&self, now: &Situation, border: &Border, beyond_m: f64) -> f64 {
        border.room_m(across(&now.pose), self.heading.into(), beyond_m)
    }

    /// The component in the direction of motion.
    fn along(&self, [right, forward]: [f64; 2]) -> f64 {
        right * self.heading[0] + forward * self.heading[1]
    }
}

#[cfg(test)]
mod tests {
    use kinematics::Pose;

    use super::*;
    use crate::safety::tests::FINE;

    const RADIUS_M: f64 = 10.0;
    const ROUND: Border = Border::circle(RADIUS_M);
    const TO_THE_REAR: [f64; 2] = [0.0, -1.1];

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
            carried.see(&now, &ROUND);
            carried.lasts(now.now)
        })
    }

    #[test]
    fn a_storm_carries_off_what_cannot_brake_before_the_fence() {
        let after =
            |wind, away_m_s| carried_off_after(|now| Situation { wind, ..now }, |_| away_m_s);
        let soon = Some(GUST);
        let within = |time: Option<Duration>| time.is_some_and(|time| time <= GUST * 2);
        assert!(after(TO_THE_REAR, 1.0) >= soon && within(after(TO_THE_REAR, 1.0)));
        assert!(within(after([0.0, -0.98], 1.0)), "it leans against more, but not enough");
        assert_eq!(after(TO_THE_REAR, 0.2), None, "it holds its place");
        assert_eq!(after([0.0, -0.5], 1.0), None, "it can brake");
        assert_eq!(after([0.0, 1.1], 1.0), None, "the wind brakes it");
        assert_eq!(after([1.1, 0.0], 1.0), None, "the wind comes from the side");
        let blind = |now| Situation { wind: TO_THE_REAR, blind_for: Duration::from_secs(1), ..now };
        assert_eq!(carried_off_after(blind, |_| 1.0), None, "nobody knows");
    }

    #[test]
    fn a_gust_passes() {
        let wind = |now: Situation| {
            let gust_ends = FINE.now + GUST.saturating_sub(Duration::from_millis(60));
            Situation { wind: if now.now < gust_ends { TO_THE_REAR } else { [0.0; 2] }, ..now }
        };
        assert_eq!(carried_off_after(wind, |_| 1.0), None);
        // While the drone decelerates, a gust is not taken for a storm.
        let storm = |now| Situation { wind: TO_THE_REAR, ..now };
        let braking = |s: f64| (3.0 - 1.2 * s).max(0.0);
        assert_eq!(carried_off_after(storm, braking), None);
    }

    #[test]
    fn room_is_measured_in_the_direction_of_motion() {
        // Seen from the fence's centre, the drone moves neither outward nor inward.
        let pose = Pose { x_m: 6.0, ..FINE.pose };
        let now = Situation { pose, velocity_m_s: [0.0, -3.0, 0.0], ..FINE };
        let room_m = Motion::of(&now).room_m(&now, &ROUND, 0.0);
        assert!((room_m - 8.0).abs() < 1e-9, "{room_m}");
        let pose_aside = Pose { x_m: 6.0, y_m: 2.0, ..FINE.pose };
        let aside = Situation { pose: pose_aside, velocity_m_s: [3.0, 3.0, 0.0], ..now };
        let room_m = Motion::of(&aside).room_m(&aside, &ROUND, 0.0);
        assert!((room_m - (92.0_f64.sqrt() - 32.0_f64.sqrt())).abs() < 1e-9, "{room_m}");
        let back = Situation { velocity_m_s: [-3.0, 0.0, 0.0], ..now };
        assert!((Motion::of(&back).room_m(&back, &ROUND, 0.0) - 16.0).abs() < 1e-9);
        let outside = Situation { pose: Pose { x_m: 11.0, ..pose }, ..now };
        assert!(Motion::of(&outside).room_m(&outside, &ROUND, 0.0) <= 0.0);
    }

    #[test]
    fn a_wind_that_the_controller_can_brake_against_is_no_storm() {
        let see = |wind, velocity_m_s| {
            let mut carried = CarriedOff::default();
            let pose = Pose { y_m: 1.0 - RADIUS_M, ..FINE.pose };
            carried.see(&Situation { pose, velocity_m_s, wind, ..FINE }, &ROUND);
            (carried.since().is_some(), carried.leans())
        };
        let backward = [0.0, -2.0, 0.0];
        assert_eq!(see(TO_THE_REAR, backward), (true, true));
        assert_eq!(see([0.0, -0.5], backward), (false, false), "it flies too fast by its sticks");
        assert_eq!(see(TO_THE_REAR, [0.0; 3]), (false, false));
        let toward_the_far_side = [0.0, 2.0, 0.0];
        assert_eq!(see([0.0, 1.1], toward_the_far_side), (true, false), "there is time");
    }

    #[test]
    fn the_way_to_brake_is_what_is_left_of_full_tilt() {
        // The braking acceleration is 0.4 m/s² of tilt and 0.3 m/s² of drag, so the way is 1.5 m + 9 m² / 1.4 m.
        let stops = |room_m: f64, wind: f64| {
            let pose = Pose { y_m: room_m - RADIUS_M - MARGIN_M, ..FINE.pose };
            let velocity_m_s = [0.0, -3.0, 0.0];
            let now = Situation { pose, velocity_m_s, wind: [0.0, -wind], ..FINE };
            Motion::of(&now).stops(&now, &ROUND)
        };
        assert!(stops(7.94, 0.8));
        assert!(!stops(7.92, 0.8));
        assert!(stops(0.1, STORM - 0.01), "less is no storm");
        assert!(!stops(0.1, STORM));
    }

    #[test]
    fn a_storm_near_the_fence_is_leant_against_at_once() {
        let leans = |room_m: f64| {
            let mut carried = CarriedOff::default();
            let pose = Pose { y_m: room_m - RADIUS_M, ..FINE.pose };
            let now = Situation { pose, velocity_m_s: [0.0, -0.5, 0.0], wind: TO_THE_REAR, ..FINE };
            carried.see(&now, &ROUND);
            carried.leans()
        };
        assert!(leans(0.5 * SOON_S - 0.1));
        assert!(!leans(0.5 * SOON_S + 0.1));
    }

    #[test]
    fn a_storm_lands_once_it_would_carry_the_drone_over_the_fence_soon() {
        let storm = |now| Situation { wind: TO_THE_REAR, ..now };
        // There are 3 m to the fence.
        let slow_m_s = 3.0 / SOON_S - 0.1;
        let fast_m_s = 3.0 / SOON_S + 0.1;
        assert_eq!(carried_off_after(storm, move |_| slow_m_s), None);
        let late_s = GUST.as_secs_f64() + 0.5;
        let quickens =
            carried_off_after(storm, move |s| if s < late_s { slow_m_s } else { fast_m_s });
        assert!(
            quickens >= Some(Duration::from_secs_f64(late_s)) && quickens <= Some(GUST * 2),
            "{quickens:?}"
        );
        let slows = carried_off_after(storm, move |s| if s < 0.5 { fast_m_s } else { slow_m_s });
        assert_eq!(slows, Some(GUST), "it has been near");
    }

    #[test]
    fn a_storm_goes_on_after_a_short_lull_only() {
        let since_after_a_lull_of = |lull: Duration| {
            let mut carried = CarriedOff::default();
            let pose = Pose { y_m: 3.0 - RADIUS_M, ..FINE.pose };
            let blows =
                Situation { pose, velocity_m_s: [0.0, -1.0, 0.0], wind: TO_THE_REAR, ..FINE };
            carried.see(&blows, &ROUND);
            carried.see(&Situation { wind: [0.0; 2], ..blows }, &ROUND);
            assert!(!carried.lasts(FINE.now + GUST), "it can brake");
            let later = Situation { now: FINE.now + lull, ..blows };
            carried.see(&Situation { wind: [0.0; 2], ..later }, &ROUND);
            carried.see(&later, &ROUND);
            carried.since()
        };
        assert_eq!(since_after_a_lull_of(LULL / 2), Some(FINE.now));
        assert_eq!(since_after_a_lull_of(LULL), Some(FINE.now + LULL));
    }

    #[test]
    fn navdata_may_be_as_old_as_those_that_are_flown_by() {
        let carried = |blind_for| {
            carried_off_after(|now| Situation { wind: TO_THE_REAR, blind_for, ..now }, |_| 1.0)
        };
        assert!(carried(crate::safety::STALE).is_some());
        assert_eq!(carried(crate::safety::STALE + Duration::from_millis(1)), None);
    }

    #[test]
    fn a_drone_that_lost_less_than_half_a_metre_per_second_does_not_brake() {
        let storm = |now| Situation { wind: TO_THE_REAR, ..now };
        let slows_by = |lost_m_s| {
            carried_off_after(storm, move |s| if s > 1.0 { 3.0 - lost_m_s } else { 3.0 })
        };
        assert_eq!(slows_by(BRAKES_M_S), Some(GUST));
        assert!(slows_by(BRAKES_M_S + 0.01) > Some(GUST));
    }
}
