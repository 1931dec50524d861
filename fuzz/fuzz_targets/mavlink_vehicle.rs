//! Any datagrams at any times: the MAVLink vehicle neither panics nor forgets who may do what.
#![no_main]

use std::time::Duration;

use autopilot::vehicle::{
    OperatorOrder, Phase, Refused, Status, Telemetry, Vehicle, VehicleConfig,
};
use libfuzzer_sys::fuzz_target;
use mavlink_core::{Message as _, calculate_crc};
use mavlink_vehicle::dialect::{
    COMMAND_LONG_DATA, MANUAL_CONTROL_DATA, MISSION_COUNT_DATA, MISSION_ITEM_INT_DATA, MavMessage,
    PARAM_SET_DATA, PositionTargetTypemask, SET_POSITION_TARGET_LOCAL_NED_DATA,
};
use mavlink_vehicle::{Config, Encoder, Input, LONGEST_FRAME, MavlinkVehicle, Output};

/// Numbers that mean something to some command.
const NUMBERS: [f32; 16] = [
    f32::NAN,
    0.0,
    1.0,
    2.0,
    3.0,
    4.0,
    6.0,
    7.0,
    -1.0,
    0.5,
    1.5,
    21196.0,
    262.0,
    67_371_008.0,
    f32::INFINITY,
    1e30,
];
/// Every command that is known, and one that is not.
const COMMANDS: [u16; 24] = [
    20, 21, 22, 23, 24, 176, 179, 185, 189, 192, 193, 224, 246, 262, 300, 400, 401, 410, 510, 511,
    512, 519, 520, 9,
];
/// Commands of items.
const ITEMS: [u16; 16] = [22, 16, 17, 19, 20, 21, 23, 24, 93, 112, 115, 178, 16, 16, 16, 177];

/// The messages that order something, from a few bytes, so that a fuzzer need not find their numbers.
fn message(kind: u8, bytes: &[u8]) -> MavMessage {
    let byte = |at: usize| bytes.get(at).copied().unwrap_or_default();
    let number = |at: usize| NUMBERS[usize::from(byte(at) & 15)];
    let (target_system, target_component) = (u8::from(byte(0) != 255), 1);
    match kind & 7 {
        0 | 1 => MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
            command: COMMANDS[usize::from(byte(1)) % COMMANDS.len()],
            param1: number(2),
            param2: number(3),
            param3: number(4),
            param4: number(5),
            param5: number(6),
            param6: number(7),
            param7: number(8),
            target_system,
            ..COMMAND_LONG_DATA::default()
        }),
        2 => MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
            x: number(1),
            y: number(2),
            z: number(3),
            vx: number(4),
            vy: number(5),
            vz: number(6),
            coordinate_frame: byte(7) & 15,
            type_mask: PositionTargetTypemask::from_bits_truncate(u16::from_le_bytes([
                byte(8),
                byte(9) | 1,
            ])),
            target_system,
            ..SET_POSITION_TARGET_LOCAL_NED_DATA::default()
        }),
        3 => MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA {
            x: i16::from_le_bytes([byte(1), byte(2)]),
            z: i16::from_le_bytes([byte(3), byte(4)]),
            target: target_system,
            ..MANUAL_CONTROL_DATA::default()
        }),
        4 => MavMessage::MISSION_COUNT(MISSION_COUNT_DATA {
            count: u16::from(byte(1) & 7),
            target_system,
            target_component,
            ..MISSION_COUNT_DATA::default()
        }),
        5 | 6 => MavMessage::MISSION_ITEM_INT(MISSION_ITEM_INT_DATA {
            seq: u16::from(byte(1) & 7),
            command: ITEMS[usize::from(byte(2) & 15)],
            frame: byte(3) & 31,
            x: i32::from(i8::from_le_bytes([byte(4)])) * 1000,
            y: i32::from(i8::from_le_bytes([byte(5)])) * 1000,
            z: number(6),
            param1: number(7),
            param2: number(8),
            target_system,
            target_component,
            ..MISSION_ITEM_INT_DATA::default()
        }),
        _ => MavMessage::PARAM_SET(PARAM_SET_DATA {
            param_value: number(1),
            target_system,
            ..PARAM_SET_DATA::default()
        }),
    }
}

