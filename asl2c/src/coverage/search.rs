//! Finds tests that reach every decision of an agent: the reference interpreter is run with random calls and answers,
//! what reaches something new is continued, and the fewest executions that reach everything found are the tests.

use std::collections::{BTreeMap, BTreeSet};

use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use translator::configuration::Configuration;
use translator::interpreter::{Interpreter, Value};
use translator::types::TypeKind;
use translator::{Act, ParsedConfiguration, TranslateError};

use super::values::Numbers;
use super::world::{Execution, Goal, Seen};
use crate::run::parameters;

/// The search ends after this number of continuations that reached nothing new, ..
const PATIENCE: u32 = 20_000;
/// .. or this number altogether.
const MOST: u32 = 200_000;
/// Maximum number of steps in which nothing happens.
const QUIET: u32 = 48;
/// Tests are not continued beyond this number of acts.
const LONGEST: usize = 400;

/// A test that was found.
#[derive(Debug, Clone)]
pub(super) struct Found {
    pub(super) acts: Vec<Act>,
    /// What the agent must do.
    pub(super) trace: String,
    /// Places of the triggers of the plans that it chooses, in the agent's text.
    pub(super) plans: BTreeSet<usize>,
}

#[derive(Clone)]
struct Run<'a> {
    acts: Vec<Act>,
    seen: Seen,
    /// After these acts, without what was seen.
    execution: Execution<'a>,
}

impl<'a> Run<'a> {
    /// No act yet.
    fn new(configuration: &'a ParsedConfiguration, text: &str) -> Result<Self, TranslateError> {
        let agent = Interpreter::new(configuration, text)?;
        let execution = Execution::new(agent, configuration.declarations());
        Ok(Self { acts: Vec::new(), seen: Seen::default(), execution })
    }

    /// The run that goes on with `acts`, which `execution` has executed.
    fn continued(&self, acts: &[Act], mut execution: Execution<'a>) -> Self {
        let mut seen = self.seen.clone();
        seen.append(execution.take_seen());
        Self { acts: [&self.acts, acts].concat(), seen, execution }
    }

    fn found(&self) -> Found {
        let plans = self.seen.reached.iter().filter_map(|goal| match goal {
            Goal::Plan(place, true) => Some(*place),
            _ => None,
        });
        Found {
            acts: without_effectless(&self.acts),
            trace: self.seen.trace.clone() + &self.execution.at_the_end(),
            plans: plans.collect(),
        }
    }
}

/// The tests of an agent: the same ones each time.
pub(super) fn search(
    configuration: &ParsedConfiguration,
    text: &str,
) -> Result<Vec<Found>, TranslateError> {
    let first = Run::new(configuration, text)?;
    let (runs, reached) = explore(&first, configuration.declarations(), text);
    // What is proved of agents is proved without `clear()`: this test alone has it.
    let acts = [Act::Step, Act::Clear, Act::Step];
    let mut cleared = first.execution.clone();
    for act in &acts {
        cleared.execute(act);
    }
    let mut found = fewest(&runs, reached);
    found.push(first.continued(&acts, cleared).found());
    Ok(found)
}

/// The test with these acts; `None` if a step of it is too long.
pub(super) fn given(
    configuration: &ParsedConfiguration,
    text: &str,
    acts: &[Act],
) -> Result<Option<Found>, TranslateError> {
    let first = Run::new(configuration, text)?;
    let mut execution = first.execution.clone();
    let ends = acts.iter().all(|act| execution.execute(act));
    Ok(ends.then(|| first.continued(acts, execution).found()))
}

