//! Stick positions.

use nalgebra::Vector2;

/// Stick positions as fractions of the drone's limits, in [-1, 1], with the drone's signs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sticks {
    /// Positive flies right.
    pub roll: f64,
    /// Positive flies backward.
    pub pitch: f64,
    /// Positive climbs.
    pub gaz: f64,
    /// Positive turns clockwise.
    pub yaw: f64,
}

impl Sticks {
    /// Tilt as fractions of its limit (right, forward).
    pub fn tilt(&self) -> Vector2<f64> {
        Vector2::new(self.roll, -self.pitch)
    }
}
