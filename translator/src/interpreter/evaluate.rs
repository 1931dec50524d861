//! Evaluates expressions under a substitution.

use super::{Decision, Environment, Interpreter, Value};
use crate::syntax::ast::{Atom, Expression, Relation};
use crate::types::CType;

/// Values of variables.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Substitution {
    bound: Vec<(String, CType, Value)>,
    /// Types of queried variables without a value.
    asked: Vec<(String, CType)>,
}

impl Substitution {
    pub(super) fn get(&self, name: &str) -> Option<&Value> {
        self.bound.iter().find(|(other, ..)| other == name).map(|(.., value)| value)
    }

    fn types(&self) -> Vec<(String, CType)> {
        self.bound.iter().map(|(name, ctype, _)| (name.clone(), ctype.clone())).collect()
    }

    fn keep(&mut self, variables: &[(String, CType)]) {
        self.bound.retain(|(name, ..)| variables.iter().any(|(kept, _)| kept == name));
    }

    pub(super) fn bind(&mut self, name: &str, ctype: &CType, value: Value) {
        self.bound.push((name.to_owned(), ctype.clone(), value));
    }
}

impl Substitution {
    /// Marks a variable that the plan has to bind.
    pub(super) fn ask(&mut self, name: &str, ctype: &CType) {
        self.asked.push((name.to_owned(), ctype.clone()));
    }

    /// The type of a queried variable.
    pub(super) fn asked(&self, name: &str) -> Option<CType> {
        self.asked.type_of(name)
    }
}

/// Source of the types of variables.
pub(super) trait Types {
    fn type_of(&self, variable: &str) -> Option<CType>;
}

impl Types for Substitution {
    fn type_of(&self, variable: &str) -> Option<CType> {
        self.types().type_of(variable)
    }
}

impl Types for Vec<(String, CType)> {
    fn type_of(&self, variable: &str) -> Option<CType> {
        self.iter().find(|(name, _)| name == variable).map(|(_, ctype)| ctype.clone())
    }
}

impl Interpreter {
    /// The value of an expression; `None` if it has no result.
    pub(super) fn evaluate(
        &self,
        expression: &Expression,
        ctype: &CType,
        theta: &Substitution,
        environment: &mut dyn Environment,
    ) -> Option<Value> {
        match expression {
            Expression::Variable(name) => theta.get(&name.text).cloned(),
            Expression::Atom(atom) if self.peer_named(atom).is_some() => self.peer_named(atom),
            Expression::Atom(atom) => self.call(atom, theta, environment)?,
            Expression::Negate { operand, .. } => {
                self.evaluate(operand, ctype, theta, environment)?.negate(ctype)
            }
            Expression::Arithmetic { operator, left, right, .. } => {
                let left = self.evaluate(left, ctype, theta, environment)?;
                let right = self.evaluate(right, ctype, theta, environment)?;
                Value::calculate(*operator, &left, &right, ctype)
            }
            constant => Value::constant(constant, ctype),
        }
    }

    /// Calls a basic action or function. `None` if an argument has no value; the inner option is `None` if
    /// there is no result.
    #[allow(clippy::option_option, reason = "having no result is not having failed")]
    pub(super) fn call(
        &self,
        atom: &Atom,
        theta: &Substitution,
        environment: &mut dyn Environment,
    ) -> Option<Option<Value>> {
        let basic =
            self.configuration.basics.iter().find(|basic| basic.name.text == atom.name.text)?;
        let arguments =
            self.evaluate_all(&atom.arguments, &basic.parameters, theta, environment)?;
        let result = environment.call(&atom.name.text, &arguments, &basic.result);
        self.log_call(atom, &arguments, result.as_ref(), environment);
        Some(result)
    }

    pub(super) fn evaluate_all(
        &self,
        expressions: &[Expression],
        types: &[CType],
        theta: &Substitution,
        environment: &mut dyn Environment,
    ) -> Option<Vec<Value>> {
        let pairs = expressions.iter().zip(types);
        pairs.map(|(e, ctype)| self.evaluate(e, ctype, theta, environment)).collect()
    }

