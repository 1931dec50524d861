//! Signatures of MAVLink 2, as the MAVLink developer guide defines them ("Message signing").

use std::fmt;
use std::time::Duration;

use sha2::{Digest as _, Sha256};

/// Link, time and hash.
pub(crate) const SIGNATURE_BYTES: usize = LINK_BYTES + TIME_BYTES + HASH_BYTES;
const LINK_BYTES: usize = 1;
const TIME_BYTES: usize = 6;
const HASH_BYTES: usize = 6;
const KEY_BYTES: usize = 32;
/// Of one direction each: two ground stations on one link are two streams.
const MOST_STREAMS: usize = 16;
/// 2015-01-01, from which signatures count, since 1970-01-01: 16436 days.
const EPOCH: Duration = Duration::from_hours(16_436 * 24);
const TICKS_PER_SECOND: u64 = 100_000;
const LATEST: u64 = (1 << 48) - 1;
/// How far a new stream may be behind.
const MINUTE: u64 = 60 * TICKS_PER_SECOND;
/// How far any stream may be ahead. Our own times follow the latest that we have heard, so one station with a wrong
/// clock would otherwise lock out all others for good.
const DAY: u64 = 24 * 60 * MINUTE;

/// The secret that all parties of signed links share. Its `Debug` does not show it.
#[derive(Clone, PartialEq, Eq)]
pub struct Key([u8; KEY_BYTES]);

/// Why a text is not a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum KeyError {
    /// Not 64 digits, or one that is not hexadecimal.
    #[error("a key is written as 64 hexadecimal digits; for anything else give a pass-phrase")]
    Digits,
    /// Nothing at all, or only spaces.
    #[error("an empty pass-phrase protects nothing; give a long one")]
    Empty,
}

impl Key {
    /// A key of these bytes.
    pub fn new(bytes: [u8; KEY_BYTES]) -> Self {
        Self(bytes)
    }

    /// The key of a pass-phrase: its SHA-256, as in QGroundControl and MAVProxy.
    ///
    /// # Errors
    /// [`KeyError::Empty`] if it has nothing but spaces.
    pub fn from_pass_phrase(text: &str) -> Result<Self, KeyError> {
        if text.trim().is_empty() {
            return Err(KeyError::Empty);
        }
        Ok(Self(Sha256::digest(text).into()))
    }

    /// A key in hexadecimal digits.
    ///
    /// # Errors
    /// [`KeyError::Digits`] unless these are 64, of either case, and nothing else.
    pub fn from_hexadecimal(text: &str) -> Result<Self, KeyError> {
        let digit = |digit: u8| char::from(digit).to_digit(16).and_then(|d| u8::try_from(d).ok());
        let (pairs, rest) = text.as_bytes().as_chunks::<2>();
        if pairs.len() != KEY_BYTES || !rest.is_empty() {
            return Err(KeyError::Digits);
        }
        let mut key = [0; KEY_BYTES];
        for (byte, [high, low]) in key.iter_mut().zip(pairs) {
            let (high, low) = digit(*high).zip(digit(*low)).ok_or(KeyError::Digits)?;
            *byte = high << 4 | low;
        }
        Ok(Self(key))
    }

    /// The first bytes of the hash of this key and what is signed.
    fn hash(&self, signed: &[&[u8]]) -> [u8; HASH_BYTES] {
        let mut hasher = Sha256::new_with_prefix(self.0);
        for part in signed {
            hasher.update(part);
        }
        let [a, b, c, d, e, f, ..] = <[u8; 32]>::from(hasher.finalize());
        [a, b, c, d, e, f]
    }
}

impl fmt::Debug for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Key(secret)")
    }
}

/// A frame's signature, with all that it depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Signature<'a> {
    /// The sender's system.
    pub system: u8,
    /// The sender's component.
    pub component: u8,
    /// The link by which the sender says that it sent it.
    pub link: u8,
    /// When it was signed, in 10 µs since 2015-01-01; at most 48 bits.
    pub time: u64,
    hash: [u8; HASH_BYTES],
    signed: &'a [u8],
}

impl<'a> Signature<'a> {
    /// Reads the end of a signed frame.
    pub(crate) fn read(system: u8, component: u8, frame: &'a [u8]) -> Option<Self> {
        let (signed, hash) = frame.split_last_chunk()?;
        let (_, [link, a, b, c, d, e, f]) = signed.split_last_chunk()?;
        let time = u64::from_le_bytes([*a, *b, *c, *d, *e, *f, 0, 0]);
        Some(Self { system, component, link: *link, time, hash: *hash, signed })
    }

    fn stream(&self) -> Stream {
        let Self { system, component, link, time, .. } = *self;
        Stream { system, component, link, latest: time }
    }
}

