//! States of agents by what their next step handles.

use super::Builder;
use crate::backend::c::events::{event_name, no_event};
use crate::backend::c::state::{
    Slot, external_name, handler_name, inbox_ring, pending, perceived, queued,
};
use crate::backend::c::turns::{asks_nothing, silence};
use crate::syntax::ast::TriggerKind;

/// Assignments to an arbitrary state that leave one event which can come first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Moment {
    /// The goal of the event.
    pub(crate) goal: String,
    pub(crate) sets: Vec<String>,
}

impl Builder<'_> {
    /// For each goal that can be pending: as a posted one, raised with priority, and in the inbox.
    pub(super) fn moments(&self) -> Vec<Moment> {
        let program = self.program;
        let mut moments = Vec::new();
        let mut calm = Vec::new();
        for external in program.external.iter().filter(|external| external.preemptive) {
            let flag = pending(Slot::Preemptive, &external_name(external));
            let mut sets = calm.clone();
            sets.push(format!("self->{flag} = true;"));
            if external.kind == TriggerKind::Achieve {
                moments.push(Moment { goal: external.name.clone(), sets });
            }
            calm.push(format!("self->{flag} = false;"));
        }
        let no_peer = asks_nothing(program, &self.names, true).into_iter();
        calm.extend(no_peer.map(|set| format!("{set};")));
        for id in &program.posted {
            let event = event_name(&self.names, Slot::Posted, &handler_name(program, *id));
            let mut sets = calm.clone();
            sets.push(format!("self->posted = {event};"));
            moments.push(Moment { goal: program.handler(*id).name.clone(), sets });
        }
        calm.push(format!("self->posted = {};", no_event(&self.names)));
        for (_, handler) in perceived(program) {
            let flag = pending(Slot::Perceived, &handler_name(program, handler));
            calm.push(format!("self->{flag} = false;"));
        }
        calm.extend(silence(program, &self.names).into_iter().map(|set| format!("{set};")));
        let Some(ring) = inbox_ring(program) else { return moments };
        calm.push(format!("self->{} = 0U;", ring.field("first")));
        calm.push(format!("self->{} = 1U;", ring.field("count")));
        for external in queued(program).filter(|one| one.kind == TriggerKind::Achieve) {
            let event = event_name(&self.names, Slot::Inbox, &external_name(external));
            let mut sets = calm.clone();
            sets.push(format!("self->{}[0] = {event};", ring.field("queue")));
            moments.push(Moment { goal: external.name.clone(), sets });
        }
        moments
    }
}
