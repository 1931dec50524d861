//! Checks properties on a model of the agent, using the compiler's library.

use asl2c::Checked;
use translator::{Model, model, parse_configuration};

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
