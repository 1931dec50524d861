//! The control law of `tum_ardrone`, from its published formulas, for comparison.
//!
//! Proportional and derivative terms on each axis, an integral on the height only, descent limited to a
//! quarter of the stick, and climb amplified by 2.5 (J. Engel, J. Sturm, D. Cremers, "Camera-based navigation
//! of a low-cost quadrocopter", IROS 2012, with the gains of its package).

use kinematics::{Pose, Sticks, body_from_world, wrap_deg};
use nalgebra::Vector2;

use crate::inputs::Inputs;

const PROPORTIONAL: f64 = 0.5;
const DERIVATIVE: f64 = 0.35;
const YAW: f64 = 0.05;
const GAZ_PROPORTIONAL: f64 = 0.6;
const GAZ_DERIVATIVE: f64 = 0.1;
const GAZ_INTEGRAL: f64 = 0.001;
const RISE_FACTOR: f64 = 2.5;
const MAX_RISE: f64 = 0.8;
const MAX_DROP: f64 = -0.25;
/// Limit of the integral as a fraction of gaz.
const MAX_INTEGRAL_SHARE: f64 = 0.2;
/// Factor by which the integral falls faster when the error opposes it.
const UNWIND_FACTOR: f64 = 2.5;

#[derive(Debug, Clone, Default)]
pub(crate) struct TumLaw {
    target: Option<Pose>,
    height_integral: f64,
}

impl TumLaw {
    pub(crate) fn step(&mut self, inputs: &Inputs<'_>) -> Sticks {
        let Inputs { pose, velocity, target, step_s, limit, .. } = *inputs;
        if self.target != Some(*target) {
            self.target = Some(*target);
            self.height_integral = 0.0;
        }
        let error_m = Vector2::new(target.x_m - pose.x_m, target.y_m - pose.y_m);
        let error_m = body_from_world(error_m, pose.yaw_deg);
        let velocity_m_s = Vector2::new(velocity.x_m_s, velocity.y_m_s);
        let velocity_m_s = body_from_world(velocity_m_s, pose.yaw_deg);
        let roll = PROPORTIONAL * error_m.x - DERIVATIVE * velocity_m_s.x;
        let pitch = -(PROPORTIONAL * error_m.y - DERIVATIVE * velocity_m_s.y);
        let yaw = YAW * wrap_deg(target.yaw_deg - pose.yaw_deg);
        let gaz = self.gaz(target.z_m - pose.z_m, velocity.z_m_s, step_s);
        let [roll, pitch, gaz, yaw] =
            [roll, pitch, gaz, yaw].map(|stick| stick.clamp(-limit, limit));
        Sticks { roll, pitch, gaz, yaw }
    }

    fn gaz(&mut self, error_m: f64, climb_m_s: f64, step_s: f64) -> f64 {
        let opposes = error_m * self.height_integral < 0.0;
        let factor = if opposes { UNWIND_FACTOR } else { 1.0 };
        let integral = self.height_integral + factor * error_m * step_s;
        let crossed = opposes && integral * self.height_integral < 0.0;
        let most = MAX_INTEGRAL_SHARE / GAZ_INTEGRAL;
        self.height_integral = if crossed { 0.0 } else { integral.clamp(-most, most) };
        let gaz = GAZ_PROPORTIONAL * error_m - GAZ_DERIVATIVE * climb_m_s
            + GAZ_INTEGRAL * self.height_integral;
        let gaz = gaz.clamp(MAX_DROP, MAX_RISE / RISE_FACTOR);
        if gaz > 0.0 { gaz * RISE_FACTOR } else { gaz }
    }
}
