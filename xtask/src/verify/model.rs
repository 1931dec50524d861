//! Checks properties on a model of the agent and measures its C, using the compiler's library.

use asl2c::Checked;
use translator::{Model, model, parse_configuration, translate};

use super::{Agent, VerifyError};

/// Checks all properties of an agent.
pub(super) fn check(agent: &Agent<'_>) -> Result<Vec<Checked>, VerifyError> {
    Ok(asl2c::verify(&of(agent)?, &[])?)
}

/// Whether a property of an agent fails.
pub(super) fn is_refuted(agent: &Agent<'_>, property: &str) -> Result<bool, VerifyError> {
    Ok(asl2c::is_refuted(&of(agent)?, property)?)
}

fn of(agent: &Agent<'_>) -> Result<Model, VerifyError> {
    let configuration = parse_configuration(agent.name, agent.configuration)?;
    Ok(model(&configuration, agent.text)?)
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
