//! Navdata captured from real drones, compared with the results of other decoders.

use ardrone_link::navdata::{
    ControlState, DroneState, Navdata, NavdataError, NavdataOption, Packet, PacketWriter,
};

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

#[test]
fn every_option_of_a_full_packet() {
    let bytes = include_bytes!("../../tests/fixtures/full_2012.bin");
    let packet = Packet::decode(bytes).unwrap();
    let options: Vec<NavdataOption<'_>> = packet.options().collect();
    let tags: Vec<u16> = options.iter().map(NavdataOption::tag).collect();
    assert_eq!(tags, (0..=27).collect::<Vec<u16>>());
    assert!(options.iter().all(|option| !matches!(option, NavdataOption::Unknown { .. })));
    let mut compared = 0;
    let mut same = |value: f64, expected: f64| {
        assert!((value - expected).abs() <= 1e-9 * expected.abs().max(1.0), "{value} {expected}");
        compared += 1;
    };
    for option in &options {
        match option {
            NavdataOption::Demo(demo) => {
                same(demo.pitch_deg, 2.974);
                same(demo.roll_deg, 0.550);
                same(demo.yaw_deg, 1.933);
                same(demo.velocity_right_m_s, -0.000_881_797_909_736_633_3);
                same(f64::from(demo.camera_rotation[0]), 0.998_084_247_112_274_2);
                same(demo.camera_translation_m[2], -0.243);
                same(demo.detection_camera_type.into(), 3.0);
            }
            NavdataOption::Time(time) => same(time.since_start.as_secs_f64(), 362.979_125),
            NavdataOption::RawMeasures(raw) => {
                assert_eq!(raw.accelerometers, [2040, 2036, 2528]);
                assert_eq!(raw.gyroscopes, [-23, 15, 0]);
                same(raw.battery_v, 11.686);
                assert_eq!((raw.echo_association, raw.curve_time), (3758, 21423));
                assert_eq!((raw.curve_reference, raw.echo_sum), (120, 3_539_193));
                assert_eq!((raw.echo_initialised, raw.echo_count, raw.gradient), (1, 1, 41));
                same(raw.altitude_m, 0.243);
            }
            NavdataOption::PhysicalMeasures(physical) => {
                let celsius = physical.accelerometer_temperature_celsius;
                same(celsius.into(), 45.309_303_283_691_406);
                assert_eq!(physical.gyroscope_temperature, 55738);
                // (80, -33, -943) milligravities.
                same(physical.acceleration_m_s2[0], 0.080_297_096_252_441_4 * 9.806_65);
                same(physical.acceleration_m_s2[1], -0.033_318_603_515_625 * 9.806_65);
                same(physical.acceleration_m_s2[2], -0.942_528_320_312_5 * 9.806_65);
                same(physical.angular_rate_deg_s[0].into(), -0.112_364_880_740_642_55);
            }
            NavdataOption::GyroOffsets(gyro) => {
                same(gyro.offsets[1].into(), 0.178_824_022_412_300_1);
            }
            NavdataOption::EulerAngles(euler) => {
                same(euler.pitch_deg, 4.866);
                same(euler.roll_deg, 2.024);
            }
            NavdataOption::Trims(trims) => {
                same(trims.pitch_deg, 3.028_916_015_625);
                same(trims.roll_deg, 1.544_318_359_375);
            }
            NavdataOption::Pwm(pwm) => assert_eq!(pwm.saturated_motors, [255; 4]),
            NavdataOption::Altitude(altitude) => {
                same(altitude.vision_m, 0.243);
                same(altitude.raw_m, 0.243);
            }
            NavdataOption::VisionRaw(vision) => {
                same(vision.translation_x.into(), 1.326_639_771_461_486_8);
            }
            NavdataOption::Vision(vision) => {
                assert_eq!((vision.state, vision.capture_time), (2, 362_969));
                same(vision.capture_yaw_rad.into(), 0.033_727_407_455_444_336);
                same(vision.capture_altitude_m, 0.243);
                same(vision.velocity_m_s[1], -0.000_881_728_053_092_956_5);
            }
            NavdataOption::Watchdog(watchdog) => assert_eq!(watchdog.watchdog, 4822),
            NavdataOption::VideoStream(video) => {
                assert_eq!((video.frame_bytes, video.frame_number), (4597, 46105));
            }
            NavdataOption::PressureRaw(pressure) => {
                assert_eq!(pressure.uncompensated_pressure, 39148);
                assert_eq!(pressure.uncompensated_temperature, 32556);
                same(pressure.temperature_celsius, 43.5);
                assert_eq!(pressure.pressure_pa, 101_586);
            }
            NavdataOption::Magneto(magneto) => {
                assert_eq!(magneto.counts, [30, -56, 80]);
                same(magneto.raw_ut[0], 18.9);
                same(magneto.rectified_ut[2], -28.718_157_958_984_375);
                same(magneto.offset_ut[1], -1.328_299_903_869_629);
                same(magneto.fused_heading_deg.into(), 1.933_355_689_048_767);
                assert_eq!((magneto.calibrated, magneto.calibration_state), (1, 2));
                same(magneto.radius_ut, 38.731_146_240_234_375);
                same(magneto.error_variance.into(), 79.367_187_5);
                assert_eq!(magneto.background_error, None);
            }
            NavdataOption::WindSpeed(wind) => {
                same(wind.states[1].into(), -0.881_728_053_092_956_5);
            }
            NavdataOption::KalmanPressure(kalman) => {
                same(kalman.offset_pa.into(), 101_580.0);
                same(kalman.climb_covariance.into(), 0.025_059_189_647_436_142);
                assert_eq!((kalman.ground_effect, kalman.ultrasound_rejected), (1, 0));
            }
            _ => {}
        }
    }
    assert_eq!(compared, 36);
}

#[test]
fn captures_are_written_again_byte_for_byte() {
    for bytes in [
        &include_bytes!("../../tests/fixtures/full_2012.bin")[..],
        &include_bytes!("../../tests/fixtures/uav_demo_inflight534mm.bin")[..],
    ] {
        let packet = Packet::decode(bytes).unwrap();
        let mut written = bytes::BytesMut::new();
        let mut writer =
            PacketWriter::new(&mut written, packet.state, packet.sequence, packet.vision);
        for option in packet.options() {
            writer.option(&option).unwrap();
        }
        writer.finish();
        assert_eq!(written, bytes);
    }
}

#[test]
fn every_truncation_and_every_flipped_bit_of_a_capture_is_refused() {
    for bytes in [
        &include_bytes!("../../tests/fixtures/full_2012.bin")[..],
        &include_bytes!("../../tests/fixtures/uav_demo_inflight534mm.bin")[..],
    ] {
        for length in 0..bytes.len() {
            assert!(Packet::decode(&bytes[..length]).is_err(), "{length}");
        }
        let mut damaged = bytes.to_vec();
        for bit in 0..bytes.len() * 8 {
            damaged[bit / 8] ^= 1 << (bit % 8);
            assert!(Packet::decode(&damaged).is_err(), "bit {bit}");
            damaged[bit / 8] ^= 1 << (bit % 8);
        }
    }
}
