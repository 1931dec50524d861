//! Angles, and rotations between the frames.

use nalgebra::{Rotation2, Vector2};

/// The same direction in [-180, 180).
pub fn wrap_deg(angle_deg: f64) -> f64 {
    let turned_deg = (angle_deg + 180.0).rem_euclid(360.0);
    // Of what is just below zero the remainder is rounded up to a whole turn.
    if turned_deg >= 360.0 { -180.0 } else { turned_deg - 180.0 }
}

/// The same direction in [-π, π).
pub fn wrap_rad(angle_rad: f64) -> f64 {
    wrap_deg(angle_rad.to_degrees()).to_radians()
}

/// Rotates (right, forward) of a body with this yaw to (x, y) in the world frame.
pub fn world_from_body(body: Vector2<f64>, yaw_deg: f64) -> Vector2<f64> {
    Rotation2::new(-yaw_deg.to_radians()) * body
}

/// Rotates (x, y) in the world frame to (right, forward) of a body with this yaw.
pub fn body_from_world(world: Vector2<f64>, yaw_deg: f64) -> Vector2<f64> {
    Rotation2::new(yaw_deg.to_radians()) * world
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_wrap_at_half_a_turn() {
        for (angle, wrapped) in
            [(0.0, 0.0), (181.0, -179.0), (-181.0, 179.0), (180.0, -180.0), (725.0, 5.0)]
        {
            assert!((wrap_deg(angle) - wrapped).abs() < 1e-9, "{angle}");
            assert!((wrap_rad(f64::to_radians(angle)) - f64::to_radians(wrapped)).abs() < 1e-9);
        }
        let just_below = (-180.0_f64).next_down();
        assert!(wrap_deg(just_below) < 0.0, "not 180");
        assert!(wrap_deg(f64::NAN).is_nan());
    }

    #[test]
    fn a_drone_that_faces_right_has_the_worlds_right_ahead() {
        let right = Vector2::new(1.0, 0.0);
        let forward = Vector2::new(0.0, 1.0);
        assert!((body_from_world(right, 90.0) - forward).norm() < 1e-12);
        assert!((world_from_body(forward, 90.0) - right).norm() < 1e-12);
        for yaw_deg in [-170.0, -30.0, 0.0, 45.0] {
            let there = Vector2::new(0.3, -0.7);
            let back = world_from_body(body_from_world(there, yaw_deg), yaw_deg);
            assert!((back - there).norm() < 1e-12, "{yaw_deg}");
        }
    }
}
