//! Resolves plans: every variable bound before it is used, every type as declared.

use std::collections::{HashMap, HashSet};

use diagnostic::{Diagnostic, Severity};

use super::conditions::check_fresh;
use super::graph::TriggerGraph;
use super::scope::{Scope, said_already};
use super::time::Place;
use super::values::Resolved;
use super::{Analysis, TriggerKey};
use crate::code::Code;
use crate::program::{Handler, HandlerId, Pattern, Placed, Plan, Raise, Step, Value, VariableId};
use crate::syntax::ast::{
    self, Agent, Atom, Expression, Formula, Name, Operator, Performative, Trigger, TriggerKind,
};
use crate::types::CType;

/// Plans of a test goal are compiled once for each combination of queried arguments. Without a limit, plans
/// that query each other multiply; up to three arguments allow all combinations.
pub(super) const MOST_QUESTIONS: usize = 8;

impl Analysis<'_> {
    /// Resolves `plan` and adds it to its handler.
    pub(super) fn plan(&mut self, plan: &ast::Plan, graph: &TriggerGraph) {
        let trigger = &plan.trigger;
        let handler = self.handler_id(trigger.operator, trigger.kind, &trigger.atom.name.text);
        if let Some(handler) = handler {
            self.plan_of(handler, plan, &[], graph);
        }
    }

    /// Resolves the plans of test goals, once for each combination in use; a resolved plan may add further
    /// combinations.
    pub(super) fn test_plans(&mut self, agent: &Agent, graph: &TriggerGraph) {
        let mut plans: HashMap<TriggerKey, Vec<&ast::Plan>> = HashMap::new();
        for plan in agent.plans.iter().filter(|plan| plan.trigger.kind == TriggerKind::Test) {
            let trigger = &plan.trigger;
            let key = (trigger.operator, trigger.kind, trigger.atom.name.text.clone());
            plans.entry(key).or_default().push(plan);
        }
        self.asked_plans(&plans, graph);
        let asked: HashSet<String> =
            self.test_handlers.keys().map(|(_, _, name)| name.clone()).collect();
        let is_asked = |plan: &ast::Plan| asked.contains(&plan.trigger.atom.name.text);
        let tests = agent.plans.iter().filter(|plan| plan.trigger.kind == TriggerKind::Test);
        for plan in tests {
            let trigger = &plan.trigger;
            let name = &trigger.atom.name.text;
            let answered = (Operator::Add, TriggerKind::Test, name.clone());
            if trigger.operator == Operator::Delete && !self.test_triggers.contains(&answered) {
                self.error(
                    Code::MissingPlan
                        .at(
                            format!("`-?{name}` can never run: no plan for `+?{name}`"),
                            trigger.span.clone(),
                        )
                        .help("a failure plan runs when a plan of its test goal fails"),
                );
            }
            if !is_asked(plan) {
                let text = format!("`?{name}` is never asked");
                self.error(
                    Code::NeverAsked
                        .at(text, trigger.span.clone())
                        .help("its plans are left out; ask it in a body: `?b(X)`"),
                );
                self.unasked_plan(plan, graph);
            }
        }
        // Queries in these plans are resolved too.
        self.asked_plans(&plans, graph);
    }

    /// Resolves the plans of those handlers of test goals that have none yet.
    fn asked_plans(&mut self, plans: &HashMap<TriggerKey, Vec<&ast::Plan>>, graph: &TriggerGraph) {
        while let Some((id, key, holes)) = self.open_tests.pop_front() {
            for plan in plans.get(&key).into_iter().flatten() {
                self.asked_plan(id, plan, &holes, graph);
            }
        }
    }

    /// Resolves a plan of a test goal for one combination. If the plan is correct for another combination,
    /// the mistake is reported at the query.
    fn asked_plan(
        &mut self,
        id: HandlerId,
        plan: &ast::Plan,
        holes: &[bool],
        graph: &TriggerGraph,
    ) {
        let (findings, waiting) = (self.findings.agent.len(), self.open_tests.len());
        self.plan_of(id, plan, holes, graph);
        let found = &self.findings.agent[findings..];
        let Some(first) = found.iter().find(|found| found.severity == Severity::Error) else {
            return;
        };
        let first = format!("line {}: {first}", self.line(first.span.start));
        match self.fitting_mode(plan, graph) {
            Ok(fitting) => {
                let name = &plan.trigger.atom.name.text;
                let arguments = fitting.iter().map(|hole| if *hole { "New" } else { "value" });
                let arguments = arguments.collect::<Vec<_>>().join(", ");
                let message = format!("the plans of `?{name}` cannot answer this");
                let span = self.handlers[id.0].span.clone();
                let error = Code::Unanswerable.at(message, span).label(first).help(format!(
                    "ask `?{name}({arguments})`, a value where the plan needs one and a new variable where it gives one, or change the plan"
                ));
                self.findings.agent.truncate(findings);
                self.error(error);
            }
            // Wrong for every combination: the usual one gives the best message.
            Err(usual) if !self.modes(plan).iter().any(|mode| mode == holes) => {
                self.findings.agent.truncate(findings);
                self.findings.agent.extend(usual);
            }
            Err(_) => return,
        }
        // Queries in a wrongly queried plan would cause consequential errors.
        self.open_tests.truncate(waiting);
    }

    /// The most likely combination for which a plan is correct, or the errors for the most likely one.
    fn fitting_mode(
        &mut self,
        plan: &ast::Plan,
        graph: &TriggerGraph,
    ) -> Result<Vec<bool>, Vec<Diagnostic>> {
        let mut first = None;
        for holes in self.modes(plan) {
            let found = self.try_plan(plan, &holes, graph);
            if !found.iter().any(|found| found.severity == Severity::Error) {
                return Ok(holes);
            }
            first.get_or_insert(found);
        }
        Err(first.unwrap_or_default())
    }

    /// Combinations that may fit a plan, the most likely first.
    fn modes(&self, plan: &ast::Plan) -> [Vec<bool>; 3] {
        let types = self.declarations.predicate(&plan.trigger.atom).unwrap_or_default();
        let fresh = fresh_variables(&plan.trigger.atom);
        let mut assigned: HashSet<&str> = HashSet::new();
        if let Some(context) = &plan.context {
            context.for_each_assigned(&mut |name| {
                assigned.insert(name.text.as_str());
            });
        }
        for formula in &plan.body {
            if let Formula::Assign { variable, .. } = formula {
                assigned.insert(&variable.text);
            }
        }
        let mode = |is_hole: &dyn Fn(&str, &CType) -> bool| -> Vec<bool> {
            let pairs = fresh.iter().zip(&types);
            pairs.map(|(name, ctype)| name.is_some_and(|name| is_hole(name, ctype))).collect()
        };
        [
            mode(&|name, ctype| assigned.contains(name) || !ctype.has_equality()),
            mode(&|name, _| assigned.contains(name)),
            mode(&|_, _| true),
        ]
    }

    /// Checks a plan of an unused test goal with a combination that fits it.
    fn unasked_plan(&mut self, plan: &ast::Plan, graph: &TriggerGraph) {
        let Some(types) = self.predicate_types(&plan.trigger.atom) else { return };
        match self.fitting_mode(plan, graph) {
            Ok(holes) => {
                let trigger = &plan.trigger;
                let id = self.new_test_handler(trigger.operator, &trigger.atom, &types, &holes);
                self.plan_of(id, plan, &holes, graph);
            }
            Err(found) => self.findings.agent.extend(found),
        }
    }

    /// The findings in a plan of a test goal for one combination; all state is restored.
    fn try_plan(
        &mut self,
        plan: &ast::Plan,
        holes: &[bool],
        graph: &TriggerGraph,
    ) -> Vec<Diagnostic> {
        let Some(types) = self.predicate_types(&plan.trigger.atom) else { return Vec::new() };
        let (findings, handlers) = (self.findings.agent.len(), self.handlers.len());
        let (waiting, crowded) = (self.open_tests.len(), self.crowded.clone());
        let id = self.new_test_handler(plan.trigger.operator, &plan.trigger.atom, &types, holes);
        self.plan_of(id, plan, holes, graph);
        let found = self.findings.agent.split_off(findings);
        self.handlers.truncate(handlers);
        self.covered.retain(|id| id.0 < handlers);
        for asked in self.test_handlers.values_mut() {
            asked.retain(|_, id| id.0 < handlers);
        }
        self.test_handlers.retain(|_, asked| !asked.is_empty());
        self.open_tests.truncate(waiting);
        self.crowded = crowded;
        found
    }

    /// The handler of a test goal for a combination of queried arguments, if it has plans.
    fn test_handler(
        &mut self,
        operator: Operator,
        atom: &Atom,
        types: &[CType],
        holes: &[bool],
    ) -> Option<HandlerId> {
        let name = &atom.name.text;
        let key = (operator, TriggerKind::Test, name.clone());
        if let Some(id) = self.test_handlers.get(&key).and_then(|asked| asked.get(holes)) {
            return Some(*id);
        }
        if !self.test_triggers.contains(&key) {
            return None;
        }
        let id = self.new_test_handler(operator, atom, types, holes);
        self.test_handlers.entry(key.clone()).or_default().insert(holes.to_vec(), id);
        self.open_tests.push_back((id, key, holes.to_vec()));
        if operator == Operator::Add {
            let failure = self.test_handler(Operator::Delete, atom, types, holes);
            self.handlers[id.0].failure = failure;
        }
        Some(id)
    }

    fn new_test_handler(
        &mut self,
        operator: Operator,
        atom: &Atom,
        types: &[CType],
        holes: &[bool],
    ) -> HandlerId {
        let id = HandlerId(self.handlers.len());
        self.handlers.push(Handler {
            operator,
            kind: TriggerKind::Test,
            name: atom.name.text.clone(),
            types: types.to_vec(),
            plans: Vec::new(),
            failure: None,
            span: atom.span.clone(),
            holes: holes.to_vec(),
            resumed: false,
            sourced: false,
        });
        id
    }

    fn plan_of(
        &mut self,
        handler: HandlerId,
        plan: &ast::Plan,
        holes: &[bool],
        graph: &TriggerGraph,
    ) {
        let trigger = &plan.trigger;
        // The arity may be wrong in a later plan of a declared trigger.
        let Some(types) = self.predicate_types(&trigger.atom) else { return };
        let mut scope = Scope::default();
        self.searched = 0;
        let (mut patterns, answers) = self.trigger_patterns(trigger, &types, holes, &mut scope);
        patterns.extend(self.source_pattern(&trigger.atom, trigger.kind, &mut scope));
        let mut context = Vec::new();
        if let Some(expression) = &plan.context {
            let resolved = self.conditions(expression, &mut scope, &mut context);
            if resolved.is_err() {
                scope.break_unbound(expression);
            }
            self.report(resolved);
        }
        let arguments = if plan.body.iter().any(|f| matches!(f, Formula::Wait { .. })) {
            self.kept_arguments(handler, trigger, &mut patterns, &mut context, &mut scope)
        } else {
            Vec::new()
        };
        let place = Place { handler, plan, graph, arguments };
        let body = self.body(&place, &plan.body, &mut scope);
        let outputs = self.outputs(&answers, &types, &mut scope);
        scope.settle();
        for (name, span) in scope.unused() {
            let warning = Code::UnusedVariable
                .at(format!("variable `{name}` is never used"), span.clone())
                .help("write `_` if any value will do");
            self.findings.agent.push(warning);
        }
        if self.covered.contains(&handler) {
            let warning = Code::NeverTried
                .at("this plan is never tried", trigger.span.clone())
                .help("an earlier plan of the same trigger fits every event");
            self.findings.agent.push(warning);
        }
        let lines = (self.line(plan.span.start), self.line(plan.span.end));
        let resolved = Plan {
            lines,
            source: self.text[plan.span.clone()].to_owned(),
            variables: scope.variables,
            patterns,
            context,
            body,
            outputs,
            label: plan.label.as_ref().map(|label| label.text.clone()),
            requirements: plan.requirements.clone(),
        };
        if resolved.always_applies() {
            self.covered.insert(handler);
        }
        self.handlers[handler.0].plans.push(resolved);
    }

    /// The patterns of the trigger's arguments, and the names that return queried arguments.
    fn trigger_patterns<'a>(
        &mut self,
        trigger: &'a Trigger,
        types: &[CType],
        holes: &[bool],
        scope: &mut Scope,
    ) -> (Vec<Pattern>, Vec<(usize, &'a Name)>) {
        let mut patterns = Vec::new();
        let mut answers: Vec<(usize, &Name)> = Vec::new();
        for (index, (expression, ctype)) in trigger.atom.arguments.iter().zip(types).enumerate() {
            if holes.get(index).copied().unwrap_or(false) {
                match expression {
                    Expression::Variable(name)
                        if scope.lookup(&name.text).is_none()
                            && answers.iter().all(|(_, other)| other.text != name.text) =>
                    {
                        answers.push((index, name));
                        scope.asked.push((name.text.clone(), ctype.clone()));
                    }
                    _ => self.error(
                        Code::AskedArgument
                            .at("this argument is asked for", expression.span())
                            .help("write a new variable, which the plan gives its value"),
                    ),
                }
                patterns.push(Pattern::Any);
            } else {
                let pattern = self.pattern(expression, ctype, scope);
                patterns.extend(self.report(pattern));
            }
        }
        (patterns, answers)
    }

    /// The variables that return queried arguments, each of which must have a value by now.
    fn outputs(
        &mut self,
        answers: &[(usize, &Name)],
        types: &[CType],
        scope: &mut Scope,
    ) -> Vec<(usize, VariableId)> {
        let mut outputs = Vec::new();
        for (index, name) in answers {
            let value = Expression::Variable((*name).clone());
            match self.value(&value, &types[*index], scope) {
                Ok(Value::Variable(id)) => outputs.push((*index, id)),
                Ok(_) => {}
                Err(_) if scope.is_broken(&value) => {}
                Err(_) => self.error(
                    Code::NeverAnswered
                        .at(
                            format!("`{}` is asked for and never gets a value", name.text),
                            name.span.clone(),
                        )
                        .help("bind it in the context, by `?b(X)` or by `X = value`"),
                ),
            }
        }
        outputs
    }

    /// Resolves the formulas of a body up to the first wait, which takes the rest along.
    pub(super) fn body(
        &mut self,
        place: &Place<'_>,
        formulae: &[Formula],
        scope: &mut Scope,
    ) -> Vec<Placed> {
        let mut body = Vec::new();
        for (index, formula) in formulae.iter().enumerate() {
            let rest = &formulae[index + 1..];
            let span = formula.span();
            let line = self.line(span.start);
            if let Formula::Wait { duration, span } = formula {
                let step = self.wait(place, duration, span, rest, scope);
                let span = span.clone();
                body.extend(self.report(step).map(|step| Placed { line, span, step }));
                break;
            }
            let step = self.step(formula, rest.is_empty(), place.graph, scope);
            body.extend(self.report(step).map(|step| Placed { line, span, step }));
        }
        body
    }

    pub(super) fn report<T>(&mut self, resolved: Resolved<T>) -> Option<T> {
        // Without what is only warned of, something would be translated that nobody wrote.
        let is_error = |found: &Diagnostic| found.severity == Severity::Error;
        debug_assert!(resolved.as_ref().err().is_none_or(is_error), "a warning leaves nothing out");
        resolved.map_err(|diagnostic| self.error(diagnostic)).ok()
    }

    fn step(
        &mut self,
        formula: &Formula,
        last: bool,
        graph: &TriggerGraph,
        scope: &mut Scope,
    ) -> Resolved<Step> {
        match formula {
            Formula::Action(atom) => Ok(Step::Action(self.call(atom, scope)?)),
            Formula::Assign { variable, value } => {
                let mut asked = scope.asked.iter().filter(|(name, _)| *name == variable.text);
                let expected = asked.next().map(|(_, ctype)| ctype.clone());
                check_fresh(variable, scope)?;
                let resolved = self.typed_value(value, expected, scope);
                if resolved.is_err() {
                    scope.break_variable(variable);
                }
                let (value, ctype) = resolved?;
                Ok(Step::Assign { variable: scope.bind(variable, &ctype), value })
            }
            Formula::Add(atom) => {
                let types = self.declarations.predicate(atom)?;
                let values = self.values(&atom.arguments, &types, scope)?;
                let belief = self.belief_id(&atom.name.text, &types);
                let raise = self.raise(Operator::Add, atom, last, graph)?;
                Ok(Step::Add { belief, values, raise })
            }
            Formula::Delete(atom) => {
                let types = self.declarations.predicate(atom)?;
                let belief = self.belief_id(&atom.name.text, &types);
                for expression in &atom.arguments {
                    if let Expression::Variable(name) = expression {
                        scope.bound(name)?;
                    }
                }
                let patterns = self.patterns(atom, &types, scope)?;
                let raise = self.raise(Operator::Delete, atom, last, graph)?;
                Ok(Step::Delete { belief, patterns, raise })
            }
            Formula::Achieve { goal, deadline } => {
                let (handler, values) = self.goal(goal, scope)?;
                if graph.is_recursive(Operator::Add, TriggerKind::Achieve, &goal.name.text) {
                    check_last(goal, last)?;
                    let due = deadline.as_ref().map(|ms| self.due(ms, &ms.span(), scope));
                    Ok(Step::Post { handler, values, deadline: due.transpose()? })
                } else if let Some(deadline) = deadline {
                    let message = format!("`!{}` never takes more than a step", goal.name.text);
                    Err(Code::IdleDeadline
                        .at(message, deadline.span())
                        .label("a deadline that is always met")
                        .help("deadlines are for goals that wait or post themselves again"))
                } else {
                    Ok(Step::Achieve { handler, values })
                }
            }
            Formula::Defer(atom) => {
                let (handler, values) = self.goal(atom, scope)?;
                Ok(Step::Defer { handler, values })
            }
            Formula::Test(atom) => self.ask(atom, graph, scope),
            Formula::MyName { variable, span } => {
                self.check_peers(span)?;
                if scope.lookup(&variable.text).is_some() {
                    let message = format!("`{}` already has a value", variable.text);
                    return Err(Code::BoundTwice
                        .at(message, variable.span.clone())
                        .help("in a context, `.my_name(P)` also compares"));
                }
                Ok(Step::Assign {
                    variable: scope.bind(variable, &CType::peer()),
                    value: Value::Me,
                })
            }
            Formula::Send { to, performative, content, .. } => {
                self.send(to.as_ref(), *performative, content, scope)
            }
            Formula::Wait { span, .. } => {
                unreachable!("`body` takes what waits, at {span:?}")
            }
        }
    }

    fn ask(&mut self, atom: &Atom, graph: &TriggerGraph, scope: &mut Scope) -> Resolved<Step> {
        let types = self.declarations.predicate(atom)?;
        if self.configuration.message(Performative::Tell, &atom.name.text).is_some() {
            return Err(Code::Unanswerable
                .at("what peers tell is not asked in a body", atom.span.clone())
                .help("ask for it in a context, where the rest decides who told it"));
        }
        let belief = self.belief_id(&atom.name.text, &types);
        check_asked_once(atom, scope)?;
        let patterns = self.question(atom, &types, scope)?;
        let holes: Vec<bool> =
            patterns.iter().map(|pattern| !matches!(pattern, Pattern::Equal(_))).collect();
        self.check_questions(atom, &holes)?;
        let plans = self.test_handler(Operator::Add, atom, &types, &holes);
        if plans.is_some() {
            if graph.is_recursive(Operator::Add, TriggerKind::Test, &atom.name.text) {
                return Err(Code::Recursion
                    .at(format!("`?{}` is recursive", atom.name.text), atom.span.clone())
                    .label("this call would be recursive")
                    .help("the answer is needed at once, so it cannot wait for the next step"));
            }
            let unknown = types.iter().zip(&holes).find(|(t, hole)| **hole && t.zero().is_none());
            if let Some((ctype, _)) = unknown {
                return Err(Code::UnaskableType
                    .at(
                        format!("values of type `{}` cannot be asked for", ctype.name),
                        atom.span.clone(),
                    )
                    .help("the translator knows no value of this type to start with"));
            }
        }
        Ok(Step::Ask { belief, patterns, plans })
    }

    /// Limits the combinations of a test goal; reported once per goal.
    fn check_questions(&mut self, atom: &Atom, holes: &[bool]) -> Resolved<()> {
        let name = &atom.name.text;
        let key = (Operator::Add, TriggerKind::Test, name.clone());
        let asked = self.test_handlers.get(&key);
        let known = asked.is_some_and(|asked| asked.contains_key(holes));
        let ways = asked.map_or(0, HashMap::len);
        if known || ways < MOST_QUESTIONS || !self.test_triggers.contains(&key) {
            return Ok(());
        }
        if !self.crowded.insert(name.clone()) {
            return Err(said_already());
        }
        Err(Code::Limit.at(
            format!("`?{name}` is asked with more than {MOST_QUESTIONS} combinations of arguments"),
            atom.span.clone(),
        )
        .label("a new combination of given and asked arguments")
        .help("its plans are translated once per combination: use one of the others, and compare the answers"))
    }

    /// Given arguments are evaluated before any answer is known.
    fn question(&self, atom: &Atom, types: &[CType], scope: &mut Scope) -> Resolved<Vec<Pattern>> {
        let pairs = || atom.arguments.iter().zip(types);
        let asked = |expression: &Expression, scope: &Scope| match expression {
            Expression::Variable(name) => scope.lookup(&name.text).is_none(),
            _ => false,
        };
        let mut given = Vec::new();
        for (expression, ctype) in pairs() {
            let asked = asked(expression, scope);
            given.push(if asked { None } else { Some(self.pattern(expression, ctype, scope)?) });
        }
        pairs()
            .zip(given)
            .map(|((expression, ctype), given)| match given {
                Some(pattern) => Ok(pattern),
                None => self.pattern(expression, ctype, scope),
            })
            .collect()
    }

    fn goal(&mut self, atom: &Atom, scope: &mut Scope) -> Resolved<(HandlerId, Vec<Value>)> {
        let types = self.declarations.predicate(atom)?;
        let mut values = self.values(&atom.arguments, &types, scope)?;
        let name = &atom.name.text;
        let handler =
            self.handler_id(Operator::Add, TriggerKind::Achieve, name).ok_or_else(|| {
                Code::MissingPlan
                    .at(format!("no plan for `+!{name}`"), atom.span.clone())
                    .label("this goal could never be achieved")
                    .help(format!("add a plan `+!{name} : context <- body.`"))
            })?;
        values.extend(self.handlers[handler.0].sourced.then_some(Value::Me));
        Ok((handler, values))
    }

    fn raise(
        &mut self,
        operator: Operator,
        atom: &Atom,
        last: bool,
        graph: &TriggerGraph,
    ) -> Resolved<Raise> {
        let name = &atom.name.text;
        let Some(handler) = self.handler_id(operator, TriggerKind::Belief, name) else {
            return Ok(Raise::Nothing);
        };
        if graph.is_recursive(operator, TriggerKind::Belief, name) {
            check_last(atom, last)?;
            Ok(Raise::Post(handler))
        } else {
            Ok(Raise::Call(handler))
        }
    }
}

