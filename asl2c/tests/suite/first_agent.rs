//! `docs/first-agent.md`, `docs/crossing.md` and `docs/airlock.md` are what a newcomer sees: the tests write their files and run their commands.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use crate::harness::{cbmc, skip};

/// What a command of the page prints, if it does not go to a file; progress is on standard error.
fn printed(command: &str, folder: &Path, cbmc: &Path) -> String {
    let (command, file) = match command.split_once(" > ") {
        Some((command, file)) => (command, Some(file)),
        None => (command, None),
    };
    let (program, arguments) = command.split_once(' ').unwrap_or((command, ""));
    let arguments: Vec<&str> = arguments.split_whitespace().collect();
    let mut program = match program {
        "asl2c" => Command::new(env!("CARGO_BIN_EXE_asl2c")),
        "gcc" => Command::new(program),
        own => Command::new(folder.join(own)),
    };
    program.args(&arguments).current_dir(folder);
    if arguments.first().is_some_and(|name| ["prove", "validate", "certify"].contains(name)) {
        program.arg("--cbmc").arg(cbmc);
    }
    let text = String::from_utf8(program.output().unwrap().stdout).unwrap();
    let Some(file) = file else { return text };
    std::fs::write(folder.join(file), text).unwrap();
    String::new()
}

/// The page with what its commands print here.
fn followed(page: &str, folder: &Path, cbmc: &Path) -> String {
    let mut text = String::new();
    let mut file = None;
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        writeln!(text, "{line}").unwrap();
        let named = line.strip_prefix('`').and_then(|rest| rest.strip_suffix("`:"));
        file = named.map(str::to_owned).or(file);
        let Some(kind) = line.strip_prefix("```").filter(|kind| !kind.is_empty()) else { continue };
        let block: Vec<&str> = lines.by_ref().take_while(|line| *line != "```").collect();
        if kind == "console" {
            let command = block[0].strip_prefix("$ ").unwrap();
            writeln!(text, "$ {command}\n{}```", printed(command, folder, cbmc)).unwrap();
        } else {
            let content: String = block.iter().map(|line| format!("{line}\n")).collect();
            writeln!(text, "{content}```").unwrap();
            let name = file.take().expect("a file's name is before its text");
            std::fs::write(folder.join(name), content).unwrap();
        }
    }
    text
}

/// Counts of the compiled C depend on the compiler.
fn without_counts(page: &str) -> String {
    let lines = page.lines().map(|line| match line.split_once(" tests; of ") {
        Some((before, _)) if line.starts_with("tests ") => before,
        _ => line,
    });
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn the_first_page_shows_what_a_newcomer_sees() {
    follow("../docs/first-agent.md");
}

#[test]
fn the_second_page_shows_what_a_newcomer_sees() {
    follow("../docs/crossing.md");
}

#[test]
fn the_page_of_two_agents_shows_what_a_newcomer_sees() {
    follow("../docs/airlock.md");
}

/// `UPDATE_PAGES=1` writes what is printed into the page.
fn follow(page_path: &str) {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    for (tool, version) in [
        ("cppcheck", "--version"),
        ("frama-c", "-version"),
        ("valgrind", "--version"),
        ("spin", "-V"),
    ] {
        if Command::new(tool).arg(version).output().is_err() {
            skip(tool);
            return;
        }
    }
    let page = std::fs::read_to_string(page_path).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let seen = followed(&page, folder.path(), &cbmc);
    if std::env::var_os("UPDATE_PAGES").is_some() {
        std::fs::write(page_path, seen).unwrap();
    } else {
        let (seen, shown) = (without_counts(&seen), without_counts(&page));
        let differs = seen.lines().zip(shown.lines()).find(|(seen, shown)| seen != shown);
        assert_eq!(differs, None, "printed, and in the page");
        assert_eq!(seen.lines().count(), shown.lines().count());
    }
    if page.contains("$ asl2c certify") {
        assert!(folder.path().join("evidence/index.html").is_file());
    }
}
