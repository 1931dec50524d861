//! Expressions: `|` below `&` below `not` below relations below `+ -` below `* / mod`.

use diagnostic::Diagnostic;

use super::ast::{Arithmetic, Expression, Number, Relation};
use super::lexer::TokenKind;
use super::parser::{Parsed, Parser};
use crate::code::Code;

/// Maximum nesting of parentheses, calls, signs and `not`, which bounds the parser's stack.
const MAX_NESTING: usize = 32;
/// Maximum number of consecutive arithmetic operators on one level.
const MAX_CHAIN: usize = 32;

impl Parser<'_> {
    /// A whole expression.
    pub(super) fn expression(&mut self, expected: &str) -> Parsed<Expression> {
        self.disjunction(0, expected)
    }

    /// An argument of an atom at this depth.
    pub(super) fn argument(&mut self, depth: usize) -> Parsed<Expression> {
        self.disjunction(depth + 1, "a value")
    }

    fn disjunction(&mut self, depth: usize, expected: &str) -> Parsed<Expression> {
        let mut parts = vec![self.conjunction(depth, expected)?];
        while self.take(&TokenKind::Bar) {
            parts.push(self.conjunction(depth, expected)?);
        }
        Ok(single_or(parts, Expression::Or))
    }

    fn conjunction(&mut self, depth: usize, expected: &str) -> Parsed<Expression> {
        let mut parts = vec![self.negation(depth, expected)?];
        while self.take(&TokenKind::Ampersand) {
            parts.push(self.negation(depth, expected)?);
        }
        Ok(single_or(parts, Expression::And))
    }

    fn negation(&mut self, depth: usize, expected: &str) -> Parsed<Expression> {
        if self.peek() != &TokenKind::Not {
            return self.relation(depth, expected);
        }
        self.check_depth(depth)?;
        let start = self.next().span.start;
        let operand = self.negation(depth + 1, "a belief or a function of type bool")?;
        let span = start..operand.span().end;
        Ok(Expression::Not { operand: Box::new(operand), span })
    }

    fn relation(&mut self, depth: usize, expected: &str) -> Parsed<Expression> {
        let left = self.sum(depth, expected)?;
        let operator = match self.peek() {
            TokenKind::Less => Relation::Less,
            TokenKind::LessOrEqual => Relation::LessOrEqual,
            TokenKind::Greater => Relation::Greater,
            TokenKind::GreaterOrEqual => Relation::GreaterOrEqual,
            TokenKind::EqualsEquals => Relation::Equal,
            TokenKind::NotEquals => Relation::NotEqual,
            TokenKind::Equals => return self.binding(left, depth),
            _ => return Ok(left),
        };
        self.next();
        let right = self.sum(depth, "a value")?;
        let span = left.span().start..right.span().end;
        let (left, right) = (Box::new(left), Box::new(right));
        Ok(Expression::Compare { operator, left, right, span })
    }

    fn binding(&mut self, left: Expression, depth: usize) -> Parsed<Expression> {
        let Expression::Variable(variable) = left else {
            return Err(Code::Syntax
                .at("`=` needs a variable on its left", left.span())
                .help("`==` compares two values"));
        };
        self.next();
        let value = self.sum(depth, "a value")?;
        let span = variable.span.start..value.span().end;
        Ok(Expression::Bind { variable, value: Box::new(value), span })
    }

    fn sum(&mut self, depth: usize, expected: &str) -> Parsed<Expression> {
        let mut left = self.product(depth, expected)?;
        for _ in 0..MAX_CHAIN {
            let operator = match self.peek() {
                TokenKind::Plus => Arithmetic::Add,
                TokenKind::Minus => Arithmetic::Subtract,
                _ => return Ok(left),
            };
            self.next();
            let right = self.product(depth, "a value")?;
            left = arithmetic(operator, left, right);
        }
        Err(self.too_long())
    }

    fn product(&mut self, depth: usize, expected: &str) -> Parsed<Expression> {
        let mut left = self.factor(depth, expected)?;
        for _ in 0..MAX_CHAIN {
            let operator = match self.peek() {
                TokenKind::Star => Arithmetic::Multiply,
                TokenKind::Slash => Arithmetic::Divide,
                TokenKind::Mod => Arithmetic::Remainder,
                _ => return Ok(left),
            };
            self.next();
            let right = self.factor(depth, "a value")?;
            left = arithmetic(operator, left, right);
        }
        Err(self.too_long())
    }

    fn factor(&mut self, depth: usize, expected: &str) -> Parsed<Expression> {
        self.check_depth(depth)?;
        match self.peek().clone() {
            TokenKind::Variable => Ok(Expression::Variable(self.name())),
            TokenKind::Unnamed => Ok(Expression::Unnamed(self.next().span)),
            TokenKind::Text(text) => Ok(Expression::Text { text, span: self.next().span }),
            kind @ (TokenKind::True | TokenKind::False) => {
                let value = kind == TokenKind::True;
                Ok(Expression::Boolean { value, span: self.next().span })
            }
            TokenKind::Atom => Ok(Expression::Atom(self.sourced(depth)?)),
            TokenKind::Dot if self.is_at_internal() => self.my_name(depth),
            TokenKind::Number => Ok(Expression::Number(self.number(None))),
            TokenKind::Minus => self.signed(depth),
            TokenKind::LeftParenthesis => {
                self.next();
                let inner = self.disjunction(depth + 1, expected)?;
                self.expect(&TokenKind::RightParenthesis, "`)`")?;
                Ok(inner)
            }
            _ => Err(self.unexpected(expected)),
        }
    }

    /// A sign directly before a number belongs to it; elsewhere it negates.
    fn signed(&mut self, depth: usize) -> Parsed<Expression> {
        let sign = self.next().span;
        if self.peek() == &TokenKind::Number && self.span().start == sign.end {
            return Ok(Expression::Number(self.number(Some(sign.start))));
        }
        let operand = self.factor(depth + 1, "a value")?;
        let span = sign.start..operand.span().end;
        Ok(Expression::Negate { operand: Box::new(operand), span })
    }

    fn number(&mut self, sign: Option<usize>) -> Number {
        let digits = self.next().span;
        let span = sign.unwrap_or(digits.start)..digits.end;
        Number { digits: self.text[digits].to_owned(), negative: sign.is_some(), span }
    }

    fn check_depth(&self, depth: usize) -> Parsed<()> {
        if depth <= MAX_NESTING {
            return Ok(());
        }
        Err(Code::Limit.at("nested too deeply", self.span()).help(format!(
            "at most {MAX_NESTING} calls and parentheses may stand inside each other"
        )))
    }

    fn too_long(&self) -> Diagnostic {
        Code::Limit
            .at("the expression is too long", self.span())
            .help(format!("at most {MAX_CHAIN} operators may follow each other; use a variable"))
    }
}

fn arithmetic(operator: Arithmetic, left: Expression, right: Expression) -> Expression {
    let span = left.span().start..right.span().end;
    Expression::Arithmetic { operator, left: Box::new(left), right: Box::new(right), span }
}

fn single_or(mut parts: Vec<Expression>, many: fn(Vec<Expression>) -> Expression) -> Expression {
    match parts.pop() {
        Some(only) if parts.is_empty() => only,
        Some(last) => {
            parts.push(last);
            many(parts)
        }
        None => many(parts),
    }
}
