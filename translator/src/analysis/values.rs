//! Resolves expressions to values, and to patterns that are matched against values.

use diagnostic::{Diagnostic, Span};

use super::Analysis;
use super::constants::constant;
use super::declarations::{check_value_result, not_a_peer};
use super::scope::{Scope, said_already};
use crate::code::Code;
use crate::program::{Call, Operation, Pattern, Value};
use crate::syntax::ast::{Arithmetic, Atom, Expression};
use crate::types::CType;

pub(super) type Resolved<T> = Result<T, Diagnostic>;

impl Analysis<'_> {
    pub(super) fn call(&self, atom: &Atom, scope: &mut Scope) -> Resolved<Call> {
        let (basic, declaration) = self.declarations.basic(atom)?;
        let arguments = self.values(&atom.arguments, &declaration.parameters, scope)?;
        Ok(Call { basic, arguments })
    }

    pub(super) fn values(
        &self,
        expressions: &[Expression],
        types: &[CType],
        scope: &mut Scope,
    ) -> Resolved<Vec<Value>> {
        let pairs = expressions.iter().zip(types);
        pairs.map(|(expression, ctype)| self.value(expression, ctype, scope)).collect()
    }

    /// An expression as a value of type `ctype`.
    pub(super) fn value(
        &self,
        expression: &Expression,
        ctype: &CType,
        scope: &mut Scope,
    ) -> Resolved<Value> {
        if let Some(constant) = constant(expression, ctype) {
            return constant;
        }
        match expression {
            Expression::Atom(atom) if let Some(peer) = self.peer_value(atom) => {
                check_type(&CType::peer(), ctype, &atom.name.text, &atom.span)?;
                Ok(peer)
            }
            Expression::Variable(name) => {
                let id = scope.bound(name)?;
                scope.variables[id.0].used = true;
                check_type(&scope.variables[id.0].ctype, ctype, &name.text, &name.span)?;
                Ok(Value::Variable(id))
            }
            Expression::Atom(atom)
                if ctype.is_peer()
                    && atom.arguments.is_empty()
                    && self.declarations.is_free(&atom.name.text) =>
            {
                Err(not_a_peer(&format!("`{}`", atom.name.text), atom.span.clone()))
            }
            Expression::Atom(atom) => {
                let call = self.call(atom, scope)?;
                let (_, basic) = self.declarations.basic(atom)?;
                check_value_result(basic, atom)?;
                check_type(&basic.result, ctype, &atom.name.text, &atom.span)?;
                Ok(Value::Call(call))
            }
            Expression::Negate { operand, span } => {
                check_numeric(ctype, span)?;
                let operand = self.value(operand, ctype, scope)?;
                if ctype.is_float() {
                    return Ok(Value::Negate(Box::new(operand)));
                }
                let zero = Value::Constant(ctype.zero().unwrap_or("0").to_owned(), ctype.clone());
                Ok(operation(Arithmetic::Subtract, zero, operand, ctype))
            }
            Expression::Arithmetic { operator, left, right, span } => {
                check_numeric(ctype, span)?;
                let left = self.value(left, ctype, scope)?;
                let right = self.value(right, ctype, scope)?;
                if *operator == Arithmetic::Remainder && ctype.is_float() {
                    return Err(Code::WrongType.at("`mod` is for integers", span.clone()));
                }
                Ok(operation(*operator, left, right, ctype))
            }
            Expression::Unnamed(span) => Err(Code::UnboundVariable
                .at("an unnamed variable has no value", span.clone())
                .help("`_` matches anything; name the variable and bind it first")),
            _ => Err(Code::NotAValue
                .at("a condition where a value is needed", expression.span())
                .help("conditions stand in contexts; bind their outcome by choosing a plan")),
        }
    }

    /// The type of an expression as far as it follows from its parts.
    pub(super) fn infer(&self, expression: &Expression, scope: &Scope) -> Option<CType> {
        match expression {
            Expression::Variable(name) => {
                let id = scope.lookup(&name.text)?;
                Some(scope.variables[id.0].ctype.clone())
            }
            Expression::Atom(atom) if self.peer_value(atom).is_some() => Some(CType::peer()),
            Expression::Atom(atom) => {
                let (_, basic) = self.declarations.basic(atom).ok()?;
                Some(basic.result.clone())
            }
            Expression::Boolean { .. } => Some(CType::named("bool")),
            Expression::Negate { operand, .. } => self.infer(operand, scope),
            Expression::Arithmetic { left, right, .. } => {
                self.infer(left, scope).or_else(|| self.infer(right, scope))
            }
            _ => None,
        }
    }

    /// An expression with its inferred type, for `X = ..`; `expected` is that of `X` if it is already known.
    pub(super) fn typed_value(
        &self,
        expression: &Expression,
        expected: Option<CType>,
        scope: &mut Scope,
    ) -> Resolved<(Value, CType)> {
        if let Expression::Atom(atom) = expression
            && self.peer_value(atom).is_none()
        {
            let (_, basic) = self.declarations.basic(atom)?;
            check_value_result(basic, atom)?;
        }
        if let Expression::Variable(name) = expression {
            scope.bound(name)?;
        }
        let Some(ctype) = self.infer(expression, scope).or(expected) else {
            if scope.is_broken(expression) {
                return Err(said_already());
            }
            return Err(Code::UnknownType
                .at("the type of this value is unknown", expression.span())
                .help("write the constant where it is used, or calculate with a variable"));
        };
        Ok((self.value(expression, &ctype, scope)?, ctype))
    }

    pub(super) fn patterns(
        &self,
        atom: &Atom,
        types: &[CType],
        scope: &mut Scope,
    ) -> Resolved<Vec<Pattern>> {
        let pairs = atom.arguments.iter().zip(types);
        pairs.map(|(expression, ctype)| self.pattern(expression, ctype, scope)).collect()
    }

    /// An expression that is matched against a value.
    pub(super) fn pattern(
        &self,
        expression: &Expression,
        ctype: &CType,
        scope: &mut Scope,
    ) -> Resolved<Pattern> {
        match expression {
            Expression::Unnamed(_) => Ok(Pattern::Any),
            Expression::Variable(name) if scope.lookup(&name.text).is_none() => {
                Ok(Pattern::Bind(scope.bind(name, ctype)))
            }
            _ => {
                let value = self.value(expression, ctype, scope)?;
                check_equality(ctype, &expression.span())?;
                Ok(Pattern::Equal(value))
            }
        }
    }
}

fn operation(operator: Arithmetic, left: Value, right: Value, ctype: &CType) -> Value {
    Value::Arithmetic(Box::new(Operation { operator, left, right, ctype: ctype.clone() }))
}

fn check_type(found: &CType, expected: &CType, name: &str, span: &Span) -> Resolved<()> {
    if found == expected {
        return Ok(());
    }
    Err(Code::WrongType.at(
        format!("`{name}` has type `{}`, expected `{}`", found.name, expected.name),
        span.clone(),
    ))
}

pub(super) fn check_numeric(ctype: &CType, span: &Span) -> Resolved<()> {
    if ctype.is_numeric() {
        return Ok(());
    }
    let message = format!("values of type `{}` are not numbers", ctype.name);
    Err(Code::WrongType.at(message, span.clone()))
}

pub(super) fn check_equality(ctype: &CType, span: &Span) -> Resolved<()> {
    if ctype.has_equality() {
        return Ok(());
    }
    let message = format!("values of type `{}` cannot be compared", ctype.name);
    Err(Code::NotComparable
        .at(message, span.clone())
        .help("bind the value to a new variable and compare it with a function of type bool"))
}
