//! The formatter: the shipped agents and systems are formatted, and formatting changes no meaning.

use std::path::Path;

use translator::syntax::parse;
use translator::{format, format_system};

/// The tree of a text, without places.
fn tree(text: &str) -> String {
    let (agent, found) = parse(text);
    assert_eq!(found, []);
    let digit = |c: char| c.is_ascii_digit();
    let shown = format!("{agent:?}");
    let parts: Vec<&str> = shown.split("..").collect();
    parts.iter().map(|part| part.trim_matches(digit)).collect::<Vec<_>>().join("..")
}

pub(crate) fn keeps_its_meaning(text: &str) {
    let once = format("a.asl", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(tree(&once), tree(text), "{text}\n{once}");
    assert_eq!(format("a.asl", &once).unwrap(), once, "not stable:\n{text}");
    // The same text in one line, as far as comments allow.
    let joined: Vec<&str> = text.lines().map(str::trim).collect();
    if !text.contains("//") {
        assert_eq!(tree(&format("a.asl", &joined.join(" ")).unwrap()), tree(text));
    }
}

#[test]
fn the_shipped_agents_and_systems_are_formatted() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut agents, mut systems) = (0, 0);
    for folder in ["agents", "agents/systems", "../autopilot/agent"] {
        for file in std::fs::read_dir(root.join(folder)).unwrap() {
            let path = file.unwrap().path();
            let (format, count): (fn(&str, &str) -> _, _) =
                match path.extension().and_then(|ending| ending.to_str()) {
                    Some("asl") => (format, &mut agents),
                    Some("system") => (format_system, &mut systems),
                    _ => continue,
                };
            let text = std::fs::read_to_string(&path).unwrap();
            assert_eq!(format("x", &text).unwrap(), text, "{}", path.display());
            *count += 1;
        }
    }
    assert!(agents >= 11 && systems >= 4, "{agents} agents, {systems} systems");
}

#[test]
fn programs_of_the_conformance_suite_keep_their_meaning() {
    let agents = crate::conformance::agents();
    assert!(agents.len() > 100);
    for agent in agents {
        keeps_its_meaning(&agent);
    }
}
