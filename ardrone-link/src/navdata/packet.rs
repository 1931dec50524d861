//! Packets: header, options, checksum.

use bytes::{Buf as _, BufMut, BytesMut};

use super::options::{Demo, Gps, NavdataOption, RawMeasures, Time, VisionDetect};
use super::state::DroneState;
use super::wire::OPTION_HEADER_BYTES;

const MAGIC: u32 = 0x5566_7788;
/// Size of the firmware's own buffer; no packet is longer.
const MAX_PACKET_BYTES: usize = 4096;
const CHECKSUM_BYTES: usize = 8;
const TAG_CHECKSUM: u16 = 0xFFFF;

/// Why a packet was refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NavdataError {
    /// The packet ends too early.
    #[error("navdata ends within its {part}")]
    Truncated {
        /// The part that was being read.
        part: &'static str,
    },
    /// It does not start with the navdata magic number.
    #[error("not navdata: starts with {found:#010x}")]
    Magic {
        /// The first word.
        found: u32,
    },
    /// An option's size is smaller than its header, or exceeds the packet.
    #[error("navdata option {tag} with impossible size {size}")]
    OptionSize {
        /// The option's tag.
        tag: u16,
        /// The size it claims.
        size: u16,
    },
    /// The checksum is wrong.
    #[error("navdata checksum is {found:#010x}, the bytes sum to {computed:#010x}")]
    Checksum {
        /// Checksum in the packet.
        found: u32,
        /// Checksum of its bytes.
        computed: u32,
    },
    /// The packet is longer than any that the firmware sends.
    #[error("navdata packet of {bytes} bytes")]
    TooLong {
        /// Length of the datagram.
        bytes: usize,
    },
}

/// A validated packet: header, option sizes and checksum are correct. Nothing is copied or allocated; options
/// are decoded on demand.
///
/// ```
/// use ardrone_link::navdata::{Altitude, NavdataOption, Packet};
///
/// fn raw_altitude_m(datagram: &[u8]) -> Option<f64> {
///     Packet::decode(datagram).ok()?.options().find_map(|option| match option {
///         NavdataOption::Altitude(Altitude { raw_m, .. }) => Some(raw_m),
///         _ => None,
///     })
/// }
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Packet<'a> {
    /// The state bits.
    pub state: DroneState,
    /// Sequence number; restarts when the drone does.
    pub sequence: u32,
    /// The header's vision word.
    pub vision: u32,
    options: &'a [u8],
}

impl<'a> Packet<'a> {
    /// Validates a packet.
    ///
    /// # Errors
    /// [`NavdataError`] if the packet is damaged; none of it is used then. Unknown options, and known ones
    /// with an unknown size, are not damage.
    pub fn decode(packet: &'a [u8]) -> Result<Self, NavdataError> {
        if packet.len() > MAX_PACKET_BYTES {
            return Err(NavdataError::TooLong { bytes: packet.len() });
        }
        let truncated = |part| move |_| NavdataError::Truncated { part };
        let mut options = packet;
        let mut word = || options.try_get_u32_le().map_err(truncated("header"));
        let [magic, state, sequence, vision] = [word()?, word()?, word()?, word()?];
        if magic != MAGIC {
            return Err(NavdataError::Magic { found: magic });
        }
        let mut rest = options;
        loop {
            let mut header = rest;
            let mut half = || header.try_get_u16_le().map_err(truncated("option header"));
            let [tag, size] = [half()?, half()?];
            if usize::from(size) < OPTION_HEADER_BYTES || usize::from(size) > rest.len() {
                return Err(NavdataError::OptionSize { tag, size });
            }
            let (option, behind) = rest.split_at(usize::from(size));
            if tag != TAG_CHECKSUM {
                rest = behind;
                continue;
            }
            let mut sum = &option[OPTION_HEADER_BYTES..];
            let found = sum.try_get_u32_le().map_err(truncated("checksum"))?;
            let before = packet.len() - rest.len();
            let computed = checksum(&packet[..before]);
            if found != computed {
                return Err(NavdataError::Checksum { found, computed });
            }
            let options = &options[..options.len() - rest.len()];
            let state = DroneState::from_bits_retain(state);
            return Ok(Self { state, sequence, vision, options });
        }
    }

    /// The options in their order, without the checksum.
    pub fn options(&self) -> impl Iterator<Item = NavdataOption<'a>> + use<'a> {
        RawOptions { rest: self.options }.map(|(tag, payload)| NavdataOption::decode(tag, payload))
    }

