//! A verdict is one about the files that lie where people compile them, or there is none.

use std::path::Path;
use std::process::{Command, Output};

use crate::harness::{cbmc, skip};

const AGENT: &str = "+!light : level(X) & X > 3 <- on.\n+!light <- off.\n";

/// A folder with an agent whose files are in folders, and those as they are written now, below `agent`. Beside them are the
/// C again, with other headers, below `edited`.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let agent = folder.path().join("agent");
    std::fs::create_dir_all(agent.join("inc")).unwrap();
    let configuration = "settings { input = a.asl; output = src/a.c; header = inc/a.h; basics = inc/b.h; };\n\
         includes { #include <stdint.h>\n#include <stdbool.h>\n#include \"own.h\"\n };\n\
         basics { void on(void); void off(void); };\n\
         types { light(void); level(int32_t); };\nsettables { level; }; triggerables { +!light; };\n\
         properties { p: at_most_one(on); };\n";
    std::fs::write(agent.join("a.conf"), configuration).unwrap();
    std::fs::write(agent.join("a.asl"), AGENT).unwrap();
    let own = "#ifndef OWN_H\n#define OWN_H\n#include \"more.h\"\n#endif\n";
    std::fs::write(agent.join("inc/own.h"), own).unwrap();
    let more = "#ifndef MORE_H\n#define MORE_H\ntypedef int more_t;\n#endif\n";
    std::fs::write(agent.join("inc/more.h"), more).unwrap();
    std::fs::create_dir(agent.join("src")).unwrap();
    let output = asl2c(folder.path(), &["-q", "agent/a.conf"], None);
    assert!(output.status.success(), "{}", said(&output));
    for name in ["src/a.c", "inc/a.h", "inc/b.h", "inc/own.h", "inc/more.h"] {
        let to = folder.path().join("edited").join(name);
        std::fs::create_dir_all(to.parent().unwrap()).unwrap();
        std::fs::copy(agent.join(name), to).unwrap();
    }
    folder
}

fn asl2c(folder: &Path, arguments: &[&str], cbmc: Option<&Path>) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    command.args(arguments).current_dir(folder);
    if let Some(cbmc) = cbmc {
        command.arg("--cbmc").arg(cbmc);
    }
    command.output().unwrap()
}

/// What is printed, with paths as they are without `..`.
fn said(output: &Output) -> String {
    let said = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text)).concat();
    said.replace("src/../", "")
}

/// With a line more in one of the files: no proof is begun, also of what would be proved.
#[test]
fn a_verdict_is_about_the_files_that_lie_there() {
    // Nothing is proved, so that there need not be a CBMC.
    let none = Path::new("/none");
    let plain = [
        &["validate", "-q", "agent/a.conf"][..],
        &["prove", "-q", "agent/a.conf"],
        &["certify", "-q", "agent/a.conf", "-o", "out"],
    ];
    let with_c = &["validate", "-q", "agent/a.conf", "--c", "edited/src/a.c"][..];
    let in_place = &["validate", "-q", "agent/a.conf", "--c", "agent/src/a.c"][..];
    let elsewhere = [
        &["validate", "-q", "agent/a.conf", "-o", "edited"][..],
        &["prove", "-q", "agent/a.conf", "-o", "edited"],
    ];
    let of_c = [&plain[..], &elsewhere].concat();
    let of_header = [&of_c[..], &[with_c, in_place]].concat();
    let of_edited = [&elsewhere[..], &[with_c]].concat();
    for (file, refused, not_refused) in [
        ("agent/src/a.c", &of_c, &[with_c, in_place][..]),
        ("agent/inc/a.h", &of_header, &[]),
        ("agent/inc/b.h", &of_header, &[]),
        ("edited/inc/a.h", &of_edited, &plain),
        ("edited/inc/b.h", &of_edited, &plain),
        ("edited/inc/own.h", &of_edited, &plain),
        ("edited/inc/more.h", &of_edited, &plain),
        ("edited/src/a.c", &elsewhere.to_vec(), &[plain[0], plain[1], plain[2], with_c, in_place]),
    ] {
        let folder = folder();
        let path = folder.path().join(file);
        let text = std::fs::read_to_string(&path).unwrap();
        let (first, rest) = text.split_once('\n').unwrap();
        std::fs::write(&path, format!("{first}\n/* changed */\n{rest}")).unwrap();
        for (arguments, stale) in refused
            .iter()
            .map(|arguments| (arguments, true))
            .chain(not_refused.iter().map(|arguments| (arguments, false)))
        {
            let output = asl2c(folder.path(), arguments, Some(none));
            let said = said(&output);
            assert_eq!(output.status.code(), Some(3), "{arguments:?}: {said}");
            // Otherwise it is that there is no CBMC.
            let expected = if stale { format!("{file}, line 2, differs") } else { "/none".into() };
            assert!(said.contains(&expected), "{file} {arguments:?}: {said}");
        }
    }
}

