//! The trace matrix: from requirement to plan, source lines, C function and its lines.

use std::collections::HashMap;

use serde_json::{Value, json};

use super::c::{handler_name, plan_name};
use crate::program::Program;

/// One row of the matrix: a plan, and a requirement that it implements.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct TraceRow {
    /// The requirement; empty if the plan names none.
    pub requirement: String,
    /// The number that is passed to the trace function.
    pub plan: usize,
    /// The plan's label; empty if it has none.
    pub label: String,
    /// Its triggering event.
    pub trigger: String,
    /// Its first and last line in the agent's text.
    pub source_lines: (usize, usize),
    /// Its function in the C.
    pub function: String,
    /// The function's first and last line.
    pub c_lines: (usize, usize),
}

/// The matrix as CSV and as JSON.
pub(crate) struct Matrix {
    pub(crate) csv: String,
    pub(crate) json: String,
}

/// Maps the plans of `program` to their functions in `source`, the generated C.
pub(crate) fn emit(program: &Program, input: &str, source: &str) -> Result<Matrix, csv::Error> {
    let rows = rows(program, source);
    let output = &program.configuration.settings.output;
    Ok(Matrix { csv: csv(&rows, input, output)?, json: json(&rows, input, output) })
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

fn csv(rows: &[TraceRow], input: &str, output: &str) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "requirement",
        "plan",
        "label",
        "trigger",
        "source",
        "source_first_line",
        "source_last_line",
        "function",
        "c_file",
        "c_first_line",
        "c_last_line",
    ])?;
    for row in rows {
        let lines = [row.source_lines.0, row.source_lines.1, row.c_lines.0, row.c_lines.1];
        let [source_first, source_last, c_first, c_last] = lines.map(|line| line.to_string());
        writer.write_record([
            &row.requirement,
            &row.plan.to_string(),
            &row.label,
            &row.trigger,
            input,
            &source_first,
            &source_last,
            &row.function,
            output,
            &c_first,
            &c_last,
        ])?;
    }
    let bytes = writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
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
