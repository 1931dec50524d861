//! Fleets in one simulated time, and a table of how near their vehicles came to each other.

use std::fmt::Write as _;
use std::ops::RangeInclusive;
use std::time::Duration;

use autopilot::vehicle::CannotFly;
use system_tests::fleet::{Fleet, FleetFlight, NEAREST_M, crossing};
use system_tests::tick_times;

use crate::parallel;

/// Longest flight.
const LIMIT: Duration = Duration::from_mins(4);
/// Vehicles of a crossing start this far from the point through which all fly.
const RADIUS_M: f64 = 3.0;
const CROSSING: RangeInclusive<usize> = 2..=6;
/// Other vehicles beside which the time of a tick is measured.
const OTHERS: [u8; 3] = [1, 4, 19];

/// Flies random fleets from `first` on, and a fifth as many crossings of each size; returns the report, and whether all kept
/// apart and came down, and all that crossed arrived.
pub(crate) fn run(fleets: u64, first: u64) -> Result<(String, bool), CannotFly> {
    let seeds: Vec<u64> = (first..first.saturating_add(fleets)).collect();
    let mut text = format!(
        "{:<22}{:>8}{:>10}{:>10}{:>10}{:>10}{:>10}{:>12}\n",
        "fleets", "flown", "nearest", "too near", "runaways", "not down", "arrived", "slowest"
    );
    let random = parallel::map(&seeds, |seed| Fleet::random(seed).fly(LIMIT))?;
    let mut good = report(&mut text, "random, with faults", &seeds, &random, false);
    let seeds: Vec<u64> = (first..first.saturating_add(fleets.div_ceil(5))).collect();
    for count in CROSSING {
        let flown = parallel::map(&seeds, |seed| crossing(count, RADIUS_M, seed).fly(LIMIT))?;
        good &= report(&mut text, &format!("crossing of {count}"), &seeds, &flown, true);
    }
    text += &tick_times::report(&OTHERS)?;
    Ok((text, good))
}

/// Adds a row, and the seeds of what must not be; returns whether there are none.
fn report(
    text: &mut String,
    what: &str,
    seeds: &[u64],
    flown: &[FleetFlight],
    must_arrive: bool,
) -> bool {
    let count =
        |is_so: fn(&FleetFlight) -> bool| flown.iter().filter(|flight| is_so(flight)).count();
    let nearest_m = flown.iter().map(FleetFlight::nearest_m).fold(f64::INFINITY, f64::min);
    let slowest = flown.iter().map(FleetFlight::duration).max().unwrap_or_default();
    // Writing to a string cannot fail.
    _ = writeln!(
        text,
        "{what:<22}{:>8}{nearest_m:>8.2} m{:>10}{:>10}{:>10}{:>10}{:>10.1} s",
        flown.len(),
        count(|flight| flight.nearest_m() < NEAREST_M),
        count(|flight| flight.runaway.is_some_and(|near| near.across_m < NEAREST_M)),
        count(|flight| !flight.is_down),
        count(FleetFlight::is_complete),
        slowest.as_secs_f64(),
    );
    let is_bad =
        |flight: &FleetFlight| !flight.keeps_apart() || must_arrive && !flight.is_complete();
    let bad = seeds.iter().zip(flown).filter(|(_, flight)| is_bad(flight));
    let bad: Vec<String> = bad.map(|(seed, _)| seed.to_string()).collect();
    if !bad.is_empty() {
        _ = writeln!(text, "  bad: {}", bad.join(", "));
    }
    bad.is_empty()
}
