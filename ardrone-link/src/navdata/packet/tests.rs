//! Packets: round trips of every option, and damage of every kind.

use std::time::Duration;

use proptest::prelude::*;

use super::*;
use crate::navdata::{ControlState, Navdata, VisionDetect};

/// Tag and size of every option, newer forms included.
const SIZES: [(u16, usize); 32] = [
    (0, 148),
    (1, 8),
    (2, 52),
    (3, 46),
    (4, 16),
    (5, 12),
    (6, 88),
    (7, 16),
    (8, 24),
    (9, 76),
    (9, 92),
    (10, 56),
    (11, 16),
    (12, 44),
    (13, 92),
    (14, 108),
    (15, 364),
    (16, 328),
    (17, 8),
    (18, 40),
    (19, 65),
    (20, 12),
    (21, 18),
    (22, 75),
    (22, 83),
    (23, 56),
    (23, 64),
    (24, 72),
    (25, 32),
    (26, 8),
    (27, 12),
    (27, 216),
];

fn packet(options: &[(u16, &[u8])]) -> BytesMut {
    let mut bytes = BytesMut::new();
    let mut writer = PacketWriter::new(&mut bytes, DroneState::FLYING, 9, 1);
    for (tag, payload) in options {
        writer.option(&NavdataOption::Unknown { tag: *tag, payload }).unwrap();
    }
    writer.finish();
    bytes
}

fn demo_set() -> BytesMut {
    let demo = Demo {
        control_state: ControlState::Hovering,
        battery_percent: 81,
        pitch_deg: -6.5,
        yaw_deg: 179.999,
        altitude_m: 0.534,
        velocity_forward_m_s: 0.046,
        ..Demo::default()
    };
    let mut bytes = BytesMut::new();
    let mut writer = PacketWriter::new(&mut bytes, DroneState::FLYING, 7, 1);
    writer.option(&NavdataOption::Demo(demo)).unwrap();
    writer.option(&NavdataOption::VisionDetect(VisionDetect::default())).unwrap();
    writer.finish();
    bytes
}

#[test]
fn the_voltage_is_in_whole_millivolts() {
    let mut bytes = BytesMut::new();
    let mut writer = PacketWriter::new(&mut bytes, DroneState::FLYING, 7, 1);
    let raw = RawMeasures { battery_v: 11.686, ..RawMeasures::default() };
    writer.option(&NavdataOption::RawMeasures(raw)).unwrap();
    writer.finish();
    assert_eq!(Navdata::decode(&bytes).unwrap().battery_mv, Some(11_686));
    assert_eq!(Navdata::decode(&demo_set()).unwrap().battery_mv, None);
}

#[test]
fn the_demo_set_has_the_size_that_clients_know() {
    assert_eq!(demo_set().len(), 500);
    assert_eq!(packet(&[]).len(), 24);
}

#[test]
fn every_truncation_and_every_flipped_bit_is_refused() {
    let bytes = demo_set();
    for length in 0..bytes.len() {
        assert!(Packet::decode(&bytes[..length]).is_err(), "{length}");
    }
    for bit in 0..bytes.len() * 8 {
        let mut damaged = bytes.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        assert!(Packet::decode(&damaged).is_err(), "bit {bit}");
    }
}

#[test]
fn options_of_impossible_size_end_the_packet_not_the_program() {
    for size in [0_u16, 1, 3, 0xFFFF] {
        let mut bytes = packet(&[(3, &[0; 42])]);
        bytes[18..20].copy_from_slice(&size.to_le_bytes());
        assert_eq!(Packet::decode(&bytes), Err(NavdataError::OptionSize { tag: 3, size }));
    }
}

#[test]
fn a_wrong_magic_number_and_a_packet_that_is_too_long_are_refused() {
    let mut bytes = packet(&[]);
    bytes[0] = 0x89;
    assert_eq!(Packet::decode(&bytes), Err(NavdataError::Magic { found: 0x5566_7789 }));
    let bytes = vec![0; 5000];
    assert_eq!(Packet::decode(&bytes), Err(NavdataError::TooLong { bytes: 5000 }));
}

#[test]
fn unknown_tags_are_kept_and_longer_options_read_as_far_as_known() {
    let time = [&(3_u32 << 21 | 5).to_le_bytes()[..], &[7; 4]].concat();
    let bytes = packet(&[(28, &[0xAB; 2]), (1, &time)]);
    let decoded = Packet::decode(&bytes).unwrap();
    let options: Vec<_> = decoded.options().collect();
    assert_eq!(options[0], NavdataOption::Unknown { tag: 28, payload: &[0xAB; 2] });
    assert_eq!(options[1], NavdataOption::Time(Time { since_start: Duration::new(3, 5000) }));
    assert_eq!(decoded.demo(), None);
}

