//! External tools of the verification. A missing one is an error, because what was not proved must not look
//! proved.

use std::ffi::OsStr;
use std::fmt;
use std::path::Path;
use std::process::Command;

use asl2c::{Cbmc, FRAMA_C, SPIN};

use super::VerifyError;
use crate::files::{cannot, target_folder};

/// The tools found.
#[derive(Debug)]
pub(super) struct Tools {
    /// CBMC.
    pub(super) cbmc: Cbmc,
    /// Versions of the tools.
    pub(super) versions: Versions,
}

/// Version strings of the tools.
#[derive(Debug)]
pub(super) struct Versions {
    pub(super) cbmc: String,
    pub(super) frama_c: String,
    pub(super) spin: String,
}

/// A program, its version option, and its package.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Needed {
    program: &'static str,
    version: &'static str,
    package: &'static str,
}

/// SPIN's searches are compiled, hence gcc.
const FOR_PROOFS: [Needed; 3] = [
    Needed { program: SPIN, version: "-V", package: "spin" },
    Needed { program: "cc", version: "--version", package: "gcc" },
    Needed { program: FRAMA_C, version: "-version", package: "frama-c-base" },
];
/// Coverage needs gcov, measuring the cost of a step needs gcc and valgrind.
const BESIDES: [Needed; 3] = [
    Needed { program: "gcc", version: "--version", package: "gcc" },
    Needed { program: "gcov", version: "--version", package: "gcc" },
    Needed { program: "valgrind", version: "--version", package: "valgrind" },
];

/// Missing programs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Missing(Vec<Needed>);

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let programs: Vec<&str> = self.0.iter().map(|needed| needed.program).collect();
        let mut packages: Vec<&str> = self.0.iter().map(|needed| needed.package).collect();
        packages.sort_unstable();
        packages.dedup();
        let (programs, packages) = (programs.join(", no "), packages.join(" "));
        write!(
            f,
            "nothing is proved: there is no {programs} here; `apt install {packages}` may help"
        )
    }
}

impl Tools {
    /// Finds the tools, only those for proofs if `only_proofs`. CBMC is downloaded if necessary, because it
    /// is not available as a package everywhere.
    ///
    /// # Errors
    /// [`VerifyError::Missing`] or [`VerifyError::NoCbmc`] if one of them is missing.
    pub(super) fn find(only_proofs: bool) -> Result<Self, VerifyError> {
        let besides: &[Needed] = if only_proofs { &[] } else { &BESIDES };
        let needed: Vec<Needed> = FOR_PROOFS.iter().chain(besides).copied().collect();
        let is_there = |needed: &Needed| version(needed.program, needed.version).is_some();
        check(&needed, is_there).map_err(VerifyError::Missing)?;
        let script = Path::new("xtask/tools/cbmc.sh");
        let fetched = Command::new(script).arg(target_folder("tools")).status();
        // The script has printed the reason.
        if !fetched.map_err(cannot("run", script))?.success() {
            return Err(VerifyError::NoCbmc);
        }
        let cbmc = target_folder("tools").join("cbmc");
        let cbmc = Cbmc::find(Some(&cbmc))?;
        let versions = Versions {
            cbmc: cbmc.version().to_owned(),
            frama_c: version(FRAMA_C, "-version").unwrap_or_default(),
            spin: version(SPIN, "-V").unwrap_or_default(),
        };
        Ok(Self { cbmc, versions })
    }
}

fn check(needed: &[Needed], is_there: impl Fn(&Needed) -> bool) -> Result<(), Missing> {
    let missing: Vec<Needed> = needed.iter().filter(|needed| !is_there(needed)).copied().collect();
    if missing.is_empty() { Ok(()) } else { Err(Missing(missing)) }
}

/// Version string of a tool; `None` if it cannot be run here.
fn version(tool: impl AsRef<OsStr>, option: &str) -> Option<String> {
    let output = Command::new(tool).arg(option).output().ok()?;
    let version = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    output.status.success().then_some(version)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_is_named_with_its_package() {
        let all: Vec<Needed> = FOR_PROOFS.iter().chain(&BESIDES).copied().collect();
        assert_eq!(check(&all, |_| true), Ok(()));
        let missing = check(&all, |needed| needed.package == "spin").unwrap_err();
        assert_eq!(
            missing.to_string(),
            "nothing is proved: there is no cc, no frama-c, no gcc, no gcov, no valgrind here; \
             `apt install frama-c-base gcc valgrind` may help"
        );
    }
}
