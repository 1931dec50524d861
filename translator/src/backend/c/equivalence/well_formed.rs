//! The states in which the C can be, as far as the comparison needs it.

use std::fmt::Write as _;

use super::Comparison;
use super::relation::numbered;
use crate::backend::c::said::{ring_field, ring_parts, turns};
use crate::backend::c::state::{
    Ring, Slot, deferred_ring, external_count, handler_name, held, inbox_ring, limits, pending,
    perceived,
};
use crate::plain;
use crate::program::HandlerId;

impl Comparison<'_> {
    /// The function `plain_well_formed()`: whether the C is in a state in which it can be.
    pub(super) fn well_formed(&self, text: &mut String) {
        let program = self.program;
        text.push_str("static bool plain_well_formed(void)\n{\n    int goals = 0;\n    int events = 0;\n    (void)goals;\n    (void)events;\n");
        let field = |name: &str| self.field(name);
        let unless = |text: &mut String, condition: &str| {
            _ = writeln!(text, "    if (!({condition})) return false;");
        };
        let among =
            |place: &str, ids: &[HandlerId], slot: Slot| {
                let mut allowed = vec![format!("{place} == {}", self.nothing())];
                allowed.extend(ids.iter().map(|id| {
                    format!("{place} == {}", self.event(slot, &handler_name(program, *id)))
                }));
                allowed.join(" || ")
            };
        unless(text, &among(&field("posted"), &program.posted, Slot::Posted));
        if limits(program).is_some() {
            unless(text, &among(&field("limited"), &program.limited, Slot::Deadline));
            let none = self.nothing();
            let (posted, limited) = (field("posted"), field("limited"));
            unless(text, &format!("{posted} != {none} || {limited} == {none}"));
        }
        // The C does not look whether such a belief is held.
        for (belief, handler) in perceived(program) {
            if !program.is_deleted(belief) {
                let pending = field(&pending(Slot::Perceived, &handler_name(program, handler)));
                unless(text, &format!("!{pending} || {}", field(&held(&belief.name))));
            }
        }
        if program.has_peers() {
            let peers = program.configuration.peers.len();
            unless(text, &format!("{} < {peers}U", field("me")));
            for turn in turns(program) {
                unless(text, &format!("{} < {peers}U", field(&turn)));
            }
        }
        for asked in &program.asked {
            for (part, relation) in [("count", "<="), ("first", "<")] {
                if ring_parts(program, asked).contains(&part) {
                    let place = field(&ring_field(program, asked, part));
                    unless(text, &format!("{place} {relation} {}U", asked.room));
                }
            }
        }
        if let Some(ring) = inbox_ring(program) {
            self.ring(text, &ring, &self.listed());
            let goals = if program.deferred.is_empty() {
                usize::MAX
            } else {
                plain::goal_number(program, HandlerId(0))
            };
            if plain::is_queue(program) {
                for slot in 0..ring.length {
                    let event =
                        format!("{}[{}]", field(&ring.field("queue")), self.at(&ring, slot));
                    let number = numbered(&event, self.listed().into_iter());
                    let count = field(&ring.field("count"));
                    _ = writeln!(
                        text,
                        "    if ({count} > {slot}U) {{ if (({number}) >= {goals}) goals++; else events++; }}"
                    );
                }
                unless(text, &format!("goals <= {}", program.deferred_room));
                unless(text, &format!("{} == (uint32_t)events", field(external_count(program))));
                unless(text, &format!("events <= {}", program.configuration.settings.inbox));
            }
        }
        if let Some(ring) = deferred_ring(program).filter(|_| !plain::is_queue(program)) {
            self.ring(text, &ring, &self.goal_events());
            for id in &program.deferred {
                let name = handler_name(program, *id);
                let event = self.event(Slot::Deferred, &name);
                let occurs = (0..ring.length).map(|slot| {
                    let (count, queue) = (field(&ring.field("count")), field(&ring.field("queue")));
                    format!(
                        "(({count} > {slot}U && {queue}[{}] == {event}) ? 1 : 0)",
                        self.at(&ring, slot)
                    )
                });
                let occurs = occurs.collect::<Vec<_>>().join(" + ");
                unless(
                    text,
                    &format!("({occurs}) == ({} ? 1 : 0)", field(&pending(Slot::Deferred, &name))),
                );
            }
        }
        text.push_str("    return true;\n}\n\n");
    }

    fn ring(&self, text: &mut String, ring: &Ring, events: &[(String, usize)]) {
        let (first, count) = (self.field(&ring.field("first")), self.field(&ring.field("count")));
        let length = ring.length;
        _ = writeln!(text, "    if (!({first} < {length}U && {count} <= {length}U)) return false;");
        for slot in 0..length {
            let event = format!("{}[{}]", self.field(&ring.field("queue")), self.at(ring, slot));
            let number = numbered(&event, events.iter().cloned());
            _ = writeln!(text, "    if ({count} > {slot}U && ({number}) == 0) return false;");
        }
    }
}