/// The arguments that are variables on their first occurrence in the trigger.
fn fresh_variables(atom: &Atom) -> Vec<Option<&str>> {
    let mut known: HashSet<&str> = HashSet::new();
    let arguments = atom.arguments.iter();
    arguments
        .map(|argument| match argument {
            Expression::Variable(name) if known.insert(&name.text) => Some(name.text.as_str()),
            _ => None,
        })
        .collect()
}

/// A variable may be queried only once.
fn check_asked_once(atom: &Atom, scope: &Scope) -> Resolved<()> {
    let mut asked: Vec<&str> = Vec::new();
    for expression in &atom.arguments {
        if let Expression::Variable(name) = expression
            && scope.lookup(&name.text).is_none()
        {
            if asked.contains(&name.text.as_str()) {
                return Err(Code::AskedArgument
                    .at(format!("`{}` is asked for twice", name.text), name.span.clone())
                    .help("ask for two variables and compare them in the context of a plan"));
            }
            asked.push(&name.text);
        }
    }
    Ok(())
}

fn check_last(atom: &Atom, last: bool) -> Resolved<()> {
    if last {
        return Ok(());
    }
    Err(Code::Recursion
        .at(
            format!("`{}` is recursive and not the last formula", atom.name.text),
            atom.span.clone(),
        )
        .label("this call would be recursive")
        .help("move it to the end of the body: there it becomes the event of the next step"))
}
