//! Measures the stack frame of each generated function, and keeps the assembly.

use std::collections::HashMap;
use std::path::Path;
use std::process::Command;

use translator::{ROUNDED, Translation};

/// Compiler and options for which the figures hold.
pub(super) const COMPILER: &str = "gcc -O2";

/// Output of the compiler.
pub(super) struct Compiled {
    /// Stack frame in bytes, by function.
    pub(super) frame_bytes: HashMap<String, u64>,
    /// The assembly.
    pub(super) assembly: String,
}

/// Compiles the generated C; the error is the reason why that fails.
pub(super) fn compiled(translation: &Translation) -> Result<Compiled, String> {
    let folder = tempfile::tempdir().map_err(|error| format!("no temporary folder: {error}"))?;
    for file in &translation.files {
        let path = folder.path().join(&file.name);
        let written = path
            .parent()
            .map_or(Ok(()), std::fs::create_dir_all)
            .and_then(|()| std::fs::write(&path, &file.text));
        written.map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    }
    compile(folder.path(), &translation.files[0].name)
}

fn compile(folder: &Path, source: &str) -> Result<Compiled, String> {
    let output = Command::new("gcc")
        .current_dir(folder)
        // Without jump tables, which would hide the successors of an instruction.
        .args([
            "-std=c99",
            ROUNDED,
            "-O2",
            "-fno-jump-tables",
            "-fstack-usage",
            "-S",
            "-o",
            "agent.s",
        ])
        .arg(source)
        .output()
        .map_err(|error| format!("gcc cannot be run: {error}"))?;
    if !output.status.success() {
        let message = String::from_utf8_lossy(&output.stderr);
        let first = message.lines().find(|line| line.contains("error")).unwrap_or("it failed");
        return Err(format!("gcc does not compile the C by itself: {first}"));
    }
    let usage = std::fs::read_to_string(folder.join("agent.su"))
        .map_err(|error| format!("gcc has left no stack usage: {error}"))?;
    let assembly = std::fs::read_to_string(folder.join("agent.s"))
        .map_err(|error| format!("gcc has left no assembly: {error}"))?;
    Ok(Compiled { frame_bytes: parse(&usage), assembly })
}

/// Each line has location and function, bytes and kind, separated by tabs. Of the parts that the compiler may
/// split a function into, `run_g.part.0`, the largest counts.
fn parse(usage: &str) -> HashMap<String, u64> {
    let mut frames: HashMap<String, u64> = HashMap::new();
    for line in usage.lines() {
        let mut columns = line.split('\t');
        let function = columns.next().and_then(|place| place.rsplit(':').next());
        let bytes = columns.next().and_then(|bytes| bytes.parse().ok());
        if let (Some(function), Some(bytes)) = (function, bytes) {
            let name = function.split('.').next().unwrap_or(function);
            let largest = frames.entry(name.to_owned()).or_default();
            *largest = (*largest).max(bytes);
        }
    }
    frames
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_part_of_a_function_counts() {
        let usage = "a.c:1:6:next_step\t48\tstatic\na.c:9:2:run_g.part.0\t16\tstatic\n\
                     a.c:9:2:run_g\t8\tdynamic,bounded\n\nnonsense\n";
        let frames = parse(usage);
        assert_eq!(frames.len(), 2);
        assert_eq!(frames["next_step"], 48);
        assert_eq!(frames["run_g"], 16);
    }
}
