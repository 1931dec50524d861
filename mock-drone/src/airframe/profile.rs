//! Published models of the same airframe, which disagree by factors of two to three.
//!
//! A controller tuned to one of them alone is tuned to its author's drone.

use std::time::Duration;

use nalgebra::Vector2;

use super::{GRAVITY_M_S2, STEP_S};

/// A model of the response to commands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Profile {
    /// Time from an AT command to the motors.
    pub dead_time: Duration,
    /// Scaling of commands by the firmware.
    pub scaling: Scaling,
    /// Response of the roll angle.
    pub roll: AttitudeLoop,
    /// Response of the pitch angle.
    pub pitch: AttitudeLoop,
    /// Acceleration by tilt.
    pub thrust: ThrustLaw,
    /// Linear drag: deceleration by the speed through the air (right, forward).
    pub linear_drag_1_s: Vector2<f64>,
    /// Quadratic drag: deceleration by the square of the horizontal speed through the air.
    pub quadratic_drag_1_m: f64,
    /// Time constant of the climb.
    pub climb_time_constant_s: f64,
    /// Time constant of the turn.
    pub turn_time_constant_s: f64,
}

/// Demand at full stick, as a multiple of the configured limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scaling {
    /// Multiple of `control:euler_angle_max`.
    pub tilt: f64,
    /// Limit of the demanded roll and pitch; infinite if there is none.
    pub tilt_limit_rad: f64,
    /// Multiple of `control:control_vz_max`, upwards.
    pub climb: f64,
    /// Multiple of `control:control_vz_max`, downwards.
    pub drop: f64,
    /// Multiple of `control:control_yaw`.
    pub turn: f64,
}

/// Response of an angle to its demand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AttitudeLoop {
    /// Without lag, which is part of the dead time.
    Immediate,
    /// First-order lag.
    FirstOrder {
        /// Inverse of the time constant.
        rate_1_s: f64,
    },
    /// Second-order system.
    SecondOrder {
        /// Natural frequency.
        frequency_rad_s: f64,
        /// Damping ratio.
        damping: f64,
    },
}

impl AttitudeLoop {
    /// Angle and rate after one step.
    pub(super) fn step(self, angle_rad: f64, rate_rad_s: f64, demand_rad: f64) -> (f64, f64) {
        match self {
            Self::Immediate => (demand_rad, 0.0),
            Self::FirstOrder { rate_1_s } => {
                let rate_rad_s = rate_1_s * (demand_rad - angle_rad);
                (angle_rad + rate_rad_s * STEP_S, rate_rad_s)
            }
            Self::SecondOrder { frequency_rad_s, damping } => {
                let acceleration = frequency_rad_s.powi(2) * (demand_rad - angle_rad)
                    - 2.0 * damping * frequency_rad_s * rate_rad_s;
                let rate_rad_s = rate_rad_s + acceleration * STEP_S;
                (angle_rad + rate_rad_s * STEP_S, rate_rad_s)
            }
        }
    }
}

/// Acceleration by tilt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ThrustLaw {
    /// Thrust carries the weight at any tilt: g tan(tilt).
    CarriesWeight,
    /// Proportional to the sine of the tilt.
    Sine {
        /// Acceleration per unit of the sine.
        acceleration_m_s2: f64,
    },
    /// Proportional to the tilt (right, forward).
    Linear {
        /// Acceleration per radian.
        acceleration_m_s2: Vector2<f64>,
    },
}

impl ThrustLaw {
    /// Acceleration (right, forward) at these angles.
    pub(super) fn acceleration_m_s2(self, roll_rad: f64, pitch_rad: f64) -> Vector2<f64> {
        let tilt = Vector2::new(roll_rad, -pitch_rad);
        match self {
            Self::CarriesWeight => tilt.map(|angle| GRAVITY_M_S2 * angle.tan()),
            Self::Sine { acceleration_m_s2 } => tilt.map(|angle| acceleration_m_s2 * angle.sin()),
            Self::Linear { acceleration_m_s2 } => tilt.component_mul(&acceleration_m_s2),
        }
    }
}

const AS_CONFIGURED: Scaling =
    Scaling { tilt: 1.0, tilt_limit_rad: f64::INFINITY, climb: 1.0, drop: 1.0, turn: 1.0 };

impl Profile {
    /// Parameters inside the range of the published models; the default.
    pub fn rec() -> Self {
        let attitude = AttitudeLoop::SecondOrder { frequency_rad_s: 12.0, damping: 0.8 };
        Self {
            dead_time: Duration::from_millis(60),
            scaling: AS_CONFIGURED,
            roll: attitude,
            pitch: attitude,
            thrust: ThrustLaw::CarriesWeight,
            linear_drag_1_s: Vector2::new(0.45, 0.45),
            quadratic_drag_1_m: 0.08,
            climb_time_constant_s: 0.5,
            turn_time_constant_s: 0.2,
        }
    }

    /// The model in `tum_ardrone`'s Kalman filter: twice the tilt at half the stick, slow climb, twice as
    /// fast descent.
    pub fn tum() -> Self {
        let attitude = AttitudeLoop::FirstOrder { rate_1_s: 7.0 };
        Self {
            dead_time: Duration::from_millis(100),
            scaling: Scaling {
                tilt: 2.0,
                tilt_limit_rad: 12_f64.to_radians(),
                climb: 0.6 / 0.7,
                drop: 2.0 * 0.6 / 0.7,
                turn: 0.9,
            },
            roll: attitude,
            pitch: attitude,
            thrust: ThrustLaw::Sine { acceleration_m_s2: 10.15 },
            linear_drag_1_s: Vector2::new(0.58, 0.58),
            quadratic_drag_1_m: 0.0,
            climb_time_constant_s: 1.25,
            turn_time_constant_s: 0.04,
        }
    }

    /// Transfer functions fitted to flights: weak tilt, fast climb, long dead time.
    pub fn tf() -> Self {
        Self {
            dead_time: Duration::from_millis(100),
            scaling: Scaling { climb: 0.885, drop: 0.885, turn: 0.725, ..AS_CONFIGURED },
            roll: AttitudeLoop::Immediate,
            pitch: AttitudeLoop::Immediate,
            thrust: ThrustLaw::Linear { acceleration_m_s2: Vector2::new(4.774, 6.154) },
            linear_drag_1_s: Vector2::new(0.4596, 0.665),
            quadratic_drag_1_m: 0.0,
            climb_time_constant_s: 0.17,
            turn_time_constant_s: 0.02,
        }
    }

    /// A model identified for a thesis: strong drag, slow climb and turn.
    pub fn leo() -> Self {
        Self {
            dead_time: Duration::from_millis(60),
            scaling: Scaling { turn: 0.9275, ..AS_CONFIGURED },
            roll: AttitudeLoop::SecondOrder { frequency_rad_s: 14.43, damping: 1.35 },
            pitch: AttitudeLoop::SecondOrder { frequency_rad_s: 13.14, damping: 0.99 },
            thrust: ThrustLaw::Linear { acceleration_m_s2: Vector2::new(9.45, 9.45) },
            linear_drag_1_s: Vector2::new(1.95, 1.33),
            quadratic_drag_1_m: 0.0,
            climb_time_constant_s: 0.88,
            turn_time_constant_s: 0.51,
        }
    }
}
