//! Navdata that real drones sent, against reference values made by other decoders.

use ardrone_link::navdata::{ControlState, DroneState, Navdata, NavdataError};

#[test]
fn a_hovering_drones_demo_packet() {
    let packet = include_bytes!("../../tests/fixtures/uav_demo_inflight534mm.bin");
    let navdata = Navdata::decode(packet).unwrap();
    assert_eq!(navdata.sequence, 6069);
    assert_eq!(navdata.state.bits(), 260_048_117);
    assert!(navdata.state.contains(DroneState::FLYING | DroneState::NAVDATA_DEMO));
    let demo = navdata.demo.unwrap();
    assert_eq!(demo.control_state, ControlState::Flying);
    assert_eq!(demo.battery_percent, 76);
    for (value, expected) in [
        (demo.pitch_deg, -0.092),
        (demo.roll_deg, -0.440),
        (demo.yaw_deg, 14.668),
        (demo.altitude_m, 0.534),
        (demo.velocity_forward_m_s, 0.268_482_635_498_046_9),
        (demo.velocity_right_m_s, -0.195_254_348_754_882_8),
        (demo.velocity_down_m_s, 0.0),
    ] {
        assert!((value - expected).abs() < 1e-12, "{value} {expected}");
    }
}

#[test]
fn a_landed_drones_full_packet() {
    let packet = include_bytes!("../../tests/fixtures/full_2012.bin");
    let navdata = Navdata::decode(packet).unwrap();
    assert_eq!(navdata.sequence, 300_711);
    let demo = navdata.demo.unwrap();
    assert_eq!(demo.control_state, ControlState::Landed);
    assert_eq!(demo.battery_percent, 50);
    assert_eq!(navdata.time.map(|time| time.as_micros()), Some(362_979_125));
}

#[test]
fn a_packet_with_a_wrong_checksum() {
    let packet = include_bytes!("../../tests/fixtures/uav_status_badcks.bin");
    let error = NavdataError::Checksum { found: 961, computed: 1024 };
    assert_eq!(Navdata::decode(packet), Err(error));
}
