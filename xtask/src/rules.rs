//! Flights in which a single rule keeps the drone safe.

use std::fmt::Write as _;

use system_tests::rules::broken;
use system_tests::sim::SimulationError;

/// Flies all of them and lists those that did not end as they must; the second value is whether there are none.
pub(crate) fn run() -> Result<(String, bool), SimulationError> {
    let broken = broken()?;
    let mut text = String::new();
    for flight in &broken {
        _ = writeln!(text, "{flight}");
    }
    _ = writeln!(text, "{} did not end as they must", broken.len());
    Ok((text, broken.is_empty()))
}
