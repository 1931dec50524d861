//! The editor is shown what the command line finds: the same code, severity, place and message.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::client::{Client, read};

/// File, severity, code, message with label and help, and place from 1.
type Finding = (String, String, String, String, [u64; 4]);

/// Findings of the command line.
fn printed(folder: &Path, arguments: &[&str]) -> BTreeSet<Finding> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    command.current_dir(folder).args(arguments).args(["--message-format", "json"]);
    let output = command.output().unwrap();
    let lines = String::from_utf8(output.stderr).unwrap();
    let finding = |line: &str| {
        let found: Value = serde_json::from_str(line).unwrap();
        let text = |key: &str| found[key].as_str().unwrap_or_default().to_owned();
        let number = |key: &str| found[key].as_u64().unwrap_or_default();
        let mut message = text("message");
        if !text("label").is_empty() {
            message = format!("{message}\n{}", text("label"));
        }
        if !text("help").is_empty() {
            message = format!("{message}\nhelp: {}", text("help"));
        }
        let place = ["line", "column", "end_line", "end_column"].map(number);
        (text("file"), text("severity"), text("code"), message, place)
    };
    lines.lines().map(finding).collect()
}

/// Findings of the server in one file, with columns that count characters.
fn shown(name: &str, text: &str, diagnostics: &[Value]) -> BTreeSet<Finding> {
    let finding = |found: &Value| {
        let severity = if found["severity"] == 1 { "error" } else { "warning" };
        let at = |end: &str| {
            let place = &found["range"][end];
            let line = place["line"].as_u64().unwrap();
            let units = usize::try_from(place["character"].as_u64().unwrap()).unwrap();
            let written = text.split('\n').nth(usize::try_from(line).unwrap()).unwrap_or_default();
            let before: Vec<u16> = written.encode_utf16().take(units).collect();
            let column = String::from_utf16_lossy(&before).chars().count();
            [line + 1, u64::try_from(column).unwrap() + 1]
        };
        let ([line, column], [end_line, end_column]) = (at("start"), at("end"));
        let text = |key: &str| found[key].as_str().unwrap_or_default().to_owned();
        let place = [line, column, end_line, end_column];
        (name.to_owned(), severity.to_owned(), text("code"), text("message"), place)
    };
    diagnostics.iter().map(finding).collect()
}

/// The command line shows no more.
const MOST: usize = 50;

/// Opens an agent and its configuration in a session and compares.
fn compare(client: &mut Client, version: &mut i32, configuration: &str, agent: &str) -> usize {
    *version += 1;
    for (name, text) in [("a.conf", configuration), ("a.asl", agent)] {
        std::fs::write(client.path(name), text).unwrap();
        client.replace(name, *version, text);
    }
    let mut found = shown("a.asl", agent, &client.diagnostics("a.asl", Some(*version)));
    // Before the agent changed the configuration may have had other findings.
    let in_configuration = client.last_diagnostics("a.conf", *version);
    found.extend(shown("a.conf", configuration, &in_configuration));
    let expected = printed(&client.path(""), &["a.conf", "-o", "out"]);
    if translator::parse_configuration("", configuration).is_err() {
        // Here the command line does not read the agent; the editor also shows errors of its syntax.
        found.retain(|finding| finding.0 == "a.conf");
    }
    // The command line shows the first of very many.
    if expected.len() < MOST {
        assert_eq!(found, expected, "{configuration}\n{agent}");
    } else {
        assert!(found.is_superset(&expected), "{configuration}\n{agent}");
    }
    found.len()
}

fn session() -> Client {
    let mut client = Client::with_files(&[]);
    std::fs::create_dir(client.path("out")).unwrap();
    for name in ["a.conf", "a.asl"] {
        client.open(name, "");
    }
    client
}

/// The strings in a Rust source.
fn strings(source: &str) -> Vec<String> {
    let mut strings = Vec::new();
    let mut rest = source;
    while let Some(start) = rest.find('"') {
        let (mut text, mut escaped) = (String::new(), false);
        let mut length = rest.len();
        for (index, character) in rest[start + 1..].char_indices() {
            match (escaped, character) {
                (false, '\\') => {
                    escaped = true;
                    continue;
                }
                (false, '"') => {
                    length = start + index + 2;
                    break;
                }
                (true, 'n') => text.push('\n'),
                (_, other) => text.push(other),
            }
            escaped = false;
        }
        strings.push(text);
        rest = &rest[length..];
    }
    strings
}

const HEAD: &str =
    "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; clock = now; };\n";

/// Every text of the suite of refused agents, right or wrong.
#[test]
fn the_refused_suite_is_shown_as_it_is_printed() {
    let suite = concat!(env!("CARGO_MANIFEST_DIR"), "/../translator/tests/suite/refused.rs");
    let mut client = session();
    let (mut version, mut texts, mut findings) = (1, 0, 0);
    let declarations = "basics { void act(int); bool flag(int); int count(void); void take(handle_t); int64_t now(void); };
        types { g(void); gi(int); b(int); d(double); h(handle_t); c(void); p(int, int); h2(handle_t, int); };
        settables { h; };";
    let configuration = format!("{HEAD}{declarations}");
    for text in strings(&read(suite.as_ref())) {
        let is_agent = text.contains("+!") || text.contains("+?") || text.contains("!g");
        if is_agent && !text.contains("-->") {
            texts += 1;
            findings += compare(&mut client, &mut version, &configuration, &text);
        }
    }
    assert!(texts > 90 && findings > 300, "{texts} texts, {findings} findings");
}

