//! Any bytes as navdata: refused, or every option survives decoding and encoding; without a panic.
#![no_main]

use ardrone_link::navdata::{Packet, PacketWriter};
use libfuzzer_sys::fuzz_target;

/// Corrects the checksum, because a fuzzer would not find a valid one.
fn with_checksum(bytes: &[u8]) -> Vec<u8> {
    let mut packet = vec![0x88, 0x77, 0x66, 0x55];
    packet.extend_from_slice(bytes);
    let sum = packet.iter().fold(0_u32, |sum, byte| sum.wrapping_add(u32::from(*byte)));
    packet.extend_from_slice(&[0xFF, 0xFF, 8, 0]);
    packet.extend_from_slice(&sum.to_le_bytes());
    packet
}

fuzz_target!(|bytes: &[u8]| {
    let _ = Packet::decode(bytes);
    let bytes = with_checksum(bytes);
    let Ok(packet) = Packet::decode(&bytes) else { return };
    let mut written = bytes::BytesMut::new();
    let mut writer = PacketWriter::new(&mut written, packet.state, packet.sequence, packet.vision);
    for option in packet.options() {
        writer.option(&option).expect("it was in a packet");
    }
    writer.finish();
    let again = Packet::decode(&written).expect("it was just written");
    let options = |packet: &Packet<'_>| format!("{:?}", packet.options().collect::<Vec<_>>());
    assert_eq!(options(&packet), options(&again));
});
