//! Vehicles of one fleet on more than one machine: what they tell each other over a network, and what of that is believed.
//!
//! Everything but `bridge` is without clock, socket or file: bytes and times in, bytes and decisions out. `bridge`, which a
//! program has only with the feature `zenoh`, carries the bytes.

#[cfg(feature = "zenoh")]
pub mod bridge;
mod clock;
mod lines;
mod news;
mod peers;
mod refused;
mod roster;
mod state;

pub use self::clock::{Bound, DRIFT};
pub use self::lines::{Inbox, LONGEST_LINE_BYTES, Line, LineError, NoLine, Outbox, Talk, WAITING};
pub use self::news::{News, Seen, Told, Totals};
pub use self::peers::{Change, Heard, Peers, TOO_OLD};
pub use self::refused::{Count, Refused};
pub use self::roster::{Digest, Entry, Roster, UnknownVehicle};
pub use self::state::{Echo, MOST_ECHOES, STATE_BYTES, Session, State, Unreadable, VERSION};
