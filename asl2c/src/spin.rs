//! Checks a model with SPIN: one exhaustive search for each property.

use std::hash::{BuildHasher as _, RandomState};
use std::path::Path;
use std::process::{Command, Output};

use translator::{CounterexampleStep, DeclaredProperty, Model, Move};

/// The model checker.
pub const SPIN: &str = "spin";

/// The shortest way to the violation of a property.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Counterexample {
    /// In the agents' terms.
    pub steps: Vec<CounterexampleStep>,
    /// Of a system: what happens, for those who repeat it.
    pub moves: Vec<Move>,
}

/// Result of an exhaustive search.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Verdict {
    /// The property holds in every environment.
    Holds,
    /// The property fails: the shortest counterexample.
    Fails(Counterexample),
    /// The search did not finish, with the reason.
    Undecided(String),
}

impl Verdict {
    /// Whether the property holds in every environment.
    pub fn is_proved(&self) -> bool {
        matches!(self, Self::Holds)
    }

    /// Whether there is an environment in which it fails.
    pub fn is_refuted(&self) -> bool {
        matches!(self, Self::Fails(_))
    }

    /// The shortest counterexample; empty unless the property fails.
    pub fn counterexample(&self) -> &[CounterexampleStep] {
        match self {
            Self::Fails(way) => &way.steps,
            Self::Holds | Self::Undecided(_) => &[],
        }
    }
}

/// Errors that prevent a check.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SpinError {
    /// A search does not find what every agent does.
    #[error(
        "nothing is checked: the search that `{SPIN}` and `cc` make does not refute a property that is false; reinstall them"
    )]
    Untrusted,
    /// A program cannot be run.
    #[error("cannot run `{program}`: {source}; `apt install spin gcc` may help")]
    Missing {
        /// Its name.
        program: &'static str,
        /// The system's error.
        source: std::io::Error,
    },
    /// The model cannot be written.
    #[error("cannot write the model: {0}")]
    Write(#[source] std::io::Error),
    /// A program rejects its input.
    #[error("`{program}` rejects the generated model:\n{output}")]
    Refused {
        /// Its name.
        program: &'static str,
        /// Its output.
        output: String,
    },
}

/// Memory limit of a search.
const MEGABYTES: u32 = 2048;

/// Checks properties in every environment: all, or those with these numbers, from 1.
pub(crate) fn check(
    model: &Model,
    numbers: &[usize],
) -> Result<Vec<(DeclaredProperty, Verdict)>, SpinError> {
    let folder = tempfile::tempdir().map_err(SpinError::Write)?;
    let folder = folder.path();
    let key = prepare(model, folder, Compiler::for_searches(numbers.len()))?;
    let run =
        |number, search: &Search, option: &str| run(model, folder, number ^ key, search, option);
    // A tool that proves a known falsehood proves nothing.
    if !matches!(result(&run(model.falsehood(), &IN_DEPTH, DEPTH)?), Found::Failure) {
        return Err(SpinError::Untrusted);
    }
    let searched = in_parallel(numbers, |number| run(number, &IN_DEPTH, DEPTH));
    let searched = searched.into_iter().map(|said| Ok(result(&said?)));
    let searched = searched.collect::<Result<Vec<Found>, SpinError>>()?;
    if searched.iter().any(|found| matches!(found, Found::Failure)) {
        compile(folder, &IN_BREADTH, Compiler::Fast)?;
    }
    let verdicts = numbers.iter().zip(searched);
    verdicts
        .map(|(number, found)| {
            let property = &model.properties[number - 1];
            let verdict = match found {
                Found::Nothing => Verdict::Holds,
                Found::NoEnd(said) => Verdict::Undecided(said),
                Found::Failure => {
                    run(*number, &IN_BREADTH, DEPTH)?;
                    let replay = run(*number, &IN_BREADTH, "-r")?;
                    let (steps, moves) = (model.explain(&replay), model.moves(&replay));
                    Verdict::Fails(Counterexample { steps, moves })
                }
            };
            Ok((property.clone(), verdict))
        })
        .collect()
}

/// Whether a search finds a counterexample to the property with this number, which is not shown.
pub(crate) fn is_refuted(model: &Model, number: usize) -> Result<bool, SpinError> {
    let folder = tempfile::tempdir().map_err(SpinError::Write)?;
    let folder = folder.path();
    let key = prepare(model, folder, Compiler::Fast)?;
    Ok(matches!(result(&run(model, folder, number ^ key, &IN_DEPTH, DEPTH)?), Found::Failure))
}

