//! Resolves one plan: every variable bound before it is used, every type as declared.

use diagnostic::{Diagnostic, Span};

use super::constants::constant;
use super::declarations::check_value_result;
use super::graph::TriggerGraph;
use super::{Analysis, is_unnamed};
use crate::program::{
    BeliefId, Call, Condition, HandlerId, Pattern, Plan, Raise, Step, Value, Variable, VariableId,
};
use crate::syntax::ast::{self, Atom, Formula, Literal, Name, Operator, Term, TriggerKind};
use crate::types::{CType, TypeKind};

/// The variables of the plan that is being resolved.
#[derive(Default)]
struct Scope {
    variables: Vec<Variable>,
    /// Where each variable is bound.
    bound_at: Vec<Span>,
    /// Variables that occurred only inside a negation: unbound after it.
    negation_only: Vec<String>,
}

impl Scope {
    fn lookup(&self, name: &str) -> Option<VariableId> {
        self.variables.iter().position(|variable| variable.name == name).map(VariableId)
    }

    fn bind(&mut self, name: &Name, ctype: &CType) -> VariableId {
        self.variables.push(Variable {
            name: name.text.clone(),
            ctype: ctype.clone(),
            used: false,
        });
        self.bound_at.push(name.span.clone());
        VariableId(self.variables.len() - 1)
    }

    /// The variable `name`, which must have a value.
    fn bound(&self, name: &Name) -> Resolved<VariableId> {
        self.lookup(&name.text).ok_or_else(|| {
            let error =
                Diagnostic::error(format!("`{}` has no value here", name.text), name.span.clone());
            if self.negation_only.contains(&name.text) {
                error.help("it occurs only inside `not`, which binds nothing")
            } else {
                error.help("bind it in the trigger, in the context, by `?b(X)` or by `X = f(..)`")
            }
        })
    }
}

/// Variables local to one negation, each standing for an argument of the belief.
type Locals = Vec<(String, BeliefId, usize)>;

type Resolved<T> = Result<T, Diagnostic>;

