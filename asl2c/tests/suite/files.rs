//! Files that `asl2c` writes, and files that it must not touch.

use std::path::Path;
use std::process::{Command, Output};

const AGENT: &str = "+!light <- on.\n";
/// A file as this program leaves it; it has no lines before the last.
const OLD: &str = "/* asl2c wrote this: sha256 e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855 */\n";

fn configuration(settings: &str) -> String {
    format!(
        "settings {{ {settings} }};\nbasics {{ void on(void); }};\ntypes {{ light(void); }};\ntriggerables {{ +!light; }};\n"
    )
}

fn folder(settings: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.conf"), configuration(settings)).unwrap();
    std::fs::write(folder.path().join("a.asl"), AGENT).unwrap();
    folder
}

fn asl2c(folder: &Path, options: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_asl2c"))
        .args(options)
        .arg("a.conf")
        .current_dir(folder)
        .output()
        .unwrap()
}

/// All files of a folder with their texts.
fn contents(folder: &Path) -> Vec<(String, String)> {
    let mut contents: Vec<(String, String)> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap())
        .map(|entry| {
            (
                entry.file_name().into_string().unwrap(),
                std::fs::read_to_string(entry.path()).unwrap_or_default(),
            )
        })
        .collect();
    contents.sort();
    contents
}

#[track_caller]
fn refused(folder: &Path, options: &[&str], expected: &[&str]) {
    let before = contents(folder);
    let output = asl2c(folder, options);
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{text}");
    for part in expected {
        assert!(text.contains(part), "{text}");
    }
    assert_eq!(contents(folder), before, "{text}");
}

#[test]
fn what_is_read_is_not_overwritten() {
    for (settings, setting) in [
        ("input = a.asl; output = a.asl; header = a.h; basics = b.h;", "a.conf:1:36"),
        ("input = a.asl; output = a.c; header = a.conf; basics = b.h;", "a.conf:1:50"),
        ("input = ./a.asl; output = a.asl; header = a.h; basics = b.h;", "a.conf:1:38"),
        ("input = a.asl; output = link.c; header = a.h; basics = b.h;", "a.conf:1:36"),
        ("input = a.asl; output = a.c; header = hard.h; basics = b.h;", "a.conf:1:50"),
        (
            "input = a.asl; output = a.c; header = a.h; basics = b.h; instance = context; rust = a.asl;",
            "a.conf:1:96",
        ),
    ] {
        let folder = folder(settings);
        #[cfg(unix)]
        std::os::unix::fs::symlink("a.asl", folder.path().join("link.c")).unwrap();
        std::fs::hard_link(folder.path().join("a.conf"), folder.path().join("hard.h")).unwrap();
        refused(folder.path(), &[], &[setting, "which is translated"]);
    }
    let folder = folder("input = a.asl; output = a.c; header = a.h; basics = b.h; matrix = a;");
    std::fs::hard_link(folder.path().join("a.asl"), folder.path().join("a.csv")).unwrap();
    refused(folder.path(), &["-o", "."], &["a.conf:1:78", "which is translated"]);
}

#[test]
fn links_between_outputs_are_noticed() {
    let folder = folder("input = a.asl; output = a.c; header = a.h; basics = b.h;");
    std::fs::write(folder.path().join("a.h"), "old").unwrap();
    std::fs::hard_link(folder.path().join("a.h"), folder.path().join("b.h")).unwrap();
    refused(folder.path(), &[], &["a.conf:1:64", "which is written too"]);
}

/// A user's header that is included by the generated ones is not overwritten.
#[test]
fn what_is_included_is_not_overwritten() {
    let settings = "input = a.asl; output = a.c; header = user.h; basics = b.h;";
    let link = "input = a.asl; output = a.c; header = a.h; basics = hard.h;";
    let inner = "input = a.asl; output = a.c; header = gen/user.h; basics = b.h;";
    for (settings, include, at) in [
        (settings, "\"user.h\"", "a.conf:1:50"),
        (settings, "<user.h>", "a.conf:1:50"),
        (settings, "\"./x/../user.h\"", "a.conf:1:50"),
        (link, "\"user.h\"", "a.conf:1:64"),
        (inner, "\"user.h\"", "a.conf:1:50"),
        (inner, "\"gen/user.h\"", "a.conf:1:50"),
    ] {
        let place = folder(settings);
        let path = place.path().join("a.conf");
        let text = format!("{}includes {{ #include {include}\n}};", configuration(settings));
        std::fs::write(&path, text).unwrap();
        std::fs::create_dir(place.path().join("gen")).unwrap();
        std::fs::write(place.path().join("user.h"), "mine").unwrap();
        std::fs::hard_link(place.path().join("user.h"), place.path().join("hard.h")).unwrap();
        refused(place.path(), &[], &[at, "which is included"]);
    }
}

