use proptest::prelude::*;

use super::*;
use crate::dialect::{HEARTBEAT_DATA, MavMessage};
use crate::frame::{Encoder, Frame, LONGEST_FRAME, frames};

/// Its key is that of the pass-phrase; written by pymavlink 2.4.50.
const PASS_PHRASE: &str = "correct horse";
const KEY: &str = "4104d36f8da2c254349f85836793ebe029e0c957063a34c91c2e9203187b5631";
const THEIRS: [u8; 34] = [
    0xfd, 0x09, 0x01, 0x00, 0x00, 0xff, 0xbe, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x06, 0x08,
    0x00, 0x04, 0x03, 0xda, 0xb0, 0x03, 0x00, 0x50, 0xdb, 0xbb, 0xa6, 0x21, 0x15, 0x98, 0x74, 0xc0,
    0xcb, 0x6e,
];
const TIME: u64 = 37_000_000_000_000;

fn key() -> Key {
    Key::from_pass_phrase(PASS_PHRASE).unwrap()
}

/// The time since 1970-01-01 of a time of signatures.
fn unix(time: u64) -> Duration {
    EPOCH + Duration::from_micros(time * 10)
}

fn at(time: u64) -> Signing {
    Signing::new(key(), 0, unix(time), 0)
}

fn heartbeat() -> MavMessage {
    MavMessage::HEARTBEAT(HEARTBEAT_DATA::default())
}

/// A frame that another component signs at this time.
fn signed(component: u8, link: u8, time: u64) -> Vec<u8> {
    let mut signing = Signing::new(key(), link, unix(time), 0);
    let mut buffer = [0; LONGEST_FRAME];
    let mut encoder = Encoder::new(255, component);
    encoder.encode(&heartbeat(), Some(&mut signing), Duration::ZERO, &mut buffer).to_vec()
}

fn judged(signing: &mut Signing, frame: &[u8]) -> Result<(), Refusal> {
    let found: Vec<_> = frames(frame).collect();
    let [Ok(Frame { signature: Some(signature), .. })] = &found[..] else { panic!("{found:?}") };
    signing.verify(signature, Duration::ZERO)
}

#[test]
fn keys_are_read_and_never_shown() {
    assert_eq!(Key::from_hexadecimal(KEY), Ok(key()));
    assert_eq!(Key::from_hexadecimal(&KEY.to_uppercase()), Ok(key()));
    for wrong in ["", &KEY[1..], &format!("{KEY}0"), &KEY.replace('4', "g"), &"é".repeat(32)] {
        assert_eq!(Key::from_hexadecimal(wrong), Err(KeyError::Digits), "{wrong}");
    }
    assert_eq!(Key::from_pass_phrase(" \t"), Err(KeyError::Empty));
    let shown = format!("{:?} {:?}", key(), at(TIME));
    assert!(!shown.contains("4104") && !shown.contains("65, 4") && shown.contains("secret"));
}

#[test]
fn signatures_are_those_of_pymavlink() {
    assert_eq!(judged(&mut at(TIME), &THEIRS), Ok(()));
    let other = Key::from_pass_phrase("incorrect horse").unwrap();
    let mut signing = Signing::new(other, 0, unix(TIME), 0);
    assert_eq!(judged(&mut signing, &THEIRS), Err(Refusal::Forged { system: 255, component: 190 }));
    assert_eq!(signing.latest(), 0);
    // Ours, at the same time and by the same sender, has the same bytes.
    let mut frame = [0; LONGEST_FRAME];
    let message = MavMessage::HEARTBEAT(HEARTBEAT_DATA {
        mavtype: 6,
        autopilot: 8,
        system_status: 4,
        ..HEARTBEAT_DATA::default()
    });
    let mut signing = Signing::new(key(), 3, unix(TIME), 0);
    let mut encoder = Encoder::new(255, 190);
    assert_eq!(encoder.encode(&message, Some(&mut signing), Duration::ZERO, &mut frame), THEIRS);
}