/// Short executions to the steps that decide something: for each decision and its outcome one of the shortest that were
/// found, up to the step before it, with the next event there.
pub(super) fn places(
    configuration: &ParsedConfiguration,
    text: &str,
) -> Result<Vec<(String, Vec<Act>)>, TranslateError> {
    let first = Run::new(configuration, text)?;
    let (runs, _) = explore(&first, configuration.declarations(), text);
    let mut shortest: BTreeMap<Goal, (String, Vec<Act>)> = BTreeMap::new();
    for run in &runs {
        let acts = without_effectless(&run.acts);
        let mut execution = first.execution.clone();
        let mut place = (execution.next().to_owned(), 0);
        for (index, act) in acts.iter().enumerate() {
            execution.execute(act);
            let Seen { reached, .. } = execution.take_seen();
            if *act != Act::Step {
                continue;
            }
            for goal in reached.into_iter().filter(Goal::is_decision) {
                let known = shortest.get(&goal);
                if known.is_none_or(|(_, known)| known.len() > place.1) {
                    let (next, length) = &place;
                    shortest.insert(goal, (next.clone(), acts[..*length].to_vec()));
                }
            }
            place = (execution.next().to_owned(), index + 1);
        }
    }
    let mut places: Vec<(String, Vec<Act>)> = Vec::new();
    for place in shortest.into_values() {
        if !places.contains(&place) {
            places.push(place);
        }
    }
    Ok(places)
}

/// Runs that reach all that is found, and what they reach.
fn explore<'a>(
    first: &Run<'a>,
    configuration: &'a Configuration,
    text: &str,
) -> (Vec<Run<'a>>, BTreeSet<Goal>) {
    let mut search =
        Search { configuration, numbers: Numbers::new(text), random: ChaCha8Rng::seed_from_u64(1) };
    let mut runs = vec![first.clone()];
    let mut reached: BTreeSet<Goal> = BTreeSet::new();
    let mut idle = 0;
    for _ in 0..MOST {
        idle += 1;
        if idle > PATIENCE {
            break;
        }
        let Some(continued) = search.continued(&runs, &reached) else { continue };
        reached.extend(continued.seen.reached.iter().cloned());
        runs.push(continued);
        idle = 0;
    }
    (runs, reached)
}

struct Search<'a> {
    configuration: &'a Configuration,
    numbers: Numbers,
    random: ChaCha8Rng,
}

