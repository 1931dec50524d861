//! Proves the properties of an agent on its C, with the compiler's library.

use std::path::Path;

use asl2c::{Cbmc, Plan, Proof};
use translator::{Obligations, obligations, parse_configuration};

use super::mutants::RUN_TIME;
use super::{Agent, VerifyError};
use crate::files::{cannot, write};

/// What was not proved.
pub(super) fn broken(proof: &Proof) -> Vec<&str> {
    let properties = proof.properties.iter().filter(|(_, holds)| !holds);
    let run_time = (!proof.run_time.is_empty()).then_some(RUN_TIME);
    properties.map(|(property, _)| property.name.as_str()).chain(run_time).collect()
}

/// Proves what can be proved of an agent; `folder` is for generated files, and `change` may spoil them.
pub(super) fn prove(
    agent: &Agent<'_>,
    cbmc: &Cbmc,
    folder: &Path,
    plan: &Plan<'_>,
    change: impl Fn(&str) -> Option<String>,
) -> Result<Proof, VerifyError> {
    Ok(asl2c::prove(&to_prove(agent, change)?, cbmc, folder, plan)?)
}

/// Whether some transition from a state that satisfies the invariant violates a property; states at these goals come
/// first.
pub(super) fn violates(
    agent: &Agent<'_>,
    cbmc: &Cbmc,
    folder: &Path,
    invariant: &[String],
    wanted: (&str, &[&str]),
    change: impl Fn(&str) -> Option<String>,
) -> Result<bool, VerifyError> {
    Ok(asl2c::violates(&to_prove(agent, change)?, cbmc, folder, invariant, wanted)?)
}

/// Writes what is proved, for another tool.
pub(super) fn write_program(
    agent: &Agent<'_>,
    folder: &Path,
    change: impl Fn(&str) -> Option<String>,
) -> Result<(), VerifyError> {
    std::fs::create_dir_all(folder).map_err(cannot("make", folder))?;
    let obligations = to_prove(agent, change)?;
    let nothing = obligations.invariant(&[]);
    let mut files = obligations.files.iter().chain([&nothing]);
    Ok(files.try_for_each(|file| write(&folder.join(&file.name), &file.text))?)
}

/// What is proved of an agent; `change` may spoil its files.
pub(super) fn to_prove(
    agent: &Agent<'_>,
    change: impl Fn(&str) -> Option<String>,
) -> Result<Obligations, VerifyError> {
    let parsed = parse_configuration(agent.name, agent.configuration)?;
    let mut obligations = obligations(&parsed, agent.text)?;
    for file in &mut obligations.files {
        if let Some(text) = change(&file.text) {
            file.text = text;
        }
    }
    Ok(obligations)
}
