//! Tests of the whole translation: refused agents and their errors, the form of the C, and its behaviour.
#![forbid(unsafe_code)]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(
    clippy::format_push_string,
    clippy::format_collect,
    reason = "tests build texts, and read better so"
)]

mod behaviour;
mod conformance;
mod format;
mod generated;
mod guide;
mod harness;
mod hostile;
mod lines;
mod messages;
mod refused;
mod validation;
