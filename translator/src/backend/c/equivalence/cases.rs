//! The states from which a step starts, by its event.

use super::Comparison;
use crate::backend::c::said::{asked_name, noticed, ring_field, told_name};
use crate::backend::c::state::{
    Ring, Slot, deferred_ring, external_name, handler_name, inbox_ring, limits, pending,
};
use crate::plain;
use crate::program::{Asked, External, HandlerId, trigger_text};

/// States in which a step handles the same event.
pub(super) struct Case {
    /// What the step does, for people.
    pub(super) name: String,
    /// Fields of the C's state, and their values.
    pub(super) fields: Fields,
}

type Fields = Vec<(String, String)>;

/// An event: what it is to the C, and to people.
type Event = (String, String);

/// With longer lists, the place of the first element and the number of elements stay unknown.
const LONGEST: usize = 4;

impl Comparison<'_> {
    /// All cases; each state is in one of them.
    pub(super) fn cases(&self) -> Vec<Case> {
        let program = self.program;
        let text = |id: HandlerId| program.handler(id).text();
        let none = self.nothing();
        let mut cases = Vec::new();
        // What is served before, and is not pending.
        let mut before = Fields::new();
        for trigger in &program.configuration.preemptive {
            if let Some((_, external)) = plain::preempting(program, trigger) {
                let flag = self.field(&pending(Slot::Preemptive, &external_name(external)));
                let fields = with(&before, [(flag.clone(), "true".to_owned())]);
                cases.push(Case { name: format!("{} pre-empts", written(external)), fields });
                before.push((flag, "false".to_owned()));
            }
            let urgent = program.asked.iter().filter(|asked| asked.preemptive);
            for asked in urgent.filter(|asked| asked.name == trigger.name.text) {
                self.asked(asked, "pre-empts", &mut before, &mut cases);
            }
        }
        let posted = self.field("posted");
        for id in &program.posted {
            let event = self.event(Slot::Posted, &handler_name(program, *id));
            let fields = with(&before, [(posted.clone(), event)]);
            let name = format!("{} goes on", text(*id));
            if limits(program).is_none() {
                cases.push(Case { name, fields });
                continue;
            }
            let limited = self.field("limited");
            for limit in &program.limited {
                let event = self.event(Slot::Deadline, &handler_name(program, *limit));
                cases.push(Case {
                    name: format!("{name}, with a deadline of {}", text(*limit)),
                    fields: with(&fields, [(limited.clone(), event)]),
                });
            }
            cases.push(Case { name, fields: with(&fields, [(limited, none.clone())]) });
        }
        before.push((posted, none));
        for (belief, handler) in plain::perceived(program) {
            let flag = pending(Slot::Perceived, &handler_name(program, handler));
            let flag = self.field(&flag);
            let fields = with(&before, [(flag.clone(), "true".to_owned())]);
            cases.push(Case { name: format!("+{} is perceived", belief.name), fields });
            before.push((flag, "false".to_owned()));
        }
        self.messages(&mut before, &mut cases);
        if let Some(ring) = inbox_ring(program) {
            self.first(&ring, &self.listed_events(), &mut before, &mut cases);
        }
        if let Some(ring) = deferred_ring(program).filter(|_| !plain::is_queue(program)) {
            self.first(&ring, &self.deferred_events(), &mut before, &mut cases);
        }
        cases.push(Case { name: "nothing happens".to_owned(), fields: before });
        cases
    }

    /// The first message that waits, in the order of their declarations: with any turn, every other may be the next event.
    fn messages(&self, before: &mut Fields, cases: &mut Vec<Case>) {
        let program = self.program;
        for asked in program.asked.iter().filter(|asked| !asked.preemptive) {
            self.asked(asked, "waits", before, cases);
        }
        for told in noticed(program) {
            let name = told_name(program, told);
            let flag = self.field(&pending(Slot::Told, name));
            let fields = with(before, [(flag.clone(), "true".to_owned())]);
            cases.push(Case { name: format!("a change of {name} waits"), fields });
            before.push((flag, "false".to_owned()));
        }
    }

    /// A goal of a peer, by how many of them wait.
    fn asked(&self, asked: &Asked, how: &str, before: &mut Fields, cases: &mut Vec<Case>) {
        let name = asked_name(self.program, asked);
        let count = self.field(&ring_field(self.program, asked, "count"));
        for waiting in 1..=asked.room {
            let fields = with(before, [(count.clone(), format!("{waiting}U"))]);
            cases.push(Case { name: format!("+!{name} {how} ({waiting} of them)"), fields });
        }
        before.push((count, "0U".to_owned()));
    }

    /// The events of the list, as in [`Self::listed`].
    fn listed_events(&self) -> Vec<Event> {
        let program = self.program;
        let external = program.external.iter().filter(|external| !external.preemptive);
        let mut texts: Vec<String> = external.map(written).collect();
        if plain::is_queue(program) {
            texts.extend(program.deferred.iter().map(|id| program.handler(*id).text()));
        }
        self.listed().into_iter().map(|(event, _)| event).zip(texts).collect()
    }

    fn deferred_events(&self) -> Vec<Event> {
        let texts = self.program.deferred.iter().map(|id| self.program.handler(*id).text());
        self.goal_events().into_iter().map(|(event, _)| event).zip(texts).collect()
    }

    /// Cases by the first event of a list, its place and the number of elements. If one of them is unknown, the C's
    /// event depends on more than constants, and CBMC executes the plans of all events instead of one's.
    fn first(&self, ring: &Ring, events: &[Event], before: &mut Fields, cases: &mut Vec<Case>) {
        let [first, count, queue] =
            ["first", "count", "queue"].map(|part| self.field(&ring.field(part)));
        for (event, text) in events {
            if ring.length > LONGEST {
                let fields = with(before, [(format!("{queue}[{first}]"), event.clone())]);
                cases.push(Case { name: format!("{text} is next"), fields });
                continue;
            }
            for (slot, elements) in places(ring.length) {
                let name = if ring.length == 1 {
                    format!("{text} is next")
                } else {
                    format!("{text} is next (slot {slot}, {elements} waiting)")
                };
                let fields = with(
                    before,
                    [
                        (first.clone(), format!("{slot}U")),
                        (count.clone(), format!("{elements}U")),
                        (format!("{queue}[{slot}]"), event.clone()),
                    ],
                );
                cases.push(Case { name, fields });
            }
        }
        before.push((count, "0U".to_owned()));
    }
}

/// All places of the first element, each with all numbers of elements.
fn places(length: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..length).flat_map(move |slot| (1..=length).map(move |elements| (slot, elements)))
}

fn with<const N: usize>(fields: &Fields, more: [(String, String); N]) -> Fields {
    fields.iter().cloned().chain(more).collect()
}

/// An event in AgentSpeak.
fn written(external: &External) -> String {
    trigger_text(external.operator, external.kind, &external.name)
}
