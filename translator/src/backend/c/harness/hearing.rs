//! Events of properties that peers cause.

use super::Builder;
use crate::backend::c::messages::Received;
use crate::backend::c::names::argument;
use crate::backend::c::said::{ASKED_TURN, TOLD_TURN, ring_field, told_name, urgent_turn};
use crate::backend::c::state::{Slot, belief_value, held, pending};
use crate::backend::writer::Writer;
use crate::configuration::{Cause, ExternalTrigger, Formula};
use crate::program::{Said, Told};
use crate::syntax::ast::{Operator, Performative};
use crate::types::CType;

impl Builder<'_> {
    /// Whether a peer has said what causes this event, and waits to be heard, as a C expression.
    pub(super) fn waits_to_be_heard(&self, event: &ExternalTrigger) -> String {
        match self.program.said(event) {
            Some(Said::Asked(index)) => {
                let asked = &self.program.asked[index];
                format!("(self->{} > 0U)", ring_field(self.program, asked, "count"))
            }
            Some(Said::Told(index)) => {
                let told = told_name(self.program, &self.program.told[index]);
                let (changed, held) = (pending(Slot::Told, told), held(told));
                let not = if event.operator == Operator::Add { "" } else { "!" };
                format!("(self->{changed} && {not}self->{held})")
            }
            None => "false".to_owned(),
        }
    }

    /// The turn that decides when the event of a peer is served, and this peer.
    pub(super) fn turn(&self, event: &ExternalTrigger) -> Option<(String, String)> {
        let (turn, sender) = match self.program.said(event)? {
            Said::Asked(index) => {
                let asked = &self.program.asked[index];
                let turn =
                    if asked.preemptive { urgent_turn(&asked.name) } else { ASKED_TURN.to_owned() };
                (turn, asked.sender)
            }
            Said::Told(index) => (TOLD_TURN.to_owned(), self.program.told[index].sender),
        };
        Some((turn, self.program.peer(sender)))
    }

    /// Calls a function for messages that arrive.
    pub(super) fn hear(&self, writer: &mut Writer, function: &Received, made: &str) {
        let all = self.properties().iter().flat_map(|property| property.formula.events());
        let mut events: Vec<&ExternalTrigger> = Vec::new();
        for event in all.filter(|event| self.program.said(event).is_some()) {
            if self.is_about(function, event) && !events.iter().any(|other| is_same(other, event)) {
                events.push(event);
            }
        }
        for (number, event) in events.iter().enumerate() {
            writer.line(format!("const bool waits_{number} = {};", self.waits(event)));
            if let Some(condition) = self.causes(function, event) {
                writer.line(format!("const bool causes_{number} = {condition};"));
            }
        }
        if events.is_empty() {
            writer.line(format!("{made};"));
            return;
        }
        writer.line(format!("const bool accepted = {made};"));
        writer.line("(void)accepted;");
        for (number, event) in events.iter().enumerate() {
            let is_this = |other: &ExternalTrigger| is_same(other, event);
            // What is taken back before it is heard need not be answered.
            writer.open(format!("if (waits_{number} && !{})", self.waits(event)));
            for property in self.properties() {
                if let Formula::Within { cause: Cause::Event(cause), .. } = &property.formula
                    && is_this(cause)
                {
                    writer.line(format!("due_{} = 0U;", property.name.text));
                }
            }
            writer.close("}");
            if self.causes(function, event).is_some() {
                writer.open(format!("if (accepted && causes_{number})"));
                self.happens(writer, is_this);
                writer.close("}");
            }
        }
    }

    /// Whether the function causes such events, or takes them back.
    fn is_about(&self, function: &Received, event: &ExternalTrigger) -> bool {
        let declared = match self.program.said(event) {
            Some(Said::Asked(_)) => Performative::Achieve,
            _ => Performative::Tell,
        };
        function.performative.declared() == declared && function.about == event.name.text
    }

    /// Whether this call, if it is accepted, causes the event, as a C expression.
    fn causes(&self, function: &Received, event: &ExternalTrigger) -> Option<String> {
        let from = |sender| format!("({} == {})", argument(0), self.program.peer(sender));
        match (self.program.said(event)?, function.performative, event.operator) {
            (Said::Asked(index), Performative::Achieve, _) => {
                Some(from(self.program.asked[index].sender))
            }
            (Said::Told(index), Performative::Tell, Operator::Add) => {
                let told = &self.program.told[index];
                Some(format!("{} && {}", from(told.sender), self.is_news(told)))
            }
            (Said::Told(index), Performative::Untell, Operator::Delete) => {
                let told = &self.program.told[index];
                let held = held(told_name(self.program, told));
                Some(format!("{} && self->{held}", from(told.sender)))
            }
            _ => None,
        }
    }

    /// Whether what a peer tells is a change, as a C expression.
    fn is_news(&self, told: &Told) -> String {
        let belief = self.program.belief(told.belief);
        // What cannot be compared always counts as changed.
        if !belief.types.iter().all(CType::has_equality) {
            return "true".to_owned();
        }
        let equal = (0..belief.types.len()).map(|index| {
            format!("(self->{} == {})", belief_value(&belief.name, index), argument(index + 1))
        });
        let held = format!("self->{}", held(&belief.name));
        let same: Vec<String> = std::iter::once(held).chain(equal).collect();
        format!("!({})", same.join(" && "))
    }
}

fn is_same(one: &ExternalTrigger, other: &ExternalTrigger) -> bool {
    let key = |event: &ExternalTrigger| {
        let source = event.source.as_ref().map(|peer| peer.text.clone());
        (event.operator, event.kind, event.name.text.clone(), source)
    };
    key(one) == key(other)
}
