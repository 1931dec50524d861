//! The reference interpreter: executes a syntax tree directly, by the rules of the language.
//!
//! It shares only the syntax tree with the C back end: it resolves names as it goes, matches at run time and
//! has its own detection of recursion. If both leave the same trace, the translation is right. It requires an
//! agent that [`crate::translate`] accepts.

mod age;
mod evaluate;
mod messages;
mod mind;
mod plans;
mod recursion;
mod said;
mod story;
mod value;

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet, HashSet, VecDeque};
use std::sync::Arc;

use self::evaluate::Substitution;
use self::messages::Mail;
use self::recursion::recursive_triggers;
pub use self::said::message_text;
use self::story::{Limit, Source};
pub use self::story::{trigger, with_values};
pub use self::value::Value;
use crate::configuration::Configuration;
use crate::syntax::ast::{
    Agent, Atom, Expression, Formula, Operator, Plan, Relation, Trigger, TriggerKind,
};
use crate::syntax::parse;
use crate::types::CType;
use crate::{CounterexampleStep, ParsedConfiguration};
use diagnostic::Span;

/// The environment of an interpreted agent.
pub trait Environment {
    /// Called at the start of each step. Returns the beliefs to set, each with one value for each argument.
    fn update_beliefs(&mut self) -> Vec<(String, Vec<Value>)>;
    /// Calls a basic action or function, or the clock; functions return a value of `result`, and without one the formula
    /// fails. A message is the action `send_tell_at`, whose first argument is the receiver's number.
    fn call(&mut self, name: &str, arguments: &[Value], result: &CType) -> Option<Value>;
    /// Log of each step: events, plans that apply or do not, and their actions. `None` disables it.
    fn story(&mut self) -> Option<&mut Vec<CounterexampleStep>> {
        None
    }
    /// Called with each plan that is chosen, and with the rest of one that waits each time it is tried: generated C
    /// calls the trace function then.
    fn chosen(&mut self) {}
    /// Called with each decision, for the measurement of coverage.
    fn decided(&mut self, _: Decision) {}
}

/// Something that the interpreter has decided. Places are byte ranges in the agent's text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Decision {
    /// A condition of a plan's trigger or context holds or not, or the time of `.wait` has come or not.
    Condition {
        /// The comparison, function, belief, pattern or formula.
        place: Span,
        /// Whether it holds.
        holds: bool,
    },
    /// Two values were compared.
    Compared {
        /// The comparison.
        place: Span,
        /// How the first is to the second; `None` if that is not defined, as for NaN.
        order: Option<Ordering>,
    },
    /// A plan is chosen, or does not apply.
    Plan {
        /// Its trigger.
        place: Span,
        /// Whether it is chosen.
        applies: bool,
    },
    /// A formula of a body was executed.
    Formula {
        /// The formula.
        place: Span,
        /// Whether it succeeded.
        succeeded: bool,
    },
}

/// An external event that was refused because the inbox is full.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the inbox is full")]
#[non_exhaustive]
pub struct Refused;

/// A step exceeded its limit. Each step terminates, but its length may be exponential in the number of plans.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the step is too long")]
#[non_exhaustive]
pub struct TooLong;

/// A trigger: operator, kind and name.
type Key = (Operator, TriggerKind, String);

#[derive(Debug, Clone, PartialEq)]
struct Event {
    key: Key,
    arguments: Vec<Value>,
    origin: Origin,
}

/// Cause of an event.
#[derive(Debug, Clone, PartialEq)]
enum Origin {
    /// A plan, or a belief that was set.
    Agent,
    Environment,
    /// The rest of a plan that waits.
    Wait(Box<Waiting>),
    /// A goal whose deadline has passed.
    Overdue,
}

/// A plan that waits.
#[derive(Debug, Clone, PartialEq)]
struct Waiting {
    due: Value,
    plan: Plan,
    /// The next formula.
    next: usize,
    theta: Substitution,
}

/// Deadline of the pending event.
#[derive(Debug, Clone, PartialEq)]
struct Deadline {
    goal: Key,
    arguments: Vec<Value>,
    due: Value,
}

