//! Shared by the tests.

/// A number that an environment variable tells, or the usual one.
pub(crate) fn from_environment(variable: &str, usual: u32) -> u32 {
    std::env::var(variable).ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// Says that something is not tested for want of a tool. In CI that is a failure: what was not tested must not look as
/// if it was.
///
/// # Panics
/// In CI.
#[allow(clippy::print_stdout, reason = "what is left out is said")]
pub(crate) fn skip(tool: &str) {
    assert!(std::env::var_os("CI").is_none(), "there is no {tool} here");
    println!("skipped: there is no {tool} here");
}

/// A CBMC: the one that `ASL2C_CBMC` names, or that on the path.
pub(crate) fn cbmc() -> Option<std::path::PathBuf> {
    let named =
        std::env::var_os("ASL2C_CBMC").map_or_else(|| "cbmc".into(), std::path::PathBuf::from);
    asl2c::Cbmc::find(Some(&named)).ok().map(|_| named)
}
