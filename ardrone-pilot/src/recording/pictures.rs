//! The video in a flight log.

use std::time::Duration;

use ardrone_link::video::is_entry;
use bytes::Bytes;
use mcap::records::Record as McapRecord;

use super::reader::{LogError, read_records};
use super::{compressed_video, topic};

/// A picture of the camera.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecordedPicture {
    /// Time of its arrival, since the Unix epoch.
    pub at: Duration,
    /// The encoded picture.
    pub data: Bytes,
    /// Whether a decoder can begin with it.
    pub is_entry: bool,
}

/// The pictures in a file, from the first that can be decoded.
///
/// # Errors
/// [`LogError`] if it is no flight log. One that is truncated is read as far as it goes.
pub fn pictures(file: &[u8]) -> Result<Vec<RecordedPicture>, LogError> {
    let mut channel = None;
    let mut found: Vec<RecordedPicture> = Vec::new();
    read_records(file, |record| {
        match record {
            McapRecord::Channel(one) if one.topic == topic::VIDEO => channel = Some(one.id),
            McapRecord::Message { header, data } if channel == Some(header.channel_id) => {
                let data = compressed_video::payload(&data).ok_or_else(|| LogError::Message {
                    topic: topic::VIDEO.to_owned(),
                    problem: "not a picture".to_owned(),
                })?;
                let is_entry = is_entry(data);
                if is_entry || !found.is_empty() {
                    let at = Duration::from_nanos(header.log_time);
                    found.push(RecordedPicture {
                        at,
                        data: Bytes::copy_from_slice(data),
                        is_entry,
                    });
                }
            }
            _ => {}
        }
        Ok(())
    })?;
    Ok(found)
}
