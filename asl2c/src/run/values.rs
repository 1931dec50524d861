//! Syntax of values in scripts.

use translator::configuration::{Configuration, Struct};
use translator::interpreter::Value;
use translator::types::{CType, TypeKind};

/// The zero value of a type.
pub(crate) fn zero(ctype: &CType, configuration: &Configuration) -> Value {
    match ctype.kind {
        TypeKind::Bool => Value::Bool(false),
        TypeKind::Signed { .. } | TypeKind::Unsigned { .. } => Value::Integer(0),
        TypeKind::Float32 | TypeKind::Float64 => Value::Float(0.0),
        TypeKind::Struct => {
            let fields = fields(ctype, configuration);
            Value::Struct(fields.iter().map(|field| zero(field, configuration)).collect())
        }
        TypeKind::Text | TypeKind::Opaque | TypeKind::Void => Value::Text(String::new()),
    }
}

/// Types of a struct's fields.
pub(crate) fn fields(ctype: &CType, configuration: &Configuration) -> Vec<CType> {
    let declared = configuration.structs.iter().find(|other| other.name.text == ctype.name);
    declared.map_or(Vec::new(), |Struct { fields, .. }| {
        fields.iter().map(|(_, ctype)| ctype.clone()).collect()
    })
}

/// The numbers in an agent's text, also those in comments.
pub(crate) fn numbers(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '.');
    let words = words.map(|word| word.trim_end_matches('.'));
    words.filter(|word| word.starts_with(|c: char| c.is_ascii_digit()))
}

/// Parses a value; the error describes the expected form.
pub(super) fn parse(word: &str, ctype: &CType) -> Result<Value, String> {
    match ctype.kind {
        TypeKind::Bool => match word {
            "true" | "1" => Ok(Value::Bool(true)),
            "false" | "0" => Ok(Value::Bool(false)),
            _ => Err("`true` or `false`".to_owned()),
        },
        TypeKind::Float64 => float(word, false).map(Value::Float),
        TypeKind::Float32 => float(word, true).map(Value::Float),
        TypeKind::Signed { .. } | TypeKind::Unsigned { .. } => {
            let range = ctype.integer_range();
            let (low, high) = range.unwrap_or((i128::MIN, i128::MAX));
            let value: Option<i128> = word.parse().ok();
            value
                .filter(|value| (low..=high).contains(value))
                .map(Value::Integer)
                .ok_or_else(|| format!("an integer from {low} to {high}"))
        }
        TypeKind::Text | TypeKind::Opaque => {
            Err(format!("a text in quotes, which stands for a value of type `{}`", ctype.name))
        }
        TypeKind::Struct => Err("the fields in braces: `{1.5, true}`".to_owned()),
        TypeKind::Void => Err("nothing".to_owned()),
    }
}

fn float(word: &str, single: bool) -> Result<f64, String> {
    // Rust would accept other words too, such as `infinity`.
    let known = matches!(word, "nan" | "inf" | "-inf");
    let plain = word.chars().all(|c| c.is_ascii_digit() || "+-.eE".contains(c));
    let value =
        if single { word.parse::<f32>().ok().map(f64::from) } else { word.parse::<f64>().ok() };
    value
        .filter(|value| known || (plain && value.is_finite()))
        .ok_or_else(|| "a number, `nan`, `inf` or `-inf`".to_owned())
}