/// Writes and compiles a model's search in depth. Returns the key by which numbers of properties are hidden: it differs
/// each time, and only who reads the model knows which is searched.
fn prepare(model: &Model, folder: &Path, compiler: Compiler) -> Result<usize, SpinError> {
    const KEYS: u64 = 0x4000;
    let key = RandomState::new().hash_one(folder) % KEYS;
    let text = model.promela().replacen("atoi(", &format!("{key} ^ atoi("), 1);
    std::fs::write(folder.join("model.pml"), text).map_err(SpinError::Write)?;
    let mut spin = Command::new(SPIN);
    succeed(SPIN, spin.args(["-a", "model.pml"]).current_dir(folder))?;
    compile(folder, &IN_DEPTH, compiler)?;
    Ok(usize::try_from(key).unwrap_or_default())
}

fn compile(folder: &Path, search: &Search, compiler: Compiler) -> Result<(), SpinError> {
    let memory = format!("-DMEMLIM={MEGABYTES}");
    let mut program = Command::new("cc");
    program.args([compiler.option(), "-w", "-DSAFETY", &memory]).args(search.options);
    succeed("cc", program.args(["-o", search.program, "pan.c"]).current_dir(folder))
}

/// What is saved: time of the compiler, or of the searches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Compiler {
    /// Optimising takes longer than most searches.
    Fast,
    /// .. but not longer than many.
    Optimising,
}

impl Compiler {
    fn for_searches(count: usize) -> Self {
        const MANY: usize = 8;
        if count > MANY { Self::Optimising } else { Self::Fast }
    }

    fn option(self) -> &'static str {
        match self {
            Self::Fast => "-O0",
            Self::Optimising => "-O2",
        }
    }
}

/// Checks one property. Each has its own folder, in which the counterexample is stored.
fn run(
    model: &Model,
    folder: &Path,
    number: usize,
    search: &Search,
    option: &str,
) -> Result<String, SpinError> {
    let own = folder.join(number.to_string());
    std::fs::create_dir_all(&own).map_err(SpinError::Write)?;
    let mut program = Command::new(folder.join(search.program));
    program.arg(option).env(model.selector(), number.to_string()).current_dir(own);
    let output = output("pan", &mut program)?;
    if output.status.code().is_none() {
        // A signal ended it: what it printed before is no result.
        return Err(SpinError::Refused { program: "pan", output: output.status.to_string() });
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Maps the inputs on all cores; the results are in the order of the inputs.
fn in_parallel<T: Copy + Sync, R: Send>(inputs: &[T], work: impl Fn(T) -> R + Sync) -> Vec<R> {
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get);
    let share = inputs.len().div_ceil(cores).max(1);
    std::thread::scope(|scope| {
        let work = &work;
        let threads: Vec<_> = inputs
            .chunks(share)
            .map(|chunk| {
                scope.spawn(move || chunk.iter().map(|input| work(*input)).collect::<Vec<R>>())
            })
            .collect();
        threads
            .into_iter()
            .flat_map(|thread| {
                thread.join().expect("a search waits for a program and does not panic")
            })
            .collect()
    })
}

/// A search strategy.
struct Search {
    program: &'static str,
    options: &'static [&'static str],
}

/// Fast.
const IN_DEPTH: Search = Search { program: "pan", options: &[] };
/// Finds the shortest counterexample.
const IN_BREADTH: Search = Search { program: "pan_breadth", options: &["-DBFS"] };
/// Depth limit; a search that exceeds it is undecided.
const DEPTH: &str = "-m2000000";

enum Found {
    Nothing,
    Failure,
    NoEnd(String),
}

/// Parses the output of a search. Only a finished search without errors is a proof.
fn result(text: &str) -> Found {
    if text.contains("assertion violated") {
        return Found::Failure;
    }
    let unfinished = ["Search not completed", "out of memory", "max search depth too small"];
    if text.contains("errors: 0") && !unfinished.iter().any(|words| text.contains(words)) {
        return Found::Nothing;
    }
    let lines: Vec<&str> = text.lines().filter(|line| !line.trim().is_empty()).collect();
    Found::NoEnd(lines[..lines.len().min(5)].join("\n"))
}

fn succeed(program: &'static str, command: &mut Command) -> Result<(), SpinError> {
    let output = output(program, command)?;
    if output.status.success() {
        return Ok(());
    }
    let said = [output.stdout, output.stderr].concat();
    Err(SpinError::Refused { program, output: String::from_utf8_lossy(&said).into_owned() })
}

fn output(program: &'static str, command: &mut Command) -> Result<Output, SpinError> {
    command.output().map_err(|source| SpinError::Missing { program, source })
}
