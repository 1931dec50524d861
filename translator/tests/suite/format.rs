//! The formatter: the shipped agents are formatted, and formatting changes no meaning.

use std::path::Path;

use translator::format;
use translator::syntax::parse;

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
fn the_shipped_agents_are_formatted() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = 0;
    for folder in ["agents", "../autopilot/agent"] {
        for file in std::fs::read_dir(root.join(folder)).unwrap() {
            let path = file.unwrap().path();
            if path.extension().is_some_and(|extension| extension == "asl") {
                let text = std::fs::read_to_string(&path).unwrap();
                assert_eq!(format("a.asl", &text).unwrap(), text, "{}", path.display());
                found += 1;
            }
        }
    }
    assert!(found >= 7, "{found} agents");
}

#[test]
fn programs_of_the_conformance_suite_keep_their_meaning() {
    let agents = crate::conformance::agents();
    assert!(agents.len() > 100);
    for agent in agents {
        keeps_its_meaning(&agent);
    }
}
