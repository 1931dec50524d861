//! The agents of `translator/agents`: each is translated, run by its transcript, and proved as its README
//! states.

use std::path::Path;
use std::process::Command;

use asl2c::{Agent, Session, replay};

use crate::harness::{cbmc, skip};

const FOLDER: &str = "../translator/agents";
/// Each agent, and its properties that do not hold.
const AGENTS: [(&str, &[&str]); 7] = [
    (
        "paper",
        &[
            "one_command",
            "landing_is_honoured",
            "landing_is_honoured_in_a_second",
            "landing_goes_on",
            "flying_goes_on",
            "nothing_is_lost",
        ],
    ),
    ("lift", &[]),
    ("traffic_light", &[]),
    ("infusion", &["air_is_heard"]),
    ("rover", &[]),
    ("inspection", &[]),
    ("relief", &[]),
];

fn session(name: &str) -> Session {
    let agent = Agent::read(&Path::new(FOLDER).join(format!("{name}.conf"))).unwrap();
    let translation = translator::translate(&agent.configuration, &agent.text).unwrap();
    if name != "paper" {
        assert!(translation.warnings.is_empty(), "{}", translation.warnings);
    }
    Session::new(&agent.configuration, &agent.text).unwrap()
}

#[test]
fn every_agent_is_in_the_gallery_and_its_readme() {
    let readme = std::fs::read_to_string(format!("{FOLDER}/README.md")).unwrap();
    let files = std::fs::read_dir(FOLDER).unwrap().map(|entry| entry.unwrap().path());
    let mut found: Vec<String> = files
        .filter(|path| path.extension().is_some_and(|ending| ending == "conf"))
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    found.sort();
    let mut known = AGENTS.map(|(name, _)| name);
    known.sort_unstable();
    assert_eq!(found, known);
    assert!(known.iter().all(|name| readme.contains(&format!("**`{name}`**"))));
}

#[test]
fn every_transcript_is_what_the_agent_does() {
    for (name, _) in AGENTS {
        let text = std::fs::read_to_string(format!("{FOLDER}/{name}.transcript")).unwrap();
        let replayed = replay(&mut session(name), name, &text);
        assert!(replayed.is_fine(), "{name} {:?}\n{}", replayed.broken, replayed.shown);
    }
}

#[test]
fn the_kept_way_breaks_what_it_is_kept_for() {
    let text = std::fs::read_to_string(format!("{FOLDER}/infusion.air_is_heard.script")).unwrap();
    let replayed = replay(&mut session("infusion"), "way", &text);
    assert_eq!((replayed.errors, replayed.broken), (0, vec!["air_is_heard".to_owned()]));
}

/// Properties that hold are proved; each counterexample violates its property when it is run.
#[test]
fn what_is_proved_holds_and_what_is_not_has_a_way() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    for (name, broken) in AGENTS {
        let folder = tempfile::tempdir().unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_asl2c"))
            .args(["prove", "--json", &format!("{FOLDER}/{name}.conf"), "--cbmc"])
            .arg(&cbmc)
            .arg("-o")
            .arg(folder.path())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(i32::from(!broken.is_empty())), "{name} {said}");
        let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(json["version"], 1);
        assert_eq!(json["run_time"], serde_json::json!([]), "{name}");
        for property in json["properties"].as_array().unwrap() {
            let own = property["name"].as_str().unwrap();
            let expected = if broken.contains(&own) { "fails" } else { "holds" };
            assert_eq!(property["verdict"], expected, "{name} {own}");
            let Some(script) = property["script"].as_str() else { continue };
            let script = std::fs::read_to_string(script).unwrap();
            let replayed = replay(&mut session(name), "way", &script);
            assert_eq!(replayed.errors, 0, "{}", replayed.shown);
            assert!(replayed.broken.iter().any(|name| name == own), "{}", replayed.shown);
        }
    }
}
