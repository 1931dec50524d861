//! Several vehicles in one room, as a `FLEET.toml` describes them.

mod file;
mod members;
mod together;

pub use self::members::{Fleet, FleetError, Member};
pub use self::together::{Meeting, SimulatedFleet, SimulatedMember, fly};
