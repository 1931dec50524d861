use mavlink_core::Message;
use proptest::prelude::*;

use super::*;
use crate::dialect::{COMMAND_ACK_DATA, HEARTBEAT_DATA, MavModeFlag, MavResult, STATUSTEXT_DATA};
use crate::signing::Key;

// Written by pymavlink 2.4.50, from system 255, component 190.
const HEARTBEAT: &str = "fd09000007ffbe0000000000000006080004037efa";
const TAKE_OFF: &str =
    "fd1f000007ffbe4c00000000000000000000000000000000c07f00000000000000000000c03f160001a98c";
const COMMAND_65000_V1: &str =
    "fe2107ffbe4c0000803f000000000000000000000000000000000000000000000000e8fd010100bd4a";
const GPS_STATUS: &str = "fd15000007ffbe1900000101010101010101010101010101010101010101014e28";
const RALLY_COUNT: &str = "fd05000007ffbe2c000005000101022077";
const RALLY_COUNT_V1: &str = "fe0507ffbe2c05000101026d2b";
const SIGNED_HEARTBEAT: &str =
    "fd09010000ffbe000000000000000608000403dab0030050dbbba621159874c0cb6e";
/// From system 1, component 1.
const ACK: &str = "fd0a00000001014d00001600000000000000ffbe2118";

pub(crate) fn bytes(hexadecimal: &str) -> Vec<u8> {
    let digits = |at: usize| u8::from_str_radix(&hexadecimal[at..at + 2], 16).unwrap();
    (0..hexadecimal.len()).step_by(2).map(digits).collect()
}

fn all(datagram: &[u8]) -> Vec<Result<Frame<'_>, FrameError>> {
    frames(datagram).collect()
}

