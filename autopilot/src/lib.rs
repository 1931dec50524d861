//! The pilot of an AR.Drone 2.0, without any input or output: bytes and time in, one datagram every 30 ms out.
//!
//! Inside [`Vehicle`] data goes round one way: navdata → estimate → beliefs → the agent's decision → the
//! controller → command. The agent is `agent/autopilot.asl`, translated to C when this crate is built.
//!
//! Nothing here reads a clock, opens a socket or a file, or starts a thread: the crate has no dependency that
//! could. So whole flights run in simulated time, deterministically, and a recorded flight can be repeated.
//!
//! - [`plan`]: flight plans as text.
//! - [`mission`]: which step of the plan is next, and where that is.
//! - [`vehicle`]: the tick.
//! - [`safety`]: what the agent may not overrule.
//! - [`outcome`]: how a flight ends.
#![deny(unsafe_code)]

pub mod agent;
pub mod mission;
pub mod outcome;
pub mod plan;
pub mod safety;
pub mod vehicle;

pub use pid::{Demand, Pose};
pub use plan::Plan;
pub use vehicle::{Vehicle, VehicleConfig};
