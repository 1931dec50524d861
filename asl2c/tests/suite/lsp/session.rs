//! Each capability in a session.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::client::{Client, position, read};

const ROVER: [&str; 2] = ["rover.conf", "rover.asl"];

fn gallery(name: &str) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../translator/agents/");
    read(format!("{folder}{name}").as_ref())
}

/// A session with the rover of the gallery, whose agent is open.
fn rover() -> (Client, String) {
    let [configuration, agent] = ROVER.map(gallery);
    let mut client = Client::with_files(&[(ROVER[0], &configuration), (ROVER[1], &agent)]);
    let text = client.open_file(ROVER[1]);
    assert_eq!(client.diagnostics(ROVER[1], Some(1)), Vec::<Value>::new());
    (client, text)
}

/// The severity of what is no mistake.
const INFORMATION: u32 = 3;

fn codes(diagnostics: &[Value]) -> Vec<&str> {
    diagnostics.iter().filter_map(|found| found["code"].as_str()).collect()
}

/// Places of an answer: name of the file, and line from 1.
fn lines(places: &Value) -> Vec<String> {
    let place = |place: &Value| {
        let file = place["uri"].as_str().unwrap().rsplit('/').next().unwrap().to_owned();
        format!("{file}:{}", place["range"]["start"]["line"].as_u64().unwrap() + 1)
    };
    places.as_array().unwrap().iter().map(place).collect()
}

/// A text after the edits of an answer.
fn edited(text: &str, edits: &Value) -> String {
    let mut text = text.to_owned();
    let mut edits = edits.as_array().unwrap().clone();
    let offset = |text: &str, position: &Value| {
        let line = position["line"].as_u64().unwrap();
        let line = text.split_inclusive('\n').take(usize::try_from(line).unwrap());
        let start: usize = line.map(str::len).sum();
        let column = usize::try_from(position["character"].as_u64().unwrap()).unwrap();
        let mut units = 0;
        let behind = text[start..].char_indices().find(|(_, c)| {
            let here = units;
            units += c.len_utf16();
            here >= column
        });
        start + behind.map_or(text.len() - start, |(index, _)| index)
    };
    edits.sort_by_key(|edit| offset(&text, &edit["range"]["start"]));
    for edit in edits.iter().rev() {
        let range = &edit["range"];
        let span = offset(&text, &range["start"])..offset(&text, &range["end"]);
        text.replace_range(span, edit["newText"].as_str().unwrap());
    }
    text
}

#[test]
fn diagnostics_follow_the_typing() {
    let (mut client, text) = rover();
    let (line, character) = position(&text, "|driveTo(X, Y);");
    let at = |from: usize, to: usize| {
        json!({ "start": { "line": line, "character": character + from },
                "end": { "line": line, "character": character + to } })
    };
    client.change(ROVER[1], 2, &json!({ "range": at(0, 7), "text": "driveTwo" }));
    let found = client.diagnostics(ROVER[1], Some(2));
    assert_eq!(codes(&found), ["not-declared"]);
    assert_eq!(found[0]["message"], "`driveTwo` is not declared\nhelp: did you mean `driveTo`?");
    assert_eq!(found[0]["range"], at(0, 8));
    assert_eq!((&found[0]["severity"], &found[0]["source"]), (&json!(1), &json!("asl2c")));
    client.change(ROVER[1], 3, &json!({ "range": at(5, 8), "text": "To" }));
    assert_eq!(client.diagnostics(ROVER[1], Some(3)), Vec::<Value>::new());
}

/// UTF-16 columns and lines that end with CRLF.
#[test]
fn edits_behind_other_characters_are_made_in_their_place() {
    let mut client = Client::with_files(&[]);
    client.open("a.asl", "// \u{1f600}\u{e9}\r\n/* \u{1f600} */ +!go <- on.\r\n+!on.");
    client.diagnostics("a.asl", Some(1));
    let range =
        json!({ "start": { "line": 1, "character": 17 }, "end": { "line": 1, "character": 19 } });
    client.change("a.asl", 2, &json!({ "range": range, "text": "~" }));
    let found = client.diagnostics("a.asl", Some(2));
    assert_eq!(
        found[0]["message"].as_str().unwrap().split('\n').next(),
        Some("unexpected character `~`")
    );
    let expected =
        json!({ "start": { "line": 1, "character": 17 }, "end": { "line": 1, "character": 18 } });
    assert_eq!(found[0]["range"], expected);
}

