//! Translation validation: random agents in random environments, interpreted and compiled.
//!
//! Both must leave the same trace, to the last bit. An agent and its events follow from a list of
//! choices, which is what shrinks when they don't. `ASL2C_VALIDATION=20000 cargo test --release -p
//! translator validation` runs more agents than usual, `ASL2C_VALIDATION_SEED` other ones.

mod compiled;
mod generate;
mod interpreted;

use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};

use self::generate::Choices;
use crate::harness::from_environment;

/// Each agent is run through this many sequences of events.
const SEQUENCES: usize = 10;
const USUAL_AGENTS: u32 = 150;

/// Runs one agent both ways; says whether it was one that translates.
fn validate(choices: &[u8]) -> Result<bool, TestCaseError> {
    let mut choices = Choices::new(choices);
    let agent = generate::agent(&mut choices);
    let sequences: Vec<_> = (0..SEQUENCES).map(|_| generate::sequence(&mut choices)).collect();
    let Some(interpreted) = interpreted::run(&agent, &sequences) else { return Ok(false) };
    let compiled = compiled::run(&agent, &sequences).map_err(TestCaseError::fail)?;
    if interpreted == compiled {
        return Ok(true);
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
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let workers = u32::try_from(processors).unwrap();
    let threads: Vec<_> = (0..workers)
        .map(|worker| {
            std::thread::spawn(move || {
                let mut seed_bytes = [0; 32];
                seed_bytes[..4].copy_from_slice(&seed.to_le_bytes());
                seed_bytes[4..8].copy_from_slice(&worker.to_le_bytes());
                let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &seed_bytes);
                let config = Config {
                    cases: cases.div_ceil(workers),
                    max_shrink_iters: 400,
                    failure_persistence: None,
                    ..Config::default()
                };
                let translated = std::cell::Cell::new(0_u32);
                let choices = proptest::collection::vec(proptest::num::u8::ANY, 50..700);
                let result = TestRunner::new_with_rng(config, rng).run(&choices, |choices| {
                    translated.set(translated.get() + u32::from(validate(&choices)?));
                    Ok(())
                });
                result.unwrap_or_else(|error| panic!("{error}"));
                translated.get()
            })
        })
        .collect();
    let translated: u32 = threads.into_iter().map(|thread| thread.join().unwrap()).sum();
    println!("{translated} of {cases} agents translated, {SEQUENCES} sequences each: all agree");
    assert!(translated * 2 > cases, "most agents should translate, {translated} of {cases} did");
}