/// Outputs that do not exist yet are identified by their folder.
#[cfg(unix)]
#[test]
fn links_between_folders_are_noticed() {
    use std::os::unix::fs::symlink;

    let place = folder("input = a.asl; output = x/a.c; header = y/a.c; basics = b.h;");
    std::fs::create_dir(place.path().join("x")).unwrap();
    symlink("x", place.path().join("y")).unwrap();
    refused(place.path(), &[], &["a.conf:1:52", "which is written too"]);
    assert_eq!(contents(&place.path().join("x")), []);

    for (settings, at) in [
        ("input = a.asl; output = out/a.c; header = a.h; basics = b.h;", "out"),
        ("input = a.asl; output = a.c; header = file.h; basics = b.h;", "file.h"),
    ] {
        let (place, other) = (folder(settings), tempfile::tempdir().unwrap());
        symlink(other.path(), place.path().join("out")).unwrap();
        std::fs::write(other.path().join("file.h"), "mine").unwrap();
        symlink(other.path().join("file.h"), place.path().join("file.h")).unwrap();
        let link = at;
        refused(place.path(), &[], &[link, "is a link"]);
        refused(place.path(), &["--force"], &[link, "is a link"]);
        assert_eq!(contents(other.path()), [("file.h".to_owned(), "mine".to_owned())]);
    }
    // The folder that is asked for may be one.
    let place = folder("input = a.asl; output = a.c; header = a.h; basics = b.h;");
    std::fs::create_dir(place.path().join("x")).unwrap();
    symlink("x", place.path().join("y")).unwrap();
    assert!(asl2c(place.path(), &["-o", "y"]).status.success());
    // A link to nothing.
    symlink("nothing", place.path().join("a.c")).unwrap();
    refused(place.path(), &[], &["a.c is a link"]);
}

#[test]
fn all_is_written_or_nothing() {
    let files = "input = a.asl; output = a.c; header = a.h; basics = b.h; matrix = m;";
    let old = |folder: &Path| {
        for name in ["a.c", "a.h"] {
            std::fs::write(folder.join(name), OLD).unwrap();
        }
    };
    // One cannot be written: a folder has its name, or its folder is missing.
    let place = folder(files);
    old(place.path());
    std::fs::create_dir(place.path().join("m.json")).unwrap();
    refused(place.path(), &[], &["m.json", "nothing is changed"]);
    let place = folder(&files.replace("b.h", "sub/b.h"));
    old(place.path());
    refused(place.path(), &[], &["sub/b.h", "nothing is changed"]);
    // One must not be written.
    let place = folder(files);
    old(place.path());
    std::fs::write(place.path().join("b.h"), OLD).unwrap();
    let mut permissions = std::fs::metadata(place.path().join("b.h")).unwrap().permissions();
    permissions.set_readonly(true);
    std::fs::set_permissions(place.path().join("b.h"), permissions).unwrap();
    refused(place.path(), &[], &["b.h", "nothing is changed"]);
}

/// A file size limit: as on a full disk, writing fails in the middle.
#[cfg(unix)]
#[test]
fn a_full_disk_changes_nothing() {
    let place = folder("input = a.asl; output = a.c; header = a.h; basics = b.h;");
    for name in ["a.c", "a.h", "b.h"] {
        std::fs::write(place.path().join(name), OLD).unwrap();
    }
    let before = contents(place.path());
    let command =
        format!("trap '' XFSZ; ulimit -f 1; exec '{}' a.conf", env!("CARGO_BIN_EXE_asl2c"));
    let output =
        Command::new("sh").args(["-c", &command]).current_dir(place.path()).output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("a.c") && text.contains("nothing is changed"), "{text}");
    assert_eq!(contents(place.path()), before);
}

