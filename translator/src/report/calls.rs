//! Minimum and maximum number of calls of each action in a step, over all paths.

use crate::coverage::always_finds_a_plan;
use crate::program::{BasicId, ContextCall, Effect, HandlerId, Plan, Program, Raise, Step};

/// Minimum and maximum number of calls of each basic action, then of each class of actions.
type Bounds = Vec<(u64, u64)>;

/// Bounds of one step.
#[derive(Debug, Clone)]
pub(super) struct Cost {
    /// Depth of nested triggers, itself included.
    pub(super) depth: usize,
    /// Calls on success; `None` if it cannot succeed.
    succeeds: Option<Bounds>,
    /// Calls on failure; `None` if it cannot fail.
    fails: Option<Bounds>,
}

impl Cost {
    /// Minimum and maximum number of calls, whatever the result.
    pub(super) fn calls(&self) -> Bounds {
        either(self.succeeds.clone(), self.fails.clone()).unwrap_or_default()
    }
}

/// Bounds of one of two alternatives.
fn either(one: Option<Bounds>, other: Option<Bounds>) -> Option<Bounds> {
    match (one, other) {
        (Some(one), Some(other)) => {
            let both = one.into_iter().zip(other);
            Some(both.map(|(a, b)| (a.0.min(b.0), a.1.max(b.1))).collect())
        }
        (one, other) => one.or(other),
    }
}

/// Bounds of a sequence.
fn then(first: &Bounds, second: Option<&Bounds>) -> Option<Bounds> {
    let both = first.iter().zip(second?);
    Some(both.map(|(a, b)| (a.0.saturating_add(b.0), a.1.saturating_add(b.1))).collect())
}

/// Counters: one for each basic action and each class of actions.
struct Counted {
    /// For each basic action, the counters that a call of it advances.
    counters: Vec<Vec<usize>>,
    /// The number of counters.
    count: usize,
    /// The trace function, called for each chosen plan.
    trace: Option<BasicId>,
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
        Self {
            counters: counters.collect(),
            count: basics + configuration.classes.len(),
            trace: program.trace(),
        }
    }

    fn nothing(&self) -> Bounds {
        vec![(0, 0); self.count]
    }

    /// Adds a call that is certain, or one that may be made.
    fn call(&self, basic: BasicId, certain: bool, bounds: &mut Bounds) {
        for counter in &self.counters[basic.0] {
            let (fewest, most) = bounds[*counter];
            bounds[*counter] = (fewest.saturating_add(u64::from(certain)), most.saturating_add(1));
        }
    }
}

/// Calls outside of plans.
pub(super) fn besides(program: &Program) -> Bounds {
    let counted = Counted::new(program);
    let mut bounds = counted.nothing();
    if let Some(clock) = program.deadline_clock() {
        counted.call(clock, false, &mut bounds);
    }
    bounds
}

/// Handlers that a step can begin with.
pub(super) fn events(program: &Program) -> Vec<HandlerId> {
    let external = program.external.iter().filter_map(|external| external.handler);
    let perceived = program.beliefs.iter().filter_map(|belief| belief.perceived);
    let asked = program.asked.iter().map(|asked| asked.handler);
    let told = program.told.iter().flat_map(|told| told.added.into_iter().chain(told.removed));
    let mut events: Vec<HandlerId> = external
        .chain(perceived)
        .chain(asked)
        .chain(told)
        .chain(program.posted.iter().copied())
        .chain(program.deferred.iter().copied())
        // A goal whose deadline has passed is handled by its failure plans.
        .chain(program.limited.iter().filter_map(|id| program.handler(*id).failure))
        .collect();
    events.sort_unstable();
    events.dedup();
    events
}

/// Costs of all handlers, callees before callers; the call graph has no cycles.
pub(super) fn costs(program: &Program) -> Vec<Cost> {
    let counted = Counted::new(program);
    let none = || Cost { depth: 0, succeeds: Some(counted.nothing()), fails: None };
    let mut costs: Vec<Option<Cost>> = vec![None; program.handlers.len()];
    let mut open: Vec<HandlerId> = program.handlers().map(|(id, _)| id).collect();
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
    let steps = handler.plans.iter().flat_map(Plan::steps);
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
    let (mut succeeds, mut fails) = (None, None);
    // Calls in the contexts of earlier plans that did not apply.
    let mut before = counted.nothing();
    for plan in &handler.plans {
        let outcome = plan_outcome(plan, counted, &before, &known);
        succeeds = either(succeeds, Some(outcome.0));
        fails = either(fails, outcome.1);
        for ContextCall { basic, .. } in plan.context_calls() {
            counted.call(basic, false, &mut before);
        }
    }
    // Without a plan that always applies, there may be no further calls.
    if !always_finds_a_plan(handler) {
        fails = either(fails, Some(before));
    }
    // A goal that its failure plans recover is achieved.
    if let (Some(failed), Some(failure)) = (&fails, handler.failure.and_then(known)) {
        succeeds = either(succeeds, then(failed, failure.succeeds.as_ref()));
        fails = then(failed, failure.fails.as_ref());
    }
    let below = callees(program, id).into_iter().filter_map(known).map(|cost| cost.depth).max();
    Cost { depth: 1 + below.unwrap_or(0), succeeds, fails }
}

/// Calls of a completed body, and of one that fails.
fn plan_outcome<'a>(
    plan: &Plan,
    counted: &Counted,
    before: &Bounds,
    known: &impl Fn(HandlerId) -> Option<&'a Cost>,
) -> (Bounds, Option<Bounds>) {
    let mut now = before.clone();
    for ContextCall { basic, certain } in plan.context_calls() {
        counted.call(basic, certain, &mut now);
    }
    if let Some(trace) = counted.trace {
        counted.call(trace, true, &mut now);
    }
    let mut fails: Option<Bounds> = None;
    for step in plan.steps() {
        for effect in step.effects() {
            match effect {
                Effect::MayFail => fails = either(fails, Some(now.clone())),
                Effect::Call(basic) => counted.call(basic, true, &mut now),
            }
        }
        let called = callee(step).and_then(known);
        if let Some(cost) = called {
            fails = either(fails, then(&now, cost.fails.as_ref()));
        } else if matches!(step, Step::Achieve { .. } | Step::Ask { .. }) {
            fails = either(fails, Some(now.clone()));
        }
        if let Some(cost) = called {
            let after = then(&now, cost.succeeds.as_ref());
            // An unchanged belief calls nothing, nor does an answered query. A goal that cannot succeed ends
            // the body, so the following formulas are never executed.
            let certain = matches!(step, Step::Achieve { .. });
            now = match after {
                Some(after) if certain => after,
                after => either(Some(now.clone()), after).unwrap_or(now),
            };
        }
    }
    (now, fails)
}