#[test]
fn an_agent_without_a_configuration_is_parsed_and_that_is_said() {
    let mut client = Client::with_files(&[]);
    client.open("pilot.asl", "+!go <- on; ");
    let found = client.diagnostics("pilot.asl", Some(1));
    assert_eq!(codes(&found), ["syntax", "no-configuration"]);
    assert_eq!(found[1]["severity"], INFORMATION);
    let said = found[1]["message"].as_str().unwrap();
    assert!(said.starts_with("only the syntax is checked: no configuration names `pilot.asl`"));
    // A configuration appears, first in the editor, then only on disk.
    let text = "settings { input = pilot.asl; output = a.c; header = a.h; basics = b.h; };
        basics { void on(void); }; types { go(void); }; triggerables { +!go; };";
    client.open("pilot.conf", text);
    assert_eq!(client.diagnostics("pilot.conf", Some(1)), Vec::<Value>::new());
    assert_eq!(codes(&client.diagnostics("pilot.asl", Some(1))), ["syntax"]);
    std::fs::write(client.path("pilot.conf"), text.replace("void on", "void off")).unwrap();
    let closed = json!({ "textDocument": { "uri": client.uri("pilot.conf") } });
    client.notify("textDocument/didClose", closed);
    client.replace("pilot.asl", 2, "+!go <- on.");
    assert_eq!(codes(&client.diagnostics("pilot.asl", Some(2))), ["not-declared"]);
}

#[test]
fn a_configuration_is_checked_with_its_agent() {
    let [configuration, agent] = ROVER.map(gallery);
    let mut client = Client::with_files(&[(ROVER[0], &configuration), (ROVER[1], &agent)]);
    client.open_file(ROVER[0]);
    assert_eq!(client.diagnostics(ROVER[0], Some(1)), Vec::<Value>::new());
    // The agent is not open, and has a finding now.
    let renamed = configuration.replace("void backUp(void)", "void backOff(void)");
    client.replace(ROVER[0], 2, &renamed.replace("halt, backUp,", "halt, backOff,"));
    assert_eq!(client.diagnostics(ROVER[0], Some(2)), Vec::<Value>::new());
    assert_eq!(codes(&client.diagnostics(ROVER[1], None)), ["not-declared"]);
    client.replace(ROVER[0], 3, "settings {");
    // It names no agent any more, which therefore has no findings.
    assert_eq!(codes(&client.diagnostics(ROVER[0], Some(3))), ["syntax"]);
    assert_eq!(client.diagnostics(ROVER[1], None), Vec::<Value>::new());
    client.replace(ROVER[0], 4, &configuration.replace("rover.asl", "missing.asl"));
    let found = client.diagnostics(ROVER[0], Some(4));
    assert_eq!(codes(&found), ["not-read"]);
    // As the command says it.
    let message = found[0]["message"].as_str().unwrap();
    assert!(message.starts_with("cannot read `missing.asl`: "), "{message}");
}

/// What the editor has counts, also for an agent that was open before.
#[test]
fn a_configuration_that_is_opened_counts_at_once() {
    let (mut client, _) = rover();
    client.open(ROVER[0], &gallery(ROVER[0]).replace("rover.asl", "other.asl"));
    assert_eq!(codes(&client.diagnostics(ROVER[1], Some(1))), ["no-configuration"]);
}

#[test]
fn hover_says_what_a_name_means() {
    let (mut client, text) = rover();
    let mut hover = |marked: &str| {
        let answer = client.ask("textDocument/hover", ROVER[1], &text, marked);
        answer["contents"]["value"].as_str().unwrap_or_default().to_owned()
    };
    assert!(hover("cha|rge(Now)").starts_with("```c\ncharge(int32_t)\n```"));
    assert!(hover("charge(No|w)").starts_with("```c\nint32_t Now\n```"));
    assert!(hover("drive|To(X, Y)").starts_with("```c\nvoid driveTo(double, double);\n```"));
    let reached = hover("+!vis|it(X, Y)");
    assert!(reached.contains("calls `backUp`, `driveTo`, `halt`, `safeMode`"), "{reached}");
    assert_eq!(hover("// A |rover"), "");
}

