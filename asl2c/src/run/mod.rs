//! Runs an agent by the reference interpreter, line by line of a script.

mod monitor;
mod script;
mod session;
mod stepping;
mod transcript;
mod values;
mod world;

pub(crate) use self::script::{call_name, is_skipped, parameters};
pub(crate) use self::session::IDLE;
pub use self::session::Session;
pub(crate) use self::transcript::test_acts;
pub use self::transcript::{Replay, replay};
pub(crate) use self::values::{fields, zero};