/// Result of the plans of one trigger.
#[derive(Debug, Clone, PartialEq)]
enum Outcome {
    /// No plan is applicable.
    NoPlan,
    /// The chosen plan failed.
    Failed,
    /// The plan succeeded, with the queried arguments.
    Achieved(Vec<Value>),
}

/// An agent that is executed without translation.
#[derive(Debug, Clone)]
pub struct Interpreter {
    configuration: Arc<Configuration>,
    agent: Arc<Agent>,
    source: Arc<Source>,
    recursive: Arc<HashSet<Key>>,
    limit: Limit,
    beliefs: BTreeMap<String, Vec<Value>>,
    posted: Option<Event>,
    deadline: Option<Deadline>,
    inbox: VecDeque<Event>,
    preemptive: Vec<Event>,
    /// Changed beliefs whose events are pending.
    perceived: BTreeSet<String>,
    deferred: VecDeque<Event>,
    mail: Mail,
    unhandled: u32,
    refused: u32,
    aborted: u32,
}

impl Interpreter {
    /// An agent before its first step.
    ///
    /// # Errors
    /// As [`crate::translate`].
    pub fn new(
        configuration: &ParsedConfiguration,
        agent_text: &str,
    ) -> Result<Self, crate::TranslateError> {
        crate::translate(configuration, agent_text)?;
        let (agent, _) = parse(agent_text);
        let mut interpreter = Self {
            configuration: Arc::new(configuration.configuration.clone()),
            recursive: Arc::new(recursive_triggers(&agent)),
            agent: Arc::new(agent),
            source: Arc::new(Source::new(agent_text)),
            limit: Limit::NONE,
            beliefs: BTreeMap::new(),
            posted: None,
            deadline: None,
            inbox: VecDeque::new(),
            preemptive: Vec::new(),
            perceived: BTreeSet::new(),
            deferred: VecDeque::new(),
            mail: Mail::default(),
            unhandled: 0,
            refused: 0,
            aborted: 0,
        };
        interpreter.init();
        Ok(interpreter)
    }

    /// Resets to the initial beliefs; the initial goal runs in the first step.
    pub fn init(&mut self) {
        self.beliefs = self
            .agent
            .beliefs
            .iter()
            .map(|belief| (belief.name.text.clone(), self.constants(belief)))
            .collect();
        self.mail.reset();
        self.unhandled = 0;
        self.refused = 0;
        self.aborted = 0;
        self.clear();
    }

    /// Drops all events and keeps the beliefs; the initial goal runs in the next step.
    pub fn clear(&mut self) {
        self.posted = self.agent.goal.as_ref().map(|goal| Event {
            key: (Operator::Add, TriggerKind::Achieve, goal.name.text.clone()),
            arguments: self.own(TriggerKind::Achieve, &goal.name.text, self.constants(goal)),
            origin: Origin::Agent,
        });
        self.deadline = None;
        self.inbox.clear();
        self.preemptive.clear();
        self.perceived.clear();
        self.deferred.clear();
        self.mail.clear();
    }

    /// Whether the next external event will be accepted.
    pub fn can_add_event(&self) -> bool {
        self.inbox.iter().filter(|event| event.is_external()).count()
            < self.configuration.settings.inbox as usize
    }

    /// Number of events that no plan handled completely, and of deferred goals for which the queue had no room.
    pub fn unhandled_events(&self) -> u32 {
        self.unhandled
    }

    /// Number of external events, and of goals of peers, that were refused because there was no room for them.
    pub fn refused_events(&self) -> u32 {
        self.refused
    }

    /// Number of posted events that were replaced by a pre-empting one.
    pub fn aborted_events(&self) -> u32 {
        self.aborted
    }

