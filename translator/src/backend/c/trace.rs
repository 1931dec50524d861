//! Traces of calls with their values: C that writes them, and the same text of a value that is known here.

use super::names::{Names, argument_names};
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

/// Traces the end of a call of a basic action, with its `result` if it has one.
pub(super) fn trace_result(writer: &mut Writer, program: &Program, result: &CType) {
    if result.kind != TypeKind::Void {
        writer.line("asl2c_trace_text(\" = \");");
        trace_value(writer, program, "result", result);
    }
    writer.line("asl2c_trace_text(\"\\n\");");
}

/// Makes a call of the interface that has no arguments in the trace, and traces it.
pub(super) fn make(writer: &mut Writer, name: &str, call: &str) {
    writer.line(format!("asl2c_trace_text(\"> {name}()\\n\");"));
    writer.line(format!("{call};"));
}

/// Traces what a function of the interface answers, by the function for its type.
pub(super) fn ask(writer: &mut Writer, names: &Names, name: &str, kind: &str) {
    writer.line(format!("asl2c_trace_text(\"> {name}() = \");"));
    writer.line(format!("asl2c_trace_{kind}({});", names.call(name, None)));
    writer.line("asl2c_trace_text(\"\\n\");");
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
            for (field, of) in program.configuration.fields(&ctype.name) {
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
            let values = values.iter().zip(configuration.fields(&ctype.name));
            let parts = values
                .map(|(value, (_, ctype))| format!("{{{}}}", traced(value, ctype, configuration)));
            parts.collect::<Vec<_>>().concat()
        }
    }
}
