//! Which state of the plain translation a state of the C is.

use std::fmt::Write as _;

use super::{Comparison, ENOUGH_ROOM};
use crate::backend::c::said::{asked_name, asked_types, ring_field, told_name, turns};
use crate::backend::c::state::{
    Ring, Slot, belief_value, counters, deferred_ring, external_name, handler_name, held,
    inbox_ring, limited_types, limits, pending, slot_value, timing, told_at,
};
use crate::plain;
use crate::program::HandlerId;
use crate::types::CType;

/// One element of the state: its name for people, its place in the plain state, when it matters, and its type;
/// no type for a plain number or truth value.
struct Element {
    name: String,
    place: String,
    matters: String,
    ctype: Option<CType>,
}

/// The function `plain_relate(..)`, and what it reads.
#[derive(Default)]
struct Relation {
    read: String,
    elements: Vec<Element>,
}

impl Relation {
    /// A number or truth value, and its expression in C.
    fn number(&mut self, name: &str, place: &str, from: &str) {
        let (name, place) = (name.to_owned(), place.to_owned());
        let element = Element { name, place, matters: String::new(), ctype: None };
        self.value(element, from);
    }

    /// An element, and its expression in C.
    fn value(&mut self, element: Element, from: &str) {
        _ = writeln!(self.read, "    to->{} = {from};", element.place);
        self.elements.push(element);
    }
}

