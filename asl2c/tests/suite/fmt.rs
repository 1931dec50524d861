//! `asl2c fmt`: files of agents and systems, standard input, `--check`, and texts with errors.

use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output, Stdio};

const UGLY: &str = "!go .\n// start\n+!go<-on ;   off.\n";
const FORMATTED: &str = "!go.\n// start\n+!go <- on; off.\n";
const SYSTEM: &str = "// two\nagents{a:x.conf;b : y.conf ;};";
const FORMATTED_SYSTEM: &str = "// two\nagents { a: x.conf; b: y.conf; };\n";

fn fmt(folder: &Path, arguments: &[&str], input: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_asl2c"))
        .arg("fmt")
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    child.wait_with_output().unwrap()
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [("a.asl", UGLY), ("b.asl", FORMATTED), ("c.asl", "+!go <- on\n")] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

fn text(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).unwrap()
}

#[test]
fn files_are_formatted_in_place_and_one_with_errors_is_left_alone() {
    let folder = folder();
    let folder = folder.path();
    let output = fmt(folder, &["a.asl", "c.asl", "b.asl", "d.asl"], "");
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(String::from_utf8_lossy(&output.stdout), "");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("error: expected `.` at the end of the plan"), "{said}");
    assert!(said.contains(" --> c.asl:1:12\n") && said.contains("cannot read d.asl"), "{said}");
    assert_eq!(text(folder, "a.asl"), FORMATTED);
    assert_eq!(text(folder, "b.asl"), FORMATTED);
    assert_eq!(text(folder, "c.asl"), "+!go <- on\n");
    assert!(fmt(folder, &["a.asl", "b.asl"], "").status.success());
}

#[test]
fn a_check_lists_the_files_and_changes_none() {
    let folder = folder();
    let folder = folder.path();
    let output = fmt(folder, &["--check", "a.asl", "b.asl"], "");
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(String::from_utf8_lossy(&output.stdout), "a.asl\n");
    assert_eq!(text(folder, "a.asl"), UGLY);
    assert!(fmt(folder, &["--check", "b.asl"], "").status.success());
    assert_eq!(fmt(folder, &[], "").status.code(), Some(2));
}

#[test]
fn standard_input_is_formatted_to_standard_output() {
    let folder = folder();
    let output = fmt(folder.path(), &["-"], UGLY);
    assert!(output.status.success());
    assert_eq!(String::from_utf8_lossy(&output.stdout), FORMATTED);
    assert_eq!(fmt(folder.path(), &["--check", "-"], UGLY).status.code(), Some(1));
    let output = fmt(folder.path(), &["--message-format", "json", "-"], "+!go <- ");
    let line: serde_json::Value = serde_json::from_slice(&output.stderr).unwrap();
    assert_eq!((&line["code"], &line["file"]), (&"syntax".into(), &"input".into()));
}

/// A file is known by its name, and what is piped by its begin.
#[test]
fn systems_are_formatted_beside_agents() {
    let folder = folder();
    let folder = folder.path();
    for (name, text) in [("d.system", SYSTEM), ("e.system", "+!go <- on.")] {
        std::fs::write(folder.join(name), text).unwrap();
    }
    assert_eq!(fmt(folder, &["--check", "d.system"], "").stdout, b"d.system\n");
    let output = fmt(folder, &["a.asl", "d.system", "e.system"], "");
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains(" --> e.system:1:1\n"), "{said}");
    assert_eq!(text(folder, "a.asl"), FORMATTED);
    assert_eq!(text(folder, "d.system"), FORMATTED_SYSTEM);
    assert_eq!(fmt(folder, &["-"], SYSTEM).stdout, FORMATTED_SYSTEM.as_bytes());
    let output = fmt(folder, &["-"], "agents { a x.conf; };");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains(" --> input:1:12\n"), "{said}");
}

/// Replacing invalid bytes in a comment would lose them.
#[test]
fn bytes_that_are_not_utf8_are_left_alone() {
    let folder = folder();
    let bytes = b"// f\xfcr\n+!go<-on.\n";
    std::fs::write(folder.path().join("a.asl"), bytes).unwrap();
    let output = fmt(folder.path(), &["a.asl"], "");
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(std::fs::read(folder.path().join("a.asl")).unwrap(), bytes);
}

#[cfg(unix)]
#[test]
fn nothing_is_formatted_through_a_link() {
    let folder = folder();
    let link = folder.path().join("link.asl");
    std::os::unix::fs::symlink("a.asl", &link).unwrap();
    let output = fmt(folder.path(), &["link.asl"], "");
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("link.asl is a link"));
    assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(text(folder.path(), "a.asl"), UGLY);
}

#[test]
fn a_new_agent_is_formatted() {
    let folder = tempfile::tempdir().unwrap();
    let mut new = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    assert!(
        new.args(["new", "pilot"]).current_dir(folder.path()).output().unwrap().status.success()
    );
    assert!(fmt(folder.path(), &["--check", "pilot/pilot.asl"], "").status.success());
}

/// Translated or written back, they would be others.
#[test]
fn other_bytes_than_those_of_utf8_are_told_with_their_place() {
    let folder = folder();
    std::fs::write(folder.path().join("a.asl"), b"// \xc3\xa9\n// \xc3\xa9 \xe9").unwrap();
    let output = fmt(folder.path(), &["a.asl"], "");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("cannot read a.asl: line 2, column 6 is not UTF-8"), "{said}");
    assert_eq!(output.status.code(), Some(1));
}
