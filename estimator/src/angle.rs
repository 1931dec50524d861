//! Angles in degrees.

/// Wraps an angle to [-180, 180).
pub fn wrap_deg(angle_deg: f64) -> f64 {
    (angle_deg + 180.0).rem_euclid(360.0) - 180.0
}

#[cfg(test)]
mod tests {
    use super::wrap_deg;

    #[test]
    fn directions_wrap_at_half_a_turn() {
        for (angle, wrapped) in
            [(0.0, 0.0), (181.0, -179.0), (-181.0, 179.0), (180.0, -180.0), (725.0, 5.0)]
        {
            assert!((wrap_deg(angle) - wrapped).abs() < 1e-9, "{angle}");
        }
    }
}
