//! `asl2c validate --c` proves what people make of generated C by hand, as long as it does the same.

use std::path::Path;
use std::time::Duration;

use asl2c::{Agent, Cbmc, validate};
use judged_c::judge;
use translator::comparison;

use crate::harness::{cbmc, from_environment, skip};

const GALLERY: &str = "../translator/agents";
const TIME: Duration = Duration::from_mins(5);

/// An edit: what for, and pairs of old and new text.
type Edit = (&'static str, &'static [(&'static str, &'static str)]);

const UNHANDLED: &str = "        agent.unhandled = agent.unhandled + 1U;";
const HANDLE: &str = "/* Handles one event";
const NEXT: &str = "    (void)handle_event(take_event());";
const FAILED: &str = "(outcome != OUTCOME_ACHIEVED) && ";

#[rustfmt::skip]
const EDITS: &[Edit] = &[
    ("a counter counts", &[(UNHANDLED, "        agent.unhandled++;")]),
    ("a counter is increased", &[(UNHANDLED, "        agent.unhandled += 1U;")]),
    ("a comparison is negated", &[(FAILED, "(!(outcome == OUTCOME_ACHIEVED)) && ")]),
    ("another comparison is negated", &[("agent.posted != EVENT_NONE", "!(agent.posted == EVENT_NONE)")]),
    ("a comparison is turned", &[("agent.unhandled < UINT32_MAX", "UINT32_MAX > agent.unhandled")]),
    ("a truth value is compared", &[("if (agent.preemptive_achieve_stop_pending)", "if (agent.preemptive_achieve_stop_pending == true)")]),
    ("a local constant", &[("    outcome_t outcome = OUTCOME_ACHIEVED;\n    bool handled", "    const uint32_t most = UINT32_MAX;\n    outcome_t outcome = OUTCOME_ACHIEVED;\n    bool handled"), ("agent.unhandled < UINT32_MAX", "agent.unhandled < most")]),
    ("a constant for all", &[(HANDLE, "static const uint32_t MOST = 4294967295U;\n\n/* Handles one event"), ("agent.unhandled < UINT32_MAX", "agent.unhandled < MOST")]),
    ("a helper without parameters", &[(HANDLE, "static void count_unhandled(void)\n{\n    agent.unhandled = agent.unhandled + 1U;\n}\n\n/* Handles one event"), (UNHANDLED, "        count_unhandled();")]),
    ("a helper of a value", &[(HANDLE, "static bool has_failed(outcome_t result)\n{\n    return result != OUTCOME_ACHIEVED;\n}\n\n/* Handles one event"), (FAILED, "has_failed(outcome) && ")]),
    ("a helper of the state", &[("/* Pre-empting events first", "static bool is_idle(const agent_t *of)\n{\n    return of->posted == EVENT_NONE;\n}\n\n/* Pre-empting events first"), ("else if (agent.posted != EVENT_NONE)", "else if (!is_idle(&agent))")]),
    ("a helper that stores", &[(HANDLE, "static void increase(uint32_t *count)\n{\n    *count = *count + 1U;\n}\n\n/* Handles one event"), (UNHANDLED, "        increase(&agent.unhandled);")]),
    ("a helper that nobody calls", &[(HANDLE, "static bool both(bool a, bool b)\n{\n    return a && b;\n}\n\n/* Handles one event")]),
    ("a helper with a local and a loop", &[(HANDLE, "static uint32_t twice(uint32_t n)\n{\n    uint32_t sum = 0U;\n\n    for (uint32_t i = 0U; i < 2U; i++)\n    {\n        sum = sum + n;\n    }\n    return sum;\n}\n\n/* Handles one event"), ("+ 1U;\n    }\n    return handled;", "+ (twice(1U) - 1U);\n    }\n    return handled;")]),
    ("two calls in two statements", &[(NEXT, "    const event_t next = take_event();\n\n    (void)handle_event(next);")]),
    ("a result is kept and not used", &[(NEXT, "    const bool was_handled = handle_event(take_event());\n\n    (void)was_handled;")]),
    ("a way out", &[("    if ((outcome != OUTCOME_ACHIEVED) && (agent.unhandled < UINT32_MAX))\n", "    if (outcome == OUTCOME_ACHIEVED)\n    {\n        return handled;\n    }\n    if (agent.unhandled < UINT32_MAX)\n")]),
    ("a branch without braces", &[("    {\n        agent.unhandled = agent.unhandled + 1U;\n    }\n", "        agent.unhandled = agent.unhandled + 1U;\n")]),
    ("a branch turned around", &[("    if ((outcome != OUTCOME_ACHIEVED) && (agent.unhandled < UINT32_MAX))\n    {\n        agent.unhandled = agent.unhandled + 1U;\n    }\n", "    if ((outcome == OUTCOME_ACHIEVED) || (agent.unhandled == UINT32_MAX))\n    {\n        /* Nothing to count. */\n    }\n    else\n    {\n        agent.unhandled = agent.unhandled + 1U;\n    }\n")]),
    ("two branches inside each other", &[("    if ((outcome != OUTCOME_ACHIEVED) && (agent.unhandled < UINT32_MAX))\n    {\n        agent.unhandled = agent.unhandled + 1U;\n    }\n", "    if (outcome != OUTCOME_ACHIEVED)\n    {\n        if (agent.unhandled < UINT32_MAX)\n        {\n            agent.unhandled = agent.unhandled + 1U;\n        }\n    }\n")]),
    ("parentheses", &[("return handled;", "return (handled);")]),
    ("an empty branch is left out", &[("    else\n    {\n        /* Nothing to do. */\n    }\n", "")]),
    ("labels in another order", &[("        case EVENT_NONE:\n        default:\n", "        default:\n        case EVENT_NONE:\n")]),
    ("a declaration before", &[("\nstatic outcome_t run_achieve_rest(void);\n", "\nstatic bool handle_event(event_t event);\nstatic outcome_t run_achieve_rest(void);\n")]),
    ("statements in another order", &[("    agent.unhandled = 0U;\n    agent.refused = 0U;\n", "    agent.refused = 0U;\n    agent.unhandled = 0U;\n")]),
    ("a block", &[("    agent.unhandled = 0U;\n", "    {\n        agent.unhandled = 0U;\n    }\n")]),
    ("a statement twice", &[("    agent.unhandled = 0U;\n", "    agent.unhandled = 0U;\n    agent.unhandled = 0U;\n")]),
];

