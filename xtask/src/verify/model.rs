//! Checks properties on a model of the agent and measures its C, using the compiler's library.

use asl2c::Checked;
use translator::{model, parse_configuration, translate};

use super::{Agent, VerifyError};

/// Checks all properties of an agent, or only one.
pub(super) fn check(agent: &Agent<'_>, only: Option<&str>) -> Result<Vec<Checked>, VerifyError> {
    let configuration = parse_configuration(agent.name, agent.configuration)?;
    let model = model(&configuration, agent.text)?;
    let only: Vec<&str> = only.into_iter().collect();
    Ok(asl2c::verify(&model, &only)?)
}

/// Cost of the agent, measured with a compiler and valgrind.
pub(super) fn cost(agent: &Agent<'_>) -> Result<String, VerifyError> {
    let configuration = parse_configuration(agent.name, agent.configuration)?;
    let mut translation = translate(&configuration, agent.text)?;
    let unknown = asl2c::measure(&mut translation, &configuration, agent.text);
    if unknown.is_empty() {
        Ok(translation.report.to_string())
    } else {
        Err(VerifyError::Unmeasured(unknown.join("\n")))
    }
}
