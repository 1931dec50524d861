//! `asl2c certify`: the folder, the page, and what it says of agents that are right and wrong.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use asl2c::{Agent, cover};
use serde_json::Value;

use crate::harness::{cbmc, skip};

const AGENTS: &str = "../translator/agents";

/// Certifies an agent of the gallery; `None` without CBMC or another tool.
fn certify(agent: &Path, folder: &Path) -> Option<Output> {
    certify_with(agent, folder, &[])
}

/// As [`certify`], with further arguments.
fn certify_with(agent: &Path, folder: &Path, further: &[&Path]) -> Option<Output> {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return None;
    };
    let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    command.arg("certify").arg(agent).arg("-o").arg(folder).arg("--cbmc").arg(cbmc);
    // Whoever counts what asl2c itself executes changes nothing.
    command.args(further).env("GCOV_PREFIX", "/none");
    let output = command.output().unwrap();
    let complaint = String::from_utf8_lossy(&output.stderr);
    if complaint.contains("nothing is certified") {
        skip("cppcheck, Frama-C, gcc or valgrind");
        return None;
    }
    Some(output)
}

fn gallery(name: &str) -> PathBuf {
    Path::new(AGENTS).join(format!("{name}.conf"))
}

/// All files of a folder and below, with their content.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().display().to_string();
                found.push((name, std::fs::read(&path).unwrap()));
            }
        }
    }
    found.sort();
    found
}

fn evidence(folder: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(folder.join("evidence.json")).unwrap()).unwrap()
}

/// Adds a file to evidence, as if it had been there from the beginning.
fn list(evidence: &Path, name: &str, text: &str) {
    std::fs::write(evidence.join(name), text).unwrap();
    let sum = |name: &str| {
        let output = Command::new("sha256sum").arg(name).current_dir(evidence).output().unwrap();
        String::from_utf8_lossy(&output.stdout).split(' ').next().unwrap().to_owned()
    };
    let sums = std::fs::read_to_string(evidence.join("SHA256SUMS")).unwrap();
    let (sums, _mark) = sums.trim_end().rsplit_once('\n').unwrap();
    let sums = format!("{sums}\n{}  {name}\n", sum(name));
    std::fs::write(evidence.join("SHA256SUMS"), &sums).unwrap();
    let mark = format!("# asl2c wrote this: sha256 {}\n", sum("SHA256SUMS"));
    std::fs::write(evidence.join("SHA256SUMS"), sums + &mark).unwrap();
}

#[test]
fn the_evidence_is_whole_and_the_same_each_time() {
    let folder = tempfile::tempdir().unwrap();
    let (first, second) = (folder.path().join("first"), folder.path().join("second"));
    let Some(output) = certify(&gallery("lift"), &first) else { return };
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("C and text    shown (10 proofs)"), "{said}");
    let tested = &evidence(&first)["reach"]["outcomes"]["tested"];
    assert!(tested.as_u64().is_some_and(|tested| tested > 10), "{tested}");
    // The second takes the place of an earlier one, of which nothing is left but what somebody else has put there.
    for (name, text) in files(&first) {
        std::fs::create_dir_all(second.join(&name).parent().unwrap()).unwrap();
        std::fs::write(second.join(name), text).unwrap();
    }
    list(&second, "tests/test_099.transcript", "old");
    std::fs::write(second.join("review.txt"), "seen").unwrap();
    let known = [Path::new("--invariant"), &first.join("invariant.txt")];
    certify_with(&gallery("lift"), &second, &known).unwrap();
    std::fs::remove_file(second.join("review.txt")).unwrap();
    assert_eq!(files(&first), files(&second));
    changed_evidence_is_not_replaced(&second);
    let checked = Command::new("sha256sum")
        .args(["--quiet", "-c", "SHA256SUMS"])
        .current_dir(&first)
        .output();
    assert!(checked.unwrap().status.success());
    // A reader of the folder alone can run each test and make the C again.
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
        command.args(arguments).current_dir(&first).output().unwrap()
    };
    let tests = evidence(&first)["tests"].as_array().unwrap().clone();
    assert!(tests.len() > 3);
    for test in tests {
        let file = test["file"].as_str().unwrap();
        let replayed = run(&["run", "agent/lift.conf", "--script", file]);
        assert!(replayed.status.success(), "{}", String::from_utf8_lossy(&replayed.stdout));
    }
    let made = folder.path().join("made");
    std::fs::create_dir(&made).unwrap();
    assert!(run(&["agent/lift.conf", "-o", made.to_str().unwrap()]).status.success());
    let read = |path: &Path| std::fs::read(path).unwrap();
    assert_eq!(read(&made.join("lift.c")), read(&first.join("c/lift.c")));
}

