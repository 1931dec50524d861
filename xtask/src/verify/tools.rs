//! The programs that verification needs. One that is missing is an error: what was not proved must not look as if
//! it was.

use std::ffi::OsStr;
use std::fmt;
use std::path::Path;
use std::process::Command;

use asl2c::{Cbmc, SPIN};

use super::run_time::FRAMA_C;
use super::{VerifyError, folder, in_file};

/// The tools with which something is proved.
#[derive(Debug)]
pub(super) struct Tools {
    /// The CBMC.
    pub(super) cbmc: Cbmc,
    /// What they call themselves.
    pub(super) versions: Versions,
}

/// What the tools call themselves.
#[derive(Debug)]
pub(super) struct Versions {
    pub(super) cbmc: String,
    pub(super) frama_c: String,
    pub(super) spin: String,
}

/// A program, how it tells its version, and its package.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Needed {
    program: &'static str,
    version: &'static str,
    package: &'static str,
}

/// SPIN's searches are compiled.
const FOR_PROOFS: [Needed; 3] = [
    Needed { program: SPIN, version: "-V", package: "spin" },
    Needed { program: "cc", version: "--version", package: "gcc" },
    Needed { program: FRAMA_C, version: "-version", package: "frama-c-base" },
];
/// Coverage is counted by gcov, what a step costs by gcc and valgrind.
const BESIDES: [Needed; 3] = [
    Needed { program: "gcc", version: "--version", package: "gcc" },
    Needed { program: "gcov", version: "--version", package: "gcc" },
    Needed { program: "valgrind", version: "--version", package: "valgrind" },
];

/// Programs that are not there.
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
    /// Finds the tools, those for the rest too unless only proofs are wanted; CBMC, which is no package everywhere,
    /// is fetched.
    ///
    /// # Errors
    /// [`VerifyError::Missing`] or [`VerifyError::NoCbmc`] if one of them is not there.
    pub(super) fn find(only_proofs: bool) -> Result<Self, VerifyError> {
        let besides: &[Needed] = if only_proofs { &[] } else { &BESIDES };
        let needed: Vec<Needed> = FOR_PROOFS.iter().chain(besides).copied().collect();
        let is_there = |needed: &Needed| version(needed.program, needed.version).is_some();
        check(&needed, is_there).map_err(VerifyError::Missing)?;
        let script = Path::new("xtask/tools/cbmc.sh");
        let fetched = Command::new(script).arg(folder("tools")).status();
        // The script has said why.
        if !fetched.map_err(in_file("cannot run", script))?.success() {
            return Err(VerifyError::NoCbmc);
        }
        let cbmc = folder("tools").join("cbmc");
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

/// What a tool calls itself; nothing if it does not run here.
fn version(tool: impl AsRef<OsStr>, option: &str) -> Option<String> {
    let output = Command::new(tool).arg(option).output().ok()?;
    let said = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    output.status.success().then_some(said)
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
