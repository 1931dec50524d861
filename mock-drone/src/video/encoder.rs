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

/// Encodes one picture after the other.
pub struct VideoEncoder {
    encoder: Encoder,
    kbit_s: u32,
    wanted_kbit_s: u32,
    /// Pictures since the last key picture, with it.
    group: u32,
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
        // The encoder keeps its rate for life. At a key picture another one can go on, because nothing depends on what was
        // before; two key pictures in a row could not be told apart by their numbers.
        if self.kbit_s != self.wanted_kbit_s && self.group == GROUP {
            self.encoder = encoder(self.wanted_kbit_s)?;
            self.kbit_s = self.wanted_kbit_s;
        }
        scene.render(view, &mut self.pixels);
        if let Some(zero) = self.clock {
            draw_clock(zero.wrapping_add(milliseconds(time)), &mut self.pixels.luma);
        }
        let payload = self.encoder.encode_planes(&YuvPlanes {
            width: WIDTH,
            height: HEIGHT,
            y: &self.pixels.luma,
            u: &self.pixels.blue,
            v: &self.pixels.red,
            stride_y: WIDTH,
            stride_c: WIDTH / 2,
        })?;
        let is_entry = is_entry(&payload);
        self.group = if is_entry { 1 } else { self.group + 1 };
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
