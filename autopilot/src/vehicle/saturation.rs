//! Detects a drone that is too weak for the wind: its sticks are at their limit and it still drifts away from
//! its target, or makes no progress towards it.
//!
//! A frozen optical-flow velocity looks the same: full tilt without visible motion.
//!
//! The estimated wind alone is not accurate enough to decide by, because the estimate also contains the
//! modelling error of the airframe. What matters is whether the drone holds its position. A disturbance
//! counts by itself only if it was absent after take-off and takes as much of full tilt as a storm: it is one, or a
//! velocity measurement that drifts, which nothing else detects.

use estimator::Prediction;
use kinematics::{Pose, Sticks};
use nalgebra::Vector3;

/// Sticks beyond this fraction of their limit count as saturated; the control law keeps a small reserve.
const FULL: f64 = 0.95;
/// Speed above which a drone drifts away, in m/s.
const DRIFT_M_S: f64 = 0.1;
/// Speed below which a drone makes no progress, in m/s.
const STILL_M_S: f64 = 0.02;
/// Distance beyond which a saturated drone must make progress, in metres.
const FAR_M: f64 = 0.5;
/// Distance below which the direction to the target is not defined, in metres.
const HERE_M: f64 = 0.2;

/// A drone that is far from its target and gets less than this nearer, in metres, within this time, in
/// seconds, makes no progress whatever its sticks do: either the wind holds it, or its velocity measurement
/// is frozen and it is flying away. Nor does one that flies all this time, near its target but never there: it circles
/// around it, because its velocity measurement is late.
const WAY_M: f64 = 0.05;
const NO_WAY_S: f64 = 6.0;

/// Speed from which a drone flies, in m/s: one that holds its position is slower.
const FLIES_M_S: f64 = 0.4;

/// How long the drone has been drifting away with saturated sticks.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Saturation {
    for_s: f64,
    way: Way,
}

/// Smallest distance to the target so far, and how long ago it was reached.
#[derive(Debug, Clone, Copy, Default)]
struct Way {
    target: Pose,
    nearest_m: f64,
    for_s: f64,
}

impl Way {
    /// Whether the drone makes no progress.
    fn is_blocked(&mut self, target: &Pose, distance_m: f64, speed_m_s: f64, step_s: f64) -> bool {
        if *target != self.target || distance_m < self.nearest_m - WAY_M {
            *self = Self { target: *target, nearest_m: distance_m, for_s: 0.0 };
        }
        let circles = distance_m > HERE_M && speed_m_s > FLIES_M_S;
        self.for_s = if distance_m > FAR_M || circles { self.for_s + step_s } else { 0.0 };
        self.for_s > NO_WAY_S
    }
}

impl Saturation {
    /// Handles one tick of flying to a target, in a storm or not. The counter does not start anew with a
    /// tick of progress, but runs down twice as fast as it ran up: progress now and then is not enough to hold a position.
    pub(super) fn watch(
        &mut self,
        demand: &Sticks,
        limit: f64,
        state: &Prediction,
        target: &Pose,
        storm: bool,
        step_s: f64,
    ) {
        let away = state.position_m - Vector3::new(target.x_m, target.y_m, target.z_m);
        let across_m = away.xy().norm();
        let drift_m_s = state.velocity_m_s.xy().dot(&away.xy()) / across_m.max(f64::EPSILON);
        let climbs_off_m_s = state.velocity_m_s.z * away.z.signum();
        let is_full = |stick: f64| stick.abs() >= FULL * limit;
        let across = is_full(demand.roll.hypot(demand.pitch)) && drifts_off(across_m, drift_m_s);
        let up = is_full(demand.gaz) && drifts_off(away.z.abs(), climbs_off_m_s);
        let speed_m_s = state.velocity_m_s.xy().norm();
        let blocked = self.way.is_blocked(target, away.norm(), speed_m_s, step_s);
        let change_s = if across || up || storm || blocked { step_s } else { -2.0 * step_s };
        self.for_s = (self.for_s + change_s).max(0.0);
    }

    /// Handles one tick in which the drone holds its position by itself: its tilt then balances the
    /// disturbance.
    pub(super) fn rest(&mut self, step_s: f64) {
        self.way = Way::default();
        self.for_s = (self.for_s - step_s).max(0.0);
    }

    /// The duration in milliseconds.
    pub(super) fn for_ms(self) -> i64 {
        // Bounded by the length of a flight.
        #[allow(clippy::cast_possible_truncation)]
        let for_ms = (self.for_s * 1e3).round() as i64;
        for_ms
    }
}

