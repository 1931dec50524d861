//! The `PaVE` header before each picture of the stream: little-endian, 64 bytes or more.

use std::time::Duration;

use bytes::{Buf as _, BufMut};

/// The first bytes of each header.
pub const SIGNATURE: [u8; 4] = *b"PaVE";
/// Size of the fields that are known; a header may be longer (68 bytes in most captures).
pub const HEADER_BYTES: usize = 64;
/// Longer headers are taken for garbage.
pub(super) const LONGEST_HEADER: usize = 256;
/// Longer payloads are taken for garbage. At 4 Mbit/s and 15 pictures per second a picture has 33 kB on average; one
/// that stands alone has five times as much.
pub const LONGEST_PAYLOAD: usize = 1 << 20;
/// The only version that is known.
const VERSION: u8 = 2;

/// How a picture is encoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Codec {
    /// MPEG-4 part 2.
    Mpeg4,
    /// H.264, an access unit in the form of its Annex B.
    H264,
    /// One of the first AR.Drone's, or an unknown one.
    Other(u8),
}

impl Codec {
    fn from_wire(number: u8) -> Self {
        match number {
            3 => Self::Mpeg4,
            4 => Self::H264,
            other => Self::Other(other),
        }
    }

    fn to_wire(self) -> u8 {
        match self {
            Self::Mpeg4 => 3,
            Self::H264 => 4,
            Self::Other(number) => number,
        }
    }
}

/// What a picture depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureKind {
    /// Nothing, and no later picture depends on earlier ones (IDR).
    Key,
    /// Nothing (I).
    Whole,
    /// Earlier pictures (P).
    Difference,
    /// No picture: parameters of the stream, or something unknown.
    Other(u8),
}

impl PictureKind {
    fn from_wire(number: u8) -> Self {
        match number {
            1 => Self::Key,
            2 => Self::Whole,
            3 => Self::Difference,
            other => Self::Other(other),
        }
    }

    fn to_wire(self) -> u8 {
        match self {
            Self::Key => 1,
            Self::Whole => 2,
            Self::Difference => 3,
            Self::Other(number) => number,
        }
    }
}

/// Width and height in pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    /// Columns.
    pub width: u16,
    /// Rows.
    pub height: u16,
}

/// A header: fields that the drone fills and clients use.
///
/// Source: Parrot's SDK 2.0, `video_encapsulation.h`, and captures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Header {
    /// How the payload is encoded.
    pub codec: Codec,
    /// Size of this header on the wire, at least [`HEADER_BYTES`].
    pub header_bytes: u16,
    /// Size of the payload behind it.
    pub payload_bytes: u32,
    /// Size of the encoded picture: multiples of 16.
    pub encoded: Size,
    /// Size of its part that is shown, from the upper left corner.
    pub shown: Size,
    /// Counts pictures.
    pub number: u32,
    /// The drone's clock, in milliseconds on the wire.
    pub time: Duration,
    /// What it depends on.
    pub kind: PictureKind,
    /// Bytes of the stream before this payload, without parameter sets.
    pub position: u64,
    /// Changes with the codec.
    pub stream: u16,
    /// Into how many slices the picture is cut, each with a header of its own.
    pub slices: u8,
    /// Which of them this is, from 0.
    pub slice: u8,
    /// Size of the sequence parameter set in the payload, with its start code.
    pub sps_bytes: u8,
    /// Size of the picture parameter set in the payload, with its start code.
    pub pps_bytes: u8,
}

impl Header {
    /// Decodes a header at the beginning of `bytes`; `None` if these are fewer than [`HEADER_BYTES`], do not begin with
    /// [`SIGNATURE`] and version 2, or claim sizes that cannot be true.
    pub fn decode(bytes: &[u8]) -> Option<Self> {
        let mut fields = bytes.strip_prefix(&SIGNATURE)?;
        if bytes.len() < HEADER_BYTES || fields.get_u8() != VERSION {
            return None;
        }
        let codec = Codec::from_wire(fields.get_u8());
        let header_bytes = fields.get_u16_le();
        let payload_bytes = fields.get_u32_le();
        let mut size = || Size { width: fields.get_u16_le(), height: fields.get_u16_le() };
        let (encoded, shown) = (size(), size());
        let number = fields.get_u32_le();
        let time = Duration::from_millis(fields.get_u32_le().into());
        // The chunks, of which there is one.
        fields.advance(2);
        let kind = PictureKind::from_wire(fields.get_u8());
        // Whether another client announced the stream.
        fields.advance(1);
        let position = fields.get_u64_le();
        let stream = fields.get_u16_le();
        let [slices, slice, sps_bytes, pps_bytes] = std::array::from_fn(|_| fields.get_u8());
        let header = Self {
            codec,
            header_bytes,
            payload_bytes,
            encoded,
            shown,
            number,
            time,
            kind,
            position,
            stream,
            slices,
            slice,
            sps_bytes,
            pps_bytes,
        };
        header.is_plausible().then_some(header)
    }

