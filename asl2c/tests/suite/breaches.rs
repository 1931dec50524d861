//! Ways by which wrong C was called right, or a file was lost, as somebody found them who only had the program.

use std::path::Path;
use std::process::{Command, Output};
use std::time::Duration;

use asl2c::{Agent, Cbmc, Plan, prove, validate};

use crate::harness::{cbmc, skip};

const AGENT: &str =
    "see(1.0).\n+!go : see(S) & S > 1.0 <- b.\n+!go : val(V) <- d(V).\n+!go <- a.\n";

/// A folder with an agent that includes these lines, and its C in `a.c`.
fn agent(includes: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let configuration = format!(
        "settings {{ input = a.asl; output = a.c; header = a.h; basics = actions.h; }};\n\
         includes {{ #include <stdbool.h>\n#include <stdint.h>\n{includes} }};\n\
         basics {{ void a(void); void b(void); void d(double); }};\n\
         types {{ go(void); see(float); val(double); }};\nsettables {{ see; val; }};\ntriggerables {{ +!go; }};\n\
         properties {{ p: at_most_one(a); }};\n"
    );
    std::fs::write(folder.path().join("a.conf"), configuration).unwrap();
    std::fs::write(folder.path().join("a.asl"), AGENT).unwrap();
    asl2c(folder.path(), &["-q", "a.conf"]);
    folder
}

fn asl2c(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    let Output { status, stdout, stderr } =
        command.args(arguments).current_dir(folder).output().unwrap();
    (
        status.code(),
        [stdout, stderr].map(|said| String::from_utf8_lossy(&said).into_owned()).concat(),
    )
}

/// What is said of the agent's C after a change.
fn validated(cbmc: &Path, from: &str, to: &str) -> (Option<i32>, String) {
    let folder = agent("");
    let c = std::fs::read_to_string(folder.path().join("a.c")).unwrap();
    assert!(c.contains(from), "{from}");
    std::fs::write(folder.path().join("edited.c"), c.replacen(from, to, 1)).unwrap();
    let cbmc = cbmc.to_str().unwrap();
    asl2c(folder.path(), &["validate", "-q", "--cbmc", cbmc, "a.conf", "--c", "edited.c"])
}

/// A number that CBMC rounds to another one than compilers, and a NaN with another sign.
#[test]
fn numbers_are_what_compilers_make_of_them() {
    let Some(cbmc) = cbmc() else { return skip("cbmc") };
    let hair = format!("1.000000059604644775390625{}1F", "0".repeat(90));
    for (from, to, expected) in [
        ("belief_see_1 = 1.0F;", format!("belief_see_1 = {hair};"), Some(1)),
        (
            "belief_see_1 = 1.0F;",
            "belief_see_1 = 1.0000000596046447753906249999F;".to_owned(),
            Some(0),
        ),
        (
            "        d(var_V);",
            "        if (var_V <= var_V) { d(var_V); } else { d(-var_V); }".to_owned(),
            Some(1),
        ),
        (
            "        d(var_V);",
            "        if (var_V <= var_V) { d(var_V); } else { d(0.0 / 0.0); }".to_owned(),
            Some(1),
        ),
        (
            "        d(var_V);",
            "        if (var_V <= var_V) { d(-(-var_V)); } else { d(var_V); }".to_owned(),
            Some(0),
        ),
    ] {
        let (status, said) = validated(&cbmc, from, &to);
        assert_eq!(status, expected, "{to}: {said}");
    }
}

