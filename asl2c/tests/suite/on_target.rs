//! The gallery and the shipped agent on a Cortex-M4, and C that differs there.

use std::path::Path;
use std::process::Command;

use asl2c::{Agent, OnTarget, TargetError, on_target};
use translator::Exercise;

use crate::harness::skip;

fn exercised(agent: &Agent) -> Exercise {
    translator::exercise(&agent.configuration, &agent.text).unwrap()
}

fn read(name: &str) -> Agent {
    Agent::read(&Path::new("..").join(name)).unwrap()
}

/// The result, or `None` if a tool is missing.
fn run(exercise: &Exercise, reference: &Exercise, steps: u32) -> Option<OnTarget> {
    match on_target(exercise, reference, steps) {
        Ok(result) => Some(result),
        Err(TargetError::Missing { program }) => {
            skip(&program);
            None
        }
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn each_agent_does_the_same_on_the_target_within_its_bounds() {
    let gallery = ["paper", "lift", "traffic_light", "infusion", "rover", "inspection", "relief"];
    let mut names: Vec<String> =
        gallery.iter().map(|name| format!("translator/agents/{name}.conf")).collect();
    names.push("autopilot/agent/autopilot.conf".to_owned());
    for name in names {
        let exercise = exercised(&read(&name));
        let Some(found) = run(&exercise, &exercise, 1000) else { return };
        assert_eq!(found.difference, None, "{name}");
        assert!(found.lines > 3000, "{name} {}", found.lines);
        let step = &found.bounds[0];
        let longest = step.instructions.clone().unwrap();
        let observed = found.observed;
        assert!((20..=longest).contains(&observed.instructions), "{name} {observed:?} {step:?}");
        assert!(observed.stack <= step.stack, "{name} {observed:?} {step:?}");
    }
}

/// The C with another character in the first such place.
fn changed(exercise: &Exercise, from: &str, to: &str) -> Exercise {
    assert!(
        from.len() == to.len() && from.bytes().zip(to.bytes()).filter(|(a, b)| a != b).count() == 1
    );
    let mut changed = exercise.clone();
    let text = exercise.files[0].text.replacen(from, to, 1);
    assert_ne!(text, exercise.files[0].text);
    changed.files[0].text = text;
    changed
}

#[test]
fn one_character_that_differs_on_one_side_is_seen() {
    let exercise = exercised(&read("translator/agents/rover.conf"));
    for (from, to) in [
        ("(var_Angle > 25.0)", "(var_Angle > 26.0)"),
        ("var_Now < var_", "var_Now > var_"),
        ("argument1 - argument2", "argument1 + argument2"),
    ] {
        let changed = changed(&exercise, from, to);
        for (target, host) in [(&exercise, &changed), (&changed, &exercise)] {
            let Some(found) = run(target, host, 5000) else { return };
            let difference = found.difference.unwrap_or_else(|| panic!("{from}"));
            assert_ne!(difference.host, difference.target);
        }
    }
}

const CONFIGURATION: &str =
    "settings { input = a.asl; output = gen/a.c; header = gen/inc/a.h; basics = actions.h; };
    includes { #include <stdint.h> #include \"own.h\" };
    structs { place_t { double x; int8_t y; float z; }; };
    basics { void act(double, int64_t, const char *, float); bool at(place_t, int16_t); uint8_t level(void); };
    types { go(double, int64_t, float); place(place_t); name(const char *); wait(void); };
    settables { place; name; }; triggerables { +!go; };";
const TEXT: &str = "!wait.
    +!wait : name(N) & place(P) & at(P, 3) <- act(1.5, 2, N, 0.5); !!wait.
    +!wait <- !!wait.
    +!go(X, Y, Z) : level > 3 <- act(X / (X - 1.0), Y / 7 + (Y mod 3) * Y, \"x\", Z * 2.5 / Z).
    -!go(X, _, Z) <- act(X * X + 1.0, 0, \"failed\", Z - 1.0).
    +!go(X, Y, Z) <- act(X, Y, \"low\", Z).";

/// Structs, strings, folders, a header of the user's own, and arithmetic that only the compiler's library has.
#[test]
fn an_agent_with_all_types_is_compared_and_the_library_counts() {
    let configuration = translator::parse_configuration("a.conf", CONFIGURATION).unwrap();
    let mut exercise = translator::exercise(&configuration, TEXT).unwrap();
    let mut own = exercise.files[1].clone();
    (own.name, own.text) = ("own.h".to_owned(), "enum { OWN = 1 };\n".to_owned());
    exercise.files.push(own);
    let found = match on_target(&exercise, &exercise, 1000) {
        Ok(found) => found,
        Err(TargetError::Missing { program }) => return skip(&program),
        Err(error) => panic!("{error}"),
    };
    assert_eq!(found.difference, None);
    assert!(found.library > 1000, "{found:?}");
    let step = &found.bounds[0];
    // The library's multiplication normalizes its operands in a loop.
    let reason = step.instructions.clone().unwrap_err();
    assert!(reason.contains("`__aeabi_"), "{reason}");
    assert!(step.stack >= found.observed.stack, "{found:?}");
    // Without the header nothing is compiled.
    exercise.files.pop();
    let error = on_target(&exercise, &exercise, 10).unwrap_err();
    assert!(error.to_string().contains("own.h"), "{error}");
}

/// A struct that comes partly in registers and partly on the stack: its function takes more stack than the compiler says.
#[test]
fn a_struct_of_four_fields_is_followed() {
    const CONFIGURATION: &str = "settings { input = m.asl; output = m.c; header = m.h; basics = acts.h; };
        structs { vec { double x; double y; float z; bool ok; }; };
        basics { void move(vec); }; types { pos(vec); go(void); }; settables { pos; }; triggerables { +!go; };";
    let configuration = translator::parse_configuration("m.conf", CONFIGURATION).unwrap();
    let exercise = translator::exercise(&configuration, "+!go : pos(P) <- move(P).").unwrap();
    let Some(found) = run(&exercise, &exercise, 1000) else { return };
    assert_eq!(found.difference, None);
    assert!(found.bounds[0].stack >= found.observed.stack, "{found:?}");
}

#[test]
fn the_report_has_the_target_and_a_missing_tool_is_no_success() {
    let report = |path: Option<&str>, arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
        let folder = tempfile::tempdir().unwrap();
        command.args(["../translator/agents/lift.conf", "-o"]).arg(folder.path()).args(arguments);
        if let Some(path) = path {
            command.env("PATH", path);
        }
        command.output().unwrap()
    };
    let wanted = ["--report", "--target", "cortex-m4"];
    let output = report(Some("/nothing"), &wanted);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(said.contains("apt install gcc gcc-arm-none-eabi qemu-system-arm"), "{said}");
    assert_eq!(report(None, &["--target", "cortex-m4"]).status.code(), Some(2));
    assert_eq!(report(None, &["--report", "--target", "z80"]).status.code(), Some(2));
    let output = report(None, &wanted);
    let said = String::from_utf8_lossy(&output.stderr);
    match output.status.code() {
        Some(0) => {}
        Some(3) => return skip(&said),
        _ => panic!("{said}"),
    }
    let shown = String::from_utf8_lossy(&output.stdout);
    for part in ["on a Cortex-M4 (", "  next_step()", "trace of 5000 steps", "the same as on this"]
    {
        assert!(shown.contains(part), "{part}: {shown}");
    }
}