/// Whether a drone at this distance from its target, which grows at this speed, does not get there.
fn drifts_off(distance_m: f64, speed_m_s: f64) -> bool {
    distance_m > HERE_M && speed_m_s > DRIFT_M_S || distance_m > FAR_M && speed_m_s > -STILL_M_S
}

#[cfg(test)]
mod tests {
    use super::*;

    const TARGET: Pose = Pose { x_m: 0.0, y_m: 0.0, z_m: 1.0, yaw_deg: 0.0 };

    #[test]
    fn near_its_target_a_drone_may_stand_still_but_not_drift_off() {
        for (distance_m, speed_m_s, expected) in [
            (HERE_M, 0.5, false),
            (0.3, 0.15, true),
            (0.3, DRIFT_M_S, false),
            (0.3, 0.0, false),
            (FAR_M, 0.0, false),
            (0.6, 0.0, true),
            (0.6, -0.01, true),
            (0.6, -STILL_M_S, false),
            (0.6, -0.1, false),
        ] {
            let found = drifts_off(distance_m, speed_m_s);
            assert_eq!(found, expected, "{distance_m} m, {speed_m_s} m/s");
        }
    }

    #[test]
    fn the_drift_is_the_speed_away_from_the_target_in_any_place() {
        let full = Sticks { roll: -1.0, gaz: -1.0, ..Sticks::default() };
        let is_counted = |away: [f64; 3], velocity: [f64; 3]| {
            let target = Pose { x_m: 4.0, y_m: -3.0, z_m: 2.0, yaw_deg: 0.0 };
            let state = Prediction {
                position_m: Vector3::new(4.0, -3.0, 2.0) + Vector3::from(away),
                velocity_m_s: velocity.into(),
                ..Prediction::default()
            };
            let mut saturation = Saturation::default();
            saturation.watch(&full, 1.0, &state, &target, false, 0.01);
            saturation.for_ms() > 0
        };
        assert!(is_counted([0.4, 0.0, 0.0], [0.15, 0.0, 0.0]));
        assert!(!is_counted([0.4, 0.0, 0.0], [0.05, 0.5, 0.0]), "it passes by");
        assert!(!is_counted([0.0, -3.0, 0.0], [0.0, 0.03, 0.0]), "slowly, but it comes");
        assert!(is_counted([0.0, -3.0, 0.0], [0.0, 0.01, 0.0]));
        assert!(is_counted([0.0, 0.0, 0.4], [0.0, 0.0, 0.15]));
        assert!(!is_counted([0.0, 0.0, 0.4], [0.0, 0.0, -0.15]));
        assert!(is_counted([0.0, 0.0, -0.4], [0.0, 0.0, -0.15]));
        assert!(!is_counted([0.0, 0.0, -0.4], [0.0, 0.0, 0.15]));
    }

    #[test]
    fn sticks_are_full_at_the_limit_of_the_plan() {
        let right = Prediction { position_m: Vector3::new(1.0, 0.0, 1.0), ..Prediction::default() };
        let is_full = |demand: Sticks| {
            let mut saturation = Saturation::default();
            saturation.watch(&demand, 0.5, &right, &TARGET, false, 0.01);
            saturation.for_ms() > 0
        };
        assert!(is_full(Sticks { roll: -0.48, ..Sticks::default() }));
        assert!(!is_full(Sticks { roll: -0.47, ..Sticks::default() }));
        assert!(is_full(Sticks { roll: -0.36, pitch: 0.36, ..Sticks::default() }), "both together");
    }

    #[test]
    fn progress_takes_back_twice_the_time_and_rest_as_much() {
        let full = Sticks { roll: -1.0, ..Sticks::default() };
        let moving = |x_m_s| Prediction {
            position_m: Vector3::new(1.0, 0.0, 1.0),
            velocity_m_s: Vector3::new(x_m_s, 0.0, 0.0),
            ..Prediction::default()
        };
        let mut saturation = Saturation { for_s: 1.0, ..Saturation::default() };
        for _ in 0..25 {
            saturation.watch(&full, 1.0, &moving(-0.5), &TARGET, false, 0.01);
        }
        assert_eq!(saturation.for_ms(), 500);
        for _ in 0..25 {
            saturation.rest(0.01);
        }
        assert_eq!(saturation.for_ms(), 250);
    }

