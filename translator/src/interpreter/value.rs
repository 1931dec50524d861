//! Values within the range of their C type.

use std::cmp::Ordering::{self, Equal, Greater, Less};
use std::fmt;

use crate::syntax::ast::{Arithmetic, Expression, Relation};
use crate::types::{CType, TypeKind};

/// A value of a C type.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// `bool`
    Bool(bool),
    /// Any integer type; its range is that of its C type.
    Integer(i128),
    /// `double` and, rounded to single precision, `float`.
    Float(f64),
    /// A string constant.
    Text(String),
    /// The fields of a struct.
    Struct(Vec<Self>),
}

impl fmt::Display for Value {
    /// In the syntax of agents and scripts: the shortest digits with exactly this value.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bool(value) => write!(f, "{value}"),
            Self::Integer(value) => write!(f, "{value}"),
            Self::Float(value) => {
                let size = value.abs();
                if value.is_nan() {
                    f.write_str("nan")
                } else if size.is_finite() && size != 0.0 && !(1e-5..1e15).contains(&size) {
                    write!(f, "{value:e}")
                } else {
                    write!(f, "{value}")
                }
            }
            Self::Text(text) => write!(f, "{text:?}"),
            Self::Struct(fields) => {
                f.write_str("{")?;
                for (index, field) in fields.iter().enumerate() {
                    write!(f, "{}{field}", if index == 0 { "" } else { ", " })?;
                }
                f.write_str("}")
            }
        }
    }
}

impl Value {
    /// The initial value of a C variable of the type.
    pub(super) fn zero(ctype: &CType) -> Option<Self> {
        match ctype.kind {
            TypeKind::Bool => Some(Self::Bool(false)),
            TypeKind::Signed { .. } | TypeKind::Unsigned { .. } => Some(Self::Integer(0)),
            TypeKind::Float32 | TypeKind::Float64 => Some(Self::Float(0.0)),
            TypeKind::Text => Some(Self::Text(String::new())),
            TypeKind::Struct => Some(Self::Struct(Vec::new())),
            TypeKind::Void | TypeKind::Opaque => None,
        }
    }

    /// The value of a constant in the tree.
    pub(super) fn constant(expression: &Expression, ctype: &CType) -> Option<Self> {
        match expression {
            Expression::Number(number) => {
                let sign = if number.negative { "-" } else { "" };
                let text = format!("{sign}{}", number.digits);
                match ctype.kind {
                    TypeKind::Float64 => text.parse().ok().map(Self::Float),
                    TypeKind::Float32 => {
                        text.parse::<f32>().ok().map(|value| Self::Float(value.into()))
                    }
                    _ => text.parse().ok().map(Self::Integer),
                }
            }
            Expression::Boolean { value, .. } => Some(Self::Bool(*value)),
            Expression::Text { text, .. } => Some(Self::Text(text.clone())),
            _ => None,
        }
    }

    /// The result of an operation, if there is one: no overflow of integers, and no division by zero.
    pub(super) fn calculate(
        operator: Arithmetic,
        left: &Self,
        right: &Self,
        ctype: &CType,
    ) -> Option<Self> {
        match (left, right) {
            (Self::Integer(left), Self::Integer(right)) => {
                let result = match operator {
                    Arithmetic::Add => left.checked_add(*right),
                    Arithmetic::Subtract => left.checked_sub(*right),
                    Arithmetic::Multiply => left.checked_mul(*right),
                    Arithmetic::Divide => left.checked_div(*right),
                    Arithmetic::Remainder => {
                        // In C the remainder is defined only if the quotient is.
                        in_range(left.checked_div(*right)?, ctype)?;
                        left.checked_rem(*right)
                    }
                };
                in_range(result?, ctype).map(Self::Integer)
            }
            (Self::Float(left), Self::Float(right)) => {
                let result = match operator {
                    Arithmetic::Add => left + right,
                    Arithmetic::Subtract => left - right,
                    Arithmetic::Multiply => left * right,
                    Arithmetic::Divide => {
                        // Neither zero nor NaN.
                        matches!(right.partial_cmp(&0.0), Some(Less | Greater)).then_some(())?;
                        left / right
                    }
                    Arithmetic::Remainder => return None,
                };
                Some(Self::Float(rounded(result, ctype)))
            }
            _ => None,
        }
    }

    /// The negated value.
    pub(super) fn negate(&self, ctype: &CType) -> Option<Self> {
        match self {
            Self::Float(value) => Some(Self::Float(-value)),
            _ => Self::calculate(Arithmetic::Subtract, &Self::Integer(0), self, ctype),
        }
    }

    /// Whether each value equals its counterpart.
    pub(super) fn all_equal(left: &[Self], right: &[Self]) -> bool {
        left.iter().zip(right).all(|(left, right)| Self::compare(Relation::Equal, left, right))
    }

    /// How one value is to another; `None` if that is not defined.
    pub(super) fn order(left: &Self, right: &Self) -> Option<Ordering> {
        match (left, right) {
            (Self::Bool(left), Self::Bool(right)) => left.partial_cmp(right),
            (Self::Integer(left), Self::Integer(right)) => left.partial_cmp(right),
            (Self::Float(left), Self::Float(right)) => left.partial_cmp(right),
            (Self::Struct(left), Self::Struct(right)) if Self::all_equal(left, right) => {
                Some(Equal)
            }
            _ => None,
        }
    }

    /// Whether two values satisfy a relation. NaN, strings, values of different kinds, and structs that differ have no
    /// order: only `\==` holds for them.
    pub fn compare(relation: Relation, left: &Self, right: &Self) -> bool {
        let order = Self::order(left, right);
        match relation {
            Relation::Less => order == Some(Less),
            Relation::LessOrEqual => matches!(order, Some(Less | Equal)),
            Relation::Greater => order == Some(Greater),
            Relation::GreaterOrEqual => matches!(order, Some(Greater | Equal)),
            Relation::Equal => order == Some(Equal),
            Relation::NotEqual => order != Some(Equal),
        }
    }
}

fn in_range(value: i128, ctype: &CType) -> Option<i128> {
    let (bits, signed) = ctype.integer_bits()?;
    let (low, high) = if signed {
        (-(1_i128 << (bits - 1)), (1_i128 << (bits - 1)) - 1)
    } else {
        (0, (1_i128 << bits) - 1)
    };
    (low..=high).contains(&value).then_some(value)
}

#[allow(clippy::cast_possible_truncation, reason = "rounding to single precision is the point")]
fn rounded(value: f64, ctype: &CType) -> f64 {
    if ctype.kind == TypeKind::Float32 { f64::from(value as f32) } else { value }
}
