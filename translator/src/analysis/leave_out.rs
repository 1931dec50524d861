//! Removes unreachable handlers from a program.

use std::collections::BTreeSet;

use crate::program::{HandlerId, Plan, Program, Raise, Step};

/// Keeps only the handlers in `reached`, and renumbers all ids.
///
/// `reached` is closed: a reached handler refers only to reached handlers, so every remaining id stays valid.
pub(super) fn leave_out(program: &mut Program, reached: &BTreeSet<HandlerId>) {
    let kept: Vec<HandlerId> = reached.iter().copied().collect();
    let renumber = |id: &mut HandlerId| *id = HandlerId(kept.partition_point(|other| other < id));
    let mut index = 0;
    let mut left_out = 0;
    program.handlers.retain(|handler| {
        let is_kept = reached.contains(&HandlerId(index));
        index += 1;
        left_out += if is_kept { 0 } else { handler.plans.len() };
        is_kept
    });
    program.left_out = left_out;
    for handler in &mut program.handlers {
        handler.failure.iter_mut().for_each(renumber);
        for plan in &mut handler.plans {
            in_plan(plan, renumber);
        }
    }
    let Program { posted, posted_by_plans, deferred, limited, .. } = program;
    for list in [posted, posted_by_plans, deferred, limited] {
        list.iter_mut().for_each(renumber);
    }
    program.beliefs.iter_mut().flat_map(|belief| &mut belief.perceived).for_each(renumber);
    program.external.iter_mut().flat_map(|event| &mut event.handler).for_each(renumber);
    program
        .told
        .iter_mut()
        .flat_map(|told| told.added.iter_mut().chain(&mut told.removed))
        .for_each(renumber);
    program.asked.iter_mut().for_each(|asked| renumber(&mut asked.handler));
    program.initial_goal.iter_mut().for_each(|(handler, _)| renumber(handler));
}

/// Renumbers all handlers that a plan refers to.
fn in_plan(plan: &mut Plan, renumber: impl Fn(&mut HandlerId)) {
    for placed in &mut plan.body {
        match &mut placed.step {
            Step::Achieve { handler, .. }
            | Step::Post { handler, .. }
            | Step::Defer { handler, .. } => renumber(handler),
            Step::Add { raise, .. } | Step::Delete { raise, .. } => match raise {
                Raise::Call(handler) | Raise::Post(handler) => renumber(handler),
                Raise::Nothing => {}
            },
            Step::Ask { plans, .. } => plans.iter_mut().for_each(&renumber),
            Step::Action(_) | Step::Assign { .. } | Step::Broadcast { .. } => {}
        }
    }
}
