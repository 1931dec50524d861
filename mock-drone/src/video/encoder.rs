//! Pictures as the drone encodes them: H.264 Constrained Baseline, one slice, a key picture every half second.

use std::time::Duration;

use ardrone_link::video::{Codec, Header, PictureKind, Size, is_entry};
use bytes::{BufMut as _, Bytes, BytesMut};
use rusty_h264_common::YuvPlanes;
use rusty_h264_encoder::{EncodeError, Encoder, EncoderConfig};

use super::scene::{HEIGHT, Pixels, Scene, View, WIDTH};

/// Pictures from one key picture to the next.
const GROUP: u32 = 15;
/// Thousands of bits per second, unless something else is asked for.
const RATE: u32 = 1000;
/// Pictures per second.
const PICTURES_PER_S: f32 = 30.0;
/// Headers of most captures are longer than what is known of them.
const HEADER: u16 = 68;
/// Encoded pictures consist of blocks of 16 pixels.
const ENCODED: Size = Size { width: 640, height: 368 };
const SHOWN: Size = Size { width: 640, height: 360 };
/// Blocks of the clock in the picture, of this width and height.
const CLOCK_BITS: usize = 32;
const CLOCK_BLOCK: usize = 16;

/// A picture with its header.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EncodedPicture {
    /// The bytes of the stream.
    pub bytes: Bytes,
    /// Whether a decoder can begin with it.
    pub is_entry: bool,
}

/// The pictures since the last key picture, with it, as long as all show the same.
///
/// A whole group of them that keeps the bit rate is sent again while nothing moves: a drone that stands on the ground, before most
/// flights and after each, would take half a processor to show what it has shown.
#[derive(Default)]
struct Still {
    of: Option<(Scene, View)>,
    payloads: Vec<Bytes>,
    /// Which of them is sent next, if they are sent again.
    next: usize,
}

impl Still {
    fn shows(&self, scene: &Scene, view: &View) -> bool {
        self.of.as_ref().is_some_and(|of| (&of.0, &of.1) == (scene, view))
    }

    fn record(&mut self, scene: &Scene, view: &View, payload: &Bytes) {
        self.next = 0;
        if is_entry(payload) {
            self.of = Some((scene.clone(), *view));
            self.payloads.clear();
        }
        if self.of.is_some() {
            self.payloads.push(payload.clone());
        }
    }

    /// The bit rate of a whole group.
    fn kbit_s(&self) -> f32 {
        let bytes: usize = self.payloads.iter().map(Bytes::len).sum();
        bytes as f32 * 8.0 / 1000.0 * PICTURES_PER_S / GROUP as f32
    }

    /// The next picture, if that is one that was there already.
    fn repeat(&mut self, is_same: bool, kbit_s: u32) -> Option<Bytes> {
        // The encoder goes on with a key picture, and two of them in a row could not be told apart by their numbers.
        let is_behind_key = self.next == 1;
        if self.payloads.len() < GROUP as usize
            || !(is_same || is_behind_key)
            || self.kbit_s() > kbit_s as f32
        {
            return None;
        }
        let payload = self.payloads[self.next].clone();
        self.next = (self.next + 1) % self.payloads.len();
        Some(payload)
    }
}

/// Encodes one picture after the other.
pub struct VideoEncoder {
    encoder: Encoder,
    kbit_s: u32,
    wanted_kbit_s: u32,
    /// Pictures since the encoder's last key picture, with it.
    group: u32,
    still: Still,
    pixels: Pixels,
    clock: Option<u32>,
    number: u32,
    position: u64,
}

impl std::fmt::Debug for VideoEncoder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("VideoEncoder").field("number", &self.number).finish_non_exhaustive()
    }
}