fn numbers(found: &[Result<Frame<'_>, FrameError>]) -> Vec<u32> {
    found.iter().flatten().map(|frame| frame.message.message_id()).collect()
}

fn errors(found: &[Result<Frame<'_>, FrameError>]) -> Vec<FrameError> {
    found.iter().filter_map(|found| found.as_ref().err().copied()).collect()
}

fn ack() -> MavMessage {
    MavMessage::COMMAND_ACK(COMMAND_ACK_DATA {
        command: 22,
        result: MavResult::MAV_RESULT_ACCEPTED,
        target_system: 255,
        target_component: 190,
        ..COMMAND_ACK_DATA::default()
    })
}

fn encoded(encoder: &mut Encoder, message: &MavMessage) -> Vec<u8> {
    encoder.encode(message, None, Duration::ZERO, &mut [0; LONGEST_FRAME]).to_vec()
}

#[test]
fn several_frames_of_both_versions_are_in_one_datagram() {
    let datagram = [HEARTBEAT, COMMAND_65000_V1, TAKE_OFF].concat();
    let datagram = bytes(&datagram);
    let found = all(&datagram);
    assert_eq!(numbers(&found), [0, 76, 76]);
    let [Ok(first), Ok(second), Ok(third)] = &found[..] else { panic!("{found:?}") };
    assert_eq!(
        (first.version, first.system, first.component, first.sequence),
        (Version::V2, 255, 190, 7)
    );
    assert_eq!((second.version, &second.signature), (Version::V1, &None));
    // A command that nobody knows can be answered.
    let MavMessage::COMMAND_LONG(command) = &second.message else { panic!("{second:?}") };
    assert_eq!((command.command, command.param1.to_bits()), (65000, 1.0_f32.to_bits()));
    let MavMessage::COMMAND_LONG(command) = &third.message else { panic!("{third:?}") };
    assert!(command.command == 22 && command.param4.is_nan() && command.confirmation == 0);
}

#[test]
fn extension_fields_are_there_in_either_version() {
    for datagram in [RALLY_COUNT, RALLY_COUNT_V1] {
        let datagram = bytes(datagram);
        let found = all(&datagram);
        let Ok(Frame { message: MavMessage::MISSION_COUNT(count), .. }) = &found[0] else {
            panic!("{found:?}")
        };
        assert_eq!((count.count, count.mission_type, count.opaque_id), (5, 2, 0));
    }
}

#[test]
fn a_damaged_frame_hides_no_later_one() {
    let mut datagram = bytes(&[TAKE_OFF, HEARTBEAT].concat());
    for place in 0..43 {
        for bit in 0..8 {
            datagram[place] ^= 1 << bit;
            let found = all(&datagram);
            // A flag that only MAVLink 2's future knows changes what follows.
            assert!(numbers(&found).ends_with(&[0]), "{place}, {bit}: {found:?}");
            let compatible = place == 3 && found.len() == 2;
            assert!(compatible || found.len() - errors(&found).len() == 1, "{place}: {found:?}");
            datagram[place] ^= 1 << bit;
        }
    }
}

#[test]
fn what_is_wrong_is_told_once() {
    let heartbeat = bytes(HEARTBEAT);
    let mut damaged = bytes(TAKE_OFF);
    damaged[15..20].fill(0xfe);
    let datagram = [b"abc", &damaged[..], &heartbeat[..], &[0xfd, 1]].concat();
    let found = all(&datagram);
    assert_eq!(numbers(&found), [0]);
    assert_eq!(
        errors(&found),
        [
            FrameError::Garbage { bytes: 3 },
            FrameError::Checksum { id: 76 },
            FrameError::CutOff { announced: 12, there: 2 },
        ]
    );
    assert_eq!(errors(&all(b"xyz")), [FrameError::Garbage { bytes: 3 }]);
    assert_eq!(all(b""), []);
}

#[test]
fn unknown_messages_and_flags_are_refused_whole() {
    let datagram = bytes(&[GPS_STATUS, HEARTBEAT].concat());
    let found = all(&datagram);
    assert_eq!(
        (numbers(&found), errors(&found)),
        (vec![0], vec![FrameError::UnknownMessage { id: 25 }])
    );
    let mut datagram = bytes(&[HEARTBEAT, HEARTBEAT].concat());
    datagram[2] = 2;
    let found = all(&datagram);
    assert_eq!((numbers(&found), errors(&found)), (vec![0], vec![FrameError::Flags { flags: 2 }]));
}

#[test]
fn a_datagram_of_beginnings_is_given_up() {
    // Estimator status with the longest payload, again and again.
    let datagram = [0xfe, 230].repeat(30_000);
    let found = all(&datagram);
    let [.., last] = &errors(&found)[..] else { panic!("{found:?}") };
    assert!(matches!(last, FrameError::TooMany { bytes } if *bytes > 59_000), "{last:?}");
    assert!(found.len() <= usize::from(MOST_ERRORS) + 1);
}

#[test]
fn numbers_that_an_enum_lacks_are_refused_by_name() {
    let text = MavMessage::STATUSTEXT(STATUSTEXT_DATA::default());
    let mut datagram = encoded(&mut Encoder::new(1, 1), &text);
    assert_eq!(datagram[1], 1, "all of it is zero");
    datagram[10] = 99;
    let checksum = calculate_crc(&datagram[1..11], MavMessage::extra_crc(253)).to_le_bytes();
    datagram[11..13].copy_from_slice(&checksum);
    let wanted = FrameError::Enum { id: 253, kind: "MavSeverity", value: 99 };
    assert_eq!(errors(&all(&datagram)), [wanted]);
}

#[test]
fn frames_are_those_that_pymavlink_writes() {
    assert_eq!(encoded(&mut Encoder::new(1, 1), &ack()), bytes(ACK));
    let heartbeat =
        HEARTBEAT_DATA { mavtype: 6, autopilot: 8, system_status: 4, ..HEARTBEAT_DATA::default() };
    assert_eq!(heartbeat.base_mode, MavModeFlag::empty(), "not armed unless it is said");
    let mut encoder = Encoder { next: 7, ..Encoder::new(255, 190) };
    assert_eq!(encoded(&mut encoder, &MavMessage::HEARTBEAT(heartbeat)), bytes(HEARTBEAT));
}

#[test]
fn sequence_numbers_go_round() {
    let mut encoder = Encoder::new(1, 1);
    for expected in 0..600_u32 {
        let frame = encoded(&mut encoder, &ack());
        assert_eq!(u32::from(frame[4]), expected % 256);
    }
}

#[test]
fn a_signature_is_read_but_not_believed() {
    let datagram = bytes(&[SIGNED_HEARTBEAT, HEARTBEAT].concat());
    let found = all(&datagram);
    let Ok(Frame { signature: Some(signature), .. }) = &found[0] else { panic!("{found:?}") };
    assert_eq!((signature.link, signature.time), (3, 37_000_000_000_000));
    assert!(matches!(&found[1], Ok(Frame { signature: None, .. })));
}

#[test]
fn the_longest_frame_fits() {
    for id in MavMessage::all_ids() {
        let message = MavMessage::default_message_from_id(*id).unwrap();
        let mut payload = [0xff; LONGEST_PAYLOAD];
        let length = message.ser(MavlinkVersion::V1, &mut payload);
        assert!(length <= LONGEST_PAYLOAD);
    }
}

/// A frame of MAVLink 2 with this payload and a valid checksum.
fn frame_of(id: u32, payload: &[u8]) -> Vec<u8> {
    let [a, b, c, _] = id.to_le_bytes();
    let length = u8::try_from(payload.len()).unwrap();
    let mut frame = vec![MAV_STX_V2, length, 0, 0, 1, 2, 3, a, b, c];
    frame.extend_from_slice(payload);
    let checksum = calculate_crc(&frame[1..], MavMessage::extra_crc(id));
    frame.extend_from_slice(&checksum.to_le_bytes());
    frame
}

proptest! {
    /// What was decoded is the same after encoding and decoding, compared as bytes because of NaN.
    #[test]
    fn encoding_undoes_decoding(
        id in prop::sample::select(MavMessage::all_ids()),
        payload in prop::collection::vec(any::<u8>(), 0..=LONGEST_PAYLOAD),
        sign in any::<bool>(),
    ) {
        let datagram = frame_of(id, &payload);
        let found = all(&datagram);
        prop_assert_eq!(found.len(), 1);
        let frame = match &found[0] {
            Ok(frame) => frame,
            Err(error) => {
                let is_enum = matches!(error, FrameError::Enum { .. });
                prop_assert!(is_enum, "{}", error);
                return Ok(());
            }
        };
        prop_assert_eq!(frame.message.message_id(), id);
        let mut signing = Signing::new(Key::new([1; 32]), 0, Duration::ZERO, 0);
        let signing = sign.then_some(&mut signing);
        let mut buffer = [0; LONGEST_FRAME];
        let sent = Encoder::new(9, 8).encode(&frame.message, signing, Duration::ZERO, &mut buffer);
        let again = all(sent);
        let [Ok(again)] = &again[..] else { panic!("{again:?}") };
        prop_assert_eq!((again.system, again.component, again.signature.is_some()), (9, 8, sign));
        let written = |message: &MavMessage| encoded(&mut Encoder::new(1, 1), message);
        let (one, other) = (written(&frame.message), written(&again.message));
        // What is sent is what was received, as far as the message reaches.
        let length = payload.len().min(usize::from(one[1]));
        prop_assert_eq!(&one[10..10 + length], &payload[..length]);
        prop_assert_eq!(one, other);
    }

    #[test]
    fn any_bytes_are_decoded_or_refused(
        datagram in prop::collection::vec(prop_oneof![Just(0xfd), Just(0xfe), any::<u8>()], 0..400),
    ) {
        let found = all(&datagram);
        prop_assert!(found.len() <= datagram.len());
        prop_assert!(errors(&found).len() <= usize::from(MOST_ERRORS) + datagram.len() / 2);
    }

    /// Behind any garbage that does not begin like a frame.
    #[test]
    fn frames_are_found_behind_garbage(garbage in prop::collection::vec(0_u8..0xfd, 0..400)) {
        let datagram = [&garbage[..], &bytes(HEARTBEAT), &garbage, &bytes(TAKE_OFF)].concat();
        prop_assert_eq!(numbers(&all(&datagram)), [0, 76]);
    }
}
