//! Horizontal reference: jerk-limited motions from rest to rest.
//!
//! If the target changes on the way, a second motion is added to the first, which runs to its end. The sum is
//! as smooth as its parts and ends at the new target.

use arrayvec::ArrayVec;
use nalgebra::Vector2;

use crate::motion::MotionLimits;

/// Position, velocity, acceleration and jerk at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reference {
    pub(crate) position_m: Vector2<f64>,
    pub(crate) velocity_m_s: Vector2<f64>,
    pub(crate) acceleration_m_s2: Vector2<f64>,
    pub(crate) jerk_m_s3: Vector2<f64>,
}

/// A motion from rest to rest along a line: seven phases of constant jerk.
#[derive(Debug, Clone, Copy)]
struct Profile {
    jerk_m_s3: f64,
    /// Duration of each of the four jerk phases.
    jerk_s: f64,
    /// Duration of each of the two phases of constant acceleration.
    acceleration_s: f64,
    cruise_s: f64,
    length_m: f64,
}

impl Profile {
    fn new(length_m: f64, limits: &MotionLimits) -> Self {
        let MotionLimits { speed_m_s: v, acceleration_m_s2: a, jerk_m_s3: j } = *limits;
        let nothing =
            Self { jerk_m_s3: 0.0, jerk_s: 0.0, acceleration_s: 0.0, cruise_s: 0.0, length_m };
        if length_m <= 0.0 || v <= 0.0 || a <= 0.0 || j <= 0.0 {
            return nothing;
        }
        // The acceleration reached on the way to the maximum speed.
        let jerk_s = (a / j).min((v / j).sqrt());
        let ramp_s = if v * j < a * a { 2.0 * jerk_s } else { jerk_s + v / a };
        if length_m >= v * ramp_s {
            let cruise_s = (length_m - v * ramp_s) / v;
            let acceleration_s = ramp_s - 2.0 * jerk_s;
            return Self { jerk_m_s3: j, jerk_s, acceleration_s, cruise_s, length_m };
        }
        // The maximum speed is not reached.
        if length_m >= 2.0 * a.powi(3) / (j * j) {
            let jerk_s = a / j;
            let ramp_s = jerk_s / 2.0 + ((jerk_s / 2.0).powi(2) + length_m / a).sqrt();
            let acceleration_s = (ramp_s - 2.0 * jerk_s).max(0.0);
            return Self { jerk_m_s3: j, jerk_s, acceleration_s, ..nothing };
        }
        // Neither is the maximum acceleration.
        Self { jerk_m_s3: j, jerk_s: (length_m / (2.0 * j)).cbrt(), ..nothing }
    }

    fn phases(&self) -> [(f64, f64); 7] {
        let (j, jerk_s) = (self.jerk_m_s3, self.jerk_s);
        let constant = (self.acceleration_s, 0.0);
        [
            (jerk_s, j),
            constant,
            (jerk_s, -j),
            (self.cruise_s, 0.0),
            (jerk_s, -j),
            constant,
            (jerk_s, j),
        ]
    }

    fn duration_s(&self) -> f64 {
        self.phases().iter().map(|(seconds, _)| seconds).sum()
    }

    /// Distance, speed, acceleration and jerk at a time since the start.
    fn at(&self, time_s: f64) -> [f64; 4] {
        if time_s >= self.duration_s() {
            return [self.length_m, 0.0, 0.0, 0.0];
        }
        let (mut way, mut speed, mut acceleration) = (0.0, 0.0, 0.0);
        let mut left_s = time_s.max(0.0);
        let mut jerk = 0.0;
        for (seconds, phase_jerk) in self.phases() {
            let t = seconds.min(left_s);
            way += speed * t + acceleration * t * t / 2.0 + phase_jerk * t.powi(3) / 6.0;
            speed += acceleration * t + phase_jerk * t * t / 2.0;
            acceleration += phase_jerk * t;
            jerk = phase_jerk;
            left_s -= t;
            if left_s <= 0.0 {
                break;
            }
        }
        [way, speed, acceleration, jerk]
    }
}

/// A motion that has begun.
#[derive(Debug, Clone, Copy)]
struct Leg {
    direction: Vector2<f64>,
    profile: Profile,
    elapsed_s: f64,
}

impl Leg {
    fn is_over(&self) -> bool {
        self.elapsed_s >= self.profile.duration_s()
    }

    fn displacement_m(&self) -> Vector2<f64> {
        self.direction * self.profile.length_m
    }
}