    /// Raises `+!name`, `+name` or `-name`.
    ///
    /// # Errors
    /// [`Refused`] if the inbox is full; pre-empting events are always accepted.
    pub fn raise(
        &mut self,
        operator: Operator,
        kind: TriggerKind,
        name: &str,
        arguments: Vec<Value>,
    ) -> Result<(), Refused> {
        let key = (operator, kind, name.to_owned());
        // A belief is stored without its source.
        let arguments =
            if kind == TriggerKind::Achieve { self.own(kind, name, arguments) } else { arguments };
        let event = Event { key, arguments, origin: Origin::Environment };
        let preempts = self.configuration.preemptive.iter().any(|trigger| {
            (trigger.operator, trigger.kind, trigger.name.text.as_str()) == (operator, kind, name)
        });
        if preempts {
            self.preemptive.retain(|waiting| waiting.key != event.key);
            self.preemptive.push(event);
        } else if self.can_add_event() {
            self.inbox.push_back(event);
        } else {
            self.refused = self.refused.saturating_add(1);
            return Err(Refused);
        }
        Ok(())
    }

    /// Sets `belief` to these values, one for each argument; if it is perceived, a change raises an event.
    pub fn set(&mut self, belief: String, values: Vec<Value>) {
        let watched = self.configuration.perceived.iter().any(|name| name.text == belief);
        let old = self.beliefs.insert(belief.clone(), values);
        let same = old.is_some_and(|old| Value::all_equal(&old, &self.beliefs[&belief]));
        if watched && !same {
            self.perceived.insert(belief);
        }
    }

    /// One deliberation cycle that tries at most this number of plans and formulas together.
    ///
    /// # Errors
    /// [`TooLong`] if the limit is exceeded, or if more than 2000 calls of plans are nested. The agent's state is then
    /// undefined.
    pub fn next_step_within(
        &mut self,
        formulae: u32,
        environment: &mut dyn Environment,
    ) -> Result<(), TooLong> {
        self.limit = Limit::new(formulae);
        self.next_step(environment);
        let exceeded = self.limit.is_exceeded();
        self.limit = Limit::NONE;
        if exceeded { Err(TooLong) } else { Ok(()) }
    }

    /// One deliberation cycle.
    pub fn next_step(&mut self, environment: &mut dyn Environment) {
        for (belief, values) in environment.update_beliefs() {
            self.set(belief, values);
        }
        while let Some(mut event) = self.take_event(environment) {
            let (operator, kind, name) = event.key.clone();
            if event.is_external() && kind == TriggerKind::Belief {
                if operator == Operator::Add {
                    self.beliefs.insert(name.clone(), event.arguments.clone());
                } else if let Some(old) = self.beliefs.remove(&name) {
                    // The event has no arguments: its plans get the old values of the belief.
                    event.arguments = old;
                } else {
                    continue;
                }
                event.arguments = self.own(kind, &name, event.arguments);
                if !self.has_plans(&event.key) {
                    continue;
                }
            }
            self.log_event(&event, environment);
            self.handle(event, environment);
            if self.posted.is_none() {
                self.deadline = None;
            }
            return;
        }
    }

    fn handle(&mut self, event: Event, environment: &mut dyn Environment) {
        let Event { key, arguments, origin } = event;
        let given: Vec<Option<Value>> = arguments.into_iter().map(Some).collect();
        let outcome = match origin {
            Origin::Agent | Origin::Environment => self.run_with_failure(&key, &given, environment),
            Origin::Wait(waiting) => self.resume(&key, *waiting, &given, environment),
            Origin::Overdue => self.mend(&key, Outcome::Failed, &given, environment),
        };
        let fine = match outcome {
            Outcome::Achieved(_) => true,
            // A percept without an applicable plan is not a failure.
            Outcome::NoPlan => key.1 == TriggerKind::Belief,
            Outcome::Failed => false,
        };
        if !fine {
            self.unhandled = self.unhandled.saturating_add(1);
        }
    }

