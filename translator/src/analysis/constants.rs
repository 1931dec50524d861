//! Numbers and strings as C constants of the expected type.

use diagnostic::{Diagnostic, Span};

use crate::c_string::c_string;
use crate::code::Code;
use crate::program::Value;
use crate::syntax::ast::{Expression, Number};
use crate::types::{CType, TypeKind};

/// An expression as a constant of type `ctype`; `None` if it is not a constant.
pub(super) fn constant(
    expression: &Expression,
    ctype: &CType,
) -> Option<Result<Value, Diagnostic>> {
    let wrong = |what: &str, span: &Span| {
        let message = format!("{what} where a value of type `{}` is expected", ctype.name);
        Err(Code::WrongType.at(message, span.clone()))
    };
    let text = match expression {
        Expression::Number(number) if ctype.is_peer() => wrong("a number", &number.span),
        Expression::Number(number) => c_number(number, ctype),
        Expression::Boolean { value, span } => match ctype.kind {
            TypeKind::Bool => Ok(value.to_string()),
            _ => wrong("`true` or `false`", span),
        },
        Expression::Text { text, span } => match ctype.kind {
            TypeKind::Text => Ok(c_string(text)),
            TypeKind::Opaque if ctype.may_be_text() => Ok(c_string(text)),
            _ => wrong("a string", span),
        },
        _ => return None,
    };
    Some(text.map(|text| Value::Constant(text, ctype.clone())))
}

/// A number as C of type `ctype`.
pub(crate) fn c_number(number: &Number, ctype: &CType) -> Result<String, Diagnostic> {
    let error = |message: String| Err(Code::WrongType.at(message, number.span.clone()));
    let integral = number.digits.bytes().all(|byte| byte.is_ascii_digit());
    let sign = if number.negative { "-" } else { "" };
    match ctype.kind {
        TypeKind::Float64 | TypeKind::Float32 => {
            // The shortest constant with the value, because programs round what has many digits differently.
            let (value, constant) = if ctype.kind == TypeKind::Float64 {
                let value: f64 = number.digits.parse().unwrap_or(f64::INFINITY);
                (value, format!("{value:?}"))
            } else {
                let value: f32 = number.digits.parse().unwrap_or(f32::INFINITY);
                (value.into(), format!("{value:?}F"))
            };
            let mantissa = number.digits.split(['e', 'E']).next().unwrap_or_default();
            let is_zero = mantissa.bytes().all(|byte| matches!(byte, b'0' | b'.'));
            // An underflow would silently be zero.
            if !value.is_finite() || (value == 0.0 && !is_zero) {
                return error(format!("number out of the range of `{}`", ctype.name));
            }
            Ok(format!("{sign}{constant}"))
        }
        TypeKind::Signed { bits } | TypeKind::Unsigned { bits } => {
            if !integral {
                return error(format!("a fraction where `{}` is expected", ctype.name));
            }
            let signed = matches!(ctype.kind, TypeKind::Signed { .. });
            let magnitude = number.digits.parse::<u128>().ok();
            let value = magnitude.and_then(|magnitude| {
                let magnitude = i128::try_from(magnitude).ok()?;
                Some(if number.negative { -magnitude } else { magnitude })
            });
            let (low, high) = ctype.integer_range().unwrap_or((0, 0));
            match value.filter(|value| (low..=high).contains(value)) {
                Some(value) => Ok(c_integer(value, bits, signed)),
                None => error(format!("number out of the range of `{}`", ctype.name)),
            }
        }
        TypeKind::Bool | TypeKind::Void | TypeKind::Text | TypeKind::Struct | TypeKind::Opaque => {
            error(format!("a number where a value of type `{}` is expected", ctype.name))
        }
    }
}

fn c_integer(value: i128, bits: u32, signed: bool) -> String {
    let suffix = match (signed, bits) {
        (true, 64) => "LL",
        (false, 64) => "ULL",
        (true, _) => "",
        (false, _) => "U",
    };
    if signed && bits >= 32 && value == -(1_i128 << (bits - 1)) {
        // The digits alone would be out of range before the sign is applied.
        return format!("(({}{suffix}) - 1{suffix})", value + 1);
    }
    format!("{value}{suffix}")
}

/// The value of a floating-point constant.
pub(crate) fn float(value: &Value) -> Option<f64> {
    let Value::Constant(text, ctype) = value else { return None };
    match ctype.kind {
        TypeKind::Float64 => text.parse().ok(),
        TypeKind::Float32 => text.trim_end_matches('F').parse::<f32>().ok().map(f64::from),
        _ => None,
    }
}

/// The value of an integer constant.
pub(crate) fn integer(value: &Value) -> Option<i128> {
    let Value::Constant(text, ctype) = value else { return None };
    let (low, _) = ctype.integer_range()?;
    if text.starts_with('(') {
        // Only the lowest value needs parentheses.
        return Some(low);
    }
    text.trim_end_matches(['U', 'L']).parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(text: &str, ctype: &str) -> Result<String, String> {
        let (negative, digits) = match text.strip_prefix('-') {
            Some(digits) => (true, digits),
            None => (false, text),
        };
        let number = Number { digits: digits.to_owned(), negative, span: 0..text.len() };
        c_number(&number, &CType::named(ctype)).map_err(|diagnostic| diagnostic.message)
    }

    #[test]
    fn numbers_keep_their_exact_value() {
        for (text, ctype, expected) in [
            ("0.123456789", "double", "0.123456789"),
            ("5", "double", "5.0"),
            ("-2", "float", "-2.0F"),
            ("1e3", "double", "1000.0"),
            ("00.50", "double", "0.5"),
            ("0e999999999", "double", "0.0"),
            ("-0", "float", "-0.0F"),
            ("1.00000005960464477539062500000000000000000000000000001", "float", "1.0000001F"),
            ("1.000000059604644775390625", "float", "1.0F"),
            ("1.1754943508222875e-38", "float", "1.1754944e-38F"),
            ("5e-324", "double", "5e-324"),
            ("2147483647", "int", "2147483647"),
            ("-2147483648", "int32_t", "((-2147483647) - 1)"),
            ("-9223372036854775808", "int64_t", "((-9223372036854775807LL) - 1LL)"),
            ("255", "uint8_t", "255U"),
            ("18446744073709551615", "uint64_t", "18446744073709551615ULL"),
            ("007", "int", "7"),
        ] {
            assert_eq!(number(text, ctype), Ok(expected.to_owned()), "{text} {ctype}");
        }
    }

    #[test]
    fn numbers_that_do_not_fit_are_refused() {
        for (text, ctype) in [
            ("3.7", "int"),
            ("2147483648", "int"),
            ("-1", "unsigned int"),
            ("256", "uint8_t"),
            ("1e999", "double"),
            ("1e39", "float"),
            ("1e-400", "double"),
            ("-1e-50", "float"),
            ("1", "bool"),
            ("1", "positiont"),
            ("999999999999999999999999999999999999999999", "int64_t"),
        ] {
            assert!(number(text, ctype).is_err(), "{text} {ctype}");
        }
    }

    #[test]
    fn strings_survive_the_journey_to_c() {
        assert_eq!(c_string("a\"\\\n??=ä*/"), r#""a\"\\\n\?\?=\303\244*/""#);
    }
}
