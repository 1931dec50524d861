//! Monitors the properties of a running system, by the rules of the language guide.

use std::collections::BTreeSet;

use translator::configuration::ExternalTrigger;
use translator::system::{AgentAction, AgentCause, System, SystemFormula};

/// The state of each property, in the order of the system.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Monitors {
    states: Vec<State>,
}

#[derive(Debug, Clone, Default, PartialEq, Eq)]
struct State {
    /// Remaining rounds for the answer, with this one; 0 if none is due.
    due: u32,
    /// Which of the actions that exclude each other were called in the round.
    together: BTreeSet<usize>,
}

impl State {
    /// An answer is due from now on: in the rest of this round, or in one of the next ones.
    fn begin(&mut self, rounds: u32) {
        if self.due == 0 {
            self.due = rounds + 1;
        }
    }
}

impl Monitors {
    pub(super) fn new(system: &System) -> Self {
        Self { states: vec![State::default(); system.properties.len()] }
    }

    /// The environment has raised an event of an agent, and it was accepted.
    pub(super) fn raised(&mut self, system: &System, member: usize, event: &ExternalTrigger) {
        let name = &system.members[member].name;
        for (state, property) in self.states.iter_mut().zip(&system.properties) {
            if let SystemFormula::Within { rounds, cause: AgentCause::Event(agent, cause), .. } =
                &property.formula
                && agent.text == *name
                && (cause.operator, cause.kind, &cause.name.text)
                    == (event.operator, event.kind, &event.name.text)
            {
                state.begin(*rounds);
            }
        }
    }

    /// An agent has called an action or function.
    pub(super) fn called(&mut self, system: &System, member: usize, call: &str) {
        let of = &system.members[member];
        let is_call_of = |action: &AgentAction| {
            action.agent.text == of.name && of.is_call_of(&action.action.text, call)
        };
        for (state, property) in self.states.iter_mut().zip(&system.properties) {
            match &property.formula {
                SystemFormula::NeverTogether(actions) => {
                    let called =
                        actions.iter().enumerate().filter(|(_, action)| is_call_of(action));
                    state.together.extend(called.map(|(index, _)| index));
                }
                SystemFormula::Within { rounds, cause, answers } => {
                    if answers.iter().any(is_call_of) {
                        state.due = 0;
                    }
                    if matches!(cause, AgentCause::Action(cause) if is_call_of(cause)) {
                        state.begin(*rounds);
                    }
                }
            }
        }
    }

    /// All agents have made their steps. Returns the names of the properties that the round violates.
    pub(super) fn end_round(&mut self, system: &System) -> Vec<String> {
        let mut broken = Vec::new();
        for (state, property) in self.states.iter_mut().zip(&system.properties) {
            let holds = match &property.formula {
                SystemFormula::NeverTogether(_) => state.together.len() <= 1,
                SystemFormula::Within { .. } => {
                    let was_due = state.due > 0;
                    state.due = state.due.saturating_sub(1);
                    !was_due || state.due > 0
                }
            };
            state.together.clear();
            if !holds {
                broken.push(property.name.text.clone());
            }
        }
        broken
    }
}
