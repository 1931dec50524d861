//! Checks which properties of an agent hold in every environment.

use translator::{DeclaredProperty, Model};

use crate::spin::{self, SpinError, Verdict};

/// Errors that prevent a check.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VerifyError {
    /// Error of SPIN or the C compiler.
    #[error(transparent)]
    Spin(#[from] SpinError),
    /// The configuration states no properties.
    #[error("the configuration has no properties: there is nothing to check")]
    Nothing,
    /// The configuration does not state this property.
    #[error("the configuration has no property `{name}`")]
    Unknown {
        /// Its name.
        name: String,
    },
}

/// A property and its verdict.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Checked {
    /// The property.
    pub property: DeclaredProperty,
    /// Result of the check.
    pub verdict: Verdict,
}

/// Checks properties in every environment: those named in `only`, or all if it is empty.
///
/// Runs `spin` and `cc`, one search per core, in a temporary folder.
///
/// # Errors
/// If there is no such property or none at all, or a program fails. A search that does not finish, because of its limits of
/// depth or memory (2 GB), is not an error but a [`Verdict`].
pub fn verify(model: &Model, only: &[&str]) -> Result<Vec<Checked>, VerifyError> {
    if model.properties.is_empty() {
        return Err(VerifyError::Nothing);
    }
    let checked = spin::check(model, &numbers(model, only)?)?;
    Ok(checked.into_iter().map(|(property, verdict)| Checked { property, verdict }).collect())
}

/// Whether a property is found to fail in some environment. False does not say that it holds: the search may not have
/// finished. Faster than [`verify`], which also shows the shortest way there.
///
/// # Errors
/// If there is no such property, or a program fails.
pub fn is_refuted(model: &Model, property: &str) -> Result<bool, VerifyError> {
    let numbers = numbers(model, &[property])?;
    let number = numbers.first().ok_or(VerifyError::Nothing)?;
    Ok(spin::is_refuted(model, *number)?)
}

/// Numbers of the properties to check: all, unless some are named.
fn numbers(model: &Model, only: &[&str]) -> Result<Vec<usize>, VerifyError> {
    if only.is_empty() {
        return Ok((1..=model.properties.len()).collect());
    }
    let number = |name: &&str| {
        let index = model.properties.iter().position(|property| property.name == *name);
        index
            .map(|index| index + 1)
            .ok_or_else(|| VerifyError::Unknown { name: (*name).to_owned() })
    };
    only.iter().map(number).collect()
}