/// Trajectory to a target that may change.
#[derive(Debug, Clone)]
pub(crate) struct Trajectory {
    /// Sum of the motions that have ended.
    origin_m: Vector2<f64>,
    target_m: Vector2<f64>,
    legs: ArrayVec<Leg, MAX_LEGS>,
}

/// Maximum number of motions added up at a time; beyond it the oldest are treated as ended.
const MAX_LEGS: usize = 4;

impl Trajectory {
    /// At rest.
    pub(crate) fn new(place_m: Vector2<f64>) -> Self {
        Self { origin_m: place_m, target_m: place_m, legs: ArrayVec::new() }
    }

    /// Starts a motion to a target, unless it is the current one.
    pub(crate) fn set_target(&mut self, target_m: Vector2<f64>, limits: &MotionLimits) {
        let way = target_m - self.target_m;
        if way.norm() <= f64::EPSILON {
            return;
        }
        if self.legs.is_full() {
            self.origin_m += self.legs.remove(0).displacement_m();
        }
        self.legs.push(Leg {
            direction: way.normalize(),
            profile: Profile::new(way.norm(), limits),
            elapsed_s: 0.0,
        });
        self.target_m = target_m;
    }

    pub(crate) fn advance(&mut self, step_s: f64) {
        for leg in &mut self.legs {
            leg.elapsed_s += step_s;
        }
        let origin_m = &mut self.origin_m;
        self.legs.retain(|leg| {
            if leg.is_over() {
                *origin_m += leg.displacement_m();
            }
            !leg.is_over()
        });
    }

    pub(crate) fn is_moving(&self) -> bool {
        !self.legs.is_empty()
    }

    /// The reference `lead_s` seconds from now.
    pub(crate) fn at(&self, lead_s: f64) -> Reference {
        let mut sums = [Vector2::zeros(); 4];
        for leg in &self.legs {
            let along = leg.profile.at(leg.elapsed_s + lead_s);
            for (sum, value) in sums.iter_mut().zip(along) {
                *sum += leg.direction * value;
            }
        }
        let [way, velocity_m_s, acceleration_m_s2, jerk_m_s3] = sums;
        Reference { position_m: self.origin_m + way, velocity_m_s, acceleration_m_s2, jerk_m_s3 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: MotionLimits =
        MotionLimits { speed_m_s: 2.0, acceleration_m_s2: 1.5, jerk_m_s3: 10.0 };

    #[test]
    fn every_motion_ends_at_its_length_and_keeps_its_limits() {
        for length_m in [0.001, 0.05, 0.3, 1.0, 2.0, 5.0, 40.0] {
            let profile = Profile::new(length_m, &LIMITS);
            let steps = 20_000_u32;
            let duration_s = profile.duration_s();
            let mut last = 0.0;
            for step in 0..=steps {
                let time_s = duration_s * f64::from(step) / f64::from(steps);
                let [way, speed, acceleration, _] = profile.at(time_s);
                assert!(way >= last - 1e-9 && way <= length_m + 1e-9, "{length_m} {way}");
                assert!(speed <= LIMITS.speed_m_s + 1e-9, "{length_m} {speed}");
                assert!(acceleration.abs() <= LIMITS.acceleration_m_s2 + 1e-9);
                last = way;
            }
            // Just before its end the motion is at the target and at rest.
            let [way, speed, ..] = profile.at(duration_s - 1e-6);
            assert!(
                (way - length_m).abs() < 1e-5 && speed.abs() < 1e-3,
                "{length_m} {way} {speed}"
            );
        }
    }

    #[test]
    fn a_target_that_changes_on_the_way_is_reached_without_a_jump() {
        let mut trajectory = Trajectory::new(Vector2::zeros());
        trajectory.set_target(Vector2::new(3.0, 0.0), &LIMITS);
        let mut last = trajectory.at(0.0);
        for step in 0..1000 {
            if step == 30 {
                trajectory.set_target(Vector2::new(0.0, 2.0), &LIMITS);
            }
            trajectory.advance(0.01);
            let reference = trajectory.at(0.0);
            assert!((reference.position_m - last.position_m).norm() < 0.05);
            assert!((reference.velocity_m_s - last.velocity_m_s).norm() < 0.06);
            last = reference;
        }
        assert!((last.position_m - Vector2::new(0.0, 2.0)).norm() < 1e-9);
        assert!(last.velocity_m_s.norm() < 1e-12);
    }

    #[test]
    fn no_limits_mean_no_motion_but_no_nonsense_either() {
        let nothing = MotionLimits { speed_m_s: 0.0, ..LIMITS };
        let [way, speed, ..] = Profile::new(1.0, &nothing).at(0.0);
        assert!(way.is_finite() && speed.abs() < 1e-12);
    }
}
