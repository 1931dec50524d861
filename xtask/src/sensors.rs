//! One failing sensor at a time, and a table of how far the drone was led astray.

use std::fmt::Write as _;
use std::ops::Range;

use system_tests::sensors::{
    AIRFRAMES, Excursion, Failure, RandomFlight, Situation, failures, fly, random,
};
use system_tests::sim::SimulationError;

use crate::parallel;

/// The worst flight, and which it was.
#[derive(Debug, Clone, Copy)]
struct Worst {
    metres: f64,
    airframe: usize,
    seed: u64,
}

impl Worst {
    const NONE: Self = Self { metres: 0.0, airframe: 0, seed: 0 };

    fn see(&mut self, metres: f64, airframe: usize, seed: u64) {
        if metres > self.metres {
            *self = Self { metres, airframe, seed };
        }
    }
}

/// Results of one failure.
#[derive(Debug, Clone)]
struct Row {
    name: String,
    away: [Worst; Situation::ALL.len()],
    outside: Worst,
    scraping_s: f64,
    airborne: usize,
    too_far: usize,
    flights: usize,
}

impl Row {
    fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            away: [Worst::NONE; Situation::ALL.len()],
            outside: Worst::NONE,
            scraping_s: 0.0,
            airborne: 0,
            too_far: 0,
            flights: 0,
        }
    }

    fn see(
        &mut self,
        excursion: &Excursion,
        own: &Excursion,
        situation: usize,
        airframe: usize,
        seed: u64,
    ) {
        self.away[situation].see(excursion.away_m, airframe, seed);
        self.outside.see(excursion.outside_m, airframe, seed);
        self.scraping_s = self.scraping_s.max(excursion.scraping.as_secs_f64());
        self.airborne += usize::from(excursion.airborne);
        self.too_far += usize::from(excursion.is_too_far(own));
        self.flights += 1;
    }
}

/// Flies every failure in every situation on every airframe with `seeds` seeds, then random ones; the second value is
/// whether no drone was led too far.
pub(crate) fn run(
    seeds: u64,
    only: Option<&str>,
    randoms: Range<u64>,
) -> Result<(String, bool), SimulationError> {
    let (listed, listed_good) = run_listed(seeds, only)?;
    let (randomly, randomly_good) = run_random(randoms)?;
    Ok((listed + &randomly, listed_good && randomly_good))
}

/// Flies random failures and lists those that led too far; those that navdata cannot show are only counted.
fn run_random(numbers: Range<u64>) -> Result<(String, bool), SimulationError> {
    let numbers: Vec<u64> = numbers.collect();
    let flown = parallel::map(&numbers, random)?;
    let too_far: Vec<&RandomFlight> = flown.iter().filter(|flight| flight.is_too_far()).collect();
    let (judged, excused): (Vec<_>, Vec<_>) = too_far.into_iter().partition(|flight| flight.shows);
    let mut text = String::new();
    for flight in &judged {
        _ = writeln!(text, "{flight}");
    }
    let showing = flown.iter().filter(|flight| flight.shows).count();
    _ = writeln!(
        text,
        "{} random failures: {} of {showing} too far, and {} of {} that navdata cannot show",
        flown.len(),
        judged.len(),
        excused.len(),
        flown.len() - showing,
    );
    Ok((text, judged.is_empty()))
}

fn run_listed(seeds: u64, only: Option<&str>) -> Result<(String, bool), SimulationError> {
    if seeds == 0 {
        return Ok((String::new(), true));
    }
    let mut failures = failures();
    failures.retain(|failure| only.is_none_or(|only| failure.name.contains(only)));
    let mut jobs = Vec::new();
    for seed in 1..=seeds {
        for airframe in 0..AIRFRAMES.len() {
            jobs.extend((0..Situation::ALL.len()).map(|situation| (seed, airframe, situation)));
        }
    }
    let flown = parallel::map(&jobs, |(seed, airframe, situation)| {
        fly((AIRFRAMES[airframe].profile)(), Situation::ALL[situation], seed, &failures)
    })?;
    let mut own = Row::new("(its own hover and landing)");
    let mut rows: Vec<Row> = failures.iter().map(row_of).collect();
    for ((seed, airframe, situation), siblings) in jobs.iter().zip(&flown) {
        own.see(&siblings.own, &siblings.own, *situation, *airframe, *seed);
        for (row, excursion) in rows.iter_mut().zip(&siblings.flown) {
            row.see(excursion, &siblings.own, *situation, *airframe, *seed);
        }
    }
    let judged = rows.iter().zip(&failures).filter(|(_, failure)| failure.shows());
    let good = judged.into_iter().all(|(row, _)| row.too_far == 0);
    rows.push(own);
    Ok((table(&rows), good))
}

/// Failures that navdata cannot show are marked: they are reported but not judged.
fn row_of(failure: &Failure) -> Row {
    Row::new(&format!("{}{}", failure.name, if failure.shows() { "" } else { " *" }))
}

fn table(rows: &[Row]) -> String {
    let mut text = format!("{:<30}", "metres from its place or way");
    for situation in Situation::ALL {
        _ = write!(text, "{:>11}", situation.to_string());
    }
    _ = writeln!(
        text,
        "{:>10}{:>10}{:>10}{:>14}  worst",
        "outside", "scraping", "airborne", "too far"
    );
    for row in rows {
        _ = write!(text, "{:<30}", row.name);
        for worst in &row.away {
            _ = write!(text, "{:>11.2}", worst.metres);
        }
        let worst =
            row.away.iter().zip(Situation::ALL).max_by(|a, b| a.0.metres.total_cmp(&b.0.metres));
        let worst = worst.map_or_else(String::new, |(worst, situation)| {
            format!("{} {situation}, seed {}", AIRFRAMES[worst.airframe].name, worst.seed)
        });
        _ = writeln!(
            text,
            "{:>10.2}{:>8.1} s{:>10}{:>14}  {worst}",
            row.outside.metres,
            row.scraping_s,
            row.airborne,
            format!("{}/{}", row.too_far, row.flights),
        );
    }
    text
}
