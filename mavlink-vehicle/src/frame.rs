//! Frames: those of a datagram, and ours. The layout is that of the MAVLink developer guide, "Packet serialization".

use std::time::Duration;

use mavlink_core::error::ParserError;
use mavlink_core::{MAV_STX, MAV_STX_V2, MavlinkVersion, Message as _, calculate_crc};

use super::dialect::MavMessage;
use super::signing::{SIGNATURE_BYTES, Signature, Signing};

const CHECKSUM_BYTES: usize = 2;
const HEADER_BYTES_V1: usize = 6;
const HEADER_BYTES_V2: usize = 10;
const LONGEST_PAYLOAD: usize = 255;
/// The longest frame, in bytes: MAVLink 2, signed.
pub const LONGEST_FRAME: usize =
    HEADER_BYTES_V2 + LONGEST_PAYLOAD + CHECKSUM_BYTES + SIGNATURE_BYTES;
/// The incompatibility flag that announces a signature.
const SIGNED: u8 = 1;
/// In one datagram. Each attempt costs a checksum, and a datagram can be made of nothing but beginnings of frames.
const MOST_ERRORS: u8 = 32;

/// Where a frame is written to.
pub type Buffer = [u8; LONGEST_FRAME];

/// A version of MAVLink.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Version {
    /// MAVLink 1: neither extension fields nor signatures, and message numbers below 256.
    V1,
    /// MAVLink 2.
    V2,
}

/// A frame with a valid checksum. A signature has yet to be verified, by [`Signing::verify`].
#[derive(Debug, Clone, PartialEq)]
pub struct Frame<'a> {
    /// How it was written. MAVLink 1 has no extension fields: they are 0 then.
    pub version: Version,
    /// The sender's system.
    pub system: u8,
    /// The sender's component.
    pub component: u8,
    /// The sender counts its frames with this.
    pub sequence: u8,
    /// What it says.
    pub message: MavMessage,
    /// Its signature, if it has one.
    pub signature: Option<Signature<'a>>,
}

/// Why bytes of a datagram are not a frame. The search goes on behind them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FrameError {
    /// Bytes in which no frame begins.
    #[error("{bytes} bytes that belong to no MAVLink frame")]
    Garbage {
        /// How many.
        bytes: usize,
    },
    /// The frame is longer than what is left of the datagram. One frame never takes two datagrams.
    #[error("a MAVLink frame of {announced} bytes of which only {there} are there")]
    CutOff {
        /// Its length in bytes; that of the shortest frame if not even its header is there.
        announced: usize,
        /// Bytes that are left.
        there: usize,
    },
    /// Flags without which the frame cannot be understood, and that are not known.
    #[error(
        "a MAVLink frame with unknown incompatibility flags {flags:#04x}; only 0x01 is supported"
    )]
    Flags {
        /// All of its flags.
        flags: u8,
    },
    /// A message that the dialect does not have. Its checksum cannot be checked.
    #[error("unknown MAVLink message {id}")]
    UnknownMessage {
        /// Its number.
        id: u32,
    },
    /// Damaged, or of a dialect with another definition of this message.
    #[error("wrong checksum of MAVLink message {id}")]
    Checksum {
        /// Its number.
        id: u32,
    },
    /// A number that one of its enums does not have, in a message that only vehicles send.
    #[error("{value} is not in {kind}, in MAVLink message {id}")]
    Enum {
        /// The message's number.
        id: u32,
        /// The enum.
        kind: &'static str,
        /// The number.
        value: u64,
    },
    /// The payload does not have the fields of its message.
    #[error("impossible payload of MAVLink message {id}")]
    Payload {
        /// The message's number.
        id: u32,
    },
    /// What looked like frames was none, too often.
    #[error("too many errors in one datagram; its last {bytes} bytes are dropped")]
    TooMany {
        /// How many.
        bytes: usize,
    },
}

/// The frames of a datagram, in order. A damaged frame hides no later one, but behind 32 errors the rest is dropped.
///
/// A payload that is shorter than its message is filled up with zeros; one that is longer has extension fields that the
/// dialect does not know, and these are ignored.
pub fn frames(datagram: &[u8]) -> impl Iterator<Item = Result<Frame<'_>, FrameError>> {
    Frames { rest: datagram, attempts: MOST_ERRORS, resynchronising: false }
}

