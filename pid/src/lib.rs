//! From where the drone is and should be to what the sticks do.
//!
//! [`PositionController`] flies by one of two laws. [`Law::Cascade`] is ours: a jerk-limited
//! reference, feed-forward, feedback on the state predicted over the commands already sent, and an
//! integral that learns wind and trim. [`Law::Tum`] is that of `tum_ardrone`, to compare with.
#![forbid(unsafe_code)]

mod cascade;
mod model;
mod position;
mod trajectory;
mod tum;

pub use cascade::CascadeConfig;
pub use model::ModelConstants;
pub use position::{Demand, Inputs, Law, Motion, Pose, PositionController};
pub use trajectory::MotionLimits;
