//! Other programs: compilers, checkers and profilers.

use std::fs::File;
use std::io::{self, Read as _, Seek as _};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

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
    /// It did not end.
    #[error("{program} did not end in {seconds} s, and was ended")]
    Endless {
        /// The program.
        program: String,
        /// Its time limit.
        seconds: u64,
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

/// How long a program may run.
const MOST_SECONDS: u64 = 600;
/// How long a processor may run an agent's steps. They end, but their length doubles with each level of goals. The time of a
/// clock would say as much of what else the machine does.
const MOST_SECONDS_OF_STEPS: u64 = 30;
/// Units in which Linux tells processor time (`proc_pid_stat(5)`; `USER_HZ` is 100 on all machines that Rust runs on).
const UNITS_PER_S: u64 = 100;

/// Runs a program in a folder. Returns its output.
#[allow(clippy::disallowed_methods, reason = "other programs get a limited time")]
pub(crate) fn output(
    folder: &Path,
    program: &str,
    arguments: &[&str],
) -> Result<Output, ToolError> {
    let path = folder.join(program);
    let mut command =
        if program.contains('/') { Command::new(path) } else { Command::new(program) };
    // Somebody may count what other programs execute: the counts of this one are looked for beside it.
    command.env_remove("GCOV_PREFIX").env_remove("GCOV_PREFIX_STRIP");
    let failed = |source: io::Error| {
        if source.kind() == io::ErrorKind::NotFound {
            ToolError::Missing { program: program.to_owned(), package: package(program) }
        } else {
            ToolError::Io { what: format!("cannot run {program}"), source }
        }
    };
    command.args(arguments).current_dir(folder);
    // Some read there which folder it is.
    if let Ok(absolute) = folder.canonicalize() {
        command.env("PWD", absolute);
    }
    let runs_steps = program == "valgrind" || program.starts_with("./");
    let seconds = if runs_steps { MOST_SECONDS_OF_STEPS } else { MOST_SECONDS };
    let begun = Instant::now();
    let late = |process| {
        let lasts = begun.elapsed();
        // What waits without working ends, too.
        let is_endless = lasts >= Duration::from_secs(MOST_SECONDS);
        let worked = || processor_time(process).filter(|_| runs_steps).unwrap_or(lasts);
        is_endless
            || lasts >= Duration::from_secs(seconds) && worked() >= Duration::from_secs(seconds)
    };
    let finished = finished(&mut command, late).map_err(failed)?;
    finished.ok_or_else(|| ToolError::Endless { program: program.to_owned(), seconds })
}

/// How long processors have worked for a process that still runs; `None` where the system does not tell.
fn processor_time(process: u32) -> Option<Duration> {
    let told = std::fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // Its name comes first, in parentheses, and may be anything.
    let (_, behind) = told.rsplit_once(')')?;
    let mut numbers = behind.split_whitespace().skip(11).map(str::parse::<u64>);
    let (user, system) = (numbers.next()?.ok()?, numbers.next()?.ok()?);
    Some(Duration::from_millis((user + system) * (1000 / UNITS_PER_S)))
}

/// What a program printed until its end; `None` if it was given up, and ended. What gives up is told the process.
#[allow(clippy::disallowed_methods, reason = "other programs are waited for")]
pub(crate) fn finished(
    command: &mut Command,
    give_up: impl Fn(u32) -> bool,
) -> io::Result<Option<Output>> {
    // Files, because the output may exceed the capacity of a pipe while the process is waited for.
    let (mut said, mut errors) = (tempfile::tempfile()?, tempfile::tempfile()?);
    command.stdin(Stdio::null()).stdout(said.try_clone()?).stderr(errors.try_clone()?);
    // Compilers would look there for headers, before the folders that they are told of.
    command.env_remove("CPATH").env_remove("C_INCLUDE_PATH");
    let mut child = command.spawn()?;
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if give_up(child.id()) {
            // It may have ended already.
            _ = child.kill();
            child.wait()?;
            return Ok(None);
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    Ok(Some(Output { status, stdout: whole(&mut said)?, stderr: whole(&mut errors)? }))
}

/// All bytes of a file.
fn whole(file: &mut File) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.rewind()?;
    file.read_to_end(&mut bytes)?;
    Ok(bytes)
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

fn package(program: &str) -> &'static str {
    match program {
        "cppcheck" => "cppcheck",
        "frama-c" => "frama-c-base",
        "valgrind" => "valgrind",
        _ => "gcc",
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn a_process_is_timed_by_what_processors_work_for_it() {
        let worked = || processor_time(std::process::id()).unwrap();
        let before = worked();
        let mut number = 1_u32;
        let mut is_seen = || {
            for _ in 0..10_000_000 {
                number = std::hint::black_box(number.wrapping_mul(3));
            }
            worked() >= before + Duration::from_millis(200)
        };
        assert!((0..1000).any(|_| is_seen()));
        let mut sleeps = Command::new("sleep").arg("60").spawn().unwrap();
        assert!(processor_time(sleeps.id()).unwrap() < Duration::from_secs(1));
        sleeps.kill().unwrap();
        sleeps.wait().unwrap();
        assert_eq!(processor_time(sleeps.id()), None);
    }
}
