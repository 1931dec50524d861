//! Types, constants, and which values fit where.

use crate::tree::Type;

/// A type by what can be done with its values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Ty {
    Void,
    Bool,
    Integer {
        bits: u32,
        signed: bool,
    },
    Float32,
    Float64,
    /// `const char *`
    Text,
    Struct(String),
    Enum(String),
    /// Only passed on.
    Opaque(String),
    Pointer {
        constant: bool,
        to: Box<Named>,
    },
    Array(Box<Self>, u64),
}

/// A type with its name: where addresses are passed, equal ranges do not make equal types.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Named {
    pub(crate) name: String,
    pub(crate) ty: Ty,
}

/// An expression's type, and its value if it is a constant integer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Typed {
    pub(crate) ty: Ty,
    pub(crate) value: Option<i128>,
}

impl From<Ty> for Typed {
    fn from(ty: Ty) -> Self {
        Self { ty, value: None }
    }
}

pub(crate) const INT: Ty = Ty::Integer { bits: 32, signed: true };
pub(crate) const UINT: Ty = Ty::Integer { bits: 32, signed: false };
pub(crate) const LONG: Ty = Ty::Integer { bits: 64, signed: true };
pub(crate) const ULONG: Ty = Ty::Integer { bits: 64, signed: false };

/// The name of a type with single blanks, as in the headers.
pub(crate) fn spelling(ctype: &Type) -> String {
    let constant = if ctype.constant { "const " } else { "" };
    let stars: String = ctype.stars.iter().map(|_| "*").collect();
    let blank = if stars.is_empty() { "" } else { " " };
    format!("{constant}{}{blank}{stars}", ctype.words.join(" "))
}

/// A type without pointers, if all compilers agree on it.
pub(crate) fn basic(words: &str) -> Option<Ty> {
    use translator::types::{CType, TypeKind};
    Some(match CType::named(words).kind {
        TypeKind::Void => Ty::Void,
        TypeKind::Bool => Ty::Bool,
        TypeKind::Signed { bits } => Ty::Integer { bits, signed: true },
        TypeKind::Unsigned { bits } => Ty::Integer { bits, signed: false },
        TypeKind::Float32 => Ty::Float32,
        TypeKind::Float64 => Ty::Float64,
        TypeKind::Text | TypeKind::Struct | TypeKind::Opaque => return None,
    })
}

/// A macro of `<stdint.h>` or `<stdbool.h>` that is generated.
pub(crate) fn listed_macro(name: &str) -> Option<Typed> {
    let (ty, value) = match name {
        "true" | "false" => return Some(Ty::Bool.into()),
        "INT8_MIN" => (INT, i8::MIN.into()),
        "INT16_MIN" => (INT, i16::MIN.into()),
        "INT32_MIN" => (INT, i32::MIN.into()),
        "INT8_MAX" => (INT, i8::MAX.into()),
        "INT16_MAX" => (INT, i16::MAX.into()),
        "INT32_MAX" => (INT, i32::MAX.into()),
        "INT64_MAX" => (LONG, i64::MAX.into()),
        "UINT8_MAX" => (INT, u8::MAX.into()),
        "UINT16_MAX" => (INT, u16::MAX.into()),
        "UINT32_MAX" => (UINT, u32::MAX.into()),
        "UINT64_MAX" => (ULONG, u64::MAX.into()),
        _ => return None,
    };
    Some(Typed { ty, value: Some(value) })
}

/// An integer constant; `None` if it is out of its type's range.
pub(crate) fn integer(text: &str) -> Option<Typed> {
    let digits = text.trim_end_matches(['U', 'L']);
    let ty = match &text[digits.len()..] {
        "" => INT,
        "U" => UINT,
        "LL" => LONG,
        _ => ULONG,
    };
    let value = digits.parse().ok()?;
    fits(value, &ty).then_some(Typed { ty, value: Some(value) })
}

/// A floating-point constant as the shortest one with its value, correctly rounded to its type; `None` if it is infinite.
/// Programs round what has many digits differently: CBMC takes a number a hair above the middle of two for the middle.
pub(crate) fn float(text: &str) -> Option<String> {
    if let Some(digits) = text.strip_suffix('F') {
        let value = digits.parse().ok().filter(|value: &f32| value.is_finite())?;
        return Some(format!("{value:?}F"));
    }
    let value = text.parse().ok().filter(|value: &f64| value.is_finite())?;
    Some(format!("{value:?}"))
}

/// Whether an integer is in the range of a type.
pub(crate) fn fits(value: i128, ty: &Ty) -> bool {
    let Ty::Integer { bits, signed } = ty else { return false };
    if *signed {
        (-(1_i128 << (bits - 1))..1 << (bits - 1)).contains(&value)
    } else {
        (0..1 << bits).contains(&value)
    }
}

/// Whether every value of one integer type is one of another.
fn contains(wide: &Ty, narrow: &Ty) -> bool {
    match (wide, narrow) {
        (
            Ty::Integer { bits: wide, signed: wide_signed },
            Ty::Integer { bits: narrow, signed: narrow_signed },
        ) => match (wide_signed, narrow_signed) {
            (true, false) => wide > narrow,
            (false, true) => false,
            _ => wide >= narrow,
        },
        _ => false,
    }
}

/// An integer in an expression: C computes with no narrower type than `int`.
fn promoted(ty: &Ty) -> Ty {
    match ty {
        Ty::Integer { bits, .. } if *bits < 32 => INT,
        other => other.clone(),
    }
}

/// The type in which C computes with two integers, if neither value can change by that.
pub(crate) fn common(left: &Typed, right: &Typed) -> Option<Ty> {
    let (Ty::Integer { bits: a, signed: s }, Ty::Integer { bits: b, signed: t }) =
        (promoted(&left.ty), promoted(&right.ty))
    else {
        return None;
    };
    let common = if s == t {
        Ty::Integer { bits: a.max(b), signed: s }
    } else {
        let (unsigned, signed) = if s { (b, a) } else { (a, b) };
        if signed > unsigned {
            Ty::Integer { bits: signed, signed: true }
        } else {
            Ty::Integer { bits: unsigned, signed: false }
        }
    };
    let keeps = |typed: &Typed| match typed.value {
        Some(value) => fits(value, &common),
        None => contains(&common, &typed.ty),
    };
    (keeps(left) && keeps(right)).then_some(common)
}

/// The result of an operator on constants; `Err` if it has none in the type.
pub(crate) fn computed(
    sign: &str,
    left: Option<i128>,
    right: Option<i128>,
    ty: &Ty,
) -> Result<Option<i128>, ()> {
    let (Some(left), Some(right)) = (left, right) else { return Ok(None) };
    let value = match sign {
        "+" => left.checked_add(right),
        "-" => left.checked_sub(right),
        "*" => left.checked_mul(right),
        "/" => left.checked_div(right),
        _ => left.checked_rem(right),
    };
    value.filter(|value| fits(*value, ty)).map(Some).ok_or(())
}

/// Whether a value can be kept where a type is, and stays what it is.
pub(crate) fn is_kept(value: &Typed, ty: &Ty) -> bool {
    match (value.value, ty) {
        (Some(number), Ty::Integer { .. }) => fits(number, ty),
        _ => match (&value.ty, ty) {
            // What may be written may also be only read.
            (Ty::Pointer { to: from, .. }, Ty::Pointer { constant: true, to }) => from == to,
            (from @ Ty::Integer { .. }, to @ Ty::Integer { .. }) => contains(to, from),
            (Ty::Array(..) | Ty::Void, _) | (_, Ty::Array(..)) => false,
            (from, to) => from == to,
        },
    }
}
