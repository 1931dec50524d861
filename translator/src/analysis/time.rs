//! Time: `.wait(ms)` and deadlines of goals.
//!
//! Neither blocks. A plan that waits ends there, and its rest becomes the event of the next step, with two
//! plans: one posts the event again while it is too early, the other goes on. Both use only existing features
//! of the language.

use std::collections::HashSet;

use diagnostic::{Diagnostic, Span};

use super::Analysis;
use super::graph::TriggerGraph;
use super::scope::Scope;
use super::values::Resolved;
use crate::code::Code;
use crate::configuration::Configuration;
use crate::program::{
    BasicId, Call, Condition, Handler, HandlerId, Operation, Pattern, Placed, Plan, Step, Value,
};
use crate::syntax::ast::{
    self, Arithmetic, Expression, Formula, Name, Relation, Trigger, TriggerKind,
};
use crate::types::CType;

/// The function that returns the time in milliseconds.
#[derive(Debug, Clone)]
pub(super) struct Clock {
    function: BasicId,
    ctype: CType,
}

impl Clock {
    pub(super) fn function(&self) -> BasicId {
        self.function
    }

    /// The type of its times.
    pub(super) fn ctype(&self) -> &CType {
        &self.ctype
    }

    pub(super) fn into_parts(self) -> (BasicId, CType) {
        (self.function, self.ctype)
    }
}

/// The plan whose body is being resolved.
pub(super) struct Place<'a> {
    pub(super) handler: HandlerId,
    pub(super) plan: &'a ast::Plan,
    pub(super) graph: &'a TriggerGraph,
    /// The arguments of the trigger, if a failure plan may need them after a wait.
    pub(super) arguments: Vec<Value>,
}

/// A value that is carried across a wait.
struct Carried {
    value: Value,
    ctype: CType,
    /// The variable's name afterwards.
    name: Option<Name>,
}

/// The clock named in the settings.
pub(super) fn find_clock(
    configuration: &Configuration,
    findings: &mut Vec<Diagnostic>,
) -> Option<Clock> {
    let name = configuration.settings.clock.as_ref()?;
    let mut basics = configuration.basics.iter().enumerate();
    let help = "declare `uint64_t now(void);` in `basics` and write `clock = now;`: \
                milliseconds that never run backwards";
    let Some((index, basic)) = basics.find(|(_, basic)| basic.name.text == name.text) else {
        let message = format!("the clock `{}` is not declared", name.text);
        findings.push(Code::NotDeclared.at(message, name.span.clone()).help(help));
        return None;
    };
    let wide = basic.result.integer_bits().is_some_and(|(bits, _)| bits >= 32);
    if !basic.parameters.is_empty() || !(wide || basic.result.is_float()) {
        let message = format!("`{}` cannot be a clock", name.text);
        findings.push(Code::NotAClock.at(message, name.span.clone()).help(help));
        return None;
    }
    Some(Clock { function: BasicId(index), ctype: basic.result.clone() })
}

