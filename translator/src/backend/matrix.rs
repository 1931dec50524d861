//! The trace matrix: from requirement to plan, source lines, C function and its lines.

use std::collections::HashMap;
use std::fmt::Write as _;

use serde_json::{Value, json};

use super::c::{handler_name, plan_name};
use crate::program::Program;

/// One row of the matrix: a plan, and a requirement that it implements.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct TraceRow {
    /// The requirement; empty if the plan names none.
    pub requirement: String,
    /// The number that is passed to the trace function, counted from 0.
    pub plan: usize,
    /// The plan's label; empty if it has none.
    pub label: String,
    /// Its triggering event.
    pub trigger: String,
    /// Its first and last line in the agent's text, counted from 1.
    pub source_lines: (usize, usize),
    /// Its function in the C.
    pub function: String,
    /// The function's first and last line in the C, counted from 1.
    pub c_lines: (usize, usize),
}

/// The matrix as CSV and as JSON.
pub(crate) struct Matrix {
    pub(crate) csv: String,
    pub(crate) json: String,
}

/// Maps the plans of `program` to their functions in `source`, the generated C.
pub(crate) fn emit(program: &Program, input: &str, source: &str) -> Matrix {
    let rows = rows(program, source);
    let output = &program.configuration.settings.output;
    Matrix { csv: csv(&rows, input, output), json: json(&rows, input, output) }
}

/// The rows for the plans of `program`, with their functions in `source`, the generated C.
pub(crate) fn rows(program: &Program, source: &str) -> Vec<TraceRow> {
    let functions = function_lines(source);
    let mut rows = Vec::new();
    for (plan_number, (id, number, plan)) in program.plans().enumerate() {
        let handler = program.handler(id);
        let function = plan_name(number, &handler_name(program, id));
        let c_lines = functions.get(function.as_str()).copied().unwrap_or_default();
        let untagged = [String::new()];
        let requirements =
            if plan.requirements.is_empty() { &untagged[..] } else { &plan.requirements };
        rows.extend(requirements.iter().map(|requirement| TraceRow {
            requirement: requirement.clone(),
            plan: plan_number,
            label: plan.label.clone().unwrap_or_default(),
            trigger: handler.text(),
            source_lines: plan.lines,
            function: function.clone(),
            c_lines,
        }));
    }
    rows
}

/// First and last line of each plan's function.
fn function_lines(source: &str) -> HashMap<&str, (usize, usize)> {
    let mut functions = HashMap::new();
    let mut open: Option<(&str, usize)> = None;
    for (number, line) in (1..).zip(source.lines()) {
        let definition = line.strip_prefix("static outcome_t ").filter(|l| l.starts_with("plan"));
        if let Some(definition) = definition {
            open = definition.split('(').next().map(|name| (name, number));
        } else if line == "}"
            && let Some((name, first)) = open.take()
        {
            functions.insert(name, (first, number));
        }
    }
    functions
}

const COLUMNS: &str = "requirement,plan,label,trigger,source,source_first_line,source_last_line,\
    function,c_file,c_first_line,c_last_line\n";

fn csv(rows: &[TraceRow], input: &str, output: &str) -> String {
    let mut text = COLUMNS.to_owned();
    for row in rows {
        let ((first, last), (c_first, c_last)) = (row.source_lines, row.c_lines);
        let [requirement, label, trigger, input, function, output] =
            [&row.requirement, &row.label, &row.trigger, input, &row.function, output].map(field);
        // Writing to a string cannot fail.
        _ = write!(text, "{requirement},{},{label},{trigger},{input},{first},{last},", row.plan);
        _ = writeln!(text, "{function},{output},{c_first},{c_last}");
    }
    text
}

/// A text as a field of CSV: in quotes if it would end the field.
fn field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

fn json(rows: &[TraceRow], input: &str, output: &str) -> String {
    let rows: Vec<Value> = rows
        .iter()
        .map(|row| {
            json!({
                "requirement": row.requirement,
                "plan": row.plan,
                "label": row.label,
                "trigger": row.trigger,
                "source": { "file": input, "lines": [row.source_lines.0, row.source_lines.1] },
                "function": row.function,
                "c": { "file": output, "lines": [row.c_lines.0, row.c_lines.1] },
            })
        })
        .collect();
    format!("{:#}\n", Value::Array(rows))
}

#[cfg(test)]
mod tests {
    use super::field;

    #[test]
    fn no_text_ends_its_field() {
        for (text, expected) in [
            ("SAF-1", "SAF-1"),
            ("", ""),
            ("a b", "a b"),
            ("a,b", "\"a,b\""),
            ("say \"a\"", "\"say \"\"a\"\"\""),
            ("a\r", "\"a\r\""),
            ("a\nb", "\"a\nb\""),
        ] {
            assert_eq!(field(text), expected);
        }
    }
}
