//! Which pictures a decoder can show: none before a key picture, and none that depends on a missing one.

use super::header::Header;
use super::reader::Picture;

/// Follows a stream, also across connections.
#[derive(Debug, Default)]
pub(super) struct Continuity {
    /// The last picture that was passed.
    last: Option<Header>,
}

impl Continuity {
    /// Whether a decoder that got all pictures that passed so far can show this one.
    pub(super) fn passes(&mut self, picture: &Picture) -> bool {
        let follows =
            !picture.after_garbage && self.last.is_some_and(|last| follows(&last, &picture.header));
        let passes = follows || picture.is_entry();
        self.last = passes.then_some(picture.header);
        passes
    }

    /// Waits for the next key picture.
    pub(super) fn interrupt(&mut self) {
        self.last = None;
    }
}

/// Whether nothing is missing between two pictures. The drone counts pictures, and the bytes of all pictures without
/// their parameter sets; either shows it, in case it skips numbers of pictures that it never encoded.
fn follows(last: &Header, next: &Header) -> bool {
    let parameters = u64::from(last.sps_bytes) + u64::from(last.pps_bytes);
    let bytes = u64::from(last.payload_bytes).saturating_sub(parameters);
    let is_next_slice = next.number == last.number && next.slice == last.slice.wrapping_add(1);
    next.stream == last.stream
        && (next.number == last.number.wrapping_add(1)
            || next.position == last.position.wrapping_add(bytes)
            || is_next_slice)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::video::reader::Reader;

    const LONG: &[u8] = include_bytes!("../../../tests/fixtures/video/pave.bin");

    /// Numbers of the pictures that pass, from the first.
    fn passing(pictures: impl IntoIterator<Item = Picture>) -> Vec<u32> {
        let mut continuity = Continuity::default();
        let passes = pictures.into_iter().filter(|picture| continuity.passes(picture));
        passes.map(|picture| picture.header.number).collect()
    }

    fn captured() -> Vec<Picture> {
        let mut reader = Reader::default();
        reader.push(LONG);
        std::iter::from_fn(|| reader.next()).collect()
    }

    #[test]
    fn a_capture_is_shown_from_its_first_key_picture() {
        assert_eq!(passing(captured()), (17_565..=17_581).collect::<Vec<u32>>());
    }

    #[test]
    fn a_missing_picture_interrupts_until_the_next_key_picture() {
        let without =
            |number: u32| captured().into_iter().filter(move |p| p.header.number != number);
        let expected: Vec<u32> = (17_565..17_570).chain(17_580..=17_581).collect();
        assert_eq!(passing(without(17_570)), expected);
        // Of a missing key picture nothing can be shown.
        assert_eq!(passing(without(17_565)), [17_580, 17_581]);
        let garbage = captured().into_iter().map(|mut picture| {
            picture.after_garbage = picture.header.number == 17_570;
            picture
        });
        assert_eq!(passing(garbage), expected);
    }

    #[test]
    fn either_count_shows_that_nothing_is_missing() {
        let counting = |change: fn(&mut Header)| {
            passing(captured().into_iter().map(|mut picture| {
                change(&mut picture.header);
                picture
            }))
            .len()
        };
        assert_eq!(counting(|header| header.position = 0), 17);
        assert_eq!(counting(|header| header.number *= 2), 17);
        assert_eq!(counting(|header| (header.position, header.number) = (0, header.number * 2)), 2);
    }

    #[test]
    fn an_interruption_waits_for_a_key_picture() {
        let mut continuity = Continuity::default();
        let pictures = captured();
        assert!(continuity.passes(&pictures[3]) && continuity.passes(&pictures[4]));
        continuity.interrupt();
        assert!(!continuity.passes(&pictures[5]) && continuity.passes(&pictures[18]));
    }
}
