//! What the drone says: state bits and tagged options, little-endian and packed.
//!
//! [`Packet`] checks a datagram without copying it and gives out its [`NavdataOption`]s; [`Navdata`]
//! is the part that every pilot needs. [`PacketWriter`] is the drone's side.

mod options;
mod packet;
mod state;
mod summary;
mod wire;

pub use options::*;
pub use packet::{NavdataError, Packet, PacketWriter};
pub use state::{ControlState, DroneState};
pub use summary::Navdata;
