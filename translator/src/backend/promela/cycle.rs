//! The environment and the deliberation cycle.

use super::choice::UNKNOWN_PEER;
use super::logic::{and, not, or};
use super::scale::Scale;
use super::{Emission, Waiting};
use crate::program::{BeliefId, HandlerId};
use crate::syntax::ast::{Operator, TriggerKind};

/// One agent's environment may do something at any time.
fn free() -> (String, String) {
    ("true".to_owned(), String::new())
}

impl Emission<'_> {
    /// Possible transitions: an event is raised, a belief is set, or the agent takes a step.
    pub(super) fn environment(&mut self) {
        self.writer.line("if");
        for (index, external) in self.program.external.iter().enumerate() {
            let number = self.number(Waiting::External(index));
            let settings = &self.program.configuration.settings;
            let (room, raise) = if external.preemptive {
                ("true".to_owned(), format!("preempts_{index} = true;"))
            } else if settings.queue {
                (format!("raised < {}", settings.inbox), format!("raised++; inbox!{number};"))
            } else {
                (format!("len(inbox) < {}", settings.inbox), format!("inbox!{number};"))
            };
            let (when, then) = self.part.map_or_else(free, |part| part.environment(true));
            let guard = and(&[when, room]);
            self.writer.line(format!(":: {guard} -> {then}{raise}"));
            self.say(&format!("raise {number}"));
            self.on_raise(index);
            self.writer.line("goto finished");
        }
        for (index, belief) in self.program.beliefs.iter().enumerate() {
            let id = BeliefId(index);
            if !belief.settable {
                continue;
            }
            let held = self.held(id);
            // Setting a held belief again has no effect, unless its value is compared.
            let mut changes = vec![not(&held)];
            if belief.perceived.is_some() || !self.comparisons.of(&belief.name).is_empty() {
                changes.push("true".to_owned());
            }
            changes.extend(self.comparisons.scale(&belief.name).map(Scale::followed));
            let guard = or(&changes);
            if guard == "false" {
                continue;
            }
            let (when, then) = self.part.map_or_else(free, |part| part.environment(false));
            let guard = and(&[when, guard]);
            self.writer.line(format!(":: {guard} -> {then}"));
            if belief.perceived.is_some() {
                // The same value is not a change.
                self.writer.line("if");
                self.writer.line(format!(":: perceived_{index} = true"));
                if !belief.types.is_empty() {
                    self.writer.line(format!(":: {held}"));
                }
                self.writer.line("fi;");
            }
            self.believe(id);
            self.say(&format!("set {index}"));
            self.writer.line("goto finished");
        }
        let turn = if let Some(part) = self.part {
            self.hear(&part.heard());
            part.turn()
        } else {
            self.say_something();
            ":: true".to_owned()
        };
        self.writer.line(turn);
        self.writer.line("fi;");
    }

    /// One step of the agent.
    pub(super) fn step(&mut self) {
        self.say("step");
        self.before_step();
        self.writer.line("take: event = 0;");
        self.take();
        self.handle();
        self.writer.line("handled: skip;");
        self.writer.line("if");
        self.writer.line(":: outcome != 0 -> lost = true; outcome = 0");
        self.writer.line(":: else");
        self.writer.line("fi;");
        self.writer.line("if");
        self.writer.line(":: posted == 0 -> limited = 0");
        self.writer.line(":: else");
        self.writer.line("fi;");
        self.writer.line("stepped: event = 0;");
        self.forget_sources();
        self.after_step();
        self.writer.line("goto finished;");
    }

    /// Takes the event with the highest priority.
    fn take(&mut self) {
        self.writer.line("if");
        let mut before: Vec<String> = Vec::new();
        let guarded = |before: &[String], own: &str| {
            let mut all = before.to_vec();
            all.push(own.to_owned());
            all.join(" && ")
        };
        for trigger in &self.program.configuration.preemptive {
            if let Some((index, _)) = self.program.raised(trigger) {
                let number = self.number(Waiting::External(index));
                let flag = format!("preempts_{index}");
                self.writer.line(format!(
                    ":: {} -> {flag} = false; posted = 0; limited = 0; event = {number}",
                    guarded(&before, &flag)
                ));
                before.push(format!("!{flag}"));
            }
            self.take_urgent(&trigger.name.text, &mut before);
        }
        self.writer.line(format!(":: {} ->", guarded(&before, "posted != 0")));
        self.writer.line("event = posted; posted = 0;");
        if let Some(clock) = self.program.deadline_clock().filter(|clock| self.is_watched(*clock)) {
            self.writer.line("if");
            self.writer.line(":: limited != 0 ->");
            self.act(clock, 0);
            self.writer.line("skip");
            self.writer.line(":: else");
            self.writer.line("fi;");
        }
        self.writer.line("if");
        self.writer.line(":: true");
        // The clock may report that the deadline of a goal has passed.
        self.writer.line(":: limited != 0 -> event = limited; limited = 0");
        self.writer.line("fi");
        before.push("posted == 0".to_owned());
        for event in self.events.clone() {
            let Waiting::Perceived(belief, _) = event else { continue };
            let (number, flag) = (self.number(event), format!("perceived_{}", belief.0));
            self.writer.line(format!(
                ":: {} -> {flag} = false; event = {number}",
                guarded(&before, &flag)
            ));
            before.push(format!("!{flag}"));
        }
        self.take_messages(&mut before);
        for queue in self.queues() {
            let name = queue.name;
            let waiting = format!("len({name}) > 0");
            self.writer.line(format!(":: {} -> {name}?event", guarded(&before, &waiting)));
            before.push(format!("len({name}) == 0"));
        }
        self.writer.line(format!(":: {} -> goto stepped", before.join(" && ")));
        self.writer.line("fi;");
    }

    /// Handles the event; after a mere update of a belief the next one is taken.
    fn handle(&mut self) {
        self.writer.line("if");
        for event in self.events.clone() {
            let number = self.number(event);
            self.writer.line(format!(":: event == {number} ->"));
            self.say(&format!("event {number}"));
            match event {
                Waiting::Posted(id) => self.run(id),
                Waiting::Overdue(id) => match self.program.handler(id).failure {
                    Some(failure) => self.run_from(failure, UNKNOWN_PEER),
                    None => self.writer.line("outcome = 2; goto handled"),
                },
                Waiting::Perceived(belief, id) => {
                    let held = self.held(belief);
                    self.writer.line("if");
                    self.writer.line(format!(":: {held} ->"));
                    self.run(id);
                    self.writer.line(":: else -> goto take");
                    self.writer.line("fi");
                }
                Waiting::Asked(index) => {
                    let asked = &self.program.asked[index];
                    self.run_from(asked.handler, &asked.sender.to_string());
                }
                Waiting::Told(index) => self.handle_told(index),
                Waiting::External(index) => self.handle_external(index),
                Waiting::Deferred(id) => {
                    if !self.program.configuration.settings.queue {
                        self.writer.line(format!("deferred_{} = false;", id.0));
                    }
                    self.run(id);
                }
            }
        }
        self.writer.line("fi;");
    }

    fn handle_external(&mut self, index: usize) {
        let external = &self.program.external[index];
        if self.program.configuration.settings.queue && !external.preemptive {
            self.writer.line("raised--;");
        }
        match (external.belief, external.operator) {
            (Some(belief), Operator::Delete) => {
                let held = self.held(belief);
                self.writer.line("if");
                self.writer.line(format!(":: {held} ->"));
                self.forget(belief);
                self.run_or_take(external.handler);
                self.writer.line(":: else -> goto take");
                self.writer.line("fi");
            }
            (Some(belief), Operator::Add) => {
                self.believe(belief);
                self.run_or_take(external.handler);
            }
            (None, _) => self.run_or_take(external.handler),
        }
    }

    fn run_or_take(&mut self, handler: Option<HandlerId>) {
        self.run_from_or_take(handler, &self.peers().me());
    }

    pub(super) fn run_from_or_take(&mut self, handler: Option<HandlerId>, peer: &str) {
        match handler {
            Some(handler) => self.run_from(handler, peer),
            None => self.writer.line("goto take"),
        }
    }

    fn run(&mut self, id: HandlerId) {
        self.run_from(id, &self.peers().me());
    }

    /// Runs the plans for an event that comes from a peer.
    fn run_from(&mut self, id: HandlerId, peer: &str) {
        self.call_from(id, peer);
        if self.program.handler(id).kind == TriggerKind::Belief {
            // A percept without an applicable plan is not a failure.
            self.writer.line("if");
            self.writer.line(":: outcome == 1 -> outcome = 0");
            self.writer.line(":: else");
            self.writer.line("fi;");
        }
        self.writer.line("goto handled");
    }
}
