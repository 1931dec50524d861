//! AT commands: `AT*NAME=sequence,arguments<CR>`, several of them in one datagram.

mod animation;
mod command;
mod decode;
mod encode;

pub use animation::{FlightAnimation, LedAnimation};
pub use command::{
    Command, Config, ConfigError, ControlMode, Fraction, Hertz, Identity, Motion, Ref,
};
pub use decode::{DecodeError, decode};
pub use encode::{Datagram, EncodeError, MAX_DATAGRAM_BYTES};
