//! The case holds, and what is wrong with one is seen.

use super::*;

const TEST: &str = "xtask case::tests::the_case_holds_and_is_drawn";
const CASE: &str = "- **G1** All is well.\n  - **C1** Here.\n  - **S1** By parts.\n    - see G2\n\n\
    - **G2** A part.\n  - **E1** test `xtask case::tests::the_case_holds_and_is_drawn`: it\n    is.\n\
    \x20 - **E2** proof `one_command`: it is.\n  - **A1** So be it. *Experiment:* [look](x.md).\n";
const LOG: &str = "     Running unittests src/main.rs (target/debug/deps/xtask-0123abc)\n\n\
    test case::tests::the_case_holds_and_is_drawn ... ok\n   Doc-tests translator\n";

fn mistakes_of(page: &str, log: Option<&str>) -> String {
    let (_, mistakes) = checked(page, log).unwrap();
    let lines = mistakes.into_iter().map(|(line, mistake)| format!("{line}: {mistake}\n"));
    lines.collect::<Vec<_>>().concat()
}

#[test]
fn the_case_holds_and_is_drawn() {
    let (nodes, mistakes) = checked(&read(&root().join(PAGE)).unwrap(), None).unwrap();
    assert_eq!(mistakes, []);
    let drawn = read(&root().join(DRAWING)).unwrap();
    assert!(drawn == drawing::draw(&nodes), "run `cargo xtask case`, and look at {DRAWING}");
}

#[test]
fn what_is_wrong_with_a_case_is_seen() {
    assert_eq!(mistakes_of(CASE, Some(LOG)), "");
    for (from, to, expected) in [
        (
            "holds_and_is_drawn",
            "holds",
            "7: `xtask case::tests::the_case_holds` is not in the sources",
        ),
        ("test `xtask case", "test `autopilot case", "is not in the sources"),
        (TEST, "system-tests/system browser::the_picture_of_the_page", "is ignored"),
        (TEST, "xtask case::tests::mistakes_of", "is no test"),
        ("proof `one_command`", "proof `two_commands`", "9: `two_commands` is not proved"),
        ("proof `one_command`", "run `cargo xtask streams`", "does not run `cargo xtask streams`"),
        ("proof `one_command`:", "hope:", "9: neither a node nor a reference"),
        ("- **G2** A part", "- A part", "neither a node nor a reference"),
        ("    - see G2\n", "", "3: S1 is not supported"),
        ("    - see G2\n", "", "5: G2 supports nothing"),
        ("see G2", "see G3", "3: there is no G3 behind S1"),
        ("see G2", "see G2, G1", "3: there is no G1 behind S1"),
        ("  - **E2**", "    - **E2**", "7: E1 cannot have anything below it"),
        ("**E2**", "**E1**", "9: E1 is there twice"),
        ("*Experiment:* [look](x.md)", "", "10: A1 lacks its experiment"),
    ] {
        let mistakes = mistakes_of(&CASE.replace(from, to), None);
        assert!(mistakes.contains(expected), "{from} {to}: {mistakes}");
    }
}

#[test]
fn a_test_that_did_not_run_or_failed_is_seen() {
    for (from, to, says) in [
        ("drawn ... ok", "drawn ... FAILED", "FAILED"),
        ("drawn ... ok", "drawn ... ignored, it is slow", "ignored, it is slow"),
        ("test case", "test ", "nothing"),
        ("/xtask-", "/pid-", "nothing"),
    ] {
        let expected = format!("7: of `{TEST}` the output says {says}\n");
        assert_eq!(mistakes_of(CASE, Some(&LOG.replace(from, to))), expected);
    }
    let log = "Running unittests src/lib.rs (deps/asl2c-1)\nRunning tests/suite/main.rs (deps/suite-2)\ntest a ... ok\n\
        Running unittests src/lib.rs (deps/translator-1)\nRunning tests/suite/main.rs (deps/suite-3)\ntest a ... ok\n\
        Doc-tests translator\ntest b ... ok\nRunning tests/network/main.rs (deps/network-4)\ntest a ... ok\n";
    let results = sources::results(log, &sources::packages(&root()).unwrap());
    let names: Vec<&str> = results.keys().map(String::as_str).collect();
    assert_eq!(names, ["ardrone-pilot/network a", "asl2c/suite a", "translator/suite a"]);
}
