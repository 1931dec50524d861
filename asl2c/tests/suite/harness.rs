//! Shared by the tests.

/// A number from an environment variable, or the default.
pub(crate) fn from_environment(variable: &str, usual: u32) -> u32 {
    std::env::var(variable).ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// Reports that a test was skipped because a tool is missing. In CI that is a failure, so that a skipped test
/// cannot look like a passed one.
///
/// # Panics
/// In CI.
#[allow(clippy::print_stdout, reason = "what is left out is said")]
pub(crate) fn skip(tool: &str) {
    assert!(std::env::var_os("CI").is_none(), "there is no {tool} here");
    println!("skipped: there is no {tool} here");
}

/// A CBMC: the one named by `ASL2C_CBMC`, or that on the path.
pub(crate) fn cbmc() -> Option<std::path::PathBuf> {
    let named =
        std::env::var_os("ASL2C_CBMC").map_or_else(|| "cbmc".into(), std::path::PathBuf::from);
    asl2c::Cbmc::find(Some(&named)).ok().map(|_| named)
}
