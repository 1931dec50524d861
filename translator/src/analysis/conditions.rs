//! Resolves contexts.

use diagnostic::Span;

use super::Analysis;
use super::constants::integer;
use super::messages::{check_peers_differ, conjuncts, no_source};
use super::scope::{Mark, Scope, said_already};
use super::values::{Resolved, check_equality, check_numeric};
use crate::code::Code;
use crate::program::{Alternatives, Condition, Value, VariableId};
use crate::syntax::ast::{Atom, Expression, Name, Relation};
use crate::types::{CType, TypeKind};

impl Analysis<'_> {
    /// Adds the conditions of `expression` to a conjunction, left to right.
    pub(super) fn conditions(
        &mut self,
        expression: &Expression,
        scope: &mut Scope,
        conjunction: &mut Vec<Condition>,
    ) -> Resolved<()> {
        self.conjunction(&conjuncts(expression), scope, conjunction)
    }

    /// As [`Self::conditions`], of several expressions. A single error is returned, others are reported.
    pub(super) fn conjunction(
        &mut self,
        parts: &[&Expression],
        scope: &mut Scope,
        conjunction: &mut Vec<Condition>,
    ) -> Resolved<()> {
        for (index, part) in parts.iter().enumerate() {
            // `true` adds no condition.
            if matches!(part, Expression::Boolean { value: true, .. }) {
                continue;
            }
            if let Some(told) = self.told(part) {
                return self.search(told, &parts[index + 1..], scope, conjunction);
            }
            match self.condition(part, scope) {
                Err(error) if parts.len() == 1 => return Err(error),
                Err(error) => {
                    scope.break_unbound(part);
                    self.error(error);
                }
                Ok(condition) => conjunction.push(condition),
            }
        }
        Ok(())
    }

    fn condition(&mut self, expression: &Expression, scope: &mut Scope) -> Resolved<Condition> {
        match expression {
            Expression::Atom(atom) => self.atom_condition(atom, scope),
            Expression::Not { operand, .. } => {
                let mark = scope.mark();
                let mut inner = Vec::new();
                self.conditions(operand, scope, &mut inner)?;
                scope.leave(mark);
                Ok(Condition::Not(inner))
            }
            Expression::Or(parts) => self.alternatives(parts, scope),
            Expression::MyName { name, span } => self.my_name(name, span, scope),
            Expression::Compare { operator, left, right, span } => {
                let inferred = self.infer(left, scope).or_else(|| self.infer(right, scope));
                let Some(ctype) = inferred else {
                    if scope.is_broken(left) || scope.is_broken(right) {
                        return Err(said_already());
                    }
                    // Reported first, because an unbound variable is the likelier mistake.
                    for side in [left, right] {
                        if let Expression::Variable(name) = side.as_ref() {
                            scope.bound(name)?;
                        }
                    }
                    return Err(Code::ConstantComparison
                        .at("both sides are constants", span.clone())
                        .help("compare a variable or the result of a function"));
                };
                let left = self.value(left, &ctype, scope)?;
                let right = self.value(right, &ctype, scope)?;
                match operator {
                    Relation::Equal | Relation::NotEqual => check_equality(&ctype, span)?,
                    _ => check_numeric(&ctype, span)?,
                }
                if ctype.is_peer() {
                    check_peers_differ(&left, &right, span)?;
                } else {
                    check_informative(*operator, &left, &right, &ctype, span)?;
                }
                Ok(Condition::Compare { relation: *operator, left, right, ctype })
            }
            Expression::Bind { variable, value, .. } => {
                check_fresh(variable, scope)?;
                let resolved = self.typed_value(value, None, scope);
                if resolved.is_err() {
                    scope.break_variable(variable);
                }
                let (value, ctype) = resolved?;
                Ok(Condition::Bind { variable: scope.bind(variable, &ctype), value })
            }
            Expression::Variable(_) | Expression::Boolean { .. } => {
                let bool_type = CType::named("bool");
                Ok(Condition::Truth(self.value(expression, &bool_type, scope)?))
            }
            _ => Err(Code::NotACondition
                .at("not a condition", expression.span())
                .help("a context is made of beliefs, functions of type bool and comparisons")),
        }
    }

    fn atom_condition(&mut self, atom: &Atom, scope: &mut Scope) -> Resolved<Condition> {
        if let Some(annotation) = atom.source.as_ref().or(atom.age.as_ref()) {
            return Err(no_source(&atom.name.text, annotation.span()));
        }
        if !self.declarations.is_basic(&atom.name.text) {
            let types = self.declarations.predicate(atom)?;
            let belief = self.belief_id(&atom.name.text, &types);
            self.beliefs[belief.0].asked_at.get_or_insert(atom.span.clone());
            let patterns = self.patterns(atom, &types, scope)?;
            return Ok(Condition::Holds { belief, patterns });
        }
        let call = self.call(atom, scope)?;
        let (_, basic) = self.declarations.basic(atom)?;
        if basic.result.kind != TypeKind::Bool {
            return Err(Code::NotACondition
                .at(format!("`{}` does not return `bool`", atom.name.text), atom.span.clone())
                .label(format!("declared `{}`", basic.result.name))
                .help("a context is made of beliefs, functions of type bool and comparisons"));
        }
        Ok(Condition::Truth(Value::Call(call)))
    }

    fn alternatives(&mut self, parts: &[Expression], scope: &mut Scope) -> Resolved<Condition> {
        let mut branches = Vec::new();
        let mut bound: Vec<Vec<(String, VariableId)>> = Vec::new();
        for part in parts {
            let mark: Mark = scope.mark();
            let mut branch = Vec::new();
            self.conditions(part, scope, &mut branch)?;
            bound.push(scope.bound_since(mark));
            scope.leave(mark);
            branches.push(branch);
        }
        let exports = scope.exports(&bound);
        Ok(Condition::Any(Alternatives { branches, exports }))
    }
}

/// Refuses comparisons with a constant result.
fn check_informative(
    relation: Relation,
    left: &Value,
    right: &Value,
    ctype: &CType,
    span: &Span,
) -> Resolved<()> {
    if left == right && matches!(left, Value::Variable(_)) {
        return Err(Code::ConstantComparison.at("a value is compared with itself", span.clone()));
    }
    let Some((low, high)) = ctype.integer_range() else { return Ok(()) };
    // Normalized to `variable relation constant`.
    let limits_decide = match relation {
        Relation::Less | Relation::GreaterOrEqual => (Some(low), Some(high)),
        Relation::Greater | Relation::LessOrEqual => (Some(high), Some(low)),
        Relation::Equal | Relation::NotEqual => (None, None),
    };
    let is = |value: &Value, limit: Option<i128>| limit.is_some() && integer(value) == limit;
    if is(right, limits_decide.0) || is(left, limits_decide.1) {
        let message = format!("the result is the same for every value of type `{}`", ctype.name);
        return Err(Code::ConstantComparison.at(message, span.clone()));
    }
    Ok(())
}

/// `=` binds new variables only.
pub(super) fn check_fresh(variable: &Name, scope: &Scope) -> Resolved<()> {
    if scope.lookup(&variable.text).is_none() {
        return Ok(());
    }
    Err(Code::BoundTwice
        .at(format!("`{}` already has a value", variable.text), variable.span.clone())
        .help("`=` binds a new variable; `==` in a context compares"))
}
