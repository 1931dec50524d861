//! Autopilot of an AR.Drone 2.0 without any I/O: bytes and time in, one datagram every 30 ms out.
//!
//! Inside [`Vehicle`] data flows in one direction: navdata → estimate → beliefs → the agent's decision →
//! controller → command. The agent is `agent/autopilot.asl`, translated to C when this crate is built.
//!
//! Nothing here reads a clock, opens a socket or a file, or starts a thread, and no dependency of this crate
//! can. Whole flights therefore run in simulated time, deterministically, and a recorded flight can be
//! replayed.
//!
//! - [`agent`]: the agent in C behind a safe interface.
//! - [`plan`]: flight plans as text.
//! - [`mission`]: the steps to be flown, and which is next.
//! - [`vehicle`]: the state machine and its tick.
//! - [`safety`]: limits that the agent cannot override.
//! - [`separation`]: other vehicles in the same room.
//! - [`outcome`]: how a flight ends.
#![deny(unsafe_code)]

pub mod agent;
mod fence;
pub mod mission;
pub mod outcome;
pub mod plan;
pub mod safety;
pub mod separation;
pub mod vehicle;
mod wind;

pub use plan::Plan;
pub use vehicle::{Vehicle, VehicleConfig};
