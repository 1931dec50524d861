//! The language guide shows the real output of `asl2c`.

use std::process::Command;

use crate::harness::skip;

const GUIDE: &str = include_str!("../../../docs/agentspeak.md");

/// Runs `asl2c` as in a terminal; [skipped](skip) without SPIN.
fn shows(terminal: &str) {
    let (command, expected) = terminal.split_once('\n').unwrap();
    let arguments = command.strip_prefix("$ asl2c ").unwrap();
    if Command::new("spin").arg("-V").output().is_err() {
        skip("spin");
        return;
    }
    let output = Command::new(env!("CARGO_BIN_EXE_asl2c"))
        .args(arguments.split(' '))
        .current_dir("..")
        .output()
        .unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stdout), expected, "{arguments}");
}

#[test]
fn the_guide_shows_what_is_printed() {
    let blocks = GUIDE.split("```console\n").skip(1);
    let blocks: Vec<&str> = blocks.map(|rest| rest.split("```").next().unwrap()).collect();
    assert!(!blocks.is_empty());
    blocks.into_iter().for_each(shows);
}
