//! Other programs: compilers, checkers and profilers.

use std::io;
use std::path::Path;
use std::process::{Command, Output};

/// Why a program has no result.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ToolError {
    /// It is not installed.
    #[error("{program} cannot be run; install it (`apt install {package}`)")]
    Missing {
        /// The program.
        program: String,
        /// The package of Debian and Ubuntu that has it.
        package: &'static str,
    },
    /// It failed.
    #[error("{program}: {said}")]
    Failed {
        /// The program.
        program: String,
        /// Its complaint.
        said: String,
    },
    /// A file, or a program that cannot be run.
    #[error("{what}: {source}")]
    Io {
        /// The operation.
        what: String,
        /// The system's error.
        source: io::Error,
    },
}

/// Maximum lines of a complaint.
const MOST_LINES: usize = 5;

/// Runs a program in a folder. Returns its output.
pub(crate) fn output(
    folder: &Path,
    program: &str,
    arguments: &[&str],
) -> Result<Output, ToolError> {
    let path = folder.join(program);
    let mut command =
        if program.contains('/') { Command::new(path) } else { Command::new(program) };
    command.args(arguments).current_dir(folder).output().map_err(|source| {
        if source.kind() == io::ErrorKind::NotFound {
            ToolError::Missing { program: program.to_owned(), package: package(program) }
        } else {
            ToolError::Io { what: format!("cannot run {program}"), source }
        }
    })
}

/// Runs a program that must succeed. Returns its standard output.
pub(crate) fn run(folder: &Path, program: &str, arguments: &[&str]) -> Result<String, ToolError> {
    let output = output(folder, program, arguments)?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let said = String::from_utf8_lossy(&output.stderr);
    let said: Vec<&str> = said.lines().take(MOST_LINES).collect();
    let said = if said.is_empty() { output.status.to_string() } else { said.join("\n") };
    Err(ToolError::Failed { program: program.to_owned(), said })
}

/// The first line that a program prints of its version.
pub(crate) fn version(program: &str) -> Result<String, ToolError> {
    let said = run(Path::new("."), program, &["--version"])?;
    Ok(said.lines().next().unwrap_or_default().to_owned())
}

/// Writes a file and makes its folder.
pub(crate) fn write(folder: &Path, name: &str, text: &str) -> Result<(), ToolError> {
    let path = folder.join(name);
    let made = path.parent().map_or(Ok(()), std::fs::create_dir_all);
    made.and_then(|()| std::fs::write(&path, text)).map_err(|source| ToolError::Io {
        what: format!("cannot write {}", path.display()),
        source,
    })
}

/// A compiler's option for a folder with headers, wherever the compiler is run.
pub(crate) fn include_option(folder: &Path) -> String {
    // A bare file name has no folder.
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    format!("-I{}", folder.display())
}

fn package(program: &str) -> &'static str {
    match program {
        "cppcheck" => "cppcheck",
        "valgrind" => "valgrind",
        _ => "gcc",
    }
}
