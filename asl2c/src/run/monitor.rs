//! Monitors the properties of a running agent, by the rules of the language guide.

use std::collections::BTreeMap;

use translator::configuration::{
    CallBound, Cause, Comparison, Configuration, ExternalTrigger, Formula, Operand, Property,
};
use translator::interpreter::{Interpreter, Value};
use translator::syntax::ast::{Name, Operator, Performative, TriggerKind};

use super::values::parse;

/// The state of each property, in the order of the configuration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Monitors {
    states: Vec<State>,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct State {
    /// Remaining steps for the answer; 0 if none is due.
    due: u32,
    /// Whether the action may be called.
    allowed: bool,
}

/// Summary of a step.
pub(crate) struct Step<'a> {
    /// Number of calls of each basic action or function.
    pub(crate) calls: &'a BTreeMap<String, u32>,
    /// Whether an event was not handled completely.
    pub(crate) lost: bool,
}

impl Monitors {
    /// The state before the first event.
    pub(crate) fn new(configuration: &Configuration) -> Self {
        Self { states: vec![State::default(); configuration.properties.len()] }
    }

    /// The environment has dropped all events, and with them what is due.
    pub(crate) fn clear(&mut self) {
        for state in &mut self.states {
            state.due = 0;
        }
    }

    /// A peer has said something, which was accepted, and these are the agents before and after it.
    pub(crate) fn heard(
        &mut self,
        (sender, performative, about, is_news): (usize, Performative, &str, bool),
        configuration: &Configuration,
        before: &Interpreter,
        agent: &Interpreter,
    ) {
        // What is taken back before it is heard need not be answered.
        for (state, property) in self.states.iter_mut().zip(&configuration.properties) {
            if let Formula::Within { cause: Cause::Event(cause), .. } = &property.formula
                && cause.source.is_some()
                && waits(cause, before, configuration)
                && !waits(cause, agent, configuration)
            {
                state.due = 0;
            }
        }
        let (operator, kind) = match performative {
            Performative::Tell => (Operator::Add, TriggerKind::Belief),
            Performative::Untell => (Operator::Delete, TriggerKind::Belief),
            Performative::Achieve | Performative::Unachieve => {
                (Operator::Add, TriggerKind::Achieve)
            }
        };
        if let Some(peer) = configuration.peers.get(sender).filter(|_| is_news) {
            let name = Name { text: about.to_owned(), span: 0..0 };
            let source = Some(peer.clone());
            let event = ExternalTrigger { operator, kind, name, source, span: 0..0 };
            self.raised(&event, configuration, agent);
        }
    }

    /// The environment has raised an event that was accepted, or a peer has caused one.
    pub(crate) fn raised(
        &mut self,
        event: &ExternalTrigger,
        configuration: &Configuration,
        agent: &Interpreter,
    ) {
        for (state, property) in self.states.iter_mut().zip(&configuration.properties) {
            match &property.formula {
                Formula::Within { unless, .. } if unless.iter().any(|u| is_same(u, event)) => {
                    state.due = 0;
                }
                Formula::Within { steps, cause: Cause::Event(cause), unless, .. }
                    if is_same(cause, event) =>
                {
                    state.begin(*steps, unless, agent, configuration);
                }
                Formula::OnlyAfter { event: allows, .. } if is_same(allows, event) => {
                    state.allowed = true;
                }
                _ => {}
            }
        }
    }

    /// A step begins.
    pub(crate) fn begin_step(&mut self, configuration: &Configuration, agent: &Interpreter) {
        for (state, property) in self.states.iter_mut().zip(&configuration.properties) {
            if let Formula::Within { steps, cause: Cause::Comparison(comparison), unless, .. } =
                &property.formula
            {
                if compares(comparison, configuration, agent) {
                    state.begin(*steps, unless, agent, configuration);
                } else {
                    state.due = 0;
                }
            }
        }
    }

