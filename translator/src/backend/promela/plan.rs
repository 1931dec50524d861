//! Handlers and plans.

use super::choice::{Choice, Reader, and, matches};
use super::{Emission, Waiting};
use crate::coverage::always_finds_a_plan;
use crate::program::{BeliefId, Handler, HandlerId, Placed, Raise, Step};
use crate::types::TypeKind;

impl Emission<'_> {
    /// All handlers, each a part that is jumped to.
    pub(super) fn handlers(&mut self) {
        let mut number = 0;
        for (id, handler) in self.program.reachable_handlers() {
            self.select(id, handler);
            for (index, plan) in handler.plans.iter().enumerate() {
                self.writer.line(format!("plan_{}_{index}:", id.0));
                self.say(&format!("plan {number}"));
                number += 1;
                for placed in &plan.body {
                    self.placed(id, placed);
                }
                self.writer.line(format!("outcome = 0; goto end_{};", id.0));
            }
            self.writer.line(format!("fail_{}: outcome = 2;", id.0));
            self.writer.line(format!("end_{}: skip;", id.0));
            if let Some(failure) = handler.failure {
                self.writer.line("if");
                self.writer.line(":: outcome != 0 ->");
                self.call(failure);
                self.writer.line(":: else");
                self.writer.line("fi;");
            }
            self.writer.line(format!("goto done_{};", id.0));
        }
    }

    /// The first plan that applies.
    fn select(&mut self, id: HandlerId, handler: &Handler) {
        let held = |id: BeliefId| self.held(id);
        let mut reader = Reader::new(self.program, &self.comparisons, &held);
        let choices: Vec<Choice> = handler.plans.iter().map(|plan| reader.applies(plan)).collect();
        self.writer.line(format!("run_{}:", id.0));
        self.writer.line("if");
        let mut earlier = "true".to_owned();
        for (index, choice) in choices.into_iter().enumerate() {
            let guard = and(&[earlier.clone(), choice.holds]);
            self.writer.line(format!(":: {guard} -> goto plan_{}_{index}", id.0));
            earlier = and(&[earlier, choice.fails]);
        }
        if !always_finds_a_plan(handler) {
            self.writer.line(format!(":: {earlier} ->"));
            self.say(&format!("unplanned {}", id.0));
            self.writer.line(format!("outcome = 1; goto end_{}", id.0));
        }
        self.writer.line("fi;");
    }

    /// One formula.
    fn placed(&mut self, id: HandlerId, placed: &Placed) {
        let Placed { line, step } = placed;
        if step.values_can_fail() {
            self.may_fail(id, *line);
        }
        match step {
            Step::Action(call) => {
                let basic = self.program.basic(call.basic);
                if basic.result.kind == TypeKind::Void {
                    self.say(&format!("action {} {line}", call.basic.0));
                    self.writer.line(format!("act_{}();", basic.name.text));
                }
            }
            Step::Assign { .. } => {}
            Step::Add { belief, raise, .. } => self.add(id, *belief, *raise, *line),
            Step::Delete { belief, patterns, raise } => {
                let matching = Choice { holds: self.held(*belief), fails: matches(patterns).fails };
                self.delete(id, *belief, &matching, *raise, *line);
            }
            Step::Achieve { handler, .. } => {
                self.call(*handler);
                self.unless_achieved(id, *line);
            }
            Step::Post { handler, deadline, .. } => {
                let number = self.number(Waiting::Posted(*handler));
                if deadline.is_some() {
                    let overdue = self.number(Waiting::Overdue(*handler));
                    self.writer.line(format!("limited = {overdue};"));
                }
                self.writer.line(format!("posted = {number};"));
            }
            Step::Defer { handler, .. } => {
                let number = self.number(Waiting::Deferred(*handler));
                let queue = self.deferred_queue();
                let flag = format!("deferred_{}", handler.0);
                self.writer.line("if");
                self.writer.line(format!(":: !{flag} -> {flag} = true; {queue}!{number}"));
                self.writer.line(":: else");
                self.writer.line("fi;");
            }
            Step::Ask { belief, patterns, plans } => {
                let held = self.held(*belief);
                let free = matches(patterns).fails == "true";
                self.writer.line("if");
                if held != "false" {
                    self.writer.line(format!(":: {held}"));
                }
                if held != "true" || free {
                    let missing = if free { "true".to_owned() } else { format!("!({held})") };
                    self.writer.line(format!(":: {missing} ->"));
                    match plans {
                        Some(plans) => {
                            self.call(*plans);
                            self.unless_achieved(id, *line);
                        }
                        None => self.fail(id, *line),
                    }
                }
                self.writer.line("fi;");
            }
        }
    }

    fn add(&mut self, id: HandlerId, belief: BeliefId, raise: Raise, line: usize) {
        let believed = self.program.belief(belief);
        let held = self.held(belief);
        if raise == Raise::Nothing {
            self.believe(belief);
            return;
        }
        let may_differ = !believed.types.is_empty();
        self.writer.line("if");
        self.writer.line(if may_differ {
            ":: true ->".to_owned()
        } else {
            format!(":: !({held}) ->")
        });
        self.believe(belief);
        self.raise(id, raise, line);
        self.writer.line(format!(":: {held}"));
        self.writer.line("fi;");
    }

    fn delete(
        &mut self,
        id: HandlerId,
        belief: BeliefId,
        matching: &Choice,
        raise: Raise,
        line: usize,
    ) {
        let held = &matching.holds;
        self.writer.line("if");
        self.writer.line(format!(":: {held} ->"));
        self.forget(belief);
        self.raise(id, raise, line);
        let other = if matching.fails == "true" { "true".to_owned() } else { format!("!({held})") };
        self.writer.line(format!(":: {other}"));
        self.writer.line("fi;");
    }

    /// The plans of a belief that has changed.
    fn raise(&mut self, id: HandlerId, raise: Raise, line: usize) {
        match raise {
            Raise::Nothing => {}
            Raise::Post(handler) => {
                let number = self.number(Waiting::Posted(handler));
                self.writer.line(format!("posted = {number};"));
            }
            Raise::Call(handler) => {
                self.call(handler);
                self.writer.line("if");
                self.writer.line(":: outcome == 2 ->");
                self.fail(id, line);
                self.writer.line(":: else -> outcome = 0");
                self.writer.line("fi;");
            }
        }
    }

    fn unless_achieved(&mut self, id: HandlerId, line: usize) {
        self.writer.line("if");
        self.writer.line(":: outcome != 0 ->");
        self.fail(id, line);
        self.writer.line(":: else");
        self.writer.line("fi;");
    }

    fn may_fail(&mut self, id: HandlerId, line: usize) {
        self.writer.line("if");
        self.writer.line(":: true");
        self.writer.line(":: true ->");
        self.fail(id, line);
        self.writer.line("fi;");
    }

    fn fail(&mut self, id: HandlerId, line: usize) {
        self.say(&format!("fails {line}"));
        self.writer.line(format!("goto fail_{}", id.0));
    }

    /// Where each handler goes back to.
    pub(super) fn returns(&mut self) {
        for (id, _) in self.program.reachable_handlers() {
            let calls = self.calls.get(&id).copied().unwrap_or_default();
            self.writer.line(format!("done_{}:", id.0));
            self.writer.line("if");
            for call in 1..=calls {
                self.writer.line(format!(
                    ":: return_{0} == {call} -> return_{0} = 0; goto back_{0}_{call}",
                    id.0
                ));
            }
            self.writer.line("fi;");
        }
    }
}
