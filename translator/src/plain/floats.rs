//! Floating-point operations of a comparison, as functions of their own.
//!
//! Both translations compute the same operation of the same operands. To show that, nobody needs to know what comes
//! out: it suffices that it is the same. What holds for whatever it is holds for what it is, and without the circuits of
//! two adders or multipliers a proof takes seconds in place of minutes.

use std::fmt::Write as _;

use crate::types::TypeKind;

/// Definition that leaves open what floating-point operations result in: the same for the same operands. What is shown
/// with it holds; what is not may still hold.
pub const ANY_FLOATS: &str = "PLAIN_ANY_FLOATS";

/// Operators and the names of their functions.
const OPERATIONS: [(&str, &str); 4] =
    [("+", "add"), ("-", "subtract"), ("*", "multiply"), ("/", "divide")];

/// Types of C and the ends of the names.
const TYPES: [(TypeKind, &str, &str); 2] =
    [(TypeKind::Float32, "float", "32"), (TypeKind::Float64, "double", "64")];

/// The function that a comparison calls for an operator on two values of a type; `None` if it uses the operator
/// itself, because the type is none of floating-point numbers or the operator none of `+ - * /`.
pub fn float_function(sign: &str, kind: TypeKind) -> Option<String> {
    let (_, operation) = OPERATIONS.iter().find(|(known, _)| *known == sign)?;
    let (_, _, bits) = TYPES.iter().find(|(known, ..)| *known == kind)?;
    Some(format!("plain_{operation}_{bits}"))
}

/// Whether a text calls one of the functions.
pub(crate) fn calls_float_functions(text: &str) -> bool {
    let names =
        OPERATIONS.iter().flat_map(|(sign, _)| TYPES.map(|(kind, ..)| float_function(sign, kind)));
    names.flatten().any(|name| text.contains(&format!("{name}(")))
}

/// The functions.
pub(crate) fn float_functions() -> String {
    let mut text = String::new();
    for (_, ctype, bits) in TYPES {
        for (sign, operation) in OPERATIONS {
            let any = format!("__CPROVER_uninterpreted_{operation}_{bits}");
            _ = writeln!(
                text,
                "#ifdef {ANY_FLOATS}\n{ctype} {any}({ctype} a, {ctype} b);\n#else\n#define {any}(a, b) ((a) {sign} (b))\n\
                 #endif\nstatic {ctype} plain_{operation}_{bits}({ctype} a, {ctype} b) {{ return {any}(a, b); }}"
            );
        }
    }
    text
}

/// C that defines these functions as macros with the operators, for compilers.
pub fn float_operators() -> String {
    let mut text = String::new();
    for (kind, ..) in TYPES {
        for (sign, _) in OPERATIONS {
            if let Some(function) = float_function(sign, kind) {
                _ = writeln!(
                    text,
                    "#define {function}(plain_a, plain_b) ((plain_a) {sign} (plain_b))"
                );
            }
        }
    }
    text
}
