//! Properties of what peers say: `verify` and `prove` judge them alike, and a run shows what does not hold.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use crate::harness::{cbmc, skip};

const CONFIGURATION: &str = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };
basics { void on(void); void off(void); void idle(void); void lift(int); void flash(void); void again(void); };
peers { leader, wingman, scout };
messages { tell low(int) from wingman; achieve land from leader, wingman; achieve go(int) from leader, 2;
    achieve up from wingman; };
preemptive { +!land; }; types { heard(void); };
properties {
";

const AGENT: &str = "+!land <- on.
+!up <- flash.
+low(_) : heard <- idle; again.
+low(_) <- +heard; idle.
-low(_) <- off.
+!go(X) <- lift(X).
";

/// Goals that are served before others.
const URGENT: &str = "unless +!land[source(leader)], unless +!land[source(wingman)]";

/// What is served before a belief that is told.
const WAITING: &str = "unless +!go[source(leader)], unless +!up[source(wingman)]";

/// Each property, and whether it holds.
const PROPERTIES: [(&str, bool); 15] = [
    ("within(1, +!land[source(leader)], on)", true),
    ("within(1, +!land[source(leader)], lift)", false),
    ("within(1, +!go[source(leader)], lift)", false),
    // The other peer may come first, once.
    ("within(1, +!go[source(leader)], lift, on, flash)", true),
    ("within(1, +!up[source(wingman)], flash, lift, URGENT)", true),
    ("within(1, +!up[source(wingman)], flash, URGENT)", false),
    ("within(2, +!up[source(wingman)], flash, URGENT)", true),
    ("only_after(lift, +!go[source(leader)])", true),
    ("only_after(lift, +!land[source(leader)])", false),
    ("only_after(flash, +low[source(wingman)])", false),
    ("only_after(off, -low[source(wingman)], until on)", true),
    // Another value is a change, too.
    ("only_after(again, -low[source(wingman)])", false),
    ("within(1, +low[source(wingman)], idle, URGENT, WAITING)", true),
    ("within(1, -low[source(wingman)], off, URGENT, WAITING)", true),
    ("within(1, -low[source(wingman)], idle, URGENT, WAITING)", false),
];

fn judged(folder: &Path, arguments: &[&str]) -> Vec<(String, bool)> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    let output = command.args(arguments).arg("a.conf").current_dir(folder).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(!text.contains("NOT CONFIRMED"), "{text}");
    let verdict = |name: &str| {
        let line = text.lines().find(|line| line.starts_with(&format!("{name}: ")));
        let line = line.unwrap_or_else(|| panic!("{name}:\n{text}"));
        assert!(line.contains("holds") || line.contains("DOES NOT HOLD"), "{text}");
        line.contains("holds")
    };
    let all = PROPERTIES.iter().enumerate();
    all.map(|(number, (formula, _))| ((*formula).to_owned(), verdict(&format!("p{number}"))))
        .collect()
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut configuration = CONFIGURATION.to_owned();
    for (number, (formula, _)) in PROPERTIES.iter().enumerate() {
        let formula = formula.replace("URGENT", URGENT).replace("WAITING", WAITING);
        // Writing to a string cannot fail.
        _ = writeln!(configuration, "p{number}: {formula};");
    }
    configuration += "};\n";
    std::fs::write(folder.path().join("a.conf"), configuration).unwrap();
    std::fs::write(folder.path().join("a.asl"), AGENT).unwrap();
    folder
}

fn expected() -> Vec<(String, bool)> {
    PROPERTIES.iter().map(|(formula, holds)| ((*formula).to_owned(), *holds)).collect()
}

#[test]
fn what_peers_say_is_verified() {
    if Command::new("spin").arg("-V").output().is_err() {
        return skip("spin");
    }
    assert_eq!(judged(folder().path(), &["verify"]), expected());
}

/// Each counterexample is confirmed by the interpreter and its monitors.
#[test]
fn what_peers_say_is_proved() {
    let Some(cbmc) = cbmc() else { return };
    let cbmc = cbmc.to_string_lossy().into_owned();
    assert_eq!(judged(folder().path(), &["prove", "--time", "20", "--cbmc", &cbmc]), expected());
}

/// What an urgent goal of a peer takes back does not go on.
#[test]
fn what_is_taken_back_is_over() {
    let folder = tempfile::tempdir().unwrap();
    let configuration = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };
        basics { void on(void); void off(void); };
        peers { leader, wingman }; messages { achieve land from any; };
        types { go(void); more(void); };
        triggerables { +!go; }; preemptive { +!land; };
        properties { over: only_after(on, +!go, until off); };\n";
    std::fs::write(folder.path().join("a.conf"), configuration).unwrap();
    let agent = "+!go <- on; !more.\n+!more <- on; !more.\n+!land <- off.\n";
    std::fs::write(folder.path().join("a.asl"), agent).unwrap();
    if Command::new("spin").arg("-V").output().is_err() {
        return skip("spin");
    }
    let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    let output = command.args(["verify", "a.conf"]).current_dir(folder.path()).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{text}");
}

/// A goal that is refused is no event: nothing is due for it.
#[test]
fn what_is_refused_is_not_due() {
    let folder = tempfile::tempdir().unwrap();
    let configuration = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };
        basics { void on(void); void off(void); };
        peers { leader, wingman }; messages { achieve go from wingman, ROOM; };
        types { first(void); }; triggerables { +!first; }; preemptive { +!first; };
        properties { answered: within(1, +!go[source(wingman)], on); };\n";
    std::fs::write(folder.path().join("a.asl"), "+!first <- on.\n+!go <- off.\n").unwrap();
    // The answer to the goal that waits comes with another event.
    let script =
        "receive_achieve_go(wingman); achieve_first(); step\nreceive_achieve_go(wingman); step\n";
    std::fs::write(folder.path().join("a.script"), script).unwrap();
    for (room, is_broken) in [("1", false), ("2", true)] {
        let path = folder.path().join("a.conf");
        std::fs::write(path, configuration.replace("ROOM", room)).unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
        let command = command.args(["run", "a.conf", "--script", "a.script"]);
        let output = command.current_dir(folder.path()).output().unwrap();
        let text = String::from_utf8_lossy(&output.stdout);
        assert_eq!(text.contains("breaks `answered`"), is_broken, "{room}: {text}");
    }
}

/// What a peer takes back before it is noticed is no event any more, and nothing is due for it.
#[test]
fn a_change_that_is_taken_back_is_not_due() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let configuration = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };
        basics { void on(void); void off(void); };
        peers { leader, wingman }; messages { tell low from wingman; };
        triggerables { +!first; }; types { first(void); };
        properties { told: within(1, +low[source(wingman)], on); gone: within(1, -low[source(wingman)], on); };\n";
    write("a.conf", configuration);
    write("a.asl", "+!first <- on.\n+low <- off.\n-low <- off.\n");
    let (tell, untell) = ("receive_tell_low(wingman)", "receive_untell_low(wingman)");
    for (said, broken) in [
        (format!("{tell}; step"), "told"),
        (format!("{tell}; {untell}; step"), "gone"),
        (format!("{tell}; {untell}; {tell}; step"), "told"),
    ] {
        write("a.script", &format!("{said}\n"));
        let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
        let command = command.args(["run", "a.conf", "--script", "a.script"]);
        let output = command.current_dir(folder.path()).output().unwrap();
        let text = String::from_utf8_lossy(&output.stdout);
        for name in ["told", "gone"] {
            let is_broken = text.contains(&format!("breaks `{name}`"));
            assert_eq!(is_broken, name == broken, "{said}: {text}");
        }
    }
}
