//! Flies every case with many seeds, on all cores, and reports how well it went.

use std::path::Path;
use std::time::Duration;

use crate::cases::CASES;
use crate::job::{FlyError, Job, fly};
use crate::parallel;
use crate::plot;
use crate::score::Scorer;
use crate::table::{self, Flown, Row};

/// Returns the table, and the simulated time of all flights.
pub(crate) fn run(
    seeds: u64,
    csv_path: Option<&Path>,
    plots: Option<&Path>,
) -> Result<(String, Duration), FlyError> {
    let flown = flown(seeds)?;
    let rows = table::rows(&flown);
    if let Some(folder) = plots {
        plot::write_all(folder, &rows)?;
    }
    if let Some(path) = csv_path {
        table::write_csv(path, &flown)
            .map_err(|source| FlyError::Write { path: path.to_owned(), source })?;
    }
    let duration = flown.iter().map(|flight| flight.score.duration).sum();
    Ok((table::table(&rows), duration))
}

/// Results of each case.
pub(crate) fn rows(seeds: u64) -> Result<Vec<Row>, FlyError> {
    Ok(table::rows(&flown(seeds)?))
}

fn flown(seeds: u64) -> Result<Vec<Flown>, FlyError> {
    let mut jobs = Vec::new();
    for (case, what) in CASES.iter().enumerate() {
        for plan in 0..what.plans.len() {
            jobs.extend((1..=seeds).map(|seed| Job { case, plan, seed }));
        }
    }
    parallel::map(&jobs, score)
}

fn score(job: Job) -> Result<Flown, FlyError> {
    let mut scorer = Scorer::new(CASES[job.case].plans[job.plan].stay);
    let flight = fly(job, |moment| scorer.watch(moment))?;
    let Job { case, plan, seed } = job;
    Ok(Flown { case, plan, seed, score: scorer.score(&flight) })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The table as it is printed, with fewer seeds. A difference is a change of how well the drone is flown:
    /// look at it, and at the whole table (`cargo xtask fly`), before accepting it.
    #[test]
    fn the_table_is_the_same() {
        insta::assert_snapshot!(run(3, None, None).unwrap().0);
    }
}