    /// Whether its sizes can be true.
    fn is_plausible(&self) -> bool {
        let is_shown =
            self.shown.width <= self.encoded.width && self.shown.height <= self.encoded.height;
        (HEADER_BYTES..=LONGEST_HEADER).contains(&self.header_bytes.into())
            && usize::try_from(self.payload_bytes).is_ok_and(|bytes| bytes <= LONGEST_PAYLOAD)
            && is_shown
            && self.slice < self.slices.max(1)
    }

    /// Appends it, with zeros for what is unknown. A `header_bytes` below [`HEADER_BYTES`] is raised to that.
    pub fn encode(&self, out: &mut impl BufMut) {
        let header_bytes = self.header_bytes.max(u16::try_from(HEADER_BYTES).unwrap_or(u16::MAX));
        let milliseconds = u32::try_from(self.time.as_millis()).unwrap_or(u32::MAX);
        out.put_slice(&SIGNATURE);
        out.put_u8(VERSION);
        out.put_u8(self.codec.to_wire());
        out.put_u16_le(header_bytes);
        out.put_u32_le(self.payload_bytes);
        for Size { width, height } in [self.encoded, self.shown] {
            out.put_u16_le(width);
            out.put_u16_le(height);
        }
        out.put_u32_le(self.number);
        out.put_u32_le(milliseconds);
        // One chunk, the first.
        out.put_slice(&[1, 0, self.kind.to_wire(), 0]);
        out.put_u64_le(self.position);
        out.put_u16_le(self.stream);
        out.put_slice(&[self.slices, self.slice, self.sps_bytes, self.pps_bytes]);
        out.put_u16_le(0);
        // What was announced is the size.
        out.put_u32_le(self.payload_bytes);
        out.put_bytes(0, usize::from(header_bytes) - 52);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const CAPTURED: &[u8] = include_bytes!("../../../tests/fixtures/video/pave68.bin");

    #[test]
    fn a_captured_header_has_the_values_that_other_readers_find() {
        let header = Header::decode(CAPTURED).unwrap();
        let expected = Header {
            codec: Codec::H264,
            header_bytes: 68,
            payload_bytes: 10_180,
            encoded: Size { width: 640, height: 368 },
            shown: Size { width: 640, height: 360 },
            number: 245_401,
            time: Duration::from_millis(8_015_353),
            kind: PictureKind::Key,
            position: 0x3c26_6fec,
            stream: 1,
            slices: 1,
            slice: 0,
            sps_bytes: 14,
            pps_bytes: 10,
        };
        assert_eq!(header, expected);
        let mut again = Vec::new();
        header.encode(&mut again);
        assert_eq!(again.len(), 68);
        // What follows is unknown, and not needed.
        assert_eq!(again[..48], CAPTURED[..48]);
    }

    #[test]
    fn what_cannot_be_true_is_no_header() {
        let header = Header::decode(CAPTURED).unwrap();
        let encoded = |change: fn(&mut Header)| {
            let mut header = header;
            change(&mut header);
            let mut bytes = Vec::new();
            header.encode(&mut bytes);
            Header::decode(&bytes)
        };
        assert!(encoded(|_| ()).is_some());
        assert_eq!(encoded(|header| header.payload_bytes = 1 << 21), None);
        assert_eq!(encoded(|header| header.header_bytes = 300), None);
        assert_eq!(encoded(|header| header.shown.width = 641), None);
        assert_eq!(encoded(|header| header.slice = 1), None);
        assert_eq!(Header::decode(&CAPTURED[..HEADER_BYTES - 1]), None);
        assert_eq!(Header::decode(b"PaVE"), None);
        let mut other = CAPTURED[..HEADER_BYTES].to_vec();
        other[4] = 3;
        assert_eq!(Header::decode(&other), None);
    }

    proptest! {
        #[test]
        fn an_encoded_header_is_decoded(
            (codec, kind, header_bytes) in (any::<u8>(), any::<u8>(), 64_u16..=256),
            (payload_bytes, number, position) in (0_u32..=1 << 20, any::<u32>(), any::<u64>()),
            (stream, milliseconds) in (any::<u16>(), any::<u32>()),
        ) {
            let size = Size { width: 640, height: 360 };
            let header = Header {
                codec: Codec::from_wire(codec),
                header_bytes,
                payload_bytes,
                encoded: size,
                shown: size,
                number,
                time: Duration::from_millis(milliseconds.into()),
                kind: PictureKind::from_wire(kind),
                position,
                stream,
                slices: 1,
                slice: 0,
                sps_bytes: 14,
                pps_bytes: 10,
            };
            let mut bytes = Vec::new();
            header.encode(&mut bytes);
            prop_assert_eq!(bytes.len(), usize::from(header_bytes));
            prop_assert_eq!(Header::decode(&bytes), Some(header));
        }
    }
}
