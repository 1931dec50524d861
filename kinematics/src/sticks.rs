//! Stick positions.

use nalgebra::Vector2;
use serde::{Deserialize, Serialize};

/// Stick positions as fractions of the drone's limits, in [-1, 1], with the drone's signs.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
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

    /// Whether each is in [-1, 1]; NaN is not.
    pub fn are_possible(&self) -> bool {
        let Self { roll, pitch, gaz, yaw } = *self;
        [roll, pitch, gaz, yaw].iter().all(|stick| (-1.0..=1.0).contains(stick))
    }
}
