//! Position control: from the current and the target pose to stick positions.
//!
//! [`Pid`] controls one axis. [`PositionController`] flies to a pose with one of two control laws.
//! [`Law::Cascade`] combines a reference trajectory that the airframe can follow, feed-forward, and a [`Pid`]
//! for each axis on the predicted state. [`Law::Tum`] is the law of `tum_ardrone`, for comparison.
#![forbid(unsafe_code)]

mod cascade;
mod climb;
mod course;
mod inputs;
mod motion;
mod pid;
mod position;
mod trajectory;
mod tum;

pub use cascade::CascadeConfig;
pub use course::Course;
pub use inputs::Inputs;
pub use motion::MotionLimits;
pub use pid::{Pid, PidGains, PidInputs};
pub use position::{Law, PositionController};