impl Comparison<'_> {
    /// `plain_relate(..)` reads the C's state, `plain_well_formed()` says whether it is one, and
    /// `plain_compare()` asserts that it is the plain one.
    pub(super) fn relation(&self) -> String {
        let mut relation = Relation::default();
        self.beliefs(&mut relation);
        self.posted(&mut relation);
        self.said(&mut relation);
        self.list(&mut relation);
        self.goals(&mut relation);
        for counter in counters(self.program) {
            relation.number(counter.name, counter.name, &self.field(counter.name));
        }
        let read = &relation.read;
        let mut text =
            format!("static void plain_relate(struct plain_state *to)\n{{\n{read}}}\n\n");
        self.well_formed(&mut text);
        let mut conditions = vec![("well-formed".to_owned(), "plain_well_formed()".to_owned())];
        if self.names.is_context() {
            let same = "self->environment == plain_environment".to_owned();
            conditions.push(("environment".to_owned(), same));
        }
        conditions.extend(relation.elements.into_iter().map(|element| {
            let (left, right) =
                (format!("now.{}", element.place), format!("plain.{}", element.place));
            let same = match &element.ctype {
                Some(ctype) => self.same(ctype, &left, &right),
                None => format!("{left} == {right}"),
            };
            let condition = if element.matters.is_empty() {
                same
            } else {
                format!("!({}) || {same}", element.matters)
            };
            (element.name, condition)
        }));
        let read = "    struct plain_state now;\n    plain_relate(&now);\n";
        _ = writeln!(text, "static bool plain_related(void)\n{{\n{read}    bool related = true;");
        for (_, condition) in &conditions {
            _ = writeln!(text, "    related = related && ({condition});");
        }
        _ = writeln!(
            text,
            "    return related;\n}}\n\nstatic void plain_compare(void)\n{{\n{read}    \
             plain_assert(plain_made != PLAIN_NEVER, \"{ENOUGH_ROOM}\");\n    \
             plain_assert(plain_repeated == plain_made, \"another call, or none\");"
        );
        for (name, condition) in conditions {
            _ = writeln!(text, "    plain_assert({condition}, \"another state: {name}\");");
        }
        text.push_str("}\n\n");
        text
    }

    fn beliefs(&self, relation: &mut Relation) {
        for belief in &self.program.beliefs {
            let name = &belief.name;
            let place = format!("held_{name}");
            relation.number(&format!("belief {name}"), &place, &self.field(&held(name)));
            // The last values of what a peer took back matter until that is noticed.
            let told = self.program.told.iter().enumerate().find(|(_, told)| {
                std::ptr::eq(self.program.belief(told.belief), belief)
                    && (told.added.is_some() || told.removed.is_some())
            });
            let matters = match told {
                Some((index, _)) => format!("plain.{place} || plain.told_{index}"),
                None => format!("plain.{place}"),
            };
            for (index, ctype) in belief.types.iter().enumerate() {
                let element = Element {
                    name: format!("belief {name}"),
                    place: format!("value_{name}_{index}"),
                    matters: matters.clone(),
                    ctype: Some(ctype.clone()),
                };
                relation.value(element, &self.field(&belief_value(name, index)));
            }
            if let Some((_, time)) = timing(self.program, belief) {
                let element = Element {
                    name: format!("when {name} was told"),
                    place: format!("told_at_{name}"),
                    matters: format!("plain.{place}"),
                    ctype: Some(time.clone()),
                };
                relation.value(element, &self.field(&told_at(name)));
            }
            if let Some(handler) = belief.perceived {
                let flag = pending(Slot::Perceived, &handler_name(self.program, handler));
                let name = format!("perceived {name}");
                relation.number(&name, &format!("perceived_{}", belief.name), &self.field(&flag));
            }
        }
    }

    fn posted(&self, relation: &mut Relation) {
        let program = self.program;
        let numbers = |slot: Slot, ids: &[HandlerId]| -> Vec<(String, usize)> {
            ids.iter().map(|id| (self.event(slot, &handler_name(program, *id)), id.0 + 1)).collect()
        };
        let posted = numbers(Slot::Posted, &program.posted).into_iter();
        let from = numbered(&self.field("posted"), posted);
        relation.number("the posted event", "posted", &from);
        for id in &program.posted {
            self.arguments(
                relation,
                *id,
                ("posted", Slot::Posted, "posted"),
                &program.handler(*id).types,
            );
        }
        let Some((_, clock)) = limits(program) else {
            relation.read.push_str("    to->limited = 0;\n");
            return;
        };
        let limited = numbers(Slot::Deadline, &program.limited).into_iter();
        let from = numbered(&self.field("limited"), limited);
        relation.number("the goal with a deadline", "limited", &from);
        let element = Element {
            name: "the deadline".to_owned(),
            place: "deadline".to_owned(),
            matters: "plain.limited != 0".to_owned(),
            ctype: Some(clock.clone()),
        };
        relation.value(element, &self.field("deadline"));
        for id in &program.limited {
            self.arguments(
                relation,
                *id,
                ("limited", Slot::Deadline, "limited"),
                limited_types(program, *id),
            );
        }
    }

    /// The arguments of the goal in a place.
    fn arguments(
        &self,
        relation: &mut Relation,
        id: HandlerId,
        (place, slot, which): (&str, Slot, &str),
        types: &[CType],
    ) {
        let trigger = handler_name(self.program, id);
        for (index, ctype) in types.iter().enumerate() {
            let element = Element {
                name: format!("arguments of {}", self.program.handler(id).text()),
                place: format!("{place}_{}_{index}", id.0),
                matters: format!("plain.{which} == {}", id.0 + 1),
                ctype: Some(ctype.clone()),
            };
            relation.value(element, &self.field(&slot_value(slot, &trigger, index)));
        }
    }

    /// Who the agent is, and what its peers say.
    fn said(&self, relation: &mut Relation) {
        let program = self.program;
        let number = |name: &str| format!("(int){}", self.field(name));
        if !program.has_peers() {
            return;
        }
        relation.number("who it is", "me", &number("me"));
        let turns = turns(program);
        for turn in &turns {
            relation.number("whose turn it is", turn, &number(turn));
        }
        for turn in plain::TURNS.iter().filter(|turn| !turns.iter().any(|known| known == *turn)) {
            _ = writeln!(relation.read, "    to->{turn} = 0;");
        }
        for (index, asked) in program.asked.iter().enumerate() {
            let name = asked_name(program, asked);
            let place = format!("asked_{index}");
            let count = number(&ring_field(program, asked, "count"));
            relation.number(&format!("the number of +!{name}"), &place, &count);
            for (argument, ctype) in asked_types(program, asked).iter().enumerate() {
                let first = self.field(&ring_field(program, asked, "first"));
                let field = self.field(&slot_value(Slot::Asked, &name, argument));
                for slot in 0..asked.room {
                    let element = Element {
                        name: format!("arguments of +!{name}"),
                        place: format!("asked_{index}_{argument}[{slot}]"),
                        matters: format!("plain.{place} > {slot}"),
                        ctype: Some(ctype.clone()),
                    };
                    let from = format!("{field}[({first} + {slot}U) % {}U]", asked.room);
                    relation.value(element, &from);
                }
            }
        }
        for (index, told) in program.told.iter().enumerate() {
            if told.added.is_some() || told.removed.is_some() {
                let name = told_name(program, told);
                let flag = self.field(&pending(Slot::Told, name));
                relation.number(&format!("a change of {name}"), &format!("told_{index}"), &flag);
            }
        }
    }

    /// Pre-empting events and the list of the others.
    fn list(&self, relation: &mut Relation) {
        let program = self.program;
        for (number, external) in
            program.external.iter().enumerate().filter(|(_, external)| external.preemptive)
        {
            let name = external_name(external);
            let place = format!("pending_{number}");
            relation.number(
                &format!("pending {name}"),
                &place,
                &self.field(&pending(Slot::Preemptive, &name)),
            );
            for (index, ctype) in external.types.iter().enumerate() {
                let element = Element {
                    name: format!("arguments of {name}"),
                    place: format!("event_{number}_{index}"),
                    matters: format!("plain.{place}"),
                    ctype: Some(ctype.clone()),
                };
                relation.value(element, &self.field(&slot_value(Slot::Preemptive, &name, index)));
            }
        }
        let Some(ring) = inbox_ring(program) else {
            relation.read.push_str("    to->count = 0;\n");
            return;
        };
        let count = format!("(int){}", self.field(&ring.field("count")));
        relation.number("the number of events", "count", &count);
        for slot in 0..ring.length {
            let from = self.at(&ring, slot);
            let event = format!("{}[{from}]", self.field(&ring.field("queue")));
            let place = format!("queue[{slot}]");
            _ = writeln!(
                relation.read,
                "    to->{place} = {};",
                numbered(&event, self.listed().into_iter())
            );
            let matters = format!("plain.count > {slot}");
            relation.elements.push(Element {
                name: "the list of events".to_owned(),
                place: place.clone(),
                matters: matters.clone(),
                ctype: None,
            });
            let mut values =
                |name: &str, number: usize, to: String, from_field: String, ctype: &CType| {
                    let element = Element {
                        name: format!("arguments of {name}"),
                        place: format!("{to}[{slot}]"),
                        matters: format!("{matters} && plain.{place} == {number}"),
                        ctype: Some(ctype.clone()),
                    };
                    relation.value(element, &format!("{}[{from}]", self.field(&from_field)));
                };
            for (number, external) in
                program.external.iter().enumerate().filter(|(_, external)| !external.preemptive)
            {
                let name = external_name(external);
                for (index, ctype) in external.types.iter().enumerate() {
                    values(
                        &name,
                        plain::event_number(number),
                        format!("event_{number}_{index}"),
                        slot_value(Slot::Inbox, &name, index),
                        ctype,
                    );
                }
            }
            if plain::is_queue(program) {
                for id in &program.deferred {
                    let name = handler_name(program, *id);
                    for (index, ctype) in program.handler(*id).types.iter().enumerate() {
                        values(
                            &name,
                            plain::goal_number(program, *id),
                            format!("deferred_{}_{index}", id.0),
                            slot_value(Slot::Deferred, &name, index),
                            ctype,
                        );
                    }
                }
            }
        }
    }

    /// The slot of a ring's element.
    pub(super) fn at(&self, ring: &Ring, element: usize) -> String {
        let first = self.field(&ring.field("first"));
        format!("({first} + {element}U) % {}U", ring.length)
    }

    /// Events that can be in the list, with their numbers.
    pub(super) fn listed(&self) -> Vec<(String, usize)> {
        let program = self.program;
        let external = program.external.iter().enumerate();
        let mut events: Vec<(String, usize)> = external
            .filter(|(_, external)| !external.preemptive)
            .map(|(number, external)| {
                (self.event(Slot::Inbox, &external_name(external)), plain::event_number(number))
            })
            .collect();
        if plain::is_queue(program) {
            events.extend(self.goal_events());
        }
        events
    }

    pub(super) fn goal_events(&self) -> Vec<(String, usize)> {
        let program = self.program;
        let goals = program.deferred.iter();
        goals
            .map(|id| {
                (
                    self.event(Slot::Deferred, &handler_name(program, *id)),
                    plain::goal_number(program, *id),
                )
            })
            .collect()
    }

    /// Deferred goals with a list of their own.
    fn goals(&self, relation: &mut Relation) {
        let program = self.program;
        let Some(ring) = deferred_ring(program).filter(|_| !plain::is_queue(program)) else {
            relation.read.push_str("    to->waiting = 0;\n");
            return;
        };
        let count = format!("(int){}", self.field(&ring.field("count")));
        relation.number("the number of deferred goals", "waiting", &count);
        for slot in 0..ring.length {
            let event = format!("{}[{}]", self.field(&ring.field("queue")), self.at(&ring, slot));
            let place = format!("deferred[{slot}]");
            _ = writeln!(
                relation.read,
                "    to->{place} = {};",
                numbered(&event, self.goal_events().into_iter())
            );
            relation.elements.push(Element {
                name: "the deferred goals".to_owned(),
                place,
                matters: format!("plain.waiting > {slot}"),
                ctype: None,
            });
        }
        for id in &program.deferred {
            let name = handler_name(program, *id);
            for (index, ctype) in program.handler(*id).types.iter().enumerate() {
                let element = Element {
                    name: format!("arguments of {}", program.handler(*id).text()),
                    place: format!("deferred_{}_{index}", id.0),
                    matters: self.field(&pending(Slot::Deferred, &name)),
                    ctype: Some(ctype.clone()),
                };
                relation.value(element, &self.field(&slot_value(Slot::Deferred, &name, index)));
            }
        }
    }
}

/// The number of an event as an expression, 0 for none.
pub(super) fn numbered(from: &str, events: impl Iterator<Item = (String, usize)>) -> String {
    events.fold("0".to_owned(), |otherwise, (event, number)| {
        format!("({from} == {event}) ? {number} : ({otherwise})")
    })
}
