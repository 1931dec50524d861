//! The command line: warnings and their selection, JSON, new agents.

use std::path::Path;
use std::process::{Command, Output};

const CONFIGURATION: &str = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };\n\
    basics { void on(void); void x1(void); void x2(void); void x3(void); int x4(void); };\n\
    types { light(void); level(int); idle(int); };\nsettables { level; };\ntriggerables { +!light; };\n";
const AGENT: &str = "+!light : level(X) <- on.\n";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.conf"), CONFIGURATION).unwrap();
    std::fs::write(folder.path().join("a.asl"), AGENT).unwrap();
    folder
}

fn asl2c(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_asl2c")).args(arguments).current_dir(folder).output().unwrap()
}

/// The first line of each printed warning.
fn warned(output: &Output) -> Vec<String> {
    let text = String::from_utf8_lossy(&output.stderr);
    text.lines()
        .filter(|l| l.starts_with("warning") || l.starts_with("error"))
        .map(str::to_owned)
        .collect()
}

#[test]
fn warnings_have_codes_and_come_in_order() {
    let folder = folder();
    let no_plan = "warning[no-plan]: `+!light` may find no plan";
    let variable = "warning[unused-variable]: variable `X` is never used";
    let unused = "warning[unused-declaration]: 4 actions and functions are never used";
    let idle = "warning[unused-declaration]: `idle` is declared and never used";
    for (arguments, expected) in [
        (&[][..], &[no_plan, variable, unused, idle][..]),
        (&["-A", "unused-declaration"], &[no_plan, variable]),
        (&["-A", "all", "-W", "no-plan"], &[no_plan]),
        (&["-A", "all"], &[]),
        (&["--quiet"], &[]),
    ] {
        let output = asl2c(folder.path(), &[&["a.conf"], arguments].concat());
        assert_eq!(warned(&output), expected);
        assert!(output.status.success());
    }
    assert_eq!(asl2c(folder.path(), &["a.conf", "-A", "no-plans"]).status.code(), Some(2));
}

#[test]
fn shells_and_manuals_are_served() {
    let folder = folder();
    let zsh = asl2c(folder.path(), &["completions", "zsh"]);
    assert!(String::from_utf8_lossy(&zsh.stdout).starts_with("#compdef asl2c"));
    let manual = asl2c(folder.path(), &["man"]);
    assert!(String::from_utf8_lossy(&manual.stdout).contains(".TH asl2c 1"));
    let manual = asl2c(folder.path(), &["man", "verify"]);
    assert!(String::from_utf8_lossy(&manual.stdout).contains(".TH asl2c-verify 1"));
    assert_eq!(asl2c(folder.path(), &["man", "fly"]).status.code(), Some(1));
}

#[test]
fn what_is_denied_is_not_translated() {
    for (arguments, denied) in [
        (&["-D", "warnings"][..], true),
        (&["-D", "warnings", "-A", "all"], false),
        (&["-D", "no-plan", "-A", "all"], true),
        (&["-D", "never-tried"], false),
        (&["-D", "warnings", "--message-format", "json"], true),
    ] {
        let folder = folder();
        let output = asl2c(folder.path(), &[arguments, &["a.conf"]].concat());
        assert_eq!(output.status.success(), !denied, "{arguments:?}");
        assert_eq!(folder.path().join("a.c").exists(), !denied);
        assert_eq!(String::from_utf8_lossy(&output.stderr).contains("are denied"), denied);
    }
}

#[test]
fn each_finding_is_a_line_of_json() {
    let folder = folder();
    let findings = |output: Output| -> Vec<serde_json::Value> {
        let text = String::from_utf8(output.stderr).unwrap();
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    };
    let warnings = findings(asl2c(folder.path(), &["a.conf", "--message-format", "json"]));
    assert_eq!(warnings.len(), 4);
    assert!(warnings.iter().all(|warning| warning["version"] == asl2c::JSON_VERSION));
    assert_eq!(
        (&warnings[1]["code"], &warnings[1]["line"]),
        (&"unused-variable".into(), &1.into())
    );
    assert_eq!((&warnings[1]["column"], &warnings[1]["end_column"]), (&17.into(), &18.into()));
    std::fs::write(folder.path().join("a.asl"), "+!light <- off; +level(true).").unwrap();
    let errors = findings(asl2c(folder.path(), &["a.conf", "--message-format", "json"]));
    let said: Vec<&str> = errors.iter().filter_map(|error| error["message"].as_str()).collect();
    assert_eq!(
        said,
        ["`off` is not declared", "`true` or `false` where a value of type `int` is expected"]
    );
    std::fs::remove_file(folder.path().join("a.asl")).unwrap();
    let missing = findings(asl2c(folder.path(), &["a.conf", "--message-format", "json"]));
    assert_eq!(missing[0]["version"], 1);
    assert!(missing[0]["message"].as_str().unwrap().contains("cannot read"));
}

