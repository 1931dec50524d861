//! A program that is asked to end while it proves leaves no CBMC behind, and says that nothing is proved.

use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use crate::harness::skip;

const LIFT: &str = "../translator/agents/lift.conf";

/// A stand-in for CBMC that proves nothing for a minute, and writes down its process.
fn slow_cbmc(folder: &Path) -> PathBuf {
    let path = folder.join("cbmc");
    let script = format!(
        "#!/bin/sh\nif [ \"$1\" = --version ]; then echo 6.0.0; exit; fi\necho $$ >>{}/started\nexec sleep 60\n",
        folder.display()
    );
    std::fs::write(&path, script).unwrap();
    std::fs::set_permissions(&path, PermissionsExt::from_mode(0o755)).unwrap();
    path
}

/// What was printed.
fn shown(output: &Output) -> String {
    [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text)).concat()
}

/// Sends a signal to a task as soon as a proof runs; `None` if a tool is missing.
fn stopped(task: &str, signal: &str, folder: &Path) -> Option<Output> {
    let slow = slow_cbmc(folder);
    let started = folder.join("started");
    std::fs::create_dir_all(folder.join("out")).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    command.args([task, LIFT, "-o"]).arg(folder.join("out")).arg("--cbmc").arg(slow);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    while !std::fs::read_to_string(&started).is_ok_and(|text| text.ends_with('\n')) {
        if child.try_wait().unwrap().is_some() {
            let text = shown(&child.wait_with_output().unwrap());
            assert!(text.contains("nothing is certified"), "{text}");
            return None;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    let (signal, process) = (format!("-{signal}"), child.id().to_string());
    assert!(Command::new("kill").args([signal, process]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    for process in std::fs::read_to_string(&started).unwrap().lines() {
        assert!(!Path::new(&format!("/proc/{process}")).exists(), "{process} is left");
    }
    Some(output)
}

#[test]
fn a_stop_leaves_no_cbmc_behind() {
    for (task, said) in [
        ("validate", "10 of 10 proofs were not finished before the stop"),
        ("prove", "nothing is proved: stopped"),
        ("certify", "nothing is proved: stopped"),
    ] {
        for signal in ["INT", "TERM"] {
            let folder = tempfile::tempdir().unwrap();
            let Some(output) = stopped(task, signal, folder.path()) else {
                skip("cppcheck, Frama-C, gcc or valgrind");
                continue;
            };
            let text = shown(&output);
            assert_eq!(output.status.code(), Some(3), "{task}: {text}");
            assert!(text.contains(said), "{task}: {text}");
            assert_eq!(std::fs::read_dir(folder.path().join("out")).unwrap().count(), 0, "{task}");
        }
    }
}
