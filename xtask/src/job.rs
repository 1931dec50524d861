//! One flight of a case.

use std::io;
use std::path::PathBuf;

use autopilot::Plan;
use system_tests::sim::{Moment, SimulatedFlight, SimulationError};

use crate::cases::CASES;

/// Failure of the measurement itself, not of a flight.
#[derive(Debug, thiserror::Error)]
pub(crate) enum FlyError {
    #[error("a plan that is built in is wrong: {0}")]
    Plan(String),
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    #[error("cannot write {}: {source}", path.display())]
    Write { path: PathBuf, source: io::Error },
}

/// One flight of one case.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Job {
    pub(crate) case: usize,
    pub(crate) plan: usize,
    pub(crate) seed: u64,
}

pub(crate) fn fly(job: Job, watch: impl FnMut(&Moment)) -> Result<SimulatedFlight, FlyError> {
    let case = &CASES[job.case];
    let plan = &case.plans[job.plan];
    let plan =
        Plan::parse(plan.name, plan.text).map_err(|error| FlyError::Plan(error.to_string()))?;
    Ok(case.simulation(job.seed).fly_watched(plan, watch)?)
}
