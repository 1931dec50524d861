//! Mutants: a judge that detects none of them is worthless.
//!
//! By hand: mistakes that a safety engineer would think of, each built and flown through the fault campaign
//! until a fault is found. All: the mutants that `cargo mutants` generates from the safety-critical code,
//! against the tests in simulated time (`.cargo/mutants.toml`).

pub(crate) mod ablation;
mod fleets;
mod layers;
mod list;
mod workspace;

use std::fmt::Write as _;
use std::io;
use std::path::Path;
use std::process::{Command, Output};

use self::list::{Expected, Mutant};
use self::workspace::Workspace;
use crate::files::{FileError, cannot, target_folder};

/// Why the mutants could not be judged.
#[derive(Debug, thiserror::Error)]
pub(crate) enum MutantsError {
    /// A file or a program.
    #[error(transparent)]
    File(#[from] FileError),
    /// The source has changed since the mutant was written.
    #[error(
        "{name}: the text to be replaced stands {times} times in {file}: the code has changed, mend the mutant"
    )]
    Changed {
        /// The mutant.
        name: &'static str,
        /// The file.
        file: &'static str,
        /// Number of occurrences.
        times: usize,
    },
    /// A mutant that does not build cannot be judged.
    #[error("{name} does not build:\n{text}")]
    Build {
        /// The mutant.
        name: String,
        /// The compiler's output.
        text: String,
    },
    /// A variant that does not fly to the end tells nothing.
    #[error("{name} breaks off: {what}")]
    BreaksOff {
        /// The variant.
        name: String,
        /// What it said.
        what: String,
    },
    /// The unmodified code must pass, or else a failing mutant proves nothing.
    #[error("the code as it is does not pass: {0}")]
    Healthy(String),
    /// No mutant has that name.
    #[error("no mutant has `{0}` in its name")]
    Unknown(String),
    /// `cargo mutants` is not installed.
    #[error("there is no cargo-mutants here: `cargo install cargo-mutants --locked`")]
    NoCargoMutants,
}

/// Result of a mutant.
#[derive(Debug, Clone, PartialEq, Eq)]
enum End {
    /// A fault was found.
    Caught(String),
    /// No fault was found.
    Survived,
}

/// Who flies the mutants, and how many times at most.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Judge {
    /// The example `judge`: the campaign of single flights, and others.
    Flights(u64),
    /// `cargo xtask fleets`.
    Fleets(u64),
}

/// Flies each mutant, or those with `only` in their name, until a fault is found or all were flown. The second value is
/// whether the judge found in each what it must.
pub(crate) fn by_hand(judge: Judge, only: Option<&str>) -> Result<(String, bool), MutantsError> {
    let (mutants, workspace) = match judge {
        Judge::Flights(_) => chosen(all_by_hand(), only)?,
        Judge::Fleets(_) => chosen(fleets::MUTANTS.iter(), only)?,
    };
    if let End::Caught(what) = judged(&workspace, "the code as it is", judge)? {
        return Err(MutantsError::Healthy(what));
    }
    let (Judge::Flights(flights) | Judge::Fleets(flights)) = judge;
    let mut text = String::new();
    let (mut caught, mut covered) = (0, 0);
    let mut broken = None;
    for mutant in &mutants {
        let changed = workspace.changed(mutant)?;
        workspace.put(&changed)?;
        let end = judged(&workspace, mutant.name, judge);
        workspace.restore(&changed)?;
        let outcome = match (end, mutant.expected) {
            (Ok(End::Caught(what)), Expected::Fault) => {
                caught += 1;
                what
            }
            (Ok(End::Survived), Expected::Nothing) => {
                covered += 1;
                "covered by another layer".to_owned()
            }
            (Ok(End::Survived), Expected::Fault) => format!("SURVIVED {flights} flights"),
            (Ok(End::Caught(what)), Expected::Nothing) => format!("NOT COVERED: {what}"),
            // The other mutants are still worth judging.
            (Err(error @ MutantsError::Build { .. }), _) => {
                broken = Some(error);
                "DOES NOT BUILD".to_owned()
            }
            (Err(error), _) => return Err(error),
        };
        // Printed at once, because the whole run takes a while.
        let line = format!("{:<63} {outcome}", mutant.name);
        _ = io::Write::write_all(&mut io::stderr(), format!("{line}\n").as_bytes());
        _ = writeln!(text, "{line}");
    }
    if let Some(error) = broken {
        return Err(error);
    }
    let all = mutants.len();
    _ = writeln!(text, "{caught} of {all} mutants caught, {covered} covered by another layer");
    Ok((text, caught + covered == all))
}

/// The mutants that single flights detect.
fn all_by_hand() -> impl Iterator<Item = &'static Mutant> {
    list::MUTANTS.iter().chain(layers::MUTANTS)
}

