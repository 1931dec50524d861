//! Soak test: flights over UDP, as processes, with random faults of the air, signals, floods and closed
//! output. Whatever is done to the pilot process, the drone must come down. This is judged by the mock
//! drone's log, never by the pilot's output.

mod bench;
mod judge;
mod script;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use self::bench::{BenchError, Programs};
use self::judge::Verdict;
use self::script::Script;

/// Arguments of the soak test.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct Arguments {
    /// No flight begins after this many minutes
    #[arg(long, value_name = "N", default_value_t = 60)]
    minutes: u64,
    /// The first seed; each further flight takes the next one
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    first: u64,
    /// Number of flights at a time
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u64).range(1..=64))]
    parallel: u64,
    /// Maximum number of flights
    #[arg(long, value_name = "N")]
    flights: Option<u64>,
    /// Another pilot program, to see whether the judge finds its faults
    #[arg(long, value_name = "PROGRAM")]
    pilot: Option<PathBuf>,
}

/// Flies until the time is over and returns the report; the second value is whether no drone was left in the
/// air.
pub(crate) fn run(arguments: &Arguments) -> Result<(String, bool), BenchError> {
    let programs = Programs::build(arguments.pilot.clone())?;
    let time = Duration::from_mins(arguments.minutes);
    let start = now();
    let next = AtomicU64::new(0);
    let done = Mutex::new(Vec::new());
    let failed = Mutex::new(None);
    std::thread::scope(|scope| {
        for _ in 0..arguments.parallel {
            scope.spawn(|| {
                while start.elapsed() < time && lock(&failed).is_none() {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if arguments.flights.is_some_and(|flights| index >= flights) {
                        break;
                    }
                    let script = Script::new(arguments.first.saturating_add(index));
                    match bench::fly(&programs, &script) {
                        Ok(verdict) => lock(&done).push((script, verdict)),
                        Err(error) => *lock(&failed) = Some(error),
                    }
                }
            });
        }
    });
    if let Some(error) = lock(&failed).take() {
        return Err(error);
    }
    let mut flown = std::mem::take(&mut *lock(&done));
    flown.sort_by_key(|(script, _)| script.seed);
    let good = !flown.is_empty() && flown.iter().all(|(_, verdict)| verdict.faults.is_empty());
    Ok((table(&flown), good))
}

fn table(flown: &[(Script, Verdict)]) -> String {
    let mut rows: BTreeMap<String, Vec<&Verdict>> = BTreeMap::new();
    for (script, verdict) in flown {
        rows.entry(script.end.to_string()).or_default().push(verdict);
        for extra in script.extras() {
            rows.entry(format!("  with {extra}")).or_default().push(verdict);
        }
    }
    let all: Vec<&Verdict> = flown.iter().map(|(_, verdict)| verdict).collect();
    rows.insert("~ all".to_owned(), all);
    let mut text = format!(
        "{:<34}{:>8}{:>8}{:>14}{:>14}{:>8}\n",
        "what was done to the pilot", "flights", "flew", "in the air", "until down", "faults"
    );
    for (name, verdicts) in rows {
        let longest = verdicts.iter().filter_map(|verdict| verdict.until_down).max();
        _ = writeln!(
            text,
            "{:<34}{:>8}{:>8}{:>14}{:>14}{:>8}",
            name.trim_start_matches("~ "),
            verdicts.len(),
            verdicts.iter().filter(|verdict| verdict.flew).count(),
            verdicts.iter().filter(|verdict| verdict.until_down.is_some()).count(),
            longest.map_or("-".to_owned(), |time| format!("{:.1} s", time.as_secs_f64())),
            verdicts.iter().filter(|verdict| !verdict.faults.is_empty()).count(),
        );
    }
    text.push_str(
        "in the air: when the pilot was ordered to end or ended; until down: the longest time from then \
         to the ground\n",
    );
    for (script, verdict) in flown.iter().filter(|(_, verdict)| !verdict.faults.is_empty()) {
        _ = writeln!(text, "seed {}: {}", script.seed, verdict.faults.join("; "));
        _ = writeln!(text, "{script}");
    }
    text
}

/// Processes are watched in real time.
fn now() -> Instant {
    #[allow(clippy::disallowed_methods, reason = "processes are watched in real time")]
    Instant::now()
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}
