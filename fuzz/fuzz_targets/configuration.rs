//! Any text as a configuration: it is parsed or refused, without a panic.
#![no_main]

use libfuzzer_sys::fuzz_target;
use translator::{parse_configuration, translate};

fuzz_target!(|text: &str| {
    if let Ok(configuration) = parse_configuration("a.conf", text) {
        let _ = translate(&configuration, "!a. +!a : b(X) <- act(X); !!a.");
    }
});
