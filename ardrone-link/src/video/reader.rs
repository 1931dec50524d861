//! Pictures from a stream of bytes, with resynchronisation.

use bytes::{Buf as _, Bytes, BytesMut};

use super::header::{HEADER_BYTES, Header, PictureKind, SIGNATURE};

/// A picture of the stream, or one slice of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// Its header.
    pub header: Header,
    /// The encoded picture.
    pub payload: Bytes,
    /// Whether there was garbage before it, so that pictures may be missing.
    pub after_garbage: bool,
}

impl Picture {
    /// Whether a decoder can begin with it: a key picture with its parameter sets.
    pub fn is_entry(&self) -> bool {
        self.header.kind == PictureKind::Key && is_entry(&self.payload)
    }
}

/// Whether an encoded picture begins with a sequence parameter set, as those do with which a decoder can begin.
pub fn is_entry(payload: &[u8]) -> bool {
    const START_CODE: [u8; 4] = [0, 0, 0, 1];
    const SPS: u8 = 7;
    const KIND: u8 = 0x1f;
    let is_sps = |rest: &[u8]| rest.first().is_some_and(|kind| kind & KIND == SPS);
    payload.strip_prefix(&START_CODE).is_some_and(is_sps)
}

/// Splits a stream into pictures. Whatever arrives, it keeps at most one picture of the largest size.
///
/// A header that announces more than follows is found out by the next header inside its payload: the damaged picture is
/// dropped then. One that announces less is passed on, because waiting for what follows would delay every picture.
#[derive(Debug, Default)]
pub struct Reader {
    waiting: BytesMut,
    /// Bytes of the payload that begins with `waiting` in which there is no other header.
    searched: usize,
    after_garbage: bool,
    garbage_bytes: u64,
}

impl Reader {
    /// Takes bytes from the stream. [`Self::next`] has to be called until it returns `None`.
    pub fn push(&mut self, bytes: &[u8]) {
        self.waiting.extend_from_slice(bytes);
    }

    /// Forgets what has arrived of a picture: the next bytes are those of another connection.
    pub fn restart(&mut self) {
        self.waiting.clear();
        self.searched = 0;
        self.after_garbage = false;
    }

    /// Bytes so far that belonged to no picture.
    pub fn garbage_bytes(&self) -> u64 {
        self.garbage_bytes
    }

    /// The next complete picture.
    #[expect(clippy::should_implement_trait, reason = "more bytes may follow its end")]
    pub fn next(&mut self) -> Option<Picture> {
        loop {
            self.skip_garbage();
            if self.waiting.len() < HEADER_BYTES {
                return None;
            }
            let Some(header) = Header::decode(&self.waiting) else {
                self.drop_garbage(SIGNATURE.len());
                continue;
            };
            let start = usize::from(header.header_bytes);
            // It is at most `LONGEST_PAYLOAD`.
            let end = start.saturating_add(header.payload_bytes as usize);
            let there = end.min(self.waiting.len());
            if let Some(other) = self.other_header(HEADER_BYTES.min(there), there) {
                self.drop_garbage(other);
                continue;
            }
            if there < end {
                return None;
            }
            let mut picture = self.waiting.split_to(end).freeze();
            picture.advance(start);
            self.searched = 0;
            let after_garbage = std::mem::take(&mut self.after_garbage);
            return Some(Picture { header, payload: picture, after_garbage });
        }
    }

    /// The place of a header that is wholly in what is there of a picture.
    fn other_header(&mut self, from: usize, to: usize) -> Option<usize> {
        let from = from.max(self.searched);
        let there = self.waiting.get(from..to)?;
        let mut places = there.windows(HEADER_BYTES);
        let found = places.position(|bytes| Header::decode(bytes).is_some());
        self.searched = (to + 1).saturating_sub(HEADER_BYTES).max(from);
        found.map(|place| from + place)
    }

    /// Drops what is before the next signature.
    fn skip_garbage(&mut self) {
        let signature =
            self.waiting.windows(SIGNATURE.len()).position(|window| window == SIGNATURE);
        let garbage = signature.unwrap_or_else(|| {
            // The end may be the beginning of a signature.
            let begun = (1..SIGNATURE.len())
                .rev()
                .find(|length| self.waiting.ends_with(&SIGNATURE[..*length]));
            self.waiting.len() - begun.unwrap_or(0)
        });
        if garbage > 0 {
            self.drop_garbage(garbage);
        }
    }