/// CBMC reads the shortest constant of each number as that number.
#[test]
fn cbmc_reads_the_shortest_constants_exactly() {
    use std::fmt::Write as _;
    let Some(cbmc) = cbmc() else { return skip("cbmc") };
    let folder = tempfile::tempdir().unwrap();
    let mut checks = String::new();
    let mut state = 1_u64;
    let mut random = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        state ^ (state >> 31)
    };
    let ends = [
        1_u64,
        0x000f_ffff_ffff_ffff,
        0x0010_0000_0000_0000,
        0x7fef_ffff_ffff_ffff,
        0x3ff0_0000_0000_0001,
    ];
    let doubles: Vec<f64> =
        ends.into_iter().chain((0..300).map(|_| random())).map(f64::from_bits).collect();
    for value in doubles.into_iter().filter(|value| value.is_finite()) {
        _ = writeln!(checks, "    check64({value:?}, {}ULL);", value.to_bits());
    }
    let ends = [1_u32, 0x007f_ffff, 0x0080_0000, 0x7f7f_ffff, 0x3f80_0001];
    let floats =
        ends.into_iter().chain((0..300).map(|_| (random() >> 32) as u32)).map(f32::from_bits);
    for value in floats.filter(|value| value.is_finite()) {
        _ = writeln!(checks, "    check32({value:?}F, {}U);", value.to_bits());
    }
    let c = format!(
        "typedef unsigned long long u64;\n\
         static void check64(double value, u64 bits) {{ union {{ double value; u64 bits; }} x; x.value = value; \
         __CPROVER_assert(x.bits == bits, \"64\"); }}\n\
         static void check32(float value, unsigned bits) {{ union {{ float value; unsigned bits; }} x; x.value = value; \
         __CPROVER_assert(x.bits == bits, \"32\"); }}\n\
         int main(void)\n{{\n{checks}    return 0;\n}}\n"
    );
    std::fs::write(folder.path().join("a.c"), c).unwrap();
    let output = Command::new(cbmc).arg("a.c").current_dir(folder.path()).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stdout));
}

/// A header that is another one for a model checker, and one that changes what the agent's functions are.
#[test]
fn own_headers_are_judged_by_all_who_judge() {
    let Some(cbmc) = cbmc() else { return skip("cbmc") };
    let cbmc = cbmc.to_str().unwrap();
    let folder = agent("#include \"own.h\"\n");
    for (header, expected) in [
        ("#ifndef __CPROVER__\n#define a b\n#endif\n", "own.h"),
        ("#define a b\n", "own.h defines a macro `a`"),
        ("\nvoid a(void) __asm__(\"b\");\n", "own.h, line 2, column 14: `__asm__`"),
        ("#ifdef __GNUC__\n#endif\n", "own.h, line 1, column 1: `#ifdef __GNUC__`"),
    ] {
        std::fs::write(folder.path().join("own.h"), header).unwrap();
        for task in [&["validate", "-q"][..], &["prove", "-q"], &["certify", "-q", "-o", "out"]] {
            let (status, said) =
                asl2c(folder.path(), &[task, &["--cbmc", cbmc, "a.conf"]].concat());
            assert_eq!(status, Some(3), "{header} {task:?}: {said}");
            assert!(said.contains(expected), "{header} {task:?}: {said}");
        }
    }
    std::fs::write(folder.path().join("own.h"), "enum { UP };\n").unwrap();
    let (status, said) = asl2c(folder.path(), &["validate", "-q", "--cbmc", cbmc, "a.conf"]);
    assert!(status == Some(3) && said.contains("own.h line 1"), "{said}");
    assert!(said.contains("guard"), "{said}");
}

/// CBMC itself checks an array in a struct behind a pointer against the end of the struct, and the C of all proofs has one.
#[test]
fn an_index_is_inside_its_array_and_not_only_inside_the_state() {
    let Some(cbmc) = cbmc() else { return skip("cbmc") };
    let cbmc = Cbmc::find(Some(&cbmc)).unwrap();
    let folder = agent("");
    let path = folder.path().join("a.conf");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replace("basics = ", "instance = context; basics = ")).unwrap();
    let Agent { configuration, text, .. } = Agent::read(&path).unwrap();
    // The inbox has room for one event, and is not the end of the state.
    let read = |index: &str| {
        format!(
            "    const uint32_t place = {index}U;\n    const a_event_t seen = self->inbox_queue[place];\n\n    (void)seen;\n"
        )
    };
    let begin = "take_event(a_agent_t *self)\n{\n";
    for (index, is_inside) in [("0", true), ("1", false)] {
        let spoilt = |c: &str| {
            assert!(c.contains(begin), "{c}");
            c.replacen(begin, &format!("{begin}{}", read(index)), 1)
        };
        let proofs = tempfile::tempdir().unwrap();
        let mut compared = translator::comparison(&configuration, &text).unwrap();
        let c = spoilt(&compared.files[0].text);
        judged_c::judge(&compared, &c, []).unwrap().put_into(&mut compared);
        let validated = validate(&compared, &cbmc, proofs.path(), Duration::from_mins(1)).unwrap();
        assert_eq!(validated.is_proved(), is_inside, "{validated:?}");
        let said = |said: &str| said.contains("an index is outside its array");
        assert!(is_inside || validated.open.iter().any(|open| said(&open.said)), "{validated:?}");

        let proofs = tempfile::tempdir().unwrap();
        let mut obligations = translator::obligations(&configuration, &text).unwrap();
        obligations.files[0].text = spoilt(&obligations.files[0].text);
        let proof = prove(&obligations, &cbmc, proofs.path(), &Plan::ALL).unwrap();
        assert_eq!(proof.holds(), is_inside, "{proof:?}");
        assert!(is_inside || proof.run_time.iter().all(|found| said(found)), "{proof:?}");
    }
}