    /// The type of an expression, inferred from its parts.
    pub(super) fn type_of(&self, expression: &Expression, types: &dyn Types) -> Option<CType> {
        match expression {
            Expression::Variable(name) => types.type_of(&name.text),
            Expression::Atom(atom) if self.peer_named(atom).is_some() => Some(CType::peer()),
            Expression::Atom(atom) => {
                let mut basics = self.configuration.basics.iter();
                let basic = basics.find(|basic| basic.name.text == atom.name.text)?;
                Some(basic.result.clone())
            }
            Expression::Boolean { .. } => Some(CType::named("bool")),
            Expression::Negate { operand, .. } => self.type_of(operand, types),
            Expression::Arithmetic { left, right, .. } => {
                self.type_of(left, types).or_else(|| self.type_of(right, types))
            }
            _ => None,
        }
    }

    /// Adds the variables that a context binds whenever it holds.
    fn bound_by(&self, expression: &Expression, bound: &mut Vec<(String, CType)>) {
        match expression {
            Expression::And(parts) => {
                for part in parts {
                    self.bound_by(part, bound);
                }
            }
            Expression::Or(parts) => {
                let branches = parts.iter().map(|part| {
                    let mut branch = bound.clone();
                    self.bound_by(part, &mut branch);
                    branch
                });
                let common = branches.reduce(|common, branch| {
                    common.into_iter().filter(|variable| branch.contains(variable)).collect()
                });
                let known = |ctype: &CType| Value::zero(ctype).is_some();
                let common = common.unwrap_or_default();
                let new = common.into_iter().filter(|(name, ctype)| {
                    known(ctype) && bound.iter().all(|(other, _)| other != name)
                });
                let new: Vec<_> = new.collect();
                bound.extend(new);
            }
            Expression::Bind { variable, value, .. } => {
                if let Some(ctype) = self.type_of(value, bound) {
                    bound.push((variable.text.clone(), ctype));
                }
            }
            Expression::MyName { name, .. } => bound_to(name, &CType::peer(), bound),
            Expression::Atom(atom) if !self.is_basic(&atom.name.text) => {
                atom.source.iter().for_each(|source| bound_to(source, &CType::peer(), bound));
                for (argument, ctype) in atom.arguments.iter().zip(self.types(&atom.name.text)) {
                    if let Expression::Variable(name) = argument
                        && bound.iter().all(|(other, _)| *other != name.text)
                    {
                        bound.push((name.text.clone(), ctype));
                    }
                }
                if let Some((age, (_, ctype))) = atom.age.as_ref().zip(self.clock()) {
                    bound_to(age, &ctype, bound);
                }
            }
            _ => {}
        }
    }

    /// Extends the substitution so that the context holds, if possible.
    pub(super) fn context(
        &self,
        expression: &Expression,
        theta: &Substitution,
        environment: &mut dyn Environment,
    ) -> Option<Substitution> {
        match expression {
            Expression::And(_) => self.conjunction(&conjuncts(expression), theta, environment),
            told if let Some(atom) = self.told(told) => self.found(atom, &[], theta, environment),
            Expression::Or(parts) => {
                let mut extended =
                    parts.iter().find_map(|part| self.context(part, theta, environment))?;
                // Variables that are not bound by every alternative are dropped.
                let mut bound = theta.types();
                self.bound_by(expression, &mut bound);
                extended.keep(&bound);
                Some(extended)
            }
            Expression::Not { operand, .. } => {
                let holds = self.context(operand, theta, environment).is_some();
                (!holds).then(|| theta.clone())
            }
            Expression::Atom(atom) if !self.is_basic(&atom.name.text) => {
                self.believed(atom, theta, environment)
            }
            condition => {
                let extended = self.condition(condition, theta, environment);
                let (place, holds) = (condition.span(), extended.is_some());
                environment.decided(Decision::Condition { place, holds });
                extended
            }
        }
    }

    /// As [`Self::context`], for conditions that must hold together.
    pub(super) fn conjunction(
        &self,
        parts: &[&Expression],
        theta: &Substitution,
        environment: &mut dyn Environment,
    ) -> Option<Substitution> {
        let Some((first, rest)) = parts.split_first() else { return Some(theta.clone()) };
        if let Some(atom) = self.told(first) {
            return self.found(atom, rest, theta, environment);
        }
        let theta = self.context(first, theta, environment)?;
        self.conjunction(rest, &theta, environment)
    }

