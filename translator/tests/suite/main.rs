//! Translation as a whole: what is refused and how, what the C looks like, and what it does.
#![forbid(unsafe_code)]

mod behaviour;
mod generated;
mod harness;
mod refused;
