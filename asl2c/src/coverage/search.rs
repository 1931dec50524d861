//! Finds tests that reach every decision of an agent: the reference interpreter is run with random calls and answers,
//! what reaches something new is continued, and the fewest executions that reach everything found are the tests.

use std::collections::BTreeSet;

use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use translator::configuration::Configuration;
use translator::interpreter::{Interpreter, Value};
use translator::types::TypeKind;
use translator::{Act, ParsedConfiguration, TranslateError};

use super::values::Numbers;
use super::world::{Execution, Goal};
use crate::run::parameters;

/// The search ends after this number of continuations that reached nothing new, ..
const PATIENCE: u32 = 20_000;
/// .. or this number altogether.
const MOST: u32 = 200_000;
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

struct Run<'a> {
    acts: Vec<Act>,
    execution: Execution<'a>,
}

impl Run<'_> {
    fn found(&self) -> Found {
        let plans = self.execution.reached().iter().filter_map(|goal| match goal {
            Goal::Plan(place, true) => Some(*place),
            _ => None,
        });
        Found {
            acts: without_effectless(&self.acts),
            trace: self.execution.trace(),
            plans: plans.collect(),
        }
    }
}

/// The tests of an agent: the same ones each time.
pub(super) fn search(
    configuration: &ParsedConfiguration,
    text: &str,
) -> Result<Vec<Found>, TranslateError> {
    let agent = Interpreter::new(configuration, text)?;
    let configuration = configuration.declarations();
    let mut search =
        Search { configuration, numbers: Numbers::new(text), random: ChaCha8Rng::seed_from_u64(1) };
    let first = Run { acts: Vec::new(), execution: Execution::new(agent, configuration) };
    // What is proved of agents is proved without `clear()`: this test alone has it.
    let mut cleared = Run { acts: Vec::new(), execution: first.execution.clone() };
    for act in [Act::Step, Act::Clear, Act::Step] {
        cleared.execution.execute(&act);
        cleared.acts.push(act);
    }
    let mut runs = vec![first];
    let mut reached: BTreeSet<Goal> = BTreeSet::new();
    let mut idle = 0;
    for _ in 0..MOST {
        idle += 1;
        if idle > PATIENCE {
            break;
        }
        let Some(continued) = search.continued(&runs, &reached) else { continue };
        reached.extend(continued.execution.reached().iter().cloned());
        runs.push(continued);
        idle = 0;
    }
    let mut found = fewest(&runs, reached);
    found.push(cleared.found());
    Ok(found)
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
        let mut acts = run.acts.clone();
        let mut execution = run.execution.clone();
        let mut useful: Option<(usize, usize, Execution<'a>)> = None;
        for _ in 0..self.random.random_range(1..=6) {
            for _ in 0..self.random.random_range(0..=3) {
                if let Some(act) = self.act(&execution) {
                    execution.execute(&act);
                    acts.push(act);
                }
            }
            acts.push(Act::Step);
            if !execution.execute(&Act::Step) {
                break;
            }
            let known = useful.as_ref().map_or(0, |(count, ..)| *count);
            let new = execution.reached().difference(reached).count();
            if new > known {
                useful = Some((new, acts.len(), execution.clone()));
            }
        }
        let (_, length, execution) = useful?;
        acts.truncate(length);
        Some(Run { acts, execution })
    }

    /// Anything that the environment may do between steps.
    fn act(&mut self, execution: &Execution<'_>) -> Option<Act> {
        let configuration = self.configuration;
        match self.random.random_range(0..3) {
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
        let new = run.execution.reached().intersection(&missing).count();
        // Of those that reach the same, the shortest.
        (new, usize::MAX - run.acts.len())
    }) {
        let reached = best.execution.reached();
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
