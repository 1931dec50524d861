//! A horizontal reference that follows a wanted velocity, which may change in every step.

use nalgebra::Vector2;

use crate::motion::MotionLimits;

/// Time in which the velocity follows the wanted one.
const RESPONSE_S: f64 = 0.15;
/// Near its place the speed is this share of the distance, in 1/s: slow enough for [`RESPONSE_S`] not to overshoot.
const APPROACH_1_S: f64 = 1.8;

impl MotionLimits {
    /// The largest speed from which a [`Course`] comes to rest within a distance; zero for a negative one. It brakes with half of
    /// the acceleration, and near the end its speed is proportional to the distance that is left.
    pub fn speed_before_stop_m_s(&self, distance_m: f64) -> f64 {
        // Half of the acceleration is left for the time in which the velocity follows.
        let braking_m_s2 = self.acceleration_m_s2 / 2.0;
        let near_m = braking_m_s2 / (APPROACH_1_S * APPROACH_1_S);
        if distance_m <= near_m {
            return (APPROACH_1_S * distance_m).max(0.0);
        }
        (2.0 * braking_m_s2 * (distance_m - near_m / 2.0)).sqrt()
    }
}

/// A point that moves smoothly, and its motion: (x, y) in the world frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// Where it is.
    pub position_m: Vector2<f64>,
    /// Its velocity.
    pub velocity_m_s: Vector2<f64>,
    /// Its acceleration.
    pub acceleration_m_s2: Vector2<f64>,
}

impl Course {
    /// A course that begins with this motion, without acceleration.
    pub fn new(position_m: Vector2<f64>, velocity_m_s: Vector2<f64>) -> Self {
        Self { position_m, velocity_m_s, acceleration_m_s2: Vector2::zeros() }
    }

    /// Velocity that leads to a place, with the largest speed from which the course comes to rest there.
    pub fn velocity_to(&self, place_m: &Vector2<f64>, limits: &MotionLimits) -> Vector2<f64> {
        let way_m = place_m - self.position_m;
        let speed_m_s = limits.speed_before_stop_m_s(way_m.norm());
        way_m.try_normalize(f64::EPSILON).map_or_else(Vector2::zeros, |way| way * speed_m_s)
    }

    /// Moves on for `step_s`, towards the wanted velocity, within the limits.
    pub fn advance(&mut self, wanted_m_s: Vector2<f64>, limits: &MotionLimits, step_s: f64) {
        let wanted_m_s = wanted_m_s.cap_magnitude(limits.speed_m_s);
        let wanted_m_s2 =
            ((wanted_m_s - self.velocity_m_s) / RESPONSE_S).cap_magnitude(limits.acceleration_m_s2);
        let change_m_s2 = wanted_m_s2 - self.acceleration_m_s2;
        self.acceleration_m_s2 += change_m_s2.cap_magnitude(limits.jerk_m_s3 * step_s);
        self.position_m +=
            self.velocity_m_s * step_s + self.acceleration_m_s2 * (step_s * step_s / 2.0);
        self.velocity_m_s += self.acceleration_m_s2 * step_s;
    }

    /// Whether all its numbers are finite.
    pub(crate) fn is_finite(&self) -> bool {
        let Self { position_m, velocity_m_s, acceleration_m_s2 } = self;
        [position_m, velocity_m_s, acceleration_m_s2]
            .iter()
            .all(|vector| vector.iter().all(|value| value.is_finite()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: MotionLimits =
        MotionLimits { speed_m_s: 2.0, acceleration_m_s2: 1.4, jerk_m_s3: 14.0 };
    const STEP_S: f64 = 0.03;

    fn at_rest() -> Course {
        Course::new(Vector2::zeros(), Vector2::zeros())
    }

    #[test]
    fn a_velocity_is_reached_and_left_within_the_limits() {
        let mut course = at_rest();
        let wanted_m_s = Vector2::new(1.5, 0.5);
        for _ in 0..100 {
            course.advance(wanted_m_s, &LIMITS, STEP_S);
            assert!(course.acceleration_m_s2.norm() <= LIMITS.acceleration_m_s2 + 1e-9);
            assert!(course.velocity_m_s.norm() <= wanted_m_s.norm() * 1.05, "{course:?}");
        }
        assert!((course.velocity_m_s - wanted_m_s).norm() < 0.01, "{course:?}");
        course.advance(Vector2::new(99.0, 0.0), &LIMITS, STEP_S);
        for _ in 0..100 {
            course.advance(Vector2::new(99.0, 0.0), &LIMITS, STEP_S);
            assert!(course.velocity_m_s.norm() <= LIMITS.speed_m_s * 1.05, "{course:?}");
        }
    }

    #[test]
    fn a_place_is_reached_without_going_beyond() {
        for far_m in [0.05, 0.3, 1.0, 3.0, 9.0] {
            let (mut course, place_m) = (at_rest(), Vector2::new(far_m, 0.0));
            for _ in 0..400 {
                course.advance(course.velocity_to(&place_m, &LIMITS), &LIMITS, STEP_S);
                assert!(course.position_m.x < far_m + 0.03, "{far_m} {course:?}");
            }
            assert!((course.position_m - place_m).norm() < 0.01, "{far_m} {course:?}");
        }
    }

    #[test]
    fn it_stands_still_without_limits_to_move_in() {
        let nothing = MotionLimits { speed_m_s: 0.0, acceleration_m_s2: 0.0, jerk_m_s3: 0.0 };
        let mut course = at_rest();
        course.advance(course.velocity_to(&Vector2::new(1.0, 1.0), &nothing), &nothing, STEP_S);
        assert_eq!(course, at_rest());
        assert!(course.is_finite());
        assert!(!Course::new(Vector2::new(f64::NAN, 0.0), Vector2::zeros()).is_finite());
    }
}
