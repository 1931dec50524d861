//! What an interpreted agent believes, and what it has yet to do.

use super::telling::{key_text, with_values};
use super::{Interpreter, Value};
use crate::syntax::ast::{Operator, TriggerKind};

impl Interpreter {
    /// What is believed now, by name.
    pub fn beliefs(&self) -> impl Iterator<Item = (&str, &[Value])> {
        self.beliefs.iter().map(|(name, values)| (name.as_str(), values.as_slice()))
    }

    /// The values of a belief, if it is held.
    pub fn believed_values(&self, name: &str) -> Option<&[Value]> {
        self.beliefs.get(name).map(Vec::as_slice)
    }

    /// Whether an event of the environment waits to be handled.
    pub fn is_waiting(&self, operator: Operator, kind: TriggerKind, name: &str) -> bool {
        let is_this = |key: &super::Key| (key.0, key.1, key.2.as_str()) == (operator, kind, name);
        let external = self.inbox.iter().filter(|event| event.is_external());
        external.chain(&self.preemptive).any(|event| is_this(&event.key))
    }

    /// The events that wait, each with its reason, in the order in which they are served.
    pub fn waiting(&self) -> Vec<String> {
        let rank = |key: &super::Key| {
            self.configuration.preemptive.iter().position(|trigger| {
                (trigger.operator, trigger.kind, &trigger.name.text) == (key.0, key.1, &key.2)
            })
        };
        let mut first: Vec<_> = self.preemptive.iter().collect();
        first.sort_by_key(|event| rank(&event.key));
        let mut waiting: Vec<String> =
            first.iter().map(|event| format!("{}, pre-empting", event.text(""))).collect();
        waiting.extend(self.posted.iter().map(|event| event.text(", posted")));
        if let Some(deadline) = &self.deadline {
            let goal = with_values(&key_text(&deadline.goal), &deadline.arguments);
            waiting.push(format!("the end of the time for {goal}, at {}", deadline.due));
        }
        let perceived =
            self.configuration.perceived.iter().filter(|name| self.perceived.contains(&name.text));
        waiting.extend(perceived.map(|name| format!("+{}, perceived", name.text)));
        waiting.extend(self.inbox.iter().map(|event| event.text(", deferred")));
        waiting.extend(self.deferred.iter().map(|event| event.text(", deferred")));
        waiting
    }

    /// Whether both would go on alike, if the environment did. What is counted is left out.
    pub fn is_like(&self, other: &Self) -> bool {
        self.beliefs == other.beliefs
            && self.posted == other.posted
            && self.deadline == other.deadline
            && self.inbox == other.inbox
            && self.preemptive == other.preemptive
            && self.perceived == other.perceived
            && self.deferred == other.deferred
    }
}
