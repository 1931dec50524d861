//! Traces of calls with their values: C that writes them, and the same text of a value that is known here.

use super::names::argument_names;
use crate::backend::writer::Writer;
use crate::configuration::Configuration;
use crate::interpreter::Value;
use crate::program::Program;
use crate::types::{CType, TypeKind};

/// Functions that write values by `asl2c_trace_text()` of the platform.
pub(super) const TRACE: &str = include_str!("trace/trace.c");

/// Traces a call, without its result.
pub(super) fn trace_call(writer: &mut Writer, program: &Program, name: &str, types: &[CType]) {
    writer.line(format!("asl2c_trace_text(\"{name}(\");"));
    for (index, (ctype, argument)) in types.iter().zip(argument_names(types)).enumerate() {
        if index > 0 {
            writer.line("asl2c_trace_text(\", \");");
        }
        trace_value(writer, program, &argument, ctype);
    }
    writer.line("asl2c_trace_text(\")\");");
}

/// Traces a value.
pub(super) fn trace_value(writer: &mut Writer, program: &Program, value: &str, ctype: &CType) {
    let function = match ctype.kind {
        TypeKind::Bool => "asl2c_trace_bool",
        TypeKind::Signed { .. } => "asl2c_trace_signed",
        TypeKind::Unsigned { .. } => "asl2c_trace_unsigned",
        TypeKind::Float32 => "asl2c_trace_float",
        TypeKind::Float64 => "asl2c_trace_double",
        TypeKind::Text => "asl2c_trace_text",
        // No value of such a type is ever created.
        TypeKind::Opaque | TypeKind::Void => return writer.line("asl2c_trace_text(\"?\");"),
        TypeKind::Struct => {
            let structs = &program.configuration.structs;
            let fields = structs.iter().filter(|declared| declared.name.text == ctype.name);
            for (field, of) in fields.flat_map(|declared| &declared.fields) {
                writer.line("asl2c_trace_text(\"{\");");
                trace_value(writer, program, &format!("{value}.{}", field.text), of);
                writer.line("asl2c_trace_text(\"}\");");
            }
            return;
        }
    };
    writer.line(format!("{function}({value});"));
}

/// The text that the C writes for a value of this type.
pub fn traced(value: &Value, ctype: &CType, configuration: &Configuration) -> String {
    match value {
        Value::Bool(value) => value.to_string(),
        Value::Integer(value) => value.to_string(),
        Value::Float(value) if value.is_nan() => "nan".to_owned(),
        #[allow(clippy::cast_possible_truncation, reason = "it has been rounded to this precision")]
        Value::Float(value) if ctype.kind == TypeKind::Float32 => {
            format!("{:#x}", (*value as f32).to_bits())
        }
        Value::Float(value) => format!("{:#x}", value.to_bits()),
        Value::Text(text) => text.clone(),
        Value::Struct(values) => {
            let structs = &configuration.structs;
            let declared = structs.iter().find(|declared| declared.name.text == ctype.name);
            let fields = declared.map_or(&[][..], |declared| &declared.fields);
            let parts = values
                .iter()
                .zip(fields)
                .map(|(value, (_, ctype))| format!("{{{}}}", traced(value, ctype, configuration)));
            parts.collect::<Vec<_>>().concat()
        }
    }
}
