//! Runs an agent or a system by the reference interpreter, line by line of a script.

mod history;
mod monitor;
mod script;
mod session;
mod stepping;
mod system;
mod transcript;
mod values;
mod world;

pub(crate) use self::script::{call_name, is_skipped, parameters};
pub(crate) use self::session::IDLE;
pub use self::session::Session;
pub use self::system::{NetworkConditions, SystemSession, repeat};
pub(crate) use self::transcript::test_acts;
pub use self::transcript::{Replay, Runs, replay};
pub(crate) use self::values::{fields, numbers, zero};
