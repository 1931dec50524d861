//! What full sticks mean to the drone, and how its airframe responds to them.

use nalgebra::Vector2;

/// The drone's configured limits: what full sticks command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DroneLimits {
    /// Tilt at full stick.
    pub tilt_rad: f64,
    /// Rate of climb at full stick.
    pub climb_m_s: f64,
    /// Rate of turn at full stick.
    pub turn_deg_s: f64,
}

impl Default for DroneLimits {
    /// The drone's indoor defaults.
    fn default() -> Self {
        Self { tilt_rad: 12_f64.to_radians(), climb_m_s: 0.7, turn_deg_s: 100.0 }
    }
}

/// Response of an airframe to its sticks. Gains are relative to what the sticks command.
///
/// The published models are those of `mock-drone`'s profiles: `tum_ardrone`'s Kalman filter, transfer functions fitted to
/// flights, a thesis, and one within their range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Airframe {
    /// Achieved over commanded tilt. The published models have 1 and 2.
    pub tilt_gain: f64,
    /// Time constant of the tilt, without the dead time.
    pub tilt_lag_s: f64,
    /// Achieved over commanded rate of climb. The published models have 0.86 to 1.
    pub climb_gain: f64,
    /// Achieved over commanded rate of descent. The published models have 0.9 to 1.7.
    pub drop_gain: f64,
    /// Time constant of the rate of climb. The published models have 0.17 to 1.25 s.
    pub climb_lag_s: f64,
    /// Achieved acceleration over that of gravity at the same tilt (right, forward). The published models have
    /// 0.5 to 1.03.
    pub thrust_gain: Vector2<f64>,
    /// Linear drag (right, forward). The published models have 0.45 to 1.95.
    pub drag_1_s: Vector2<f64>,
    /// Achieved over commanded rate of turn. The published models have 0.7 to 1.
    pub turn_gain: f64,
    /// Time constant of the rate of turn. The published models have 0.02 to 0.51 s.
    pub turn_lag_s: f64,
}

/// Ends of what the published models have, for whoever must not rely on what was identified.
impl Airframe {
    /// Largest gain of the tilt.
    pub const STRONGEST_TILT: f64 = 2.0;
    /// Smallest and largest gain of the climb.
    pub const CLIMBS: [f64; 2] = [0.85, 1.0];
    /// Largest gain of the descent.
    pub const STRONGEST_DROP: f64 = 1.7;
    /// Shortest and longest time constant of the climb.
    pub const CLIMB_LAGS_S: [f64; 2] = [0.17, 1.25];
    /// Shortest and longest time constant of the turn.
    pub const TURN_LAGS_S: [f64; 2] = [0.02, 0.51];
    /// Smallest and largest gain of the turn.
    pub const TURNS: [f64; 2] = [0.7, 1.0];
    /// Smallest and largest linear drag.
    pub const DRAGS_1_S: [f64; 2] = [0.45, 1.95];
}

impl Default for Airframe {
    /// Within the range of the published models; each gain is 1, as commanded.
    fn default() -> Self {
        Self {
            tilt_gain: 1.0,
            tilt_lag_s: 0.13,
            climb_gain: 1.0,
            drop_gain: 1.0,
            climb_lag_s: 0.5,
            thrust_gain: Vector2::new(1.0, 1.0),
            drag_1_s: Vector2::new(0.5, 0.5),
            turn_gain: 1.0,
            turn_lag_s: 0.15,
        }
    }
}