    /// A step has ended. Returns the properties that it violates.
    pub(crate) fn end_step<'a>(
        &mut self,
        step: &Step<'_>,
        configuration: &'a Configuration,
        agent: &Interpreter,
    ) -> Vec<&'a Property> {
        let count = |name: &Name| count(name, step.calls, configuration);
        let any = |names: &[Name]| names.iter().any(|name| count(name) > 0);
        let mut broken = Vec::new();
        for (state, property) in self.states.iter_mut().zip(&configuration.properties) {
            let holds = match &property.formula {
                Formula::AllHandled => !step.lost,
                Formula::Count { bound, action } => {
                    let count = count(action);
                    match bound {
                        CallBound::ExactlyOne => count == 1,
                        CallBound::AtMostOne => count <= 1,
                        CallBound::AtLeastOne => count >= 1,
                        CallBound::Never => count == 0,
                    }
                }
                Formula::Within { steps, cause, actions, unless } => {
                    let holds = state.answered(any(actions));
                    if let Cause::Action(cause) = cause
                        && count(cause) > 0
                    {
                        state.begin(*steps, unless, agent, configuration);
                    }
                    holds
                }
                Formula::OnlyAfter { action, event, until } => {
                    let holds = count(action) == 0 || state.allowed;
                    if any(until) && !waits(event, agent, configuration) {
                        state.allowed = false;
                    }
                    holds
                }
            };
            if !holds {
                broken.push(property);
            }
        }
        broken
    }
}

impl State {
    fn begin(
        &mut self,
        steps: u32,
        unless: &[ExternalTrigger],
        agent: &Interpreter,
        configuration: &Configuration,
    ) {
        if self.due == 0 && !unless.iter().any(|event| waits(event, agent, configuration)) {
            self.due = steps;
        }
    }

    /// Whether the answer came, or may still come.
    fn answered(&mut self, answered: bool) -> bool {
        if self.due == 0 {
            return true;
        }
        self.due = if answered { 0 } else { self.due - 1 };
        answered || self.due > 0
    }
}

fn is_same(one: &ExternalTrigger, other: &ExternalTrigger) -> bool {
    let source = |event: &ExternalTrigger| event.source.as_ref().map(|peer| peer.text.clone());
    (one.operator, one.kind, &one.name.text) == (other.operator, other.kind, &other.name.text)
        && source(one) == source(other)
}

fn waits(event: &ExternalTrigger, agent: &Interpreter, configuration: &Configuration) -> bool {
    let ExternalTrigger { operator, kind, name, source, .. } = event;
    match source {
        Some(peer) => configuration
            .peer(&peer.text)
            .is_some_and(|peer| agent.is_waiting_from(peer, *operator, *kind, &name.text)),
        None => agent.is_waiting(*operator, *kind, &name.text),
    }
}

fn count(name: &Name, calls: &BTreeMap<String, u32>, configuration: &Configuration) -> u32 {
    let calls = |name: &Name| calls.get(&name.text).copied().unwrap_or(0);
    let class = configuration.classes.iter().find(|class| class.name.text == name.text);
    class.map_or_else(|| calls(name), |class| class.actions.iter().map(calls).sum())
}

fn compares(comparison: &Comparison, configuration: &Configuration, agent: &Interpreter) -> bool {
    let value = |name: &Name| agent.believed_values(&name.text)?.first().cloned();
    let left = value(&comparison.left);
    let right = match &comparison.right {
        Operand::Belief(name) => value(name),
        Operand::Number(number) => {
            let mut declared = configuration.predicates.iter();
            let declared = declared.find(|other| other.name.text == comparison.left.text);
            let ctype = declared.and_then(|declared| declared.parameters.first());
            let sign = if number.negative { "-" } else { "" };
            ctype.and_then(|ctype| parse(&format!("{sign}{}", number.digits), ctype).ok())
        }
    };
    left.zip(right).is_some_and(|(left, right)| Value::compare(comparison.relation, &left, &right))
}
