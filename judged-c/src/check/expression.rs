//! Types of expressions, and which of their parts may be evaluated in any order.

use translator::types::TypeKind;

use super::effects::{operands, root};
use super::{Checked, Checker, inner, require, shown};
use crate::language::Owner;
use crate::lexer::refused;
use crate::refused::Rule;
use crate::tree::{Expression, Prefix, What, Word};
use crate::types::{Ty, Typed, common, computed, integer, listed_macro};

impl Checker<'_> {
    /// An expression that is evaluated as a whole.
    pub(super) fn expression(&mut self, expression: &Expression) -> Checked<Typed> {
        self.order(expression)?;
        self.typed(expression)
    }

    /// A condition.
    pub(super) fn truth(&mut self, condition: &Expression) -> Checked<()> {
        let typed = self.expression(condition)?;
        require(typed.ty == Ty::Bool, &shown(condition), condition.place, Rule::Mismatch)
    }

    fn typed(&mut self, expression: &Expression) -> Checked<Typed> {
        let place = expression.place;
        match &expression.what {
            What::Name(name) => self.named(expression, name),
            What::Integer(text) => integer(text).ok_or_else(|| refused(text, place, Rule::Number)),
            What::Float(text) => {
                Ok(if text.ends_with('F') { Ty::Float32 } else { Ty::Float64 }.into())
            }
            What::Text(_) => Ok(Ty::Text.into()),
            What::Parentheses(inside) => self.typed(inside),
            What::Prefix(prefix, operand) => self.prefixed(expression, *prefix, operand),
            What::Binary(sign, left, right) => self.binary(expression, sign, left, right),
            What::Cast(ctype, operand) => {
                let to = self.language.named(ctype)?;
                self.type_names(ctype)?;
                let from = self.typed(operand)?;
                let integers =
                    matches!((&from.ty, &to.ty), (Ty::Integer { .. }, Ty::Integer { .. }));
                require(integers && ctype.stars.is_empty(), &to.name, place, Rule::Cast)?;
                Ok(to.ty.into())
            }
            What::Call(name, arguments) => self.call(name, arguments),
            What::Field(of, field) => {
                let of_type = self.typed(of)?.ty;
                self.field(&of_type, field, expression)
            }
            What::Arrow(of, field) => match self.typed(of)?.ty {
                Ty::Pointer { to, .. } => self.field(&to.ty, field, expression),
                _ => Err(refused("->", place, Rule::Operation)),
            },
            What::Index(of, index) => {
                let Ty::Array(element, length) = self.typed(of)?.ty else {
                    return Err(refused("[", place, Rule::Operation));
                };
                let index = self.typed(index)?;
                let number = matches!(index.ty, Ty::Integer { .. });
                let inside =
                    index.value.is_none_or(|index| (0..i128::from(length)).contains(&index));
                require(number && inside, "[", place, Rule::Operation)?;
                Ok((*element).into())
            }
            What::Braces(_) => Err(refused("{", place, Rule::Operation)),
        }
    }

    fn named(&mut self, expression: &Expression, name: &str) -> Checked<Typed> {
        let place = expression.place;
        let constant = || self.language.constants.get(name).cloned();
        if let Some(typed) = listed_macro(name).or_else(constant) {
            require(!self.macros.contains(name), name, place, Rule::Macro)?;
            return Ok(typed);
        }
        self.name(name, place)?;
        if let Some(variable) = self.variable(name) {
            return Ok(variable.ty.clone().into());
        }
        match self.language.enumerators.get(name) {
            Some(of) => Ok(Ty::Enum(of.clone()).into()),
            None => Err(refused(name, place, Rule::Undeclared)),
        }
    }

    fn field(&mut self, of: &Ty, field: &str, expression: &Expression) -> Checked<Typed> {
        let Ty::Struct(name) = of else {
            return Err(refused(field, expression.place, Rule::Operation));
        };
        let fields = self.language.structs.get(name);
        let found = fields.and_then(|fields| fields.iter().find(|(known, _)| known == field));
        let Some((_, ty)) = found else {
            return Err(refused(field, expression.place, Rule::Undeclared));
        };
        let ty = ty.clone();
        self.name(field, expression.place)?;
        Ok(ty.into())
    }

    fn prefixed(
        &mut self,
        whole: &Expression,
        prefix: Prefix,
        operand: &Expression,
    ) -> Checked<Typed> {
        let place = whole.place;
        // Only in an argument, where it does not come here.
        require(prefix != Prefix::Address, "&", place, Rule::Address)?;
        let typed = self.typed(operand)?;
        match (prefix, &typed.ty) {
            (Prefix::Not, Ty::Bool) => Ok(Ty::Bool.into()),
            (Prefix::Minus, Ty::Float32 | Ty::Float64) => Ok(typed.ty.into()),
            // As `0 - x`, which no unsigned type of `int`'s width or more can have as its result.
            (Prefix::Minus, Ty::Integer { bits, signed }) if *signed || *bits < 32 => {
                let zero = Typed { ty: crate::types::INT, value: Some(0) };
                let ty = common(&zero, &typed).unwrap_or(crate::types::INT);
                let value = computed("-", Some(0), typed.value, &ty)
                    .map_err(|()| refused("-", place, Rule::Number))?;
                Ok(Typed { ty, value })
            }
            (Prefix::Content, Ty::Pointer { to, .. }) => Ok(to.ty.clone().into()),
            _ => {
                let sign = match prefix {
                    Prefix::Not => "!",
                    Prefix::Minus => "-",
                    Prefix::Address | Prefix::Content => "*",
                };
                Err(refused(sign, place, Rule::Operation))
            }
        }
    }

    fn binary(
        &mut self,
        whole: &Expression,
        sign: &str,
        left: &Expression,
        right: &Expression,
    ) -> Checked<Typed> {
        let place = whole.place;
        let (left, right) = (self.typed(left)?, self.typed(right)?);
        let same = left.ty == right.ty;
        let integers = common(&left, &right);
        let both = |ty: &Ty| left.ty == *ty && same;
        let mixed = matches!((&left.ty, &right.ty), (Ty::Integer { .. }, Ty::Integer { .. }))
            && integers.is_none();
        require(!mixed, sign, place, Rule::Mismatch)?;
        let floats = both(&Ty::Float32) || both(&Ty::Float64);
        match sign {
            "&&" | "||" => {
                require(both(&Ty::Bool), sign, place, Rule::Mismatch)?;
                Ok(Ty::Bool.into())
            }
            "==" | "!=" => {
                let events = same && matches!(left.ty, Ty::Enum(_));
                let equal = events || both(&Ty::Bool) || integers.is_some();
                require(equal, sign, place, Rule::Equality)?;
                Ok(Ty::Bool.into())
            }
            "<" | "<=" | ">" | ">=" => {
                require(floats || integers.is_some(), sign, place, Rule::Operation)?;
                Ok(Ty::Bool.into())
            }
            _ if floats && sign != "%" => {
                let kind =
                    if left.ty == Ty::Float32 { TypeKind::Float32 } else { TypeKind::Float64 };
                self.floats.insert(place, kind);
                Ok(left.ty.into())
            }
            _ => {
                let Some(ty) = integers else { return Err(refused(sign, place, Rule::Operation)) };
                let value = computed(sign, left.value, right.value, &ty)
                    .map_err(|()| refused(sign, place, Rule::Number))?;
                Ok(Typed { ty, value })
            }
        }
    }

    fn call(&mut self, name: &Word, arguments: &[Expression]) -> Checked<Typed> {
        let Word { text, place } = name;
        self.name(text, *place)?;
        let own = self.functions.get(text).map(|own| own.signature.clone());
        let outside = || {
            let declared = self.language.functions.get(text);
            declared.map(|(_, signature)| signature.clone())
        };
        let Some(signature) = own.or_else(outside) else {
            return Err(refused(text, *place, Rule::Undeclared));
        };
        // The environment could keep an address.
        let outside = self.language.functions.get(text);
        let keeps = outside.is_some_and(|(owner, _)| *owner == Owner::Environment);
        let fits = signature.parameters.len() == arguments.len();
        require(fits, text, *place, Rule::Arguments)?;
        for (argument, parameter) in arguments.iter().zip(&signature.parameters) {
            if let What::Prefix(Prefix::Address, of) = &inner(argument).what {
                require(!keeps, "&", argument.place, Rule::Address)?;
                self.address(argument, of, &parameter.ty)?;
            } else {
                let value = self.typed(argument)?;
                self.kept(argument, &value, &parameter.ty)?;
            }
        }
        Ok(signature.result.ty.into())
    }

    /// `&of` can be passed as this pointer.
    fn address(&mut self, whole: &Expression, of: &Expression, pointer: &Ty) -> Checked<()> {
        let Ty::Pointer { constant, to } = pointer else {
            return Err(refused("&", whole.place, Rule::Mismatch));
        };
        let ty = self.typed(of)?.ty;
        require(self.is_place(of), "&", whole.place, Rule::Address)?;
        require(ty == to.ty, "&", whole.place, Rule::Mismatch)?;
        if !constant {
            self.written(of)?;
        }
        Ok(())
    }

    /// Whether it is a variable or a part of one.
    pub(super) fn is_place(&self, place: &Expression) -> bool {
        match &place.what {
            What::Name(name) => self.variable(name).is_some(),
            What::Parentheses(of) | What::Field(of, _) | What::Index(of, _) => self.is_place(of),
            What::Arrow(..) | What::Prefix(Prefix::Content, _) => true,
            _ => false,
        }
    }

    /// It may be changed.
    pub(super) fn written(&mut self, place: &Expression) -> Checked<()> {
        require(self.is_place(place), &shown(place), place.place, Rule::Place)?;
        let constant = match behind(place) {
            Some(pointer) => match self.typed(pointer)?.ty {
                Ty::Pointer { constant, .. } => constant,
                _ => true,
            },
            None => {
                root(place).and_then(|name| self.variable(name)).is_none_or(|root| root.constant)
            }
        };
        require(!constant, &shown(place), place.place, Rule::Written)
    }

    /// Whether it can change something that outlives it.
    pub(super) fn has_effect(&self, expression: &Expression) -> bool {
        let calls =
            matches!(&expression.what, What::Call(name, _) if self.effects.contains(&name.text));
        calls || operands(expression).any(|operand| self.has_effect(operand))
    }

    /// Whether nothing can change it while the expression around it is evaluated.
    pub(super) fn is_fixed(&self, expression: &Expression) -> bool {
        match &expression.what {
            What::Integer(_) | What::Float(_) | What::Text(_) => true,
            What::Name(name) => self.variable(name).is_none_or(|variable| variable.constant),
            What::Prefix(Prefix::Content, _) | What::Arrow(..) | What::Call(..) => false,
            // An address is fixed, whatever is there.
            What::Prefix(Prefix::Address, of) => matches!(inner(of).what, What::Name(_)),
            _ => operands(expression).all(|operand| self.is_fixed(operand)),
        }
    }

    /// No effect beside something that it could change. `&&` and `||` have an order.
    pub(super) fn order(&self, expression: &Expression) -> Checked<()> {
        operands(expression).try_for_each(|operand| self.order(operand))?;
        if matches!(expression.what, What::Binary("&&" | "||", ..)) {
            return Ok(());
        }
        let parts: Vec<&Expression> = operands(expression).collect();
        self.apart(&parts)
    }

    /// Expressions that are evaluated in any order.
    pub(super) fn apart(&self, parts: &[&Expression]) -> Checked<()> {
        for (index, part) in parts.iter().enumerate() {
            let mut others = parts.iter().enumerate().filter(|(other, _)| *other != index);
            let fixed = others.all(|(_, other)| self.is_fixed(other));
            require(fixed || !self.has_effect(part), &shown(part), part.place, Rule::Order)?;
        }
        Ok(())
    }
}

/// The pointer through which a place is reached.
fn behind(place: &Expression) -> Option<&Expression> {
    match &place.what {
        What::Parentheses(of) | What::Field(of, _) | What::Index(of, _) => behind(of),
        What::Arrow(pointer, _) | What::Prefix(Prefix::Content, pointer) => Some(pointer),
        _ => None,
    }
}
