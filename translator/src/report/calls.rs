//! How often a step can call each action, at least and at most, over all paths.

use crate::coverage::always_finds_a_plan;
use crate::program::{Call, HandlerId, Plan, Program, Raise, Step};

/// Bounds of what one step can do.
#[derive(Debug, Clone)]
pub(super) struct Cost {
    /// Triggers that call each other, itself included.
    pub(super) depth: usize,
    /// Fewest and most calls of each basic action, then of each class of actions.
    pub(super) calls: Vec<(u32, u32)>,
}

/// What is counted: each basic action and each class of actions.
struct Counted {
    /// For each basic action, the counters that a call of it advances.
    counters: Vec<Vec<usize>>,
    /// The number of counters.
    count: usize,
}

impl Counted {
    fn new(program: &Program) -> Self {
        let configuration = &program.configuration;
        let basics = configuration.basics.len();
        let counters = configuration.basics.iter().enumerate().map(|(index, basic)| {
            let classes = configuration.classes.iter().enumerate().filter(|(_, class)| {
                class.actions.iter().any(|action| action.text == basic.name.text)
            });
            std::iter::once(index).chain(classes.map(|(class, _)| basics + class)).collect()
        });
        Self { counters: counters.collect(), count: basics + configuration.classes.len() }
    }
}

/// Handlers that a step can begin with.
pub(super) fn events(program: &Program) -> Vec<HandlerId> {
    let external = program.external.iter().filter_map(|external| external.handler);
    let perceived = program.beliefs.iter().filter_map(|belief| belief.perceived);
    let mut events: Vec<HandlerId> = external
        .chain(perceived)
        .chain(program.posted.iter().copied())
        .chain(program.deferred.iter().copied())
        // What is late is handled by its failure plans.
        .chain(program.limited.iter().filter_map(|id| program.handler(*id).failure))
        .collect();
    events.sort_unstable();
    events.dedup();
    events
}

/// Costs of all handlers, callees before callers; calls never lead back.
pub(super) fn costs(program: &Program) -> Vec<Cost> {
    let counted = Counted::new(program);
    let none = || Cost { depth: 0, calls: vec![(0, 0); counted.count] };
    let mut costs: Vec<Option<Cost>> = vec![None; program.handlers.len()];
    let mut open: Vec<HandlerId> = program.reachable_handlers().map(|(id, _)| id).collect();
    while let Some(id) = open.last().copied() {
        if costs[id.0].is_some() {
            open.pop();
            continue;
        }
        let waiting: Vec<HandlerId> =
            callees(program, id).into_iter().filter(|callee| costs[callee.0].is_none()).collect();
        if waiting.is_empty() {
            costs[id.0] = Some(handler_cost(program, id, &counted, &costs));
        } else {
            open.extend(waiting);
        }
    }
    costs.into_iter().map(|cost| cost.unwrap_or_else(none)).collect()
}

pub(super) fn callees(program: &Program, id: HandlerId) -> Vec<HandlerId> {
    let handler = program.handler(id);
    let steps = handler.plans.iter().flat_map(|plan| &plan.body);
    handler.failure.into_iter().chain(steps.filter_map(callee)).collect()
}

/// The handler that a formula calls.
fn callee(step: &Step) -> Option<HandlerId> {
    match step {
        Step::Achieve { handler, .. }
        | Step::Add { raise: Raise::Call(handler), .. }
        | Step::Delete { raise: Raise::Call(handler), .. } => Some(*handler),
        Step::Ask { plans, .. } => *plans,
        _ => None,
    }
}

fn handler_cost(
    program: &Program,
    id: HandlerId,
    counted: &Counted,
    costs: &[Option<Cost>],
) -> Cost {
    let handler = program.handler(id);
    let known = |id: HandlerId| costs[id.0].as_ref();
    let plans: Vec<Vec<(u32, u32)>> =
        handler.plans.iter().map(|plan| plan_calls(plan, counted, &known)).collect();
    // Without a plan that always applies, nothing may be called at all.
    let always = always_finds_a_plan(handler);
    let mut calls = vec![(u32::MAX, 0_u32); counted.count];
    for plan in &plans {
        for (bounds, plan_bounds) in calls.iter_mut().zip(plan) {
            *bounds = (bounds.0.min(plan_bounds.0), bounds.1.max(plan_bounds.1));
        }
    }
    for bounds in &mut calls {
        if !always || bounds.0 == u32::MAX {
            bounds.0 = 0;
        }
    }
    if let Some(failure) = handler.failure.and_then(known) {
        for (bounds, failure_bounds) in calls.iter_mut().zip(&failure.calls) {
            bounds.1 = bounds.1.saturating_add(failure_bounds.1);
        }
    }
    let below = callees(program, id).into_iter().filter_map(known).map(|cost| cost.depth).max();
    Cost { depth: 1 + below.unwrap_or(0), calls }
}

fn plan_calls<'a>(
    plan: &Plan,
    counted: &Counted,
    known: &impl Fn(HandlerId) -> Option<&'a Cost>,
) -> Vec<(u32, u32)> {
    let mut now = vec![(0_u32, 0_u32); counted.count];
    // The fewest calls when the body ends early.
    let mut ended_early: Option<Vec<u32>> = None;
    for step in &plan.body {
        if let Step::Action(Call { basic, .. }) = step {
            if step.can_fail() {
                end_early(&mut ended_early, &now);
            }
            for counter in &counted.counters[basic.0] {
                now[*counter] = (now[*counter].0 + 1, now[*counter].1 + 1);
            }
            continue;
        }
        if let Some(cost) = callee(step).and_then(known) {
            for (bounds, called) in now.iter_mut().zip(&cost.calls) {
                // A belief that has not changed calls nothing, nor does an answered question.
                let certain = matches!(step, Step::Achieve { .. });
                bounds.0 = bounds.0.saturating_add(if certain { called.0 } else { 0 });
                bounds.1 = bounds.1.saturating_add(called.1);
            }
        }
        if step.can_fail() {
            end_early(&mut ended_early, &now);
        }
    }
    if let Some(fewest) = ended_early {
        for (bounds, early) in now.iter_mut().zip(fewest) {
            bounds.0 = bounds.0.min(early);
        }
    }
    now
}

fn end_early(fewest: &mut Option<Vec<u32>>, now: &[(u32, u32)]) {
    let here: Vec<u32> = now.iter().map(|(low, _)| *low).collect();
    *fewest = Some(match fewest.take() {
        Some(fewest) => fewest.into_iter().zip(here).map(|(a, b)| a.min(b)).collect(),
        None => here,
    });
}
