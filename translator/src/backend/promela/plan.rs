//! Handlers and plans.

use super::choice::{Reader, UNKNOWN_PEER, matches};
use super::logic::{Choice, and};
use super::{Emission, Waiting};
use crate::coverage::always_finds_a_plan;
use crate::program::{
    BasicId, BeliefId, ContextCall, Effect, Handler, HandlerId, Placed, Plan, Raise, Step,
};

/// Handlers with more plans try them one by one.
const MOST_AT_ONCE: usize = 64;

impl Emission<'_> {
    /// All handlers, each a section that is jumped to.
    pub(super) fn handlers(&mut self) {
        let mut number = 0;
        for (id, handler) in self.program.handlers() {
            self.select(id, handler);
            for (index, plan) in handler.plans.iter().enumerate() {
                self.writer.line(format!("plan_{}_{index}:", id.0));
                self.say(&format!("plan {number}"));
                number += 1;
                if let Some(trace) = self.program.trace().filter(|trace| self.is_watched(*trace)) {
                    self.act(trace, plan.lines.0);
                }
                for placed in &plan.body {
                    self.placed(id, index, placed);
                }
                self.writer.line(format!("outcome = 0; goto end_{};", id.0));
            }
            self.writer.line(format!("fail_{}: outcome = 2;", id.0));
            self.writer.line(format!("end_{}: skip;", id.0));
            if let Some(failure) = handler.failure {
                self.writer.line("if");
                self.writer.line(":: outcome != 0 ->");
                let source = self.source(id).unwrap_or_else(|| UNKNOWN_PEER.to_owned());
                self.call_from(failure, &source);
                self.writer.line(":: else");
                self.writer.line("fi;");
            }
            self.writer.line(format!("goto done_{};", id.0));
        }
    }

    /// Selects the first applicable plan.
    fn select(&mut self, id: HandlerId, handler: &Handler) {
        let (held, peers) = (|id: BeliefId| self.held(id), self.peers());
        let mut reader = Reader::new(self.program, &self.comparisons, &held, &peers);
        let source = self.source(id);
        let source = source.as_deref();
        let choices: Vec<Choice> =
            handler.plans.iter().map(|plan| reader.applies(plan, source)).collect();
        self.writer.line(format!("run_{}:", id.0));
        if choices.len() > MOST_AT_ONCE {
            self.select_one_by_one(id, handler, choices);
            return;
        }
        self.writer.line("if");
        let mut earlier = "true".to_owned();
        for (index, choice) in choices.into_iter().enumerate() {
            let guard = and(&[earlier.clone(), choice.holds]);
            self.writer.line(format!(":: {guard} ->"));
            handler.plans[..index].iter().for_each(|plan| self.rejected(plan));
            self.chosen(&handler.plans[index]);
            self.choose_receivers(id, index);
            self.writer.line(format!("goto plan_{}_{index}", id.0));
            earlier = and(&[earlier, choice.fails]);
        }
        if !always_finds_a_plan(handler) {
            self.writer.line(format!(":: {earlier} ->"));
            handler.plans.iter().for_each(|plan| self.rejected(plan));
            self.unplanned(id);
        }
        self.writer.line("fi;");
    }

    /// The same for handlers with many plans: each is tried separately, so that the text grows linearly.
    fn select_one_by_one(&mut self, id: HandlerId, handler: &Handler, choices: Vec<Choice>) {
        for (index, choice) in choices.into_iter().enumerate() {
            self.writer.line("if");
            self.writer.line(format!(":: {} ->", choice.holds));
            self.chosen(&handler.plans[index]);
            self.choose_receivers(id, index);
            self.writer.line(format!("goto plan_{}_{index}", id.0));
            self.writer.line(format!(":: {} ->", choice.fails));
            self.rejected(&handler.plans[index]);
            self.writer.line("skip");
            self.writer.line("fi;");
        }
        if always_finds_a_plan(handler) {
            // One of them always applies here; letting the last one through is conservative.
            self.writer.line(format!("goto plan_{}_{};", id.0, handler.plans.len() - 1));
        } else {
            self.unplanned(id);
            self.writer.line(";");
        }
    }

    fn unplanned(&mut self, id: HandlerId) {
        self.say(&format!("unplanned {}", id.0));
        self.writer.line(format!("outcome = 1; goto end_{}", id.0));
    }

    /// A plan applies: the calls in its context are made.
    fn chosen(&mut self, plan: &Plan) {
        for ContextCall { basic, certain } in plan.context_calls() {
            if certain {
                self.act(basic, plan.lines.0);
            } else {
                self.may_act(basic, plan.lines.0);
            }
        }
    }

    /// A plan does not apply: some calls in its context are made.
    fn rejected(&mut self, plan: &Plan) {
        for ContextCall { basic, .. } in plan.context_calls() {
            self.may_act(basic, plan.lines.0);
        }
    }

    /// A call of an action or function.
    pub(super) fn act(&mut self, basic: BasicId, line: usize) {
        if self.is_printed(basic) {
            self.say(&format!("action {} {line}", basic.0));
            let act = self.act_name(&self.program.basic(basic).name.text);
            self.writer.line(format!("{act}();"));
        }
    }

    fn may_act(&mut self, basic: BasicId, line: usize) {
        if self.is_printed(basic) {
            self.writer.line("if");
            self.writer.line(":: true ->");
            self.act(basic, line);
            self.writer.line("skip");
            self.writer.line(":: true");
            self.writer.line("fi;");
        }
    }

    /// Effects of evaluating the values of a formula.
    fn effects(&mut self, id: HandlerId, step: &Step, line: usize) {
        let mut failed = false;
        for effect in step.effects() {
            match effect {
                // Two failures in a row are one.
                Effect::MayFail if failed => {}
                Effect::MayFail => self.may_fail(id, line),
                Effect::Call(basic) => self.act(basic, line),
            }
            failed = effect == Effect::MayFail;
        }
    }

    /// One formula.
    fn placed(&mut self, id: HandlerId, plan: usize, placed: &Placed) {
        let Placed { line, step, .. } = placed;
        self.effects(id, step, *line);
        match step {
            // Their calls are made by `effects`.
            Step::Action(call) => self.send((id, plan), call),
            Step::Broadcast { basic, .. } => self.broadcast(*basic),
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
                let flag = format!("deferred_{}", handler.0);
                self.writer.line("if");
                if self.program.configuration.settings.queue {
                    let room = self.program.deferred_room;
                    self.writer.line(format!(":: len(inbox) - raised < {room} -> inbox!{number}"));
                    self.writer.line(":: else -> lost = true");
                } else {
                    self.writer.line(format!(":: !{flag} -> {flag} = true; deferred!{number}"));
                    self.writer.line(":: else");
                }
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

    /// Runs or posts the plans of a changed belief.
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

    /// Return addresses of each handler.
    pub(super) fn returns(&mut self) {
        for (id, _) in self.program.handlers() {
            let calls = self.calls.get(&id).copied().unwrap_or_default();
            self.writer.line(format!("done_{}:", id.0));
            if calls == 0 {
                // Never called: beliefs that are always held are not queried in plans.
                self.writer.line("goto finished;");
                continue;
            }
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
