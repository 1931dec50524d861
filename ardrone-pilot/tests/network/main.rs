//! Vehicles of one fleet on more than one machine: programs that hear each other by Zenoh, over good networks and bad ones.
#![forbid(unsafe_code)]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::disallowed_methods, reason = "these tests run real processes in real time")]
#![allow(
    clippy::print_stderr,
    clippy::print_stdout,
    reason = "what is skipped, and measured, is said"
)]

mod agents;
mod bridges;
mod flights;
mod lab;
mod latency;
mod liars;
mod pilot;