#[test]
fn definitions_and_references_are_in_both_texts() {
    let (mut client, text) = rover();
    let configuration = gallery(ROVER[0]);
    let mut places = |method: &str, marked: &str, further: Value| {
        lines(&client.try_ask(method, ROVER[1], &text, marked, &further).unwrap())
    };
    let line = |text: &str, marked: &str| position(text, marked).0 + 1;
    let declared = |marked: &str| vec![format!("rover.conf:{}", line(&configuration, marked))];
    // A goal's plans; otherwise the declaration.
    assert_eq!(places("textDocument/definition", "!av|oid(X, Y, Left)", json!({})).len(), 4);
    assert_eq!(
        places("textDocument/declaration", "!av|oid(X, Y, Left)", json!({})),
        declared("|avoid(")
    );
    assert_eq!(
        places("textDocument/definition", "drive|To(X, Y)", json!({})),
        declared("|driveTo(")
    );
    let left = places("textDocument/definition", "avoid(X, Y, Le|ft)", json!({}));
    assert_eq!(left, [format!("rover.asl:{}", line(&text, "|Left = Attempts"))]);
    let with = json!({ "context": { "includeDeclaration": true } });
    let without = json!({ "context": { "includeDeclaration": false } });
    let all = places("textDocument/references", "back|Up", with);
    assert_eq!(all.len(), 4, "{all:?}");
    let used = places("textDocument/references", "back|Up", without);
    assert_eq!(used.len(), 3, "{used:?}");
    assert_eq!(places("textDocument/definition", "// A |rover", json!({})), [""; 0]);
}

#[test]
fn renaming_changes_both_texts_or_nothing() {
    let (mut client, text) = rover();
    let configuration = gallery(ROVER[0]);
    let mut rename = |marked: &str, name: &str| {
        let name = json!({ "newName": name });
        client.try_ask("textDocument/rename", ROVER[1], &text, marked, &name)
    };
    let texts = |answer: &Value| -> BTreeMap<String, String> {
        let changes = answer["changes"].as_object().unwrap().iter();
        let name = |uri: &str| uri.rsplit('/').next().unwrap().to_owned();
        let old = |name: &str| if name == ROVER[0] { &configuration } else { &text };
        changes.map(|(uri, edits)| (name(uri), edited(old(&name(uri)), edits))).collect()
    };
    let renamed = texts(&rename("drive|To(X, Y)", "goTo").unwrap());
    assert_eq!(renamed[ROVER[0]], configuration.replace("driveTo", "goTo"));
    assert_eq!(renamed[ROVER[1]], text.replace("driveTo", "goTo"));
    // A variable is that of its plan.
    let renamed = texts(&rename("avoid(X, Y, Le|ft)", "Rest").unwrap());
    assert_eq!(renamed.len(), 1);
    assert_eq!(renamed[ROVER[1]], text.replace("Left", "Rest"));
    for (marked, name, reason) in [
        ("drive|To(X, Y)", "DriveTo", "is not a name"),
        ("drive|To(X, Y)", "not", "is not a name"),
        ("drive|To(X, Y)", "halt", "there is a `halt` already"),
        ("drive|To(X, Y)", "printf", "`printf` cannot be the name of a C function"),
        ("avoid(X, Y, Le|ft)", "X", "there is a `X` already"),
        ("// A |rover", "x", "there is no name here"),
    ] {
        let (_, said) = rename(marked, name).unwrap_err();
        assert!(said.contains(reason), "{said}");
    }
    let mut prepare =
        |marked: &str| client.ask("textDocument/prepareRename", ROVER[1], &text, marked);
    assert_eq!(prepare("drive|To(X, Y)")["placeholder"], "driveTo");
    assert_eq!(prepare("// A |rover"), Value::Null);
    // Names in text with errors would be forgotten.
    client.replace(ROVER[1], 2, &format!("{text}+!x <- driveTo("));
    let name = json!({ "newName": "goTo" });
    let refused = client.try_ask("textDocument/rename", ROVER[1], &text, "drive|To(X, Y)", &name);
    assert!(refused.unwrap_err().1.contains("syntax errors"));
}

#[test]
fn completion_offers_what_fits() {
    let (mut client, text) = rover();
    let mut offered = |name: &str, text: &str, marked: &str| -> Vec<String> {
        let answer = client.ask("textDocument/completion", name, text, marked);
        let items = answer["items"].as_array().unwrap().iter();
        items.map(|item| item["label"].as_str().unwrap().to_owned()).collect()
    };
    let goals = offered(ROVER[1], &text, "halt; !|drive");
    assert!(goals.contains(&"visit".to_owned()) && !goals.contains(&"backUp".to_owned()));
    let formulae = offered(ROVER[1], &text, "Attempts - 1; |halt");
    assert!(formulae.contains(&"backUp".to_owned()) && formulae.contains(&"Attempts".to_owned()));
    assert!(!formulae.contains(&"visit".to_owned()));
}

