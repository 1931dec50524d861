//! Checks the names of the output files.

use diagnostic::{Diagnostic, is_printable};

use super::{Configuration, Settings};
use crate::code::Code;

/// Output names must be usable in `#include`, stay inside the output folder, and be distinct; none may be a file of the proofs
/// or an included one. Returns an error for each that is not.
pub(super) fn check_outputs(configuration: &Configuration) -> Vec<Diagnostic> {
    let outputs = configuration.settings.outputs();
    let included = configuration.included_files();
    let place =
        |settings: &Settings, key: &str| settings.places.get(key).cloned().unwrap_or_default();
    let mut findings = Vec::new();
    for (index, (key, name)) in outputs.iter().enumerate() {
        let span = place(&configuration.settings, key);
        let odd = |c: char| "'\"\\*?<>|".contains(c) || !is_printable(c);
        if name.contains(odd) {
            findings.push(
                Code::FileName
                    .at(format!("`{key}` is not a valid file name for `#include`"), span)
                    .help("letters, digits, `_`, `-`, `.` and `/` do"),
            );
        } else if name.starts_with('/') || name.split('/').any(|part| part == "..") {
            findings.push(
                    Code::FileName.at(format!("`{key}` is outside the output folder"), span)
                        .help("name a file in the configuration's folder or below; `-o DIR` selects another folder"),
                );
        } else if name.split('/').any(|part| matches!(part, "" | ".")) {
            findings.push(
                Code::FileName
                    .at(format!("`{key}` is not a plain file name"), span)
                    .help("write it without `./` and `//`"),
            );
        } else if ["harness.c", "invariant.h"].contains(&name.as_str()) {
            findings.push(
                Code::FileName
                    .at(format!("`{name}` is a file of the proofs"), span)
                    .help("choose another name"),
            );
        } else if let Some((other, _)) = outputs[..index].iter().find(|(_, other)| other == name) {
            findings.push(
                Code::Overwrites
                    .at(format!("`{key}` and `{other}` are the same file"), span)
                    .help("the second would overwrite the first"),
            );
        } else if included.contains(name) {
            findings.push(
                Code::Overwrites
                    .at(format!("`{key}` is {name}, which is included"), span)
                    .help("yours would be overwritten: choose another name"),
            );
        }
    }
    // A name with two conflicts is reported once.
    findings.dedup_by(|one, other| one.message == other.message);
    findings
}