#[test]
fn beside_an_error_only_warnings_that_are_asked_for_are_printed() {
    let place = folder("input = a.asl; output = a.c; header = a.h; basics = b.h; rust = r.rs;");
    std::fs::write(place.path().join("a.asl"), AGENT.repeat(2)).unwrap();
    for (options, warns) in [
        (&[][..], true),
        (&["-q"], false),
        (&["-A", "all"], false),
        (&["-A", "never-tried"], false),
        (&["-A", "never-asked"], true),
        // A denied warning is an error, and printed as one.
        (&["-q", "-D", "never-tried"], false),
    ] {
        let output = asl2c(place.path(), options);
        let text = String::from_utf8_lossy(&output.stderr);
        assert!(text.contains("Rust bindings need the agent's state"), "{text}");
        assert_eq!(text.contains("warning"), warns, "{options:?}: {text}");
        let is_told = warns || options.contains(&"-D");
        assert_eq!(text.contains("a.asl:2:"), is_told, "{options:?}: {text}");
    }
}

#[test]
fn only_what_was_generated_and_is_unchanged_is_replaced() {
    let place = folder("input = a.asl; output = a.c; header = a.h; basics = b.h; matrix = m;");
    let path = |name: &str| place.path().join(name);
    let append = |name: &str| {
        let text = std::fs::read_to_string(path(name)).unwrap();
        std::fs::write(path(name), text + "\n").unwrap();
    };
    let translate = |options: &[&str]| {
        let output = asl2c(place.path(), options);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    translate(&[]);
    // A changed agent changes all files, the matrix too.
    std::fs::write(path("a.asl"), "// one\n+!light <- on; on.\n").unwrap();
    let before = contents(place.path());
    translate(&[]);
    assert_ne!(contents(place.path()), before);
    for name in ["a.c", "a.h", "b.h", "m.csv", "m.json"] {
        append(name);
        refused(place.path(), &[], &[name, "somebody else wrote or changed it", "--force"]);
        translate(&["--force"]);
        translate(&[]);
    }
    std::fs::write(path("a.c"), "int mine;\n").unwrap();
    refused(place.path(), &["-q"], &["a.c", "nothing is changed"]);
    // What is in the way is told, and not waited for.
    std::fs::remove_file(path("a.c")).unwrap();
    #[cfg(unix)]
    {
        assert!(Command::new("mkfifo").arg(path("a.c")).status().unwrap().success());
        let output = asl2c(place.path(), &["--force"]);
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{text}");
        assert!(text.contains("a.c") && text.contains("not a regular file"), "{text}");
    }
}

/// A counterexample is not written over the agent, through a link, or over somebody's script.
#[test]
fn scripts_replace_only_scripts() {
    let Some(cbmc) = crate::harness::cbmc() else {
        crate::harness::skip("cbmc");
        return;
    };
    let settings = "output = a.c; header = a.h; basics = b.h;";
    let cbmc = cbmc.to_str().unwrap();
    let prove = |folder: &Path| asl2c(folder, &["prove", "--cbmc", cbmc]);
    let place = |input: &str| {
        let place = tempfile::tempdir().unwrap();
        let text = configuration(&format!("input = {input}; {settings}"));
        let text = format!("{text}properties {{ p: never(on); }};\n");
        std::fs::write(place.path().join("a.conf"), text).unwrap();
        std::fs::write(place.path().join(input), AGENT).unwrap();
        place
    };
    let own = place("a.p.script");
    let output = prove(own.path());
    assert_eq!(output.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&output.stderr).contains("is not as asl2c left it"));
    assert_eq!(std::fs::read_to_string(own.path().join("a.p.script")).unwrap(), AGENT);
    let usual = place("a.asl");
    for _ in 0..2 {
        assert_eq!(prove(usual.path()).status.code(), Some(1));
    }
    assert!(asl2c(usual.path(), &["run", "--script", "a.p.script"]).status.code() == Some(1));
    #[cfg(unix)]
    {
        let script = usual.path().join("a.p.script");
        std::fs::remove_file(&script).unwrap();
        std::os::unix::fs::symlink("nothing", &script).unwrap();
        assert_eq!(prove(usual.path()).status.code(), Some(3));
        assert!(!usual.path().join("nothing").exists());
    }
    let validated = place("a.differs.script");
    let output = asl2c(validated.path(), &["validate", "-q", "--cbmc", cbmc]);
    assert_eq!(output.status.code(), Some(3));
    assert_eq!(std::fs::read_to_string(validated.path().join("a.differs.script")).unwrap(), AGENT);
}

