//! The program `ardrone-pilot`: everything with I/O around the pure crate `autopilot`.
//!
//! - [`flight`] runs the vehicle in real time over UDP; [`runtime`] is for what is slow beside it. [`realtime`] requests
//!   real-time scheduling, and [`timing`] measures the ticks.
//! - [`recording`] is the flight log, [`replay`] replays a log, [`report`] makes a page of it,
//!   `flights` finds the flights in it, [`plan_drawing`] draws a
//!   plan.
//! - [`fleet`] reads several vehicles with their plans, and flies them together on simulated drones.
//! - [`selftest`] asks a drone on the ground what is assumed of its firmware.
//! - [`video`] passes on what the camera sees.
//! - [`drive`] runs the vehicle in simulated time with a simulated drone; [`simulation`] flies a plan so.
//! - [`browser`] shows the flight in a browser, [`cli`] in the terminal, [`mavlink`] to ground stations and programs of others.
//! - [`network`] is how vehicles of one fleet on several machines hear each other.
//! - [`settings`] reads `pilot.toml`.
#![forbid(unsafe_code)]
#![expect(
    clippy::disallowed_methods,
    reason = "this crate has the clock, the sockets and the files"
)]

pub mod browser;
mod checked_plan;
pub mod cli;
mod drawing;
pub mod drive;
pub mod fleet;
mod fleet_drawing;
pub mod flight;
mod flights;
mod flown_path;
mod json;
pub mod mavlink;
pub mod network;
mod ordered;
pub mod plan_drawing;
pub mod realtime;
pub mod recording;
pub mod replay;
pub mod report;
pub mod runtime;
pub mod selftest;
pub mod settings;
pub mod simulation;
mod text_file;
pub mod timing;
mod typed;
pub mod video;
mod whole_file;