impl Analysis<'_> {
    /// Resolves `plan` and adds it to its handler.
    pub(super) fn plan(&mut self, plan: &ast::Plan, graph: &TriggerGraph) {
        let trigger = &plan.trigger;
        let Some(handler) =
            self.handler_id(trigger.operator, trigger.kind, &trigger.atom.name.text)
        else {
            return;
        };
        // The arity may be wrong in a later plan of a declared trigger.
        let Some(types) = self.predicate_types(&trigger.atom) else { return };
        let mut scope = Scope::default();
        let mut patterns = Vec::new();
        for (term, ctype) in trigger.atom.arguments.iter().zip(&types) {
            let pattern = self.pattern(term, ctype, &mut scope);
            patterns.extend(self.report(pattern));
        }
        let mut context = Vec::new();
        for literal in &plan.context {
            let condition = self.condition(literal, &mut scope);
            context.extend(self.report(condition));
        }
        let mut body = Vec::new();
        for (index, formula) in plan.body.iter().enumerate() {
            let last = index + 1 == plan.body.len();
            let step = self.step(formula, last, graph, &mut scope);
            body.extend(self.report(step));
        }
        self.warn_unused(&scope);
        let line = self.line(plan.span.start);
        self.handlers[handler.0].plans.push(Plan {
            line,
            source: self.text[plan.span.clone()].to_owned(),
            variables: scope.variables,
            patterns,
            context,
            body,
        });
    }

    fn report<T>(&mut self, resolved: Resolved<T>) -> Option<T> {
        resolved.map_err(|diagnostic| self.error(diagnostic)).ok()
    }

    fn warn_unused(&mut self, scope: &Scope) {
        for (variable, span) in scope.variables.iter().zip(&scope.bound_at) {
            if !variable.used {
                self.error(
                    Diagnostic::warning(
                        format!("variable `{}` is never used", variable.name),
                        span.clone(),
                    )
                    .help("write `_` if any value will do"),
                );
            }
        }
    }

    fn condition(&mut self, literal: &Literal, scope: &mut Scope) -> Resolved<Condition> {
        let atom = &literal.atom;
        if self.declarations.is_basic(&atom.name.text) {
            let call = self.call(atom, scope)?;
            let (_, basic) = self.declarations.basic(atom)?;
            if basic.result.kind != TypeKind::Bool {
                return Err(Diagnostic::error(
                    format!("`{}` does not return `bool`", atom.name.text),
                    atom.span.clone(),
                )
                .label(format!("declared `{}`", basic.result.name))
                .help("a context is made of beliefs and functions of type bool"));
            }
            return Ok(Condition::Test { call, negated: literal.negated });
        }
        let types = self.declarations.predicate(atom)?;
        let belief = self.belief_id(&atom.name.text, &types);
        if literal.negated {
            let patterns = self.negated_patterns(atom, belief, &types, scope)?;
            Ok(Condition::HoldsNot { belief, patterns })
        } else {
            let patterns = self.patterns(atom, &types, scope)?;
            Ok(Condition::Holds { belief, patterns })
        }
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
            Formula::Assign { variable, call: atom } => {
                let call = self.call(atom, scope)?;
                let (_, basic) = self.declarations.basic(atom)?;
                check_value_result(basic, atom)?;
                let result = basic.result.clone();
                if scope.lookup(&variable.text).is_some() {
                    return Err(Diagnostic::error(
                        format!("`{}` already has a value", variable.text),
                        variable.span.clone(),
                    )
                    .help("`=` binds a new variable; choose another name"));
                }
                Ok(Step::Assign { variable: scope.bind(variable, &result), call })
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
                for term in &atom.arguments {
                    if let Term::Variable(name) = term {
                        scope.bound(name)?;
                    }
                }
                let patterns = self.patterns(atom, &types, scope)?;
                let raise = self.raise(Operator::Delete, atom, last, graph)?;
                Ok(Step::Delete { belief, patterns, raise })
            }
            Formula::Achieve(atom) => {
                let (handler, values) = self.goal(atom, scope)?;
                if graph.is_recursive(handler) {
                    check_last(atom, last)?;
                    Ok(Step::Post { handler, values })
                } else {
                    Ok(Step::Achieve { handler, values })
                }
            }
            Formula::Defer(atom) => {
                let (handler, values) = self.goal(atom, scope)?;
                Ok(Step::Defer { handler, values })
            }
            Formula::Test(atom) => {
                let types = self.declarations.predicate(atom)?;
                let belief = self.belief_id(&atom.name.text, &types);
                let patterns = self.patterns(atom, &types, scope)?;
                Ok(Step::Ask { belief, patterns })
            }
        }
    }

    fn goal(&mut self, atom: &Atom, scope: &mut Scope) -> Resolved<(HandlerId, Vec<Value>)> {
        let types = self.declarations.predicate(atom)?;
        let values = self.values(&atom.arguments, &types, scope)?;
        let name = &atom.name.text;
        let handler =
            self.handler_id(Operator::Add, TriggerKind::Achieve, name).ok_or_else(|| {
                Diagnostic::error(format!("no plan for `+!{name}`"), atom.span.clone())
                    .label("this goal could never be achieved")
                    .help(format!("add a plan `+!{name} : context <- body.`"))
            })?;
        Ok((handler, values))
    }

    fn raise(
        &mut self,
        operator: Operator,
        atom: &Atom,
        last: bool,
        graph: &TriggerGraph,
    ) -> Resolved<Raise> {
        let Some(handler) = self.handler_id(operator, TriggerKind::Belief, &atom.name.text) else {
            return Ok(Raise::Nothing);
        };
        if graph.is_recursive(handler) {
            check_last(atom, last)?;
            Ok(Raise::Post(handler))
        } else {
            Ok(Raise::Call(handler))
        }
    }

    fn call(&self, atom: &Atom, scope: &mut Scope) -> Resolved<Call> {
        let (basic, declaration) = self.declarations.basic(atom)?;
        let arguments = self.values(&atom.arguments, &declaration.parameters, scope)?;
        Ok(Call { basic, arguments })
    }

    fn values(&self, terms: &[Term], types: &[CType], scope: &mut Scope) -> Resolved<Vec<Value>> {
        terms.iter().zip(types).map(|(term, ctype)| self.value(term, ctype, scope)).collect()
    }

    /// A term whose value is needed.
    fn value(&self, term: &Term, ctype: &CType, scope: &mut Scope) -> Resolved<Value> {
        if let Some(constant) = constant(term, ctype) {
            return constant;
        }
        match term {
            Term::Variable(name) => {
                let id = scope.bound(name)?;
                scope.variables[id.0].used = true;
                check_type(&scope.variables[id.0].ctype, ctype, &name.text, &name.span)?;
                Ok(Value::Variable(id))
            }
            Term::Call(atom) => {
                let call = self.call(atom, scope)?;
                let (_, basic) = self.declarations.basic(atom)?;
                check_value_result(basic, atom)?;
                check_type(&basic.result, ctype, &atom.name.text, &atom.span)?;
                Ok(Value::Call(call))
            }
            _ => Err(Diagnostic::error("an unnamed variable has no value", term.span())
                .help("`_` matches anything; name the variable and bind it first")),
        }
    }

    fn patterns(&self, atom: &Atom, types: &[CType], scope: &mut Scope) -> Resolved<Vec<Pattern>> {
        atom.arguments
            .iter()
            .zip(types)
            .map(|(term, ctype)| self.pattern(term, ctype, scope))
            .collect()
    }

    /// A term that is matched against a value.
    fn pattern(&self, term: &Term, ctype: &CType, scope: &mut Scope) -> Resolved<Pattern> {
        match term {
            _ if is_unnamed(term) => Ok(Pattern::Any),
            Term::Variable(name) if scope.lookup(&name.text).is_none() => {
                Ok(Pattern::Bind(scope.bind(name, ctype)))
            }
            _ => {
                let value = self.value(term, ctype, scope)?;
                check_equality(ctype, &term.span())?;
                Ok(Pattern::Equal(value))
            }
        }
    }

    /// As [`Self::patterns`], but what the negation binds is forgotten after it.
    fn negated_patterns(
        &self,
        atom: &Atom,
        belief: BeliefId,
        types: &[CType],
        scope: &mut Scope,
    ) -> Resolved<Vec<Pattern>> {
        let mut locals = Locals::new();
        let mut patterns = Vec::new();
        for (index, (term, ctype)) in atom.arguments.iter().zip(types).enumerate() {
            let Term::Variable(name) = term else {
                patterns.push(self.pattern(term, ctype, scope)?);
                continue;
            };
            if scope.lookup(&name.text).is_some() {
                patterns.push(self.pattern(term, ctype, scope)?);
                continue;
            }
            let local = locals.iter().find(|(local, ..)| *local == name.text);
            if let Some((_, belief, first)) = local {
                check_type(&types[*first], ctype, &name.text, &name.span)?;
                check_equality(ctype, &name.span)?;
                patterns.push(Pattern::Equal(Value::Field(*belief, *first)));
            } else {
                locals.push((name.text.clone(), belief, index));
                patterns.push(Pattern::Any);
            }
        }
        scope.negation_only.extend(locals.into_iter().map(|(name, ..)| name));
        Ok(patterns)
    }
}

fn check_type(found: &CType, expected: &CType, name: &str, span: &Span) -> Resolved<()> {
    if found == expected {
        return Ok(());
    }
    Err(Diagnostic::error(
        format!("`{name}` has type `{}`, expected `{}`", found.name, expected.name),
        span.clone(),
    ))
}

fn check_equality(ctype: &CType, span: &Span) -> Resolved<()> {
    if ctype.has_equality() {
        return Ok(());
    }
    Err(Diagnostic::error(
        format!("values of type `{}` cannot be compared", ctype.name),
        span.clone(),
    )
    .help("bind the value to a new variable and compare it with a function of type bool"))
}

fn check_last(atom: &Atom, last: bool) -> Resolved<()> {
    if last {
        return Ok(());
    }
    Err(Diagnostic::error(
        format!("`{}` leads back to itself and is not the last formula", atom.name.text),
        atom.span.clone(),
    )
    .label("this call would be recursive")
    .help("move it to the end of the body: there it becomes the event of the next step"))
}
