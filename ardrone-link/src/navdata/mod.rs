//! What the drone says: state bits and tagged options, little-endian and packed.

mod packet;
mod state;

pub use packet::{Demo, Navdata, NavdataError, OPTION_DEMO, OPTION_TIME, OPTION_VISION_DETECT};
pub use state::{ControlState, DroneState};
