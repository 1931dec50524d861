//! Translation validation: random agents in random environments, interpreted and compiled.
//!
//! Both must leave the same trace, to the last bit. An agent and its events are derived from a list of
//! choices, which is shrunk on a failure. `ASL2C_VALIDATION=20000 cargo test --release -p translator
//! validation` runs more agents than usual, `ASL2C_VALIDATION_SEED` other ones; `ASL2C_CC=tcc` selects
//! another compiler, which is twenty times as fast.

mod compiled;
mod generate;
mod interpreted;

use proptest::test_runner::{Config, TestCaseError, TestRunner};

use self::generate::Choices;
use crate::harness::{from_environment, in_random_cases};

/// Each agent is run through this many sequences of events.
const SEQUENCES: usize = 10;
const USUAL_AGENTS: u32 = 150;

/// Number of accepted agents, and of those with hostile names.
#[derive(Debug, Clone, Copy, Default)]
struct Validated {
    agents: u32,
    hostile: u32,
}

/// Runs one agent both ways.
fn validate(choices: &[u8]) -> Result<Validated, TestCaseError> {
    let mut choices = Choices::new(choices);
    let agent = generate::agent(&mut choices);
    let sequences: Vec<_> = (0..SEQUENCES).map(|_| generate::sequence(&mut choices)).collect();
    let Some(interpreted) = interpreted::run(&agent, &sequences) else {
        return Ok(Validated::default());
    };
    crate::format::keeps_its_meaning(&agent.text);
    let compiled = compiled::run(&agent, &sequences).map_err(TestCaseError::fail)?;
    if interpreted == compiled {
        return Ok(Validated { agents: 1, hostile: u32::from(agent.hostile > 0) });
    }
    let first = interpreted.lines().zip(compiled.lines()).position(|(a, b)| a != b);
    Err(TestCaseError::fail(format!(
        "{}\n{sequences:?}\nline {first:?}\ninterpreted:\n{interpreted}\ncompiled:\n{compiled}",
        agent.text
    )))
}

#[test]
fn validation_of_random_agents() {
    let cases = from_environment("ASL2C_VALIDATION", USUAL_AGENTS);
    let seed = from_environment("ASL2C_VALIDATION_SEED", 1);
    let choices = || proptest::collection::vec(proptest::num::u8::ANY, 50..700);
    let validated = in_random_cases(cases, seed, choices, |choices| validate(&choices));
    let translated: u32 = validated.iter().map(|one| one.agents).sum();
    let hostile: u32 = validated.iter().map(|one| one.hostile).sum();
    println!(
        "{translated} of {cases} agents translated, {hostile} of them with hostile names, \
         {SEQUENCES} sequences each: all agree"
    );
    assert!(translated * 2 > cases, "most agents should translate, {translated} of {cases} did");
    assert!(hostile * 3 > translated, "{hostile} of {translated} have hostile names");
}

/// Goals that only defer others and report that they run.
const QUEUEING: &str = "+!p(N) : N > 3 <- !!z(N); !!y(N, 1); !!z(N + 1).\n+!p(N) : N > 1 <- !!y(N, 2).\n+!p(N) <- a(N, 0).\n\
    +!z(N) : N mod 3 == 0 <- !!z(N + 1); a(N, 1).\n+!z(N) <- a(N, 2).\n+!y(N, M) <- a(N, M + 2).\n";
/// Number of `!!` in the agent.
const DEFERS: usize = 5;

/// A reference queue without agents: a list whose first element is next.
#[test]
fn queues_are_first_in_first_out() {
    let cases = from_environment("ASL2C_QUEUES", 60);
    let configuration = |room: usize| {
        format!(
            "settings {{ input = agent.asl; output = agent.c; header = agent.h; basics = actions.h; max_events = {room}; }};\n\
             basics {{ void a(int, int); }};\ntypes {{ p(int); z(int); y(int, int); }};\n\
             triggerables {{ +!p; +!z; }};\n"
        )
    };
    let commands = proptest::collection::vec((0..3_u8, 0..9_i32), 5..60);
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    TestRunner::new(config)
        .run(&(1..4_usize, commands), |(room, commands)| {
            let mut queue: std::collections::VecDeque<(char, i32, i32, bool)> = std::collections::VecDeque::new();
            let (mut expected, mut script, mut lost) = (Vec::new(), String::new(), 0);
            for (command, number) in commands {
                let goal = if command == 1 { 'p' } else { 'z' };
                if command > 0 {
                    script.push_str(&format!("printf(\"%d\\n\", (int)achieve_{goal}({number}));"));
                    let accepted = queue.iter().filter(|event| event.3).count() < room;
                    expected.push(i32::from(accepted).to_string());
                    if accepted {
                        queue.push_back((goal, number, 0, true));
                    }
                    continue;
                }
                script.push_str("next_step(); printf(\"|%u\\n\", unhandled_events());");
                let mut defer = |queue: &mut std::collections::VecDeque<_>, goal, n, m| {
                    let ours = queue.iter().filter(|event: &&(char, i32, i32, bool)| !event.3).count();
                    if ours < room + DEFERS { queue.push_back((goal, n, m, false)) } else { lost += 1 }
                };
                match queue.pop_front() {
                    Some(('p', n, ..)) if n > 3 => {
                        defer(&mut queue, 'z', n, 0);
                        defer(&mut queue, 'y', n, 1);
                        defer(&mut queue, 'z', n + 1, 0);
                    }
                    Some(('p', n, ..)) if n > 1 => defer(&mut queue, 'y', n, 2),
                    Some(('p', n, ..)) => expected.push(format!("{n},0")),
                    Some(('z', n, ..)) if n % 3 == 0 => {
                        defer(&mut queue, 'z', n + 1, 0);
                        expected.push(format!("{n},1"));
                    }
                    Some(('z', n, ..)) => expected.push(format!("{n},2")),
                    Some((_, n, m, _)) => expected.push(format!("{n},{}", m + 2)),
                    None => {}
                }
                expected.push(format!("|{lost}"));
            }
            let parsed = translator::parse_configuration("a.conf", &configuration(room)).unwrap();
            let translation = translator::translate(&parsed, QUEUEING).unwrap();
            let environment = format!(
                "#include <stdio.h>\nvoid updateBeliefs(void) {{ }}\n\
                 void a(int x, int y) {{ printf(\"%d,%d\\n\", x, y); }}\nint main(void) {{ init(); {script} return 0; }}\n"
            );
            let trace = crate::harness::compile_and_run(&translation, &environment);
            if trace == expected.join(" ") {
                return Ok(());
            }
            Err(TestCaseError::fail(format!("{script}\nexpected {}\ngot      {trace}", expected.join(" "))))
        })
        .unwrap_or_else(|error| panic!("{error}"));
}