#[cfg(unix)]
#[test]
fn a_report_that_cannot_be_printed_is_an_error() {
    let place = folder("input = a.asl; output = a.c; header = a.h; basics = b.h;");
    for (options, status) in [(&["--report"][..], 1), (&["verify", "--model"], 3)] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
        command.args(options).arg("a.conf").current_dir(place.path()).stdout(full);
        let output = command.output().unwrap();
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{text}");
        assert!(text.contains("cannot print"), "{text}");
    }
}

/// Printing help to a closed pipe is not a success, and an agent that could not be announced is removed.
#[cfg(unix)]
#[test]
fn what_cannot_be_said_is_not_done() {
    let place = tempfile::tempdir().unwrap();
    for options in [&["--help"][..], &["--version"], &["verify", "--help"], &["new", "pilot"]] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
        let output = command.args(options).current_dir(place.path()).stdout(full).output().unwrap();
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{options:?} {text}");
        assert!(text.starts_with("error: cannot print"), "{text}");
        assert_eq!(contents(place.path()), []);
    }
    let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    let output = command.args(["new", "pilot"]).current_dir(place.path()).output().unwrap();
    assert!(output.status.success() && place.path().join("pilot/Makefile").exists());
}

/// Outputs in folders include each other correctly, and are measured like others.
#[test]
fn outputs_may_be_in_folders() {
    for instance in ["static", "context"] {
        let place = folder(&format!(
            "input = a.asl; output = gen/a.c; header = include/a.h; basics = b.h; instance = {instance};"
        ));
        for name in ["gen", "include"] {
            std::fs::create_dir(place.path().join(name)).unwrap();
        }
        let output = asl2c(place.path(), &["--report"]);
        let text = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && !text.contains("cannot write"), "{text}");
        let mut compile = Command::new("cc");
        compile.args(["-std=c99", "-Wall", "-Werror", "-c", "gen/a.c"]).current_dir(place.path());
        let output = compile.output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

#[test]
fn without_properties_nothing_is_verified() {
    let place = folder("input = a.asl; output = a.c; header = a.h; basics = b.h;");
    let output = asl2c(place.path(), &["verify"]);
    assert_eq!(output.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&output.stderr).contains("has no properties"));
}

/// Each level of goals doubles the calls of a step: what cannot be counted or measured is said, and waited for only so long.
#[test]
fn a_step_too_long_to_be_measured_is_told() {
    use std::fmt::Write as _;
    const LEVELS: usize = 70;
    let place = tempfile::tempdir().unwrap();
    let mut agent = format!("+!light <- !g1.\n+!g{} <- on.\n", LEVELS + 1);
    let mut types = String::new();
    for level in 1..=LEVELS {
        writeln!(agent, "+!g{level} <- !g{0}; !g{0}.", level + 1).unwrap();
        write!(types, "g{level}(void); ").unwrap();
    }
    let text = configuration("input = a.asl; output = a.c; header = a.h; basics = b.h;");
    let types = format!("light(void); {types}g{}(void);", LEVELS + 1);
    std::fs::write(place.path().join("a.conf"), text.replace("light(void);", &types)).unwrap();
    std::fs::write(place.path().join("a.asl"), agent).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    command.args(["-q", "--report", "a.conf"]);
    let output = command.current_dir(place.path()).output().unwrap();
    let report = String::from_utf8_lossy(&output.stdout);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(report.contains("18446744073709551615 or more"), "{report}");
    // Without valgrind nothing is measured anyway.
    assert!(said.contains("did not end") || said.contains("cannot be run"), "{said}");
}
