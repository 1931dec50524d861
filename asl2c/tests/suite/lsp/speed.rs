//! What a keystroke costs in a file of 10 000 plans.
//!
//! `ASL2C_KEYSTROKES=400 cargo test --release -p asl2c --test suite lsp::speed -- --nocapture` measures the figures of
//! `docs/agentspeak.md`. A time limit is not tested: it would depend on what else the machine does.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::time::{Duration, Instant};

use lsp_server::{Message, Notification, Request, RequestId, Response};
use serde_json::json;

use super::client::{Client, position, read};
use crate::harness::from_environment;

/// Copies of the rover of the gallery, which has 19 plans.
const COPIES: usize = 530;

/// Many rovers in one agent, each with names of its own.
fn rovers() -> (String, String) {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../translator/agents/");
    let agent = read(format!("{folder}rover.asl").as_ref());
    let parsed = read(format!("{folder}rover.conf").as_ref());
    let (parsed, _) = translator::configuration::parse(&parsed);
    let own: BTreeSet<&str> =
        parsed.predicates.iter().map(|predicate| predicate.name.text.as_str()).collect();
    let (_, plans) = agent.split_once("!wait.\n").unwrap();
    let (mut beliefs, mut all) = (String::new(), String::new());
    let (mut types, mut settables, mut events, mut first) =
        (String::new(), String::new(), String::new(), String::new());
    for copy in 0..COPIES {
        _ = writeln!(beliefs, "reserve_{copy}(30).");
        all.push_str(&numbered(plans, &own, copy));
        for predicate in &parsed.predicates {
            let parameters: Vec<&str> =
                predicate.parameters.iter().map(|ctype| ctype.name.as_str()).collect();
            let parameters =
                if parameters.is_empty() { "void".into() } else { parameters.join(", ") };
            _ = writeln!(types, "{}_{copy}({parameters});", predicate.name.text);
        }
        for name in &parsed.settables {
            _ = writeln!(settables, "{}_{copy};", name.text);
        }
        _ = writeln!(events, "+!visit_{copy}; +!halt_now_{copy};");
        _ = writeln!(first, "+!halt_now_{copy};");
    }
    let configuration = format!(
        "settings {{ input = a.asl; output = a.c; header = a.h; basics = b.h; }};
        basics {{ void halt(void); void backUp(void); void driveTo(double, double); void safeMode(void);
            bool isThere(double, double); }};
        types {{ {types} }};\nsettables {{ {settables} }};\ntriggerables {{ {events} }};\npreemptive {{ {first} }};\n"
    );
    (configuration, format!("{beliefs}!wait_0.\n{all}"))
}

/// A text in which some words, and all labels, have a number.
fn numbered(text: &str, own: &BTreeSet<&str>, copy: usize) -> String {
    let mut numbered = String::with_capacity(text.len() * 2);
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut rest = text;
    while let Some(start) = rest.find(is_word) {
        let end = rest[start..].find(|c| !is_word(c)).map_or(rest.len(), |length| start + length);
        numbered.push_str(&rest[..end]);
        if own.contains(&rest[start..end]) || rest[..start].ends_with('@') {
            _ = write!(numbered, "_{copy}");
        }
        rest = &rest[end..];
    }
    numbered + rest
}

/// Pseudo-random numbers, the same in each run.
fn next(seed: &mut u64, below: usize) -> usize {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    usize::try_from(*seed >> 33).unwrap() % below
}

#[test]
#[allow(clippy::print_stdout, clippy::disallowed_methods, reason = "a measurement")]
fn a_keystroke_in_a_file_of_ten_thousand_plans_is_answered() {
    let (configuration, mut text) = rovers();
    let plans = text.lines().filter(|line| line.starts_with(['+', '-'])).count();
    assert!(plans >= 10_000, "{plans}");
    let mut client = Client::with_files(&[("a.conf", &configuration)]);
    client.open("a.asl", &text);
    let usual = client.diagnostics("a.asl", Some(1)).len();
    let (mut seed, mut version) = (1, 1);
    let mut times: [Vec<Duration>; 2] = [Vec::new(), Vec::new()];
    for _ in 0..from_environment("ASL2C_KEYSTROKES", 10) / 2 {
        let place = next(&mut seed, text.len());
        for inserted in [true, false] {
            version += 1;
            let started = Instant::now();
            let found =
                keystroke(&mut client, &mut text, place, inserted, version, &mut times, started);
            assert!(inserted || found == usual, "{found} findings instead of {usual}");
        }
    }
    println!("{plans} plans, {} bytes, {} keystrokes", text.len(), times[0].len());
    for (what, times) in ["diagnostics", "hover"].iter().zip(&mut times) {
        times.sort();
        let at = |share: usize| times[(times.len() * share / 100).min(times.len() - 1)];
        println!("{what:<12} p50 {:?}, p95 {:?}, worst {:?}", at(50), at(95), at(100));
    }
}

/// Types or takes back a letter and asks what is there. Returns the number of diagnostics.
fn keystroke(
    client: &mut Client,
    text: &mut String,
    place: usize,
    inserted: bool,
    version: i32,
    times: &mut [Vec<Duration>; 2],
    started: Instant,
) -> usize {
    let before = &text[..place];
    let line = before.matches('\n').count();
    let column = before.rsplit('\n').next().unwrap().len();
    let at = |column: usize| json!({ "line": line, "character": column });
    let (end, letter) = if inserted { (at(column), "x") } else { (at(column + 1), "") };
    client.change(
        "a.asl",
        version,
        &json!({ "range": { "start": at(column), "end": end }, "text": letter }),
    );
    let hover = RequestId::from(version);
    let params = json!({ "textDocument": { "uri": client.uri("a.asl") }, "position": at(column) });
    client.send(&Request::new(hover.clone(), "textDocument/hover".to_owned(), params).into());
    text.replace_range(place..place + usize::from(!inserted), letter);
    let (mut found, mut answered) = (None, false);
    while found.is_none() || !answered {
        match client.receive() {
            Message::Response(Response { id, response_result }) if id == hover => {
                assert!(response_result.is_ok());
                answered = true;
                times[1].push(started.elapsed());
            }
            Message::Notification(Notification { params, .. }) => {
                if params["version"] == version {
                    found = params["diagnostics"].as_array().map(Vec::len);
                    times[0].push(started.elapsed());
                }
            }
            other => panic!("unexpected {other:?}"),
        }
    }
    found.unwrap()
}

/// The agent of the measurement is one that the translator accepts.
#[test]
fn many_rovers_are_an_agent() {
    let (configuration, agent) = rovers();
    assert_eq!(position(&agent, "|+!wait_0 : tilt").1, 0);
    let configuration = translator::parse_configuration("a.conf", &configuration).unwrap();
    let document = translator::syntax::Document::new(agent);
    let found = translator::findings(&configuration, &document);
    assert_eq!((found.configuration, found.agent), (Vec::new(), Vec::new()));
}
