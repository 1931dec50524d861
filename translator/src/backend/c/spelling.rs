//! Syntax of conditions and operators in C.

use crate::syntax::ast::Arithmetic;

/// The C operator.
pub(super) fn symbol(operator: Arithmetic) -> &'static str {
    match operator {
        Arithmetic::Add => "+",
        Arithmetic::Subtract => "-",
        Arithmetic::Multiply => "*",
        Arithmetic::Divide => "/",
        Arithmetic::Remainder => "%",
    }
}

/// Conjunction of the conditions.
pub(super) fn conjunction(conditions: &[String]) -> String {
    match conditions {
        [only] => only.clone(),
        several => several.iter().map(|c| parenthesised(c)).collect::<Vec<_>>().join(" && "),
    }
}

/// In parentheses, unless it already is.
pub(super) fn parenthesised(condition: &str) -> String {
    let mut depth = 0_u32;
    let closed_early = condition.char_indices().any(|(index, character)| {
        match character {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        depth == 0 && index + 1 < condition.len()
    });
    if condition.starts_with('(') && !closed_early {
        condition.to_owned()
    } else {
        format!("({condition})")
    }
}
