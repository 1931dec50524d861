//! Navdata, the drone's telemetry: state bits and tagged options, little-endian and packed.
//!
//! [`Packet`] validates a datagram without copying it and yields its [`NavdataOption`]s; [`Navdata`] is the
//! part that every client needs. [`PacketWriter`] is the drone's side.

mod options;
mod packet;
mod state;
mod summary;
mod wire;

pub use options::*;
pub use packet::{NavdataError, Packet, PacketWriter};
pub use state::{ControlState, DroneState};
pub use summary::Navdata;
