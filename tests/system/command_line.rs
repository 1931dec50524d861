//! The command line and its errors.

use std::net::UdpSocket;
use std::path::Path;
use std::process::Output;
use std::time::{Duration, Instant};

use system_tests::lateness::Lateness;

use crate::processes::program;

fn pilot(arguments: &[&str]) -> Output {
    let flies = arguments.contains(&"--plan");
    let mut pilot = program("ardrone-pilot");
    pilot.args(arguments).args(flies.then_some("--no-log")).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Flies a plan with this content and expects exit status 20.
fn refused_plan(content: &[u8]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plan.txt");
    std::fs::write(&path, content).unwrap();
    let output = pilot(&["--plan", path.to_str().unwrap(), "--mock"]);
    assert_eq!(output.status.code(), Some(20), "{}", stderr(&output));
    let message = stderr(&output);
    assert!(!message.contains("panicked"), "{message}");
    message.replace(folder.path().to_str().unwrap(), "")
}

#[test]
fn a_missing_plan_is_named() {
    let output = pilot(&["--plan", "no/such/plan.txt", "--mock"]);
    assert_eq!(output.status.code(), Some(20));
    assert!(stderr(&output).contains("cannot read the plan no/such/plan.txt"));
}

#[test]
fn bad_plans_are_refused_with_their_place() {
    insta::assert_snapshot!(refused_plan(b""), @r"
    error: the plan never takes off
     --> /plan.txt:1:1
      |
    1 |
      | ^
      |
      = help: begin with `takeoff` and end with `land`
    ");
    insta::assert_snapshot!(refused_plan(b"takeoff\nland\ngtoo 1 2 3 4\n"), @r"
    error: unknown command `gtoo`
     --> /plan.txt:3:1
      |
    3 | gtoo 1 2 3 4
      | ^^^^
      |
      = help: commands are: takeoff, land, goto, moveBy, moveByRel, hold, setReference, setInitialReachDist, setStayWithinDist, setStayTime, setSpeed, setMaxControl, tag, findTag, landOnTag, clearCommands, autoInit, autoTakeover, lockScaleFP, version
    ");
}

#[test]
fn random_bytes_are_no_plan() {
    let mut state = 7_u32;
    let bytes: Vec<u8> = std::iter::repeat_with(|| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state.to_be_bytes()[0]
    })
    .take(4096)
    .collect();
    assert!(refused_plan(&bytes).contains("unknown command"));
}

/// Characters that control a terminal, or make a line read differently.
const HOSTILE: &str = "\x1b]0;title\x07\x1b[2J\u{9b}2J\u{202e}\u{200b}\r\x08";

/// Checks that the output contains only printable lines.
#[track_caller]
fn is_harmless(output: &Output) {
    for said in [&output.stdout, &output.stderr] {
        let said = String::from_utf8_lossy(said);
        let unseen = ['\u{202e}', '\u{200b}'];
        let hostile = said.chars().find(|c| unseen.contains(c) || (c.is_control() && *c != '\n'));
        assert_eq!(hostile, None, "{said:?}");
    }
}

/// Plans, file names and settings cannot control the terminal.
#[test]
fn what_a_file_holds_does_nothing_to_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let plan = folder.path().join(format!("{HOSTILE}.txt"));
    let path = plan.to_str().unwrap();
    let settings = folder.path().join("pilot.toml");
    std::fs::write(&settings, format!("[limits]\nradius_m = \"{HOSTILE}\"\n")).unwrap();
    for text in [format!("takeoff\ngoto {HOSTILE} 0 0 0\n"), "takeoff\ngoto 1 0 0 0\n".to_owned()] {
        std::fs::write(&plan, text).unwrap();
        is_harmless(&pilot(&["check", path]));
        is_harmless(&pilot(&["check", "--json", path]));
        is_harmless(&pilot(&["check", "--config", settings.to_str().unwrap(), path]));
    }
    is_harmless(&pilot(&["replay", path]));
    is_harmless(&pilot(&["replay", &format!("{path}/no")]));
}

#[test]
fn usage_errors_have_their_own_exit_status() {
    for arguments in
        [&["--plan"][..], &["--plan", "x", "--warp"], &["--plan", "x", "--at-port", "70000"]]
    {
        assert_eq!(pilot(arguments).status.code(), Some(2), "{arguments:?}");
    }
}

#[test]
fn no_drone_is_reported_within_seconds() {
    let (start, lateness) = (Instant::now(), Lateness::measure());
    let output =
        pilot(&["--plan", "../plans/square.txt", "--drone", "127.0.0.1", "--navdata-port", "9"]);
    let taken = start.elapsed();
    assert!(taken < Duration::from_secs(10) + 3 * lateness.worst(), "{taken:?}");
    assert_eq!(output.status.code(), Some(10), "{}", stderr(&output));
    assert!(String::from_utf8_lossy(&output.stdout).contains("no drone answered"));
}

#[test]
fn an_unknown_host_is_named() {
    let output = pilot(&["--plan", "../plans/square.txt", "--drone", "no.such.drone.invalid"]);
    assert_eq!(output.status.code(), Some(10), "{}", stderr(&output));
    assert!(stderr(&output).contains("no.such.drone.invalid"));
}

#[test]
fn a_port_in_use_is_named() {
    let taken = UdpSocket::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    let output = program("mock-drone").args(["--at-port", &port]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let message = stderr(&output);
    assert!(message.contains(&port) && message.contains("AT commands"), "{message}");
}

#[test]
fn help_explains_each_program() {
    for (name, word) in [("ardrone-pilot", "--z-origin"), ("mock-drone", "--bind"), ("asl2c", "-o")]
    {
        let output = program(name).arg("--help").output().unwrap();
        assert!(output.status.success());
        assert!(String::from_utf8_lossy(&output.stdout).contains(word), "{name}");
    }
}

#[test]
fn asl2c_writes_its_files_beside_the_configuration_or_where_it_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let agent = Path::new("../autopilot/agent");
    for file in ["autopilot.asl", "autopilot.conf"] {
        std::fs::copy(agent.join(file), folder.path().join(file)).unwrap();
    }
    let configuration = folder.path().join("autopilot.conf");
    let other = tempfile::tempdir().unwrap();
    for (arguments, output) in
        [(vec![], folder.path()), (vec!["-o", other.path().to_str().unwrap()], other.path())]
    {
        let result = program("asl2c").arg(&configuration).args(arguments).output().unwrap();
        assert!(result.status.success(), "{}", stderr(&result));
        for file in ["autopilot.c", "autopilot.h", "actions.h", "bindings.rs"] {
            assert!(output.join(file).exists(), "{file}");
        }
    }
    let result = program("asl2c").arg("no-such.conf").output().unwrap();
    assert_eq!(result.status.code(), Some(1));
    assert!(stderr(&result).contains("cannot read no-such.conf"));
}

#[test]
fn the_mock_drone_says_what_is_wrong_with_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("faults.txt");
    std::fs::write(&path, "+2 loss 300\nsoon restart\n").unwrap();
    let output = program("mock-drone").args(["--scenario", path.to_str().unwrap()]).output();
    let output = output.unwrap();
    assert_eq!(output.status.code(), Some(1));
    insta::assert_snapshot!(stderr(&output).replace(folder.path().to_str().unwrap(), ""), @r"
    error: expected a percentage, found `300`
     --> /faults.txt:1:9
      |
    1 | +2 loss 300
      |         ^^^
      |
      = help: a number from 0 to 100

    error: `soon` is not a time
     --> /faults.txt:2:1
      |
    2 | soon restart
      | ^^^^
      |
      = help: seconds since the start, or with a plus since the first take-off
    ");
    for (option, value) in [("--scenario", "/no/file"), ("--truth", "/no/folder/truth.csv")] {
        let output = program("mock-drone").args([option, value]).output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        assert!(stderr(&output).contains(value), "{}", stderr(&output));
    }
    for value in ["-1", "101", "many"] {
        let output = program("mock-drone").args(["--loss", value]).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{value}");
    }
}

#[test]
fn a_plan_can_be_checked_without_a_drone() {
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("plan.svg");
    let plan = concat!(env!("CARGO_MANIFEST_DIR"), "/../plans/square.txt");
    let output = pilot(&["check", plan, "--svg", picture.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = String::from_utf8_lossy(&output.stdout);
    let row = text.lines().find(|line| line.contains("goto 1 1 0 0")).unwrap();
    let row: Vec<&str> = row.split_whitespace().collect();
    assert_eq!(row[..10].join(" "), "5 goto 1 1 0 0 1.00 1.00 0.85 0");
    assert!(text.ends_with("square.txt can be flown\n"), "{text}");
    let svg = std::fs::read_to_string(&picture).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("height over expected time"));
    let output = pilot(&["check", plan, "--svg", "/no/such/folder/plan.svg"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("cannot write the drawing /no/such/folder/plan.svg"));
}

/// Each step of it is good; the place is known worse with every metre.
#[test]
fn a_plan_that_would_be_landed_on_the_way_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("long.txt");
    let round = "goto 0 2 0 0\ngoto 2 2 0 0\ngoto 2 0 0 0\ngoto 0 0 0 0\n".repeat(15);
    std::fs::write(&path, format!("takeoff\nsetStayTime 2\n{round}land\n")).unwrap();
    let output = pilot(&["check", path.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.contains("s in the air, at step ") && text.contains("uncertainty is too large"));
    assert!(text.ends_with("long.txt can be flown, but not to its end; 1 warning\n"), "{text}");
}

#[test]
fn a_file_alone_is_taken_for_a_plan() {
    let output = pilot(&["square.txt"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("write `--plan square.txt`"), "{}", stderr(&output));
}

#[test]
fn a_bad_plan_is_reported_to_programs_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plan.txt");
    std::fs::write(&path, "goto 0 1 0 0\nfly\n").unwrap();
    let output = pilot(&["check", path.to_str().unwrap(), "--json"]);
    assert_eq!(output.status.code(), Some(20));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(json["steps"].is_null());
    let problems = json["problems"].as_array().unwrap();
    let problems: Vec<(u64, &str)> = problems
        .iter()
        .map(|problem| (problem["line"].as_u64().unwrap(), problem["message"].as_str().unwrap()))
        .collect();
    assert_eq!(problems, [(1, "the drone is on the ground here"), (2, "unknown command `fly`")]);
}

#[test]
fn shells_and_manuals_are_served() {
    let bash = pilot(&["completions", "bash"]);
    let script = String::from_utf8_lossy(&bash.stdout);
    assert!(script.contains("complete -F") && script.contains("--z-origin"));
    assert_eq!(pilot(&["completions", "no-shell"]).status.code(), Some(2));
    let manual = pilot(&["man"]);
    let manual = String::from_utf8_lossy(&manual.stdout);
    assert!(manual.contains(".TH ardrone-pilot") && manual.contains("Exit status"), "{manual}");
    let of_command = pilot(&["man", "selftest"]);
    let of_command = String::from_utf8_lossy(&of_command.stdout);
    assert!(of_command.contains(".TH ardrone-pilot-selftest 1"), "{of_command}");
    assert_eq!(pilot(&["man", "fly"]).status.code(), Some(2));
}

#[test]
fn programs_get_the_flight_line_by_line() {
    let plan = concat!(env!("CARGO_MANIFEST_DIR"), "/../plans/square.txt");
    let output = pilot(&["--plan", plan, "--mock", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let lines = String::from_utf8_lossy(&output.stdout);
    let lines: Vec<serde_json::Value> =
        lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let of = |kind: &str| lines.iter().filter(|line| line["type"] == kind).collect::<Vec<_>>();
    assert!(of("status").len() > 50, "{}", of("status").len());
    assert_eq!(of("target").len(), 4);
    let started: Vec<&str> =
        of("event").iter().filter_map(|event| event["command"].as_str()).collect();
    assert!(started.contains(&"goto 1 1 0 0"));
    let end = lines.last().unwrap();
    assert_eq!((&end["type"], &end["exit_status"]), (&"end".into(), &0.into()));
}

/// The first code block of a documentation page in this language.
fn block(page: &str, language: &str) -> String {
    let text = std::fs::read_to_string(format!("../docs/{page}")).unwrap();
    let (_, rest) = text.split_once(&format!("```{language}\n")).unwrap();
    rest.split_once("```").unwrap().0.to_owned()
}

#[test]
fn the_documentation_shows_what_is_seen() {
    let terminal = block("plans.md", "console");
    let (command, expected) = terminal.split_once('\n').unwrap();
    let arguments = command.strip_prefix("$ ardrone-pilot ").unwrap().split(' ');
    let output = program("ardrone-pilot").args(arguments).current_dir("..").output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stdout), expected);
    let plan = std::fs::read_to_string("../plans/square.txt").unwrap();
    assert_eq!(block("plans.md", "text"), plan);
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), block("configuration.md", "toml")).unwrap();
    let output = pilot(&["config", "--config", file.path().to_str().unwrap()]);
    let printed = String::from_utf8_lossy(&output.stdout);
    assert!(printed.contains("radius_m = 4.0") && printed.contains("floor_m = 0.3"), "{printed}");
}
