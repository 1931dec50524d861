//! The MISRA C:2012 rules that cppcheck and its addon check.

use std::path::Path;

use serde::Serialize;
use translator::GeneratedFile;

use crate::tool::{ToolError, output, write};

/// A violated rule or a complaint.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Deviation {
    /// The file.
    pub file: String,
    /// Its line, counted from 1; 0 if it is about the whole file.
    pub line: usize,
    /// The rule as cppcheck names it, `misra-c2012-15.5`.
    pub rule: String,
    /// What cppcheck says of it.
    pub said: String,
}

const CPPCHECK: &str = "cppcheck";
/// C that violates rule 15.5, which an addon that does not run would pass.
const BAD: &str = "int f(int x);\nint f(int x)\n{\n  if (x)\n    return 1;\n  return 0;\n}\n";
const BROKEN_RULE: &str = "misra-c2012-15.5";
/// The interface is not called by the C itself, and system headers are not checked.
const SUPPRESSED: [&str; 2] = ["--suppress=missingIncludeSystem", "--suppress=unusedFunction"];
/// Between the parts of a finding.
const PARTS: &str = "--template={file}\t{line}\t{id}\t{message}";

/// The deviations of generated C.
///
/// # Errors
/// If cppcheck or its addon does not run.
pub(super) fn deviations(files: &[GeneratedFile]) -> Result<Vec<Deviation>, ToolError> {
    let no_folder = |source| ToolError::Io { what: "no temporary folder".to_owned(), source };
    let folder = tempfile::tempdir().map_err(no_folder)?;
    write(folder.path(), "bad.c", BAD)?;
    let awake = checked(folder.path(), "bad.c")?;
    if !awake.iter().any(|found| found.rule == BROKEN_RULE) {
        return Err(ToolError::Failed {
            program: CPPCHECK.to_owned(),
            said: format!("the MISRA addon does not find {BROKEN_RULE}; it needs python3"),
        });
    }
    files.iter().try_for_each(|file| write(folder.path(), &file.name, &file.text))?;
    checked(folder.path(), &files[0].name)
}

fn checked(folder: &Path, file: &str) -> Result<Vec<Deviation>, ToolError> {
    let options = ["--addon=misra", "--enable=all", "--std=c99", "--quiet", PARTS, "-I."];
    let result = output(folder, CPPCHECK, &[&options[..], &SUPPRESSED, &[file]].concat())?;
    let said = String::from_utf8_lossy(&result.stderr);
    let said: Vec<&str> = said.lines().filter(|line| !line.is_empty()).collect();
    if !result.status.success() {
        let said = [String::from_utf8_lossy(&result.stdout).as_ref(), &said.join("\n")].concat();
        return Err(ToolError::Failed { program: CPPCHECK.to_owned(), said });
    }
    let deviations = said.iter().map(|line| {
        let parts: Vec<&str> = line.splitn(4, '\t').collect();
        let part = |index: usize| parts.get(index).copied().unwrap_or_default().to_owned();
        let line = part(1).parse().unwrap_or(0);
        Deviation { file: part(0), line, rule: part(2), said: part(3) }
    });
    Ok(deviations.collect())
}
