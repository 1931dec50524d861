//! What is of the language, what is not, and that nothing is lost in between.
#![forbid(unsafe_code)]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod cases;

use judged_c::{Refused, Rule, judge};
use translator::{Comparison, comparison, parse_configuration};

const LAMP: &str = "settings { input = a.asl; output = lamp.c; header = lamp.h; basics = b.h; };
    structs { place_t { double x; int8_t y; }; };
    basics { void on(void); void say(const char *); int now(void); void at(place_t); void hear(uint32_t *); void keep(handle_t *); };
    types { light(void); level(uint8_t); }; triggerables { +!light; }; settables { level; };";

fn lamp() -> Comparison {
    let configuration = parse_configuration("a.conf", LAMP).unwrap();
    comparison(&configuration, "+!light : level(L) & L < 3 <- on; say(\"exit # \\\\ ? \").")
        .unwrap()
}

/// The C with something outside of functions, and something in one.
fn with(top: &str, inside: &str) -> String {
    let c = lamp().files[0].text.clone();
    let (before, after) = c.split_once("void next_step(void)\n{\n").unwrap();
    format!("{before}{top}\nvoid next_step(void)\n{{\n{inside}\n{after}")
}

fn judged(c: &str, headers: &[&str]) -> Result<String, Refused> {
    judge(&lamp(), c, headers.iter().copied()).map(|judged| judged.text().to_owned())
}

/// Words without comments and blanks.
fn words(text: &str) -> String {
    let parts = text.split("/*").enumerate().map(|(index, part)| match part.split_once("*/") {
        Some((_, behind)) if index > 0 => behind,
        _ => part,
    });
    parts.flat_map(str::split_whitespace).collect::<Vec<_>>().join(" ")
}

#[test]
fn the_gallery_is_printed_as_it_is() {
    for name in [
        "paper",
        "lift",
        "traffic_light",
        "infusion",
        "rover",
        "inspection",
        "../../autopilot/agent/autopilot",
    ] {
        let path = format!("../translator/agents/{name}");
        let configuration = std::fs::read_to_string(format!("{path}.conf")).unwrap();
        let text = std::fs::read_to_string(format!("{path}.asl")).unwrap();
        let configuration = parse_configuration("a.conf", &configuration).unwrap();
        let compared = comparison(&configuration, &text).unwrap();
        let c = &compared.files[0].text;
        let judged = judge(&compared, c, []).unwrap_or_else(|refused| panic!("{name}: {refused}"));
        assert_eq!(words(c), words(judged.text()), "{name}");
        assert_eq!(judged.arbitrary(), "");
    }
}

