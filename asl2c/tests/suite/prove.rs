//! `asl2c prove` without its tools, and undecided results. Proofs themselves are tested with the gallery.

use std::path::Path;
use std::process::{Command, Output};

use crate::harness::{cbmc, skip};

const CONFIGURATION: &str = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };\n\
    basics { void on(void); int32_t read(void); };\ntypes { light(void); level(int32_t); };\n\
    settables { level; };\ntriggerables { +!light; };\n";
const AGENT: &str = "+!light : level(X) & X + read > 3 <- on.\n+!light <- on.\n";

fn folder(sections: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.conf"), format!("{CONFIGURATION}{sections}")).unwrap();
    std::fs::write(folder.path().join("a.asl"), AGENT).unwrap();
    folder
}

fn asl2c(folder: &Path, cbmc: &Path, options: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    command.args(["prove", "a.conf"]).args(options).arg("--cbmc").arg(cbmc);
    command.current_dir(folder).output().unwrap()
}

fn complaint(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(3), "{}", String::from_utf8_lossy(&output.stdout));
    assert!(output.stdout.is_empty());
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A missing proof must not look like a successful one.
#[test]
fn a_missing_tool_is_no_pass() {
    let folder = folder("");
    let text = complaint(&asl2c(folder.path(), Path::new("./no-cbmc"), &[]));
    assert!(
        text.starts_with("error: nothing is proved") && text.contains("apt install cbmc"),
        "{text}"
    );
    let text = complaint(&asl2c(folder.path(), Path::new("no-such-cbmc"), &[]));
    assert!(text.contains("CBMC cannot be run"), "{text}");
    let json = ["--message-format", "json"];
    let text = complaint(&asl2c(folder.path(), Path::new("no-such-cbmc"), &json));
    assert!(text.contains("\"not-checked\""), "{text}");
}

#[cfg(unix)]
#[test]
fn another_tool_is_none() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder("");
    for (version, said, expected) in [
        ("5.12 (cbmc-5.12)", "VERIFICATION SUCCESSFUL", "is `5.12"),
        ("something", "VERIFICATION SUCCESSFUL", "is `something"),
        ("6.6.0", "Out of memory", "gave no result"),
    ] {
        let script = folder.path().join("cbmc");
        let text = format!(
            "#!/bin/sh\nif [ \"$1\" = --version ]; then echo '{version}'; else echo '{said}'; fi\n"
        );
        std::fs::write(&script, text).unwrap();
        std::fs::set_permissions(&script, std::fs::Permissions::from_mode(0o755)).unwrap();
        let text = complaint(&asl2c(folder.path(), Path::new("./cbmc"), &[]));
        assert!(text.contains(expected), "{text}");
    }
}

/// Stand-ins for CBMC that prove everything: none of them is believed by any task.
#[cfg(unix)]
#[test]
fn a_tool_that_proves_falsehoods_is_refused() {
    use std::os::unix::fs::PermissionsExt;
    // The second and third print all assertions that they find in the C, as CBMC does.
    const LISTED: &str = "n=0; f=0; echo '** Results:'\n\
        for s in $(grep -ho '__CPROVER_assert(.*);' *.c *.h | sed 's/.*\"\\(.*\\)\".*/\\1/; s/ /~/g'); do n=$((n+1))\n\
        echo \"[x.assertion.$n] line 1 $(echo $s | tr '~' ' '): RESULT\"; done\n";
    let all_hold = LISTED.replace("RESULT", "SUCCESS");
    let all_fail = LISTED.replace("RESULT", "FAILURE");
    for (fake, tasks) in [
        ("echo 'VERIFICATION SUCCESSFUL'".to_owned(), &["prove", "validate", "certify"][..]),
        ("echo 'VERIFICATION SUCCESSFUL'; exit 10".to_owned(), &["prove", "validate"]),
        ("echo 'VERIFICATION FAILED'".to_owned(), &["prove", "validate"]),
        ("echo 'VERIFICATION FAILED'; exit 10".to_owned(), &["prove", "validate"]),
        (
            format!(
                "{all_hold}echo \"** 0 of $n failed (1 iterations)\"\necho 'VERIFICATION SUCCESSFUL'"
            ),
            &["prove", "validate", "certify"],
        ),
        (
            format!(
                "{all_fail}echo \"** $n of $n failed (1 iterations)\"\necho 'VERIFICATION FAILED'; exit 10"
            ),
            &["prove"],
        ),
    ] {
        let folder = folder("properties { p: never(on); };");
        let script = folder.path().join("cbmc");
        let text =
            format!("#!/bin/bash\nif [ \"$1\" = --version ]; then echo 6.6.0; exit; fi\n{fake}\n");
        std::fs::write(&script, text).unwrap();
        std::fs::set_permissions(&script, PermissionsExt::from_mode(0o755)).unwrap();
        std::fs::create_dir(folder.path().join("out")).unwrap();
        for task in tasks {
            let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
            command.args([task, "a.conf", "-q", "-o", "out", "--cbmc", "./cbmc"]);
            let output = command.current_dir(folder.path()).output().unwrap();
            let text = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(3), "{task}: {fake}: {text}");
            assert!(output.stdout.is_empty(), "{task}: {fake}: {text}");
            assert!(
                text.contains("cannot be trusted") || text.contains("nothing is certified"),
                "{task}: {fake}: {text}"
            );
            assert!(!folder.path().join("out/index.html").exists());
        }
    }
}

