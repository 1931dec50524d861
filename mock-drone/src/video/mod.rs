//! The video stream: what the cameras see, rendered and encoded as the drone does.
//!
//! `scene` renders a picture, `encoder` makes an H.264 access unit behind a header of it. Both are pure; the server sends
//! the result to clients.

mod encoder;
mod scene;

pub use encoder::{EncodedPicture, VideoEncoder};
pub use scene::{Scene, View};
