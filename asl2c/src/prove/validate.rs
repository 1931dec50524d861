//! Proves that an agent's C does what a second, plain translation of the same text does.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use translator::configuration::Configuration;
use translator::{COMPARISON, Comparison, ENOUGH_ROOM, ONLY_END, ONLY_ROOM, ROOM};

use super::cbmc::{Cbmc, Failure};
use super::trace::Way;
use super::{ProveError, in_file, write};

/// First limit of the calls in a step, and the last one that is tried.
const ROOMS: std::ops::RangeInclusive<u32> = 2..=1024;

/// Function that only asserts that no state is left out.
const COVER: &str = "plain_cover";
/// Description of a function whose end is never reached.
const ENDLESS: &str = "it does not come to an end";

/// Result of a comparison.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Validated {
    /// Number of proofs: the start, the calls of the environment, and each kind of step.
    pub proofs: usize,
    /// What differs, by CBMC's description; empty if the C is proved.
    pub open: Vec<String>,
    /// Proofs that reached the time limit; none if there is a difference, which ends the others.
    pub timeouts: usize,
    /// The largest number of calls in a step that had to be compared, rounded up to a power of two.
    pub calls: u32,
}

impl Validated {
    /// Whether something was done differently: a way to it may be found. What never ends is not.
    pub(crate) fn differs(&self) -> bool {
        self.open.iter().any(|said| is_difference(said))
    }

    /// Whether the C does what the agent says, in every environment and for any number of steps.
    pub fn is_proved(&self) -> bool {
        self.open.is_empty() && self.timeouts == 0
    }
}

/// An execution from the start in which the C does not do what the agent says.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Difference {
    /// What differs, at its end.
    pub said: String,
    pub(crate) way: Way,
}

impl Difference {
    /// The lines of a script for `asl2c run`.
    pub fn lines(&self) -> impl Iterator<Item = String> {
        self.way.lines()
    }
}

/// Proves the comparison, with `include` as a folder of the environment's own headers. Creates `folder` for the
/// generated files. Each proof has a limited time. Ends with the first difference.
///
/// # Errors
/// If a file cannot be written, or CBMC gives no result: C that cannot be compiled, for example.
pub fn validate(
    comparison: &Comparison,
    cbmc: &Cbmc,
    folder: &Path,
    include: &Path,
    time: Duration,
) -> Result<Validated, ProveError> {
    std::fs::create_dir_all(folder).map_err(in_file("cannot make", folder))?;
    comparison.files.iter().try_for_each(|file| write(folder, &file.name, &file.text))?;
    let steps = (0..comparison.steps).map(|step| format!("plain_case_{step}"));
    let functions =
        ["plain_base", COVER, "plain_interface"].map(str::to_owned).into_iter().chain(steps);
    let functions: Vec<String> = functions.collect();
    let next = AtomicUsize::new(0);
    let different = AtomicBool::new(false);
    let results = Mutex::new(Vec::new());
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..workers.min(functions.len()) {
            scope.spawn(|| {
                while let Some(function) = functions.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let until = Instant::now() + time;
                    // What follows a difference tells no more, and may take long.
                    let give_up = || different.load(Ordering::Relaxed) || Instant::now() >= until;
                    let result = prove(comparison, cbmc, folder, include, function, give_up);
                    if let Ok(Some((failures, _))) = &result
                        && failures.iter().any(|failure| is_difference(&failure.said))
                    {
                        different.store(true, Ordering::Relaxed);
                    }
                    if let Ok(mut results) = results.lock() {
                        results.push(result);
                    }
                }
            });
        }
    });
    let results = results.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    let mut validated =
        Validated { proofs: functions.len(), open: Vec::new(), timeouts: 0, calls: 0 };
    for result in results {
        match result? {
            Some((failures, calls)) => {
                validated.calls = validated.calls.max(calls);
                validated.open.extend(failures.into_iter().map(|failure| failure.said));
            }
            None => validated.timeouts += 1,
        }
    }
    if validated.differs() {
        // They were given up.
        validated.timeouts = 0;
    }
    validated.open.sort();
    validated.open.dedup();
    Ok(validated)
}

