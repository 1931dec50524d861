//! The states from which a step starts, by its event.

use super::Comparison;
use crate::backend::c::state::{
    Ring, Slot, deferred_ring, external_name, handler_name, inbox_ring, limits, pending,
};
use crate::plain;

/// Fields of the C's state, and their values.
type Case = Vec<(String, String)>;

/// With longer lists, the place of the first element stays unknown.
const LONGEST: usize = 4;

impl Comparison<'_> {
    /// All cases; each state is in one of them.
    pub(super) fn cases(&self) -> Vec<Case> {
        let program = self.program;
        let none = self.nothing();
        let mut cases = Vec::new();
        // What is served before, and is not pending.
        let mut before: Case = Vec::new();
        for external in plain::preempting(program).map(|(_, external)| external) {
            let flag = self.names.field(&pending(Slot::Preemptive, &external_name(external)));
            cases.push(with(&before, [(flag.clone(), "true".to_owned())]));
            before.push((flag, "false".to_owned()));
        }
        let posted = self.names.field("posted");
        for id in &program.posted {
            let event = self.event(Slot::Posted, &handler_name(program, *id));
            let case = with(&before, [(posted.clone(), event)]);
            if limits(program).is_none() {
                cases.push(case);
                continue;
            }
            let limited = self.names.field("limited");
            let limits = program.limited.iter();
            let limits = limits.map(|id| self.event(Slot::Deadline, &handler_name(program, *id)));
            for limit in limits.chain([none.clone()]) {
                cases.push(with(&case, [(limited.clone(), limit)]));
            }
        }
        before.push((posted, none));
        for (_, handler) in plain::perceived(program) {
            let flag = pending(Slot::Perceived, &handler_name(program, handler));
            let flag = self.names.field(&flag);
            cases.push(with(&before, [(flag.clone(), "true".to_owned())]));
            before.push((flag, "false".to_owned()));
        }
        if let Some(ring) = inbox_ring(program) {
            self.first(&ring, &self.listed(), &mut before, &mut cases);
        }
        if let Some(ring) = deferred_ring(program).filter(|_| !plain::is_queue(program)) {
            self.first(&ring, &self.goal_events(), &mut before, &mut cases);
        }
        cases.push(before);
        cases
    }

    /// Cases by the first event of a list.
    fn first(
        &self,
        ring: &Ring,
        events: &[(String, usize)],
        before: &mut Case,
        cases: &mut Vec<Case>,
    ) {
        let [first, count, queue] =
            ["first", "count", "queue"].map(|part| self.names.field(&ring.field(part)));
        for (event, _) in events {
            if ring.length > LONGEST {
                cases.push(with(before, [(format!("{queue}[{first}]"), event.clone())]));
                continue;
            }
            for slot in 0..ring.length {
                cases.push(with(
                    before,
                    [
                        (first.clone(), format!("{slot}U")),
                        (format!("{queue}[{slot}]"), event.clone()),
                    ],
                ));
            }
        }
        before.push((count, "0U".to_owned()));
    }
}

fn with<const N: usize>(case: &Case, more: [(String, String); N]) -> Case {
    case.iter().cloned().chain(more).collect()
}
