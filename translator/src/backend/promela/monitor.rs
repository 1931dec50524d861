//! Monitors of properties. One is checked at a time, so they share their variables.

use super::{Emission, Writer};
use crate::configuration::{CallBound, Cause, ExternalTrigger, Formula, Property};
use crate::program::{BasicId, BeliefId, Said};
use crate::syntax::ast::{Name, Operator};
use crate::types::TypeKind;

impl Emission<'_> {
    /// The role of each action in each property.
    pub(super) fn actions(&mut self) {
        for (index, basic) in self.program.configuration.basics.iter().enumerate() {
            if !self.is_printed(BasicId(index)) {
                continue;
            }
            let name = &basic.name.text;
            self.writer.open_here(format!("inline {}()", self.act_name(name)));
            self.writer.open_here("d_step");
            if let Some(part) = &self.part {
                for deed in part.deeds(name) {
                    self.writer.line(deed);
                }
            }
            for role in [Role::Main, Role::Cause, Role::Until] {
                let concerned: Vec<String> = (1..)
                    .zip(self.properties())
                    .filter(|(_, property)| self.plays(property, role, name))
                    .map(|(number, _)| format!("checked == {number}"))
                    .collect();
                if concerned.is_empty() {
                    continue;
                }
                let counter = role.counter();
                self.writer.line("if");
                // Saturates at two, which is already a violation.
                self.writer.line(format!(
                    ":: ({}) && {counter} < 2 -> {counter}++",
                    concerned.join(" || ")
                ));
                self.writer.line(":: else");
                self.writer.line("fi;");
            }
            self.writer.line("skip");
            self.writer.close("}");
            self.writer.close("}");
        }
        self.writer.line("");
    }

    /// The name of what a call of an action does.
    pub(super) fn act_name(&self, action: &str) -> String {
        let peer = self.part.as_ref().map_or_else(String::new, |part| format!("{}_", part.peer));
        format!("act_{peer}{action}")
    }

    /// Whether calls are printed and counted: those of actions, and of functions in properties.
    pub(super) fn is_printed(&self, id: BasicId) -> bool {
        self.program.basic(id).result.kind == TypeKind::Void || self.is_watched(id)
    }

    /// Whether a property refers to an action.
    pub(super) fn is_watched(&self, id: BasicId) -> bool {
        let name = &self.program.basic(id).name.text;
        let roles = [Role::Main, Role::Cause, Role::Until];
        let watches =
            |property: &Property| roles.iter().any(|role| self.plays(property, *role, name));
        self.properties().iter().any(watches)
            || self.part.as_ref().is_some_and(|part| !part.deeds(name).is_empty())
    }

    /// Whether an action has a role in a property.
    fn plays(&self, property: &Property, role: Role, action: &str) -> bool {
        let is_one_of = |name: &str| {
            let classes = &self.program.configuration.classes;
            match classes.iter().find(|class| class.name.text == name) {
                Some(class) => class.actions.iter().any(|member| member.text == action),
                None => name == action,
            }
        };
        match (&property.formula, role) {
            (Formula::Count { action, .. } | Formula::OnlyAfter { action, .. }, Role::Main) => {
                is_one_of(&action.text)
            }
            (Formula::Within { actions, .. }, Role::Main) => {
                actions.iter().any(|name| is_one_of(&name.text))
            }
            (Formula::Within { cause: Cause::Action(cause), .. }, Role::Cause) => {
                is_one_of(&cause.text)
            }
            (Formula::OnlyAfter { until, .. }, Role::Until) => {
                until.iter().any(|name| is_one_of(&name.text))
            }
            _ => false,
        }
    }

    /// The environment has raised an event.
    pub(super) fn on_raise(&mut self, index: usize) {
        let is_this = |event: &ExternalTrigger| {
            self.program.raised(event).is_some_and(|(other, _)| other == index)
        };
        let cases = match &self.part {
            Some(part) => part.on_raise(index),
            None => self.on_event(is_this),
        };
        self.of_the_checked(cases);
    }

    /// A peer says something that causes an event.
    pub(super) fn on_said(&mut self, said: Said, operator: Operator) {
        let is_this = |event: &ExternalTrigger| {
            event.operator == operator && self.program.said(event) == Some(said)
        };
        let cases = self.on_event(is_this);
        self.of_the_checked(cases);
    }

    /// A peer will take something back: if it waits, nothing is due for it.
    pub(super) fn before_taking_back(&mut self, said: Said, operator: Operator) {
        let case = |property: &Property| match &property.formula {
            Formula::Within { cause: Cause::Event(event), .. }
                if event.operator == operator && self.program.said(event) == Some(said) =>
            {
                vec![when(self.waits(event), "due = 0")]
            }
            _ => Vec::new(),
        };
        let cases = (1..).zip(self.properties().iter().map(case)).collect();
        self.of_the_checked(cases);
    }

    /// What an accepted event does to each property.
    fn on_event(&self, is_this: impl Fn(&ExternalTrigger) -> bool) -> Vec<(usize, Vec<Case>)> {
        let case = |property: &Property| match &property.formula {
            Formula::Within { unless, .. } if unless.iter().any(&is_this) => {
                vec![when("true", "due = 0")]
            }
            Formula::Within { steps, cause: Cause::Event(event), unless, .. } if is_this(event) => {
                vec![when(self.begin("true", unless), format!("due = {steps}"))]
            }
            Formula::OnlyAfter { event, .. } if is_this(event) => {
                vec![when("true", "allowed = true")]
            }
            _ => Vec::new(),
        };
        (1..).zip(self.properties().iter().map(case)).collect()
    }

    /// A step begins.
    pub(super) fn before_step(&mut self) {
        let cases = (1..).zip(self.properties().iter().map(|p| self.compared(p))).collect();
        self.of_the_checked(cases);
    }

    /// An answer is due while a comparison holds.
    fn compared(&self, property: &Property) -> Vec<Case> {
        let Formula::Within { steps, cause: Cause::Comparison(comparison), unless, .. } =
            &property.formula
        else {
            return Vec::new();
        };
        let Some(compared) = self.comparisons.holds(self.program, comparison) else {
            return Vec::new();
        };
        let beliefs = &self.program.beliefs;
        let held = |name: &Name| {
            let index = beliefs.iter().position(|belief| belief.name == name.text);
            index.map_or("false".to_owned(), |index| self.held(BeliefId(index)))
        };
        let holds: Vec<String> = comparison.beliefs().map(held).chain([compared]).collect();
        let holds = format!("({})", holds.join(" && "));
        let begin = when(self.begin(&holds, unless), format!("due = {steps}"));
        vec![begin, when(format!("!{holds}"), "due = 0")]
    }

    /// An answer is due from now on, unless one is due already, or an excusing event is pending.
    fn begin(&self, happened: &str, unless: &[ExternalTrigger]) -> String {
        let mut conditions = vec![happened.to_owned(), "due == 0".to_owned()];
        conditions.extend(unless.iter().map(|event| format!("!({})", self.waits(event))));
        conditions.join(" && ")
    }

    /// A step has ended.
    pub(super) fn after_step(&mut self) {
        if self.part.is_some() {
            // What it has done counts in the round.
            self.writer.line("lost = false;");
            return;
        }
        // The last one is of no property: it fails in each agent, or its steps do not end.
        let falsehood = std::iter::once(vec![when("true", "assert(false)")]);
        let judged = self.properties().iter().map(|p| self.judged(p));
        let cases = (1..).zip(judged.chain(falsehood)).collect();
        self.of_the_checked(cases);
        self.writer.line("main_calls = 0; cause_calls = 0; until_calls = 0; lost = false;");
    }

    fn judged(&self, property: &Property) -> Vec<Case> {
        match &property.formula {
            Formula::AllHandled => vec![when("true", "assert(!lost)")],
            Formula::Count { bound, .. } => {
                let bound = match bound {
                    CallBound::ExactlyOne => "== 1",
                    CallBound::AtMostOne => "<= 1",
                    CallBound::AtLeastOne => ">= 1",
                    CallBound::Never => "== 0",
                };
                vec![when("true", format!("assert(main_calls {bound})"))]
            }
            Formula::Within { steps, cause, unless, .. } => {
                let mut cases = vec![when(
                    "due > 0",
                    "due = (main_calls > 0 -> 0 : due - 1); assert(main_calls > 0 || due > 0)",
                )];
                if matches!(cause, Cause::Action(_)) {
                    let begin = self.begin("cause_calls > 0", unless);
                    cases.push(when(begin, format!("due = {steps}")));
                }
                cases
            }
            Formula::OnlyAfter { event, until, .. } => {
                let mut cases = vec![when("true", "assert(main_calls == 0 || allowed)")];
                if !until.is_empty() {
                    let ends = format!("until_calls > 0 && !({})", self.waits(event));
                    cases.push(when(ends, "allowed = false"));
                }
                cases
            }
        }
    }

    fn of_the_checked(&mut self, cases: Vec<(usize, Vec<Case>)>) {
        of_the_checked(&mut self.writer, cases);
    }
}

