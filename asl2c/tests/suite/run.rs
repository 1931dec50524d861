//! `asl2c run`: its output, and that no input ends it.

use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use asl2c::{Runs as _, Session, replay};
use translator::parse_configuration;

const GUIDE: &str = include_str!("../../../docs/agentspeak.md");
const PAPER: &str = "translator/agents/paper.conf";

/// Runs `asl2c run` in the repository's root with these lines as a script.
fn run(lines: &str) -> (String, Option<i32>) {
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("a.script");
    std::fs::write(&script, lines).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_asl2c"))
        .args(["run", PAPER, "--script"])
        .arg(&script)
        .current_dir("..")
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    (text.replace(folder.path().to_str().unwrap(), "."), output.status.code())
}

#[test]
fn a_mind_is_shown_with_what_ran_and_why() {
    let (shown, status) = run("set_position(1.0, 2, 3, 4); step\n\
        achieve_goTo(1,2,3,1e-7);\n\
        closeEnough_result = false, true\n\
        step 2; mind\n\
        undo; mind // back to before\n");
    insta::assert_snapshot!(shown);
    assert_eq!(status, Some(0));
}

#[test]
fn errors_point_at_their_place_and_end_nothing() {
    let (shown, status) = run("achive_land();\nachieve_goTo(1,2);\n  achieve_land(3);\n\
        getCurrentTimeMS_result = 99999999999999999999;\nonGround_result = maybe\n\
        step 0\nstep; undo 9\nset_position(1, 2, 3, 1e999)\n) \nstep now\nonGround_result true\nstep\n");
    insta::assert_snapshot!(shown);
    assert_eq!(status, Some(1));
}

#[test]
fn a_run_ends_where_nothing_changes_and_tells_what_is_broken() {
    let (shown, status) = run("onGround_result = true; run\n\
        onGround_result = false; achieve_goTo(0, 0, 1, 0); step 2\n");
    insta::assert_snapshot!(shown);
    assert_eq!(status, Some(1));
}

#[test]
fn a_transcript_is_compared() {
    let good =
        "> onGround_result = true;\n> step\nstandBy()\n\n> achieve_land();\n> step 2\nstandBy()\n";
    let (_, status) = run(good);
    assert_eq!(
        status,
        Some(1),
        "`+!land` on the ground has no plan: properties are broken, and it does not say so"
    );
    let good = good.replacen("step 2\n", "step\n// step 2: an event was not handled completely\n\
        // step 2 breaks `one_command`\n// step 2 breaks `landing_is_honoured`\n// step 2 breaks `nothing_is_lost`\n\
        > step\n", 1);
    let (shown, status) = run(&good);
    assert_eq!(status, Some(0), "{shown}");
    let (shown, status) = run(&good.replacen("standBy()", "sendLand()", 1));
    assert_eq!(status, Some(1));
    assert!(shown.contains("the output differs") && shown.contains("a.script:2:2"), "{shown}");
}

fn piped(arguments: &[&str], lines: &[u8], folder: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    command.args(arguments).current_dir(folder).stdin(Stdio::piped());
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // It may have ended before everything is written.
    _ = child.stdin.take().unwrap().write_all(lines);
    child.wait_with_output().unwrap()
}

#[test]
fn what_is_piped_in_is_carried_out() {
    let output =
        piped(&["run", PAPER], b"onGround_result = true;\nstep\nquit\nstep\n", Path::new(".."));
    let shown = String::from_utf8(output.stdout).unwrap();
    assert_eq!(shown, "> onGround_result = true;\n> step\nstandBy()\n> quit\n");
    assert!(output.status.success());
    let output = piped(&["run", PAPER], b"step\n\nstop\nstep\n", Path::new(".."));
    assert_eq!(output.status.code(), Some(1));
    let complaint = String::from_utf8(output.stderr).unwrap();
    assert!(
        complaint.contains("there is no `stop`") && complaint.contains("input:3:1"),
        "{complaint}"
    );
    assert_eq!(String::from_utf8(output.stdout).unwrap().matches("> step").count(), 2);
}

/// The guide's transcripts, which another test compiles, have the same result without any C.
#[test]
fn the_guides_transcripts_need_no_c() {
    let mut configuration = "";
    let mut agent = "";
    let mut checked = 0;
    for block in GUIDE.split("\n```").skip(1) {
        let Some((language, content)) = block.split_once('\n') else { continue };
        match language {
            "configuration" => configuration = content,
            "agentspeak" => agent = content,
            "transcript" => {
                let parsed = parse_configuration("a.conf", configuration).unwrap();
                let mut session = Session::new(&parsed, agent).unwrap();
                let replayed = replay(&mut session, "guide", &format!("{content}\n"));
                assert_eq!(replayed.errors, 0, "{}", replayed.shown);
                checked += 1;
            }
            // The expected output includes errors.
            "session" => {
                let parsed = parse_configuration("a.conf", configuration).unwrap();
                let mut session = Session::new(&parsed, agent).unwrap();
                let said = content.lines().filter_map(|line| line.strip_prefix("> "));
                let said: String = said.map(|line| format!("{line}\n")).collect();
                assert_eq!(replay(&mut session, "pilot.script", &said).shown.trim_end(), content);
                checked += 1;
            }
            _ => {}
        }
    }
    assert!(checked >= 4, "{checked}");
}