/// A denied warning is an error, and is printed even if only errors are.
#[test]
fn what_is_denied_is_an_error() {
    let folder = folder();
    let unused = "error[unused-declaration]: 4 actions and functions are never used";
    let idle = "error[unused-declaration]: `idle` is declared and never used";
    let summary = "error: 2 of these are denied as errors: nothing is translated";
    let no_plan = "warning[no-plan]: `+!light` may find no plan";
    let variable = "warning[unused-variable]: variable `X` is never used";
    let deny = ["a.conf", "-D", "unused-declaration"];
    assert_eq!(warned(&asl2c(folder.path(), &deny)), [unused, idle, no_plan, variable, summary]);
    let quiet = [&deny[..], &["-q"]].concat();
    assert_eq!(warned(&asl2c(folder.path(), &quiet)), [unused, idle, summary]);
    let said = asl2c(folder.path(), &[&quiet[..], &["--message-format", "json"]].concat());
    let said: Vec<serde_json::Value> = (String::from_utf8_lossy(&said.stderr).lines())
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    let codes: Vec<&str> = said.iter().filter_map(|finding| finding["code"].as_str()).collect();
    assert_eq!(codes, ["unused-declaration", "unused-declaration", "denied"]);
    assert!(said.iter().all(|finding| finding["severity"] == "error"));
}

/// All JSON lines have the same keys, and a code.
#[test]
fn all_lines_of_json_are_alike() {
    // Options, the defect in the folder, the first code and the exit status.
    type Case<'a> = (&'a [&'a str], &'a dyn Fn(&Path), &'a str, i32);
    let json = ["a.conf", "--message-format", "json"];
    let no_agent = |folder: &Path| std::fs::remove_file(folder.join("a.asl")).unwrap();
    let wrong = |folder: &Path| std::fs::write(folder.join("a.asl"), "+!light <- off.").unwrap();
    let unread = |folder: &Path| std::fs::write(folder.join("a.conf"), "settings { }").unwrap();
    let blocked = |folder: &Path| std::fs::create_dir(folder.join("a.c")).unwrap();
    let latin =
        |folder: &Path| std::fs::write(folder.join("a.asl"), b"+!light <- off.\n// \xe9").unwrap();
    let cases: [Case<'_>; 11] = [
        (&[], &|_| {}, "no-plan", 0),
        (&["-D", "warnings"], &|_| {}, "no-plan", 1),
        (&[], &no_agent, "not-read", 1),
        (&[], &wrong, "not-declared", 1),
        (&[], &unread, "missing-setting", 1),
        (&[], &blocked, "not-written", 1),
        (&[], &latin, "not-read", 1),
        (&["verify"], &|_| {}, "not-checked", 3),
        (&["verify", "-q"], &no_agent, "not-read", 3),
        (&["verify"], &wrong, "not-declared", 3),
        (&["verify", "--quiet"], &unread, "missing-setting", 3),
    ];
    for (options, spoil, code, status) in cases {
        let folder = folder();
        spoil(folder.path());
        let output = asl2c(folder.path(), &[options, &json].concat());
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{options:?} {text}");
        for (index, line) in text.lines().enumerate() {
            let finding: serde_json::Value = serde_json::from_str(line).unwrap();
            let keys: Vec<&String> = finding.as_object().unwrap().keys().collect();
            assert_eq!(
                keys,
                [
                    "code",
                    "column",
                    "end_column",
                    "end_line",
                    "file",
                    "help",
                    "label",
                    "line",
                    "message",
                    "rendered",
                    "severity",
                    "version"
                ]
            );
            assert!(finding["code"].as_str().is_some_and(|code| !code.is_empty()), "{line}");
            assert!(index > 0 || finding["code"] == code, "{line}");
        }
        assert!(!text.is_empty());
    }
}

#[test]
fn a_new_agent_builds_and_runs_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let made = asl2c(folder.path(), &["new", "pilot"]);
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let mut make = Command::new("make");
    make.args(["-s", "-C", "pilot", "CFLAGS=-std=c99 -Wall -Wextra -Werror"]);
    make.env("ASL2C", env!("CARGO_BIN_EXE_asl2c")).current_dir(folder.path());
    let output = make.output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    let printed = String::from_utf8(output.stdout).unwrap();
    let steps: Vec<&str> = printed.split("step ").skip(1).map(|step| step[1..].trim()).collect();
    assert_eq!(steps, ["hover", "hover", "land", "land", "land", "", "hover", "hover"]);
    // Existing files are not touched, and names are checked.
    assert_eq!(asl2c(folder.path(), &["new", "pilot"]).status.code(), Some(1));
    for (name, reason) in [
        ("../x", "is not a valid agent name"),
        ("Pilot", "is not a valid agent name"),
        ("sendLand", "then lower-case letters"),
        ("a b", "is not a valid agent name"),
        ("", "is not a valid agent name"),
        ("main", "`main` is taken: the C file"),
        ("actions", "`actions` is taken: the header"),
        ("run", "`run` is taken: a target of the Makefile"),
        ("verify", "`verify` is taken: a target of the Makefile"),
        ("clean", "`clean` is taken: a target of the Makefile"),
    ] {
        let output = asl2c(folder.path(), &["new", name]);
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{name}");
        assert!(text.contains(reason), "{text}");
    }
}

#[test]
fn every_code_is_explained() {
    let folder = folder();
    let shown = |arguments: &[&str]| {
        let output = asl2c(folder.path(), arguments);
        (String::from_utf8(output.stdout).unwrap(), output.status.code())
    };
    let (text, status) = shown(&["explain", "no-plan"]);
    assert!(
        text.starts_with("warning `no-plan`: goals that may find no plan") && status == Some(0)
    );
    assert!(text.contains("```right\n+!light : dark <- on.\n+!light.\n"), "{text}");
    let (list, _) = shown(&["explain"]);
    assert_eq!(list.lines().count(), translator::Code::ALL.len());
    assert_eq!(shown(&["explain", "no-such-code"]).1, Some(2));
}
