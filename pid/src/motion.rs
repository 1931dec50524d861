//! Limits of horizontal motions.

use crate::CascadeConfig;

/// Limits of a motion along a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionLimits {
    /// Largest speed.
    pub speed_m_s: f64,
    /// Largest acceleration.
    pub acceleration_m_s2: f64,
    /// Largest jerk.
    pub jerk_m_s3: f64,
}

impl CascadeConfig {
    /// Limits of a reference that a drone can follow which accelerates with `full_m_s2` at full tilt, against a disturbance,
    /// with this fraction of the sticks and no faster than `speed_m_s`.
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

#[cfg(test)]
mod tests {
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
}
