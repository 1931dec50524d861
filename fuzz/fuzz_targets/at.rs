//! Any bytes as AT commands: decoded commands survive encoding and decoding.
#![no_main]

use ardrone_link::at::{Command, Datagram, decode};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    for (sequence, command) in decode(bytes).flatten() {
        let mut datagram = Datagram::new();
        if datagram.push(sequence, &command).is_ok() {
            let again: Vec<(u32, Command)> = decode(datagram.as_bytes()).flatten().collect();
            assert_eq!(again, [(sequence, command)]);
        }
    }
});
