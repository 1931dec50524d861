//! Flies the fault campaign, then landings with gaps and other orders around them, then streams of orders, then flights in which a
//! single rule keeps the drone safe, then one wrong sensor at a time, until a fault is found:
//! `cargo run -p system-tests --example judge -- 1000`.
//!
//! `cargo xtask mutants` runs it on code with a mistake in it. The first fault is printed with its seed, and
//! the exit status is 1; it is 0 if no fault was found. Too few completed plans are a fault too: a drone that
//! never flies does no harm, and a judge that accepts it would accept any mistake.
#![allow(clippy::print_stdout, reason = "it prints what it finds")]

use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use autopilot::outcome::Outcome;
use system_tests::airframes::AIRFRAMES;
use system_tests::sensors::{self, led_astray};
use system_tests::sim::SimulationError;
use system_tests::{campaign, landings, rules, streams};

/// At least one of this many flights of the campaign must complete its plan; of the unmodified code, two of
/// five do.
const ONE_OF: u64 = 5;

/// Seeds to be flown, and the lowest with a fault.
struct Hunt {
    next: AtomicU64,
    last: AtomicU64,
    /// Number of completed plans.
    completed: AtomicU64,
}

impl Hunt {
    /// Flies seeds until there are none left below the lowest with a fault; returns the last fault found.
    fn fly(&self) -> Option<(u64, String)> {
        let mut found = None;
        loop {
            let seed = self.next.fetch_add(1, Ordering::Relaxed);
            if seed > self.last.load(Ordering::Relaxed) {
                return found;
            }
            if let Some(fault) = self.fault(seed) {
                self.last.fetch_min(seed, Ordering::Relaxed);
                found = Some((seed, fault));
            }
        }
    }

    /// The fault of a seed's flight, if any.
    fn fault(&self, seed: u64) -> Option<String> {
        match campaign::fly(seed) {
            Ok(verdict) => {
                let completed = verdict.outcome == Outcome::Completed;
                self.completed.fetch_add(completed.into(), Ordering::Relaxed);
                verdict.faults.first().map(|(_, fault)| fault.to_string())
            }
            Err(error) => Some(error.to_string()),
        }
    }
}

/// The first sensor failure that led a drone too far.
fn astray() -> Option<String> {
    const SEED: u64 = 1;
    let flown = thread::scope(|scope| {
        let threads = AIRFRAMES.map(|airframe| scope.spawn(move || led_astray(airframe, SEED)));
        let flown = threads
            .into_iter()
            .map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        flown.collect::<Result<Vec<_>, SimulationError>>()
    });
    match flown {
        Ok(found) => found.into_iter().flatten().next().or_else(randomly_astray),
        Err(error) => Some(error.to_string()),
    }
}

/// The first random sensor failure that led a drone too far.
fn randomly_astray() -> Option<String> {
    const LAST: u64 = 200;
    (1..=LAST).find_map(|number| match sensors::random(number) {
        Ok(flight) => (flight.shows && flight.is_too_far()).then(|| flight.to_string()),
        Err(error) => Some(error.to_string()),
    })
}

/// The first landing that was not carried out, or the reason why none could be judged.
fn forgotten() -> Option<String> {
    match landings::forgotten() {
        Ok(found) => found.into_iter().next(),
        Err(error) => Some(error.to_string()),
    }
}

/// The first flight in which a rule was missing, or the reason why none could be judged.
fn unruly() -> Option<String> {
    match rules::broken() {
        Ok(found) => found.into_iter().next(),
        Err(error) => Some(error.to_string()),
    }
}

/// The first stream of orders that led too far.
fn streamed() -> Option<String> {
    const LAST: u64 = 60;
    (1..=LAST).find_map(|seed| match streams::fly(seed) {
        Ok(flown) => flown.is_bad().then(|| flown.to_string()),
        Err(error) => Some(error.to_string()),
    })
}

fn main() -> ExitCode {
    let Some(flights) = std::env::args().nth(1).and_then(|word| word.parse().ok()) else {
        println!("usage: judge FLIGHTS");
        return ExitCode::from(2);
    };
    let (next, last, completed) = (AtomicU64::new(1), AtomicU64::new(flights), AtomicU64::new(0));
    let hunt = Hunt { next, last, completed };
    let found = thread::scope(|scope| {
        let cores = thread::available_parallelism().map_or(1, usize::from);
        let threads: Vec<_> = (0..cores).map(|_| scope.spawn(|| hunt.fly())).collect();
        // A flight that panics is a fault: its thread passes the panic on, which ends the process.
        let ends = threads
            .into_iter()
            .map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        ends.flatten().min()
    });
    let completed = hunt.completed.into_inner();
    let text = match found {
        Some((seed, fault)) => format!("seed {seed}: {fault}"),
        None if completed < flights / ONE_OF => {
            format!("only {completed} of {flights} plans were flown to their end")
        }
        None => {
            let astray = || astray().map(|astray| format!("sensors: {astray}"));
            let unruly = || unruly().map(|unruly| format!("rules: {unruly}"));
            let streamed = || streamed().map(|streamed| format!("streams: {streamed}"));
            let Some(found) = forgotten().or_else(streamed).or_else(unruly).or_else(astray) else {
                println!("nothing in {flights} flights, {completed} plans were flown to their end");
                return ExitCode::SUCCESS;
            };
            found
        }
    };
    println!("{text}");
    ExitCode::FAILURE
}
