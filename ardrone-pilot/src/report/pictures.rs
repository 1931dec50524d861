//! Pictures of the camera in a report, as they were encoded.

use std::time::Duration;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde::Serialize;

use crate::recording::RecordedPicture;

/// Maximum size of all pictures in a page: two minutes of video.
const MOST_BYTES: usize = 16 << 20;

/// A picture in the page.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct EmbeddedPicture {
    at_s: f64,
    /// Whether a decoder can begin with it.
    entry: bool,
    /// In base 64.
    data: String,
}

/// The pictures for a page about a part of a recording that began at `start`. Of a long video only those with which a decoder can
/// begin, and of a very long one every second of these, or fewer.
pub(super) fn embedded(
    pictures: &[RecordedPicture],
    start: Duration,
    (from, until): (Duration, Duration),
) -> Vec<EmbeddedPicture> {
    let inside = |at: Duration| (from..=until).contains(&at.saturating_sub(start));
    let first = pictures.iter().position(|picture| inside(picture.at)).unwrap_or(pictures.len());
    let count = pictures[first..].iter().take_while(|picture| inside(picture.at)).count();
    let end = first + count;
    // A decoder begins with the entry before them.
    let first = pictures[..end.min(first + 1)].iter().rposition(|picture| picture.is_entry);
    let pictures = if count == 0 { &[][..] } else { &pictures[first.unwrap_or(0)..end] };
    let bytes = |pictures: &mut dyn Iterator<Item = &RecordedPicture>| -> usize {
        pictures.map(|picture| picture.data.len()).sum()
    };
    let embed = |picture: &RecordedPicture| EmbeddedPicture {
        at_s: picture.at.saturating_sub(start).as_secs_f64(),
        entry: picture.is_entry,
        data: BASE64_STANDARD.encode(&picture.data),
    };
    if bytes(&mut pictures.iter()) <= MOST_BYTES {
        return pictures.iter().map(embed).collect();
    }
    let entries = || pictures.iter().filter(|picture| picture.is_entry);
    let every = bytes(&mut entries()).div_ceil(MOST_BYTES).max(1);
    let mut room = MOST_BYTES;
    // Their sizes differ: the end may have to be left out.
    let fits = |picture: &&RecordedPicture| {
        let left = room.checked_sub(picture.data.len());
        left.inspect(|left| room = *left).is_some()
    };
    entries().step_by(every).take_while(fits).map(embed).collect()
}

#[cfg(test)]
mod tests {
    use bytes::Bytes;

    use super::*;

    fn pictures(count: u64, bytes: usize) -> Vec<RecordedPicture> {
        let data = Bytes::from(vec![1; bytes]);
        let picture = |index: u64| RecordedPicture {
            at: Duration::from_secs(100 + index),
            data: data.clone(),
            is_entry: index.is_multiple_of(10),
        };
        (0..count).map(picture).collect()
    }

    #[test]
    fn a_page_has_the_pictures_of_its_flight_and_the_entry_before_them() {
        let part = (Duration::from_secs(25), Duration::from_secs(32));
        let all = embedded(&pictures(100, 1000), Duration::from_secs(100), part);
        assert_eq!((all.len(), all[0].at_s, all[0].entry), (13, 20.0, true));
        let late = (Duration::from_secs(200), Duration::MAX);
        assert_eq!(embedded(&pictures(100, 1000), Duration::from_secs(100), late), []);
    }

    #[test]
    fn long_videos_are_thinned() {
        let start = Duration::from_secs(100);
        let whole = (Duration::ZERO, Duration::MAX);
        let embedded = |pictures: &[RecordedPicture], start| embedded(pictures, start, whole);
        let all = embedded(&pictures(30, 1000), start);
        assert_eq!((all.len(), all[7].at_s, all[7].entry), (30, 7.0, false));
        let entries = embedded(&pictures(300, 1 << 17), start);
        assert_eq!(entries.len(), 30);
        let fewer = embedded(&pictures(3000, 1 << 17), start);
        assert_eq!(fewer.len(), 100);
        assert!(fewer.iter().all(|picture| picture.entry));
        assert_eq!(embedded(&pictures(300, MOST_BYTES + 1), start), []);
    }
}
