//! Live video (TCP 5555): pictures from the stream, and the client's side of the connection as a pure state machine.
//!
//! The drone sends one H.264 access unit after the other, each behind a [`Header`]. Nothing is decoded here: a browser, a
//! log viewer and ffmpeg take the [`Picture::payload`] as it is.
//!
//! ```
//! use ardrone_link::video::Reader;
//!
//! let mut reader = Reader::default();
//! reader.push(b"anything");
//! assert_eq!(reader.next(), None);
//! ```

mod continuity;
mod header;
mod reader;
mod session;
mod watching;

pub use header::{Codec, HEADER_BYTES, Header, LONGEST_PAYLOAD, PictureKind, SIGNATURE, Size};
pub use reader::{Picture, Reader, is_entry};
pub use session::{Input, Output, VideoEvent, VideoSession};
pub use watching::Watching;
