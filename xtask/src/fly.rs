//! Flies every case with many seeds, on all cores, and tells how well it went.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use autopilot::Plan;
use autopilot::sim::{Moment, SimulatedFlight, SimulationError};

use crate::cases::{CASES, LAWS};
use crate::plot;
use crate::score::Scorer;
use crate::table::{self, Flown};

/// What went wrong with the measurement, not with a flight.
#[derive(Debug, thiserror::Error)]
pub(crate) enum FlyError {
    #[error("a plan that is built in is wrong: {0}")]
    Plan(String),
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    #[error("cannot write {}: {source}", path.display())]
    Write { path: PathBuf, source: io::Error },
}

/// Which flight of which case.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Job {
    pub(crate) case: usize,
    pub(crate) law: usize,
    pub(crate) plan: usize,
    pub(crate) seed: u64,
}

pub(crate) fn run(
    seeds: u64,
    csv_path: Option<&Path>,
    plots: Option<&Path>,
) -> Result<String, FlyError> {
    let mut jobs = Vec::new();
    for (case, what) in CASES.iter().enumerate() {
        for law in 0..LAWS.len() {
            for plan in 0..what.plans.len() {
                jobs.extend((1..=seeds).map(|seed| Job { case, law, plan, seed }));
            }
        }
    }
    let flown = fly_all(&jobs)?;
    let rows = table::rows(&flown);
    if let Some(folder) = plots {
        plot::write_all(folder, &rows)?;
    }
    if let Some(path) = csv_path {
        table::write_csv(path, &flown)
            .map_err(|source| FlyError::Write { path: path.to_owned(), source })?;
    }
    Ok(table::table(&rows))
}

fn fly_all(jobs: &[Job]) -> Result<Vec<Flown>, FlyError> {
    let next = AtomicUsize::new(0);
    let flown = Mutex::new(Vec::new());
    let failed = Mutex::new(None);
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some(job) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
                    match score(*job) {
                        Ok(flight) => lock(&flown).push(flight),
                        Err(error) => *lock(&failed) = Some(error),
                    }
                }
            });
        }
    });
    if let Some(error) = lock(&failed).take() {
        return Err(error);
    }
    let mut flown = std::mem::take(&mut *lock(&flown));
    flown.sort_by_key(|flight| (flight.case, flight.law, flight.plan, flight.seed));
    Ok(flown)
}

/// A poisoned lock holds what was pushed before; nothing of it is half done.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

fn score(job: Job) -> Result<Flown, FlyError> {
    let mut scorer = Scorer::new(CASES[job.case].plans[job.plan].stay);
    let flight = fly(job, |moment| scorer.watch(moment))?;
    let Job { case, law, plan, seed } = job;
    Ok(Flown { law, case, plan, seed, score: scorer.score(&flight) })
}

pub(crate) fn fly(job: Job, watch: impl FnMut(&Moment)) -> Result<SimulatedFlight, FlyError> {
    let case = &CASES[job.case];
    let plan = &case.plans[job.plan];
    let plan =
        Plan::parse(plan.name, plan.text).map_err(|error| FlyError::Plan(error.to_string()))?;
    Ok(case.simulation(LAWS[job.law].1, job.seed).fly_watched(plan, watch)?)
}