/// A page that somebody has changed, or a link in its place.
fn changed_evidence_is_not_replaced(evidence: &Path) {
    let page = evidence.join("index.html");
    let text = std::fs::read_to_string(&page).unwrap();
    std::fs::write(&page, format!("{text}<!-- seen -->")).unwrap();
    let before = files(evidence);
    let output = certify(&gallery("lift"), evidence).unwrap();
    assert_eq!(output.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&output.stderr).contains("is not as asl2c left it"));
    assert_eq!(files(evidence), before);
    #[cfg(unix)]
    {
        let other = tempfile::tempdir().unwrap();
        let victim = other.path().join("victim");
        std::fs::write(&victim, &text).unwrap();
        std::fs::remove_file(&page).unwrap();
        std::os::unix::fs::symlink(&victim, &page).unwrap();
        let output = certify(&gallery("lift"), evidence).unwrap();
        assert_eq!(output.status.code(), Some(3));
        assert!(String::from_utf8_lossy(&output.stderr).contains("is a link"));
        assert_eq!(std::fs::read_to_string(victim).unwrap(), text);
    }
}

#[test]
fn what_is_wrong_is_told_with_its_counterexample() {
    let folder = tempfile::tempdir().unwrap();
    let Some(output) = certify(&gallery("infusion"), folder.path()) else { return };
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("properties    REFUTED (6 of 7)"), "{said}");
    let evidence = evidence(folder.path());
    let properties = evidence["properties"].as_array().unwrap();
    let wrong = properties.iter().find(|property| property["name"] == "air_is_heard").unwrap();
    let script = wrong["verdict"]["fails"]["script"].as_str().unwrap();
    let mut replayed = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    replayed.args(["run", "agent/infusion.conf", "--script", script]).current_dir(folder.path());
    let replayed = replayed.output().unwrap();
    let shown = String::from_utf8_lossy(&replayed.stdout);
    assert!(shown.contains("breaks `air_is_heard`"), "{shown}");
    // The way from a requirement to its plans, their C, the property, and the tests.
    let requirements = evidence["requirements"].as_array().unwrap();
    let air = requirements.iter().find(|requirement| requirement["tag"] == "PUMP-4").unwrap();
    assert_eq!(air["plans"].as_array().unwrap().len(), 3);
    assert!(!air["tests"].as_array().unwrap().is_empty());
    let page = std::fs::read_to_string(folder.path().join("index.html")).unwrap();
    assert!(page.contains("air_is_heard") && !page.contains("http"), "{page}");
}

/// A warning of the compiler, a rule that is broken, a difference: whatever is found, is told.
#[test]
fn other_peoples_folders_are_not_changed() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("thesis.txt"), "ten years").unwrap();
    let Some(output) = certify(&gallery("lift"), folder.path()) else { return };
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3));
    assert!(said.contains("is not empty and holds no evidence"), "{said}");
    assert_eq!(files(folder.path()).len(), 1);
}

/// Other people's checksums are no evidence, and their files are not removed.
#[test]
fn other_peoples_checksums_are_no_evidence() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("main.c"), "int main;\n").unwrap();
    std::fs::write(folder.path().join("SHA256SUMS"), "00  main.c\n").unwrap();
    let Some(output) = certify(&gallery("lift"), folder.path()) else { return };
    assert_eq!(output.status.code(), Some(3));
    assert_eq!(files(folder.path()).len(), 2);
}