/// An agent that was changed since its C was written, as often happens; and what else may lie in a file's place.
#[test]
fn an_old_translation_is_told() {
    let none = Some(Path::new("/none"));
    let folder = folder();
    let agent = folder.path().join("agent/a.asl");
    std::fs::write(&agent, AGENT.replace("> 3", "> 4")).unwrap();
    let validate = ["validate", "agent/a.conf", "--message-format", "json"];
    let output = asl2c(folder.path(), &validate, none);
    assert_eq!(output.status.code(), Some(3));
    let json: serde_json::Value = serde_json::from_slice(&output.stderr).unwrap();
    assert_eq!((&json["code"], &json["file"]), (&"stale".into(), &"agent/src/a.c".into()));
    assert!(json["message"].as_str().unwrap().contains("write it anew by `asl2c agent/a.conf`"));
    assert!(asl2c(folder.path(), &["-q", "agent/a.conf"], None).status.success());
    let is_current = || said(&asl2c(folder.path(), &validate, none)).contains("/none");
    assert!(is_current());
    // Build scripts write it without the last line.
    let c = folder.path().join("agent/src/a.c");
    let text = std::fs::read_to_string(&c).unwrap();
    let (plain, _) = text.trim_end().rsplit_once('\n').unwrap();
    std::fs::write(&c, format!("{plain}\n")).unwrap();
    assert!(is_current());
    std::fs::write(&c, plain).unwrap();
    assert!(!is_current());
    std::fs::remove_file(&c).unwrap();
    assert!(is_current());
    std::fs::create_dir(&c).unwrap();
    let output = asl2c(folder.path(), &validate, none);
    assert!(said(&output).contains("it is not a regular file"), "{}", said(&output));
    std::fs::remove_dir(&c).unwrap();
    // What cannot be looked at may be there.
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("a.c", &c).unwrap();
        let output = asl2c(folder.path(), &validate, none);
        assert!(said(&output).contains("cannot read agent/src/a.c"), "{}", said(&output));
        std::fs::remove_file(&c).unwrap();
    }
    // There is no file below what is no folder.
    let scripts = folder.path().join("scripts");
    std::fs::create_dir(&scripts).unwrap();
    std::fs::write(scripts.join("src"), "").unwrap();
    let elsewhere = [&validate[..], &["-o", "scripts"]].concat();
    assert!(said(&asl2c(folder.path(), &elsewhere, none)).contains("/none"));
}

/// A header that is the compiler's for whatever is proved, and another one beside the C.
#[test]
fn no_header_lies_beside_the_c_alone() {
    let folder = folder();
    std::fs::write(folder.path().join("edited/inc/stdint.h"), "typedef int int32_t;\n").unwrap();
    let validate = ["validate", "agent/a.conf", "--c", "edited/src/a.c"];
    let output = asl2c(folder.path(), &validate, Some(Path::new("/none")));
    let said = said(&output);
    assert!(said.contains("edited/inc/stdint.h, line 1, differs from the compiler's"), "{said}");
}

/// What is as it is written now is proved.
#[test]
fn files_as_they_are_written_are_proved() {
    let Some(cbmc) = cbmc() else { return skip("cbmc") };
    let folder = folder();
    for arguments in [
        &["validate", "-q", "agent/a.conf"][..],
        &["validate", "-q", "agent/a.conf", "--c", "edited/src/a.c", "-o", "edited"],
        &["prove", "-q", "agent/a.conf"],
    ] {
        let output = asl2c(folder.path(), arguments, Some(&cbmc));
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", said(&output));
    }
}