/// Why a frame is not believed to come from who it says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// Another key, or a forgery.
    #[error("system {system}, component {component} signs with another key")]
    Forged {
        /// The system that it claims to come from.
        system: u8,
        /// And its component.
        component: u8,
    },
    /// Not later than the last frame of its stream: a repetition, or overtaken on the way.
    #[error("a signed frame of system {system}, component {component} came again or too late")]
    Repeated {
        /// Its system.
        system: u8,
        /// Its component.
        component: u8,
    },
    /// The first frame of its stream, and more than a minute behind our clock or the latest valid signature.
    #[error(
        "system {system}, component {component} signs with a time that is {behind_s} s old; set its clock"
    )]
    Old {
        /// Its system.
        system: u8,
        /// Its component.
        component: u8,
        /// How far it is behind, in seconds.
        behind_s: u64,
    },
    /// More than a day ahead of our clock.
    #[error(
        "system {system}, component {component} signs with a time that is {ahead_s} s ahead; set its clock or this one"
    )]
    Ahead {
        /// Its system.
        system: u8,
        /// Its component.
        component: u8,
        /// How much ahead of our clock, in seconds.
        ahead_s: u64,
    },
    /// A new stream, while 16 others have been heard of in the last minute.
    #[error("more than {MOST_STREAMS} senders of signed frames; disconnect one and wait a minute")]
    TooManyStreams,
}

#[derive(Debug, Clone, Copy)]
struct Stream {
    system: u8,
    component: u8,
    link: u8,
    /// The time of its latest frame.
    latest: u64,
}

impl Stream {
    fn is(&self, other: &Self) -> bool {
        let key = |s: &Self| (s.system, s.component, s.link);
        key(self) == key(other)
    }
}

/// Signs our frames and judges the signatures of others. A stream is what one component signs on one link.
#[derive(Debug)]
pub struct Signing {
    key: Key,
    link: u8,
    /// The time of the start.
    start: u64,
    /// The latest time that anyone signed with.
    latest: u64,
    streams: [Option<Stream>; MOST_STREAMS],
}

impl Signing {
    /// Signs with this key and this number of our link. `start_unix` is the time of the start since 1970-01-01, to which
    /// each `now` is added. `latest` is what [`Self::latest`] was when the key was last used, or 0: keep it, because
    /// whoever recorded the last minute of an earlier run could otherwise repeat that.
    pub fn new(key: Key, link: u8, start_unix: Duration, latest: u64) -> Self {
        let start = ticks(start_unix.saturating_sub(EPOCH));
        Self { key, link, start, latest: latest.min(LATEST), streams: [None; MOST_STREAMS] }
    }

    /// The latest time of a signature, ours or a valid one of others, in 10 µs since 2015-01-01.
    pub fn latest(&self) -> u64 {
        self.latest
    }

    /// What comes behind a frame's checksum. Each time is later than the last, until the year 2104.
    pub(crate) fn sign(&mut self, frame: &[u8], now: Duration) -> [u8; SIGNATURE_BYTES] {
        self.latest = self.clock(now).max(self.latest + 1).min(LATEST);
        let [a, b, c, d, e, f, ..] = self.latest.to_le_bytes();
        let behind = [self.link, a, b, c, d, e, f];
        let hash = self.key.hash(&[frame, &behind]);
        let mut signature = [0; SIGNATURE_BYTES];
        for (place, byte) in signature.iter_mut().zip(behind.iter().chain(&hash)) {
            *place = *byte;
        }
        signature
    }

    /// Whether a frame comes from someone who has the key, and for the first time. `now` is the time since the start.
    ///
    /// # Errors
    /// [`Refusal`]; then nothing has changed.
    pub fn verify(&mut self, signature: &Signature<'_>, now: Duration) -> Result<(), Refusal> {
        let Signature { system, component, time, .. } = *signature;
        if !are_equal(self.key.hash(&[signature.signed]), signature.hash) {
            return Err(Refusal::Forged { system, component });
        }
        let clock = self.clock(now);
        if time > clock.saturating_add(DAY) {
            let ahead_s = (time - clock) / TICKS_PER_SECOND;
            return Err(Refusal::Ahead { system, component, ahead_s });
        }
        let here = clock.max(self.latest);
        let stream = signature.stream();
        match self.streams.iter_mut().flatten().find(|known| known.is(&stream)) {
            Some(known) if time <= known.latest => {
                return Err(Refusal::Repeated { system, component });
            }
            Some(known) => known.latest = time,
            None if is_old(time, here) => {
                let behind_s = (here - time) / TICKS_PER_SECOND;
                return Err(Refusal::Old { system, component, behind_s });
            }
            None => *self.room(here).ok_or(Refusal::TooManyStreams)? = Some(stream),
        }
        self.latest = self.latest.max(time);
        Ok(())
    }

    /// A place for a new stream. All frames of a stream that was replaced are too old to begin a new one.
    fn room(&mut self, here: u64) -> Option<&mut Option<Stream>> {
        let has_room =
            |place: &&mut Option<Stream>| place.is_none_or(|stream| is_old(stream.latest, here));
        self.streams.iter_mut().find(has_room)
    }

    fn clock(&self, now: Duration) -> u64 {
        self.start.saturating_add(ticks(now)).min(LATEST)
    }
}

/// Takes as long whichever byte differs: the answer's delay must not tell how much of a guess was right.
fn are_equal(one: [u8; HASH_BYTES], other: [u8; HASH_BYTES]) -> bool {
    one.iter().zip(other).fold(0, |difference, (a, b)| difference | (a ^ b)) == 0
}

fn is_old(time: u64, here: u64) -> bool {
    time.saturating_add(MINUTE) < here
}

/// In 10 µs.
fn ticks(time: Duration) -> u64 {
    u64::try_from(time.as_micros() / 10).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests;
