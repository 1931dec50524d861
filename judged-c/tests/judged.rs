//! What is of the language, what is not, and that nothing is lost in between.
#![forbid(unsafe_code)]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use judged_c::{Refused, Rule, judge};
use translator::{Comparison, comparison, parse_configuration};

const LAMP: &str = "settings { input = a.asl; output = lamp.c; header = lamp.h; basics = b.h; };
    structs { place_t { double x; int8_t y; }; };
    basics { void on(void); void say(const char *); int now(void); void at(place_t); void hear(uint32_t *); };
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

/// A rule, and C that only it refuses.
type Case = (Rule, &'static str, &'static str);

#[rustfmt::skip]
const REFUSED: &[Case] = &[
    (Rule::Character, "static uint32_t ä = 0U;", ""),
    (Rule::Character, "/* \u{202e} */", ""),
    (Rule::LineEnd, "", "on();\r"),
    (Rule::Trigraph, "// why ??/", ""),
    (Rule::Trigraph, "", "say(\"??<\");"),
    (Rule::Digraph, "", "<% on(); %>"),
    (Rule::Digraph, "%:define x", ""),
    (Rule::Comment, "/* *\\\n/", ""),
    (Rule::Comment, "/* a \\ b */", ""),
    (Rule::Comment, "// a \\ b", ""),
    (Rule::Comment, "// /* x", ""),
    (Rule::Open, "static const char *const x = \"abc", ""),
    (Rule::Preprocessor, "#define x", ""),
    (Rule::Escape, "", "say(\"\\x41\");"),
    (Rule::Escape, "", "say(\"\\477\");"),
    (Rule::Number, "", "(void)010;"),
    (Rule::Number, "", "(void)0x10U;"),
    (Rule::Number, "", "(void)1L;"),
    (Rule::Number, "", "(void)4294967296U;"),
    (Rule::Number, "", "(void)(2147483647 + 1);"),
    (Rule::Number, "", "(void)1e999;"),
    (Rule::Expected(""), "", "(on)();"),
    (Rule::Expected(""), "static volatile int x = 0;", ""),
    (Rule::Undeclared, "", "asm(\"hlt\");"),
    (Rule::Expected(""), "", "asm volatile (\"hlt\");"),
    (Rule::Type, "static long x = 0;", ""),
    (Rule::Type, "static union x y = 0;", ""),
    (Rule::Type, "static void x = 0;", ""),
    (Rule::Type, "static void own(void x, bool y) { (void)y; }", ""),
    (Rule::Typedef, "typedef enum { A } own_t;", ""),
    (Rule::Array, "", "int32_t x[2] = { 1, 2 };"),
    (Rule::Array, "static int32_t x[2000] = { 0 };", ""),
    (Rule::Pointer, "static uint32_t *x = 0;", ""),
    (Rule::Initial, "static uint32_t x;", ""),
    (Rule::Initial, "", "uint32_t x;"),
    (Rule::Constant, "static int32_t x = now();", ""),
    (Rule::Undeclared, "", "exit(0);"),
    (Rule::Undeclared, "", "agent.other = 1U;"),
    (Rule::Declared, "static bool on(void) { return true; }", ""),
    (Rule::Declared, "", "uint32_t agent = 0U;"),
    (Rule::Declared, "", "{ static uint32_t x = 0U; x++; } { uint32_t x = 0U; x++; }"),
    (Rule::Reserved, "static void puts(void) { }", ""),
    (Rule::Reserved, "static uint32_t __x = 0U;", ""),
    (Rule::Comparison, "static uint32_t plain_made = 0U;", ""),
    (Rule::Static, "void own(void) { }", ""),
    (Rule::Static, "uint32_t own = 0U;", ""),
    (Rule::Signature, "static void own(void);\nstatic void own(bool x) { (void)x; }", ""),
    (Rule::Undefined, "static void own(void);", ""),
    (Rule::Recursion, "static void own(void) { own(); }", ""),
    (Rule::Recursion, "static void two(void);\nstatic void own(void) { two(); }\nstatic void two(void) { own(); }", ""),
    (Rule::Return, "static bool own(bool x) { if (x) { return true; } }", ""),
    (Rule::Arguments, "", "on(1);"),
    (Rule::Mismatch, "", "const uint32_t x = -1;"),
    (Rule::Mismatch, "", "const uint8_t x = agent.unhandled;"),
    (Rule::Mismatch, "", "if (-1LL < 4294967295ULL) { on(); }"),
    (Rule::Mismatch, "", "if (agent.unhandled) { on(); }"),
    (Rule::Mismatch, "", "const uint32_t x = 1.5;"),
    (Rule::Mismatch, "static const uint32_t x[2] = { 1U };", ""),
    (Rule::Cast, "", "const uint32_t x = (uint32_t)1.5;"),
    (Rule::Cast, "static bool own(uint32_t *x) { return true; }", "(void)own((uint32_t *)agent.unhandled);"),
    (Rule::Operation, "", "(void)(true + true);"),
    (Rule::Operation, "", "(void)(-1U);"),
    (Rule::Operation, "static const uint32_t x[2] = { 1U, 2U };", "(void)x[2];"),
    (Rule::Equality, "", "if (1.5 == 1.5) { on(); }"),
    (Rule::Equality, "", "if (\"a\" == \"a\") { on(); }"),
    (Rule::Address, "", "(void)&agent;"),
    (Rule::Address, "", "hear(&agent.unhandled);"),
    (Rule::Address, "", "if (&agent == &agent) { on(); }"),
    (Rule::Written, "static const uint32_t x = 1U;", "x = 2U;"),
    (Rule::Written, "static const uint32_t x = 1U;\nstatic void own(uint32_t *to) { *to = 1U; }", "own(&x);"),
    (Rule::Written, "static void own(const agent_t *of) { of->unhandled = 1U; }", ""),
    (Rule::Written, "static void own(uint32_t x) { x = 1U; }", ""),
    (Rule::Written, "", "for (uint32_t i = 0U; i < 3U; i++) { i = 0U; }"),
    (Rule::Place, "", "now() = 1;"),
    (Rule::Order, "static int32_t x = 0;\nstatic int32_t own(void) { x = 1; return x; }", "x = x + own();"),
    (Rule::Order, "static int32_t x = 0;\nstatic int32_t own(void) { x = 1; return x; }", "x += own();"),
    (Rule::Order, "", "if (now() < now()) { on(); }"),
    (Rule::Order, "static uint32_t x[2] = { 0U, 0U };\nstatic uint32_t own(void) { agent.unhandled = 1U; return 0U; }", "x[agent.unhandled] = own();"),
    (Rule::Unused, "", "now();"),
    (Rule::Unused, "", "agent.unhandled;"),
    (Rule::Loop, "", "while (true) { }"),
    (Rule::Loop, "", "for (uint32_t i = 0U; i < agent.unhandled; i++) { on(); }"),
    (Rule::Loop, "", "for (uint32_t i = 0U; i > 3U; i++) { on(); }"),
    (Rule::Loop, "", "for (uint8_t i = 0U; i < 300U; i++) { on(); }"),
    (Rule::Loop, "", "uint32_t x = 0U; for (uint32_t i = 0U; i < 3U; x++) { on(); }"),
    (Rule::Case, "", "switch (agent.unhandled) { case 0U: on(); default: break; }"),
    (Rule::Case, "", "switch (agent.unhandled) { case 0U: break; case 0U: break; default: break; }"),
    (Rule::Case, "", "switch (agent.unhandled) { case 0U: uint32_t x = 0U; break; default: break; }"),
    (Rule::Unreachable, "static void own(void) { return; on(); }", ""),
];