/// Whether a failure tells of something done differently, and not of a bound.
fn is_difference(said: &str) -> bool {
    said != ENDLESS && said != ENOUGH_ROOM && !said.starts_with("unwinding assertion")
}

/// Proves one function; with as much room for calls as it needs. `None` if it was given up.
fn prove(
    comparison: &Comparison,
    cbmc: &Cbmc,
    folder: &Path,
    include: &Path,
    function: &str,
    give_up: impl Fn() -> bool,
) -> Result<Option<(Vec<Failure>, u32)>, ProveError> {
    let run = |room: u32, more: &[&str]| {
        let mut arguments = arguments(comparison, include, room);
        // The relation does not know other variables than those of the state, and a loop that never ends must not be
        // taken for one that is never entered.
        arguments.extend(["--nondet-static", "--no-self-loops-to-assumptions"].map(str::to_owned));
        arguments.extend(more.iter().copied().map(str::to_owned));
        cbmc.failures(folder, (COMPARISON, function), &arguments, &give_up)
    };
    let only = |asked: &str, room: u32| {
        let define = format!("-D{asked}");
        run(
            room,
            &["--no-standard-checks", "--no-unwinding-assertions", "--slice-formula", &define],
        )
    };
    let mut room = *ROOMS.start();
    // A bound of the loops may be reached here, and more room be needed than is found.
    while room < *ROOMS.end() {
        let Some(found) = only(ONLY_ROOM, room)? else { return Ok(None) };
        if found.is_empty() {
            break;
        }
        room *= 2;
    }
    let Some(mut found) = run(room, &[])? else { return Ok(None) };
    if function != COVER && found.is_empty() {
        let Some(reached) = only(ONLY_END, room)? else { return Ok(None) };
        if reached.is_empty() {
            found.push(Failure { name: function.to_owned(), said: ENDLESS.to_owned() });
        }
    }
    Ok(Some((found, room)))
}

fn arguments(comparison: &Comparison, include: &Path, room: u32) -> Vec<String> {
    // Made absolute, because CBMC is run in another folder. A bare file name has no folder.
    let include = if include.as_os_str().is_empty() { Path::new(".") } else { include };
    let include = std::path::absolute(include).unwrap_or_else(|_| include.to_owned());
    vec![
        format!("-D{ROOM}={room}"),
        format!("-I{}", include.display()),
        "--unwind".to_owned(),
        comparison.unwinding.to_string(),
    ]
}

/// Searches for the shortest execution from the start in which the two differ, of at most this number of
/// events, beliefs and steps; [`validate`] has written the files. `None` if there is none, or not in time.
///
/// # Errors
/// If CBMC gives no result.
pub(crate) fn difference(
    comparison: &Comparison,
    configuration: &Configuration,
    cbmc: &Cbmc,
    (folder, include): (&Path, &Path),
    calls: u32,
    limits: super::Limits,
) -> Result<Option<Difference>, ProveError> {
    let until = Instant::now() + limits.time;
    for length in 1..=limits.transitions {
        let mut arguments = arguments(comparison, include, calls.max(*ROOMS.start()));
        // One more than the number of rounds: the last one only leaves the loop.
        arguments.extend(["--unwindset".to_owned(), format!("main.0:{}", length + 1)]);
        arguments.push("--no-unwinding-assertions".to_owned());
        let Some(traces) = cbmc.traces(folder, (COMPARISON, "main"), &arguments, until)? else {
            return Ok(None);
        };
        for trace in traces {
            if let Some(way) = Way::new(&trace, configuration) {
                return Ok(Some(Difference { said: trace.said.clone(), way }));
            }
        }
    }
    Ok(None)
}
