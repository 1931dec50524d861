//! Flies an AR.Drone 2.0 along a plan.
//!
//! The [`Pilot`] is pure: navdata and time in, one datagram every 30 ms out. Inside it data goes
//! round one way: navdata → estimate → beliefs → the agent's decision → the controller → command.
//! The agent is `agent/autopilot.asl`, translated to C when this crate is built.
//!
//! Two shells drive the same pilot: [`flight`] in real time over UDP, [`sim`] in simulated time
//! against a simulated drone.
//!
//! - [`plan`]: flight plans as text.
//! - [`mission`]: which step of the plan is next, and where that is.
//! - [`pilot`]: the tick.
//! - [`safety`]: what the agent may not overrule.
//! - [`recording`]: the flight log; [`replay`]: a log flown again; [`report`]: a page about it; [`picture`]: a plan drawn.
//! - [`browser`]: the flight in a browser.
//! - [`flight`], [`sim`]: the shells; [`realtime`], [`timing`]: what the system gives the tick, and how
//!   regular it was. [`cli`]: the command line.
#![deny(unsafe_code)]

pub mod agent;
pub mod browser;
pub mod cli;
mod drawing;
pub mod flight;
mod json;
pub mod mission;
pub mod outcome;
pub mod picture;
pub mod pilot;
pub mod plan;
pub mod realtime;
pub mod recording;
pub mod replay;
pub mod report;
pub mod safety;
pub mod settings;
pub mod sim;
pub mod timing;
mod trail;

pub use pid::{Demand, Pose};
pub use pilot::{Pilot, PilotConfig};
pub use plan::Plan;
