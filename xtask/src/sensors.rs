//! One failing sensor at a time, and a table of how far the drone was led astray.

use std::fmt::Write as _;
use std::ops::Range;

use system_tests::airframes::{AIRFRAMES, Airframes};
use system_tests::sensors::{
    Excursion, Failure, Flown, RandomFlight, Situation, failures, fly, random_of,
};
use system_tests::sim::SimulationError;

use crate::compare::Line;
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

/// What is flown.
#[derive(Debug, Clone)]
pub(crate) struct Request {
    pub(crate) airframes: Airframes,
    /// Seeds of each failure in each situation on each airframe, from 1.
    pub(crate) seeds: u64,
    /// Of the listed failures only those with this in their name.
    pub(crate) only: Option<String>,
    /// Numbers of random failures.
    pub(crate) randoms: Range<u64>,
}

/// What came of it.
#[derive(Debug, Default)]
pub(crate) struct Report {
    pub(crate) text: String,
    /// Each flight.
    pub(crate) lines: Vec<Line>,
}

impl Report {
    /// Whether no drone was led too far by what navdata can show.
    pub(crate) fn is_good(&self) -> bool {
        !self.lines.iter().any(|line| line.judged && line.too_far)
    }
}

/// Flies every failure in every situation on every airframe with some seeds, then random ones.
pub(crate) fn run(request: &Request) -> Result<Report, SimulationError> {
    let mut report = Report::default();
    if request.seeds > 0 {
        fly_listed(request, &mut report)?;
    }
    fly_random(request, &mut report)?;
    Ok(report)
}

/// Flies random failures and lists those that led too far; those that navdata cannot show are only counted.
fn fly_random(request: &Request, report: &mut Report) -> Result<(), SimulationError> {
    let numbers: Vec<u64> = request.randoms.clone().collect();
    let flown = parallel::map(&numbers, |number| random_of(request.airframes, number))?;
    let never = flown.iter().filter(|flight| flight.is_none()).count();
    let flown: Vec<RandomFlight> = flown.into_iter().flatten().collect();
    let too_far: Vec<&RandomFlight> = flown.iter().filter(|flight| flight.is_too_far()).collect();
    let (judged, excused): (Vec<_>, Vec<_>) = too_far.into_iter().partition(|flight| flight.shows);
    let text = &mut report.text;
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
    tell_of_landed(text, never);
    report.lines.extend(flown.iter().map(|flight| {
        let row = format!("random {:?}", flight.quantity);
        let RandomFlight { airframe, situation, number, own, .. } = flight;
        line(row, airframe, *situation, *number, flight.shows, own, &flight.flown)
    }));
    Ok(())
}

fn fly_listed(request: &Request, report: &mut Report) -> Result<(), SimulationError> {
    let Request { airframes, seeds, only, .. } = request;
    let mut failures = failures();
    failures.retain(|failure| only.as_ref().is_none_or(|only| failure.name.contains(only)));
    let mut jobs = Vec::new();
    for seed in 1..=*seeds {
        for airframe in 0..AIRFRAMES.len() {
            jobs.extend((0..Situation::ALL.len()).map(|situation| (seed, airframe, situation)));
        }
    }
    let flown = parallel::map(&jobs, |(seed, airframe, situation)| {
        fly(airframes.profile(airframe, seed), Situation::ALL[situation], seed, &failures)
    })?;
    let mut own = Row::new("(its own hover and landing)");
    let mut rows: Vec<Row> = failures.iter().map(row_of).collect();
    for ((seed, airframe, situation), siblings) in jobs.iter().zip(&flown) {
        let Some(siblings) = siblings else { continue };
        own.see(&siblings.own, &siblings.own, *situation, *airframe, *seed);
        for ((row, failure), flown) in rows.iter_mut().zip(&failures).zip(&siblings.flown) {
            row.see(&flown.excursion, &siblings.own, *situation, *airframe, *seed);
            report.lines.push(line(
                failure.name.clone(),
                airframes.name(*airframe),
                Situation::ALL[*situation],
                *seed,
                failure.shows(),
                &siblings.own,
                flown,
            ));
        }
    }
    rows.push(own);
    report.text += &table(&rows);
    tell_of_landed(&mut report.text, flown.iter().filter(|siblings| siblings.is_none()).count());
    Ok(())
}

/// Tells how many healthy drones were landed before a sensor could fail.
fn tell_of_landed(text: &mut String, landed: usize) {
    if landed > 0 {
        _ = writeln!(text, "{landed} healthy drones were landed before a sensor could fail");
    }
}

fn line(
    row: String,
    airframe: &str,
    situation: Situation,
    seed: u64,
    judged: bool,
    own: &Excursion,
    flown: &Flown,
) -> Line {
    let Flown { excursion, reaction, outcome } = flown;
    Line {
        row,
        airframe: airframe.to_owned(),
        situation: situation.to_string(),
        seed,
        judged,
        away_m: excursion.away_m,
        outside_m: excursion.outside_m,
        scraping_s: excursion.scraping.as_secs_f64(),
        airborne: excursion.airborne,
        too_far: excursion.is_too_far(own),
        reaction_s: reaction.map(|reaction| reaction.as_secs_f64()),
        outcome: outcome.to_string(),
    }
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
