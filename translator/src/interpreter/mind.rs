//! Beliefs and pending events of an interpreted agent.

use super::{Event, Interpreter, Value};
use crate::syntax::ast::{Operator, TriggerKind};

impl Interpreter {
    /// Current beliefs, by name, without those that peers tell.
    pub fn beliefs(&self) -> impl Iterator<Item = (&str, &[Value])> {
        self.beliefs.iter().map(|(name, values)| (name.as_str(), values.as_slice()))
    }

    /// What peers tell at present: the belief, the peer's name, and the values.
    pub fn told_beliefs(&self) -> impl Iterator<Item = (&str, &str, &[Value])> {
        let told = self.mail.told();
        told.filter_map(|(name, sender, values)| {
            Some((name, self.configuration.peers.get(sender)?.text.as_str(), values))
        })
    }

    /// The values of a belief, if it is held.
    pub fn believed_values(&self, name: &str) -> Option<&[Value]> {
        self.beliefs.get(name).map(Vec::as_slice)
    }

    /// Whether an event of the environment is pending.
    pub fn is_waiting(&self, operator: Operator, kind: TriggerKind, name: &str) -> bool {
        let is_this = |key: &super::Key| (key.0, key.1, key.2.as_str()) == (operator, kind, name);
        let external = self.inbox.iter().filter(|event| event.is_external());
        external.chain(&self.preemptive).any(|event| is_this(&event.key))
    }

    /// Whether an event that this peer has caused is pending.
    pub fn is_waiting_from(
        &self,
        peer: usize,
        operator: Operator,
        kind: TriggerKind,
        name: &str,
    ) -> bool {
        let said = (name.to_owned(), peer);
        match kind {
            TriggerKind::Achieve => self.mail.is_asked(&said),
            TriggerKind::Belief => self.mail.has_changed(&said, operator == Operator::Add),
            TriggerKind::Test => false,
        }
    }

    /// The pending events, each with its cause, in the order of service.
    pub fn waiting(&self) -> Vec<String> {
        let mut waiting = Vec::new();
        for trigger in &self.configuration.preemptive {
            let is_it = |event: &&Event| {
                (trigger.operator, trigger.kind, &trigger.name.text)
                    == (event.key.0, event.key.1, &event.key.2)
            };
            let raised = self.preemptive.iter().filter(is_it);
            let raised = raised.map(|event| self.event_text(event, ""));
            let asked = self.asked_for(|goal| goal == trigger.name.text);
            waiting.extend(raised.chain(asked).map(|event| format!("{event}, pre-empting")));
        }
        waiting.extend(self.posted.iter().map(|event| self.event_text(event, ", posted")));
        if let Some(deadline) = &self.deadline {
            let goal = self.with_source(&deadline.goal, &deadline.arguments);
            waiting.push(format!("the deadline of {goal}, at {}", deadline.due));
        }
        let perceived =
            self.configuration.perceived.iter().filter(|name| self.perceived.contains(&name.text));
        waiting.extend(perceived.map(|name| format!("+{}, perceived", name.text)));
        waiting.extend(self.said());
        let queued = self.inbox.iter().chain(&self.deferred);
        waiting.extend(queued.map(|event| self.event_text(event, ", deferred")));
        waiting
    }

    /// Whether both agents would behave identically from now on. Counters are ignored.
    pub fn is_like(&self, other: &Self) -> bool {
        self.beliefs == other.beliefs
            && self.posted == other.posted
            && self.deadline == other.deadline
            && self.inbox == other.inbox
            && self.preemptive == other.preemptive
            && self.perceived == other.perceived
            && self.deferred == other.deferred
            && self.mail == other.mail
    }
}
