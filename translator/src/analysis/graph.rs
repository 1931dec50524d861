//! The trigger graph: which plans call which, and which calls are recursive.

use std::collections::HashMap;

use super::TriggerKey;
use crate::syntax::ast::{Agent, Formula, Operator, Trigger, TriggerKind};

/// Recursive triggers, from which a cycle of calls can be reached.
pub(super) struct TriggerGraph {
    nodes: HashMap<TriggerKey, usize>,
    recursive: Vec<bool>,
}

impl TriggerGraph {
    pub(super) fn new(agent: &Agent) -> Self {
        let mut nodes: HashMap<TriggerKey, usize> = HashMap::new();
        for plan in &agent.plans {
            let next = nodes.len();
            nodes.entry(trigger_key(&plan.trigger)).or_insert(next);
        }
        let mut callers: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
        let mut open_calls = vec![0_usize; nodes.len()];
        let mut edge = |from: usize, to: usize| {
            callers[to].push(from);
            open_calls[from] += 1;
        };
        let node = |operator, kind, name: &str| nodes.get(&(operator, kind, name.to_owned()));
        for plan in &agent.plans {
            let from = nodes[&trigger_key(&plan.trigger)];
            for formula in &plan.body {
                let target = match formula {
                    Formula::Achieve { goal, .. } => {
                        node(Operator::Add, TriggerKind::Achieve, &goal.name.text)
                    }
                    Formula::Add(belief) => {
                        node(Operator::Add, TriggerKind::Belief, &belief.name.text)
                    }
                    Formula::Delete(belief) => {
                        node(Operator::Delete, TriggerKind::Belief, &belief.name.text)
                    }
                    Formula::Test(belief) => {
                        node(Operator::Add, TriggerKind::Test, &belief.name.text)
                    }
                    // The rest of a plan that waits is the event of a later step.
                    Formula::Wait { .. } => Some(&from),
                    // A deferred goal is not called, and actions call no plan.
                    Formula::Defer(_)
                    | Formula::Action(_)
                    | Formula::Assign { .. }
                    | Formula::MyName { .. }
                    | Formula::Send { .. } => None,
                };
                if let Some(to) = target {
                    edge(from, *to);
                }
            }
        }
        for ((operator, kind, name), from) in &nodes {
            if *operator == Operator::Add
                && *kind != TriggerKind::Belief
                && let Some(to) = node(Operator::Delete, *kind, name)
            {
                edge(*from, *to);
            }
        }
        let recursive = reaches_cycle(&callers, open_calls);
        Self { nodes, recursive }
    }

    pub(super) fn is_recursive(&self, operator: Operator, kind: TriggerKind, name: &str) -> bool {
        let node = self.nodes.get(&(operator, kind, name.to_owned()));
        node.is_some_and(|node| self.recursive[*node])
    }
}

fn trigger_key(trigger: &Trigger) -> TriggerKey {
    (trigger.operator, trigger.kind, trigger.atom.name.text.clone())
}

/// Repeatedly removes nodes without outgoing calls; the remaining ones reach a cycle.
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
