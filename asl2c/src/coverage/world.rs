//! The environment of a test: answers of functions, and the trace of all calls.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fmt::Write as _;

use translator::configuration::{Basic, Configuration};
use translator::interpreter::{Decision, Environment, Interpreter, Value};
use translator::types::{CType, TypeKind};
use translator::{Act, traced};

use crate::run::{call_name, parameters, zero};

/// Maximum number of plans and formulas that one step may try.
const LONGEST: u32 = 100_000;

/// Something that a test reaches: a decision and its outcome, or a state of the events.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Goal {
    /// A condition at these bytes of the agent's text holds or not.
    Condition(usize, usize, bool),
    /// In the comparison there the first value is less, equal or greater, or not to be compared.
    Compared(usize, Option<Ordering>),
    /// The plan with this trigger is chosen or not.
    Plan(usize, bool),
    /// A formula succeeds or not.
    Formula(usize, bool),
    /// A step begins with this event as the next one, or with none.
    Next(String),
    /// While this event is the next one, an event is refused, aborted, or not handled completely.
    Counted(usize, String),
    /// So many events wait.
    Waiting(usize),
}

impl Goal {
    /// Whether it is a decision in the agent's text.
    pub(super) fn is_decision(&self) -> bool {
        matches!(self, Self::Condition(..) | Self::Compared(..) | Self::Plan(..))
    }
}

/// A test in execution.
#[derive(Debug, Clone)]
pub(super) struct Execution<'a> {
    configuration: &'a Configuration,
    agent: Interpreter,
    world: World<'a>,
    /// The next event, without its values; empty if there is none.
    next: String,
}

#[derive(Debug, Clone)]
struct World<'a> {
    configuration: &'a Configuration,
    /// The actions that send messages.
    sending: Vec<Basic>,
    answers: BTreeMap<String, VecDeque<Value>>,
    seen: Seen,
    /// Of what was reached, what was not reached before.
    new: Vec<Goal>,
}

/// What was seen of an execution.
#[derive(Debug, Clone, Default)]
pub(super) struct Seen {
    /// All calls, in the form of [`translator::scripted`], without the test's number.
    pub(super) trace: String,
    /// What was reached.
    pub(super) reached: BTreeSet<Goal>,
}

impl Seen {
    /// Adds what was seen after it.
    pub(super) fn append(&mut self, later: Self) {
        self.trace += &later.trace;
        self.reached.extend(later.reached);
    }
}

impl<'a> Execution<'a> {
    /// Before the first act: functions return 0, `false` or the like.
    pub(super) fn new(agent: Interpreter, configuration: &'a Configuration) -> Self {
        let functions =
            configuration.basics.iter().filter(|basic| basic.result.kind != TypeKind::Void);
        let answers = functions.map(|basic| {
            (basic.name.text.clone(), VecDeque::from([zero(&basic.result, configuration)]))
        });
        let answers = answers.collect();
        let world = World {
            configuration,
            sending: configuration.sending(),
            answers,
            seen: Seen::default(),
            new: Vec::new(),
        };
        let next = without_values(agent.waiting());
        Self { configuration, agent, world, next }
    }

    /// Takes away what was reached for the first time since the last call, and since what was seen was taken away.
    pub(super) fn take_new(&mut self) -> Vec<Goal> {
        std::mem::take(&mut self.world.new)
    }

    /// Takes away what was seen until now: whatever is continued often is copied without it.
    pub(super) fn take_seen(&mut self) -> Seen {
        self.world.new.clear();
        std::mem::take(&mut self.world.seen)
    }

    /// What its functions say of the events at its end, in the form of the trace.
    pub(super) fn at_the_end(&self) -> String {
        let mut trace = String::new();
        // Writing to a string cannot fail.
        _ = writeln!(trace, "> can_add_event() = {}", self.agent.can_add_event());
        for (name, count) in self.counts() {
            _ = writeln!(trace, "> {name}_events() = {count}");
        }
        trace
    }

    /// The next answer of a function.
    pub(super) fn answer(&self, function: &str) -> Option<&Value> {
        self.world.answers.get(function).and_then(VecDeque::front)
    }

    fn counts(&self) -> Vec<(&'static str, u32)> {
        let mut counts = vec![
            ("unhandled", self.agent.unhandled_events()),
            ("refused", self.agent.refused_events()),
        ];
        // Only agents with pre-empting events have the function.
        if !self.configuration.preemptive.is_empty() {
            counts.push(("aborted", self.agent.aborted_events()));
        }
        counts
    }

    /// The next event, without its values; empty if there is none.
    pub(super) fn next(&self) -> &str {
        &self.next
    }