    /// As [`Self::context`], for a condition without parts.
    fn condition(
        &self,
        expression: &Expression,
        theta: &Substitution,
        environment: &mut dyn Environment,
    ) -> Option<Substitution> {
        match expression {
            Expression::Compare { operator, left, right, span } => {
                let ctype = self.type_of(left, theta).or_else(|| self.type_of(right, theta))?;
                let left = self.evaluate(left, &ctype, theta, environment)?;
                let right = self.evaluate(right, &ctype, theta, environment)?;
                let (place, order) = (span.clone(), Value::order(&left, &right));
                environment.decided(Decision::Compared { place, order });
                Value::compare(*operator, &left, &right).then(|| theta.clone())
            }
            Expression::MyName { name, .. } => {
                let mut theta = theta.clone();
                let me = self.me();
                self.match_pattern(name, &me, &CType::peer(), &mut theta, environment)?;
                Some(theta)
            }
            Expression::Bind { variable, value, .. } => {
                let ctype = self.type_of(value, theta)?;
                let value = self.evaluate(value, &ctype, theta, environment)?;
                let mut theta = theta.clone();
                theta.bind(&variable.text, &ctype, value);
                Some(theta)
            }
            Expression::Atom(atom) => {
                let holds = self.call(atom, theta, environment)? == Some(Value::Bool(true));
                holds.then(|| theta.clone())
            }
            value => {
                let bool_type = CType::named("bool");
                let value = self.evaluate(value, &bool_type, theta, environment);
                (value == Some(Value::Bool(true))).then(|| theta.clone())
            }
        }
    }

    /// Matches a belief.
    pub(super) fn believed(
        &self,
        atom: &Atom,
        theta: &Substitution,
        environment: &mut dyn Environment,
    ) -> Option<Substitution> {
        let values = self.beliefs.get(&atom.name.text);
        let (place, holds) = (atom.name.span.clone(), values.is_some());
        environment.decided(Decision::Condition { place, holds });
        let values = values?;
        let types = self.types(&atom.name.text);
        let mut theta = theta.clone();
        for ((pattern, value), ctype) in atom.arguments.iter().zip(values).zip(&types) {
            self.match_pattern(pattern, value, ctype, &mut theta, environment)?;
        }
        Some(theta)
    }

    /// Matches one argument; binds a new variable.
    pub(super) fn match_pattern(
        &self,
        pattern: &Expression,
        value: &Value,
        ctype: &CType,
        theta: &mut Substitution,
        environment: &mut dyn Environment,
    ) -> Option<()> {
        match pattern {
            Expression::Unnamed(_) => Some(()),
            Expression::Variable(name) if theta.get(&name.text).is_none() => {
                theta.bind(&name.text, ctype, value.clone());
                Some(())
            }
            _ => {
                let wanted = self.evaluate(pattern, ctype, theta, environment);
                let is_equal = |wanted: &Value| Value::compare(Relation::Equal, value, wanted);
                let (place, holds) = (pattern.span(), wanted.as_ref().is_some_and(is_equal));
                environment.decided(Decision::Condition { place, holds });
                holds.then_some(())
            }
        }
    }

    pub(super) fn is_basic(&self, name: &str) -> bool {
        self.configuration.basics.iter().any(|basic| basic.name.text == name)
    }
}

/// Adds a variable of this type.
fn bound_to(name: &Expression, ctype: &CType, bound: &mut Vec<(String, CType)>) {
    if let Expression::Variable(name) = name
        && bound.iter().all(|(other, _)| *other != name.text)
    {
        bound.push((name.text.clone(), ctype.clone()));
    }
}

/// The parts of a conjunction, those in parentheses with the others.
fn conjuncts(expression: &Expression) -> Vec<&Expression> {
    match expression {
        Expression::And(parts) => parts.iter().flat_map(conjuncts).collect(),
        other => vec![other],
    }
}