const DEEP: &str = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };\nbasics { void on(int); };\n";

/// No step runs for ever, whatever the agent.
#[test]
fn a_step_that_is_too_long_is_not_made() {
    // Each goal calls the next one twice.
    let goals = 40;
    let types: String = (0..=goals).map(|n| format!("g{n}(void); ")).collect();
    let plans: String = (0..goals).map(|n| format!("+!g{n} <- !g{0}; !g{0}.\n", n + 1)).collect();
    let wide = format!("{plans}+!g{goals} <- on(1).\n");
    let configuration =
        format!("{DEEP}types {{ {types} }};\ntriggerables {{ +!g0; +!g{goals}; }};");
    let parsed = parse_configuration("a.conf", &configuration).unwrap();
    let mut session = Session::new(&parsed, &wide).unwrap();
    let error = session.execute("achieve_g0(); step").unwrap_err();
    assert!(error.message.contains("it is not executed"), "{}", error.message);
    assert_eq!(session.execute("clear(); achieve_g40(); step").unwrap(), ["on(1)"]);
}

/// Calls nested as deep as a long agent can nest them.
#[test]
fn a_deep_step_overflows_no_stack() {
    let goals = 3000;
    let types: String = (0..=goals).map(|n| format!("g{n}(void); ")).collect();
    let plans: String = (0..goals).map(|n| format!("+!g{n} <- !g{}.\n", n + 1)).collect();
    let folder = tempfile::tempdir().unwrap();
    let configuration =
        format!("{DEEP}types {{ {types} }};\ntriggerables {{ +!g0; +!g{}; }};", goals - 1500);
    std::fs::write(folder.path().join("a.conf"), configuration).unwrap();
    std::fs::write(folder.path().join("a.asl"), format!("{plans}+!g{goals} <- on(1).\n")).unwrap();
    let lines = format!("achieve_g{}(); step\nachieve_g0(); step\nstep\n", goals - 1500);
    let output = piped(&["run", "a.conf"], lines.as_bytes(), folder.path());
    let shown = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(shown.contains("on(1)"), "{shown}");
    assert!(String::from_utf8_lossy(&output.stderr).contains("calls too deep"));
}

/// Every input gets a response.
#[test]
fn no_line_ends_a_session() {
    let configuration = std::fs::read_to_string("../translator/agents/paper.conf").unwrap();
    let agent = std::fs::read_to_string("../translator/agents/paper.asl").unwrap();
    let parsed = parse_configuration("a.conf", &configuration).unwrap();
    let mut session = Session::new(&parsed, &agent).unwrap();
    let parts = [
        "achieve_",
        "goTo",
        "land",
        "(",
        ")",
        ",",
        ";",
        "1",
        "-",
        "1e308",
        "nan",
        "set_position",
        "step ",
        "undo ",
        "run 5",
        "onGround_result",
        "=",
        "true",
        "\"",
        "\\",
        "{",
        "}",
        "mind",
        "//",
        "ä",
        "\u{0}",
        "\t",
        "999999999999",
        " ",
        "achieve_land();",
        "set_position(1,2,3,4);",
        "step;",
    ];
    let mut random = 88_172_645_463_325_252_u64;
    let mut fine = 0;
    for _ in 0..5000 {
        let mut line = String::new();
        for _ in 0..=random % 7 {
            random ^= random << 13;
            random ^= random >> 7;
            random ^= random << 17;
            line += parts[usize::try_from(random >> 8).unwrap() % parts.len()];
        }
        match session.execute(&line) {
            Ok(_) => fine += 1,
            Err(error) => {
                assert!(error.span.end <= line.len() && !error.message.is_empty(), "{line:?}");
            }
        }
    }
    assert!(fine > 100, "{fine}");
}

/// Otherwise a line of a text would be one of the transcript, or a command.
#[test]
fn texts_are_shown_and_read_with_the_escapes_of_agents() {
    let configuration = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };\n\
        basics { void say(const char *); };\ntypes { go(const char *); };\ntriggerables { +!go; };";
    let agent = r#"+!go(X) <- say("one\n> quit\t\\"); say(X)."#;
    let parsed = parse_configuration("a.conf", configuration).unwrap();
    let mut session = Session::new(&parsed, agent).unwrap();
    let script = concat!(r#"achieve_go("a\nb\t\"c\"\\"); step"#, "\n");
    let shown = [r"say(one\n> quit\t\\)", r#"say(a\nb\t"c"\\)"#];
    assert_eq!(session.execute(script.trim_end()).unwrap(), shown);
    let transcript = replay(&mut Session::new(&parsed, agent).unwrap(), "a.script", script);
    let again = replay(&mut Session::new(&parsed, agent).unwrap(), "a", &transcript.shown);
    assert!(transcript.is_fine() && again.is_fine(), "{}", again.shown);
    let error = session.execute(r#"achieve_go("a\r")"#).unwrap_err();
    assert_eq!((&*error.message, error.span), ("unknown escape in a text", 13..15));
}
