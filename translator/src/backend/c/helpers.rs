//! Helper functions that plans use: exact comparison, and arithmetic without overflow.

use super::spelling::{conjunction, symbol};
use crate::backend::writer::Writer;
use crate::configuration::Struct;
use crate::syntax::ast::Arithmetic;
use crate::types::{CType, TypeKind};

/// The helpers in use, each once.
#[derive(Debug, Default)]
pub(super) struct Helpers {
    equal: Vec<CType>,
    /// Comparisons of structs: the type's name and the condition on `argument1` and `argument2`.
    structs: Vec<(String, String)>,
    checked: Vec<(Arithmetic, CType)>,
    /// Operations on floating-point numbers that a compiler may contract: products and sums.
    products: bool,
    sums: bool,
}

impl Helpers {
    /// The expression that is true if two values are equal.
    pub(super) fn equality(&mut self, ctype: &CType, left: &str, right: &str) -> String {
        if !ctype.is_float() && ctype.kind != TypeKind::Struct {
            return format!("({left} == {right})");
        }
        if !self.equal.contains(ctype) {
            self.equal.push(ctype.clone());
        }
        // Structs are passed by reference.
        let reference = if ctype.kind == TypeKind::Struct { "&" } else { "" };
        format!("equal_{}({reference}{left}, {reference}{right})", identifier(ctype))
    }

    /// Keeps that an operation is used.
    pub(super) fn operation(&mut self, operator: Arithmetic, ctype: &CType) {
        self.products |= ctype.is_float() && operator == Arithmetic::Multiply;
        self.sums |= ctype.is_float() && matches!(operator, Arithmetic::Add | Arithmetic::Subtract);
    }

    /// Whether a compiler might round a product and a sum only once, which is another result.
    pub(super) fn may_be_contracted(&self) -> bool {
        self.products && self.sums
    }

    /// The name of the function for checked arithmetic.
    pub(super) fn checked(&mut self, operator: Arithmetic, ctype: &CType) -> String {
        if !self.checked.iter().any(|(other, other_type)| *other == operator && other_type == ctype)
        {
            self.checked.push((operator, ctype.clone()));
        }
        checked_name(operator, ctype)
    }

    pub(super) fn emit(&mut self, writer: &mut Writer, structs: &[Struct]) {
        for declared in structs {
            let needed = |ctype: &CType| ctype.name == declared.name.text;
            if !self.equal.iter().any(needed) {
                continue;
            }
            // The comparisons of its fields have to precede it.
            let fields: Vec<String> = declared
                .fields
                .iter()
                .map(|(field, ctype)| {
                    let name = &field.text;
                    self.equality(
                        ctype,
                        &format!("argument1->{name}"),
                        &format!("argument2->{name}"),
                    )
                })
                .collect();
            self.structs.push((declared.name.text.clone(), conjunction(&fields)));
        }
        for ctype in self.equal.iter().filter(|ctype| ctype.is_float()) {
            let (name, stem) = (&ctype.name, identifier(ctype));
            writer.line("/* Exact equality; a NaN equals nothing. */");
            writer.open(format!("static bool equal_{stem}({name} argument1, {name} argument2)"));
            writer.line("return (argument1 <= argument2) && (argument1 >= argument2);");
            writer.close("}");
            writer.line("");
        }
        for (name, condition) in &self.structs {
            writer.line("/* Equal in every field. */");
            writer.open(format!(
                "static bool equal_{name}(const {name} *argument1, const {name} *argument2)"
            ));
            writer.line(format!("return {condition};"));
            writer.close("}");
            writer.line("");
        }
        for (operator, ctype) in &self.checked {
            emit_checked(writer, *operator, ctype);
        }
    }
}

fn checked_name(operator: Arithmetic, ctype: &CType) -> String {
    let verb = match operator {
        Arithmetic::Add => "add",
        Arithmetic::Subtract => "subtract",
        Arithmetic::Multiply => "multiply",
        Arithmetic::Divide => "divide",
        Arithmetic::Remainder => "remainder",
    };
    format!("checked_{verb}_{}", identifier(ctype))
}