#[derive(Debug)]
struct Frames<'a> {
    rest: &'a [u8],
    /// How many more errors there may be.
    attempts: u8,
    /// Whether what comes next may belong to a frame that has already been refused.
    resynchronising: bool,
}

impl<'a> Iterator for Frames<'a> {
    type Item = Result<Frame<'a>, FrameError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let begin = self.rest.iter().position(|byte| is_begin(*byte));
            let bytes = begin.unwrap_or(self.rest.len());
            self.skip(bytes);
            if bytes > 0 && !self.resynchronising {
                return Some(Err(FrameError::Garbage { bytes }));
            }
            if self.rest.is_empty() {
                return None;
            }
            if self.attempts == 0 {
                let bytes = std::mem::take(&mut self.rest).len();
                return Some(Err(FrameError::TooMany { bytes }));
            }
            let (found, bytes) = attempt(self.rest);
            self.skip(bytes);
            if found.is_err() {
                self.attempts -= 1;
            }
            // One damaged frame is one error, whatever its bytes look like.
            let damaged = found.is_err() && bytes == 1;
            let reported = std::mem::replace(&mut self.resynchronising, damaged);
            if !(damaged && reported) {
                return Some(found);
            }
        }
    }
}

impl Frames<'_> {
    fn skip(&mut self, bytes: usize) {
        self.rest = self.rest.get(bytes..).unwrap_or_default();
    }
}

/// Reads what begins like a frame. Returns also how many bytes to skip: only one if its length is not to be believed.
fn attempt(rest: &[u8]) -> (Result<Frame<'_>, FrameError>, usize) {
    let raw = match Raw::read(rest) {
        Ok(raw) => raw,
        Err(error) => return (Err(error), 1),
    };
    let whole = raw.bytes.len();
    let frame = raw.frame();
    let bytes = match frame {
        Err(FrameError::Checksum { .. }) => 1,
        // It has no checksum that can be checked. It is a frame if another follows, or nothing at all.
        Err(FrameError::UnknownMessage { .. } | FrameError::Flags { .. })
            if rest.get(whole).is_some_and(|byte| !is_begin(*byte)) =>
        {
            1
        }
        _ => whole,
    };
    (frame, bytes)
}

fn is_begin(byte: u8) -> bool {
    byte == MAV_STX || byte == MAV_STX_V2
}

/// The parts of what looks like a frame.
#[derive(Debug)]
struct Raw<'a> {
    version: Version,
    flags: u8,
    sequence: u8,
    system: u8,
    component: u8,
    id: u32,
    payload: &'a [u8],
    checksum: u16,
    /// Header and payload, without the first byte: what has the checksum.
    checked: &'a [u8],
    /// All of it.
    bytes: &'a [u8],
}

impl<'a> Raw<'a> {
    /// Reads what begins with the first byte of a frame.
    fn read(rest: &'a [u8]) -> Result<Self, FrameError> {
        let cut_off = |announced| FrameError::CutOff { announced, there: rest.len() };
        let (version, flags, header_bytes, length, sequence, system, component, id) = match *rest {
            [MAV_STX, length, sequence, system, component, id, ..] => {
                (Version::V1, 0, HEADER_BYTES_V1, length, sequence, system, component, id.into())
            }
            [MAV_STX_V2, length, flags, _, sequence, system, component, a, b, c, ..] => {
                let id = u32::from_le_bytes([a, b, c, 0]);
                (Version::V2, flags, HEADER_BYTES_V2, length, sequence, system, component, id)
            }
            [MAV_STX, ..] => return Err(cut_off(HEADER_BYTES_V1 + CHECKSUM_BYTES)),
            _ => return Err(cut_off(HEADER_BYTES_V2 + CHECKSUM_BYTES)),
        };
        let end = header_bytes + usize::from(length);
        let signature_bytes = if flags & SIGNED == 0 { 0 } else { SIGNATURE_BYTES };
        let announced = end + CHECKSUM_BYTES + signature_bytes;
        let parts = || {
            let checked = rest.get(1..end)?;
            let checksum = rest.get(end..)?.first_chunk().copied()?;
            Some((rest.get(header_bytes..end)?, checked, checksum, rest.get(..announced)?))
        };
        let (payload, checked, checksum, bytes) = parts().ok_or(cut_off(announced))?;
        let checksum = u16::from_le_bytes(checksum);
        Ok(Self {
            version,
            flags,
            sequence,
            system,
            component,
            id,
            payload,
            checksum,
            checked,
            bytes,
        })
    }

