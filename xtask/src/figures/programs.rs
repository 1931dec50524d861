//! The programs that are measured, and how others are run.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::FiguresError;
use crate::files::root;

/// The programs whose instructions and cadence are measured, always built in the same way: another profile, and what cargo does
/// for the next build, make other instructions.
pub(super) struct Programs {
    folder: PathBuf,
}

impl Programs {
    /// Builds them, unless that has been done where this program is (`PROGRAMS_ARE_BUILT`).
    pub(super) fn build() -> Result<Self, Box<dyn std::error::Error>> {
        if std::env::var_os("PROGRAMS_ARE_BUILT").is_some() {
            let own = std::env::current_exe()?;
            return Ok(Self { folder: own.parent().map(Path::to_owned).unwrap_or_default() });
        }
        let target = root().join("target/figures");
        let mut build = Command::new("cargo");
        build.args(["build", "--quiet", "--locked", "--workspace", "--bins"]);
        build.env("CARGO_INCREMENTAL", "0").arg("--target-dir").arg(&target);
        output(build.current_dir(root()))?;
        Ok(Self { folder: target.join("debug") })
    }

    /// The path of a program.
    pub(super) fn named(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }
}

/// What a program prints.
pub(super) fn output(command: &mut Command) -> Result<String, FiguresError> {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command.stdin(Stdio::null()).output();
    let output = output.map_err(|source| FiguresError::Run { program: program.clone(), source })?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        // Where others follow from it, the first one says what is wrong.
        let first = said.lines().find(|line| line.starts_with("error"));
        let said = first.or_else(|| said.lines().last()).unwrap_or_default().to_owned();
        return Err(FiguresError::Failed { program, said });
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}