/// Every example of `asl2c explain`.
#[test]
fn the_explained_mistakes_are_shown_as_they_are_printed() {
    let explanations = concat!(env!("CARGO_MANIFEST_DIR"), "/../translator/src/explanations.md");
    let configuration = format!(
        "{HEAD}basics {{ void on(void); void show(int32_t); int32_t read(void); bool dark(void); int64_t now(void); }};
        types {{ light(void); dim(int32_t); level(int32_t); asked(int32_t); pair(int32_t, int32_t); idle(void); }};
        settables {{ level; }}; triggerables {{ +!light; +!dim; }};"
    );
    let mut client = session();
    let (mut version, mut texts) = (1, 0);
    let text = read(explanations.as_ref());
    for block in ["```wrong\n", "```right\n"] {
        for example in text.split(block).skip(1) {
            let agent = example.split("```").next().unwrap();
            compare(&mut client, &mut version, &configuration, agent);
            texts += 1;
        }
    }
    assert!(texts > 50, "{texts}");
    // Characters of one and of two units, and an empty text.
    for agent in ["", "+!light : \u{e9} <- on. /* \u{1f600} */ ~", "\u{1f600}\n"] {
        compare(&mut client, &mut version, &configuration, agent);
    }
}

#[test]
fn mistakes_in_configurations_are_shown_as_they_are_printed() {
    let mut client = session();
    let mut version = 1;
    let agent = "+!g <- act(1).";
    let plain = "basics { void act(int); }; types { g(void); }; triggerables { +!g; };";
    for configuration in [
        String::new(),
        format!("{HEAD}{plain}"),
        format!("{HEAD}{plain} typs {{ }};"),
        format!("{HEAD}{plain} settables {{ 3; x; }};"),
        format!("{HEAD}{plain} perceived {{ g; }};"),
        format!("{HEAD}{plain} preemptive {{ -g; }};"),
        format!("{HEAD}{plain} properties {{ p: never(fly); }};"),
        format!("{HEAD}{plain} properties {{ p: within(1, g < 2, act); }};"),
        format!("{HEAD}{plain}").replace("void act", "void printf"),
        format!("{HEAD}{plain}").replace("clock = now;", "rust = a.rs;"),
        format!("{HEAD}{plain}").replace("output = a.c", "output = ../a.c"),
        format!("{}{plain}", HEAD.replace("clock = now;", "inbox = 99;")),
    ] {
        compare(&mut client, &mut version, &configuration, agent);
        compare(&mut client, &mut version, &configuration, "+!g <- fly(1).");
    }
}

#[test]
fn mistakes_in_systems_are_shown_as_they_are_printed() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../translator/agents/systems/");
    let gallery = |name: &str| read(format!("{folder}{name}").as_ref());
    let traveller = gallery("traveller.conf");
    let others = traveller.replace("keeper, left, right }", "left, keeper, right }");
    let raised = traveller.replace("types {", "triggerables { +!travel; };\ntypes {");
    let mut client = Client::with_files(&[
        ("keeper.conf", &gallery("keeper.conf")),
        ("keeper.asl", &gallery("keeper.asl")),
        ("traveller.conf", &traveller),
        ("traveller.asl", &gallery("traveller.asl")),
        ("others.conf", &others),
        ("raised.conf", &raised),
    ]);
    client.open("a.system", "");
    let agents = "agents { keeper: keeper.conf; left: traveller.conf; right: raised.conf; };";
    let mut version = 1;
    let mut compare = |text: &str| {
        version += 1;
        std::fs::write(client.path("a.system"), text).unwrap();
        client.replace("a.system", version, text);
        let found = client.diagnostics("a.system", Some(version));
        let expected = printed(&client.path(""), &["verify", "--model", "a.system"]);
        assert_eq!(shown("a.system", text, &found), expected, "{text}");
        found.len()
    };
    for text in [
        "never_together(left.pass, right.pass)",
        "within(3, right.+!travel, keeper.send_achieve_enter)",
    ] {
        assert_eq!(compare(&format!("{agents} properties {{ p: {text}; }};")), 0);
    }
    for text in [
        "never(left.pass)",
        "never_together(left.pass, right.passes)",
        "never_together(left.pass, left.hold)",
        "never_together(left.pass, middle.pass)",
        "within(3, left.+!travel, right.pass)",
        "within(3, keeper.send_tell_waiting, right.pass)",
        "within(0, left.pass, right.pass)",
    ] {
        assert_eq!(
            compare(&format!("{agents} properties {{ /* \u{1f600} */ p: {text}; }};")),
            1,
            "{text}"
        );
    }
    for text in [
        "",
        "agents { keeper keeper.conf; };\nagent { };",
        "agents { keeper: keeper.conf; };",
        "agents { keeper: keeper.conf; left: traveller.conf; middle: traveller.conf; };",
        "agents { keeper: keeper.conf; left: traveller.conf; right: others.conf; };",
        "agents { keeper: keeper.conf; left: traveller.conf; left: traveller.conf; };\n/* open",
    ] {
        assert!(compare(text) > 0, "{text}");
    }
    assert!(compare(&format!("{agents} channels {{ losses = some; size = 3; }};")) > 1);
}