    /// Executes an act. False if a step is too long: the state is undefined then.
    pub(super) fn execute(&mut self, act: &Act) -> bool {
        let trace = |values: &[Value], types: &[CType]| {
            let values = values.iter().zip(types);
            let values = values.map(|(value, ctype)| traced(value, ctype, self.configuration));
            values.collect::<Vec<_>>().join(", ")
        };
        let before = self.counts();
        match act {
            Act::Raise(event, values) => {
                let name = &event.name.text;
                let values_text = trace(values, parameters(self.configuration, name));
                let result = self.agent.raise(event.operator, event.kind, name, values.clone());
                let accepted = result.is_ok();
                let call = call_name(event);
                _ = writeln!(self.world.seen.trace, "> {call}({values_text}) = {accepted}");
            }
            Act::Set(belief, values) => {
                let values_text = trace(values, parameters(self.configuration, belief));
                _ = writeln!(self.world.seen.trace, "> set_{belief}({values_text})");
                self.agent.set(belief.clone(), values.clone());
            }
            Act::Receive(performative, about, values) => {
                let message = self.configuration.message(*performative, about);
                let types = message.map_or_else(Vec::new, |message| message.said(*performative));
                let values_text = trace(values, &types);
                let (sender, said) = match values.split_first() {
                    Some((Value::Integer(sender), said)) => (usize::try_from(*sender), said),
                    _ => return true,
                };
                // The clock may be called before the answer is known.
                let call = format!("receive_{}_{about}", performative.name());
                _ = write!(self.world.seen.trace, "> {call}({values_text}) = ");
                let accepted = sender.is_ok_and(|sender| {
                    let said = said.to_vec();
                    self.agent.receive(sender, *performative, about, said, &mut self.world)
                });
                _ = writeln!(self.world.seen.trace, "{accepted}");
            }
            Act::Be(peer) => {
                self.world.seen.trace += "> init()\n";
                self.agent.be(*peer);
            }
            Act::Answer(function, values) => {
                self.world.answers.insert(function.clone(), values.iter().cloned().collect());
            }
            Act::Clear => {
                self.world.seen.trace += "> clear()\n";
                self.agent.clear();
            }
            Act::Step => {
                self.world.seen.trace += "> next_step()\n";
                self.world.reach(Goal::Next(self.next.clone()));
                if self.agent.next_step_within(LONGEST, &mut self.world).is_err() {
                    return false;
                }
            }
        }
        for (index, (before, after)) in before.iter().zip(self.counts()).enumerate() {
            if before.1 != after.1 {
                self.world.reach(Goal::Counted(index, self.next.clone()));
            }
        }
        let waiting = self.agent.waiting();
        self.world.reach(Goal::Waiting(waiting.len()));
        self.next = without_values(waiting);
        true
    }
}

/// The first of these events, without its values.
fn without_values(waiting: Vec<String>) -> String {
    let mut name = waiting.into_iter().next().unwrap_or_default();
    let mut depth = 0;
    name.retain(|character| {
        depth += i32::from(character == '(');
        let is_outside = depth == 0 && !character.is_ascii_digit();
        depth -= i32::from(character == ')');
        is_outside
    });
    name
}

impl World<'_> {
    fn reach(&mut self, goal: Goal) {
        if !self.seen.reached.contains(&goal) {
            self.new.push(goal.clone());
            self.seen.reached.insert(goal);
        }
    }
}

impl Environment for World<'_> {
    fn update_beliefs(&mut self) -> Vec<(String, Vec<Value>)> {
        Vec::new()
    }

    fn call(&mut self, name: &str, arguments: &[Value], result: &CType) -> Option<Value> {
        let mut actions = self.configuration.basics.iter().chain(&self.sending);
        let basic = actions.find(|basic| basic.name.text == name);
        let types = basic.map_or(&[][..], |basic| &basic.parameters);
        let values = arguments.iter().zip(types);
        let values: Vec<String> =
            values.map(|(value, ctype)| traced(value, ctype, self.configuration)).collect();
        _ = write!(self.seen.trace, "{name}({})", values.join(", "));
        let answer = if result.kind == TypeKind::Void {
            None
        } else {
            let answers = self.answers.get_mut(name)?;
            let answer = answers.front().cloned()?;
            if answers.len() > 1 {
                answers.pop_front();
            }
            _ = write!(self.seen.trace, " = {}", traced(&answer, result, self.configuration));
            Some(answer)
        };
        self.seen.trace.push('\n');
        answer
    }

    fn decided(&mut self, decision: Decision) {
        self.reach(match decision {
            Decision::Condition { place, holds } => Goal::Condition(place.start, place.end, holds),
            Decision::Compared { place, order } => Goal::Compared(place.start, order),
            Decision::Plan { place, applies } => Goal::Plan(place.start, applies),
            Decision::Formula { place, succeeded } => Goal::Formula(place.start, succeeded),
        });
    }
}