impl VideoEncoder {
    /// An encoder. With a `clock`, milliseconds at time zero, each picture has the time along its lower edge: 32 blocks of
    /// 16 pixels, white for one, the highest bit on the left.
    ///
    /// # Errors
    /// [`EncodeError`] if the encoder refuses its configuration.
    pub fn new(clock: Option<u32>) -> Result<Self, EncodeError> {
        Ok(Self {
            encoder: encoder(RATE)?,
            kbit_s: RATE,
            wanted_kbit_s: RATE,
            group: 0,
            still: Still::default(),
            pixels: Pixels::default(),
            clock,
            number: 0,
            position: 0,
        })
    }

    /// Asks for another bit rate, in thousands of bits per second, from the next key picture on.
    pub fn set_rate(&mut self, kbit_s: u32) {
        self.wanted_kbit_s = kbit_s;
    }

    /// Renders and encodes the next picture.
    ///
    /// # Errors
    /// [`EncodeError`] if the encoder fails.
    pub fn encode(
        &mut self,
        time: Duration,
        scene: &Scene,
        view: &View,
    ) -> Result<EncodedPicture, EncodeError> {
        let payload = self.payload(time, scene, view)?;
        let is_entry = is_entry(&payload);
        let [sps_bytes, pps_bytes] = if is_entry { parameter_bytes(&payload) } else { [0, 0] };
        let payload_bytes = u32::try_from(payload.len()).unwrap_or(u32::MAX);
        let header = Header {
            codec: Codec::H264,
            header_bytes: HEADER,
            payload_bytes,
            encoded: ENCODED,
            shown: SHOWN,
            number: self.number,
            time,
            kind: if is_entry { PictureKind::Key } else { PictureKind::Difference },
            position: self.position,
            stream: 1,
            slices: 1,
            slice: 0,
            sps_bytes,
            pps_bytes,
        };
        self.number = self.number.wrapping_add(1);
        let parameters = u64::from(sps_bytes) + u64::from(pps_bytes);
        self.position += u64::from(payload_bytes).saturating_sub(parameters);
        let mut bytes = BytesMut::with_capacity(usize::from(HEADER) + payload.len());
        header.encode(&mut bytes);
        bytes.put_slice(&payload);
        Ok(EncodedPicture { bytes: bytes.freeze(), is_entry })
    }

    /// The access unit of a picture.
    fn payload(
        &mut self,
        time: Duration,
        scene: &Scene,
        view: &View,
    ) -> Result<Bytes, EncodeError> {
        let is_same = self.clock.is_none()
            && self.kbit_s == self.wanted_kbit_s
            && self.still.shows(scene, view);
        if let Some(payload) = self.still.repeat(is_same, self.kbit_s) {
            return Ok(payload);
        }
        // The encoder keeps its rate for life. At a key picture another one can go on, because nothing depends on what was
        // before; two key pictures in a row could not be told apart by their numbers.
        if self.kbit_s != self.wanted_kbit_s && self.group == GROUP {
            self.encoder = encoder(self.wanted_kbit_s)?;
            self.kbit_s = self.wanted_kbit_s;
        }
        if !is_same {
            self.still.of = None;
            scene.render(view, &mut self.pixels);
        }
        if let Some(zero) = self.clock {
            draw_clock(zero.wrapping_add(milliseconds(time)), &mut self.pixels.luma);
        }
        let payload = Bytes::from(self.encoder.encode_planes(&YuvPlanes {
            width: WIDTH,
            height: HEIGHT,
            y: &self.pixels.luma,
            u: &self.pixels.blue,
            v: &self.pixels.red,
            stride_y: WIDTH,
            stride_c: WIDTH / 2,
        })?);
        self.group = if is_entry(&payload) { 1 } else { self.group + 1 };
        self.still.record(scene, view, &payload);
        Ok(payload)
    }
}

/// An encoder with a bit rate.
fn encoder(kbit_s: u32) -> Result<Encoder, EncodeError> {
    Encoder::new(EncoderConfig {
        gop_size: GROUP,
        min_keyint: GROUP,
        bitrate: kbit_s.saturating_mul(1000),
        framerate: PICTURES_PER_S,
        ..EncoderConfig::baseline(WIDTH, HEIGHT)
    })
}