#[test]
fn formatting_is_that_of_the_command() {
    let mut client = Client::with_files(&[]);
    for (name, text, expected) in [
        ("a.asl", "!go .\n// \u{e9}\n+!go<-on ;   off.\n", "!go.\n// \u{e9}\n+!go <- on; off.\n"),
        ("a.asl", "!go .\r\n+!go<-on.\r\n", "!go.\r\n+!go <- on.\r\n"),
        ("a.asl", "!go.\n+!go <- say(\"\u{e8}\") .\n", "!go.\n+!go <- say(\"\u{e8}\").\n"),
        ("a.system", "agents{a:b.conf;}", "agents { a: b.conf; }\n"),
    ] {
        client.open(name, text);
        let uri = client.uri(name);
        let params = json!({ "textDocument": { "uri": uri }, "options": { "tabSize": 8, "insertSpaces": false } });
        let edits = client.request("textDocument/formatting", params.clone()).unwrap();
        assert_eq!(edited(text, &edits), expected);
        client.open(name, expected);
        assert_eq!(client.request("textDocument/formatting", params.clone()), Ok(json!([])));
        client.open(name, "+!go <- ");
        assert_eq!(client.request("textDocument/formatting", params), Ok(Value::Null));
    }
}

#[test]
fn the_outline_has_every_declaration() {
    let (mut client, text) = rover();
    client.open_file(ROVER[0]);
    let mut names = |name: &str| -> Vec<String> {
        let params = json!({ "textDocument": { "uri": client.uri(name) } });
        let symbols = client.request("textDocument/documentSymbol", params).unwrap();
        let symbols = symbols.as_array().unwrap().iter();
        symbols.map(|symbol| symbol["name"].as_str().unwrap().to_owned()).collect()
    };
    let agent = names(ROVER[1]);
    assert_eq!(agent[..3], ["reserve", "!wait", "+!wait"]);
    assert_eq!(agent.len(), 2 + text.lines().filter(|line| line.starts_with(['+', '-'])).count());
    let configuration = names(ROVER[0]);
    assert!(
        ["driveTo", "command", "charge", "tilting_stops"]
            .iter()
            .all(|n| configuration.contains(&(*n).to_owned()))
    );
}

/// The tokens of an answer: text, kind and modifiers.
fn tokens(text: &str, data: &Value) -> Vec<(String, u64, u64)> {
    let data: Vec<u64> = data.as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).collect();
    let (mut line, mut column) = (0, 0);
    let lines: Vec<Vec<u16>> = text.lines().map(|line| line.encode_utf16().collect()).collect();
    let mut tokens = Vec::new();
    for token in data.chunks(5) {
        let size = |n: u64| usize::try_from(n).unwrap();
        line += size(token[0]);
        column = if token[0] == 0 { column + size(token[1]) } else { size(token[1]) };
        let units = &lines[line][column..column + size(token[2])];
        tokens.push((String::from_utf16(units).unwrap(), token[3], token[4]));
    }
    tokens
}

#[test]
fn names_are_coloured_by_their_meaning() {
    let (mut client, text) = rover();
    let uri = client.uri(ROVER[1]);
    let document = json!({ "textDocument": { "uri": uri } });
    let full = client.request("textDocument/semanticTokens/full", document).unwrap();
    let all = tokens(&text, &full["data"]);
    let (belief, goal, function, variable, label) = (0, 1, 2, 3, 5);
    for (name, kind) in [
        ("reserve", belief),
        ("wait", goal),
        ("Angle", variable),
        ("safeMode", function),
        ("isThere", function),
        ("tilted", label),
    ] {
        let kinds: Vec<u64> = all.iter().filter(|t| t.0 == name).map(|t| t.1).collect();
        assert!(!kinds.is_empty() && kinds.iter().all(|k| *k == kind), "{name} {kinds:?}");
    }
    // A part of the text, and the difference after an edit.
    let (line, _) = position(&text, "|@tilted");
    let part = json!({ "textDocument": { "uri": uri }, "range": {
        "start": { "line": line, "character": 0 }, "end": { "line": line + 1, "character": 0 } } });
    let part = client.request("textDocument/semanticTokens/range", part).unwrap();
    assert_eq!(tokens(&text, &part["data"]), [("tilted".to_owned(), label, 1)]);
    let range = json!({ "start": { "line": line, "character": 1 }, "end": { "line": line, "character": 7 } });
    client.change(ROVER[1], 2, &json!({ "range": range, "text": "t" }));
    let known = json!({ "textDocument": { "uri": uri }, "previousResultId": full["resultId"] });
    let delta = client.request("textDocument/semanticTokens/full/delta", known.clone()).unwrap();
    let edits = delta["edits"].as_array().unwrap();
    assert_eq!(edits.len(), 1);
    assert_eq!((&edits[0]["deleteCount"], &edits[0]["data"][2]), (&json!(5), &json!(1)));
    // What is not known any more is sent as a whole.
    let delta = client.request("textDocument/semanticTokens/full/delta", known).unwrap();
    assert!(delta["data"].as_array().unwrap().len() > 500);
}
