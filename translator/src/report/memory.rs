//! Memory of an agent: its state, and its stack if a compiler has reported the frame size of each function.

use std::collections::HashMap;

use super::calls::callees;
use crate::backend::c::{FieldType, handler_name, layout, plan_name};
use crate::program::Program;
use crate::types::{CType, TypeKind};

/// Functions of the C file that others call and that call nothing.
const LEAVES: [&str; 5] = ["checked_", "equal_", "post_", "defer_", "limit_"];

/// The call graph, which has no cycles.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Frames {
    /// For each trigger: its function, those of its plans, and the triggers that they call.
    triggers: Vec<Trigger>,
    next_step: String,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Trigger {
    function: String,
    plans: Vec<String>,
    callees: Vec<usize>,
}

impl Frames {
    pub(super) fn new(program: &Program, next_step: String) -> Self {
        let mut position = vec![None; program.handlers.len()];
        let mut triggers = Vec::new();
        for (id, handler) in program.handlers() {
            position[id.0] = Some(triggers.len());
            let trigger = handler_name(program, id);
            triggers.push(Trigger {
                plans: (0..handler.plans.len()).map(|n| plan_name(n, &trigger)).collect(),
                function: format!("run_{trigger}"),
                callees: Vec::new(),
            });
        }
        for (id, _) in program.handlers() {
            if let Some(index) = position[id.0] {
                let callees = callees(program, id);
                triggers[index].callees = callees.iter().filter_map(|c| position[c.0]).collect();
            }
        }
        Self { triggers, next_step }
    }

    /// Linker symbol of `next_step()`.
    pub(super) fn next_step(&self) -> &str {
        &self.next_step
    }

    /// Maximum stack below a call of `next_step()`, without that of the basic actions.
    pub(super) fn deepest(&self, frame_bytes: &HashMap<String, u64>) -> u64 {
        let frame = |name: &str| frame_bytes.get(name).copied().unwrap_or(0);
        let leaf = |name: &str| LEAVES.iter().any(|prefix| name.starts_with(prefix));
        let leaves = frame_bytes.iter().filter(|(name, _)| leaf(name)).map(|(_, bytes)| *bytes);
        let leaves = leaves.max().unwrap_or(0);
        let mut below: Vec<Option<u64>> = vec![None; self.triggers.len()];
        let mut open: Vec<usize> = (0..self.triggers.len()).collect();
        while let Some(index) = open.last().copied() {
            let trigger = &self.triggers[index];
            let waiting = trigger.callees.iter().copied().filter(|callee| below[*callee].is_none());
            let waiting: Vec<usize> = waiting.collect();
            if below[index].is_none() && !waiting.is_empty() {
                open.extend(waiting);
                continue;
            }
            open.pop();
            let called = trigger.callees.iter().filter_map(|callee| below[*callee]).max();
            let plan = trigger.plans.iter().map(|plan| frame(plan)).max().unwrap_or(0);
            below[index] = Some(frame(&trigger.function) + plan + called.unwrap_or(0).max(leaves));
        }
        let handling = frame("handle_event") + below.into_iter().flatten().max().unwrap_or(0);
        let [asked, told] = ["take_asked", "take_told"]
            .map(|function| frame(function) + frame(&format!("{function}_from")));
        let taking = frame("take_event") + asked.max(told);
        frame(&self.next_step) + handling.max(taking)
    }
}

/// Size of the state struct if every scalar is aligned to its own size.
pub(super) fn state_bytes(program: &Program) -> usize {
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

/// Size and alignment; for unknown types, those of a pointer.
fn size_of_type(program: &Program, ctype: &CType) -> (usize, usize) {
    match ctype.kind {
        TypeKind::Bool => (1, 1),
        TypeKind::Signed { bits } | TypeKind::Unsigned { bits } => {
            let bytes = bits as usize / 8;
            (bytes, bytes)
        }
        TypeKind::Float32 => (4, 4),
        TypeKind::Struct => {
            let fields = program.configuration.fields(&ctype.name);
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
