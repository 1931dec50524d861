//! Files that lie in the folder of an agent, or of its C, take the place of no header, in whatever is judged or executed.

use std::path::Path;
use std::process::{Command, Output};

use crate::harness::{cbmc, skip};

const AGENT: &str = "+!light : level(X) & X > 3 <- on.\n+!light <- off.\n";

/// A folder with an agent that includes these headers, and these files beside it.
fn folder(includes: &str, files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let configuration = format!(
        "settings {{ input = a.asl; output = a.c; header = a.h; basics = b.h; }};\n\
         includes {{ {includes} }};\nbasics {{ void on(void); void off(void); }};\n\
         types {{ light(void); level(int32_t); }};\nsettables {{ level; }}; triggerables {{ +!light; }};\n\
         properties {{ p: at_most_one(on); }};\n"
    );
    for (name, text) in files.iter().chain(&[("a.conf", configuration.as_str()), ("a.asl", AGENT)])
    {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    folder
}

fn asl2c(folder: &Path, arguments: &[&str], cbmc: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    command.args(arguments).arg("--cbmc").arg(cbmc).current_dir(folder);
    command.output().unwrap()
}

fn said(output: &Output) -> String {
    [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text)).concat()
}

/// The agent's C with a change, in a folder of its own. Returns its path.
fn edited(folder: &Path, from: &str, to: &str) -> String {
    std::fs::create_dir(folder.join("edited")).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    let output = command.args(["a.conf", "-o", "edited"]).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let c = std::fs::read_to_string(folder.join("edited/a.c")).unwrap();
    assert!(c.contains(from), "{from}");
    std::fs::write(folder.join("edited/a.c"), c.replacen(from, to, 1)).unwrap();
    "edited/a.c".to_owned()
}

/// Each of these headers makes a wrong number right, if it is taken for that of the compiler.
#[test]
fn what_lies_in_the_folder_is_no_header_of_the_compiler() {
    const TRUTH: &str = "#define bool _Bool\n#define true 1\n#define false 1\n";
    const NUMBERS: &str = "#include_next <stdint.h>\n#undef UINT32_MAX\n#define UINT32_MAX 0U\n\
        #define __CPROVER_assert(condition, said) ((void)0)\n";
    const LIBRARY: &str = "#define __CPROVER_assert(condition, said) ((void)0)\n";
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let planted = [
        ("stdbool.h", TRUTH),
        ("stdint.h", NUMBERS),
        ("string.h", LIBRARY),
        ("bits/types.h", LIBRARY),
        ("features.h", LIBRARY),
        ("comparison.c", "#error planted\n"),
        ("cbmc", "#error planted\n"),
    ];
    let folder = folder("#include <stdint.h> #include <stdbool.h> #include <string.h>", &planted);
    // The same headers beside the edited C, whose folder is not the agent's.
    let c = edited(folder.path(), "        on();", "        off();");
    for (name, text) in planted {
        let path = folder.path().join("edited").join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    for arguments in [&["validate", "-q", "a.conf"][..], &["prove", "-q", "a.conf"]] {
        let output = asl2c(folder.path(), arguments, &cbmc);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", said(&output));
    }
    let output = asl2c(folder.path(), &["validate", "-q", "a.conf", "--c", &c], &cbmc);
    assert_ne!(output.status.code(), Some(0), "{}", said(&output));
    let output = asl2c(folder.path(), &["certify", "a.conf", "-o", "out"], &cbmc);
    assert!(said(&output).contains("C and text    shown"), "{}", said(&output));
    let mut report = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    let output = report
        .args(["-q", "--report", "a.conf", "-o", "edited", "--force"])
        .current_dir(folder.path());
    let said = said(&output.output().unwrap());
    assert!(!said.contains("was not measured"), "{said}");
}

/// Headers of an agent's own are read; none of them may be taken for one of the compiler, mean something else by what is
/// generated, or bring in what lies elsewhere.
#[test]
fn own_headers_change_nothing_else() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let elsewhere = tempfile::tempdir().unwrap();
    let foreign = elsewhere.path().join("foreign.h");
    std::fs::write(&foreign, "typedef int foreign_t;\n").unwrap();
    let absolute = format!("#include \"{}\"\n", foreign.display());
    let above =
        format!("#include \"../{}/foreign.h\"\n", elsewhere.path().file_name().unwrap().display());
    let computed = format!("#define WHERE \"{}\"\n#include WHERE\n", foreign.display());
    let named = "is included, which is neither";
    for (includes, files, expected) in [
        (
            "#include \"own.h\"",
            &[
                ("own.h", "#include \"sub/more.h\"\n"),
                (
                    "sub/more.h",
                    "#ifndef __MORE_H__\n#define __MORE_H__\n#include \"own.h\"\n#endif\n",
                ),
            ][..],
            None,
        ),
        ("#include <own.h>", &[("own.h", "typedef int own_t;\n")], None),
        ("#include \"stdint.h\"", &[], None),
        (
            "#include \"own.h\"",
            &[("own.h", "#include \"a.h\"\n"), ("a.h", "#error planted\n")],
            Some("a.h, line 1, differs"),
        ),
        (
            "#include \"stdint.h\"",
            &[("stdint.h", "typedef int int32_t;\n")],
            Some("has the name of <stdint.h>"),
        ),
        (
            "#include \"sub/own.h\"",
            &[("sub/own.h", "#include \"stdint.h\"\n"), ("sub/stdint.h", "\n")],
            Some("has the name of <stdint.h>"),
        ),
        (
            "#include \"own.h\"",
            &[("own.h", "#define __CPROVER_assert(condition, said) ((void)0)\n")],
            Some("a macro `__CPROVER_assert`"),
        ),
        (
            "#include \"own.h\"",
            &[(
                "own.h",
                "#ifdef __CPROVER__\n#define plain_assert(condition, said) ((void)0)\n#endif\n",
            )],
            Some("a macro `plain_assert`"),
        ),
        (
            "#include \"own.h\"",
            &[("own.h", "#define plain_index(index, length) (index)\n")],
            Some("a macro `plain_index`"),
        ),
        ("#include \"own.h\"", &[("own.h", "#define _Bool int\n")], Some("a macro `_Bool`")),
        ("#include \"own.h\"", &[("own.h", "#define while(x) if (0)\n")], Some("a macro `while`")),
        ("#include \"own.h\"", &[("own.h", absolute.as_str())], Some(named)),
        ("#include \"own.h\"", &[("own.h", above.as_str())], Some(named)),
        ("#include \"own.h\"", &[("own.h", computed.as_str())], Some(named)),
        (absolute.trim(), &[], Some(named)),
    ] {
        let folder = folder(includes, files);
        let output = asl2c(folder.path(), &["validate", "-q", "a.conf"], &cbmc);
        let said = said(&output);
        let status = if expected.is_some() { 3 } else { 0 };
        assert_eq!(output.status.code(), Some(status), "{includes} {files:?}: {said}");
        assert!(expected.is_none_or(|part| said.contains(part)), "{includes} {files:?}: {said}");
    }
}
