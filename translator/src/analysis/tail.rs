//! Failures that do not propagate outward.
//!
//! A recursive goal in last position is posted for the next step, and has succeeded for the plan that posts
//! it. A failure in a later step is handled by the failure plans of the goal that fails then, and not by
//! those of its callers.

use std::collections::{BTreeSet, HashSet, VecDeque};

use diagnostic::{Diagnostic, Span};

use crate::code::Code;
use crate::coverage::always_finds_a_plan;
use crate::program::{Handler, HandlerId, Plan, Raise, Step};
use crate::syntax::ast::{Operator, TriggerKind};

/// Warns of failure plans that never see the failure of their goal.
pub(super) fn warn_unseen(
    handlers: &[Handler],
    reached: &BTreeSet<HandlerId>,
    findings: &mut Vec<Diagnostic>,
) {
    let fails = failing(handlers);
    let mut reported: HashSet<Span> = HashSet::new();
    for handler in reached.iter().map(|id| &handlers[id.0]) {
        let is_goal = (handler.operator, handler.kind) == (Operator::Add, TriggerKind::Achieve);
        let Some(failure) = handler.failure.filter(|_| is_goal) else { continue };
        let guard = handlers[failure.0].text();
        for placed in handler.plans.iter().flat_map(|plan| &plan.body) {
            let Some(first) = Posted::of(&placed.step) else { continue };
            let Some(unseen) = unseen(handlers, &fails, failure, first) else { continue };
            if !reported.insert(placed.span.clone()) {
                continue;
            }
            let unseen = &handlers[unseen.0];
            let text = unseen.text();
            let mend = match (unseen.kind, unseen.failure) {
                (TriggerKind::Achieve, None) => {
                    format!("add plans for `{}`", text.replacen('+', "-", 1))
                }
                (TriggerKind::Achieve, Some(_)) => {
                    format!("let plans for `{}` apply to every failure", text.replacen('+', "-", 1))
                }
                _ => "let its plans post a goal that has failure plans".to_owned(),
            };
            findings.push(
                Code::UnseenFailure
                    .at(
                        format!("`{guard}` does not handle a later failure of `{text}`"),
                        placed.span.clone(),
                    )
                    .label("posted for the next step, so this plan has already succeeded")
                    .help(mend),
            );
        }
    }
}

/// A goal that a formula posts for the next step.
#[derive(Clone, Copy)]
struct Posted {
    handler: HandlerId,
    limited: bool,
}

impl Posted {
    fn of(step: &Step) -> Option<Self> {
        match step {
            Step::Post { handler, deadline, .. } => {
                Some(Self { handler: *handler, limited: deadline.is_some() })
            }
            Step::Add { raise: Raise::Post(handler), .. }
            | Step::Delete { raise: Raise::Post(handler), .. } => {
                Some(Self { handler: *handler, limited: false })
            }
            _ => None,
        }
    }

    /// Whether it can fail without recovery: in its plans, or by its deadline.
    fn fails(self, handlers: &[Handler], fails: &[bool]) -> bool {
        let late = || handlers[self.handler.0].failure.is_none_or(|failure| fails[failure.0]);
        fails[self.handler.0] || (self.limited && late())
    }
}

/// The nearest posted goal from here on that can fail without `guard` being tried.
fn unseen(
    handlers: &[Handler],
    fails: &[bool],
    guard: HandlerId,
    first: Posted,
) -> Option<HandlerId> {
    let mut open = VecDeque::from([first]);
    let mut known: HashSet<HandlerId> = HashSet::new();
    while let Some(posted) = open.pop_front() {
        let handler = &handlers[posted.handler.0];
        // The goal itself, and the rests of its plans that wait, are checked separately.
        if handler.failure == Some(guard) || !known.insert(posted.handler) {
            continue;
        }
        if posted.fails(handlers, fails) {
            return Some(posted.handler);
        }
        let failure = handler.failure.map(|failure| &handlers[failure.0]);
        let plans =
            handler.plans.iter().chain(failure.into_iter().flat_map(|failure| &failure.plans));
        open.extend(plans.flat_map(Plan::steps).filter_map(Posted::of));
    }
    None
}

/// Handlers that can fail for their callers, in spite of failure plans.
fn failing(handlers: &[Handler]) -> Vec<bool> {
    let mut users: Vec<Vec<usize>> = vec![Vec::new(); handlers.len()];
    let mut mends: Vec<Vec<usize>> = vec![Vec::new(); handlers.len()];
    let mut body = vec![false; handlers.len()];
    for (index, handler) in handlers.iter().enumerate() {
        // A percept without an applicable plan is not a failure.
        body[index] = handler.kind != TriggerKind::Belief && !always_finds_a_plan(handler);
        if let Some(failure) = handler.failure {
            mends[failure.0].push(index);
        }
        for step in handler.plans.iter().flat_map(Plan::steps) {
            body[index] |= step.values_can_fail();
            match step {
                Step::Achieve { handler, .. }
                | Step::Add { raise: Raise::Call(handler), .. }
                | Step::Delete { raise: Raise::Call(handler), .. }
                | Step::Ask { plans: Some(handler), .. } => users[handler.0].push(index),
                Step::Ask { plans: None, .. } => body[index] = true,
                _ => {}
            }
        }
    }
    let mut fails = vec![false; handlers.len()];
    let mut open: Vec<usize> = (0..handlers.len()).collect();
    while let Some(index) = open.pop() {
        let mended = handlers[index].failure.is_some_and(|failure| !fails[failure.0]);
        if fails[index] || !body[index] || mended {
            continue;
        }
        fails[index] = true;
        for user in &users[index] {
            body[*user] = true;
            open.push(*user);
        }
        open.extend(&mends[index]);
    }
    fails
}
