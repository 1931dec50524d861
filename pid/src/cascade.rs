//! Reference, feed-forward, feedback: our own law.
//!
//! A jerk-limited reference runs to the target; feed-forward is the command with which a drone
//! without errors would follow it; feedback mends what is left, on the state predicted to the moment
//! at which the command acts; an integral learns wind and trim and keeps them over targets.

use nalgebra::{Vector2, Vector3};

use crate::model::{ModelConstants, PlantModel};
use crate::position::{Demand, Inputs, body_from_world, wrap_deg};
use crate::trajectory::{MotionLimits, Trajectory};

const GRAVITY_M_S2: f64 = 9.81;

/// Gains and constants of the law, for the drone's indoor limits: 12 degrees of tilt, 0.7 m/s of
/// climb, 100 degrees a second of turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CascadeConfig {
    /// Tilt at full stick.
    pub tilt_max_rad: f64,
    /// Climb at full stick.
    pub climb_max_m_s: f64,
    /// How the drone answers.
    pub model: ModelConstants,
    /// From a command to the motors.
    pub dead_time_s: f64,
    /// Of the reference, at full stick.
    pub horizontal: MotionLimits,
    /// Of the reference, at full stick.
    pub vertical: MotionLimits,
    /// Acceleration per metre of error.
    pub position_gain_1_s2: f64,
    /// Acceleration per metre a second of error.
    pub velocity_gain_1_s: f64,
    /// Acceleration per metre of error and second.
    pub integral_gain_1_s3: f64,
    /// The velocity's share of what the integral learns from.
    pub integral_velocity_s: f64,
    /// No disturbance is taken as larger.
    pub disturbance_max_m_s2: f64,
    /// Climb per metre of error.
    pub height_gain_1_s: f64,
    /// Climb per metre a second of error.
    pub climb_gain: f64,
    /// Turn, as stick per degree.
    pub yaw_gain_1_deg: f64,
}

impl Default for CascadeConfig {
    fn default() -> Self {
        Self {
            tilt_max_rad: 12_f64.to_radians(),
            climb_max_m_s: 0.7,
            model: ModelConstants {
                tilt_time_constant_s: 0.13,
                climb_time_constant_s: 0.5,
                drag_1_s: 0.5,
            },
            dead_time_s: 0.06,
            horizontal: MotionLimits { velocity_m_s: 2.2, acceleration_m_s2: 1.5, jerk_m_s3: 14.0 },
            vertical: MotionLimits { velocity_m_s: 0.68, acceleration_m_s2: 1.3, jerk_m_s3: 10.0 },
            position_gain_1_s2: 3.2,
            velocity_gain_1_s: 3.0,
            integral_gain_1_s3: 0.35,
            integral_velocity_s: 0.4,
            disturbance_max_m_s2: 0.6,
            height_gain_1_s: 2.2,
            climb_gain: 0.4,
            yaw_gain_1_deg: 0.025,
        }
    }
}

#[derive(Debug, Clone)]
pub(crate) struct Cascade {
    config: CascadeConfig,
    trajectory: Option<Trajectory>,
    model: PlantModel,
    disturbance_m_s2: Vector2<f64>,
}

impl Cascade {
    pub(crate) fn new(config: CascadeConfig) -> Self {
        Self {
            config,
            trajectory: None,
            model: PlantModel::new(config.model),
            disturbance_m_s2: Vector2::zeros(),
        }
    }

    /// Forgets where the drone was going, and what was learnt of disturbances.
    pub(crate) fn reset(&mut self) {
        *self = Self::new(self.config);
    }

    /// Forgets where the drone was going and what it was told.
    pub(crate) fn rest(&mut self) {
        let disturbance_m_s2 = self.disturbance_m_s2;
        *self = Self { disturbance_m_s2, ..Self::new(self.config) };
    }