/// Nothing is required, so nothing is shown; and headers bring those that they include.
#[test]
fn without_properties_nothing_is_shown() {
    let folder = tempfile::tempdir().unwrap();
    let text = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };\n\
        includes { #include <stdbool.h>\n#include <stdint.h>\n#include \"sub/own.h\"\n};\n\
        basics { void on(void); }; types { light(void); }; triggerables { +!light; };\n";
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    for (name, text) in [
        ("a.conf", text),
        ("a.asl", "+!light <- on.\n"),
        ("sub/own.h", "# include \"other.h\"\n"),
        ("sub/other.h", "#include \"../deep.h\"\n"),
        ("deep.h", "#ifndef DEEP_H\n#define DEEP_H\n#endif\n"),
    ] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let out = folder.path().join("out");
    let Some(output) = certify(&folder.path().join("a.conf"), &out) else { return };
    let said = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("properties    NOT DECIDED (none is stated"), "{said}{errors}");
    assert!(out.join("c/deep.h").exists() && out.join("c/sub/other.h").exists());
    std::fs::remove_file(folder.path().join("deep.h")).unwrap();
    let mut prove = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    prove.arg("prove").arg(folder.path().join("a.conf")).arg("--cbmc").arg(cbmc().unwrap());
    let output = prove.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3));
    assert!(said.contains("the C cannot be compiled") && said.contains("deep.h"), "{said}");
}

#[test]
fn a_missing_tool_is_no_evidence() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    command.arg("certify").arg(gallery("lift")).arg("-o").arg(folder.path());
    let output = command.args(["--cbmc", "./no-cbmc"]).output().unwrap();
    assert_eq!(output.status.code(), Some(3));
    assert!(files(folder.path()).is_empty());
    // A path with gcc, but not the other tools: all are named at once, CBMC too.
    let tools = tempfile::tempdir().unwrap();
    for tool in ["gcc", "sh"] {
        let found = Command::new("which").arg(tool).output().unwrap().stdout;
        let found = String::from_utf8(found).unwrap();
        std::os::unix::fs::symlink(found.trim(), tools.path().join(tool)).unwrap();
    }
    for cbmc in cbmc().into_iter().chain(["./no-cbmc".into()]) {
        let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
        command.arg("certify").arg(gallery("lift")).arg("-o").arg(folder.path());
        command.arg("--cbmc").arg(&cbmc).env("PATH", tools.path());
        let output = command.output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(3), "{said}");
        for package in ["gcc", "cppcheck", "valgrind", "frama-c-base"] {
            assert!(said.contains(&format!("(`apt install {package}`)")), "{package}: {said}");
        }
        assert!(!said.contains("gcc cannot be run"), "{said}");
        let without_cbmc = cbmc.ends_with("no-cbmc");
        assert_eq!(said.contains("CBMC 6 or later is needed"), without_cbmc, "{said}");
        assert!(files(folder.path()).is_empty());
    }
}

/// The tests of each agent, and of the shipped one: no difference, and hardly a line of the C that is not reached.
#[test]
fn generated_tests_reach_the_c() {
    let names = ["paper", "lift", "traffic_light", "infusion", "rover", "inspection"];
    let mut paths: Vec<PathBuf> = names.iter().map(|name| gallery(name)).collect();
    paths.push("../autopilot/agent/autopilot.conf".into());
    for path in paths {
        let agent = Agent::read(&path).unwrap();
        let Ok(found) = cover(&agent, &[]) else {
            skip("gcc");
            return;
        };
        let differences: Vec<&String> =
            found.tests.iter().filter_map(|test| test.difference.as_ref()).collect();
        assert!(differences.is_empty(), "{} {differences:?}", path.display());
        let statements = found.counts.statements(&(1..=usize::MAX));
        assert!(statements.ran * 100 >= statements.all * 96, "{} {statements}", path.display());
    }
}
