//! Analyses the agent for run-time errors with Frama-C's EVA.

use std::path::Path;
use std::process::Command;

use translator::HARNESS;

use super::{VerifyError, in_file};

/// Name of the program.
pub(super) const FRAMA_C: &str = "frama-c";

/// Alarms that EVA cannot exclude during the agent's whole life, from `init()` on.
pub(super) fn alarms(folder: &Path) -> Result<Vec<String>, VerifyError> {
    // What the coarse analysis excludes is excluded. A finer one takes more than ten times as long, and excludes more.
    let coarse = coarse_alarms(folder)?;
    if coarse.is_empty() { Ok(coarse) } else { alarms_at("1", folder) }
}

/// Alarms, some of which a finer analysis may exclude.
pub(super) fn coarse_alarms(folder: &Path) -> Result<Vec<String>, VerifyError> {
    alarms_at("0", folder)
}

fn alarms_at(precision: &str, folder: &Path) -> Result<Vec<String>, VerifyError> {
    let folder = folder.canonicalize().map_err(in_file("cannot find", folder))?;
    let output = Command::new(FRAMA_C)
        .args(["-eva", "-eva-precision", precision, "-machdep", "gcc_x86_64"])
        // NaN may come from outside; literals need not be exact.
        .args(["-warn-special-float", "none", "-kernel-warn-key", "parser:decimal-float=inactive"])
        .arg(HARNESS)
        .current_dir(&folder)
        // Frama-C reads its working directory from the environment.
        .env("PWD", &folder)
        .output()
        .map_err(in_file("cannot run", Path::new(FRAMA_C)))?;
    let text = String::from_utf8_lossy(&output.stdout);
    if !text.contains("ANALYSIS SUMMARY") {
        return Err(VerifyError::Tool { tool: "Frama-C", output: text.into_owned() });
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