    /// Takes the next event.
    fn take_event(&mut self, environment: &mut dyn Environment) -> Option<Event> {
        let configuration = Arc::clone(&self.configuration);
        for trigger in &configuration.preemptive {
            let is_it = |event: &Event| {
                (trigger.operator, trigger.kind, &trigger.name.text)
                    == (event.key.0, event.key.1, &event.key.2)
            };
            // What the environment raises comes before what peers ask for.
            let raised = self.preemptive.iter().position(is_it);
            let raised = raised.map(|index| self.preemptive.remove(index));
            if let Some(event) = raised.or_else(|| self.next_urgent(&trigger.name.text)) {
                self.aborted = self.aborted.saturating_add(u32::from(self.posted.is_some()));
                self.posted = None;
                self.deadline = None;
                return Some(event);
            }
        }
        if let Some(event) = self.posted.take() {
            let overdue = self
                .deadline
                .take_if(|deadline| Self::is_due(&self.configuration, &deadline.due, environment));
            return Some(overdue.map_or(event, |Deadline { goal, arguments, .. }| Event {
                key: goal,
                arguments,
                origin: Origin::Overdue,
            }));
        }
        for name in &self.configuration.perceived {
            // A belief that has been deleted meanwhile raises no event.
            if self.perceived.remove(&name.text)
                && let Some(arguments) = self.beliefs.get(&name.text).cloned()
            {
                let key = (Operator::Add, TriggerKind::Belief, name.text.clone());
                let arguments = self.own(TriggerKind::Belief, &name.text, arguments);
                return Some(Event { key, arguments, origin: Origin::Agent });
            }
        }
        if let Some(event) = self.next_message() {
            return Some(event);
        }
        self.inbox.pop_front().or_else(|| self.deferred.pop_front())
    }

    /// Whether the clock has reached a time.
    fn is_due(
        configuration: &Configuration,
        due: &Value,
        environment: &mut dyn Environment,
    ) -> bool {
        let clock = configuration.settings.clock.as_ref();
        let basics = &configuration.basics;
        let clock = clock.and_then(|name| basics.iter().find(|b| b.name.text == name.text));
        let now = clock.and_then(|clock| environment.call(&clock.name.text, &[], &clock.result));
        now.is_some_and(|now| !Value::compare(Relation::Less, &now, due))
    }

    fn defer(&mut self, key: Key, arguments: Vec<Value>) {
        let event = Event { key, arguments, origin: Origin::Agent };
        if self.configuration.settings.queue {
            // Each deferred goal is a separate element, as long as there is room: that of the external
            // events, plus one for each `!!` of the agent up to 64.
            let ours = self.inbox.iter().filter(|event| !event.is_external()).count();
            let formulae = self.agent.plans.iter().flat_map(|plan| &plan.body);
            let defers = formulae.filter(|formula| matches!(formula, Formula::Defer(_))).count();
            if ours < self.configuration.settings.inbox as usize + defers.min(64) {
                self.inbox.push_back(event);
            } else {
                self.unhandled = self.unhandled.saturating_add(1);
            }
            return;
        }
        match self.deferred.iter_mut().find(|waiting| waiting.key == event.key) {
            Some(waiting) => waiting.arguments = event.arguments,
            None => self.deferred.push_back(event),
        }
    }

    fn constants(&self, atom: &Atom) -> Vec<Value> {
        let pairs = atom.arguments.iter().zip(self.types(&atom.name.text));
        let value = |expression: &Expression, ctype: &CType| match expression {
            Expression::Atom(atom) => self.peer_named(atom),
            other => Value::constant(other, ctype),
        };
        pairs.filter_map(|(expression, ctype)| value(expression, &ctype)).collect()
    }

    fn types(&self, predicate: &str) -> Vec<CType> {
        let declared =
            self.configuration.predicates.iter().find(|other| other.name.text == predicate);
        declared.map_or(Vec::new(), |declared| declared.parameters.clone())
    }

    fn has_plans(&self, key: &Key) -> bool {
        self.agent.plans.iter().any(|plan| key_of(&plan.trigger) == *key)
    }
}

impl Event {
    fn is_external(&self) -> bool {
        matches!(self.origin, Origin::Environment)
    }
}

fn key_of(trigger: &Trigger) -> Key {
    (trigger.operator, trigger.kind, trigger.atom.name.text.clone())
}
