//! The layout of the agent's state, one list for the C struct and its Rust mirror.

use super::said::{
    TOLD_TURN, asked_name, asked_turns, asked_types, has_values, noticed, ring_field, ring_parts,
    told_name,
};
use crate::configuration::Instance;
use crate::program::{BasicId, Belief, External, HandlerId, Program, Told, trigger_name};
use crate::syntax::ast::TriggerKind;
use crate::types::CType;

/// All fields of the agent's state, in order, and its possible events.
pub(crate) struct StateLayout {
    pub(crate) fields: Vec<Field>,
    /// Enumerators of the event type, behind `EVENT_NONE`.
    pub(crate) events: Vec<String>,
}

/// One field.
pub(crate) struct Field {
    pub(crate) name: String,
    pub(crate) content: FieldType,
    /// The number of elements of an array.
    pub(crate) length: Option<usize>,
}

/// The type of a field.
pub(crate) enum FieldType {
    /// The environment's own pointer.
    Environment,
    Flag,
    Count,
    Event,
    Value(CType),
}

/// The layout of `program`'s state.
pub(crate) fn layout(program: &Program) -> StateLayout {
    let mut layout = StateLayout { fields: Vec::new(), events: Vec::new() };
    if program.instance == Instance::Context {
        layout.field("environment".to_owned(), FieldType::Environment, None);
    }
    for belief in &program.beliefs {
        layout.field(held(&belief.name), FieldType::Flag, None);
        for (index, ctype) in belief.types.iter().enumerate() {
            let name = belief_value(&belief.name, index);
            layout.field(name, FieldType::Value(ctype.clone()), None);
        }
        if let Some((_, time)) = timing(program, belief) {
            layout.field(told_at(&belief.name), FieldType::Value(time.clone()), None);
        }
    }
    if program.has_peers() {
        layout.field("me".to_owned(), FieldType::Value(CType::peer()), None);
    }
    layout.field("posted".to_owned(), FieldType::Event, None);
    for id in &program.posted {
        layout.events.push(event(Slot::Posted, &handler_name(program, *id)));
        layout.values(program, Slot::Posted, *id);
    }
    layout.deadline(program);
    for (_, handler) in perceived(program) {
        let trigger = handler_name(program, handler);
        layout.events.push(event(Slot::Perceived, &trigger));
        layout.field(pending(Slot::Perceived, &trigger), FieldType::Flag, None);
    }
    layout.messages(program);
    layout.rings(program);
    layout.inbox(program);
    layout.preemptive(program);
    layout.deferred(program);
    for counter in counters(program) {
        layout.field(counter.name.to_owned(), FieldType::Count, None);
    }
    layout
}

impl StateLayout {
    fn field(&mut self, name: String, content: FieldType, length: Option<usize>) {
        self.fields.push(Field { name, content, length });
    }

    fn values(&mut self, program: &Program, slot: Slot, id: HandlerId) {
        let trigger = handler_name(program, id);
        for (index, ctype) in program.handler(id).types.iter().enumerate() {
            let name = slot_value(slot, &trigger, index);
            self.field(name, FieldType::Value(ctype.clone()), None);
        }
    }

    fn deadline(&mut self, program: &Program) {
        let Some((_, time)) = limits(program) else { return };
        self.field("deadline".to_owned(), FieldType::Value(time.clone()), None);
        self.field("limited".to_owned(), FieldType::Event, None);
        for id in &program.limited {
            let trigger = handler_name(program, *id);
            self.events.push(event(Slot::Deadline, &trigger));
            for (index, ctype) in limited_types(program, *id).iter().enumerate() {
                let name = slot_value(Slot::Deadline, &trigger, index);
                self.field(name, FieldType::Value(ctype.clone()), None);
            }
        }
    }

    fn messages(&mut self, program: &Program) {
        for turn in asked_turns(program) {
            self.field(turn, FieldType::Count, None);
        }
        if has_values(program) {
            self.field("asked_taken".to_owned(), FieldType::Count, None);
        }
        for asked in &program.asked {
            let name = asked_name(program, asked);
            self.events.push(event(Slot::Asked, &name));
            for part in ring_parts(program, asked) {
                self.field(ring_field(program, asked, part), FieldType::Count, None);
            }
            for (index, ctype) in asked_types(program, asked).iter().enumerate() {
                let place = slot_value(Slot::Asked, &name, index);
                self.field(place, FieldType::Value(ctype.clone()), Some(asked.room));
            }
        }
        if noticed(program).next().is_some() {
            self.field(TOLD_TURN.to_owned(), FieldType::Count, None);
        }
        for told in noticed(program) {
            let name = told_name(program, told);
            self.events.push(event(Slot::Told, name));
            self.field(pending(Slot::Told, name), FieldType::Flag, None);
        }
    }

