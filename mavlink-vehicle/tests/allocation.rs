//! Frames are read, signed, verified and written without allocating.

use std::time::Duration;

use allocation_counter::measure;
use mavlink_core::Message as _;
use mavlink_vehicle::dialect::MavMessage;
use mavlink_vehicle::{Encoder, Key, LONGEST_FRAME, Signing, frames};

#[test]
fn nothing_is_allocated_for_a_frame() {
    let mut ours = Signing::new(Key::new([7; 32]), 0, Duration::from_secs(2_000_000_000), 0);
    let mut theirs = Signing::new(Key::new([7; 32]), 0, Duration::from_secs(2_000_000_000), 0);
    let mut encoder = Encoder::new(1, 1);
    let mut datagram = [0; LONGEST_FRAME + 40];
    let (mut read, mut refused) = (0, 0);
    let used = measure(|| {
        for id in MavMessage::all_ids() {
            let Some(message) = MavMessage::default_message_from_id(*id) else { continue };
            for signing in [None, Some(&mut ours)] {
                let mut buffer = [0; LONGEST_FRAME];
                let frame = encoder.encode(&message, signing, Duration::ZERO, &mut buffer);
                // Behind it, something damaged.
                datagram[..frame.len()].copy_from_slice(frame);
                datagram[frame.len()..][..20].copy_from_slice(&[0xfe; 20]);
                for found in frames(&datagram[..frame.len() + 20]) {
                    let Ok(found) = found else {
                        refused += 1;
                        continue;
                    };
                    assert_eq!(found.message, message);
                    if let Some(signature) = found.signature {
                        assert_eq!(theirs.verify(&signature, Duration::ZERO), Ok(()));
                    }
                    read += 1;
                }
            }
        }
    });
    assert_eq!((read, refused), (2 * 71, 2 * 71));
    assert_eq!((used.count_total, used.bytes_total), (0, 0));
}
