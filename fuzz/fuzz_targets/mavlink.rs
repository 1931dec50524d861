//! Any bytes as a datagram of MAVLink: refused, or every message survives encoding and decoding; without a panic.
#![no_main]

use std::time::Duration;

use libfuzzer_sys::fuzz_target;
use mavlink_core::{Message as _, calculate_crc};
use mavlink_vehicle::dialect::MavMessage;
use mavlink_vehicle::{Encoder, Frame, Key, LONGEST_FRAME, Signing, frames};

/// Corrects the checksums, because a fuzzer would not find a valid one: what stands in their place is not of interest.
fn with_checksums(datagram: &[u8]) -> Vec<u8> {
    let mut datagram = datagram.to_vec();
    let mut at = 0;
    while let Some(&[begin, length, flags, _, _, id, _, a, b, c, ..]) = datagram.get(at..) {
        let (header, id, signature) = match begin {
            0xfd => (10, u32::from_le_bytes([a, b, c, 0]), 13 * usize::from(flags & 1)),
            0xfe => (6, id.into(), 0),
            _ => {
                at += 1;
                continue;
            }
        };
        let end = at + header + usize::from(length);
        let Some(checked) = datagram.get(at + 1..end) else { break };
        let checksum = calculate_crc(checked, MavMessage::extra_crc(id)).to_le_bytes();
        let Some(place) = datagram.get_mut(end..end + 2) else { break };
        place.copy_from_slice(&checksum);
        at = end + 2 + signature;
    }
    datagram
}

fn signing() -> Signing {
    Signing::new(Key::new([7; 32]), 0, Duration::from_secs(2_000_000_000), 0)
}

fuzz_target!(|bytes: &[u8]| {
    for found in frames(bytes) {
        drop(found);
    }
    let (mut ours, mut theirs) = (signing(), signing());
    let mut encoder = Encoder::new(1, 1);
    let mut buffer = [0; LONGEST_FRAME];
    for frame in frames(&with_checksums(bytes)).flatten() {
        if let Some(signature) = frame.signature {
            let _ = theirs.verify(&signature, Duration::ZERO);
        }
        let sent = encoder.encode(&frame.message, Some(&mut ours), Duration::ZERO, &mut buffer);
        let again: Vec<Frame<'_>> =
            frames(sent).collect::<Result<_, _>>().expect("it was just written");
        assert_eq!(again.len(), 1);
        let signature = again[0].signature.expect("it was signed");
        theirs.verify(&signature, Duration::ZERO).expect("with the same key");
        // NaN is not equal to itself: the bytes are.
        let plain = |message| {
            let mut buffer = [0; LONGEST_FRAME];
            Encoder::new(1, 1).encode(message, None, Duration::ZERO, &mut buffer).to_vec()
        };
        assert_eq!(plain(&frame.message), plain(&again[0].message));
    }
});