    fn rings(&mut self, program: &Program) {
        for ring in rings(program) {
            for part in ["count", "first"] {
                self.field(ring.field(part), FieldType::Count, None);
            }
            self.field(ring.field("queue"), FieldType::Event, Some(ring.length));
        }
    }

    fn inbox(&mut self, program: &Program) {
        let Some(ring) = inbox_ring(program) else { return };
        self.field("inbox_taken".to_owned(), FieldType::Count, None);
        if program.configuration.settings.queue {
            self.field("inbox_external".to_owned(), FieldType::Count, None);
        }
        for external in queued(program) {
            let trigger = external_name(external);
            self.events.push(event(Slot::Inbox, &trigger));
            for (index, ctype) in external.types.iter().enumerate() {
                let name = slot_value(Slot::Inbox, &trigger, index);
                self.field(name, FieldType::Value(ctype.clone()), Some(ring.length));
            }
        }
    }

    fn preemptive(&mut self, program: &Program) {
        for external in program.external.iter().filter(|external| external.preemptive) {
            let trigger = external_name(external);
            self.events.push(event(Slot::Preemptive, &trigger));
            self.field(pending(Slot::Preemptive, &trigger), FieldType::Flag, None);
            for (index, ctype) in external.types.iter().enumerate() {
                let name = slot_value(Slot::Preemptive, &trigger, index);
                self.field(name, FieldType::Value(ctype.clone()), None);
            }
        }
    }

    fn deferred(&mut self, program: &Program) {
        let queue = program.configuration.settings.queue;
        for id in &program.deferred {
            let trigger = handler_name(program, *id);
            self.events.push(event(Slot::Deferred, &trigger));
            if let Some(ring) = deferred_ring(program).filter(|_| queue) {
                // Each queued goal has its own arguments.
                for (index, ctype) in program.handler(*id).types.iter().enumerate() {
                    let name = slot_value(Slot::Deferred, &trigger, index);
                    self.field(name, FieldType::Value(ctype.clone()), Some(ring.length));
                }
                continue;
            }
            self.field(pending(Slot::Deferred, &trigger), FieldType::Flag, None);
            self.values(program, Slot::Deferred, *id);
        }
    }
}

/// Counters of events that failed or were dropped, so that none is lost silently.
pub(crate) struct Counter {
    /// The field; the interface has `NAME_events()`.
    pub(crate) name: &'static str,
    /// Description.
    pub(crate) meaning: &'static str,
}

/// All counters of the agent.
pub(crate) fn counters(program: &Program) -> impl Iterator<Item = Counter> {
    let always = [
        Counter {
            name: "unhandled",
            meaning: "Events since the start that no plan handled completely.",
        },
        Counter {
            name: "refused",
            meaning: "External events since the start that were refused because the inbox was full.",
        },
    ];
    let aborted = Counter {
        name: "aborted",
        meaning: "Posted events since the start that a pre-empting one replaced.",
    };
    always.into_iter().chain(program.has_preemptive().then_some(aborted))
}

/// Place of a pending event.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Slot {
    /// The event of the next step, posted by a plan.
    Posted,
    /// A posted goal whose deadline has passed.
    Deadline,
    /// Raised by the environment.
    Inbox,
    /// Raised by the environment, aborting the pending event.
    Preemptive,
    /// A changed belief.
    Perceived,
    /// Posted with `!!`.
    Deferred,
    /// A goal that a peer asks for.
    Asked,
    /// A belief that a peer told or took back.
    Told,
}

impl Slot {
    fn name(self) -> &'static str {
        match self {
            Self::Posted => "posted",
            Self::Deadline => "deadline",
            Self::Inbox => "inbox",
            Self::Preemptive => "preemptive",
            Self::Perceived => "perceived",
            Self::Deferred => "deferred",
            Self::Asked => "asked",
            Self::Told => "told",
        }
    }
}

/// The clock, if any goal has a deadline.
pub(super) fn limits(program: &Program) -> Option<&(BasicId, CType)> {
    program.clock.as_ref().filter(|_| !program.limited.is_empty())
}

