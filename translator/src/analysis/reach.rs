//! Reachability of triggers from events.

use std::collections::BTreeSet;

use diagnostic::Diagnostic;

use crate::code::Code;
use crate::coverage::always_finds_a_plan;
use crate::program::{Belief, BeliefId, External, Handler, HandlerId, Plan, Raise, Step, Told};
use crate::syntax::ast::{Operator, TriggerKind};

/// Reachable handlers, and how their plans refer to each other.
pub(super) struct Reached {
    /// Handlers reachable from an event; everything that they refer to is included.
    pub(super) handlers: BTreeSet<HandlerId>,
    /// Handlers whose events are posted for the next step.
    pub(super) posted: BTreeSet<HandlerId>,
    /// Handlers whose goals are deferred.
    pub(super) deferred: BTreeSet<HandlerId>,
    /// Handlers whose goals get a deadline.
    pub(super) limited: BTreeSet<HandlerId>,
}

/// Computes reachability from `roots`.
pub(super) fn reach(handlers: &[Handler], roots: &[HandlerId]) -> Reached {
    let mut reached = Reached {
        handlers: BTreeSet::new(),
        posted: BTreeSet::new(),
        deferred: BTreeSet::new(),
        limited: BTreeSet::new(),
    };
    let mut open: Vec<HandlerId> = roots.to_vec();
    while let Some(id) = open.pop() {
        if !reached.handlers.insert(id) {
            continue;
        }
        let handler = &handlers[id.0];
        open.extend(handler.failure);
        for step in handler.plans.iter().flat_map(Plan::steps) {
            match step {
                Step::Achieve { handler, .. } => open.push(*handler),
                Step::Post { handler, deadline, .. } => {
                    reached.posted.insert(*handler);
                    reached.limited.extend(deadline.as_ref().map(|_| *handler));
                    open.push(*handler);
                }
                Step::Defer { handler, .. } => {
                    reached.deferred.insert(*handler);
                    open.push(*handler);
                }
                Step::Add { raise, .. } | Step::Delete { raise, .. } => match raise {
                    Raise::Nothing => {}
                    Raise::Call(handler) => open.push(*handler),
                    Raise::Post(handler) => {
                        reached.posted.insert(*handler);
                        open.push(*handler);
                    }
                },
                Step::Ask { plans, .. } => open.extend(*plans),
                Step::Action(_) | Step::Assign { .. } | Step::Broadcast { .. } => {}
            }
        }
    }
    reached
}

pub(super) fn warn_unreachable(
    handlers: &[Handler],
    reached: &BTreeSet<HandlerId>,
    findings: &mut Vec<Diagnostic>,
) {
    // Unused test goals are reported elsewhere.
    let idle = |(index, handler): &(usize, &Handler)| {
        let is_reported_elsewhere = handler.resumed || handler.kind == TriggerKind::Test;
        !is_reported_elsewhere && !reached.contains(&HandlerId(*index))
    };
    for (_, handler) in handlers.iter().enumerate().filter(idle) {
        let text = handler.text();
        findings.push(
            Code::NeverTriggered
                .at(format!("`{text}` is never triggered"), handler.span.clone())
                .help("its plans are left out; list it in `triggerables` or let a plan post it"),
        );
    }
}

/// Sources of a belief: an initial belief, a plan, an event, a `set_` function.
pub(super) fn believable(
    beliefs: &[Belief],
    handlers: &[Handler],
    external: &[External],
    told: &[Told],
) -> BTreeSet<BeliefId> {
    let given = beliefs.iter().enumerate();
    let given = given.filter(|(_, belief)| belief.settable || belief.initial.is_some());
    let given = given.map(|(index, _)| BeliefId(index));
    let raised = external.iter().filter(|event| event.operator == Operator::Add);
    let steps = handlers.iter().flat_map(|handler| &handler.plans).flat_map(Plan::steps);
    let added = steps.filter_map(|step| match step {
        Step::Add { belief, .. } => Some(*belief),
        _ => None,
    });
    given
        .chain(told.iter().map(|told| told.belief))
        .chain(raised.filter_map(|event| event.belief))
        .chain(added)
        .collect()
}

/// Warns of beliefs in a context that nothing can make true.
pub(super) fn warn_never_believed(
    beliefs: &[Belief],
    believable: &BTreeSet<BeliefId>,
    findings: &mut Vec<Diagnostic>,
) {
    let beliefs = beliefs.iter().enumerate();
    for (_, belief) in beliefs.filter(|(index, _)| !believable.contains(&BeliefId(*index))) {
        if let Some(span) = &belief.asked_at {
            let message = format!("`{}` is never believed", belief.name);
            findings.push(
                Code::NeverBelieved.at(message, span.clone()).help(
                    "no initial belief, no plan, no event and no `set_` function makes it true",
                ),
            );
        }
    }
}

/// Warns of goals that may find no plan and have no failure plan.
pub(super) fn warn_without_plan(
    handlers: &[Handler],
    events: &[HandlerId],
    findings: &mut Vec<Diagnostic>,
) {
    let mut unguarded = vec![false; handlers.len()];
    let mut open = events.to_vec();
    while let Some(HandlerId(index)) = open.pop() {
        let handler = &handlers[index];
        if handler.failure.is_some() || std::mem::replace(&mut unguarded[index], true) {
            continue;
        }
        let steps = handler.plans.iter().flat_map(Plan::steps);
        open.extend(steps.filter_map(|step| match step {
            Step::Achieve { handler, .. } => Some(*handler),
            _ => None,
        }));
    }
    let goals = handlers.iter().zip(unguarded).filter(|(handler, unguarded)| {
        *unguarded && (handler.operator, handler.kind) == (Operator::Add, TriggerKind::Achieve)
    });
    for (handler, _) in goals.filter(|(handler, _)| !always_finds_a_plan(handler)) {
        let text = handler.text();
        let failure = text.replacen('+', "-", 1);
        findings.push(
            Code::NoPlan
                .at(format!("`{text}` may find no plan"), handler.span.clone())
                .label("then it fails, and no failure plan handles that")
                .help(format!(
                    "add a plan without context behind its others, or one for `{failure}`"
                )),
        );
    }
}
