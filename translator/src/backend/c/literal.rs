//! Constants of C.

use crate::c_string::c_string;
use crate::interpreter::Value;
use crate::program::Program;
use crate::types::{CType, TypeKind};

/// A constant with the value, or with zero.
pub(super) fn literal(program: &Program, value: Option<&Value>, ctype: &CType) -> String {
    match (value, ctype.kind) {
        (Some(Value::Struct(values)), _) => {
            let fields = values.iter().zip(fields(program, ctype));
            let parts: Vec<String> =
                fields.map(|(value, ctype)| literal(program, Some(value), ctype)).collect();
            format!("{{ {} }}", parts.join(", "))
        }
        (None, TypeKind::Struct) => {
            let fields = fields(program, ctype);
            let parts: Vec<String> = fields.map(|ctype| literal(program, None, ctype)).collect();
            format!("{{ {} }}", parts.join(", "))
        }
        (Some(Value::Bool(value)), _) => value.to_string(),
        (Some(Value::Integer(value)), _) => integer(*value),
        (Some(Value::Float(value)), _) => number(*value),
        (Some(Value::Text(text)), _) => c_string(text),
        (None, TypeKind::Text) => "\"\"".to_owned(),
        (None, TypeKind::Bool) => "false".to_owned(),
        (None, _) => "0".to_owned(),
    }
}

fn fields<'a>(program: &'a Program, ctype: &CType) -> impl Iterator<Item = &'a CType> {
    program.configuration.fields(&ctype.name).iter().map(|(_, ctype)| ctype)
}

fn integer(value: i128) -> String {
    if value > i64::MAX.into() {
        format!("{value}ULL")
    } else if value == i64::MIN.into() {
        // Its absolute value is no constant of C.
        format!("({}LL - 1LL)", value + 1)
    } else {
        format!("{value}LL")
    }
}

fn number(value: f64) -> String {
    if value.is_nan() {
        "(0.0 / 0.0)".to_owned()
    } else if value.is_infinite() {
        format!("({} / 0.0)", 1.0_f64.copysign(value))
    } else {
        format!("{value:?}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_have_exactly_their_value() {
        assert_eq!(integer(u64::MAX.into()), "18446744073709551615ULL");
        assert_eq!(integer(i64::MIN.into()), "(-9223372036854775807LL - 1LL)");
        assert_eq!(number(-0.0), "-0.0");
        assert_eq!(number(5e-324), "5e-324");
        assert_eq!(number(f64::NEG_INFINITY), "(-1 / 0.0)");
    }
}