/// The arguments of a goal with a deadline that its failure plans get, if it has any.
pub(super) fn limited_types(program: &Program, id: HandlerId) -> &[CType] {
    let handler = program.handler(id);
    if handler.failure.is_some() { &handler.types } else { &[] }
}

/// External events that use the inbox.
pub(super) fn queued(program: &Program) -> impl Iterator<Item = &External> {
    program.external.iter().filter(|external| !external.preemptive)
}

/// A queue of events, first in, first out.
pub(super) struct Ring {
    name: &'static str,
    pub(super) length: usize,
}

impl Ring {
    /// The name of its field `queue`, `first` or `count`.
    pub(super) fn field(&self, part: &str) -> String {
        format!("{}_{part}", self.name)
    }
}

/// Queue of external events; in queue mode also of deferred goals.
pub(super) fn inbox_ring(program: &Program) -> Option<Ring> {
    let settings = &program.configuration.settings;
    let external = if queued(program).next().is_some() { settings.inbox as usize } else { 0 };
    let shared = settings.queue && !program.deferred.is_empty();
    let length = external + if shared { program.deferred_room } else { 0 };
    (length > 0).then_some(Ring { name: "inbox", length })
}

/// Queue of deferred goals, which in queue mode is that of the external events.
pub(super) fn deferred_ring(program: &Program) -> Option<Ring> {
    let own = || Some(Ring { name: "deferred", length: program.deferred.len() });
    let queue = program.configuration.settings.queue;
    (!program.deferred.is_empty()).then(|| if queue { inbox_ring(program) } else { own() })?
}

/// All queues, in the order of service.
pub(super) fn rings(program: &Program) -> impl Iterator<Item = Ring> {
    let own = deferred_ring(program).filter(|ring| ring.name == "deferred");
    inbox_ring(program).into_iter().chain(own)
}

/// The field that counts the queued external events.
pub(super) fn external_count(program: &Program) -> &'static str {
    if program.configuration.settings.queue { "inbox_external" } else { "inbox_count" }
}

/// Beliefs whose change raises an event, with its handler.
pub(super) fn perceived(program: &Program) -> impl Iterator<Item = (&Belief, HandlerId)> {
    let find = |name: &str| program.beliefs.iter().find(|belief| belief.name == name);
    let names = program.configuration.perceived.iter();
    names.filter_map(move |name| {
        let belief = find(&name.text)?;
        Some((belief, belief.perceived?))
    })
}

/// The flag whether a belief is held.
pub(super) fn held(belief: &str) -> String {
    format!("belief_{belief}_held")
}

/// An argument of a belief.
pub(super) fn belief_value(belief: &str, index: usize) -> String {
    format!("belief_{belief}_{}", index + 1)
}

/// The time when a belief was told.
pub(super) fn told_at(belief: &str) -> String {
    format!("belief_{belief}_told_at")
}

/// The clock, and the type of its times, if the time is kept when the belief is told.
pub(super) fn timing<'a>(program: &'a Program, belief: &Belief) -> Option<&'a (BasicId, CType)> {
    let is_this = |told: &&Told| std::ptr::eq(program.belief(told.belief), belief);
    program.told.iter().find(is_this).and_then(|told| program.timing(told))
}

/// An argument of a pending event.
pub(super) fn slot_value(slot: Slot, trigger: &str, index: usize) -> String {
    format!("{}_{trigger}_{}", slot.name(), index + 1)
}

/// The flag of an event with its own slot.
pub(super) fn pending(slot: Slot, trigger: &str) -> String {
    format!("{}_{trigger}_pending", slot.name())
}

/// The enumerator of a pending event.
pub(super) fn event(slot: Slot, trigger: &str) -> String {
    format!("EVENT_{}_{trigger}", slot.name().to_uppercase())
}

/// `achieve_goto`; for test goals with a letter for each argument, `i` given and `o` queried:
/// `test_io_twice`. The user's name comes last, so that names are unique.
pub(crate) fn handler_name(program: &Program, id: HandlerId) -> String {
    let handler = program.handler(id);
    if handler.kind != TriggerKind::Test {
        return trigger_name(handler.operator, handler.kind, &handler.name);
    }
    let mode = handler.holes.iter().map(|hole| if *hole { 'o' } else { 'i' });
    let mode = if handler.holes.is_empty() { "n".to_owned() } else { mode.collect() };
    trigger_name(handler.operator, handler.kind, &format!("{mode}_{}", handler.name))
}

/// `achieve_goto`
pub(super) fn external_name(external: &External) -> String {
    trigger_name(external.operator, external.kind, &external.name)
}
