//! The control law: reference trajectory, feed-forward and feedback.
//!
//! A reference that the airframe can follow leads to the target. Feed-forward is the command with which an
//! ideal drone would follow it. Feedback corrects the remaining error, using the state predicted for the
//! moment at which the command takes effect. The estimated disturbance is compensated at once; an integral
//! learns the rest and keeps it across targets.

use kinematics::{
    Airframe, DroneLimits, GRAVITY_M_S2, Sticks, body_from_world, world_from_body, wrap_deg,
};
use nalgebra::Vector2;

use crate::climb::{ClimbLimits, ClimbReference};
use crate::course::Course;
use crate::inputs::Inputs;
use crate::motion::MotionLimits;
use crate::pid::{Pid, PidGains, PidInputs};
use crate::trajectory::{Reference, Trajectory};

/// Gains and limits of the law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CascadeConfig {
    /// Maximum horizontal speed of the reference.
    pub speed_max_m_s: f64,
    /// Fraction of the acceleration at full tilt that the reference uses; the rest is reserved for errors and
    /// drag.
    pub acceleration_share: f64,
    /// Maximum jerk of the reference.
    pub jerk_max_m_s3: f64,
    /// Maximum vertical speed of the reference.
    pub climb_speed_max_m_s: f64,
    /// Fraction of the vertical limits that the reference uses for braking; the rest is reserved for errors.
    pub braking_share: f64,
    /// Horizontal gains: acceleration in m/s² per metre, per metre-second, and per m/s.
    pub horizontal: PidGains,
    /// Natural frequency of the height loop.
    pub vertical_frequency_rad_s: f64,
    /// Damping ratio of the height loop.
    pub vertical_damping: f64,
    /// Integral gain of the height loop: rate of climb per metre-second.
    pub vertical_integral_1_s2: f64,
    /// Fraction of the yaw stick used on the way to a target.
    pub turn_share: f64,
    /// Yaw gains: stick fraction per degree, per degree-second, and per degree/s.
    pub yaw: PidGains,
}

impl Default for CascadeConfig {
    fn default() -> Self {
        Self {
            speed_max_m_s: 2.2,
            acceleration_share: 0.72,
            jerk_max_m_s3: 14.0,
            climb_speed_max_m_s: 0.75,
            braking_share: 0.9,
            horizontal: PidGains { proportional: 4.6, integral: 0.1, derivative: 4.2 },
            vertical_frequency_rad_s: 2.1,
            vertical_damping: 0.8,
            vertical_integral_1_s2: 0.1,
            turn_share: 0.6,
            yaw: PidGains { proportional: 0.025, ..PidGains::default() },
        }
    }
}

impl CascadeConfig {
    /// Limits of a reference that a drone can follow which accelerates with `full_m_s2` at full tilt, against a disturbance,
    /// with this fraction of the sticks and no faster than `speed_m_s`. The disturbance takes two thirds of `full_m_s2` at most.
    pub fn motion_limits(
        &self,
        full_m_s2: f64,
        disturbance_m_s2: f64,
        limit: f64,
        speed_m_s: f64,
    ) -> MotionLimits {
        // Acceleration needed against the disturbance is not available to the reference.
        let free_m_s2 = (full_m_s2 - disturbance_m_s2).max(full_m_s2 / 3.0);
        MotionLimits {
            speed_m_s: speed_m_s.min(self.speed_max_m_s * limit),
            acceleration_m_s2: self.acceleration_share * free_m_s2 * limit,
            jerk_m_s3: self.jerk_max_m_s3 * limit,
        }
    }
}

/// Approaches and holds a pose.
#[derive(Debug, Clone)]
pub struct PositionController {
    config: CascadeConfig,
    limits: DroneLimits,
    way: Option<Way>,
    right: Pid,
    forward: Pid,
    up: Pid,
    yaw: Pid,
}

/// References of the current approach.
#[derive(Debug, Clone)]
struct Way {
    horizontal: Trajectory,
    vertical: ClimbReference,
}

/// A course `lead_s` seconds from now.
fn along(course: &Course, lead_s: f64) -> Reference {
    Reference {
        position_m: course.position_m + course.velocity_m_s * lead_s,
        velocity_m_s: course.velocity_m_s + course.acceleration_m_s2 * lead_s,
        acceleration_m_s2: course.acceleration_m_s2,
        jerk_m_s3: Vector2::zeros(),
    }
}