/// The cases of the property that is checked, in order.
pub(super) fn of_the_checked(writer: &mut Writer, cases: Vec<(usize, Vec<Case>)>) {
    let cases: Vec<_> = cases.into_iter().filter(|(_, cases)| !cases.is_empty()).collect();
    if cases.is_empty() {
        return;
    }
    writer.open_here("d_step");
    writer.line("if");
    for (number, cases) in cases {
        writer.line(format!(":: checked == {number} ->"));
        writer.indent();
        for Case { condition, then } in cases {
            writer.line("if");
            writer.line(format!(":: {condition} -> {then}"));
            writer.line(":: else");
            writer.line("fi;");
        }
        writer.dedent();
    }
    writer.line(":: else");
    writer.line("fi;");
    writer.close("};");
}

/// A guarded statement.
pub(super) struct Case {
    condition: String,
    then: String,
}

pub(super) fn when(condition: impl Into<String>, then: impl Into<String>) -> Case {
    Case { condition: condition.into(), then: then.into() }
}

/// The role of an action in a property.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    /// The subject of the property.
    Main,
    /// The cause that requires an answer.
    Cause,
    /// Ends a permission.
    Until,
}

impl Role {
    fn counter(self) -> &'static str {
        match self {
            Self::Main => "main_calls",
            Self::Cause => "cause_calls",
            Self::Until => "until_calls",
        }
    }
}