#[test]
fn what_is_not_of_the_language_is_refused() {
    let begin = with("", "").lines().take_while(|line| !line.starts_with("void next_step")).count();
    let mut wrong = Vec::new();
    for (rule, top, inside) in cases::REFUSED {
        let found = judged(&with(top, inside), &[]);
        let is_it = |refused: &Refused| {
            let same = std::mem::discriminant(&refused.rule) == std::mem::discriminant(rule);
            same && refused.line as usize >= begin
        };
        if !found.as_ref().is_err_and(is_it) {
            wrong.push(format!("{rule:?}: {top} {inside}: {:?}", found.map(|_| ())));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Rules about the file as a whole, and about headers.
#[test]
fn what_is_missing_or_a_macro_is_refused() {
    let c = with("", "");
    let without = |text: &str| {
        assert!(c.contains(text), "{text}");
        judged(&c.replacen(text, "", 1), &[]).unwrap_err().rule
    };
    assert_eq!(without("#include \"b.h\"\n"), Rule::Includes);
    assert_eq!(without("static agent_t agent;\n"), Rule::Undeclared);
    let clear = &c[c.find("void clear(").unwrap()..];
    assert_eq!(without(&clear[..clear.find("\n}\n").unwrap() + 3]), Rule::Missing);
    let other = |from: &str, to: &str| {
        assert!(c.contains(from), "{from}");
        judged(&c.replacen(from, to, 1), &[]).unwrap_err().rule
    };
    let state = "static agent_t agent;\n";
    assert_eq!(other(state, "static agent_t agent = { 0 };\n"), Rule::State);
    assert_eq!(other(state, "static const agent_t agent = { 0 };\n"), Rule::State);
    let line = "#include \"b.h\"\n";
    assert_eq!(other(line, "#include <stdlib.h>\n"), Rule::Preprocessor);
    assert_eq!(other(line, "#include \"b.h\"\n#include <errno.h>\n"), Rule::Preprocessor);
    let later = c.replacen(line, "", 1).replacen("void init(", &format!("{line}void init("), 1);
    assert_eq!(judged(&later, &[]).unwrap_err().rule, Rule::Preprocessor);
    let begin = c.find("typedef enum").unwrap();
    let typed = &c[begin..begin + c[begin..].find(";\n").unwrap() + 2];
    assert_eq!(without(typed), Rule::Types);
    assert_eq!(other(typed, &format!("{typed}{typed}")), Rule::Typedef);
    let empty = "bool achieve_light(void) { return true; }\nbool can_add_event(void) { return true; }\n\
        void clear(void) { }\nvoid init(void) { }\nvoid next_step(void) { }\n\
        uint32_t refused_events(void) { return 0U; }\nvoid set_level(uint8_t x) { (void)x; }\n\
        uint32_t unhandled_events(void) { return 0U; }\n";
    let empty = format!("{}{empty}", &c[..c.find("static outcome_t ").unwrap()]);
    assert_eq!(judged(&empty, &[]).map(|_| ()), Ok(()));
    assert_eq!(judged(&empty.replacen(state, "", 1), &[]).unwrap_err().rule, Rule::State);
    let field =
        c.replacen("    uint32_t unhandled;\n", "    uint32_t unhandled;\n    uint32_t more;\n", 1);
    assert_eq!(judged(&field, &[]).unwrap_err().rule, Rule::Typedef);
    let other = c.replace("bool can_add_event(void)", "uint32_t can_add_event(void)");
    assert_eq!(judged(&other, &[]).unwrap_err().rule, Rule::Signature);
    assert_eq!(judged("/* x", &[]).unwrap_err().rule, Rule::Open);
    for header in [
        "#define agent bye",
        "#define on() exit(0)",
        "#if 0\n# /* x */ define /* y */ handled exit(0)\n#endif",
        "#def\\\nine if while",
        "#def??/\nine UINT32_MAX 3U",
        "#def\\ \t\nine agent bye",
        "%:define outcome_t int",
        "#define/**/EVENT_NONE 3",
        "static const char *x = \"/*\";\n#define/* */agent x\n/* */",
    ] {
        assert_eq!(judged(&c, &[header]).unwrap_err().rule, Rule::Macro, "{header}");
    }
    assert_eq!(judged(&c, &["#define OTHER agent\ntypedef int own_t;\n"]).map(|_| ()), Ok(()));
}

#[test]
fn what_people_write_is_of_the_language() {
    for (top, inside) in [
        ("// exit(0) #", ""),
        ("static void own(void) { if (agent.unhandled > 0) return; else on(); }", "own();"),
        (
            "static const double x = -1.5e-3;",
            "if ((x < 1.0) || !(x > 0.0)) { say(\"a\\\"\\\\\\n\\t\\?\\377\"); }",
        ),
        ("static place_t x = { 1.0, -3 };", "x.y = 4; at(x);"),
        (
            "static bool own(const place_t *of) { return of->x > 1.0; }",
            "const place_t x = { 0 }; if (own(&x)) { on(); }",
        ),
        (
            "",
            "const int32_t x = now(); switch (x) { case -1: case 2: on(); break; default: break; }",
        ),
        ("", "for (uint32_t i = 0U; (i < 3U) && (agent.unhandled == 0U); i++) { on(); }"),
        ("", "const int32_t x = - -1; (void)x;"),
        ("static handle_t *kept = { 0 };", "keep(kept);"),
        (
            "static void first(void) { static uint32_t own = 0U; own++; }\n\
             static bool second(bool own) { return own; }",
            "first(); (void)second(true);",
        ),
        ("static bool own(void) { { return true; } }", "(void)own();"),
        ("", "const int64_t x = 5000000000LL; const uint8_t y = 255U; if (x > y) { on(); }"),
    ] {
        let c = with(top, inside);
        let printed = judged(&c, &[]).unwrap_or_else(|refused| panic!("{top} {inside}: {refused}"));
        // What is printed is of the language, and stays as it is.
        assert_eq!(words(&judged(&printed, &[]).unwrap()), words(&printed));
    }
}

#[test]
fn state_is_printed_outside_of_functions_and_is_arbitrary() {
    let c = with(
        "static bool kept = true;\nstatic const bool FIXED = true;\nstatic place_t next_step_own = { 1.0, 1 };",
        "static uint32_t own[2] = { 1U, 2U }; own[0]++; (void)FIXED; (void)kept; (void)next_step_own;",
    );
    let judged = judge(&lamp(), &c, []).unwrap();
    assert!(
        judged
            .text()
            .contains("\nstatic uint32_t next_step_own_[2] = { 1U, 2U };\nvoid next_step(void)\n")
    );
    assert!(judged.text().contains("next_step_own_[0]++;"), "{}", judged.text());
    for part in [
        "next_step_own_[0] = any",
        "next_step_own_[1] = any",
        "kept = any",
        "next_step_own.x = any",
        "next_step_own.y = any",
    ] {
        assert!(judged.arbitrary().contains(part), "{}", judged.arbitrary());
    }
    assert!(!judged.arbitrary().contains("FIXED") && !judged.arbitrary().contains("agent"));
    let mut compared = lamp();
    judged.put_into(&mut compared);
    let text = &compared.files.last().unwrap().text;
    assert!(
        text.contains("next_step_own_[1] = any")
            && text.contains("#ifdef next_step\n#error")
            && text.contains("#ifdef if\n#error"),
        "{text}"
    );
}

#[test]
fn no_text_is_too_deep() {
    let many = |text: &str| text.repeat(20_000);
    for inside in [
        format!("(void){}1;", many("(")),
        format!("(void){}1;", many("- ")),
        format!("(void)({}1);", many("1 + ")),
        format!("{} on();", many("{")),
        format!("{} on();", many("if (true) ")),
        format!("on({}1);", many("on(")),
        format!("place_t x = {}1;", many("{ ")),
        format!("(void)agent{};", many(".x")),
        format!("(void)agent{}", many("[1")),
        format!("(void){}1;", many("(int32_t)")),
        many("switch (1) { default: "),
    ] {
        let refused = judged(&with("", &inside), &[]).unwrap_err();
        assert_eq!(refused.rule, Rule::Depth, "{}: {refused}", &inside[..20]);
    }
    let arms = |count| format!("if (false) {{ }} {}", "else if (true) { on(); } ".repeat(count));
    assert!(judged(&with("", &arms(400)), &[]).is_ok());
    assert_eq!(judged(&with("", &arms(20_000)), &[]).unwrap_err().rule, Rule::Depth);
    let chain = |count: u32| {
        let calls =
            (1..count).map(|own| format!("static void own{own}(void) {{ own{}(); }}\n", own - 1));
        "static void own0(void) { on(); }\n".to_owned() + &calls.collect::<String>()
    };
    assert!(judged(&with(&chain(150), ""), &[]).is_ok());
    let refused = judged(&with(&chain(20_000), ""), &[]).unwrap_err();
    assert_eq!((refused.rule, refused.found.as_str()), (Rule::Calls, "own200"));
}

#[test]
fn what_people_may_write_instead_is_said() {
    for (top, inside, advice) in [
        ("#define LIMIT 3", "", "static const int32_t limit = 3;"),
        ("#include <stddef.h>", "", "static const int32_t limit = 3;"),
        ("enum { LIMIT = 3 };", "", "static const int32_t limit = 3;"),
        ("static inline void own(void) { on(); }", "", "leave the word out"),
        ("", "uint32_t x = 0U; ++x;", "`count++;`"),
    ] {
        let refused = judged(&with(top, inside), &[]).unwrap_err().to_string();
        assert!(refused.contains(advice), "{refused}");
    }
}