/// Builds the workspace and runs the judge on it.
fn judged(workspace: &Workspace, name: &str, judge: Judge) -> Result<End, MutantsError> {
    let (package, program, arguments) = match judge {
        Judge::Flights(flights) => {
            (["system-tests", "--example", "judge"], "examples/judge", vec![flights.to_string()])
        }
        Judge::Fleets(fleets) => {
            let fleets = fleets.to_string();
            let arguments = ["fleets", "--until-bad", "--fleets", &fleets].map(str::to_owned);
            (["xtask", "--bin", "xtask"], "xtask", arguments.to_vec())
        }
    };
    let built = cargo(workspace.root())
        .args(["build", "--locked", "--quiet", "-p"])
        .args(package)
        .env("CARGO_TARGET_DIR", workspace.target())
        // Debug information would only slow the build.
        .env("CARGO_PROFILE_DEV_DEBUG", "false")
        .output()
        .map_err(cannot("run", Path::new("cargo")))?;
    if !built.status.success() {
        let text = String::from_utf8_lossy(&built.stderr).into_owned();
        return Err(MutantsError::Build { name: name.to_owned(), text });
    }
    let judge = workspace.target().join("debug").join(program);
    let judged = Command::new(&judge).args(arguments).output();
    Ok(end(&judged.map_err(cannot("run", &judge))?))
}

/// Evaluates the judge's output; an aborted run has found a fault too.
fn end(output: &Output) -> End {
    let text = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    match output.status.code() {
        Some(0) => End::Survived,
        Some(1) if !text.is_empty() => End::Caught(text),
        _ => {
            let panic = String::from_utf8_lossy(&output.stderr);
            // The panic message is in the line below the thread and the place.
            let what = panic.lines().skip_while(|line| !line.contains("panicked at")).nth(1);
            let what = what.unwrap_or("the judge breaks off");
            End::Caught(format!("{what} ({})", output.status))
        }
    }
}

/// Runs `cargo mutants` as configured in `.cargo/mutants.toml`, on all mutants or on one shard, such as
/// `2/20`. The second value is whether all were caught.
pub(crate) fn all(shard: Option<&str>) -> Result<(String, bool), MutantsError> {
    let there = cargo(Path::new(".")).args(["mutants", "--version"]).output();
    if !there.is_ok_and(|output| output.status.success()) {
        return Err(MutantsError::NoCargoMutants);
    }
    let output = target_folder("mutants");
    std::fs::create_dir_all(&output).map_err(cannot("make", &output))?;
    let status = cargo(Path::new("."))
        .args(["mutants", "--no-times", "--colors", "never", "--output"])
        .arg(&output)
        // Round-robin, so that each shard is a sample of all mutants.
        .args(shard.iter().flat_map(|shard| ["--sharding", "round-robin", "--shard", shard]))
        .status()
        .map_err(cannot("run", Path::new("cargo")))?;
    let lists = output.join("mutants.out");
    Ok((format!("what survived is in {}\n", lists.join("missed.txt").display()), status.success()))
}

fn cargo(folder: &Path) -> Command {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(folder);
    cargo
}

/// Folder in which mutants are built.
/// The mutants that have `only` in their name, and a copy of the workspace that all of them can be made in.
fn chosen<'a, E>(
    mutants: impl Iterator<Item = &'a crate::edit::Mutant<E>>,
    only: Option<&str>,
) -> Result<(Vec<&'a crate::edit::Mutant<E>>, Workspace), MutantsError> {
    let wanted =
        |mutant: &&crate::edit::Mutant<E>| only.is_none_or(|only| mutant.name.contains(only));
    let mutants: Vec<_> = mutants.filter(wanted).collect();
    if mutants.is_empty() {
        return Err(MutantsError::Unknown(only.unwrap_or_default().to_owned()));
    }
    let workspace = Workspace::copy(Path::new("."), &target_folder("mutants"))?;
    for mutant in &mutants {
        workspace.changed(mutant)?;
    }
    Ok((mutants, workspace))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Result of a shell script in place of the judge.
    fn outcome(script: &str) -> End {
        end(&Command::new("sh").args(["-c", script]).output().unwrap())
    }

    #[test]
    fn only_a_judge_that_ends_and_finds_nothing_lets_a_mutant_live() {
        assert_eq!(outcome("echo nothing"), End::Survived);
        let caught = |what: &str| End::Caught(what.to_owned());
        assert_eq!(outcome("echo seed 3: too far; exit 1"), caught("seed 3: too far"));
        let panic = "echo \"thread 'main' panicked at x.rs:1:\nmin > max\" >&2; exit 101";
        assert_eq!(outcome(panic), caught("min > max (exit status: 101)"));
        let killed = outcome("kill -ABRT $$");
        assert!(matches!(&killed, End::Caught(what) if what.contains("breaks off")), "{killed:?}");
    }

    #[test]
    fn the_judge_of_single_flights_is_there() {
        assert!(Path::new("../tests/examples/judge.rs").exists(), "it is built by this name");
    }

    #[test]
    fn each_mutant_can_be_made() {
        let workspace = Workspace::here(Path::new(".."));
        let all = all_by_hand().chain(fleets::MUTANTS);
        let changed: Vec<_> = all.map(|mutant| workspace.changed(mutant)).collect();
        let problems: Vec<String> =
            changed.iter().filter_map(|it| it.as_ref().err()).map(ToString::to_string).collect();
        assert!(problems.is_empty(), "{}", problems.join("\n"));
        for (file, text) in changed.into_iter().flatten().flatten() {
            assert_ne!(text, std::fs::read_to_string(Path::new("..").join(file)).unwrap());
        }
    }
}
