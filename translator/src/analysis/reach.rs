//! Which triggers any event can lead to.

use std::collections::BTreeSet;

use diagnostic::Diagnostic;

use crate::code::Code;
use crate::coverage::always_finds_a_plan;
use crate::program::{Belief, BeliefId, External, Handler, HandlerId, Plan, Raise, Step};
use crate::syntax::ast::{Operator, TriggerKind};

/// What the reachable plans do besides calling each other.
pub(super) struct Reached {
    /// Handlers whose events they post for the next step.
    pub(super) posted: BTreeSet<HandlerId>,
    /// Handlers whose goals they defer.
    pub(super) deferred: BTreeSet<HandlerId>,
    /// Handlers whose goals they give a deadline.
    pub(super) limited: BTreeSet<HandlerId>,
}

/// Marks the handlers that can be reached from `roots`.
pub(super) fn reach(handlers: &mut [Handler], roots: &[HandlerId]) -> Reached {
    let mut reached =
        Reached { posted: BTreeSet::new(), deferred: BTreeSet::new(), limited: BTreeSet::new() };
    let mut open: Vec<HandlerId> = roots.to_vec();
    while let Some(HandlerId(index)) = open.pop() {
        if std::mem::replace(&mut handlers[index].reachable, true) {
            continue;
        }
        open.extend(handlers[index].failure);
        for step in handlers[index].plans.iter().flat_map(Plan::steps) {
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
                Step::Action(_) | Step::Assign { .. } => {}
            }
        }
    }
    reached
}

pub(super) fn warn_unreachable(handlers: &[Handler], findings: &mut Vec<Diagnostic>) {
    // Of test goals that nobody asks it is said where they stand.
    let idle = |handler: &&Handler| {
        !handler.reachable && !handler.resumed && handler.kind != TriggerKind::Test
    };
    for handler in handlers.iter().filter(idle) {
        let text = handler.text();
        findings.push(
            Code::NeverTriggered
                .at(format!("nothing ever triggers `{text}`"), handler.span.clone())
                .help("its plans are left out; list it in `triggerables` or let a plan post it"),
        );
    }
}

/// Marks what something can make true: an initial belief, a plan, an event, a `set_` function.
pub(super) fn mark_believable(beliefs: &mut [Belief], handlers: &[Handler], external: &[External]) {
    for belief in beliefs.iter_mut() {
        belief.believable = belief.settable || belief.initial.is_some();
    }
    let raised = external.iter().filter(|event| event.operator == Operator::Add);
    let steps = handlers.iter().flat_map(|handler| &handler.plans).flat_map(Plan::steps);
    let added = steps.filter_map(|step| match step {
        Step::Add { belief, .. } => Some(*belief),
        _ => None,
    });
    for BeliefId(index) in raised.filter_map(|event| event.belief).chain(added) {
        beliefs[index].believable = true;
    }
}

/// Warns of beliefs that a context asks for and that nothing can make true.
pub(super) fn warn_never_believed(beliefs: &[Belief], findings: &mut Vec<Diagnostic>) {
    for belief in beliefs.iter().filter(|belief| !belief.believable) {
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

/// Warns of goals that may find no plan while no failure plan is there to mend it.
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
                .label("then it fails, and nothing mends that")
                .help(format!(
                    "add a plan without context behind its others, or one for `{failure}`"
                )),
        );
    }
}
