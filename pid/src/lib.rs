//! From where the drone is and should be to what the sticks do.
//!
//! [`Pid`] is a controller of one axis. [`PositionController`] flies to a pose by one of two laws.
//! [`Law::Cascade`] is ours: a reference that the airframe can follow, feed-forward, and a [`Pid`] for
//! each axis on the predicted state. [`Law::Tum`] is that of `tum_ardrone`, to compare with.
#![forbid(unsafe_code)]

mod cascade;
mod climb;
mod pid;
mod position;
mod trajectory;
mod tum;

pub use cascade::CascadeConfig;
pub use pid::{Pid, PidGains, PidInputs};
pub use position::{Airframe, Demand, Inputs, Law, Motion, Pose, PositionController};