impl<'a> Search<'a> {
    /// One of the runs with some more acts, if that reaches something new; it ends there.
    fn continued(&mut self, runs: &[Run<'a>], reached: &BTreeSet<Goal>) -> Option<Run<'a>> {
        // Half of the time one of the newest, which has come far.
        let newest = runs.len().saturating_sub(8);
        let from = if self.random.random() { newest } else { 0 };
        let run = &runs[self.random.random_range(from..runs.len())];
        if run.acts.len() > LONGEST {
            return None;
        }
        let mut acts = Vec::new();
        let mut execution = run.execution.clone();
        let mut useful = None;
        // Sometimes nothing happens for long: what counts steps or time comes to its end then.
        let is_quiet = self.random.random_range(0..8) == 0;
        let (steps, calls) = if is_quiet { (QUIET, 0) } else { (6, 3) };
        for _ in 0..self.random.random_range(1..=steps) {
            for _ in 0..self.random.random_range(0..=calls) {
                if let Some(act) = self.act(&execution) {
                    execution.execute(&act);
                    acts.push(act);
                }
            }
            acts.push(Act::Step);
            if !execution.execute(&Act::Step) {
                break;
            }
            if !execution.take_new().iter().all(|goal| reached.contains(goal)) {
                useful = Some((acts.len(), execution.clone()));
            }
        }
        let (length, execution) = useful?;
        Some(run.continued(&acts[..length], execution))
    }

    /// Anything that the environment may do between steps.
    fn act(&mut self, execution: &Execution<'_>) -> Option<Act> {
        let configuration = self.configuration;
        let messages = configuration.receiving();
        // Without peers the choices are those of before.
        match self.random.random_range(0..if messages.is_empty() { 3 } else { 6 }) {
            5 => {
                let peer = self.random.random_range(0..configuration.peers.len());
                // Seldom, as everything begins again.
                (self.random.random_range(0..4) == 0).then_some(Act::Be(peer))
            }
            3 | 4 => {
                let (_, performative, message) =
                    messages.get(self.random.random_range(0..messages.len()))?;
                let types = message.said(*performative);
                let values = types
                    .iter()
                    .map(|ctype| self.numbers.any(ctype, configuration, &mut self.random));
                let about = message.name.text.clone();
                Some(Act::Receive(*performative, about, values.collect()))
            }
            0 => {
                let events = &configuration.triggerables;
                let event = events.get(self.random.random_range(0..events.len().max(1)))?;
                let types = match event.operator {
                    translator::syntax::ast::Operator::Add => {
                        parameters(configuration, &event.name.text)
                    }
                    translator::syntax::ast::Operator::Delete => &[],
                };
                let values = types
                    .iter()
                    .map(|ctype| self.numbers.any(ctype, configuration, &mut self.random));
                let values = values.collect();
                Some(Act::Raise(event.clone(), values))
            }
            1 => {
                let beliefs = &configuration.settables;
                let belief = beliefs.get(self.random.random_range(0..beliefs.len().max(1)))?;
                let types = parameters(configuration, &belief.text).iter();
                let values =
                    types.map(|ctype| self.numbers.any(ctype, configuration, &mut self.random));
                Some(Act::Set(belief.text.clone(), values.collect()))
            }
            _ => self.answer(execution),
        }
    }

    fn answer(&mut self, execution: &Execution<'_>) -> Option<Act> {
        let configuration = self.configuration;
        let trace = configuration.settings.trace.as_ref().map(|name| &name.text);
        let functions = configuration
            .basics
            .iter()
            .filter(|basic| basic.result.kind != TypeKind::Void && Some(&basic.name.text) != trace);
        let functions: Vec<_> = functions.collect();
        let function = functions.get(self.random.random_range(0..functions.len().max(1)))?;
        let name = &function.name.text;
        let count = if self.random.random_range(0..4) == 0 { 3 } else { 1 };
        let mut values: Vec<Value> = (0..count)
            .map(|_| self.numbers.any(&function.result, configuration, &mut self.random))
            .collect();
        let clock = configuration.settings.clock.as_ref();
        if clock.is_some_and(|clock| clock.text == *name) {
            // It never runs backwards.
            let Some(Value::Integer(now)) = execution.answer(name) else { return None };
            let (_, last) = function.result.integer_range()?;
            let later = now + self.numbers.duration(&mut self.random);
            values = vec![Value::Integer(later.min(last))];
        }
        Some(Act::Answer(name.clone(), values))
    }
}

/// The fewest runs that reach everything, as far as always taking the one that reaches the most finds them.
fn fewest(runs: &[Run<'_>], mut missing: BTreeSet<Goal>) -> Vec<Found> {
    let mut chosen = Vec::new();
    while let Some(best) = runs.iter().max_by_key(|run| {
        let new = run.seen.reached.intersection(&missing).count();
        // Of those that reach the same, the shortest.
        (new, usize::MAX - run.acts.len())
    }) {
        let reached = &best.seen.reached;
        if reached.is_disjoint(&missing) {
            break;
        }
        missing.retain(|goal| !reached.contains(goal));
        chosen.push(best.found());
    }
    chosen
}

/// Without answers that are replaced before a step.
fn without_effectless(acts: &[Act]) -> Vec<Act> {
    let mut kept: Vec<Act> = Vec::new();
    for act in acts {
        if let Act::Answer(function, _) = act {
            let begin = kept.iter().rposition(|act| *act == Act::Step).map_or(0, |step| step + 1);
            let replaced = kept[begin..].iter().position(
                |other| matches!(other, Act::Answer(replaced, _) if replaced == function),
            );
            if let Some(replaced) = replaced {
                kept.remove(begin + replaced);
            }
        }
        kept.push(act.clone());
    }
    kept
}
