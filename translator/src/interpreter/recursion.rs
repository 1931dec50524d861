//! Finds recursive goals and beliefs, independently of the analysis that the translation uses.

use std::collections::{BTreeMap, BTreeSet, HashSet};

use super::{Key, key_of};
use crate::syntax::ast::{Agent, Formula, Operator, TriggerKind};

/// Triggers from which a cycle of calls is reachable, found by following every call.
pub(super) fn recursive_triggers(agent: &Agent) -> HashSet<Key> {
    let plans: BTreeSet<Key> = agent.plans.iter().map(|plan| key_of(&plan.trigger)).collect();
    let mut calls: BTreeMap<&Key, BTreeSet<Key>> = BTreeMap::new();
    for plan in &agent.plans {
        let key = key_of(&plan.trigger);
        let Some(key) = plans.get(&key) else { continue };
        let targets = calls.entry(key).or_default();
        let (operator, kind, name) = key;
        if *operator == Operator::Add && *kind != TriggerKind::Belief {
            targets.insert((Operator::Delete, *kind, name.clone()));
        }
        for formula in &plan.body {
            let target = match formula {
                // The rest of a plan that waits is the event of a later step.
                Formula::Wait { .. } => {
                    targets.insert(key.clone());
                    continue;
                }
                Formula::Achieve { goal: atom, .. } => (Operator::Add, TriggerKind::Achieve, atom),
                Formula::Add(atom) => (Operator::Add, TriggerKind::Belief, atom),
                Formula::Delete(atom) => (Operator::Delete, TriggerKind::Belief, atom),
                Formula::Test(atom) => (Operator::Add, TriggerKind::Test, atom),
                Formula::Action(_)
                | Formula::Assign { .. }
                | Formula::Defer(_)
                | Formula::MyName { .. }
                | Formula::Send { .. } => continue,
            };
            targets.insert((target.0, target.1, target.2.name.text.clone()));
        }
        targets.retain(|target| plans.contains(target));
    }
    let reaches = |start: &Key, goal: Option<&Key>| {
        let mut seen: BTreeSet<&Key> = BTreeSet::new();
        let mut open: Vec<&Key> = calls.get(start).into_iter().flatten().collect();
        while let Some(key) = open.pop() {
            if Some(key) == goal {
                return (true, seen);
            }
            if seen.insert(key) {
                open.extend(calls.get(key).into_iter().flatten());
            }
        }
        (false, seen)
    };
    let on_cycle: BTreeSet<&Key> = plans.iter().filter(|key| reaches(key, Some(key)).0).collect();
    plans
        .iter()
        .filter(|key| {
            on_cycle.contains(key) || reaches(key, None).1.iter().any(|k| on_cycle.contains(k))
        })
        .cloned()
        .collect()
}