/// The environment may call `init()` and `clear()` at any time.
#[test]
fn the_environment_may_clear() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    // After clear() the initial goal runs again, with the beliefs as they are.
    let text = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };\n\
        basics { void on(void); void off(void); };\n\
        types { go(void); rest(void); first(void); }; triggerables { +!go; };\n\
        properties { again: only_after(on, +!go); answered: within(2, +!go, off); };\n";
    let agent = "first.\n!rest.\n+!rest : first <- -first.\n+!rest <- on.\n+!go <- off.\n";
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.conf"), text).unwrap();
    std::fs::write(folder.path().join("a.asl"), agent).unwrap();
    let output = asl2c(folder.path(), &cbmc, &[]);
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{said}{}", String::from_utf8_lossy(&output.stderr));
    assert!(said.contains("drops all events: clear()"), "{said}");
    // What is dropped is not due any more, for `run` as for the proof.
    assert!(said.contains("answered: holds"), "{said}");
}

#[test]
fn what_only_the_environment_knows_is_undecided() {
    let folder = folder("");
    let text = CONFIGURATION.replace("level(int32_t)", "level(handle_t)").replace("read", "rest");
    std::fs::write(folder.path().join("a.conf"), text).unwrap();
    std::fs::write(folder.path().join("a.asl"), "+!light : level(_) <- on.\n+!light.\n").unwrap();
    let text = complaint(&asl2c(folder.path(), Path::new("no-such-cbmc"), &[]));
    assert!(text.contains("cannot create arbitrary values"), "{text}");
}

/// Each of the waiting beliefs is one more round of the step's loop; the C includes a header of its own.
#[test]
fn longer_inboxes_and_own_headers_are_proved() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let text = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; inbox = 3; };\n\
        includes { #include <stdbool.h>\n#include <stdint.h>\n#include \"own.h\" };\n\
        basics { void on(void); }; types { light(void); level(int32_t); };\n\
        triggerables { +!light; +level; -level; };\nproperties { p: at_most_one(on); };\n";
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in
        [("a.conf", text), ("a.asl", "+!light : level(_) <- on.\n+!light.\n"), ("own.h", "\n")]
    {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let output = asl2c(folder.path(), &cbmc, &[]);
    let text = String::from_utf8_lossy(&output.stdout);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{text}{said}");
    assert!(text.contains("no error at run time: holds"), "{text}");
}

#[test]
fn each_end_has_its_status() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let one = "properties { p [R-1]: at_most_one(on); };";
    let none = "properties { p: never(on); };";
    for (sections, options, status, expected) in [
        ("", &[][..], 0, "no error at run time: holds"),
        (one, &[], 0, "p [R-1]: holds in every environment"),
        (one, &["--quiet"], 0, ""),
        (
            none,
            &[],
            1,
            "p: DOES NOT HOLD\n  never(on)\n  counterexample (a.asl):\n    the environment raises +!light\n",
        ),
        (none, &["--length", "1"], 3, "p: NOT DECIDED"),
        (none, &["--time", "0"], 3, "p: NOT DECIDED"),
    ] {
        let folder = folder(sections);
        let output = asl2c(folder.path(), &cbmc, options);
        let text = String::from_utf8_lossy(&output.stdout);
        assert_eq!(
            output.status.code(),
            Some(status),
            "{text}{}",
            String::from_utf8_lossy(&output.stderr)
        );
        assert!(text.contains(expected), "{text}");
        assert_eq!(folder.path().join("a.p.script").exists(), status == 1);
    }
}
