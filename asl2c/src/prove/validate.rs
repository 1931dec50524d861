//! Proves that an agent's C does what a second, plain translation of the same text does.

use std::fmt;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use translator::configuration::Configuration;
use translator::{ANY_FLOATS, COMPARISON, Comparison, END, ENOUGH_ROOM, ROOM};

use super::cbmc::{Cbmc, Failure};
use super::goals::Place;
use super::trace::Way;
use super::watch::{Budget, End, Part, Watch};
use super::{ProveError, in_file, write};

/// First limit of the answers to one action in a step, and the last one that is tried.
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
    /// What is not proved; empty if the C is proved.
    pub open: Vec<Open>,
    /// Proofs that reached a time limit or were stopped; none if there is a difference, which ends the others.
    pub timeouts: usize,
    /// The largest number of answers of one action in a step that had to be compared, rounded up to a power of two.
    pub calls: u32,
}

/// Something that is not proved.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[non_exhaustive]
pub struct Open {
    /// Where: in the start, a call of the environment, or the step that handles an event.
    pub part: String,
    /// What differs, by CBMC's description.
    pub said: String,
}

impl fmt::Display for Open {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.part, self.said)
    }
}

impl Validated {
    /// Whether something was done differently: a way to it may be found. What never ends is not.
    pub(crate) fn differs(&self) -> bool {
        self.open.iter().any(|open| is_difference(&open.said))
    }

    /// Whether the C does what the agent says, in every environment and for any number of steps.
    pub fn is_proved(&self) -> bool {
        self.open.is_empty() && self.timeouts == 0
    }
}

/// An execution from the start in which the C does not do what the agent says.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Difference {
    /// What differs, at its end.
    pub said: String,
    /// The lines of a script for `asl2c run`.
    pub lines: Vec<String>,
}

/// Proves the comparison, whose files are all that is read, but for headers of the compiler. Creates `folder` for them.
/// Each proof has a limited time. Ends with the first difference.
///
/// # Errors
/// As [`prove`](crate::prove()).
pub fn validate(
    comparison: &Comparison,
    cbmc: &Cbmc,
    folder: &Path,
    time: Duration,
) -> Result<Validated, ProveError> {
    validate_watched(comparison, cbmc, folder, Budget::begin(time, None), &())
}

