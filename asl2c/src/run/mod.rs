//! An agent that is run by the reference interpreter, one line of a script after the other.

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