#[test]
fn what_is_not_of_the_language_is_refused() {
    let begin = with("", "").lines().take_while(|line| !line.starts_with("void next_step")).count();
    let mut wrong = Vec::new();
    for (rule, top, inside) in REFUSED {
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
        ("", "const int64_t x = 5000000000LL; const uint8_t y = 255U; if (x > y) { on(); }"),
    ] {
        let c = with(top, inside);
        let printed = judged(&c, &[]).unwrap_or_else(|refused| panic!("{top} {inside}: {refused}"));
        // What is printed is of the language, and stays as it is.
        assert_eq!(judged(&printed, &[]).unwrap(), printed);
    }
}

#[test]
fn state_is_printed_outside_of_functions_and_is_arbitrary() {
    let c = with(
        "static bool kept = true;\nstatic const bool FIXED = true;",
        "static uint32_t own[2] = { 1U, 2U }; own[0]++; (void)FIXED; (void)kept;",
    );
    let judged = judge(&lamp(), &c, []).unwrap();
    assert!(
        judged
            .text()
            .contains("\nstatic uint32_t next_step_own[2] = { 1U, 2U };\nvoid next_step(void)\n")
    );
    assert!(judged.text().contains("next_step_own[0]++;"), "{}", judged.text());
    for part in ["next_step_own[0] = any", "next_step_own[1] = any", "kept = any"] {
        assert!(judged.arbitrary().contains(part), "{}", judged.arbitrary());
    }
    assert!(!judged.arbitrary().contains("FIXED") && !judged.arbitrary().contains("agent"));
    let mut compared = lamp();
    judged.put_into(&mut compared);
    let text = &compared.files.last().unwrap().text;
    assert!(
        text.contains("next_step_own[1] = any") && text.contains("#ifdef next_step\n#error"),
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
    let wide = format!("if (false) {{ }} {}", many("else if (true) { on(); } "));
    assert!(judged(&with("", &wide), &[]).is_ok());
}
