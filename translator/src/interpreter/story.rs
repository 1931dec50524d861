//! Log of a step in the agent's terms, and the limit of its length.

use super::{Environment, Event, Interpreter, Key, Origin, Value};
use crate::CounterexampleStep;
use crate::program::trigger_text;
use crate::syntax::ast::{Atom, Formula, Operator, Plan, TriggerKind};

/// The agent's text, for quotes and line numbers.
#[derive(Debug)]
pub(super) struct Source {
    text: String,
    /// Ends of the lines.
    ends: Vec<usize>,
}

impl Source {
    pub(super) fn new(text: &str) -> Self {
        let ends = text.match_indices('\n').map(|(index, _)| index).collect();
        Self { text: text.to_owned(), ends }
    }

    fn line(&self, offset: usize) -> usize {
        self.ends.partition_point(|end| *end < offset) + 1
    }

    /// Label, trigger and context of a plan, with single blanks.
    fn head(&self, plan: &Plan) -> String {
        let context = plan.context.as_ref().map_or(plan.trigger.span.end, |c| c.span().end);
        let head = self.text.get(plan.trigger.span.start..context).unwrap_or_default();
        let head = head.split_whitespace().collect::<Vec<_>>().join(" ");
        // The context's span has no closing parentheses.
        let open = head.matches('(').count().saturating_sub(head.matches(')').count());
        let label = plan.label.as_ref().map_or(String::new(), |label| format!("@{} ", label.text));
        format!("{label}{head}{}", ")".repeat(open))
    }
}

/// Remaining work of a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limit {
    left: u32,
    depth: usize,
    deepest: usize,
    exceeded: bool,
}

/// Maximum nesting of calls in a limited step.
const DEEPEST: usize = 2000;

impl Limit {
    /// No limit.
    pub(super) const NONE: Self =
        Self { left: u32::MAX, depth: 0, deepest: usize::MAX, exceeded: false };

    pub(super) fn new(left: u32) -> Self {
        Self { left, deepest: DEEPEST, ..Self::NONE }
    }

    pub(super) fn is_exceeded(&self) -> bool {
        self.exceeded
    }

    /// Whether one more formula or plan may be tried.
    pub(super) fn spend(&mut self) -> bool {
        if self.deepest == usize::MAX {
            return true;
        }
        self.exceeded |= self.left == 0;
        self.left = self.left.saturating_sub(1);
        !self.exceeded
    }

    /// Whether plans may be called from here.
    pub(super) fn descend(&mut self) -> bool {
        self.exceeded |= self.depth >= self.deepest;
        self.depth += usize::from(!self.exceeded);
        !self.exceeded
    }

    pub(super) fn ascend(&mut self) {
        self.depth = self.depth.saturating_sub(1);
    }
}

/// An event in AgentSpeak: `+!goTo(1, 2)`.
pub fn trigger(operator: Operator, kind: TriggerKind, name: &str, values: &[Value]) -> String {
    with_values(&trigger_text(operator, kind, name), values)
}

/// A name with its values, if there are any: `goTo(1, 2)`.
pub fn with_values(head: &str, values: &[Value]) -> String {
    if values.is_empty() {
        return head.to_owned();
    }
    let values: Vec<String> = values.iter().map(Value::to_string).collect();
    format!("{head}({})", values.join(", "))
}

pub(super) fn key_text(key: &Key) -> String {
    trigger_text(key.0, key.1, &key.2)
}

impl Interpreter {
    /// The event in AgentSpeak, with its cause.
    pub(super) fn event_text(&self, event: &Event, posted: &str) -> String {
        let head = self.with_source(&event.key, &event.arguments);
        match &event.origin {
            Origin::Agent => format!("{head}{posted}"),
            Origin::Environment => format!("{head}, raised by the environment"),
            Origin::Wait(waiting) => format!("{head}, which waits until {}", waiting.due),
            Origin::Overdue => format!("the deadline of {head}"),
        }
    }

    /// A trigger with its values, and with where it comes from if its plans are told.
    pub(super) fn with_source(&self, key: &Key, values: &[Value]) -> String {
        let is_sourced = self.configuration.is_sourced(key.1, &key.2);
        match values.split_last() {
            Some((source, values)) if is_sourced => {
                let head = with_values(&key_text(key), values);
                format!("{head}[source({})]", self.peer_text(source))
            }
            _ => with_values(&key_text(key), values),
        }
    }

    /// Adds a line to the log; plans are one level deeper than their caller.
    fn tell(
        &self,
        further: usize,
        line: Option<usize>,
        text: impl FnOnce() -> String,
        environment: &mut dyn Environment,
    ) -> Option<usize> {
        let story = environment.story()?;
        // The effects of a call are below the formula that calls.
        let depth = (2 * self.limit.depth.max(1) - 1) + further;
        story.push(CounterexampleStep { depth, line, text: text() });
        Some(story.len() - 1)
    }

    pub(super) fn log_event(&self, event: &Event, environment: &mut dyn Environment) {
        self.tell(0, None, || format!("handles {}", self.event_text(event, "")), environment);
    }

    /// Returns the index of the line in the log.
    pub(super) fn log_plan(&self, plan: &Plan, environment: &mut dyn Environment) -> Option<usize> {
        let line = self.source.line(plan.trigger.span.start);
        self.tell(0, Some(line), || format!("plan {}", self.source.head(plan)), environment)
    }

    /// Marks a logged plan as not applicable.
    pub(super) fn log_skipped(index: Option<usize>, environment: &mut dyn Environment) {
        let story = environment.story().zip(index);
        if let Some(plan) = story.and_then(|(story, index)| story.get_mut(index)) {
            plan.text = format!("does not apply: {}", plan.text);
        }
    }

    pub(super) fn log_no_plan(&self, key: &Key, environment: &mut dyn Environment) {
        // A change of a belief without plans is not logged.
        if key.1 == TriggerKind::Belief {
            return;
        }
        self.tell(0, None, || format!("no plan for {} applies", key_text(key)), environment);
    }

    pub(super) fn log_call(
        &self,
        atom: &Atom,
        arguments: &[Value],
        result: Option<&Value>,
        environment: &mut dyn Environment,
    ) {
        let text = || {
            let call = with_values(&atom.name.text, arguments);
            result.map_or(call.clone(), |result| format!("{call} is {result}"))
        };
        self.tell(1, Some(self.source.line(atom.span.start)), text, environment);
    }

    pub(super) fn log_sent(
        &self,
        action: &str,
        content: &Atom,
        values: &[Value],
        environment: &mut dyn Environment,
    ) {
        let text = || with_values(action, values);
        self.tell(1, Some(self.source.line(content.span.start)), text, environment);
    }

    pub(super) fn log_formula(
        &self,
        sign: &str,
        atom: &Atom,
        values: &[Value],
        environment: &mut dyn Environment,
    ) {
        let text = || with_values(&format!("{sign}{}", atom.name.text), values);
        self.tell(1, Some(self.source.line(atom.span.start)), text, environment);
    }

    pub(super) fn log_failure(&self, formula: &Formula, environment: &mut dyn Environment) {
        let line = self.source.line(formula.span().start);
        self.tell(1, Some(line), || "fails".to_owned(), environment);
    }
}
