//! From where the drone is and should be to what the sticks do.
//!
//! [`Pid`] is one axis: derivative on the measured rate, so that a new target causes no kick;
//! output limits; an integral that stops where it could only wind up. [`PositionController`] is
//! four of them: x, y and z in the world, so that wind and trim are remembered in the frame they
//! act in, and yaw the short way round.
#![forbid(unsafe_code)]

mod axis;
mod position;

pub use axis::{Gains, Pid};
pub use position::{ControllerGains, Demand, Motion, Pose, PositionController};
