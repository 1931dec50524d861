//! A MAVLink vehicle without input or output.
#![forbid(unsafe_code)]

pub mod mission;
pub mod place;
