//! What an agent costs: memory, call depth, and how often a step calls each action.

use std::fmt::Write as _;

use crate::backend::c::{FieldType, layout};
use crate::program::{Call, HandlerId, Plan, Program, Raise, Step};
use crate::types::{CType, TypeKind};

/// Bounds of what one step can do.
#[derive(Debug, Clone)]
struct Cost {
    /// Triggers that call each other, itself included.
    depth: usize,
    /// Fewest and most calls of each basic action.
    calls: Vec<(u32, u32)>,
}

/// The report as text.
pub(crate) fn report(program: &Program) -> String {
    let costs = costs(program);
    let basics = &program.configuration.basics;
    let settings = &program.configuration.settings;
    let mut text = String::new();
    let mut line = |label: &str, value: String| {
        // Writing to a string cannot fail.
        _ = writeln!(text, "{label:<28}{value}");
    };
    let handlers: Vec<_> = program.reachable_handlers().collect();
    line("plans", program.reachable_plans().count().to_string());
    line("triggers", handlers.len().to_string());
    let events: Vec<HandlerId> = events(program);
    let deepest = events.iter().max_by_key(|id| costs[id.0].depth);
    if let Some(id) = deepest {
        let handler = program.handler(*id);
        let name = handler.text();
        // next_step, handle_event, then a trigger's function and a plan's for each level.
        let frames = 2 + 2 * costs[id.0].depth;
        line("deepest chain of calls", format!("{frames} functions, from `{name}`"));
    }
    line("state", format!("{} bytes on a 64-bit machine", state_bytes(program)));
    line("posted events", "at most 1".to_owned());
    line("external events waiting", format!("at most {}", settings.inbox));
    line("deferred goals waiting", format!("at most {}", program.deferred.len()));
    let preemptive = program.external.iter().filter(|external| external.preemptive).count();
    line("pre-empting events", preemptive.to_string());
    text.push_str("\ncalls in a step that handles an event\n");
    for (index, basic) in basics.iter().enumerate() {
        if basic.result.kind != TypeKind::Void {
            continue;
        }
        let bounds = events.iter().map(|id| costs[id.0].calls[index]);
        let (low, high) = bounds
            .reduce(|(low, high), (other_low, other_high)| {
                (low.min(other_low), high.max(other_high))
            })
            .unwrap_or((0, 0));
        _ = writeln!(text, "  {:<26}{low} to {high}", basic.name.text);
    }
    text
}

/// Handlers that a step can begin with.
fn events(program: &Program) -> Vec<HandlerId> {
    let external = program.external.iter().filter_map(|external| external.handler);
    let perceived = program.beliefs.iter().filter_map(|belief| belief.perceived);
    let mut events: Vec<HandlerId> = external
        .chain(perceived)
        .chain(program.posted.iter().copied())
        .chain(program.deferred.iter().copied())
        .collect();
    events.sort_unstable();
    events.dedup();
    events
}

/// Costs of all handlers, callees before callers; calls never lead back.
fn costs(program: &Program) -> Vec<Cost> {
    let none = || Cost { depth: 0, calls: vec![(0, 0); program.configuration.basics.len()] };
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
            costs[id.0] = Some(handler_cost(program, id, &costs));
        } else {
            open.extend(waiting);
        }
    }
    costs.into_iter().map(|cost| cost.unwrap_or_else(none)).collect()
}

fn callees(program: &Program, id: HandlerId) -> Vec<HandlerId> {
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

fn handler_cost(program: &Program, id: HandlerId, costs: &[Option<Cost>]) -> Cost {
    let handler = program.handler(id);
    let count = program.configuration.basics.len();
    let known = |id: HandlerId| costs[id.0].as_ref();
    let plans: Vec<Vec<(u32, u32)>> =
        handler.plans.iter().map(|plan| plan_calls(plan, count, &known)).collect();
    // Without a plan that always applies, nothing may be called at all.
    let always = handler.plans.iter().any(Plan::always_applies);
    let mut calls = vec![(u32::MAX, 0_u32); count];
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
    count: usize,
    known: &impl Fn(HandlerId) -> Option<&'a Cost>,
) -> Vec<(u32, u32)> {
    let mut now = vec![(0_u32, 0_u32); count];
    // The fewest calls when the body ends early.
    let mut ended_early: Option<Vec<u32>> = None;
    for step in &plan.body {
        if let Step::Action(Call { basic, .. }) = step {
            if step.can_fail() {
                end_early(&mut ended_early, &now);
            }
            now[basic.0] = (now[basic.0].0 + 1, now[basic.0].1 + 1);
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

/// The size of the state struct where every scalar is aligned to its own size.
fn state_bytes(program: &Program) -> usize {
    let mut bytes = 0_usize;
    let mut alignment = 1;
    for field in layout(program).fields {
        let (size, align) = match &field.content {
            FieldType::Environment => (8, 8),
            FieldType::Flag => (1, 1),
            FieldType::Count | FieldType::Event => (4, 4),
            FieldType::Value(ctype) => size_of_type(program, ctype),
        };
        bytes = bytes.next_multiple_of(align) + size * field.length.unwrap_or(1);
        alignment = alignment.max(align);
    }
    bytes.next_multiple_of(alignment)
}

/// Size and alignment; of types that the translator does not know, those of a pointer.
fn size_of_type(program: &Program, ctype: &CType) -> (usize, usize) {
    match ctype.kind {
        TypeKind::Bool => (1, 1),
        TypeKind::Signed { bits } | TypeKind::Unsigned { bits } => {
            let bytes = bits as usize / 8;
            (bytes, bytes)
        }
        TypeKind::Float32 => (4, 4),
        TypeKind::Struct => {
            let mut structs = program.configuration.structs.iter();
            let declared = structs.find(|declared| declared.name.text == ctype.name);
            let fields = declared.map_or(&[][..], |declared| &declared.fields[..]);
            let (bytes, alignment) =
                fields.iter().fold((0_usize, 1), |(bytes, alignment), (_, field)| {
                    let (size, align) = size_of_type(program, field);
                    (bytes.next_multiple_of(align) + size, alignment.max(align))
                });
            (bytes.next_multiple_of(alignment), alignment)
        }
        TypeKind::Float64 | TypeKind::Text | TypeKind::Opaque | TypeKind::Void => (8, 8),
    }
}
