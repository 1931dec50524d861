//! Model of an agent for the model checker SPIN, and the interpretation of its replays.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::DeclaredProperty;
use crate::backend::promela::{MARK, PROPERTY, Waiting, emit, events};
use crate::program::{Program, trigger_text};

/// A model of an agent in Promela.
///
/// Beliefs are held or not. Their values, the results of functions and the outcome of comparisons are
/// nondeterministic, except for the comparisons in properties. A property that holds in the model therefore
/// holds in every environment, while a counterexample may need an environment that cannot exist.
#[derive(Debug)]
#[non_exhaustive]
#[must_use = "the model has to be checked"]
pub struct Model {
    /// The properties, in the order of their numbers.
    pub properties: Vec<DeclaredProperty>,
    program: Program,
}

/// A step of a counterexample, in the agent's terms.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct CounterexampleStep {
    /// Nesting depth: 0 for the environment and for steps, 1 for plans, 2 for the actions of plans.
    pub depth: usize,
    /// The line of the agent's source, if there is one.
    pub line: Option<usize>,
    /// Description.
    pub text: String,
}

impl CounterexampleStep {
    /// A step of a counterexample.
    pub fn new(depth: usize, line: Option<usize>, text: String) -> Self {
        Self { depth, line, text }
    }
}

impl fmt::Display for CounterexampleStep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let indentation = "  ".repeat(self.depth);
        match self.line {
            Some(line) => write!(f, "{indentation}line {line}: {}", self.text),
            None => write!(f, "{indentation}{}", self.text),
        }
    }
}

impl Model {
    pub(crate) fn new(program: Program, properties: Vec<DeclaredProperty>) -> Self {
        Self { properties, program }
    }

    /// The environment variable that selects the property to check, counted from 1.
    pub fn selector(&self) -> &'static str {
        PROPERTY
    }

    /// The AgentSpeak source's name.
    pub fn input(&self) -> &str {
        &self.program.configuration.settings.input
    }

    /// The number by which a property is selected that is false in each agent: some step ends.
    pub fn falsehood(&self) -> usize {
        self.properties.len() + 1
    }

    /// The model in Promela.
    pub fn promela(&self) -> String {
        emit(&self.program)
    }

    /// Translates the replay of a counterexample to the agent's terms.
    pub fn explain(&self, replay: &str) -> Vec<CounterexampleStep> {
        let lines = replay.lines().filter_map(|line| line.trim().strip_prefix(MARK));
        let lines: Vec<Vec<&str>> = lines.map(|line| line.split_whitespace().collect()).collect();
        let mut happenings: Vec<CounterexampleStep> = Vec::new();
        let mut steps = 0_usize;
        let mut idle_from = None;
        for (index, words) in lines.iter().enumerate() {
            let Some((what, numbers)) = words.split_first() else { continue };
            let numbers: Vec<usize> = numbers.iter().filter_map(|n| n.parse().ok()).collect();
            if *what != "step" {
                happenings.extend(self.happening(what, &numbers));
                continue;
            }
            steps += 1;
            let handles = lines.get(index + 1).is_some_and(|next| next.first() == Some(&"event"));
            let text = match idle_from.filter(|_| !handles) {
                // Consecutive steps without an event share one line.
                Some(first) => {
                    happenings.pop();
                    format!("steps {first} to {steps}: no event is pending")
                }
                None if handles => format!("step {steps}"),
                None => format!("step {steps}: no event is pending"),
            };
            happenings.push(CounterexampleStep { depth: 0, line: None, text });
            let alone = lines.get(index + 1).is_none_or(|next| next.first() == Some(&"step"));
            idle_from = (!handles && alone).then(|| idle_from.unwrap_or(steps));
        }
        happenings
    }

    fn happening(&self, what: &str, numbers: &[usize]) -> Option<CounterexampleStep> {
        let at = |depth, line, text| Some(CounterexampleStep { depth, line, text });
        let first = numbers.first().copied();
        match what {
            "raise" => at(0, None, format!("the environment raises {}", self.event(first?)?)),
            "set" => {
                let belief = self.program.beliefs.get(first?)?;
                at(0, None, format!("the environment sets `{}`", belief.name))
            }
            "asks" | "unasks" => {
                let asked = self.program.asked.get(first?)?;
                let peer = &self.program.configuration.peers.get(asked.sender)?.text;
                let what = if what == "asks" { "asks for" } else { "no longer asks for" };
                at(0, None, format!("{peer} {what} `{}`", asked.name))
            }
            "tells" | "untells" => {
                let told = self.program.told.get(first?)?;
                let peer = &self.program.configuration.peers.get(told.sender)?.text;
                let what = if what == "tells" { "tells" } else { "takes back" };
                at(0, None, format!("{peer} {what} `{}`", told.name))
            }
            "event" => at(1, None, format!("handles {}", self.event(first?)?)),
            "plan" => {
                let (_, _, plan) = self.program.plans().nth(first?)?;
                let head = plan.source.split("<-").next().unwrap_or_default();
                let head = head.split_whitespace().collect::<Vec<_>>().join(" ");
                at(1, Some(plan.lines.0), format!("plan {head}"))
            }
            "action" => {
                let basic = self.program.configuration.basics.get(first?)?;
                at(2, numbers.get(1).copied().filter(|line| *line > 0), basic.name.text.clone())
            }
            "fails" => at(2, first, "fails".to_owned()),
            "unplanned" => {
                let handler = self.program.handlers.get(first?)?;
                at(1, None, format!("no plan for {} applies", handler.text()))
            }
            _ => None,
        }
    }

    /// Description of an event by its number, with its cause.
    fn event(&self, number: usize) -> Option<String> {
        let handler = |id| self.program.handler(id).text();
        Some(match events(&self.program).get(number.checked_sub(1)?)? {
            Waiting::Posted(id) => handler(*id),
            Waiting::Overdue(id) => format!("the deadline of {}", handler(*id)),
            Waiting::Perceived(_, id) => format!("{}, which was perceived", handler(*id)),
            Waiting::Asked(index) => {
                let asked = self.program.asked.get(*index)?;
                let peer = &self.program.configuration.peers.get(asked.sender)?.text;
                format!("+!{}[source({peer})]", asked.name)
            }
            Waiting::Told(index) => {
                let told = self.program.told.get(*index)?;
                let peer = &self.program.configuration.peers.get(told.sender)?.text;
                format!("what {peer} said of `{}`", told.name)
            }
            Waiting::External(index) => {
                let external = self.program.external.get(*index)?;
                trigger_text(external.operator, external.kind, &external.name)
            }
            Waiting::Deferred(id) => format!("{}, which was deferred", handler(*id)),
        })
    }
}
