//! Cost of an agent's compiled C: stack, longest path, costliest step.

mod costliest_step;
mod longest_path;
mod stack;

use translator::{ParsedConfiguration, Translation, exercise};

/// Adds stack, longest path and costliest step of the compiled C to a translation's report. Returns the
/// figures that could not be measured, with the reason: one line each, without a full stop.
///
/// The agent's configuration and text are those that were translated. Files that were added to the translation, such as
/// headers that the C includes, are used too.
#[must_use = "missing figures should be reported"]
pub fn measure(
    translation: &mut Translation,
    configuration: &ParsedConfiguration,
    agent: &str,
) -> Vec<String> {
    let compiled = match stack::compiled(translation) {
        Ok(compiled) => compiled,
        Err(reason) => return vec![format!("the stack was not measured: {reason}")],
    };
    let mut unknown = Vec::new();
    let report = &mut translation.report;
    report.add_stack(stack::COMPILER, &compiled.frame_bytes);
    match longest_path::longest(&compiled.assembly, report.entry()) {
        Ok(instructions) => report.add_path(stack::COMPILER, instructions),
        Err(reason) => unknown.push(format!("the longest path is unknown: {reason}")),
    }
    let costliest = exercise(configuration, agent).map_err(|error| error.to_string()).and_then(
        |mut exercise| {
            let known: Vec<String> = exercise.files.iter().map(|file| file.name.clone()).collect();
            let added = translation.files.iter().filter(|file| !known.contains(&file.name));
            exercise.files.extend(added.cloned());
            costliest_step::costliest(&exercise)
        },
    );
    match costliest {
        Ok(instructions) => report.add_costliest(instructions),
        Err(reason) => unknown.push(format!("no costliest step was found: {reason}")),
    }
    unknown
}
