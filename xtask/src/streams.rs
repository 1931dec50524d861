//! Random streams of operators' orders, and a table of how far they led on each airframe.

use std::fmt::Write as _;

use system_tests::airframes::AIRFRAMES;
use system_tests::sim::SimulationError;
use system_tests::streams::{Flown, fly};

use crate::parallel;

/// Flies streams from `first` on and returns the report; the second value is whether none led too far.
pub(crate) fn run(streams: u64, first: u64) -> Result<(String, bool), SimulationError> {
    let seeds: Vec<u64> = (first..first.saturating_add(streams)).collect();
    let flown = parallel::map(&seeds, fly)?;
    let mut text = format!(
        "{:<10}{:>9}{:>12}{:>12}{:>8}{:>8}\n",
        "airframe", "streams", "outside [m]", "further [m]", "floor", "bad"
    );
    for (airframe, model) in AIRFRAMES.iter().enumerate() {
        let on: Vec<&Flown> = flown.iter().filter(|flown| flown.airframe == airframe).collect();
        let most = |of: fn(&Flown) -> f64| {
            on.iter().map(|flown| of(flown)).fold(f64::NEG_INFINITY, f64::max)
        };
        let bad = on.iter().filter(|flown| flown.is_bad()).count();
        _ = writeln!(
            text,
            "{:<10}{:>9}{:>12.2}{:>12.2}{:>8}{bad:>8}",
            model.name,
            on.len(),
            most(|flown| flown.outside_m),
            most(|flown| flown.further_m),
            on.iter().filter(|flown| flown.touches > 0).count(),
        );
    }
    let bad: Vec<&Flown> = flown.iter().filter(|flown| flown.is_bad()).collect();
    for flown in &bad {
        _ = writeln!(text, "{flown}");
    }
    Ok((text, bad.is_empty()))
}
