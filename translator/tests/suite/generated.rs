//! What the generated text looks like, and that compilers accept it.

use proptest::prelude::*;
use translator::{parse_configuration, translate};

use crate::harness::Case;

const LAMP: Case = Case {
    basics: "void switchOn(double); bool isDark(void);",
    types: "light(double); level(double); wait(void);",
    sections: "settables { level; }; triggerables { +!light; }; preemptive { +!light; };",
    agent: "// A lamp.\n!wait.\n+!wait <- !!wait.\n+!light(Level) : isDark & not level(Level)\n  <- switchOn(Level); +level(Level).\n-!light(_) <- true.\n",
};

#[test]
fn a_whole_agent_as_c_and_rust() {
    let static_form = LAMP.translate("").unwrap();
    insta::assert_snapshot!("lamp_static_source", static_form.files[0].text);
    insta::assert_snapshot!("lamp_static_header", static_form.files[1].text);
    let context = LAMP.translate("instance = context; rust = lamp.rs;").unwrap();
    insta::assert_snapshot!("lamp_context_header", context.files[1].text);
    insta::assert_snapshot!("lamp_context_actions", context.files[2].text);
    insta::assert_snapshot!("lamp_bindings", context.files[3].text);
    LAMP.compile();
}

#[test]
fn the_autopilot_passes_strict_compilation() {
    let configuration = include_str!("../../../autopilot/agent/autopilot.conf");
    let agent = include_str!("../../../autopilot/agent/autopilot.asl");
    let folder = tempfile::tempdir().unwrap();
    let parsed = parse_configuration("autopilot.conf", configuration).unwrap();
    let translation = translate(parsed, agent).unwrap();
    assert_eq!(translation.warnings, "");
    for file in &translation.files {
        std::fs::write(folder.path().join(&file.name), &file.text).unwrap();
    }
    let result = std::process::Command::new("gcc")
        .current_dir(folder.path())
        .args(crate::harness::STRICT)
        .args(["-c", "autopilot.c"])
        .output()
        .unwrap();
    assert!(result.status.success(), "{}", String::from_utf8_lossy(&result.stderr));
}

proptest! {
    #[test]
    fn any_text_is_translated_or_refused(agent in "\\PC{0,200}", configuration in "\\PC{0,200}") {
        let _ = parse_configuration("agent.conf", &configuration);
        let fixed = parse_configuration("lamp.conf", &LAMP.configuration("")).unwrap();
        let _ = translate(fixed, &agent);
    }

    #[test]
    fn any_words_of_the_language_are_translated_or_refused(
        words in proptest::collection::vec(
            prop_oneof![
                Just("+!light(X)"), Just("+!"), Just("-"), Just("wait"), Just("level(X)"),
                Just("light(1)"), Just(":"), Just("<-"), Just("."), Just(";"), Just("&"),
                Just("not"), Just("true"), Just("isDark"), Just("switchOn(X)"), Just("X ="),
                Just("!!"), Just("?"), Just("("), Just(")"), Just("_"), Just("\"t\""), Just("-0.5"),
            ],
            0..30,
        )
    ) {
        let fixed = parse_configuration("lamp.conf", &LAMP.configuration("")).unwrap();
        let _ = translate(fixed, &words.join(" "));
    }
}
