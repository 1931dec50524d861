//! Any bytes as a video stream, cut anywhere: no panic, no growth, and every picture lies in the stream.
#![no_main]

use ardrone_link::video::{HEADER_BYTES, LONGEST_PAYLOAD, Picture, Reader};
use libfuzzer_sys::fuzz_target;

fn pictures(parts: &[&[u8]]) -> (Vec<Picture>, u64) {
    let mut reader = Reader::default();
    let mut found = Vec::new();
    for part in parts {
        reader.push(part);
        found.extend(std::iter::from_fn(|| reader.next()));
    }
    (found, reader.garbage_bytes())
}

fuzz_target!(|input: (usize, &[u8])| {
    let (cut, bytes) = input;
    let (found, garbage) = pictures(&[bytes]);
    let size = |picture: &Picture| usize::from(picture.header.header_bytes) + picture.payload.len();
    let used: usize = found.iter().map(size).sum();
    assert!(used as u64 + garbage <= bytes.len() as u64);
    for picture in &found {
        assert!(usize::from(picture.header.header_bytes) >= HEADER_BYTES);
        assert!(picture.payload.len() <= LONGEST_PAYLOAD);
        assert_eq!(picture.header.payload_bytes as usize, picture.payload.len());
    }
    let (begin, end) = bytes.split_at(cut.checked_rem(bytes.len() + 1).unwrap_or(0));
    assert_eq!(pictures(&[begin, end]).0, found);
});
