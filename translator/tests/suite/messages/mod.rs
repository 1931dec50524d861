//! Random agents that talk, in random company, interpreted and compiled.
//!
//! Both must leave the same trace: all actions and messages that are sent with their arguments, all answers to what
//! arrives, and all counters. An agent with its peers, and what it hears, are derived from lists of choices, which are
//! shrunk on a failure. `ASL2C_MESSAGES=20000 cargo test -p translator messages` runs more agents than usual,
//! `ASL2C_SYSTEMS=20000` more systems of agents, `ASL2C_MESSAGES_SEED` other ones; `ASL2C_CC=clang` selects another
//! compiler.

mod system;
mod talker;
mod traces;

use proptest::collection::vec;
use proptest::num::u8::ANY;
use proptest::test_runner::TestCaseError;
use translator::interpreter::Interpreter;
use translator::{ParsedConfiguration, parse_configuration};

use self::system::Network;
use self::talker::{Choices, Command, Talker};
use self::traces::{compiled, interpreted};
use crate::harness::{from_environment, in_random_cases};

const USUAL_AGENTS: u32 = 100;
const USUAL_SYSTEMS: u32 = 60;
/// Each agent is run through at most this many sequences of commands.
const SEQUENCES: usize = 16;
/// Choices of what happens in a system, enough for about all steps.
const HAPPENINGS: std::ops::Range<usize> = 4_000..8_000;

fn parsed(talker: &Talker) -> ParsedConfiguration {
    parse_configuration("agent.conf", &talker.configuration)
        .unwrap_or_else(|error| panic!("{}{error}", talker.configuration))
}

/// Compares what an agent's C does with what the interpreter has done.
fn same(
    talker: &Talker,
    text: &str,
    sequences: &[Vec<Command>],
    expected: &str,
) -> Result<(), TestCaseError> {
    let found = compiled(talker, text, &parsed(talker), sequences);
    if found.as_deref() == Ok(expected) {
        return Ok(());
    }
    let found = found.unwrap_or_else(|error| error);
    let first = expected.lines().zip(found.lines()).position(|(one, other)| one != other);
    Err(TestCaseError::fail(format!(
        "{}\n{text}\n{sequences:?}\nline {first:?}\ninterpreted:\n{expected}\ncompiled:\n{found}",
        talker.configuration
    )))
}

/// Runs one agent both ways; false if it is refused.
fn agrees(agent: &[u8], sequences: &[Vec<u8>]) -> Result<bool, TestCaseError> {
    let talker = Talker::new(&mut Choices(agent));
    let Ok(interpreter) = Interpreter::new(&parsed(&talker), &talker.text) else {
        return Ok(false);
    };
    let sequences: Vec<Vec<Command>> =
        sequences.iter().map(|choices| talker.sequence(&mut Choices(choices))).collect();
    let expected = interpreted(interpreter, &sequences);
    same(&talker, &talker.text, &sequences, &expected).map(|()| true)
}

#[test]
fn messages_of_random_agents() {
    let agents = from_environment("ASL2C_MESSAGES", USUAL_AGENTS);
    let seed = from_environment("ASL2C_MESSAGES_SEED", 1);
    let choices = || (vec(ANY, 100..600), vec(vec(ANY, 80..300), 1..=SEQUENCES));
    let translated =
        in_random_cases(agents, seed, choices, |(agent, sequences)| agrees(&agent, &sequences));
    let translated = translated.into_iter().filter(|is_translated| *is_translated).count();
    println!(
        "{translated} of {agents} agents translated, up to {SEQUENCES} sequences each: all agree"
    );
    assert!(translated * 2 > agents as usize, "only {translated} of {agents} were translated");
}

/// Runs one system both ways; none if its first agent is refused. What the C is sent is what the interpreter was sent:
/// if each agent agrees with itself, their C in the same network does.
fn system_agrees(
    [first, second]: [&[u8]; 2],
    happenings: &[u8],
) -> Result<Option<Network>, TestCaseError> {
    let talker = Talker::new(&mut Choices(first));
    let texts = [talker.text.clone(), talker.text(&mut Choices(second))];
    let parsed = parsed(&talker);
    let kinds = texts.each_ref().map(|text| Interpreter::new(&parsed, text).ok());
    if kinds[0].is_none() {
        return Ok(None);
    }
    let kinds: Vec<Interpreter> = kinds.into_iter().map_while(|kind| kind).collect();
    let (members, network) = system::run(&talker, &kinds, &mut Choices(happenings));
    for (kind, text) in texts.iter().enumerate() {
        let members = || members.iter().filter(|member| member.kind == Some(kind));
        let sequences: Vec<Vec<Command>> = members().map(|one| one.commands.clone()).collect();
        let expected: String = members().map(|member| &*member.trace.text).collect();
        if !sequences.is_empty() {
            same(&talker, text, &sequences, &expected)?;
        }
    }
    Ok(Some(network))
}

#[test]
fn systems_of_random_agents() {
    let systems = from_environment("ASL2C_SYSTEMS", USUAL_SYSTEMS);
    let seed = from_environment("ASL2C_MESSAGES_SEED", 1);
    let choices = || (vec(ANY, 100..600), vec(ANY, 100..600), vec(ANY, HAPPENINGS));
    let run = in_random_cases(systems, seed, choices, |(first, second, happenings)| {
        system_agrees([&first, &second], &happenings)
    });
    let run: Vec<Network> = run.into_iter().flatten().collect();
    let all = run.iter().fold(Network::default(), |all, one| Network {
        received: all.received + one.received,
        lost: all.lost + one.lost,
        reordered: all.reordered + one.reordered,
    });
    println!(
        "{} of {systems} systems translated, {} steps of each agent, {} messages received, {} of them behind a later one, \
         {} lost: all agree",
        run.len(),
        system::STEPS,
        all.received,
        all.reordered,
        all.lost
    );
    assert!(run.len() * 2 > systems as usize, "only {} of {systems} were translated", run.len());
    assert!(all.received > all.lost && all.lost > 0 && all.reordered > 0, "{all:?}");
}
