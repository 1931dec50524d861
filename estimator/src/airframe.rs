//! How the drone answers its sticks.

use nalgebra::Vector2;

/// What is configured on the drone, and how late it tells and obeys.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DroneLimits {
    /// Tilt at full stick.
    pub tilt_rad: f64,
    /// Climb at full stick.
    pub climb_m_s: f64,
    /// Turn at full stick.
    pub turn_deg_s: f64,
}

impl Default for DroneLimits {
    /// The drone's defaults for indoors.
    fn default() -> Self {
        Self { tilt_rad: 12_f64.to_radians(), climb_m_s: 0.7, turn_deg_s: 100.0 }
    }
}

/// How an airframe answers; the gains and lags are learnt in flight. Gains are multiples of what
/// the sticks ask for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Airframe {
    /// Of tilt. The published models have 1 and 2.
    pub tilt_gain: f64,
    /// Time constant of the tilt, dead time apart.
    pub tilt_lag_s: f64,
    /// Of climb, upward.
    pub climb_gain: f64,
    /// Of climb, downward. The published models have 0.9 to 1.7.
    pub drop_gain: f64,
    /// Time constant of the climb. The published models have 0.17 to 1.25 s.
    pub climb_lag_s: f64,
    /// Of the acceleration that gravity gives at a tilt (right, forward). The published models have
    /// 0.5 to 1.03.
    pub thrust_gain: Vector2<f64>,
    /// Slows by its speed (right, forward). The published models have 0.45 to 1.95.
    pub drag_1_s: Vector2<f64>,
    /// Of the turn. The published models have 0.7 to 1.
    pub turn_gain: f64,
    /// Time constant of the turn. The published models have 0.02 to 0.5 s.
    pub turn_lag_s: f64,
}

impl Default for Airframe {
    /// In the middle of the published models.
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
