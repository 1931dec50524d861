//! Quantities that the estimator, the controller and the autopilot share, with their frames and units.
//!
//! World frame: x right, y forward, z up in metres, as the drone stood at the start; yaw in degrees, clockwise
//! seen from above, in [-180, 180). Body frame: right and forward, level, turned by the yaw. A horizontal
//! vector is (right, forward) in the body frame and (x, y) in the world frame.
//!
//! ```
//! use kinematics::{Sticks, body_from_world, wrap_deg};
//! use nalgebra::Vector2;
//!
//! assert_eq!(wrap_deg(190.0), -170.0);
//! // The drone faces right, so a place to the right is ahead.
//! let ahead = body_from_world(Vector2::new(1.0, 0.0), 90.0);
//! assert!((ahead - Vector2::new(0.0, 1.0)).norm() < 1e-12);
//! // Negative pitch flies forward.
//! let sticks = Sticks { pitch: -0.5, ..Sticks::default() };
//! assert_eq!(sticks.tilt(), Vector2::new(0.0, 0.5));
//! ```
#![forbid(unsafe_code)]

mod airframe;
mod frame;
mod pose;
mod sticks;

pub use airframe::{Airframe, DroneLimits};
pub use frame::{body_from_world, world_from_body, wrap_deg, wrap_rad};
pub use pose::{Pose, Velocity};
pub use sticks::Sticks;

/// Standard gravity, rounded as the published airframe models have it.
pub const GRAVITY_M_S2: f64 = 9.81;
