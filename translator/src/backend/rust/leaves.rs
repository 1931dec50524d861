//! The values in the text of a message, one by one: a struct is its fields in braces.

use super::argument;
use crate::configuration::Configuration;
use crate::types::{CType, TypeKind};

/// A value in the text of a message.
pub(super) struct Leaf {
    /// The text between it and the one before.
    pub(super) before: String,
    /// The index of its argument.
    pub(super) argument: usize,
    /// The field of that argument which it is.
    pub(super) field: Option<String>,
    pub(super) ctype: CType,
}

impl Leaf {
    /// The variable or field where it is: `argument1`, `argument2.x`.
    pub(super) fn place(&self) -> String {
        let argument = argument(self.argument);
        match &self.field {
            Some(field) => format!("{argument}.{field}"),
            None => argument,
        }
    }

    /// The expression that is written for it; none if it is a variable as it stands.
    pub(super) fn spelled(&self) -> Option<String> {
        let place = self.place();
        match self.ctype.kind {
            TypeKind::Float32 => Some(format!("Digits32({place})")),
            TypeKind::Float64 => Some(format!("Digits64({place})")),
            // One line, whatever the string is.
            TypeKind::Text => Some(format!("{place}.to_bytes().escape_ascii()")),
            _ => self.field.as_ref().map(|_| place),
        }
    }
}

/// The values of arguments of these types, and the text behind them.
pub(super) fn leaves(configuration: &Configuration, types: &[CType]) -> (Vec<Leaf>, String) {
    let mut leaves = Vec::new();
    let mut behind = "(";
    for (argument, ctype) in types.iter().enumerate() {
        let is_struct = ctype.kind == TypeKind::Struct;
        let value = |before: String, field: Option<&str>, ctype: &CType| {
            let (field, ctype) = (field.map(str::to_owned), ctype.clone());
            Leaf { before, argument, field, ctype }
        };
        if is_struct {
            let fields = configuration.fields(&ctype.name).iter().enumerate();
            leaves.extend(fields.map(|(index, (field, ctype))| {
                let before = if index == 0 { format!("{behind}{{") } else { ", ".to_owned() };
                value(before, Some(&field.text), ctype)
            }));
        } else {
            leaves.push(value(behind.to_owned(), None, ctype));
        }
        behind = if is_struct { "}, " } else { ", " };
    }
    let after = if behind.starts_with('}') { "})" } else { ")" };
    (leaves, after.to_owned())
}

/// The number of bytes in the longest text of a value that is read.
pub(super) fn longest(configuration: &Configuration, ctype: &CType) -> usize {
    if ctype.is_peer() {
        return configuration.peers.iter().map(|peer| peer.text.len()).max().unwrap_or(0);
    }
    if let Some((lowest, highest)) = ctype.integer_range() {
        return lowest.to_string().len().max(highest.to_string().len());
    }
    match ctype.kind {
        TypeKind::Bool => "false".len(),
        // All digits that C writes for any number, too. Rust writes a number below 1e16 without an exponent.
        TypeKind::Float32 => "-9999999000000000.0".len(),
        TypeKind::Float64 => "-2.2250738585072014e-308".len(),
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::configuration::parse;

    #[test]
    fn the_longest_text_of_a_number_has_its_sign() {
        let (configuration, _) = parse("peers { leader, wingman, scout };");
        for (name, text) in [
            ("int8_t", "-128"),
            ("uint8_t", "255"),
            ("int", "-2147483648"),
            ("int64_t", "-9223372036854775808"),
            ("uint64_t", "18446744073709551615"),
            ("bool", "false"),
        ] {
            assert_eq!(longest(&configuration, &CType::named(name)), text.len(), "{name}");
        }
        assert_eq!(longest(&configuration, &CType::peer()), "wingman".len());
        let [narrow, wide] =
            ["float", "double"].map(|name| longest(&configuration, &CType::named(name)));
        for exponent in -45..=38 {
            let number: f32 = format!("-9.999999e{exponent}").parse().unwrap();
            assert!(format!("{number:?}").len() <= narrow, "{number:?}");
        }
        for exponent in -324..=308 {
            let number: f64 = format!("-1.2345678901234567e{exponent}").parse().unwrap();
            assert!(format!("{number:?}").len() <= wide, "{number:?}");
        }
    }
}
