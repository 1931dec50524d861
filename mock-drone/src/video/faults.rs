//! What a faulty drone sends in place of its pictures.

use bytes::Bytes;
use rand::{Rng as _, RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use super::encoder::EncodedPicture;
use crate::scenario::VideoFault;

/// Places of a header's fields: its own size, and that of the payload.
const HEADER_SIZE: usize = 6;
const PAYLOAD_SIZE: usize = 8;

/// What becomes of a picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Sent {
    /// These bytes are sent.
    Bytes(Bytes),
    /// Nothing is sent.
    Nothing,
    /// The connection is closed.
    End,
}

/// A wrong size in a header.
#[derive(Debug, Clone, Copy)]
enum Lie {
    Payload(u32),
    Header(u16),
}

/// One after the other: those that a client must refuse, those that it can only find out by what follows, and those that
/// cut the picture.
const LIES: [Lie; 7] = [
    Lie::Payload(u32::MAX),
    Lie::Payload(1_000_000),
    Lie::Payload(100),
    Lie::Payload(0),
    Lie::Header(u16::MAX),
    Lie::Header(200),
    Lie::Header(64),
];

/// Spoils pictures on their way to one client.
#[derive(Debug)]
pub(crate) struct Spoiler {
    random: ChaCha8Rng,
    lies: usize,
}

impl Default for Spoiler {
    fn default() -> Self {
        Self { random: ChaCha8Rng::seed_from_u64(0), lies: 0 }
    }
}

impl Spoiler {
    /// What the client gets of a picture. What follows a fault is the next picture, whatever it depends on: an encoder
    /// knows nothing of what happens behind it.
    pub(crate) fn spoil(&mut self, picture: &EncodedPicture, fault: Option<VideoFault>) -> Sent {
        match fault {
            None => Sent::Bytes(picture.bytes.clone()),
            Some(VideoFault::Cut) => Sent::End,
            Some(VideoFault::Silent) => Sent::Nothing,
            Some(VideoFault::Garbage) => Sent::Bytes(self.garbage(picture.bytes.len())),
            Some(VideoFault::Lie) => Sent::Bytes(self.lie(&picture.bytes)),
        }
    }

    fn garbage(&mut self, length: usize) -> Bytes {
        let mut bytes = vec![0; length];
        self.random.fill_bytes(&mut bytes);
        let place = self.random.random_range(0..length.max(1));
        for (byte, letter) in bytes.iter_mut().skip(place).zip(ardrone_link::video::SIGNATURE) {
            *byte = letter;
        }
        bytes.into()
    }

    fn lie(&mut self, bytes: &[u8]) -> Bytes {
        let mut bytes = bytes.to_vec();
        let (place, size) = match LIES[self.lies % LIES.len()] {
            Lie::Header(size) => (HEADER_SIZE, size.to_le_bytes().to_vec()),
            Lie::Payload(size) => (PAYLOAD_SIZE, size.to_le_bytes().to_vec()),
        };
        self.lies += 1;
        for (byte, wrong) in bytes.iter_mut().skip(place).zip(size) {
            *byte = wrong;
        }
        bytes.into()
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use ardrone_link::video::{Picture, Reader};
    use nalgebra::Vector3;

    use super::*;
    use crate::video::{Scene, VideoEncoder, View};

    const PICTURES: u64 = 14;

    /// What a client reads of a stream with a fault, and the bytes that belonged to no picture.
    fn read(fault: Option<VideoFault>) -> (Vec<Picture>, u64) {
        let view = View {
            position_m: Vector3::new(0.0, 0.0, 1.0),
            yaw_rad: 0.0,
            pitch_rad: 0.0,
            roll_rad: 0.0,
            is_bottom: true,
        };
        let mut encoder = VideoEncoder::new(None).unwrap();
        let (mut spoiler, mut reader) = (Spoiler::default(), Reader::default());
        let mut pictures = Vec::new();
        for number in 0..PICTURES {
            let time = Duration::from_millis(number * 33);
            let picture = encoder.encode(time, &Scene::default(), &view).unwrap();
            if let Sent::Bytes(bytes) = spoiler.spoil(&picture, fault) {
                assert_eq!(bytes.len(), picture.bytes.len());
                reader.push(&bytes);
            }
            pictures.extend(std::iter::from_fn(|| reader.next()));
        }
        (pictures, reader.garbage_bytes())
    }

    #[test]
    fn each_fault_spoils_every_picture() {
        let (good, garbage) = read(None);
        assert_eq!((good.len(), garbage), (14, 0));
        for fault in [VideoFault::Cut, VideoFault::Silent] {
            assert_eq!(read(Some(fault)), (Vec::new(), 0), "{fault:?}");
        }
        let (pictures, garbage) = read(Some(VideoFault::Garbage));
        assert_eq!(pictures, []);
        assert!(garbage > 10_000, "{garbage}");
        let (pictures, garbage) = read(Some(VideoFault::Lie));
        assert!(garbage > 10_000, "{garbage}");
        // A client takes those that announce less than follows, which are not what was encoded.
        assert_eq!(pictures.len(), 6);
        for picture in pictures {
            assert!(good.iter().all(|one| one.payload != picture.payload));
        }
    }
}