/// A name in place of another one.
fn renamed(c: &str, from: &str, to: &str) -> String {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut text = String::new();
    let mut rest = c;
    while let Some(at) = rest.find(from) {
        let (before, behind) = (&rest[..at], &rest[at + from.len()..]);
        let whole = !before.ends_with(is_word) && !behind.starts_with(is_word);
        text += before;
        text += if whole { to } else { from };
        rest = behind;
    }
    text + rest
}

/// A function moved before another one.
fn moved(c: &str, function: &str, before: &str) -> String {
    let from = c.find(function).unwrap();
    let until = from + c[from..].find("\n}\n").unwrap() + 4;
    let (text, rest) = (&c[from..until], format!("{}{}", &c[..from], &c[until..]));
    let to = rest.find(before).unwrap();
    format!("{}{text}{}", &rest[..to], &rest[to..])
}

/// The C without its comments.
fn uncommented(c: &str) -> String {
    let parts = c.split("/*").enumerate().map(|(index, part)| match part.split_once("*/") {
        Some((_, behind)) if index > 0 => behind.to_owned(),
        _ => part.to_owned(),
    });
    parts.collect()
}

fn edits(c: &str) -> Vec<(&'static str, String)> {
    let mut edits: Vec<(&str, String)> = Vec::new();
    for (what, changes) in EDITS {
        let text = changes.iter().fold(c.to_owned(), |text, (from, to)| {
            assert!(text.contains(from), "{what}: {from}");
            text.replacen(from, to, 1)
        });
        edits.push((what, text));
    }
    let lines = |line: fn(&str) -> String| c.lines().map(line).collect::<String>();
    edits.push((
        "another name of a local",
        renamed(&renamed(c, "outcome", "result"), "handled", "done"),
    ));
    edits.push((
        "another name of a parameter",
        renamed(&renamed(c, "argument1", "given"), "event", "next"),
    ));
    edits.push((
        "another name of a function",
        renamed(&renamed(c, "take_event", "next_event"), "run_achieve_rest", "do_rest"),
    ));
    edits.push((
        "a function before another",
        moved(c, "static void forget_events", "/* Pre-empting"),
    ));
    edits.push((
        "functions of the interface in another order",
        moved(c, "uint32_t refused_events", "uint32_t unhandled_events"),
    ));
    edits.push((
        "more comments",
        lines(|line| {
            let more = " // as it was; \"quoted\" /\n/* and so on */";
            format!("{line}{}\n", if line.ends_with(';') { more } else { "" })
        }),
    ));
    edits.push(("no comments", uncommented(c)));
    edits.push(("tabs", c.replace("    ", "\t")));
    edits.push((
        "nearly one line",
        lines(|line| {
            if line.starts_with('#') { format!("{line}\n") } else { format!(" {} ", line.trim()) }
        }),
    ));
    edits.push(("braces at the ends of lines", c.replace(")\n{\n", ") {\n")));
    edits
}

/// `ASL2C_EDITS` of them.
#[test]
fn an_edit_without_effect_is_proved() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let cbmc = Cbmc::find(Some(&cbmc)).unwrap();
    let agent = Agent::read(Path::new(&format!("{GALLERY}/infusion.conf"))).unwrap();
    let compared = comparison(&agent.configuration, &agent.text).unwrap();
    let edits = edits(&compared.files[0].text);
    assert!(edits.len() >= 30);
    // All are of the language.
    let judged: Vec<_> = edits
        .iter()
        .map(|(what, c)| {
            assert!(*c != compared.files[0].text, "{what}");
            (what, judge(&compared, c, []).unwrap_or_else(|refused| panic!("{what}: {refused}")))
        })
        .collect();
    let wanted = from_environment("ASL2C_EDITS", 6) as usize;
    let mut proved = 0;
    for (what, judged) in judged.into_iter().step_by((edits.len() / wanted).max(1)) {
        let mut compared = compared.clone();
        judged.put_into(&mut compared);
        let folder = tempfile::tempdir().unwrap();
        let result = validate(&compared, &cbmc, folder.path(), TIME);
        assert!(matches!(&result, Ok(result) if result.is_proved()), "{what}: {result:?}");
        proved += 1;
    }
    println!("{proved} of {} edits tried, all proved", edits.len());
}