/// All files below a folder, and their texts.
fn files(folder: &Path) -> Vec<(std::path::PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.push((path.clone(), std::fs::read(path).unwrap()));
        }
    }
    found.sort();
    found
}

/// A list in the form of the tool's own, which anybody can make, with other people's files.
#[test]
fn a_forged_list_loses_no_file() {
    use sha2::{Digest as _, Sha256};
    let sum = |text: &[u8]| {
        Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect::<String>()
    };
    for (place, listed) in [
        (".", "a.conf"),
        (".", "a.asl"),
        (".", "actions.h"),
        ("agent", "agent/a.asl"),
        ("agent", "agent/a.conf"),
        ("c", "c/own.h"),
        ("c", "c/main.c"),
        ("tests", "tests/main.c"),
        ("tests/own", "tests/own/mine.transcript"),
        ("agent", "agent/../agent/a.asl"),
    ] {
        let made = agent("#include \"own.h\"\n");
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join(place);
        std::fs::create_dir_all(&place).unwrap();
        for (path, text) in files(made.path()) {
            std::fs::write(place.join(path.file_name().unwrap()), text).unwrap();
        }
        for (name, text) in
            [("main.c", "int main;\n"), ("own.h", ""), ("mine.transcript", "> next_step();\n")]
        {
            std::fs::write(place.join(name), text).unwrap();
        }
        let text = std::fs::read(folder.path().join(listed)).unwrap();
        let list = format!("{}  {listed}\n", sum(&text));
        let list = format!("{list}# asl2c wrote this: sha256 {}\n", sum(list.as_bytes()));
        std::fs::write(folder.path().join("SHA256SUMS"), list).unwrap();
        let before = files(folder.path());
        let configuration = place.join("a.conf");
        let mut arguments = vec!["certify", configuration.to_str().unwrap(), "-o", "."];
        let tests = place.to_str().unwrap().to_owned();
        if listed.starts_with("tests") {
            arguments.extend(["--tests", &tests]);
        }
        let (status, said) = asl2c(folder.path(), &arguments);
        assert_eq!(status, Some(3), "{listed}: {said}");
        assert!(said.contains("is listed"), "{listed}: {said}");
        assert!(files(folder.path()) == before, "{listed}: {said}");
    }
}

/// Nothing is worked at whose result would be lost, or that never ends.
#[test]
fn what_cannot_end_well_is_told_at_once() {
    let folder = agent("");
    std::fs::write(folder.path().join("taken"), "").unwrap();
    for (task, output) in [("validate", "taken"), ("prove", "taken"), ("prove", "taken/below")] {
        let (status, said) =
            asl2c(folder.path(), &[task, "a.conf", "-o", output, "--cbmc", "/none"]);
        assert_eq!(status, Some(3), "{said}");
        assert!(said.contains(&format!("cannot write {output}")), "{said}");
    }
    #[cfg(target_os = "linux")]
    for arguments in [&["validate", "a.conf", "--c", "/dev/zero"][..], &["/dev/zero"]] {
        let (_, said) = asl2c(folder.path(), arguments);
        assert!(said.contains("more than 16 MB"), "{said}");
    }
}

/// What CBMC finds by itself is no difference, and said to be an error.
#[test]
fn an_error_at_run_time_is_said_to_be_one() {
    let Some(cbmc) = cbmc() else { return skip("cbmc") };
    let bump = "        d(var_V);\n        if (var_V > 1.0) { int32_t x = 2147483646; x++; x++; (void)x; }";
    let (status, said) = validated(&cbmc, "        d(var_V);", bump);
    assert_ne!(status, Some(0), "{said}");
    assert!(said.contains("a possible error at run time"), "{said}");
}
