//! What the control law decides by.

use kinematics::{Airframe, Pose, Velocity};
use nalgebra::Vector2;

use crate::course::Course;

/// Inputs of the control law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inputs<'a> {
    /// Pose at the time when the demand takes effect.
    pub pose: &'a Pose,
    /// Velocity at that time.
    pub velocity: &'a Velocity,
    /// Disturbance acceleration (x, y), in the world frame.
    pub disturbance_m_s2: Vector2<f64>,
    /// Identified response of the airframe.
    pub airframe: Airframe,
    /// Target pose.
    pub target: &'a Pose,
    /// Time for which the demand will hold.
    pub step_s: f64,
    /// Limit of the sticks: a fraction of the full stick, clamped to 0 to 1.
    pub limit: f64,
    /// Largest horizontal speed, in m/s, besides that of the law's configuration.
    pub speed_m_s: f64,
    /// The horizontal reference, if the caller moves one: otherwise the law makes its own, which ends at the target.
    pub course: Option<&'a Course>,
}

impl Inputs<'_> {
    pub(crate) fn is_finite(&self) -> bool {
        let Inputs {
            pose,
            velocity,
            disturbance_m_s2,
            airframe,
            target,
            step_s,
            limit,
            speed_m_s,
            course,
        } = self;
        [
            pose.x_m,
            pose.y_m,
            pose.z_m,
            pose.yaw_deg,
            velocity.x_m_s,
            velocity.y_m_s,
            velocity.z_m_s,
            velocity.yaw_deg_s,
            disturbance_m_s2.x,
            disturbance_m_s2.y,
            airframe.tilt_lag_s,
            airframe.climb_lag_s,
            airframe.drag_1_s.x,
            airframe.drag_1_s.y,
            target.x_m,
            target.y_m,
            target.z_m,
            target.yaw_deg,
            *step_s,
            *limit,
            *speed_m_s,
        ]
        .iter()
        .all(|value| value.is_finite())
            && course.is_none_or(Course::is_finite)
            && [
                airframe.tilt_gain,
                airframe.climb_gain,
                airframe.drop_gain,
                airframe.thrust_gain.x,
                airframe.thrust_gain.y,
            ]
            .iter()
            .all(|gain| gain.is_normal() && *gain > 0.0)
    }
}
