//! Flights of healthy drones that were landed without need.

use std::fmt::Write as _;

use system_tests::healthy::{HealthyFlight, fly};
use system_tests::sim::SimulationError;

use crate::parallel;

/// How many landings without need are accepted in a thousand flights.
const ACCEPTED_PER_THOUSAND: u64 = 1;

/// Flies seeds from `first`; the second value is whether few enough were landed without need.
pub(crate) fn run(flights: u64, first: u64) -> Result<(String, bool), SimulationError> {
    let seeds: Vec<u64> = (first..first.saturating_add(flights)).collect();
    let flown = parallel::map(&seeds, fly)?;
    let needless: Vec<&HealthyFlight> =
        flown.iter().filter(|flight| flight.is_landed_without_need()).collect();
    let mut text = String::new();
    for flight in &needless {
        _ = writeln!(text, "{}: {}", flight.description, flight.outcome);
    }
    for (link, is_ordinary) in [("40 to 150", true), ("150 to 300", false)] {
        let count = |flights: &mut dyn Iterator<Item = &HealthyFlight>| {
            flights.filter(|flight| flight.is_ordinary == is_ordinary).count()
        };
        let (landed, all) = (count(&mut needless.iter().copied()), count(&mut flown.iter()));
        _ = writeln!(text, "{link} ms there and back: {landed} of {all} landed without need");
    }
    Ok((text, needless.len() as u64 * 1000 <= ACCEPTED_PER_THOUSAND * flights))
}
