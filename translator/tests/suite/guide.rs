//! The language guide's examples behave as the guide states.

use std::process::Command;

use translator::system::parse_system;
use translator::{Translation, format, format_system, obligations, parse_configuration, translate};

use crate::harness::run_program;

const GUIDE: &str = include_str!("../../../docs/agentspeak.md");

/// Declarations for the guide's properties.
const DRONE: &str = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };
    basics { void sendLand(void); void sendStandby(void); void sendTakeOff(void);
        void sendHover(void); };
    classes { at_command: sendLand, sendStandby, sendTakeOff, sendHover; };
    types { land(void); takeOff(void); }; triggerables { +!land; +!takeOff; };
    ";

/// The fenced blocks of the guide: language and content.
fn blocks() -> Vec<(&'static str, String)> {
    let mut blocks = Vec::new();
    let mut open: Option<(&str, String)> = None;
    for line in GUIDE.lines() {
        match (&mut open, line.strip_prefix("```")) {
            (None, Some(language)) => open = Some((language, String::new())),
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (Some((_, content)), None) => {
                content.push_str(line);
                content.push('\n');
            }
            (None, None) => {}
        }
    }
    blocks
}

/// Output of a program that is compiled with the agent's C, as in the guide.
fn runs_alone(translation: &Translation, main: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    for file in &translation.files {
        std::fs::write(folder.path().join(&file.name), &file.text).unwrap();
    }
    std::fs::write(folder.path().join("main.c"), main).unwrap();
    let mut compile = Command::new("gcc");
    compile.args([
        "-std=c99",
        translator::ROUNDED,
        "-Wall",
        "-Wextra",
        "-Werror",
        "-o",
        "pilot",
        "main.c",
        "pilot.c",
    ]);
    let output = compile.current_dir(folder.path()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let output = Command::new(folder.path().join("pilot")).output().unwrap();
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn every_example_of_the_guide_does_what_it_says() {
    let mut configuration = String::new();
    let mut agent = String::new();
    let mut checked = 0;
    for (language, content) in blocks() {
        match language {
            "configuration" => configuration = content,
            "agentspeak" => {
                assert_eq!(format("a.asl", &content).unwrap(), content);
                agent = content;
            }
            "transcript" => {
                let (script, expected): (Vec<&str>, Vec<&str>) =
                    content.lines().partition(|line| line.starts_with('>'));
                let script: String = script
                    .iter()
                    .map(|line| format!("{}\n", line.trim_start_matches('>')))
                    .collect();
                let trace = run_program(&configuration, &agent, &script);
                assert_eq!(trace, expected.join("\n"), "{agent}");
                checked += 1;
            }
            "refused" => {
                let parsed = parse_configuration("a.conf", &configuration).unwrap();
                let error = translate(&parsed, &agent).unwrap_err().to_string();
                assert_eq!(error.trim_end(), content.trim_end());
                checked += 1;
            }
            "warned" => {
                let parsed = parse_configuration("a.conf", &configuration).unwrap();
                let warnings = translate(&parsed, &agent).unwrap().warnings.to_string();
                let warnings = warnings.replace("pilot.asl", "a.asl");
                assert!(warnings.starts_with(content.trim_end()), "{warnings}");
                checked += 1;
            }
            // A complete program with the agent: it compiles and runs.
            "c" => {
                let parsed = parse_configuration("a.conf", &configuration).unwrap();
                let translation = translate(&parsed, &agent).unwrap();
                assert_eq!(runs_alone(&translation, &content), "land\n");
                checked += 1;
            }
            // Output of `asl2c` is tested in that crate.
            "sh" | "console" | "session" => {}
            "system" => {
                assert_eq!(parse_system("a.system", &content).unwrap().agents().len(), 2);
                assert_eq!(format_system("a.system", &content).unwrap(), content);
                checked += 1;
            }
            "properties" => {
                let parsed = parse_configuration("a.conf", &format!("{DRONE}{content}")).unwrap();
                let agent = "+!land <- sendLand. +!takeOff <- sendTakeOff; sendHover; sendStandby.";
                let promises = obligations(&parsed, agent).unwrap().properties;
                assert_eq!(promises.len(), content.matches(';').count() - 1);
                checked += 1;
            }
            other => panic!("what is ```{other} for?"),
        }
    }
    assert!(checked >= 6, "{checked}");
}
