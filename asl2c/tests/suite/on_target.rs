//! The gallery and the shipped agent on a Cortex-M4, and C that differs there.

use std::path::Path;

use asl2c::{Agent, OnTarget, TargetError, on_target};
use translator::Exercise;

use crate::harness::skip;

fn exercised(agent: &Agent) -> Exercise {
    translator::exercise(&agent.configuration, &agent.text).unwrap()
}

fn read(name: &str) -> Agent {
    Agent::read(&Path::new("..").join(name)).unwrap()
}

/// The result, or `None` if a tool is missing.
fn run(exercise: &Exercise, reference: &Exercise, steps: u32) -> Option<OnTarget> {
    match on_target(exercise, reference, Path::new("."), steps) {
        Ok(result) => Some(result),
        Err(TargetError::Missing { program }) => {
            skip(&program);
            None
        }
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn each_agent_does_the_same_on_the_target_within_its_bounds() {
    let folder = std::fs::read_dir("../translator/agents").unwrap();
    let names = folder.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let names = names.filter(|name| name.ends_with(".conf"));
    let mut names: Vec<String> = names.map(|name| format!("translator/agents/{name}")).collect();
    names.push("autopilot/agent/autopilot.conf".to_owned());
    assert_eq!(names.len(), 7);
    for name in names {
        let exercise = exercised(&read(&name));
        let Some(found) = run(&exercise, &exercise, 1000) else { return };
        assert_eq!(found.difference, None, "{name}");
        assert!(found.lines > 3000, "{name} {}", found.lines);
        let step = &found.bounds[0];
        let longest = step.instructions.clone().unwrap();
        let observed = found.observed;
        assert!((20..=longest).contains(&observed.instructions), "{name} {observed:?} {step:?}");
        assert!(observed.stack <= step.stack, "{name} {observed:?} {step:?}");
        println!("{name} {found:?}");
    }
}
