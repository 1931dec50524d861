//! What the plans of a trigger lead to.

use std::collections::{BTreeSet, HashMap, HashSet};

use crate::syntax::ast::{Agent, Formula, Operator, Plan, TriggerKind};

/// A trigger in the source.
pub(super) type Key<'a> = (Operator, TriggerKind, &'a str);

/// Everything that can follow an event, in this step or a later one.
#[derive(Debug, Default)]
pub(super) struct Reach<'a> {
    pub(super) goals: BTreeSet<&'a str>,
    pub(super) changes: BTreeSet<&'a str>,
    pub(super) actions: BTreeSet<&'a str>,
}

/// What the plans of some triggers lead to. A goal may fail, so its failure plans count.
pub(super) fn reach<'a>(agent: &'a Agent, from: &[Key<'a>]) -> Reach<'a> {
    let mut plans: HashMap<Key<'_>, Vec<&Plan>> = HashMap::new();
    for plan in &agent.plans {
        plans.entry(key(plan)).or_default().push(plan);
    }
    let mut reach = Reach::default();
    let mut open = from.to_vec();
    let mut known: HashSet<Key<'_>> = HashSet::new();
    while let Some(trigger) = open.pop() {
        if !known.insert(trigger) {
            continue;
        }
        let (operator, kind, name) = trigger;
        if operator == Operator::Add && kind != TriggerKind::Belief {
            open.push((Operator::Delete, kind, name));
        }
        for formula in plans.get(&trigger).into_iter().flatten().flat_map(|plan| &plan.body) {
            let (operator, kind, atom) = match formula {
                Formula::Action(atom) => {
                    reach.actions.insert(&atom.name.text);
                    continue;
                }
                Formula::Achieve { goal: atom, .. } | Formula::Defer(atom) => {
                    reach.goals.insert(&atom.name.text);
                    (Operator::Add, TriggerKind::Achieve, atom)
                }
                Formula::Add(atom) => {
                    reach.changes.insert(&atom.name.text);
                    (Operator::Add, TriggerKind::Belief, atom)
                }
                Formula::Delete(atom) => {
                    reach.changes.insert(&atom.name.text);
                    (Operator::Delete, TriggerKind::Belief, atom)
                }
                Formula::Test(atom) => (Operator::Add, TriggerKind::Test, atom),
                Formula::Assign { .. }
                | Formula::Wait { .. }
                | Formula::MyName { .. }
                | Formula::Send { .. } => continue,
            };
            open.push((operator, kind, &atom.name.text));
        }
    }
    reach
}

pub(super) fn key(plan: &Plan) -> Key<'_> {
    let trigger = &plan.trigger;
    (trigger.operator, trigger.kind, &trigger.atom.name.text)
}