impl PositionController {
    /// A controller in its initial state.
    pub fn new(config: CascadeConfig, limits: DroneLimits) -> Self {
        Self {
            way: None,
            right: Pid::new(config.horizontal),
            forward: Pid::new(config.horizontal),
            up: Pid::default(),
            yaw: Pid::new(config.yaw),
            config,
            limits,
        }
    }

    /// Resets the reference and the integrals.
    pub fn reset(&mut self) {
        *self = Self::new(self.config, self.limits);
    }

    /// The drone holds by itself: resets the reference and keeps the integrals.
    pub fn rest(&mut self) {
        self.way = None;
    }

    /// Stick fractions for the next step, within the limit. Inputs that are not finite, and an airframe with a gain of tilt,
    /// climb, descent or thrust that is not positive, result in centred sticks and change nothing in the controller.
    pub fn step(&mut self, inputs: &Inputs<'_>) -> Sticks {
        if !inputs.is_finite() {
            return Sticks::default();
        }
        let inputs = &Inputs { limit: inputs.limit.clamp(0.0, 1.0), ..*inputs };
        let Inputs { pose, target, .. } = *inputs;
        if self.way.is_none() {
            self.way = Some(Way {
                horizontal: Trajectory::new(Vector2::new(pose.x_m, pose.y_m)),
                vertical: ClimbReference::at_rest(pose.z_m),
            });
        }
        let (right, forward) = self.across(inputs);
        let gaz = self.up(inputs);
        let turn_deg = wrap_deg(target.yaw_deg - pose.yaw_deg);
        let yaw = self.yaw.output(&PidInputs {
            setpoint: turn_deg,
            measured_rate: inputs.velocity.yaw_deg_s,
            ..PidInputs::default()
        });
        // A drone that turns more slowly while moving flies a straighter path.
        let moves = inputs.course.is_some()
            || self.way.as_ref().is_some_and(|way| way.horizontal.is_moving());
        let most = if moves { inputs.limit * self.config.turn_share } else { inputs.limit };
        Sticks { roll: right, pitch: -forward, gaz, yaw: yaw.clamp(-most, most) }
    }

    /// Horizontal stick demand (right, forward).
    fn across(&mut self, inputs: &Inputs<'_>) -> (f64, f64) {
        let Inputs { pose, velocity, target, airframe, disturbance_m_s2, step_s, limit, .. } =
            *inputs;
        let Some(way) = &mut self.way else { return (0.0, 0.0) };
        let (config, tilt_max_rad) = (self.config, self.limits.tilt_rad);
        let thrust = airframe.thrust_gain;
        let full_m_s2 = GRAVITY_M_S2 * tilt_max_rad.tan() * thrust.amin();
        let limits =
            config.motion_limits(full_m_s2, disturbance_m_s2.norm(), limit, inputs.speed_m_s);
        if let Some(course) = inputs.course {
            // Where the course ends, a motion begins from there.
            way.horizontal = Trajectory::new(course.position_m);
        } else {
            way.horizontal.set_target(Vector2::new(target.x_m, target.y_m), &limits);
        }
        let at = |lead_s: f64| {
            inputs.course.map_or_else(|| way.horizontal.at(lead_s), |course| along(course, lead_s))
        };
        let reference = at(0.0);
        // The command holds for one step, so it is computed for the middle of the step.
        let ahead = at(step_s / 2.0);
        way.horizontal.advance(step_s);
        let speed_m_s = body_from_world(ahead.velocity_m_s, pose.yaw_deg);
        let drag = speed_m_s.component_mul(&airframe.drag_1_s);
        let feed_forward = ahead.acceleration_m_s2
            + ahead.jerk_m_s3 * airframe.tilt_lag_s
            + world_from_body(drag, pose.yaw_deg)
            - disturbance_m_s2;
        let axis = |i: usize, measured: f64, measured_rate: f64| PidInputs {
            setpoint: reference.position_m[i],
            setpoint_rate: reference.velocity_m_s[i],
            measured,
            measured_rate,
            feed_forward: feed_forward[i],
        };
        let (x, y) = (axis(0, pose.x_m, velocity.x_m_s), axis(1, pose.y_m, velocity.y_m_s));
        let wanted = Vector2::new(self.right.output(&x), self.forward.output(&y));
        // While the tilt follows its stick the drone turns, and the tilt with it.
        let ahead_s = airframe.tilt_lag_s + step_s / 2.0;
        let yaw_deg = pose.yaw_deg + velocity.yaw_deg_s * ahead_s;
        let wanted_m_s2 = body_from_world(wanted, yaw_deg);
        let pull = wanted_m_s2.component_div(&(thrust * GRAVITY_M_S2));
        let sticks = pull.map(f64::atan) / (tilt_max_rad * airframe.tilt_gain);
        // Keeps the direction if one axis exceeds the limit. The drone does not tilt beyond its limit,
        // whatever its gain.
        let most = limit.min(1.0 / airframe.tilt_gain);
        let largest = sticks.amax();
        let scale = if largest > most { most / largest } else { 1.0 };
        self.right.learn(&x, wanted.x, wanted.x * scale, step_s);
        self.forward.learn(&y, wanted.y, wanted.y * scale, step_s);
        let sticks = sticks * scale;
        (sticks.x, sticks.y)
    }