    /// How the place has changed in the last `age_s`, as far as the commands tell.
    pub(crate) fn change_since(&self, age_s: f64) -> Vector3<f64> {
        // The model is where the drone will be when the newest command acts.
        let ahead_s = self.config.dead_time_s;
        self.model.change_since(age_s + ahead_s).0 - self.model.change_since(ahead_s).0
    }

    pub(crate) fn step(&mut self, inputs: &Inputs<'_>) -> Demand {
        let Inputs { pose, motion, target, age_s, step_s, limit } = *inputs;
        let config = self.config;
        let (way, change) = self.model.change_since(age_s + config.dead_time_s);
        let place = Vector3::new(pose.x_m, pose.y_m, pose.z_m) + way;
        let velocity = Vector3::new(motion.x_m_s, motion.y_m_s, motion.z_m_s) + change;
        let goal = Vector3::new(target.x_m, target.y_m, target.z_m);
        let trajectory = self.trajectory.get_or_insert_with(|| Trajectory::new(place));
        trajectory.set_target(
            goal,
            &scaled(&config.horizontal, limit),
            &scaled(&config.vertical, limit),
        );
        let reference = trajectory.at(config.dead_time_s);
        trajectory.advance(step_s);
        let error = reference.position_m - place;
        let error_rate = reference.velocity_m_s - velocity;

        // Across the ground.
        let feed_forward = reference.acceleration_m_s2
            + reference.jerk_m_s3 * config.model.tilt_time_constant_s
            + reference.velocity_m_s * config.model.drag_1_s;
        let wanted = feed_forward.xy()
            + error.xy() * config.position_gain_1_s2
            + error_rate.xy() * config.velocity_gain_1_s
            + self.disturbance_m_s2;
        let (right, forward) = body_from_world(wanted.x, wanted.y, pose.yaw_deg);
        let sticks = Vector2::new(right, forward).map(|m_s2| self.tilt_stick(m_s2));
        // Keep the direction where one axis asks for more than there is.
        let largest = sticks.amax();
        let scale = if largest > limit { limit / largest } else { 1.0 };
        let sticks = sticks * scale;
        let learning = (error.xy() + error_rate.xy() * config.integral_velocity_s)
            * (config.integral_gain_1_s3 * step_s);
        // What cannot be carried out must not be learnt from.
        if scale >= 1.0 || learning.dot(&wanted) < 0.0 {
            let most = config.disturbance_max_m_s2;
            self.disturbance_m_s2 =
                (self.disturbance_m_s2 + learning).map(|value| value.clamp(-most, most));
        }

        // Up and down.
        let climb = reference.velocity_m_s.z
            + reference.acceleration_m_s2.z * config.model.climb_time_constant_s
            + error.z * config.height_gain_1_s
            + error_rate.z * config.climb_gain;
        let gaz = (climb / config.climb_max_m_s).clamp(-limit, limit);

        let turn_deg = wrap_deg(target.yaw_deg - pose.yaw_deg);
        let yaw = (turn_deg * config.yaw_gain_1_deg).clamp(-limit, limit);
        // What is spent on wind and trim does not move the drone.
        let moving = (wanted - self.disturbance_m_s2) * scale;
        self.model.send(moving.push(gaz * config.climb_max_m_s), step_s);
        Demand { roll: sticks.x, pitch: -sticks.y, gaz, yaw }
    }

    /// The stick for an acceleration.
    fn tilt_stick(&self, acceleration_m_s2: f64) -> f64 {
        (acceleration_m_s2 / GRAVITY_M_S2).atan() / self.config.tilt_max_rad
    }
}

/// The limits of a drone whose sticks are not moved further.
fn scaled(limits: &MotionLimits, limit: f64) -> MotionLimits {
    MotionLimits {
        velocity_m_s: limits.velocity_m_s * limit,
        acceleration_m_s2: limits.acceleration_m_s2 * limit,
        jerk_m_s3: limits.jerk_m_s3 * limit,
    }
}
