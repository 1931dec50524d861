//! The case holds, and what is wrong with one is seen.

use super::*;

fn mistakes_of(text: &str) -> String {
    let mistakes = mistakes(&Page::parse(text)).unwrap();
    mistakes.into_iter().map(|(line, mistake)| format!("{line}: {mistake}\n")).collect()
}

const TEST: &str = "xtask case::tests::the_case_holds_and_is_drawn";

fn small() -> String {
    format!(
        "- **G1** All is well.\n  - **C1** Here.\n  - **S1** By parts.\n    - see G2\n\n\
         - **G2** A part.\n  - **E1** test `{TEST}`: it\n    is.\n\
         \x20 - **E2** proof `one_command`: it is.\n  - **A1** So be it. *Experiment:* [look](x.md).\n"
    )
}

#[test]
fn the_case_holds_and_is_drawn() {
    let (text, good) = run(&Arguments { check: true, ran: None, proved: None }).unwrap();
    assert!(good, "{text}");
}

#[test]
fn what_is_wrong_with_a_case_is_seen() {
    assert_eq!(mistakes_of(&small()), "");
    for (from, to, expected) in [
        ("holds_and_is_drawn", "holds", "7: there is no `xtask case::tests::the_case_holds`"),
        ("test `xtask case", "test `autopilot case", "7: there is no"),
        (TEST, "system-tests/system browser::the_picture_of_the_page", "is ignored"),
        (TEST, "xtask case::tests::small", "is no test"),
        ("proof `one_command`", "proof `two_commands`", "9: `two_commands` is not proved"),
        (
            "proof `one_command`",
            "run `cargo xtask campaign`",
            "does not run `cargo xtask campaign`",
        ),
        ("proof `one_command`:", "hope:", "9: E2 is no evidence"),
        ("    - see G2\n", "", "3: nothing supports S1"),
        ("    - see G2\n", "    - see G3\n", "3: there is no G3"),
        ("    - see G2\n", "    - see G2, G1\n", "G1 supports itself"),
        ("  - **S1** By parts.\n    - see G2\n", "", "1: G1 has what does not belong below it"),
        ("**E2**", "**E1**", "9: E1 is there twice"),
        ("*Experiment:* [look](x.md)", "", "10: A1 lacks its experiment"),
        ("So be it. ", "", ""),
        ("- **G2** A part", "- A part", "neither a node nor a reference"),
    ] {
        let text = small().replace(from, to);
        assert_ne!(text, small(), "{from}");
        let mistakes = mistakes_of(&text);
        assert!(mistakes.contains(expected), "{from} {to}: {mistakes}");
    }
}

#[test]
fn what_did_not_run_is_seen() {
    let log = "     Running unittests src/main.rs (target/debug/deps/xtask-0123abc)\n\n\
               test case::tests::the_case_holds_and_is_drawn ... ok\n\
               \x20  Doc-tests translator\n";
    let proofs = "The shipped agent, in every environment\n  one_command    model: holds     C: proved\n\
                  Mutants\n  x\n";
    let unseen = |log: &str, proofs: &str| {
        let page = Page::parse(&small());
        not_seen(&page, Some(log), Some(proofs))
            .unwrap()
            .into_iter()
            .map(|(line, _)| line)
            .collect()
    };
    assert_eq!(unseen(log, proofs), Vec::<usize>::new());
    for (from, to) in [
        ("drawn ... ok", "drawn ... FAILED"),
        ("drawn ... ok", "drawn ... ignored, slow"),
        ("test case", "test "),
        ("/xtask-", "/pid-"),
    ] {
        assert_eq!(unseen(&log.replace(from, to), proofs), [7], "{to}");
    }
    for (from, to) in [("C: proved", "C: not proved"), ("holds", "FAILS"), ("one_", "a_")] {
        assert_eq!(unseen(log, &proofs.replace(from, to)), [9], "{to}");
    }
    // The same name in two binaries that have the same name, too.
    let suites = "Running unittests src/lib.rs (deps/asl2c-1)\nRunning tests/suite/main.rs (deps/suite-2)\ntest a ... ok\n\
                  Running unittests src/lib.rs (deps/translator-1)\nRunning tests/suite/main.rs (deps/suite-3)\ntest a ... ok\n\
                  Doc-tests translator\ntest a ... ok\nRunning tests/network/main.rs (deps/network-4)\ntest a ... ok\n";
    let ran = ran::tests(suites, &sources_of(&workspace()).unwrap());
    let names: Vec<&str> = ran.keys().map(String::as_str).collect();
    assert_eq!(names, ["ardrone-pilot/network a", "asl2c/suite a", "translator/suite a"]);
}
