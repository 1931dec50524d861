//! Statements, and whether each way through a function ends with `return`.

use std::collections::{HashMap, HashSet};

use super::{Checked, Checker, inner, require, shown};
use crate::lexer::refused;
use crate::refused::Rule;
use crate::tree::{Block, Expression, For, Group, Statement, What};
use crate::types::{Ty, is_kept};

impl Checker<'_> {
    /// Checks a block in a scope of its own. Returns whether its end is never reached.
    fn block(&mut self, block: &Block) -> Checked<bool> {
        self.scopes.push(HashMap::new());
        let returns = self.statements(block)?;
        self.scopes.pop();
        Ok(returns)
    }

    /// The same in the scope that is open.
    pub(super) fn statements(&mut self, block: &Block) -> Checked<bool> {
        let mut returns = false;
        for statement in block {
            if returns {
                let (found, place) = first(statement);
                return Err(refused(&found, place, Rule::Unreachable));
            }
            returns = self.statement(statement)?;
        }
        Ok(returns)
    }

    /// Returns whether nothing behind it is reached.
    fn statement(&mut self, statement: &Statement) -> Checked<bool> {
        match statement {
            Statement::Block(block) => return self.block(block),
            Statement::Object(object) => self.object(object)?,
            Statement::Assign(place, sign, value) => self.assign(place, sign, value)?,
            Statement::Count(place, sign) => {
                let ty = self.expression(place)?.ty;
                // Narrower ones are converted back.
                let counts = matches!(ty, Ty::Integer { bits: 32.., .. });
                require(counts, sign, place.place, Rule::Operation)?;
                self.written(place)?;
            }
            Statement::Value(value) => self.value(value)?,
            Statement::If(arms, otherwise) => {
                let mut returns = otherwise.is_some();
                for (condition, block) in arms {
                    self.truth(condition)?;
                    returns &= self.block(block)?;
                }
                if let Some(block) = otherwise {
                    returns &= self.block(block)?;
                }
                return Ok(returns);
            }
            Statement::For(repeated) => self.repeat(repeated)?,
            Statement::Switch(value, groups) => return self.select(value, groups),
            Statement::Return(place, value) => {
                let result = self.result.clone();
                match value {
                    Some(value) => {
                        let typed = self.expression(value)?;
                        self.kept(value, &typed, &result)?;
                    }
                    None => require(result == Ty::Void, "return", *place, Rule::Mismatch)?,
                }
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn assign(&mut self, place: &Expression, sign: &str, value: &Expression) -> Checked<()> {
        let ty = self.expression(place)?.ty;
        self.written(place)?;
        let typed = self.expression(value)?;
        if sign == "=" {
            self.kept(value, &typed, &ty)?;
            // The place is that of before or after an effect.
            let fixed = is_fixed_place(self, place);
            require(fixed || !self.has_effect(value), &shown(value), value.place, Rule::Order)
        } else {
            let sum = match &ty {
                Ty::Integer { bits: 32.., .. } => is_kept(&typed, &ty),
                Ty::Float32 | Ty::Float64 => typed.ty == ty,
                _ => return Err(refused(sign, place.place, Rule::Operation)),
            };
            require(sum, sign, place.place, Rule::Mismatch)?;
            require(!self.has_effect(value), &shown(value), value.place, Rule::Order)
        }
    }

    /// A call without a result, or a value that is thrown away.
    fn value(&mut self, value: &Expression) -> Checked<()> {
        if let What::Cast(ctype, thrown) = &value.what
            && ctype.stars.is_empty()
            && ctype.words == ["void"]
            && !ctype.constant
        {
            return self.expression(thrown).map(|_| ());
        }
        let typed = self.expression(value)?;
        let is_call = matches!(value.what, What::Call(..));
        require(is_call && typed.ty == Ty::Void, &shown(value), value.place, Rule::Unused)
    }

    fn repeat(&mut self, repeated: &For) -> Checked<()> {
        let For { counter, condition, step, body } = repeated;
        let place = counter.name.place;
        let count = &counter.name.text;
        self.scopes.push(HashMap::new());
        self.object(counter)?;
        let mut is_number = false;
        // In the loop it only counts: nothing else changes it.
        if let Some(variable) = self.scopes.last_mut().and_then(|scope| scope.get_mut(count)) {
            is_number = matches!(variable.ty, Ty::Integer { bits: 32.., .. }) && !variable.constant;
            variable.constant = true;
        }
        require(is_number && counter.length.is_none(), count, place, Rule::Loop)?;
        let constant = |value: &Option<Expression>| {
            value.as_ref().is_some_and(|v| matches!(v.what, What::Integer(_)))
        };
        require(constant(&counter.initial), count, place, Rule::Loop)?;
        require(step.text == *count, &step.text, step.place, Rule::Loop)?;
        self.truth(condition)?;
        let effect = self.has_effect(condition);
        let bounded = is_bound(condition, count);
        require(bounded && !effect, &shown(condition), condition.place, Rule::Loop)?;
        self.block(body)?;
        self.scopes.pop();
        Ok(())
    }

    fn select(&mut self, value: &Expression, groups: &[Group]) -> Checked<bool> {
        let typed = self.expression(value)?;
        let selects = matches!(typed.ty, Ty::Enum(_) | Ty::Integer { bits: 32.., .. });
        require(selects, &shown(value), value.place, Rule::Operation)?;
        let mut known = HashSet::new();
        let mut has_default = false;
        let mut returns = true;
        for group in groups {
            for (place, label) in &group.labels {
                let Some(label) = label else {
                    require(!has_default, "default", *place, Rule::Case)?;
                    has_default = true;
                    continue;
                };
                self.constant(label)
                    .map_err(|refused| crate::Refused { rule: Rule::Case, ..refused })?;
                let of = self.expression(label)?;
                let name = match (&of.value, &inner(label).what) {
                    (Some(value), _) => value.to_string(),
                    (None, What::Name(name)) => name.clone(),
                    _ => String::new(),
                };
                let fits = is_kept(&of, &typed.ty);
                require(fits && known.insert(name), &shown(label), label.place, Rule::Case)?;
            }
            self.block(&group.body)?;
            // It ends with `break` or `return`.
            returns &= !group.breaks;
        }
        Ok(returns && has_default)
    }
}

/// Whether it is the same place before and after any effect.
fn is_fixed_place(checker: &Checker<'_>, place: &Expression) -> bool {
    match &place.what {
        // Pointers are parameters, which stay the same.
        What::Name(_) | What::Arrow(..) | What::Prefix(..) => true,
        What::Parentheses(of) | What::Field(of, _) => is_fixed_place(checker, of),
        What::Index(of, index) => is_fixed_place(checker, of) && checker.is_fixed(index),
        _ => false,
    }
}

/// `count < 3`, also in a conjunction.
fn is_bound(condition: &Expression, count: &str) -> bool {
    match &inner(condition).what {
        What::Binary("<", left, right) => {
            let counts = matches!(&inner(left).what, What::Name(name) if name == count);
            counts && matches!(inner(right).what, What::Integer(_))
        }
        What::Binary("&&", left, right) => is_bound(left, count) || is_bound(right, count),
        _ => false,
    }
}

/// A word and its place for a message about a statement.
fn first(statement: &Statement) -> (String, crate::lexer::Place) {
    match statement {
        Statement::Block(block) => block.first().map_or(("{".to_owned(), <_>::default()), first),
        Statement::Object(object) => (object.name.text.clone(), object.name.place),
        Statement::Assign(place, ..) | Statement::Count(place, _) => (shown(place), place.place),
        Statement::Value(value) | Statement::Switch(value, _) => (shown(value), value.place),
        Statement::If(arms, _) => {
            arms.first().map_or(("if".to_owned(), <_>::default()), |(c, _)| (shown(c), c.place))
        }
        Statement::For(repeated) => ("for".to_owned(), repeated.counter.name.place),
        Statement::Return(place, _) => ("return".to_owned(), *place),
    }
}
