//! Position control: from the current and the target pose to stick positions.
//!
//! [`Pid`] controls one axis. [`PositionController`] flies to a pose with a reference trajectory that the airframe can
//! follow, feed-forward, and a [`Pid`] for each axis on the predicted state.
#![forbid(unsafe_code)]

mod cascade;
mod climb;
mod course;
mod inputs;
mod motion;
mod pid;
mod trajectory;

pub use cascade::{CascadeConfig, PositionController};
pub use course::Course;
pub use inputs::Inputs;
pub use motion::MotionLimits;
pub use pid::{Pid, PidGains, PidInputs};