    fn drop_garbage(&mut self, bytes: usize) {
        self.waiting.advance(bytes);
        self.searched = 0;
        self.after_garbage = true;
        self.garbage_bytes += bytes as u64;
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::video::header::LONGEST_PAYLOAD;

    const LONG: &[u8] = include_bytes!("../../../tests/fixtures/video/pave.bin");
    const SHORT: &[u8] = include_bytes!("../../../tests/fixtures/video/pave68.bin");

    fn pictures(reader: &mut Reader) -> Vec<Picture> {
        std::iter::from_fn(|| reader.next()).collect()
    }

    fn read(bytes: &[u8]) -> Vec<Picture> {
        let mut reader = Reader::default();
        reader.push(bytes);
        pictures(&mut reader)
    }

    /// A header that announces a payload of this size.
    fn announcing(payload_bytes: u32) -> Vec<u8> {
        let header = Header { payload_bytes, ..Header::decode(SHORT).unwrap() };
        let mut bytes = Vec::new();
        header.encode(&mut bytes);
        bytes
    }

    #[test]
    fn captures_have_their_pictures() {
        let (long, short) = (read(LONG), read(SHORT));
        assert_eq!((long.len(), short.len()), (20, 5));
        let used = |found: &[Picture]| {
            let bytes = |p: &Picture| usize::from(p.header.header_bytes) + p.payload.len();
            found.iter().map(bytes).sum::<usize>()
        };
        assert_eq!((used(&long), used(&short)), (LONG.len(), SHORT.len()));
        assert!(short[0].is_entry() && !short[1].is_entry());
        assert!(long.iter().all(|p| p.payload.starts_with(&[0, 0, 0, 1]) && !p.after_garbage));
        // An entry has its parameter sets, whose sizes the header knows.
        for picture in long.iter().chain(&short) {
            let parameters = picture.header.sps_bytes > 0;
            assert_eq!(picture.is_entry(), parameters);
        }
    }

    #[test]
    fn pictures_are_found_behind_garbage() {
        let garbage = b"PaPaVPaVE\0\x04not a header";
        let found = read(&[garbage, SHORT, garbage, LONG].concat());
        assert_eq!(found.len(), 25);
        let after: Vec<usize> = (0..25).filter(|index| found[*index].after_garbage).collect();
        assert_eq!(after, [0, 5]);
    }

    #[test]
    fn a_size_that_is_too_large_costs_one_picture() {
        for too_large in [20_000, 100_000, u32::try_from(LONGEST_PAYLOAD).unwrap()] {
            let mut reader = Reader::default();
            reader.push(&announcing(too_large));
            reader.push(b"what there is");
            assert_eq!(pictures(&mut reader), []);
            reader.push(SHORT);
            let found = pictures(&mut reader);
            assert_eq!(found.len(), 5, "{too_large}");
            assert!(found[0].after_garbage);
            assert_eq!(reader.garbage_bytes(), 68 + 13);
        }
    }

    #[test]
    fn a_size_that_is_too_small_is_garbage_behind() {
        let mut stream = announcing(10);
        stream.extend_from_slice(&SHORT[68..68 + 10_180]);
        stream.extend_from_slice(SHORT);
        let found = read(&stream);
        assert_eq!(found.len(), 6);
        assert!(!found[0].after_garbage && found[1].after_garbage);
        // Nothing is announced, and nothing is there.
        assert_eq!(read(&[announcing(0), SHORT.to_vec()].concat()).len(), 6);
    }

    #[test]
    fn garbage_is_not_kept() {
        let mut reader = Reader::default();
        for _ in 0..1000 {
            reader.push(&[b'P'; 4096]);
            assert_eq!(reader.next(), None);
            assert!(reader.waiting.len() < HEADER_BYTES);
        }
    }

    proptest! {
        /// However the network cuts the stream.
        #[test]
        fn the_cuts_of_the_network_change_nothing(sizes in prop::collection::vec(1_usize..6000, 1..60)) {
            let mut reader = Reader::default();
            let (mut rest, mut found) = ([SHORT, b"garbage", LONG].concat(), Vec::new());
            let expected = read(&rest);
            for size in sizes.iter().cycle() {
                if rest.is_empty() {
                    break;
                }
                let later = rest.split_off((*size).min(rest.len()));
                reader.push(&rest);
                found.extend(pictures(&mut reader));
                rest = later;
            }
            prop_assert_eq!(found, expected);
        }

        /// A damaged stream is read to its end, and most of its pictures are there.
        #[test]
        fn damage_costs_what_it_hits(places in prop::collection::vec((0..SHORT.len(), any::<u8>()), 1..4)) {
            let mut damaged = SHORT.to_vec();
            for (place, byte) in places {
                damaged[place] = byte;
            }
            damaged.extend_from_slice(LONG);
            let found = read(&damaged);
            prop_assert!(found.len() >= 20, "{}", found.len());
        }
    }
}