/// Sizes of the first two units of an access unit, with their start codes.
fn parameter_bytes(payload: &[u8]) -> [u8; 2] {
    const START_CODE: [u8; 4] = [0, 0, 0, 1];
    let mut starts = payload.windows(4).enumerate().filter(|(_, four)| *four == START_CODE);
    let mut next = || starts.next().map_or(0, |(place, _)| place);
    let [first, second, third] = [next(), next(), next()];
    [second - first, third.saturating_sub(second)].map(|bytes| u8::try_from(bytes).unwrap_or(0))
}

/// The lowest 32 bits.
#[allow(clippy::cast_possible_truncation, reason = "the highest are cut off")]
fn milliseconds(time: Duration) -> u32 {
    time.as_millis() as u32
}

fn draw_clock(milliseconds: u32, luma: &mut [u8]) {
    let left = (WIDTH - CLOCK_BITS * CLOCK_BLOCK) / 2;
    for row in HEIGHT - CLOCK_BLOCK..HEIGHT {
        let line = &mut luma[row * WIDTH + left..][..CLOCK_BITS * CLOCK_BLOCK];
        for (bit, block) in (0..u32::BITS).rev().zip(line.chunks_mut(CLOCK_BLOCK)) {
            block.fill(if milliseconds >> bit & 1 == 1 { 235 } else { 16 });
        }
    }
}

#[cfg(test)]
mod tests {
    use ardrone_link::video::Reader;
    use nalgebra::Vector3;

    use super::*;

    const VIEW: View = View {
        position_m: Vector3::new(0.0, 0.0, 1.0),
        yaw_rad: 0.0,
        pitch_rad: 0.0,
        roll_rad: 0.0,
        is_bottom: true,
    };

    #[test]
    fn the_stream_is_one_that_our_client_reads() {
        let mut encoder = VideoEncoder::new(None).unwrap();
        let (scene, mut reader) = (Scene::default(), Reader::default());
        let mut bytes = 0;
        for number in 0..60_u32 {
            let mut view = VIEW;
            view.position_m.x = f64::from(number) * 0.01;
            let time = Duration::from_millis(u64::from(number) * 33);
            let encoded = encoder.encode(time, &scene, &view).unwrap();
            assert_eq!(encoded.is_entry, number % GROUP == 0, "{number}");
            bytes += encoded.bytes.len();
            reader.push(&encoded.bytes);
            let picture = reader.next().unwrap();
            let header = picture.header;
            assert_eq!((header.number, header.time), (number, time));
            assert_eq!(picture.is_entry(), encoded.is_entry);
            assert_eq!(header.sps_bytes > 0, encoded.is_entry);
            assert!(!picture.after_garbage);
        }
        assert_eq!(reader.garbage_bytes(), 0);
        // Two seconds at about 1 Mbit/s.
        assert!((100_000..500_000).contains(&bytes), "{bytes}");
    }

    #[test]
    fn what_stands_still_is_encoded_once() {
        let mut encoder = VideoEncoder::new(None).unwrap();
        let mut reader = Reader::default();
        let mut number = 0_u32;
        let mut was_key = false;
        // Each view is left at another place of the group that is sent again.
        for count in 30..50 {
            let view = View { position_m: Vector3::new(f64::from(count), 0.0, 1.0), ..VIEW };
            let mut keys = Vec::new();
            for nth in 0..count {
                let time = Duration::from_millis(33 * u64::from(number));
                reader.push(&encoder.encode(time, &Scene::default(), &view).unwrap().bytes);
                let picture = reader.next().unwrap();
                assert_eq!((picture.header.number, picture.header.time), (number, time));
                assert!(!(was_key && picture.is_entry()), "two key pictures in a row");
                // What is seen elsewhere is shown at once, or behind a picture that has to come before.
                assert!(nth != 1 || was_key || picture.is_entry(), "{count}");
                was_key = picture.is_entry();
                number += 1;
                if was_key {
                    keys.push(picture.payload);
                }
            }
            assert!(keys.len() >= 2 && keys.iter().all(|key| *key == keys[0]), "{count}");
        }
    }