/// A frame of any bytes.
fn raw(sequence: u8, system: u8, id: u8, payload: &[u8], buffer: &mut Vec<u8>) {
    let length = u8::try_from(payload.len()).expect("it was cut");
    buffer.extend_from_slice(&[0xfd, length, 0, 0, sequence, system, 190, id, 0, 0]);
    buffer.extend_from_slice(payload);
    let checksum = calculate_crc(&buffer[1..], MavMessage::extra_crc(id.into()));
    buffer.extend_from_slice(&checksum.to_le_bytes());
}

fuzz_target!(|bytes: &[u8]| {
    let Some((&[setting, phase], mut rest)) = bytes.split_first_chunk() else { return };
    let view_only = setting & 1 != 0;
    let mut vehicle = MavlinkVehicle::new(Config { view_only, ..Config::default() });
    let still = Vehicle::new(&VehicleConfig::default()).expect("the default");
    let mut status = still.status(Duration::ZERO);
    let mut now = Duration::from_secs(1);
    let mut sequence = 0_u8;
    vehicle.handle(now, Input::Telemetry(&Telemetry::Readiness([].into())));
    let set = |status: &mut Status, phase: u8| {
        status.phase = if phase & 1 != 0 { Phase::Flying } else { Phase::Standby };
        status.airborne = phase & 3 == 3;
        status.mission_waits = phase & 4 != 0;
    };
    set(&mut status, phase);
    // What comes next: its kind, from whom, how long it is, and then itself.
    while let Some((&[kind, from, length], more)) = rest.split_first_chunk() {
        let (payload, after) = more.split_at(usize::from(length).min(more.len()));
        rest = after;
        match kind {
            255 => now += Duration::from_millis(20 * u64::from(from)),
            254 => set(&mut status, from),
            253 => vehicle.handle(now, Input::PeerGone(from & 3)),
            _ => {
                sequence = sequence.wrapping_add(1);
                let (system, peer) = (250 + (from >> 2 & 3), from & 3);
                let mut bytes = Vec::new();
                if kind < 128 {
                    let mut buffer = [0; LONGEST_FRAME];
                    let mut encoder = Encoder::new(system, 190);
                    let message = message(kind, payload);
                    bytes.extend_from_slice(encoder.encode(&message, None, now, &mut buffer));
                } else {
                    raw(sequence, system, kind - 128, payload, &mut bytes);
                }
                vehicle.handle(now, Input::Datagram { peer, local: true, bytes: &bytes });
            }
        }
        vehicle.handle(now, Input::Telemetry(&Telemetry::Status(status)));
        vehicle.tick(now);
        let mut outputs = 0;
        while let Some(output) = vehicle.poll(now) {
            outputs += 1;
            assert!(outputs < 2000, "it goes on and on");
            let Output::Order { ticket, by, order } = output else { continue };
            assert!(!view_only, "{order:?} of {by}, who may only look");
            let answer = match &order {
                OperatorOrder::Take if status.controls.is_some_and(|holder| holder != by) => {
                    Err(Refused::Busy)
                }
                OperatorOrder::Take => {
                    status.controls = Some(by);
                    Ok(())
                }
                OperatorOrder::Release => {
                    status.controls = status.controls.filter(|holder| *holder != by);
                    Ok(())
                }
                OperatorOrder::Start { .. } | OperatorOrder::Append(_) => {
                    let others = status.controls.is_some_and(|holder| holder != by);
                    assert!(!others || status.phase == Phase::Flying, "flown for {by}");
                    Ok(())
                }
                _ => Ok(()),
            };
            vehicle.handle(now, Input::Answer { ticket, answer });
        }
    }
});
