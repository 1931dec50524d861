//! Limits of horizontal motions.

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