    /// Vertical stick demand.
    fn up(&mut self, inputs: &Inputs<'_>) -> f64 {
        let Inputs { pose, velocity, target, airframe, step_s, limit, .. } = *inputs;
        let Some(way) = &mut self.way else { return 0.0 };
        let (config, climb_max_m_s) = (self.config, self.limits.climb_m_s);
        let rise_m_s = climb_max_m_s * airframe.climb_gain * limit;
        let drop_m_s = climb_max_m_s * airframe.drop_gain * limit;
        let reference = way.vertical;
        let feed_forward = way.vertical.advance(
            target.z_m,
            step_s,
            &ClimbLimits {
                rise_m_s,
                drop_m_s,
                speed_m_s: config.climb_speed_max_m_s * limit,
                lag_s: airframe.climb_lag_s,
                braking: config.braking_share,
            },
        );
        self.up.set_gains(self.climb_gains(&airframe));
        let z = PidInputs {
            setpoint: reference.height_m,
            setpoint_rate: reference.climb_m_s,
            measured: pose.z_m,
            measured_rate: velocity.z_m_s,
            feed_forward,
        };
        let wanted_m_s = self.up.output(&z);
        let climb_m_s = wanted_m_s.clamp(-drop_m_s, rise_m_s);
        self.up.learn(&z, wanted_m_s, climb_m_s, step_s);
        let gain = if climb_m_s > 0.0 { airframe.climb_gain } else { airframe.drop_gain };
        climb_m_s / (climb_max_m_s * gain)
    }