#[test]
fn nothing_is_believed_twice_or_in_the_wrong_order() {
    let mut signing = at(TIME);
    let repeated = Err(Refusal::Repeated { system: 255, component: 190 });
    assert_eq!(judged(&mut signing, &signed(190, 0, TIME + 5)), Ok(()));
    assert_eq!(judged(&mut signing, &signed(190, 0, TIME + 5)), repeated);
    assert_eq!(judged(&mut signing, &signed(190, 0, TIME + 4)), repeated);
    assert_eq!(judged(&mut signing, &signed(190, 0, TIME + 6)), Ok(()));
    // Other streams have their own times.
    assert_eq!(judged(&mut signing, &signed(191, 0, TIME)), Ok(()));
    assert_eq!(judged(&mut signing, &signed(190, 1, TIME)), Ok(()));
}

#[test]
fn a_new_stream_is_neither_old_nor_ahead() {
    let mut signing = at(TIME);
    let (system, component) = (255, 190);
    assert_eq!(
        judged(&mut signing, &signed(190, 0, TIME - MINUTE - TICKS_PER_SECOND)),
        Err(Refusal::Old { system, component, behind_s: 61 })
    );
    assert_eq!(
        judged(&mut signing, &signed(190, 0, TIME + DAY + TICKS_PER_SECOND)),
        Err(Refusal::Ahead { system, component, ahead_s: 86_401 })
    );
    assert_eq!(judged(&mut signing, &signed(190, 0, TIME - MINUTE)), Ok(()));
    // A known stream may be slow.
    let mut signing = at(TIME);
    assert_eq!(judged(&mut signing, &signed(190, 0, TIME)), Ok(()));
    signing.start += 10 * MINUTE;
    assert_eq!(judged(&mut signing, &signed(190, 0, TIME + 1)), Ok(()));
    assert_eq!(
        judged(&mut signing, &signed(191, 0, TIME + 1)),
        Err(Refusal::Old { system, component: 191, behind_s: 599 })
    );
}

#[test]
fn an_earlier_run_cannot_be_repeated() {
    let recorded = signed(190, 0, TIME);
    let mut signing = at(TIME);
    assert_eq!(judged(&mut signing, &recorded), Ok(()));
    // With a clock that was set back meanwhile.
    let mut signing = Signing::new(key(), 0, unix(TIME - 9 * MINUTE), TIME + 2 * MINUTE);
    assert!(matches!(judged(&mut signing, &recorded), Err(Refusal::Old { .. })));
}

#[test]
fn streams_are_bounded_and_silent_ones_make_room() {
    let mut signing = at(TIME);
    for component in 0..16 {
        assert_eq!(judged(&mut signing, &signed(component, 0, TIME)), Ok(()));
    }
    assert_eq!(judged(&mut signing, &signed(16, 0, TIME)), Err(Refusal::TooManyStreams));
    assert_eq!(judged(&mut signing, &signed(15, 0, TIME + 1)), Ok(()));
    signing.start += MINUTE + 1;
    assert_eq!(judged(&mut signing, &signed(16, 0, TIME + MINUTE)), Ok(()));
    // What was replaced is too old to come again.
    assert!(matches!(judged(&mut signing, &signed(0, 0, TIME)), Err(Refusal::Old { .. })));
}

#[test]
fn our_times_always_increase() {
    let mut signing = at(TIME);
    let mut last = 0;
    for now_ms in [0, 0, 0, 5, 3, 5, 1000] {
        signing.sign(b"frame", Duration::from_millis(now_ms));
        assert!(signing.latest() > last);
        last = signing.latest();
    }
    assert_eq!(last, TIME + TICKS_PER_SECOND);
    // Others are believed to know the time.
    assert_eq!(judged(&mut signing, &signed(190, 0, TIME + MINUTE)), Ok(()));
    signing.sign(b"frame", Duration::ZERO);
    assert_eq!(signing.latest(), TIME + MINUTE + 1);
}

#[test]
fn impossible_clocks_are_limited() {
    for start in [Duration::ZERO, Duration::MAX] {
        let mut signing = Signing::new(key(), 0, start, u64::MAX);
        signing.sign(b"frame", Duration::MAX);
        assert_eq!(signing.latest(), LATEST);
    }
}

proptest! {
    #[test]
    fn a_change_of_any_bit_is_noticed(place in 0..THEIRS.len(), bit in 0..8) {
        let mut frame = THEIRS;
        frame[place] ^= 1_u8 << bit;
        let mut signing = at(TIME);
        for found in frames(&frame).flatten() {
            let believed = found.signature.is_some_and(|s| signing.verify(&s, Duration::ZERO).is_ok());
            prop_assert!(!believed);
        }
    }
}