impl Analysis<'_> {
    /// The time at which `duration` will have passed.
    pub(super) fn due(
        &self,
        duration: &Expression,
        span: &Span,
        scope: &mut Scope,
    ) -> Resolved<Value> {
        let Some(clock) = &self.clock else {
            return Err(Code::NoClock.at("the agent has no clock", span.clone()).help(
                "declare `uint64_t now(void);` in `basics` and write `clock = now;` in `settings`",
            ));
        };
        let duration = self.value(duration, &clock.ctype, scope)?;
        Ok(Value::Arithmetic(Box::new(Operation {
            operator: Arithmetic::Add,
            left: Value::Call(Call { basic: clock.function, arguments: Vec::new() }),
            right: duration,
            ctype: clock.ctype.clone(),
        })))
    }

    /// `.wait(ms)` in front of `rest`.
    pub(super) fn wait(
        &mut self,
        place: &Place<'_>,
        duration: &Expression,
        span: &Span,
        rest: &[Formula],
        scope: &mut Scope,
    ) -> Resolved<Step> {
        let carried = self.carried(place, rest, scope);
        let due = self.due(duration, span, scope);
        // The rest is checked in any case: all errors of a file are reported in one run.
        let ctype = self.clock.as_ref().map_or(CType::named("double"), |clock| clock.ctype.clone());
        let handler = self.resumed(place, &carried, &ctype, span, rest);
        let due = due?;
        if place.plan.trigger.kind == TriggerKind::Test {
            return Err(Code::WaitInTestGoal
                .at("a test goal is answered at once", span.clone())
                .help("wait in the plan with the test goal"));
        }
        let values = carried.into_iter().map(|carried| carried.value).chain([due]).collect();
        Ok(Step::Post { handler, values, deadline: None })
    }

    /// The values that the rest of the plan, or its failure plans, will need.
    fn carried(&self, place: &Place<'_>, rest: &[Formula], scope: &mut Scope) -> Vec<Carried> {
        let mut names: HashSet<&str> = HashSet::new();
        for formula in rest {
            formula.for_each_variable(&mut |name| {
                names.insert(name.text.as_str());
            });
        }
        let mut wanted: Vec<(Name, crate::program::VariableId)> =
            scope.visible().filter(|(name, _)| names.contains(name.text.as_str())).collect();
        let types = &self.handlers[place.handler.0].types;
        let mut carried = Vec::new();
        for (value, ctype) in place.arguments.iter().zip(types) {
            let name = wanted
                .iter()
                .position(|(_, id)| *value == Value::Variable(*id))
                .map(|index| wanted.remove(index).0);
            carried.push(Carried { value: value.clone(), ctype: ctype.clone(), name });
        }
        carried.extend(wanted.into_iter().map(|(name, id)| Carried {
            value: Value::Variable(id),
            ctype: scope.variables[id.0].ctype.clone(),
            name: Some(name),
        }));
        for carried in &carried {
            if let Value::Variable(id) = carried.value {
                scope.variables[id.0].used = true;
            }
        }
        carried
    }

    /// The event that represents the rest of a plan; its last argument is the time.
    fn resumed(
        &mut self,
        place: &Place<'_>,
        carried: &[Carried],
        time: &CType,
        span: &Span,
        rest: &[Formula],
    ) -> HandlerId {
        let original = &self.handlers[place.handler.0];
        let goal = &place.plan.trigger.atom.name.text;
        let waits = self.waits.entry(goal.clone()).or_default();
        let mut name = String::new();
        while name.is_empty() || self.declarations.is_predicate(&name) {
            *waits += 1;
            name = format!("{goal}_wait{waits}");
        }
        let mut types: Vec<CType> = carried.iter().map(|carried| carried.ctype.clone()).collect();
        types.push(time.clone());
        let id = HandlerId(self.handlers.len());
        let handler = Handler {
            name,
            types: types.clone(),
            plans: Vec::new(),
            resumed: true,
            sourced: false,
            span: span.clone(),
            holes: Vec::new(),
            ..*original
        };
        self.handlers.push(handler);
        let waiting = self.waiting_plan(place, id, &types, span);
        let going_on = self.plan_after_wait(place, id, carried, span, rest);
        self.handlers[id.0].plans = vec![waiting, going_on];
        id
    }

    /// The plan that posts the event again while it is too early.
    fn waiting_plan(
        &self,
        place: &Place<'_>,
        handler: HandlerId,
        types: &[CType],
        span: &Span,
    ) -> Plan {
        let mut scope = Scope::default();
        let ids: Vec<_> = types.iter().map(|ctype| scope.bind_unnamed(ctype)).collect();
        for variable in &mut scope.variables {
            variable.used = true;
        }
        let values: Vec<Value> = ids.iter().map(|id| Value::Variable(*id)).collect();
        let too_early = self.clock.iter().zip(values.last()).map(|(clock, due)| {
            let now = Call { basic: clock.function, arguments: Vec::new() };
            Condition::Compare {
                relation: Relation::Less,
                left: Value::Call(now),
                right: due.clone(),
                ctype: clock.ctype.clone(),
            }
        });
        let too_early = too_early.collect();
        let step = Step::Post { handler, values, deadline: None };
        Plan {
            lines: (self.line(span.start), self.line(span.end)),
            source: self.text[span.clone()].to_owned(),
            patterns: ids.into_iter().map(Pattern::Bind).collect(),
            context: too_early,
            body: vec![Placed { line: self.line(span.start), span: span.clone(), step }],
            variables: scope.variables,
            outputs: Vec::new(),
            label: place.plan.label.as_ref().map(|label| label.text.clone()),
            requirements: place.plan.requirements.clone(),
        }
    }

    /// The plan with the rest behind the wait.
    fn plan_after_wait(
        &mut self,
        place: &Place<'_>,
        handler: HandlerId,
        carried: &[Carried],
        span: &Span,
        rest: &[Formula],
    ) -> Plan {
        let mut scope = Scope::default();
        let ids: Vec<_> = carried
            .iter()
            .map(|carried| match &carried.name {
                Some(name) => scope.bind(name, &carried.ctype),
                None => scope.bind_unnamed(&carried.ctype),
            })
            .collect();
        let arguments =
            ids.iter().take(place.arguments.len()).map(|id| Value::Variable(*id)).collect();
        let patterns = ids.into_iter().map(Pattern::Bind).chain([Pattern::Any]).collect();
        let place = Place { handler, plan: place.plan, graph: place.graph, arguments };
        let body = self.body(&place, rest, &mut scope);
        scope.settle();
        let end = place.plan.span.end;
        Plan {
            lines: (self.line(span.start), self.line(end)),
            source: self.text[span.start..end].to_owned(),
            variables: scope.variables,
            patterns,
            context: Vec::new(),
            body,
            outputs: Vec::new(),
            label: place.plan.label.as_ref().map(|label| label.text.clone()),
            requirements: place.plan.requirements.clone(),
        }
    }

    /// The arguments of a trigger as values, for a plan that waits and has failure plans.
    pub(super) fn kept_arguments(
        &self,
        handler: HandlerId,
        trigger: &Trigger,
        patterns: &mut [Pattern],
        context: &mut Vec<Condition>,
        scope: &mut Scope,
    ) -> Vec<Value> {
        let types = &self.handlers[handler.0].types;
        if self.handlers[handler.0].failure.is_none() || trigger.kind != TriggerKind::Achieve {
            return Vec::new();
        }
        let mut arguments = Vec::new();
        let mut equal = Vec::new();
        for (pattern, ctype) in patterns.iter_mut().zip(types) {
            if let Pattern::Equal(value @ (Value::Variable(_) | Value::Constant(..))) = pattern {
                arguments.push(value.clone());
                continue;
            }
            let id = match pattern {
                Pattern::Bind(id) => *id,
                Pattern::Any | Pattern::Equal(_) => scope.bind_unnamed(ctype),
            };
            let variable = Value::Variable(id);
            arguments.push(variable.clone());
            if let Pattern::Equal(value) = std::mem::replace(pattern, Pattern::Bind(id)) {
                // The function of a pattern is called once; the incoming value is its result.
                equal.push(Condition::Compare {
                    relation: Relation::Equal,
                    left: variable,
                    right: value,
                    ctype: ctype.clone(),
                });
                scope.variables[id.0].used = true;
            }
        }
        context.splice(0..0, equal);
        arguments
    }
}