#[test]
fn shorter_options_and_unknown_forms_of_tag_27_are_kept_as_bytes() {
    for (tag, size) in [(0, 40), (10, 3), (27, 476), (27, 9), (27, 0)] {
        let payload = vec![1; size];
        let bytes = packet(&[(tag, &payload)]);
        let decoded = Packet::decode(&bytes).unwrap();
        let unknown = NavdataOption::Unknown { tag, payload: &payload };
        assert_eq!(decoded.options().collect::<Vec<_>>(), [unknown], "{tag} {size}");
        assert_eq!(Navdata::decode(&bytes).unwrap().demo, None);
    }
}

#[test]
fn options_may_be_missing_repeated_and_in_any_order() {
    let payload = |battery: u8| {
        let mut payload = vec![0; 144];
        payload[4] = battery;
        payload
    };
    let bytes = packet(&[(26, &[0; 4]), (0, &payload(50)), (0, &payload(60)), (1, &[0; 4])]);
    let navdata = Navdata::decode(&bytes).unwrap();
    assert_eq!(navdata.demo.map(|demo| demo.battery_percent), Some(50));
    assert_eq!(navdata.time, Some(Duration::ZERO));
}

#[test]
fn a_packet_longer_than_the_firmwares_cannot_be_written() {
    let mut bytes = BytesMut::new();
    let mut writer = PacketWriter::new(&mut bytes, DroneState::empty(), 1, 0);
    let payload = [0; 3000];
    writer.option(&NavdataOption::Unknown { tag: 99, payload: &payload }).unwrap();
    let error = writer.option(&NavdataOption::Unknown { tag: 99, payload: &payload }).unwrap_err();
    assert_eq!(error, NavdataError::TooLong { bytes: 6032 });
    writer.finish();
    assert_eq!(Packet::decode(&bytes).unwrap().options().count(), 1);
}

proptest! {
    #[test]
    fn decoding_undoes_encoding_for_every_option(
        choice in 0..SIZES.len(),
        bytes in proptest::collection::vec(any::<u8>(), 364),
        (state, sequence, vision) in any::<(u32, u32, u32)>(),
    ) {
        let (tag, size) = SIZES[choice];
        let sent = NavdataOption::decode(tag, &bytes[..size - OPTION_HEADER_BYTES]);
        let unknown = matches!(sent, NavdataOption::Unknown { .. });
        prop_assert!(!unknown, "{tag} {size}");
        let mut packet = BytesMut::new();
        let state = DroneState::from_bits_retain(state);
        let mut writer = PacketWriter::new(&mut packet, state, sequence, vision);
        writer.option(&sent).unwrap();
        writer.finish();
        prop_assert_eq!(packet.len(), 24 + size);
        let received = Packet::decode(&packet).unwrap();
        prop_assert_eq!((received.state, received.sequence, received.vision), (state, sequence, vision));
        let options: Vec<_> = received.options().collect();
        // Random bits may be NaN, which is not equal to itself.
        prop_assert_eq!(format!("{options:?}"), format!("{:?}", [sent]));
    }

    #[test]
    fn any_bytes_are_decoded_or_refused(
        mut bytes in proptest::collection::vec(any::<u8>(), 0..300),
        (tag, size) in (0_u16..32, 4_u16..40),
        fitting in any::<bool>(),
    ) {
        if fitting && bytes.len() >= 20 {
            // Random bytes would hardly ever form a packet.
            bytes[..4].copy_from_slice(&MAGIC.to_le_bytes());
            bytes[16..18].copy_from_slice(&tag.to_le_bytes());
            bytes[18..20].copy_from_slice(&size.to_le_bytes());
            bytes.resize(16 + usize::from(size), 0xA5);
            let sum = checksum(&bytes);
            bytes.extend([0xFF, 0xFF, 8, 0]);
            bytes.extend(sum.to_le_bytes());
            prop_assert!(Packet::decode(&bytes).is_ok());
        }
        if let Ok(packet) = Packet::decode(&bytes) {
            let mut written = BytesMut::new();
            let mut writer =
                PacketWriter::new(&mut written, packet.state, packet.sequence, packet.vision);
            for option in packet.options() {
                writer.option(&option).unwrap();
            }
            writer.finish();
            let again = Packet::decode(&written).unwrap();
            let debug = |packet: &Packet<'_>| format!("{:?}", packet.options().collect::<Vec<_>>());
            prop_assert_eq!(debug(&packet), debug(&again));
        }
    }
}
