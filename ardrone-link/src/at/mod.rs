//! AT commands: `AT*NAME=sequence,arguments<CR>`, several of them in one datagram.

mod animation;
mod command;
mod config;
mod decode;
mod encode;

pub use animation::{FlightAnimation, Hertz, LedAnimation};
pub use command::{Command, ControlMode, Fraction, Identity, Motion, Ref};
pub use config::{Config, ConfigError};
pub use decode::{DecodeError, decode};
pub use encode::{Datagram, EncodeError, MAX_DATAGRAM_BYTES};
