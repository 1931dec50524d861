//! Drops late frames for live viewing.

use std::collections::VecDeque;

use super::continuity::Continuity;
use super::reader::Picture;

/// Pictures that may wait. The drone sends a key picture every half second, which replaces what waits; this is for
/// streams without.
const MOST: usize = 64;

/// Pictures that wait to be shown.
///
/// A viewer that is behind continues with the newest key picture, so that it never shows the past for long.
#[derive(Debug, Default)]
pub struct Watching {
    waiting: VecDeque<Picture>,
    continuity: Continuity,
    left_out: u64,
}

impl Watching {
    /// Takes the next picture of the stream.
    pub fn push(&mut self, picture: Picture) {
        if !self.continuity.passes(&picture) {
            self.left_out += 1;
            return;
        }
        let is_full = self.waiting.len() >= MOST;
        if picture.is_entry() || is_full {
            self.left_out += self.waiting.len() as u64;
            self.waiting.clear();
        }
        if is_full && !picture.is_entry() {
            // It depends on those that were left out.
            self.continuity.interrupt();
            self.left_out += 1;
        } else {
            self.waiting.push_back(picture);
        }
    }

    /// Continues with the next key picture: some were lost on the way here.
    pub fn interrupt(&mut self) {
        self.continuity.interrupt();
    }

    /// The next picture to show.
    pub fn pop(&mut self) -> Option<Picture> {
        self.waiting.pop_front()
    }

    /// Pictures that were not shown.
    pub fn left_out(&self) -> u64 {
        self.left_out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::video::reader::Reader;

    const LONG: &[u8] = include_bytes!("../../../tests/fixtures/video/pave.bin");

    fn captured() -> Vec<Picture> {
        let mut reader = Reader::default();
        reader.push(LONG);
        std::iter::from_fn(|| reader.next()).collect()
    }

    fn shown(watching: &mut Watching) -> Vec<u32> {
        std::iter::from_fn(|| watching.pop()).map(|picture| picture.header.number).collect()
    }

    #[test]
    fn who_keeps_up_sees_everything_from_the_first_key_picture() {
        let mut watching = Watching::default();
        let mut seen = Vec::new();
        for picture in captured() {
            watching.push(picture);
            seen.extend(shown(&mut watching));
        }
        assert_eq!(seen, (17_565..=17_581).collect::<Vec<u32>>());
        assert_eq!(watching.left_out(), 3);
    }

    #[test]
    fn who_is_behind_continues_with_the_newest_key_picture() {
        let mut watching = Watching::default();
        for picture in captured() {
            watching.push(picture);
        }
        assert_eq!(shown(&mut watching), [17_580, 17_581]);
        assert_eq!(watching.left_out(), 18);
    }

    #[test]
    fn a_stream_without_key_pictures_does_not_fill_the_memory() {
        let mut watching = Watching::default();
        let [key, next] = [3, 4].map(|index| captured().swap_remove(index));
        let following = (0_u32..200).map(|count| {
            let mut picture = next.clone();
            picture.header.number += count;
            picture
        });
        watching.push(key);
        for picture in following {
            watching.push(picture);
        }
        assert_eq!(shown(&mut watching), []);
        assert_eq!(watching.left_out(), 201);
    }
}
