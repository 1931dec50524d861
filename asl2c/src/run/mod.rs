//! Runs an agent by the reference interpreter, line by line of a script.

mod monitor;
mod script;
mod session;
mod stepping;
mod transcript;
mod values;
mod world;

pub(crate) use self::script::is_skipped;
pub(crate) use self::session::IDLE;
pub use self::session::Session;
pub use self::transcript::{Replay, replay};