fn emit_checked(writer: &mut Writer, operator: Arithmetic, ctype: &CType) {
    let name = &ctype.name;
    let function = checked_name(operator, ctype);
    writer.line("/* Stores the result and returns true, or returns false if there is none. */");
    writer.open(format!(
        "static bool {function}({name} argument1, {name} argument2, {name} *answer)"
    ));
    writer.line(format!("const bool accepted = {};", valid(operator, ctype)));
    writer.line("");
    writer.open("if (accepted)");
    let symbol = symbol(operator);
    // Narrow types are promoted; the explicit cast makes sure that the only narrowing is of a plain value.
    let wide = match ctype.integer_bits() {
        Some((8 | 16, true)) => Some("int32_t"),
        Some((8 | 16, false)) => Some("uint32_t"),
        _ => None,
    };
    if let Some(wide) = wide {
        writer.line(format!("const {wide} value = ({wide})argument1 {symbol} ({wide})argument2;"));
        writer.line(format!("*answer = ({name})value;"));
    } else {
        writer.line(format!("*answer = argument1 {symbol} argument2;"));
    }
    writer.close("}");
    writer.line("return accepted;");
    writer.close("}");
    writer.line("");
}

/// The condition under which the operation has a result of its type.
fn valid(operator: Arithmetic, ctype: &CType) -> String {
    let Some((bits, signed)) = ctype.integer_bits() else {
        // Of the floating-point operations only division is checked.
        return "(argument2 < 0) || (argument2 > 0)".replace('0', ctype.zero().unwrap_or("0"));
    };
    if !signed {
        let max = unsigned_max(bits);
        return match operator {
            Arithmetic::Add => format!("argument1 <= ({max} - argument2)"),
            Arithmetic::Subtract => "argument1 >= argument2".to_owned(),
            Arithmetic::Multiply => {
                format!("(argument2 == 0U) || (argument1 <= ({max} / argument2))")
            }
            Arithmetic::Divide | Arithmetic::Remainder => "argument2 != 0U".to_owned(),
        };
    }
    let (min, max) = signed_limits(bits);
    match operator {
        Arithmetic::Add => format!(
            "((argument2 >= 0) && (argument1 <= ({max} - argument2))) || ((argument2 < 0) && (argument1 >= ({min} - argument2)))"
        ),
        Arithmetic::Subtract => format!(
            "((argument2 >= 0) && (argument1 >= ({min} + argument2))) || ((argument2 < 0) && (argument1 <= ({max} + argument2)))"
        ),
        Arithmetic::Multiply => format!(
            "(argument1 == 0) || (argument2 == 0) \
             || ((argument1 > 0) && (argument2 > 0) && (argument1 <= ({max} / argument2))) \
             || ((argument1 < 0) && (argument2 < 0) && (argument1 >= ({max} / argument2))) \
             || ((argument1 > 0) && (argument2 < 0) && (argument2 >= ({min} / argument1))) \
             || ((argument1 < 0) && (argument2 > 0) && (argument1 >= ({min} / argument2)))"
        ),
        Arithmetic::Divide | Arithmetic::Remainder => {
            format!("(argument2 != 0) && ((argument1 != {min}) || (argument2 != -1))")
        }
    }
}

fn unsigned_max(bits: u32) -> String {
    match bits {
        64 => "UINT64_MAX".to_owned(),
        bits => format!("UINT{bits}_MAX"),
    }
}

fn signed_limits(bits: u32) -> (String, String) {
    let min = match bits {
        // Checkers replace the macro by a constant without its suffix, which would violate MISRA's rule 7.2.
        64 => "(-INT64_MAX - 1)".to_owned(),
        bits => format!("INT{bits}_MIN"),
    };
    (min, format!("INT{bits}_MAX"))
}

/// A type's name as part of an identifier.
fn identifier(ctype: &CType) -> String {
    ctype.name.replace([' ', '*'], "_")
}
