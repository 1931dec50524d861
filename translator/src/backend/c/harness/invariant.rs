//! Candidates for the invariant of a proof, which keeps those that are inductive.

use std::collections::BTreeMap;

use super::{Builder, occupied};
use crate::backend::c::events::{event_name, no_event};
use crate::backend::c::said::{ring_field, ring_parts, turns};
use crate::backend::c::state::{
    Slot, belief_value, deferred_ring, external_count, external_name, handler_name, held, pending,
    perceived, queued, rings,
};
use crate::backend::c::turns::waits;
use crate::configuration::{Cause, Formula, Property};
use crate::program::{Belief, Value};
use crate::types::TypeKind;

impl Builder<'_> {
    /// The candidates, and by index the assignments to arbitrary states that say the same. Wrong ones do no harm: they
    /// are removed.
    pub(super) fn candidates(&self) -> (Vec<String>, BTreeMap<usize, String>) {
        let mut candidates = Vec::new();
        let mut fixed = BTreeMap::new();
        let posted: Vec<String> = (self.program.posted.iter())
            .map(|id| event_name(&self.names, Slot::Posted, &handler_name(self.program, *id)))
            .collect();
        let none = no_event(&self.names);
        let any_of = |left: &str, of: &[String]| {
            let tests: Vec<String> = of.iter().map(|one| format!("({left} == {one})")).collect();
            format!("({})", tests.join(" || "))
        };
        let mut posted_or_none = posted.clone();
        posted_or_none.push(none.clone());
        candidates.push(any_of("self->posted", &posted_or_none));
        self.rings_are_sound(&mut candidates);
        self.messages_are_sound(&mut candidates);
        self.something_waits(&mut candidates, &none, &posted);
        for belief in &self.program.beliefs {
            let held = format!("self->{}", held(&belief.name));
            for event in &posted {
                candidates.push(format!("((self->posted != {event}) || {held})"));
            }
            if let Some(handler) = belief.perceived {
                let pending = pending(Slot::Perceived, &handler_name(self.program, handler));
                candidates.push(format!("(!self->{pending} || {held})"));
            }
            fixed.insert(candidates.len(), format!("{held} = false;"));
            candidates.push(format!("(!{held})"));
            fixed.insert(candidates.len(), format!("{held} = true;"));
            candidates.push(held);
            for (index, value) in belief.initial.iter().flatten().enumerate() {
                if let Value::Constant(text, ctype) = value {
                    let field = belief_value(&belief.name, index);
                    // Other types have several values that are equal to one: 0.0 and -0.0.
                    if let TypeKind::Signed { .. } | TypeKind::Unsigned { .. } = ctype.kind {
                        fixed.insert(candidates.len(), format!("self->{field} = {text};"));
                    }
                    candidates.push(format!("(self->{field} == {text})"));
                }
            }
        }
        for property in self.properties() {
            self.monitor_candidates(property, &posted, &mut candidates);
        }
        (candidates, fixed)
    }

    fn rings_are_sound(&self, candidates: &mut Vec<String>) {
        for ring in rings(self.program) {
            let length = ring.length;
            let (count, first) = (ring.field("count"), ring.field("first"));
            let name = count.trim_end_matches("_count").to_owned();
            candidates.push(format!("(self->{count} <= {length}U)"));
            candidates.push(format!("(self->{first} < {length}U)"));
            let mut events: Vec<String> = Vec::new();
            if name == "inbox" {
                candidates.push(format!("(self->inbox_taken < {length}U)"));
                events.extend(queued(self.program).map(|external| {
                    event_name(&self.names, Slot::Inbox, &external_name(external))
                }));
            }
            if deferred_ring(self.program).is_some_and(|own| own.field("count") == count) {
                events.extend(self.program.deferred.iter().map(|id| {
                    event_name(&self.names, Slot::Deferred, &handler_name(self.program, *id))
                }));
                if self.program.configuration.settings.queue {
                    let room = self.program.deferred_room;
                    let external = external_count(self.program);
                    candidates.push(format!("(self->{external} <= self->{count})"));
                    candidates.push(format!("((self->{count} - self->{external}) <= {room}U)"));
                } else {
                    let flags: Vec<String> = (self.program.deferred.iter())
                        .map(|id| pending(Slot::Deferred, &handler_name(self.program, *id)))
                        .map(|flag| format!("(self->{flag} ? 1U : 0U)"))
                        .collect();
                    candidates.push(format!("(self->{count} == ({}))", flags.join(" + ")));
                }
            }
            for slot in 0..length {
                let free = format!("!{}", occupied(&name, slot, length));
                let known: Vec<String> = events
                    .iter()
                    .map(|event| format!("(self->{name}_queue[{slot}] == {event})"))
                    .collect();
                candidates.push(format!("({free} || {})", known.join(" || ")));
            }
        }
    }

    fn messages_are_sound(&self, candidates: &mut Vec<String>) {
        let program = self.program;
        let peers = program.configuration.peers.len();
        if peers > 0 {
            candidates.push(format!("(self->me < {peers}U)"));
            // Otherwise the turn could pass over a peer.
            candidates
                .extend(turns(program).iter().map(|turn| format!("(self->{turn} < {peers}U)")));
        }
        for asked in &program.asked {
            let count = ring_field(program, asked, "count");
            candidates.push(format!("(self->{count} <= {}U)", asked.room));
            if ring_parts(program, asked).contains(&"first") {
                let first = ring_field(program, asked, "first");
                candidates.push(format!("(self->{first} < {}U)", asked.room));
            }
        }
        // It asks itself for nothing, and believes nothing of what it says itself.
        for asked in &program.asked {
            let count = ring_field(program, asked, "count");
            let sender = program.peer(asked.sender);
            candidates.push(format!("((self->{count} == 0U) || (self->me != {sender}))"));
        }
        for told in &program.told {
            let held = held(&program.belief(told.belief).name);
            candidates
                .push(format!("(!self->{held} || (self->me != {}))", program.peer(told.sender)));
        }
    }

    fn something_waits(&self, candidates: &mut Vec<String>, none: &str, posted: &[String]) {
        let mut waiting = vec![format!("(self->posted != {none})")];
        waiting.extend(
            rings(self.program).map(|ring| format!("(self->{} > 0U)", ring.field("count"))),
        );
        for external in self.program.external.iter().filter(|external| external.preemptive) {
            let flag = pending(Slot::Preemptive, &external_name(external));
            waiting.push(format!("self->{flag}"));
        }
        for (_, handler) in perceived(self.program) {
            let flag = pending(Slot::Perceived, &handler_name(self.program, handler));
            waiting.push(format!("self->{flag}"));
        }
        waiting.extend(waits(self.program, &self.names));
        // Events of the agent only, and with those of the environment.
        candidates.push(format!("({})", waiting.join(" || ")));
        if let Some(ring) = deferred_ring(self.program) {
            let count = ring.field("count");
            candidates.push(format!("((self->posted != {none}) || (self->{count} > 0U))"));
            // A posted idle goal is pending from the first step on.
            for event in posted {
                candidates.push(format!("((self->posted == {event}) || (self->{count} > 0U))"));
            }
        }
    }

    fn monitor_candidates(&self, property: &Property, posted: &[String], out: &mut Vec<String>) {
        let name = &property.name.text;
        match &property.formula {
            Formula::Within { steps, cause, unless, .. } => {
                out.push(format!("(due_{name} <= {steps}U)"));
                for due in 1..=(*steps).min(4) {
                    for event in posted {
                        out.push(format!("((due_{name} != {due}U) || (self->posted != {event}))"));
                    }
                    let none = no_event(&self.names);
                    out.push(format!("((due_{name} != {due}U) || (self->posted != {none}))"));
                }
                if let Cause::Action(_) = cause {
                    // The answer may depend on the deletion of a belief by the action's plan.
                    let deleted = |belief: &&Belief| self.program.is_deleted(belief);
                    for belief in self.program.beliefs.iter().filter(deleted) {
                        let held = held(&belief.name);
                        out.push(format!("((due_{name} == 0U) || !self->{held})"));
                    }
                }
                if let Cause::Event(event) = cause {
                    out.push(format!("((due_{name} == 0U) || {})", self.waits(event)));
                    // Its sender may be the next one.
                    if let Some((turn, peer)) = self.turn(event) {
                        out.extend((1..=(*steps).min(4)).map(|due| {
                            format!("((due_{name} != {due}U) || (self->{turn} == {peer}))")
                        }));
                    }
                }
                // What a peer has said before excuses.
                let said = unless.iter().filter(|event| event.source.is_some());
                out.extend(
                    said.map(|event| format!("((due_{name} == 0U) || !{})", self.waits(event))),
                );
                for external in self.program.external.iter().filter(|e| e.preemptive) {
                    let flag = pending(Slot::Preemptive, &external_name(external));
                    out.push(format!("((due_{name} == 0U) || !self->{flag})"));
                }
                for asked in self.program.asked.iter().filter(|asked| asked.preemptive) {
                    let count = ring_field(self.program, asked, "count");
                    out.push(format!("((due_{name} == 0U) || (self->{count} == 0U))"));
                }
            }
            Formula::OnlyAfter { event, .. } => {
                for event in posted {
                    out.push(format!("(allowed_{name} || (self->posted != {event}))"));
                }
                out.push(format!("(allowed_{name} || !{})", self.waits(event)));
                // The belief that remembers the event.
                let deleted = |belief: &&Belief| self.program.is_deleted(belief);
                for belief in self.program.beliefs.iter().filter(deleted) {
                    out.push(format!("(allowed_{name} || !self->{})", held(&belief.name)));
                }
            }
            Formula::Count { .. } | Formula::AllHandled => {}
        }
    }
}
