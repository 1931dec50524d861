//! `foxglove.CompressedVideo`, the message in which log viewers expect encoded pictures, as protobuf.
//!
//! Four fields need no generator: <https://protobuf.dev/programming-guides/encoding/>. The schema in the log is a
//! `FileDescriptorSet`, as MCAP asks for (<https://mcap.dev/spec/registry>).

use std::time::Duration;

/// Name of the message.
pub(super) const SCHEMA_NAME: &str = "foxglove.CompressedVideo";
/// Encoding of messages and schema.
pub(super) const ENCODING: &str = "protobuf";

/// Numbers of the message's fields.
const TIMESTAMP: u32 = 1;
const FRAME_ID: u32 = 2;
const DATA: u32 = 3;
const FORMAT: u32 = 4;

/// Types of fields in a descriptor.
const INT64: u64 = 3;
const INT32: u64 = 5;
const STRING: u64 = 9;
const MESSAGE: u64 = 11;
const BYTES: u64 = 12;

/// A message: a picture in the form of Annex B, of a camera, and when it came.
pub(super) fn message(time: Duration, camera: &str, picture: &[u8]) -> Vec<u8> {
    let mut timestamp = Vec::new();
    put_number(&mut timestamp, 1, time.as_secs());
    put_number(&mut timestamp, 2, time.subsec_nanos().into());
    // Tags and lengths take less than the rest.
    let mut message = Vec::with_capacity(picture.len() + camera.len() + 64);
    put_bytes(&mut message, TIMESTAMP, &timestamp);
    put_bytes(&mut message, FRAME_ID, camera.as_bytes());
    put_bytes(&mut message, DATA, picture);
    put_bytes(&mut message, FORMAT, b"h264");
    message
}

/// The picture in a message; `None` if it is none.
pub(super) fn payload(message: &[u8]) -> Option<&[u8]> {
    let mut rest = message;
    while !rest.is_empty() {
        let tag = take_varint(&mut rest)?;
        if tag & 7 != LENGTH_DELIMITED {
            return None;
        }
        let length = usize::try_from(take_varint(&mut rest)?).ok()?;
        let (content, behind) = rest.split_at_checked(length)?;
        if tag >> 3 == u64::from(DATA) {
            return Some(content);
        }
        rest = behind;
    }
    None
}

/// The schema: a `FileDescriptorSet` of the message's file and of that of its time stamp.
pub(super) fn schema() -> Vec<u8> {
    let timestamp = file(
        ("google/protobuf/timestamp.proto", "google.protobuf"),
        None,
        ("Timestamp", &[field("seconds", 1, INT64, None), field("nanos", 2, INT32, None)]),
    );
    let fields = [
        field("timestamp", TIMESTAMP, MESSAGE, Some(".google.protobuf.Timestamp")),
        field("frame_id", FRAME_ID, STRING, None),
        field("data", DATA, BYTES, None),
        field("format", FORMAT, STRING, None),
    ];
    let video = file(
        ("foxglove/CompressedVideo.proto", "foxglove"),
        Some("google/protobuf/timestamp.proto"),
        ("CompressedVideo", &fields),
    );
    let mut set = Vec::new();
    for file in [timestamp, video] {
        put_bytes(&mut set, 1, &file);
    }
    set
}

/// A `FileDescriptorProto` with one message.
fn file(
    (name, package): (&str, &str),
    dependency: Option<&str>,
    (message, fields): (&str, &[Vec<u8>]),
) -> Vec<u8> {
    let mut descriptor = Vec::new();
    put_bytes(&mut descriptor, 1, message.as_bytes());
    for field in fields {
        put_bytes(&mut descriptor, 2, field);
    }
    let mut file = Vec::new();
    put_bytes(&mut file, 1, name.as_bytes());
    put_bytes(&mut file, 2, package.as_bytes());
    if let Some(dependency) = dependency {
        put_bytes(&mut file, 3, dependency.as_bytes());
    }
    put_bytes(&mut file, 4, &descriptor);
    put_bytes(&mut file, 12, b"proto3");
    file
}

/// A `FieldDescriptorProto`.
fn field(name: &str, number: u32, kind: u64, type_name: Option<&str>) -> Vec<u8> {
    const OPTIONAL: u64 = 1;
    let mut field = Vec::new();
    put_bytes(&mut field, 1, name.as_bytes());
    put_number(&mut field, 3, number.into());
    put_number(&mut field, 4, OPTIONAL);
    put_number(&mut field, 5, kind);
    if let Some(type_name) = type_name {
        put_bytes(&mut field, 6, type_name.as_bytes());
    }
    field
}

const VARINT: u64 = 0;
const LENGTH_DELIMITED: u64 = 2;

fn put_number(out: &mut Vec<u8>, field: u32, value: u64) {
    put_varint(out, u64::from(field) << 3 | VARINT);
    put_varint(out, value);
}

fn put_bytes(out: &mut Vec<u8>, field: u32, content: &[u8]) {
    put_varint(out, u64::from(field) << 3 | LENGTH_DELIMITED);
    put_varint(out, content.len() as u64);
    out.extend_from_slice(content);
}

/// Seven bits in each byte, the lowest first; the highest bit says that more follow.
fn put_varint(out: &mut Vec<u8>, mut value: u64) {
    loop {
        let [low, ..] = value.to_le_bytes();
        value >>= 7;
        if value == 0 {
            out.push(low);
            return;
        }
        out.push(low | 0x80);
    }
}

fn take_varint(rest: &mut &[u8]) -> Option<u64> {
    let mut value = 0;
    for shift in (0..64).step_by(7) {
        let (first, behind) = rest.split_first()?;
        *rest = behind;
        value |= u64::from(first & 0x7f) << shift;
        if first & 0x80 == 0 {
            return Some(value);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_message_is_as_protobuf_encodes_it() {
        let expected = [
            &[0x0a, 5, 8, 0x96, 1, 16, 7][..],
            &[0x12, 5][..],
            b"front",
            &[0x1a, 3, 1, 2, 3, 0x22, 4],
            b"h264",
        ];
        assert_eq!(message(Duration::new(150, 7), "front", &[1, 2, 3]), expected.concat());
    }

    proptest! {
        #[test]
        fn pictures_come_back(
            (seconds, picture) in (any::<u64>(), prop::collection::vec(any::<u8>(), 0..300))
        ) {
            let message = message(Duration::from_secs(seconds), "bottom", &picture);
            prop_assert_eq!(payload(&message), Some(&picture[..]));
        }

        #[test]
        fn anything_else_has_no_picture_or_a_part_of_it(bytes in prop::collection::vec(any::<u8>(), 0..60)) {
            if let Some(found) = payload(&bytes) {
                prop_assert!(found.len() < bytes.len());
            }
        }
    }
}
