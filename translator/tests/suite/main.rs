//! Translation as a whole: what is refused and how, what the C looks like, and what it does.
#![forbid(unsafe_code)]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(
    clippy::format_push_string,
    clippy::format_collect,
    reason = "tests build texts, and read better so"
)]

mod behaviour;
mod conformance;
mod generated;
mod guide;
mod harness;
mod hostile;
mod refused;
mod validation;