    /// Gains from natural frequency and damping: a drone whose climb follows with a lag `τ`, controlled by
    /// `k_p e + k_d ė`, has the natural frequency `√(k_p / τ)` and the damping ratio `(1 + k_d) / (2 √(k_p
    /// τ))`.
    fn climb_gains(&self, airframe: &Airframe) -> PidGains {
        let CascadeConfig { vertical_frequency_rad_s: frequency, vertical_damping, .. } =
            self.config;
        let lag_s = airframe.climb_lag_s;
        PidGains {
            proportional: frequency * frequency * lag_s,
            integral: self.config.vertical_integral_1_s2,
            derivative: (2.0 * vertical_damping * frequency * lag_s - 1.0).max(0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use kinematics::{Pose, Velocity};

    use super::*;

    #[test]
    fn a_reference_keeps_what_the_disturbance_leaves() {
        let config = CascadeConfig {
            speed_max_m_s: 2.0,
            acceleration_share: 0.5,
            jerk_max_m_s3: 14.0,
            ..CascadeConfig::default()
        };
        let calm = config.motion_limits(3.0, 0.0, 1.0, f64::INFINITY);
        assert_eq!(calm, MotionLimits { speed_m_s: 2.0, acceleration_m_s2: 1.5, jerk_m_s3: 14.0 });
        let half = config.motion_limits(3.0, 1.0, 0.5, 0.25);
        assert_eq!(half, MotionLimits { speed_m_s: 0.25, acceleration_m_s2: 0.5, jerk_m_s3: 7.0 });
        // Some is left in a storm.
        let storm = config.motion_limits(3.0, 9.0, 1.0, 1.0);
        assert!((storm.acceleration_m_s2 - 0.5).abs() < 1e-12, "{storm:?}");
    }

    fn controller() -> PositionController {
        PositionController::new(CascadeConfig::default(), DroneLimits::default())
    }

    /// Sticks after a while at one place.
    fn demand(pose: Pose, target: Pose, limit: f64) -> Sticks {
        let mut controller = controller();
        let step = |controller: &mut PositionController, target: &Pose| {
            let velocity = &Velocity::default();
            controller.step(&Inputs {
                pose: &pose,
                velocity,
                target,
                disturbance_m_s2: Vector2::zeros(),
                airframe: Airframe::default(),
                step_s: 0.03,
                limit,
                speed_m_s: 99.0,
                course: None,
            })
        };
        step(&mut controller, &pose);
        (0..10).map(|_| step(&mut controller, &target)).last().unwrap()
    }

    #[test]
    fn each_error_moves_the_stick_that_mends_it() {
        let here = Pose::default();
        let ahead = demand(here, Pose { y_m: 1.0, ..here }, 1.0);
        assert!(ahead.pitch < -0.1 && ahead.roll.abs() < 1e-9, "{ahead:?}");
        let right = demand(here, Pose { x_m: 1.0, ..here }, 1.0);
        assert!(right.roll > 0.1 && right.pitch.abs() < 1e-9, "{right:?}");
        assert!(demand(here, Pose { z_m: 0.2, ..here }, 1.0).gaz > 0.1);
        assert!(demand(here, Pose { z_m: -0.2, ..here }, 1.0).gaz < -0.1);
        assert!(demand(here, Pose { yaw_deg: 20.0, ..here }, 1.0).yaw > 0.1);
    }

    #[test]
    fn a_turned_drone_flies_to_the_same_place() {
        // Facing right: a target to the right is ahead.
        let pose = Pose { yaw_deg: 90.0, ..Pose::default() };
        let demand = demand(pose, Pose { x_m: 1.0, ..pose }, 1.0);
        assert!(demand.pitch < -0.1 && demand.roll.abs() < 1e-9, "{demand:?}");
    }

    #[test]
    fn yaw_goes_the_short_way_round() {
        let pose = Pose { yaw_deg: 171.0, ..Pose::default() };
        for yaw_deg in [-170.0, 181.0 + 360.0] {
            assert!(demand(pose, Pose { yaw_deg, ..pose }, 1.0).yaw > 0.0);
        }
    }

    #[test]
    fn the_limit_holds_on_every_axis_at_every_heading() {
        for yaw_deg in 0..360 {
            let pose = Pose { yaw_deg: f64::from(yaw_deg), ..Pose::default() };
            let target = Pose { x_m: 9.0, y_m: -7.0, z_m: 5.0, yaw_deg: pose.yaw_deg + 179.0 };
            let demand = demand(pose, target, 0.3);
            for stick in [demand.roll, demand.pitch, demand.gaz, demand.yaw] {
                assert!(stick.abs() <= 0.3 + 1e-12, "{demand:?}");
            }
        }
    }

    #[test]
    fn a_course_is_followed() {
        let here = Pose::default();
        let mut controller = controller();
        let mut step = |course: Option<&Course>| {
            controller.step(&Inputs {
                pose: &here,
                velocity: &Velocity::default(),
                target: &here,
                disturbance_m_s2: Vector2::zeros(),
                airframe: Airframe::default(),
                step_s: 0.03,
                limit: 1.0,
                speed_m_s: 99.0,
                course,
            })
        };
        assert_eq!(step(None), Sticks::default());
        let forward = Course::new(Vector2::zeros(), Vector2::new(0.0, 0.5));
        let demand = step(Some(&forward));
        assert!(demand.pitch < -0.1 && demand.roll.abs() < 1e-9, "{demand:?}");
        assert!(step(None).pitch.abs() < 0.01, "it is at the target");
        let nowhere = Course::new(Vector2::new(0.0, f64::NAN), Vector2::zeros());
        assert_eq!(step(Some(&nowhere)), Sticks::default());
    }

    #[test]
    fn what_is_no_number_moves_nothing_and_spoils_nothing() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut controller = controller();
            let good = Pose::default();
            let target = Pose { y_m: 1.0, ..good };
            for pose in [Pose { x_m: bad, ..good }, Pose { yaw_deg: bad, ..good }] {
                let velocity = &Velocity::default();
                let inputs = Inputs {
                    pose: &pose,
                    velocity,
                    target: &target,
                    disturbance_m_s2: Vector2::zeros(),
                    airframe: Airframe::default(),
                    step_s: 0.03,
                    limit: 1.0,
                    speed_m_s: 99.0,
                    course: None,
                };
                assert_eq!(controller.step(&inputs), Sticks::default());
                let demand = controller.step(&Inputs { pose: &good, ..inputs });
                assert!(demand.pitch.is_finite() && demand.pitch <= 0.0);
            }
        }
    }
}