    #[test]
    fn a_group_in_which_something_moved_is_not_sent_again() {
        let mut encoder = VideoEncoder::new(None).unwrap();
        let mut reader = Reader::default();
        let mut film = |moves: bool| -> Vec<Bytes> {
            let picture = |nth| {
                let x = if moves && nth == 7 { 0.1 } else { 0.0 };
                let view = View { position_m: Vector3::new(x, 0.0, 1.0), ..VIEW };
                let encoded = encoder.encode(Duration::ZERO, &Scene::default(), &view).unwrap();
                reader.push(&encoded.bytes);
                reader.next().unwrap().payload
            };
            (0..GROUP).map(picture).collect()
        };
        let [moved, stood, again] = [true, false, false].map(&mut film);
        assert_ne!(moved[7], stood[7]);
        assert_eq!(stood, again);
    }

    #[test]
    fn the_rate_changes_at_a_key_picture() {
        let mut encoder = VideoEncoder::new(None).unwrap();
        let mut reader = Reader::default();
        let mut number = 0_u32;
        // Pictures of three seconds, of which the first is left out, and their kilobits per second.
        let mut film = |kbit_s: u32| {
            encoder.set_rate(kbit_s);
            let mut bytes = 0;
            for _ in 0..90 {
                let mut view = VIEW;
                // The front camera, turning.
                view.is_bottom = false;
                view.yaw_rad = f64::from(number) * 0.03;
                let time = Duration::from_millis(u64::from(number) * 33);
                let encoded = encoder.encode(time, &Scene::default(), &view).unwrap();
                assert_eq!(encoded.is_entry, number.is_multiple_of(GROUP), "{number}");
                reader.push(&encoded.bytes);
                assert_eq!(reader.next().unwrap().header.number, number);
                number += 1;
                bytes += if number % 90 >= 30 { encoded.bytes.len() } else { 0 };
            }
            bytes * 8 / 2 / 1000
        };
        for kbit_s in [1000, 250, 4000, 500] {
            let found = film(kbit_s);
            assert!(found.abs_diff(kbit_s as usize) < kbit_s as usize / 10, "{kbit_s}: {found}");
        }
    }

    /// The first group after a change is much larger than those into which the encoder settles.
    #[test]
    fn a_group_beyond_the_rate_is_not_sent_again() {
        let mut encoder = VideoEncoder::new(None).unwrap();
        encoder.set_rate(250);
        let mut film = |pictures: u32| {
            let view = View { is_bottom: false, ..VIEW };
            let mut picture = || encoder.encode(Duration::ZERO, &Scene::default(), &view).unwrap();
            let bytes: usize = (0..pictures).map(|_| picture().bytes.len()).sum();
            bytes as f32 * 8.0 / 1000.0 / (pictures as f32 / PICTURES_PER_S)
        };
        let (at_first, settled) = (film(30), film(90));
        assert!(at_first > 1000.0 && settled < 0.7 * at_first, "{at_first} {settled}");
    }

    #[test]
    fn the_clock_goes_on_where_nothing_moves() {
        let mut encoder = VideoEncoder::new(Some(0)).unwrap();
        let mut film = |nth: u64| {
            encoder.encode(Duration::from_secs(nth), &Scene::default(), &VIEW).unwrap().bytes
        };
        let pictures: Vec<Bytes> = (0..u64::from(GROUP) * 2).map(&mut film).collect();
        assert_ne!(pictures[1][usize::from(HEADER)..], pictures[16][usize::from(HEADER)..]);
    }

    #[test]
    fn the_clock_is_in_the_picture() {
        let mut luma = vec![0; WIDTH * HEIGHT];
        draw_clock(0x8000_0005, &mut luma);
        let bits: Vec<bool> =
            (0..32).map(|bit| luma[350 * WIDTH + 64 + bit * 16 + 8] > 128).collect();
        let expected: Vec<bool> = (0..32).map(|bit| [0, 29, 31].contains(&bit)).collect();
        assert_eq!(bits, expected);
    }
}