/// As [`validate`], with a limit for all proofs together, and somebody who follows them and may stop them.
///
/// # Errors
/// As [`validate`].
pub fn validate_watched(
    comparison: &Comparison,
    cbmc: &Cbmc,
    folder: &Path,
    budget: Budget,
    watch: &dyn Watch,
) -> Result<Validated, ProveError> {
    write_comparison(comparison, folder)?;
    let parts = parts(comparison);
    let next = AtomicUsize::new(0);
    let different = AtomicBool::new(false);
    let results = Mutex::new(Vec::new());
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..workers.min(parts.len()) {
            scope.spawn(|| {
                while let Some((function, part)) = parts.get(next.fetch_add(1, Ordering::Relaxed)) {
                    // What follows a difference tells no more, and may take long.
                    let needless = || different.load(Ordering::Relaxed);
                    let result = if needless() || watch.stops() || budget.is_over() {
                        Ok(None)
                    } else {
                        let begun = Instant::now();
                        watch.begins(part);
                        let late = budget.late(watch);
                        let give_up = || needless() || late();
                        let result = prove(comparison, cbmc, folder, function, give_up);
                        watch.ends(part, end(&result), begun.elapsed());
                        result
                    };
                    if let Ok(Some((failures, _))) = &result
                        && failures.iter().any(|failure| is_difference(&failure.said))
                    {
                        different.store(true, Ordering::Relaxed);
                    }
                    if let Ok(mut results) = results.lock() {
                        results.push((part, result));
                    }
                }
            });
        }
    });
    let results = results.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    let mut validated = Validated { proofs: parts.len(), open: Vec::new(), timeouts: 0, calls: 0 };
    for (part, result) in results {
        match result {
            Ok(Some((failures, calls))) => {
                validated.calls = validated.calls.max(calls);
                let open = |failure: Failure| Open { part: part.what.clone(), said: said(failure) };
                validated.open.extend(failures.into_iter().map(open));
            }
            Ok(None) => validated.timeouts += 1,
            // A terminal interrupts CBMC too, which then says nothing.
            Err(ProveError::NoResult { .. }) if watch.stops() => validated.timeouts += 1,
            Err(error) => return Err(error),
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

/// Writes the files of a comparison into a folder, which it makes.
pub(crate) fn write_comparison(comparison: &Comparison, folder: &Path) -> Result<(), ProveError> {
    std::fs::create_dir_all(folder).map_err(in_file("cannot make", folder))?;
    comparison.files.iter().try_for_each(|file| write(folder, &file.name, &file.text))
}

/// The functions to prove.
fn parts(comparison: &Comparison) -> Vec<(String, Part)> {
    let others = [("plain_base", "the start"), (COVER, "all steps are proved")];
    let others = others.into_iter().chain([("plain_interface", "calls of the environment")]);
    let others = others.map(|(function, what)| (function.to_owned(), what.to_owned()));
    let steps = comparison.cases.iter().enumerate();
    let steps = steps.map(|(step, case)| (format!("plain_case_{step}"), format!("step: {case}")));
    let functions: Vec<(String, String)> = others.chain(steps).collect();
    let of = functions.len();
    let parts = functions.into_iter().enumerate();
    parts.map(|(number, (function, what))| (function, Part { number, of, what })).collect()
}

fn end(result: &Result<Option<(Vec<Failure>, u32)>, ProveError>) -> End {
    match result {
        Ok(Some((failures, _))) if failures.is_empty() => End::Proved,
        Ok(Some(_)) => End::Open,
        Ok(None) | Err(_) => End::GivenUp,
    }
}

/// Whether a failure tells of something done differently, and not of a bound.
fn is_difference(said: &str) -> bool {
    said != ENDLESS && said != ENOUGH_ROOM && !said.starts_with("unwinding assertion")
}

/// What is not proved. CBMC words its own checks as if everybody knew that they are about errors.
fn said(failure: Failure) -> String {
    if is_difference(&failure.said) && !failure.is_asserted() {
        format!("a possible error at run time: {}", failure.said)
    } else {
        failure.said
    }
}

/// Proves one function; with as much room for calls as it needs. `None` if it was given up.
fn prove(
    comparison: &Comparison,
    cbmc: &Cbmc,
    folder: &Path,
    function: &str,
    give_up: impl Fn() -> bool,
) -> Result<Option<(Vec<Failure>, u32)>, ProveError> {
    let run = |room: u32, more: &[&str], goals| {
        let mut arguments = arguments(comparison, room);
        // The relation does not know other variables than those of the state, and a loop that never ends must not be
        // taken for one that is never entered.
        arguments.extend(
            ["--nondet-static", "--no-self-loops-to-assumptions", "--slice-formula"]
                .map(str::to_owned),
        );
        arguments.extend(more.iter().copied().map(str::to_owned));
        cbmc.failures(folder, (COMPARISON, function), &arguments, goals, &give_up)
    };
    let any_floats = format!("-D{ANY_FLOATS}");
    let mut room = *ROOMS.start();
    let mut found = loop {
        let Some(found) = run(room, &[&any_floats], Place::Before)? else { return Ok(None) };
        if room >= *ROOMS.end() || !found.iter().any(|failure| failure.said == ENOUGH_ROOM) {
            break found;
        }
        room *= 2;
    };
    let is_end = |failure: &Failure| failure.said == END;
    let comes_to_end = function == COVER || found.iter().any(is_end);
    found.retain(|failure| !is_end(failure));
    if !found.is_empty() && comparison.computes_floats {
        // What differs may differ for results that no operation has. That it does not is asked of all assertions.
        let again = if found.iter().all(Failure::is_asserted) {
            let names = found.iter().flat_map(|failure| ["--property", &failure.name]);
            run(room, &names.collect::<Vec<_>>(), Place::Nowhere)?
        } else {
            Some(Vec::new())
        };
        let Some(again) = again else { return Ok(None) };
        found = again;
        if found.is_empty() {
            let Some(exact) = run(room, &[], Place::Before)? else { return Ok(None) };
            found = exact;
            found.retain(|failure| !is_end(failure));
        }
    }
    if found.is_empty() && !comes_to_end {
        found.push(Failure { name: function.to_owned(), said: ENDLESS.to_owned() });
    }
    Ok(Some((found, room)))
}

fn arguments(comparison: &Comparison, room: u32) -> Vec<String> {
    vec![format!("-D{ROOM}={room}"), "--unwind".to_owned(), comparison.unwinding.to_string()]
}

/// Result of the search for an execution in which the two differ.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct SearchedWay {
    /// The shortest one, if it was found.
    pub(crate) difference: Option<Difference>,
    /// There is none with at most this number of events, beliefs and steps.
    pub(crate) none: u32,
}

/// Searches for the shortest execution from the start in which the two differ, of at most this `length` in events,
/// beliefs and steps, whose files are written. It is told as `what`.
///
/// # Errors
/// If CBMC gives no result.
pub(crate) fn difference(
    comparison: &Comparison,
    configuration: &Configuration,
    cbmc: &Cbmc,
    folder: &Path,
    ((calls, length), what): ((u32, u32), &str),
    (budget, watch): (Budget, &dyn Watch),
) -> Result<SearchedWay, ProveError> {
    let late = budget.late(watch);
    let of = length as usize;
    for length in 1..=length {
        let what = format!("{what}: not within {}", length - 1);
        let part = Part { number: length as usize - 1, of, what };
        watch.begins(&part);
        let begun = Instant::now();
        let mut arguments = arguments(comparison, calls.max(*ROOMS.start()));
        // One more than the number of rounds: the last one only leaves the loop.
        arguments.extend(["--unwindset".to_owned(), format!("main.0:{}", length + 1)]);
        arguments.push("--no-unwinding-assertions".to_owned());
        let found = cbmc.traces(folder, (COMPARISON, "main"), &arguments, &late);
        let found = if watch.stops() { Ok(None) } else { found };
        let end = match &found {
            Ok(Some(traces)) if traces.is_empty() => End::Proved,
            Ok(Some(_)) => End::Open,
            Ok(None) | Err(_) => End::GivenUp,
        };
        watch.ends(&part, end, begun.elapsed());
        let Some(traces) = found? else {
            return Ok(SearchedWay { difference: None, none: length - 1 });
        };
        for trace in traces {
            if let Some(way) = Way::new(&trace, configuration) {
                let lines = way.lines().collect();
                let said = said(Failure { name: trace.name, said: trace.said });
                let difference = Some(Difference { said, lines });
                return Ok(SearchedWay { difference, none: length - 1 });
            }
        }
    }
    Ok(SearchedWay { difference: None, none: length })
}
