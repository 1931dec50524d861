//! Flights whose place something else knows too, and a table of how often it contradicted.

use std::fmt::Write as _;

use system_tests::cross_checks::{CASES, Told, Wrong, fly};
use system_tests::sim::SimulationError;

use crate::parallel;

/// Flies each case with seeds from `first`; the second value is whether no healthy flight was contradicted.
pub(crate) fn run(flights: u64, first: u64) -> Result<(String, bool), SimulationError> {
    let mut text = format!(
        "{:<32}{:>8}{:>14}{:>12}{:>20}{:>16}{:>12}\n",
        "",
        "flights",
        "contradicted",
        "elsewhere",
        "contradicted of it",
        "said success",
        "worst [m]"
    );
    let mut good = true;
    for (name, wrong, knows) in CASES {
        let seeds: Vec<u64> = (first..first.saturating_add(flights)).collect();
        let flown = parallel::map(&seeds, |seed| fly(wrong, knows, seed))?;
        let count = |which: fn(&Told) -> bool| flown.iter().filter(|told| which(told)).count();
        _ = writeln!(
            text,
            "{name:<32}{:>8}{:>14}{:>12}{:>20}{:>16}{:>12.1}",
            flown.len(),
            count(|told| told.contradicted),
            count(Told::was_elsewhere),
            count(|told| told.was_elsewhere() && told.contradicted),
            count(Told::is_false_success),
            flown.iter().map(|told| told.off_m).fold(0.0, f64::max),
        );
        if wrong == Wrong::Nothing {
            for told in flown.iter().filter(|told| told.contradicted) {
                _ = writeln!(
                    text,
                    "  seed {}: {:.2} m off, {}",
                    told.seed, told.off_m, told.outcome
                );
                good = false;
            }
        }
    }
    Ok((text, good))
}
