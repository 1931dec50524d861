//! The video stream: what the cameras see, rendered and encoded as the drone does.
//!
//! `scene` renders a picture, `encoder` makes an H.264 access unit behind a header of it, `faults` spoils that. All are
//! pure; the server sends the result to clients.

mod encoder;
#[cfg(feature = "server")]
mod faults;
mod scene;

pub use encoder::{EncodedPicture, VideoEncoder};
#[cfg(feature = "server")]
pub(crate) use faults::{Sent, Spoiler};
pub use scene::{Scene, View};
