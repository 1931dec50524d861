//! Frama-C's EVA: a second tool that looks for errors at run time in what is proved, by abstract interpretation.
//!
//! To CBMC an array in the agent's state ends where the state does, which the checks of indices mend; EVA knows where arrays
//! end. It follows all calls that the environment may make from `init()` on, for any number of steps.

use std::path::Path;

use translator::HARNESS;

use crate::tool::{ToolError, output};

/// The program.
pub const FRAMA_C: &str = "frama-c";

/// Errors that cannot be excluded in the program of a proof, whose files are in this folder. A coarse analysis comes first:
/// a finer one takes more than ten times as long, and excludes more.
///
/// # Errors
/// If Frama-C is missing or comes to no result.
pub fn alarms(folder: &Path) -> Result<Vec<String>, ToolError> {
    let coarse = coarse_alarms(folder)?;
    if coarse.is_empty() { Ok(coarse) } else { alarms_at("1", folder) }
}

/// As [`alarms`], some of which a finer analysis may exclude.
///
/// # Errors
/// As [`alarms`].
pub fn coarse_alarms(folder: &Path) -> Result<Vec<String>, ToolError> {
    alarms_at("0", folder)
}

fn alarms_at(precision: &str, folder: &Path) -> Result<Vec<String>, ToolError> {
    let arguments = [
        "-eva",
        "-eva-precision",
        precision,
        "-machdep",
        "gcc_x86_64",
        // NaN may come from outside; literals need not be exact.
        "-warn-special-float",
        "none",
        "-kernel-warn-key",
        "parser:decimal-float=inactive",
        HARNESS,
    ];
    let output = output(folder, FRAMA_C, &arguments)?;
    let text = String::from_utf8_lossy(&output.stdout);
    if !text.contains("ANALYSIS SUMMARY") {
        let said = text.lines().rev().take(5).collect::<Vec<_>>();
        let said = said.into_iter().rev().collect::<Vec<_>>().join("\n");
        return Err(ToolError::Failed { program: FRAMA_C.to_owned(), said });
    }
    let mut lines = text.lines();
    let mut alarms = Vec::new();
    while let Some(line) = lines.next() {
        if let Some(place) = line.strip_prefix("[eva:alarm] ") {
            let place = place.trim_end_matches(" Warning: ").trim_end_matches(':');
            alarms.push(format!("{place} {}", lines.next().unwrap_or_default().trim()));
        }
    }
    Ok(alarms)
}