    #[test]
    fn no_way_is_made_only_far_from_the_target_and_after_its_time() {
        let ticks_until_blocked = |distance_m, speed_m_s| {
            let mut way = Way::default();
            (1..100).find(|_| way.is_blocked(&TARGET, distance_m, speed_m_s, 0.5))
        };
        // Exactly six seconds are twelve ticks.
        assert_eq!(ticks_until_blocked(3.0, 0.0), Some(13));
        assert_eq!(ticks_until_blocked(FAR_M, 0.0), None);
        assert_eq!(ticks_until_blocked(0.45, 0.9), Some(13), "it circles");
        assert_eq!(ticks_until_blocked(0.45, FLIES_M_S), None, "it holds, aside");
        assert_eq!(ticks_until_blocked(HERE_M, 0.9), None, "it is there");
        let mut way = Way { target: TARGET, nearest_m: 3.0, for_s: 5.75 };
        assert!(way.is_blocked(&TARGET, 3.0 - WAY_M, 0.0, 0.5), "that is no way yet");
        let mut way = Way { target: TARGET, nearest_m: 3.0, for_s: 5.75 };
        assert!(!way.is_blocked(&TARGET, 2.9 - WAY_M, 0.0, 0.5));
    }

    fn after_a_second(demand: Sticks, position: [f64; 3], velocity: [f64; 3]) -> i64 {
        let state = Prediction {
            position_m: position.into(),
            velocity_m_s: velocity.into(),
            ..Prediction::default()
        };
        let mut saturation = Saturation::default();
        for _ in 0..100 {
            saturation.watch(&demand, 1.0, &state, &TARGET, false, 0.01);
        }
        saturation.for_ms()
    }

    #[test]
    fn only_a_drone_that_drifts_off_at_full_stick_is_too_weak() {
        let full = Sticks { roll: -1.0, ..Sticks::default() };
        let half = Sticks { roll: -0.5, ..Sticks::default() };
        let sinking = Sticks { gaz: 1.0, ..Sticks::default() };
        let (right, low) = ([1.0, 0.0, 1.0], [0.0, 0.0, 0.5]);
        assert_eq!(after_a_second(full, right, [0.5, 0.0, 0.0]), 1000);
        assert_eq!(after_a_second(full, right, [-0.5, 0.0, 0.0]), 0, "it comes back");
        assert_eq!(after_a_second(half, right, [0.5, 0.0, 0.0]), 0, "there is more");
        assert_eq!(after_a_second(full, right, [0.0, 0.0, 0.0]), 1000, "it comes no nearer");
        assert_eq!(after_a_second(full, [0.3, 0.0, 1.0], [0.0; 3]), 0, "it holds");
        assert_eq!(after_a_second(sinking, low, [0.0, 0.0, -0.3]), 1000);
        assert_eq!(after_a_second(sinking, low, [0.0, 0.0, 0.3]), 0);
    }

    #[test]
    fn a_storm_counts_wherever_the_drone_is_and_whatever_its_sticks() {
        let lasts_ms = |storm| {
            let mut saturation = Saturation::default();
            for _ in 0..100 {
                let here = Pose { z_m: 0.0, ..TARGET };
                saturation.watch(
                    &Sticks::default(),
                    1.0,
                    &Prediction::default(),
                    &here,
                    storm,
                    0.01,
                );
            }
            saturation.for_ms()
        };
        assert_eq!([lasts_ms(false), lasts_ms(true)], [0, 1000]);
    }

    #[test]
    fn a_drone_that_makes_no_way_is_noticed_whatever_its_sticks() {
        let lasts_ms = |speed_m_s: f64| {
            let mut saturation = Saturation::default();
            for step in 0..1000_u32 {
                let x_m = 3.0 - speed_m_s * 0.01 * f64::from(step);
                let position_m = Vector3::new(x_m, 0.0, 1.0);
                let state = Prediction { position_m, ..Prediction::default() };
                saturation.watch(&Sticks::default(), 1.0, &state, &TARGET, false, 0.01);
            }
            saturation.for_ms()
        };
        assert!(lasts_ms(0.0) > 2000, "{}", lasts_ms(0.0));
        assert_eq!(lasts_ms(0.1), 0, "slowly, but it comes");
    }

    #[test]
    fn what_passes_is_forgotten() {
        let mut saturation = Saturation { for_s: 1.5, ..Saturation::default() };
        for _ in 0..100 {
            saturation.rest(0.02);
        }
        assert_eq!(saturation.for_ms(), 0);
    }
}
