//! The trigger graph: which plans call which, and which can come back to themselves.

use std::collections::HashMap;

use super::TriggerKey;
use crate::program::HandlerId;
use crate::syntax::ast::{Agent, Formula, Operator, TriggerKind};

/// Which triggers are recursive: from them a cycle of calls can be reached.
pub(super) struct TriggerGraph {
    recursive: Vec<bool>,
}

impl TriggerGraph {
    pub(super) fn new(agent: &Agent, handlers: &HashMap<TriggerKey, HandlerId>) -> Self {
        let mut callers: Vec<Vec<usize>> = vec![Vec::new(); handlers.len()];
        let mut open_calls = vec![0_usize; handlers.len()];
        let mut edge = |from: HandlerId, to: HandlerId| {
            callers[to.0].push(from.0);
            open_calls[from.0] += 1;
        };
        let id = |operator, kind, name: &str| handlers.get(&(operator, kind, name.to_owned()));
        for plan in &agent.plans {
            let trigger = &plan.trigger;
            let Some(from) = id(trigger.operator, trigger.kind, &trigger.atom.name.text) else {
                continue;
            };
            for formula in &plan.body {
                let target = match formula {
                    Formula::Achieve(goal) => {
                        id(Operator::Add, TriggerKind::Achieve, &goal.name.text)
                    }
                    Formula::Add(belief) => {
                        id(Operator::Add, TriggerKind::Belief, &belief.name.text)
                    }
                    Formula::Delete(belief) => {
                        id(Operator::Delete, TriggerKind::Belief, &belief.name.text)
                    }
                    // A deferred goal is never called; actions and tests call no plan.
                    Formula::Defer(_)
                    | Formula::Test(_)
                    | Formula::Action(_)
                    | Formula::Assign { .. } => None,
                };
                if let Some(to) = target {
                    edge(*from, *to);
                }
            }
        }
        for ((operator, kind, name), from) in handlers {
            if (*operator, *kind) == (Operator::Add, TriggerKind::Achieve)
                && let Some(to) = id(Operator::Delete, TriggerKind::Achieve, name)
            {
                edge(*from, *to);
            }
        }
        Self { recursive: reaches_cycle(&callers, open_calls) }
    }

    pub(super) fn is_recursive(&self, handler: HandlerId) -> bool {
        self.recursive[handler.0]
    }
}

/// Takes away, again and again, what calls nothing that is left: what remains reaches a cycle.
fn reaches_cycle(callers: &[Vec<usize>], mut open_calls: Vec<usize>) -> Vec<bool> {
    let mut ready: Vec<usize> =
        (0..open_calls.len()).filter(|node| open_calls[*node] == 0).collect();
    let mut recursive = vec![true; open_calls.len()];
    while let Some(node) = ready.pop() {
        recursive[node] = false;
        for caller in &callers[node] {
            open_calls[*caller] -= 1;
            if open_calls[*caller] == 0 {
                ready.push(*caller);
            }
        }
    }
    recursive
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_reaches_a_cycle_is_recursive_and_a_chain_is_not() {
        // 0 -> 1 -> 2, 3 -> 3, 4 -> 3, 5 -> 0
        let callers = vec![vec![5], vec![0], vec![1], vec![3, 4], vec![], vec![]];
        let open_calls = vec![1, 1, 0, 1, 1, 1];
        assert_eq!(reaches_cycle(&callers, open_calls), [false, false, false, true, true, false]);
    }
}
