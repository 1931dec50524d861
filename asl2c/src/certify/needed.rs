//! The programs that evidence needs.

use std::path::Path;

use super::gather::CertifyError;
use crate::eva::FRAMA_C;
use crate::prove::Cbmc;
use crate::tool::{ToolError, version};

/// Checks that everything is there that evidence needs, and finds CBMC: whoever installs one program after the other begins anew
/// with each.
///
/// # Errors
/// With all that cannot be run, and what to install.
pub(crate) fn find_tools(cbmc: Option<&Path>) -> Result<Cbmc, CertifyError> {
    let cbmc = Cbmc::find(cbmc);
    let mut missing: Vec<String> = ["gcc", "gcov", "cppcheck", "valgrind", FRAMA_C]
        .into_iter()
        .filter_map(|program| match version(program) {
            Err(error @ ToolError::Missing { .. }) => Some(error.to_string()),
            // Whatever else is wrong is told where it matters.
            _ => None,
        })
        .collect();
    match cbmc {
        Ok(cbmc) if missing.is_empty() => Ok(cbmc),
        Err(error) if missing.is_empty() => Err(error.into()),
        cbmc => {
            missing.extend(cbmc.err().map(|error| error.to_string()));
            Err(CertifyError::Tools(missing))
        }
    }
}