    fn frame(&self) -> Result<Frame<'a>, FrameError> {
        let id = self.id;
        if self.flags & !SIGNED != 0 {
            return Err(FrameError::Flags { flags: self.flags });
        }
        // The dialect answers 0 for what it does not know, and there is a message whose byte is 0.
        if MavMessage::all_ids().binary_search(&id).is_err() {
            return Err(FrameError::UnknownMessage { id });
        }
        if calculate_crc(self.checked, MavMessage::extra_crc(id)) != self.checksum {
            return Err(FrameError::Checksum { id });
        }
        let version = match self.version {
            Version::V1 => MavlinkVersion::V1,
            Version::V2 => MavlinkVersion::V2,
        };
        let message =
            MavMessage::parse(version, id, self.payload).map_err(|error| match error {
                ParserError::InvalidEnum { enum_type: kind, value } => {
                    FrameError::Enum { id, kind, value }
                }
                ParserError::UnknownMessage { .. } => FrameError::UnknownMessage { id },
                ParserError::InvalidPayloadSize { .. } | ParserError::BytesError(_) => {
                    FrameError::Payload { id }
                }
            })?;
        let Self { system, component, .. } = *self;
        let signed = self.flags & SIGNED != 0;
        let signature = if signed { Signature::read(system, component, self.bytes) } else { None };
        Ok(Frame {
            version: self.version,
            system,
            component,
            sequence: self.sequence,
            message,
            signature,
        })
    }
}

/// Writes the frames that one component sends, in MAVLink 2.
#[derive(Debug, Clone)]
pub struct Encoder {
    system: u8,
    component: u8,
    next: u8,
}

impl Encoder {
    /// An encoder for the frames of this system and component.
    pub fn new(system: u8, component: u8) -> Self {
        Self { system, component, next: 0 }
    }

    /// Writes the next frame, signed or not, and returns its bytes. `now` is the time since the start; only the
    /// signature needs it. Zeros at the end of the payload are not sent.
    pub fn encode<'b>(
        &mut self,
        message: &MavMessage,
        signing: Option<&mut Signing>,
        now: Duration,
        buffer: &'b mut Buffer,
    ) -> &'b [u8] {
        let flags = if signing.is_some() { SIGNED } else { 0 };
        let id = message.message_id();
        let [a, b, c, _] = id.to_le_bytes();
        let sequence = self.next;
        self.next = self.next.wrapping_add(1);
        let mut payload = [0; LONGEST_PAYLOAD];
        let length = message.ser(MavlinkVersion::V2, &mut payload).min(LONGEST_PAYLOAD);
        let byte = u8::try_from(length).unwrap_or(u8::MAX);
        let header = [MAV_STX_V2, byte, flags, 0, sequence, self.system, self.component, a, b, c];
        let mut frame = Writer { buffer, length: 0 };
        frame.put(&header);
        frame.put(payload.get(..length).unwrap_or_default());
        let checked = frame.written().get(1..).unwrap_or_default();
        let checksum = calculate_crc(checked, MavMessage::extra_crc(id));
        frame.put(&checksum.to_le_bytes());
        if let Some(signing) = signing {
            let signature = signing.sign(frame.written(), now);
            frame.put(&signature);
        }
        let Writer { buffer, length } = frame;
        buffer.get(..length).unwrap_or_default()
    }
}

struct Writer<'b> {
    buffer: &'b mut Buffer,
    length: usize,
}

impl Writer<'_> {
    /// The buffer has room for the longest frame.
    fn put(&mut self, bytes: &[u8]) {
        let end = self.length + bytes.len();
        if let Some(place) = self.buffer.get_mut(self.length..end) {
            place.copy_from_slice(bytes);
            self.length = end;
        }
    }

    fn written(&self) -> &[u8] {
        self.buffer.get(..self.length).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests;
