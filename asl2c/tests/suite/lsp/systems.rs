//! Systems in a session.

use serde_json::{Value, json};

use super::client::{Client, read};

const SYSTEM: &str = "corridor.system";

fn gallery(name: &str) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../translator/agents/systems/");
    read(format!("{folder}{name}").as_ref())
}

/// A session with the corridor of the gallery, whose system is open, with some texts in place of others on disk.
fn corridor(changes: &[(&str, &str, &str)]) -> (Client, String) {
    let mut client = Client::with_files(&[]);
    for name in [SYSTEM, "keeper.conf", "keeper.asl", "traveller.conf", "traveller.asl"] {
        let changes = changes.iter().filter(|change| change.0 == name);
        let text = changes.fold(gallery(name), |text, (_, old, new)| text.replacen(old, new, 1));
        std::fs::write(client.path(name), text).unwrap();
    }
    let text = client.open_file(SYSTEM);
    (client, text)
}

/// The first line of each message.
fn messages(diagnostics: &[Value]) -> Vec<&str> {
    let messages = diagnostics.iter().map(|found| found["message"].as_str().unwrap());
    messages.map(|message| message.lines().next().unwrap()).collect()
}

#[test]
fn what_is_wrong_with_an_agent_is_shown_in_its_files_and_at_its_entry() {
    let (mut client, text) = corridor(&[
        ("keeper.conf", "taken(void);", "taken(void)"),
        ("traveller.asl", "<- pass", "<- pas"),
    ]);
    let found = client.diagnostics(SYSTEM, Some(1));
    let undeclared = "`traveller.asl` has errors: `pas` is not declared";
    let syntax = "`keeper.conf` has errors: expected `;`, found `watch`";
    assert_eq!(messages(&found), [syntax, undeclared, undeclared]);
    assert_eq!((&found[0]["code"], &found[1]["code"]), (&json!("syntax"), &json!("not-declared")));
    let line = text.lines().position(|line| line.contains("keeper.conf")).unwrap();
    let place = json!({ "start": { "line": line, "character": 10 }, "end": { "line": line, "character": 21 } });
    assert_eq!(found[0]["range"], place);
    assert_eq!(messages(&client.diagnostics("keeper.conf", None)), ["expected `;`, found `watch`"]);
    assert_eq!(messages(&client.diagnostics("traveller.asl", None)), ["`pas` is not declared"]);
    // What only the system showed ends with it.
    let closed = json!({ "textDocument": { "uri": client.uri(SYSTEM) } });
    client.notify("textDocument/didClose", closed);
    assert_eq!(client.diagnostics("keeper.conf", None), Vec::<Value>::new());
}

#[test]
fn a_file_that_is_missing_is_named_at_its_entry() {
    let (mut client, text) = corridor(&[]);
    assert_eq!(client.diagnostics(SYSTEM, Some(1)), Vec::<Value>::new());
    client.replace(
        SYSTEM,
        2,
        &text.replace("keeper.conf", "../none.conf").replacen("traveller.conf", "keeper.asl", 1),
    );
    let found = client.diagnostics(SYSTEM, Some(2));
    let messages = messages(&found);
    assert!(
        messages[0].starts_with("cannot read ") && messages[0].contains("none.conf"),
        "{messages:?}"
    );
    assert!(messages[1].starts_with("`keeper.asl` has errors: "), "{messages:?}");
    std::fs::remove_file(client.path("traveller.asl")).unwrap();
    client.notify("textDocument/didSave", json!({}));
    client.replace(SYSTEM, 3, &text);
    let found = client.diagnostics(SYSTEM, Some(3));
    assert_eq!(found.len(), 2);
    assert!(found.iter().all(|found| found["code"] == "not-read"), "{found:?}");
}

