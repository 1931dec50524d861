//! Position, heading and velocity in the world frame.

/// Position and heading in the world frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose {
    /// Right.
    pub x_m: f64,
    /// Forward.
    pub y_m: f64,
    /// Up.
    pub z_m: f64,
    /// Clockwise from above, zero along y.
    pub yaw_deg: f64,
}

/// Velocity and rate of turn in the world frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Velocity {
    /// Right.
    pub x_m_s: f64,
    /// Forward.
    pub y_m_s: f64,
    /// Up.
    pub z_m_s: f64,
    /// Clockwise from above.
    pub yaw_deg_s: f64,
}
