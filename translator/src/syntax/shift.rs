//! Moves the spans of a tree whose text has moved.

use diagnostic::{Diagnostic, Span};

use super::ast::{Atom, Expression, Formula, Name, Plan};

/// A part of a tree whose places can be moved.
pub(super) trait Shift {
    /// Moves all spans by this number of bytes.
    fn shift(&mut self, bytes: isize);
}

impl Shift for usize {
    fn shift(&mut self, bytes: isize) {
        // What is behind an edit has room to move by its length.
        *self = self.saturating_add_signed(bytes);
    }
}

impl Shift for Span {
    fn shift(&mut self, bytes: isize) {
        self.start.shift(bytes);
        self.end.shift(bytes);
    }
}

impl<T: Shift> Shift for [T] {
    fn shift(&mut self, bytes: isize) {
        for part in self {
            part.shift(bytes);
        }
    }
}

impl<T: Shift> Shift for Option<T> {
    fn shift(&mut self, bytes: isize) {
        if let Some(part) = self {
            part.shift(bytes);
        }
    }
}

impl<T: Shift> Shift for Box<T> {
    fn shift(&mut self, bytes: isize) {
        self.as_mut().shift(bytes);
    }
}

impl<T: Shift, U: Shift> Shift for (T, U) {
    fn shift(&mut self, bytes: isize) {
        self.0.shift(bytes);
        self.1.shift(bytes);
    }
}

impl Shift for Diagnostic {
    fn shift(&mut self, bytes: isize) {
        self.span.shift(bytes);
    }
}

impl Shift for Name {
    fn shift(&mut self, bytes: isize) {
        self.span.shift(bytes);
    }
}

impl Shift for Atom {
    fn shift(&mut self, bytes: isize) {
        self.name.shift(bytes);
        self.arguments.shift(bytes);
        self.source.shift(bytes);
        self.age.shift(bytes);
        self.span.shift(bytes);
    }
}

impl Shift for Expression {
    fn shift(&mut self, bytes: isize) {
        match self {
            Self::Variable(name) => name.shift(bytes),
            Self::Number(number) => number.span.shift(bytes),
            Self::Atom(atom) => atom.shift(bytes),
            Self::Unnamed(span) | Self::Boolean { span, .. } | Self::Text { span, .. } => {
                span.shift(bytes);
            }
            Self::Negate { operand, span }
            | Self::Not { operand, span }
            | Self::MyName { name: operand, span } => {
                operand.shift(bytes);
                span.shift(bytes);
            }
            Self::Arithmetic { left, right, span, .. }
            | Self::Compare { left, right, span, .. } => {
                left.shift(bytes);
                right.shift(bytes);
                span.shift(bytes);
            }
            Self::Bind { variable, value, span } => {
                variable.shift(bytes);
                value.shift(bytes);
                span.shift(bytes);
            }
            Self::And(parts) | Self::Or(parts) => parts.shift(bytes),
        }
    }
}

impl Shift for Formula {
    fn shift(&mut self, bytes: isize) {
        match self {
            Self::Action(atom)
            | Self::Add(atom)
            | Self::Delete(atom)
            | Self::Defer(atom)
            | Self::Test(atom) => atom.shift(bytes),
            Self::Assign { variable, value } => {
                variable.shift(bytes);
                value.shift(bytes);
            }
            Self::Achieve { goal, deadline } => {
                goal.shift(bytes);
                deadline.shift(bytes);
            }
            Self::MyName { variable, span } => {
                variable.shift(bytes);
                span.shift(bytes);
            }
            Self::Send { to, content, span, .. } => {
                to.shift(bytes);
                content.shift(bytes);
                span.shift(bytes);
            }
            Self::Wait { duration, span } => {
                duration.shift(bytes);
                span.shift(bytes);
            }
        }
    }
}

impl Shift for Plan {
    fn shift(&mut self, bytes: isize) {
        self.label.shift(bytes);
        self.trigger.atom.shift(bytes);
        self.trigger.span.shift(bytes);
        self.context.shift(bytes);
        self.body.shift(bytes);
        self.span.shift(bytes);
    }
}
