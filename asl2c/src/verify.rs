//! Which properties of an agent hold in every environment.

use translator::{Model, Promise};

use crate::spin::{self, SpinError, Verdict};

/// Why nothing was checked.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VerifyError {
    /// SPIN or the C compiler.
    #[error(transparent)]
    Spin(#[from] SpinError),
    /// The configuration states no properties.
    #[error("the configuration has no properties: there is nothing to check")]
    Nothing,
    /// One was asked for that the configuration does not state.
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
    pub property: Promise,
    /// Whether it holds.
    pub verdict: Verdict,
}

/// Checks properties in every environment: those that are named, or all if `only` is empty.
///
/// Starts `spin` and `cc`, one search on each core, with files in a folder for temporary ones.
///
/// # Errors
/// If there is no such property, or a program does not do what is asked of it. That a search has no end is no error
/// but a [`Verdict`].
pub fn verify(model: &Model, only: &[&str]) -> Result<Vec<Checked>, VerifyError> {
    if model.properties.is_empty() {
        return Err(VerifyError::Nothing);
    }
    let checked = spin::check(model, &numbers(model, only)?)?;
    Ok(checked.into_iter().map(|(property, verdict)| Checked { property, verdict }).collect())
}

/// The numbers of the properties to check: of all, unless some are named.
fn numbers(model: &Model, only: &[&str]) -> Result<Vec<usize>, VerifyError> {
    if only.is_empty() {
        return Ok((1..=model.properties.len()).collect());
    }
    let number = |name: &&str| {
        let index = model.properties.iter().position(|promise| promise.name == *name);
        index
            .map(|index| index + 1)
            .ok_or_else(|| VerifyError::Unknown { name: (*name).to_owned() })
    };
    only.iter().map(number).collect()
}