    /// Payload of the first option with this tag.
    fn payload(&self, tag: u16) -> Option<&'a [u8]> {
        RawOptions { rest: self.options }.find(|(found, _)| *found == tag).map(|(_, bytes)| bytes)
    }

    /// Attitude, altitude, velocity and battery, if included.
    pub fn demo(&self) -> Option<Demo> {
        self.payload(0).and_then(Demo::read)
    }

    /// What the cameras have found, if it is in the packet.
    pub fn vision_detect(&self) -> Option<VisionDetect> {
        self.payload(16).and_then(VisionDetect::read)
    }

    /// The flight recorder's GPS, if included.
    pub fn gps(&self) -> Option<Gps> {
        self.payload(27).filter(|payload| payload.len() == Gps::EXACT_BYTES).and_then(Gps::read)
    }

    /// Voltage of the battery in millivolts, if the raw measures are included.
    pub fn battery_mv(&self) -> Option<u32> {
        let raw = self.payload(2).and_then(RawMeasures::read)?;
        // The option has whole millivolts of 32 bits, so that this is exact.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let millivolts = (raw.battery_v * 1e3).round() as u32;
        Some(millivolts)
    }

    /// The drone's clock, if included.
    pub fn time(&self) -> Option<Time> {
        self.payload(1).and_then(Time::read)
    }
}

/// Tags and payloads of options with validated sizes.
struct RawOptions<'a> {
    rest: &'a [u8],
}

impl<'a> Iterator for RawOptions<'a> {
    type Item = (u16, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        let (header, _) = self.rest.split_first_chunk::<OPTION_HEADER_BYTES>()?;
        let [tag_low, tag_high, size_low, size_high] = *header;
        let size = usize::from(u16::from_le_bytes([size_low, size_high]));
        let (option, rest) = self.rest.split_at_checked(size.max(OPTION_HEADER_BYTES))?;
        self.rest = rest;
        Some((u16::from_le_bytes([tag_low, tag_high]), &option[OPTION_HEADER_BYTES..]))
    }
}

/// Writes one packet to a buffer: header, then options, then the checksum.
///
/// ```
/// use ardrone_link::navdata::{Demo, DroneState, NavdataOption, Packet, PacketWriter};
///
/// let mut bytes = bytes::BytesMut::new();
/// let mut writer = PacketWriter::new(&mut bytes, DroneState::FLYING, 7, 0);
/// writer.option(&NavdataOption::Demo(Demo { battery_percent: 80, ..Demo::default() }))?;
/// writer.finish();
/// assert_eq!(Packet::decode(&bytes)?.demo().map(|demo| demo.battery_percent), Some(80));
/// # Ok::<(), ardrone_link::navdata::NavdataError>(())
/// ```
#[derive(Debug)]
#[must_use = "a packet is complete only behind `finish`"]
pub struct PacketWriter<'a> {
    out: &'a mut BytesMut,
    start: usize,
}

impl<'a> PacketWriter<'a> {
    /// Begins a packet at the end of `out`.
    pub fn new(out: &'a mut BytesMut, state: DroneState, sequence: u32, vision: u32) -> Self {
        let start = out.len();
        for word in [MAGIC, state.bits(), sequence, vision] {
            out.put_u32_le(word);
        }
        Self { out, start }
    }

    /// Appends an option.
    ///
    /// # Errors
    /// [`NavdataError::TooLong`] if the packet would become longer than any that the firmware sends; it is
    /// unchanged then.
    pub fn option(&mut self, option: &NavdataOption<'_>) -> Result<(), NavdataError> {
        let before = self.out.len();
        self.out.put_u16_le(option.tag());
        self.out.put_u16_le(0);
        option.write(self.out);
        let bytes = self.out.len() - self.start + CHECKSUM_BYTES;
        let size = u16::try_from(self.out.len() - before).ok();
        let Some(size) = size.filter(|_| bytes <= MAX_PACKET_BYTES) else {
            self.out.truncate(before);
            return Err(NavdataError::TooLong { bytes });
        };
        self.out[before + 2..before + OPTION_HEADER_BYTES].copy_from_slice(&size.to_le_bytes());
        Ok(())
    }

    /// Completes the packet with its checksum.
    pub fn finish(self) {
        let sum = checksum(&self.out[self.start..]);
        self.out.put_u16_le(TAG_CHECKSUM);
        self.out.put_u16_le(8);
        self.out.put_u32_le(sum);
    }
}

/// The plain sum of all bytes before the checksum option.
fn checksum(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0_u32, |sum, byte| sum.wrapping_add(u32::from(*byte)))
}

#[cfg(test)]
mod tests;
