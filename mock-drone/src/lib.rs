//! A simulated AR.Drone 2.0 that real clients can fly.
//!
//! - [`airframe`]: motion of the drone: tilt, thrust, drag, turn.
//! - [`firmware`]: the state machine that the network sees: take-off, landing, emergency, sequence
//!   numbers, watchdogs, configuration with acknowledgement.
//! - [`sensors`]: measurements of the motion: noise, bias, delay.
//! - [`Drone`]: the three together, a pure state machine fed with time and bytes.
//! - [`Lies`]: how a firmware may differ from what is assumed of it.
//! - [`World`]: a drone and its radio link, with datagrams that are late or lost, and faults over time.
//! - [`World::meet`]: other drones in the same air, as [`Presence`] describes them: the wash below a drone is felt, and two
//!   drones within 3 m whose ultrasound has the same frequency disturb each other's heights.
#![cfg_attr(feature = "server", doc = "- [`server`]: the drone on real sockets.")]
#![cfg_attr(feature = "cli", doc = "- [`command_line`]: the program.")]
//!
//! Without its features the crate is pure: it opens no socket and reads no clock. `server` needs tokio; `cli`
//! is the program `mock-drone`.
//!
//! A drone with the same [`DroneConfig`] and the same inputs at the same times behaves identically, bit for
//! bit. Its [`Truth`] is available to judge a flight.
#![forbid(unsafe_code)]

mod air;
pub mod airframe;
mod camera;
#[cfg(feature = "cli")]
pub mod command_line;
mod configuration;
mod drone;
mod faults;
pub mod firmware;
mod gauss_markov;
mod lies;
mod link;
pub mod scenario;
mod second_pilot;
pub mod sensors;
#[cfg(feature = "server")]
#[expect(clippy::disallowed_methods, reason = "the server has sockets and a clock")]
pub mod server;
mod telemetry;
mod truth_log;
#[cfg(feature = "video")]
pub mod video;
mod wind;
mod world;

pub use air::{Presence, Standing};
pub use camera::{CameraModel, FloorTag, OrientationSign};
pub use drone::{Drone, DroneConfig, Truth};
pub use faults::{Quantity, SensorFault};
pub use lies::Lies;
pub use link::LinkFaults;
pub use telemetry::Tag27;
pub use truth_log::TruthLog;
pub use world::{Message, World, WorldConfig};
