//! Flights of healthy drones that were landed without need.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use system_tests::airframes::Airframes;
use system_tests::healthy::{HealthyFlight, fly};
use system_tests::sim::SimulationError;

use crate::parallel;

/// How many landings without need are accepted in a thousand flights.
const ACCEPTED_PER_THOUSAND: u64 = 1;

/// Flies seeds from `first`; the second value is whether few enough were landed without need.
pub(crate) fn run(
    airframes: Airframes,
    flights: u64,
    first: u64,
) -> Result<(String, bool), SimulationError> {
    let seeds: Vec<u64> = (first..first.saturating_add(flights)).collect();
    let flown = parallel::map(&seeds, |seed| fly(airframes, seed))?;
    let landed = flown.iter().filter(|flight| flight.is_landed_without_need()).count() as u64;
    Ok((report(&flown), landed * 1000 <= ACCEPTED_PER_THOUSAND * flights))
}

/// What was landed without need, for which reasons, and how often with each ingredient.
fn report(flown: &[HealthyFlight]) -> String {
    let mut text = String::new();
    let mut reasons: BTreeMap<String, usize> = BTreeMap::new();
    let mut ingredients: BTreeMap<(&str, &str), [usize; 2]> = BTreeMap::new();
    for flight in flown {
        let is_landed = flight.is_landed_without_need();
        for ingredient in &flight.ingredients {
            let [landed, all] = ingredients.entry(*ingredient).or_default();
            *landed += usize::from(is_landed);
            *all += 1;
        }
        if is_landed {
            _ = writeln!(text, "{}: {}", flight.description, flight.outcome);
            *reasons.entry(flight.outcome.to_string()).or_default() += 1;
        }
    }
    _ = writeln!(text, "\n{:<40}{:>8}{:>10}", "ingredient", "landed", "flights");
    for ((kind, which), [landed, all]) in &ingredients {
        _ = writeln!(text, "{:<40}{landed:>8}{all:>10}", format!("{kind}: {which}"));
    }
    let mut reasons: Vec<_> = reasons.into_iter().collect();
    reasons.sort_by_key(|(_, landed)| std::cmp::Reverse(*landed));
    _ = writeln!(text, "\n{:<8}reason", "landed");
    for (reason, landed) in &reasons {
        _ = writeln!(text, "{landed:<8}{reason}");
    }
    let landed: usize = reasons.iter().map(|(_, landed)| landed).sum();
    _ = writeln!(text, "\n{landed} of {} landed without need", flown.len());
    text
}