/// What is open counts, not what is saved.
#[test]
fn a_change_of_an_agent_is_seen_in_the_system() {
    let (mut client, _) = corridor(&[]);
    let [configuration, agent] = ["traveller.conf", "traveller.asl"];
    let text = client.open_file(agent);
    client.diagnostics(agent, Some(1));
    assert_eq!(client.last_diagnostics(SYSTEM, 1), Vec::<Value>::new());
    client.replace(agent, 2, &text.replace("<- pass", "<- walk"));
    client.diagnostics(agent, Some(2));
    assert_eq!(client.last_diagnostics(SYSTEM, 1).len(), 2);
    let declared = client.open_file(configuration);
    client.replace(
        configuration,
        2,
        &declared.replace("pass(", "walk(").replace(", pass", ", walk"),
    );
    client.diagnostics(configuration, Some(2));
    let never = ["`left` never calls `pass`", "`right` never calls `pass`"];
    assert_eq!(messages(&client.last_diagnostics(SYSTEM, 1)), never);
}

#[test]
fn names_that_fit_are_offered() {
    let (mut client, text) = corridor(&[]);
    let mut version = 1;
    let mut offered = |marked: &str| -> String {
        version += 1;
        let typed = format!("{text}{}", marked.replace('|', ""));
        client.replace(SYSTEM, version, &typed);
        let answer = client.ask("textDocument/completion", SYSTEM, &typed, marked);
        let items = answer["items"].as_array().unwrap().iter();
        let mut labels: Vec<&str> = items.map(|item| item["label"].as_str().unwrap()).collect();
        labels.sort_unstable();
        labels.join(" ")
    };
    assert_eq!(offered("ag|"), "agents channels properties version");
    assert_eq!(offered("agents { l|"), "keeper left right");
    assert_eq!(offered("agents { x: ke|"), "keeper.conf traveller.conf");
    assert_eq!(offered("channels { losses = 1; de|"), "capacity delay losses");
    assert_eq!(offered("channels { losses = |"), "any");
    assert_eq!(offered("channels { capacity = |"), "");
    assert_eq!(offered("properties { q|"), "");
    assert_eq!(offered("properties { q: w|"), "never_together within");
    assert_eq!(offered("properties { q [R-1]: never_together(le|"), "keeper left right");
    let actions = "flight hold isThrough isWanted pass send_achieve_enter send_achieve_release \
        send_tell_waiting send_unachieve_enter send_unachieve_release send_untell_waiting";
    assert_eq!(offered("properties { q: never_together(keeper.x, left.p|"), actions);
    assert_eq!(offered("properties { q: within(1, left.+!|"), "");
    assert_eq!(offered("properties { q: never_together(nobody.|"), "");
}

#[test]
fn an_entry_leads_to_its_configuration() {
    let (mut client, text) = corridor(&[]);
    let mut asked = |marked: &str| client.ask("textDocument/definition", SYSTEM, &text, marked);
    for marked in ["kee|per: keeper.conf", "keeper: keeper.|conf"] {
        assert!(asked(marked)["uri"].as_str().unwrap().ends_with("/keeper.conf"), "{marked}");
    }
    assert_eq!(asked("capa|city"), Value::Null);
    let uri = client.uri(SYSTEM);
    for method in ["declaration", "references", "hover"] {
        let method = format!("textDocument/{method}");
        let more = json!({ "context": { "includeDeclaration": true } });
        assert!(client.try_ask(&method, SYSTEM, &text, "kee|per:", &more).is_ok(), "{method}");
    }
    let params = json!({ "textDocument": { "uri": uri } });
    let symbols = client.request("textDocument/documentSymbol", params.clone()).unwrap();
    let names: Vec<&Value> =
        symbols.as_array().unwrap().iter().map(|symbol| &symbol["name"]).collect();
    assert_eq!(names, ["keeper", "left", "right", "one_at_a_time"]);
    let tokens = client.request("textDocument/semanticTokens/full", params).unwrap();
    assert_eq!(tokens["data"], json!([]));
}
