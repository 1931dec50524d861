//! How regular the ticks of a flight over UDP are, in real time, beside how late the machine itself is.

use std::time::Duration;

use autopilot::vehicle::TICK;
use serde_json::Value;
use system_tests::lateness::Lateness;

use super::programs::{Programs, output};
use super::record::Figures;
use crate::files::root;

/// A flight during which the machine stood still by chance does not tell of the program: so many are flown at most.
const FLIGHTS: usize = 3;

/// What a flight shows.
#[derive(Debug, Clone, Copy)]
struct Cadence {
    late_ms: f64,
    skipped: f64,
    /// What of it the machine does not explain.
    unexplained_ms: f64,
    unexplained_skipped: f64,
}

impl Cadence {
    /// Of two flights the least of each: chance only adds.
    fn least(&self, other: &Self) -> Self {
        Self {
            late_ms: self.late_ms.min(other.late_ms),
            skipped: self.skipped.min(other.skipped),
            unexplained_ms: self.unexplained_ms.min(other.unexplained_ms),
            unexplained_skipped: self.unexplained_skipped.min(other.unexplained_skipped),
        }
    }

    fn is_explained(&self) -> bool {
        self.unexplained_ms <= 0.0 && self.unexplained_skipped <= 0.0
    }

    /// `late_ms` of the tick that was latest since the status before, and `delays` of a thread that only slept meanwhile.
    fn of(late_ms: Vec<f64>, skipped: f64, delays: &[Duration]) -> Option<Self> {
        // Of as long a time as a status tells of: only like can be compared.
        let of_status = delays.len().div_ceil(late_ms.len().max(1)).max(1);
        let worst =
            |delays: &[Duration]| delays.iter().max().map(|worst| worst.as_secs_f64() * 1e3);
        let machine_ms = late(delays.chunks(of_status).filter_map(worst).collect())?;
        let late_ms = late(late_ms)?;
        let missed = |delay: &Duration| (delay.as_nanos() / TICK.as_nanos()) as f64;
        let machine_skipped: f64 = delays.iter().map(missed).sum();
        Some(Self {
            late_ms,
            skipped,
            unexplained_ms: (late_ms - machine_ms).max(0.0),
            unexplained_skipped: (skipped - machine_skipped).max(0.0),
        })
    }
}

/// What 99 of 100 do not exceed.
fn late(mut all_ms: Vec<f64>) -> Option<f64> {
    all_ms.sort_by(f64::total_cmp);
    all_ms.get(all_ms.len() * 99 / 100).copied()
}

/// Flies the simulated drone, as the README's first command does.
pub(super) fn measure(
    programs: &Programs,
    figures: &mut Figures,
) -> Result<(), Box<dyn std::error::Error>> {
    let mut least = flight(programs)?;
    for _ in 1..FLIGHTS {
        if least.is_explained() {
            break;
        }
        least = least.least(&flight(programs)?);
    }
    figures.add("lateness of ticks, 99 of 100", "square.txt", least.late_ms);
    figures.add("ticks skipped", "square.txt", least.skipped);
    figures.add("lateness of ticks beyond the machine's", "square.txt", least.unexplained_ms);
    figures.add("ticks skipped beyond the machine's", "square.txt", least.unexplained_skipped);
    Ok(())
}

fn flight(programs: &Programs) -> Result<Cadence, Box<dyn std::error::Error>> {
    let mut flight = std::process::Command::new(programs.named("ardrone-pilot"));
    flight.args(["--plan", "plans/square.txt", "--mock", "--json", "--no-log"]);
    let lateness = Lateness::of_ticks();
    let said = output(flight.current_dir(root()));
    let delays = lateness.delays();
    let (mut late_ms, mut skipped) = (Vec::new(), 0.0);
    for line in said?.lines() {
        let message: Value = serde_json::from_str(line)?;
        // The worst one since the status before.
        late_ms.extend(message["tick_late_s"].as_f64().map(|late_s| late_s * 1e3));
        skipped = message["ticks_skipped"].as_f64().unwrap_or(skipped);
    }
    Cadence::of(late_ms, skipped, &delays).ok_or_else(|| "the flight told of no tick".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of 200 statuses, during which the machine was late as often as is said.
    fn cadence(late_ms: f64, skipped: f64, machine_ms: u64, often: usize) -> Cadence {
        let mut delays = vec![Duration::ZERO; 600];
        delays.iter_mut().step_by(3).take(often).for_each(|delay| {
            *delay = Duration::from_millis(machine_ms);
        });
        Cadence::of(vec![late_ms; 200], skipped, &delays).unwrap()
    }

    #[test]
    fn a_program_that_is_later_than_the_machine_is_not_explained_by_it() {
        let late = cadence(12.0, 0.0, 4, 200);
        assert!(!late.is_explained());
        assert!((late.unexplained_ms - 8.0).abs() < 1e-9, "{late:?}");
        assert!(cadence(12.0, 0.0, 12, 200).is_explained());
    }

    #[test]
    fn a_machine_that_is_late_once_does_not_explain_a_program_that_always_is() {
        assert!((cadence(12.0, 0.0, 20, 1).unexplained_ms - 12.0).abs() < 1e-9);
        assert!(cadence(12.0, 0.0, 20, 2).is_explained());
    }

    #[test]
    fn ticks_are_skipped_by_a_machine_that_stands_still() {
        assert!(cadence(0.0, 4.0, 65, 2).is_explained());
        let skips = cadence(0.0, 5.0, 65, 2);
        assert!(!skips.is_explained());
        assert!((skips.unexplained_skipped - 1.0).abs() < 1e-9, "{skips:?}");
    }

    #[test]
    fn of_several_flights_the_least_of_each_counts() {
        let (late, skips) = (cadence(2.0, 0.0, 0, 200), cadence(1.0, 10.0, 0, 200));
        assert!(!late.is_explained() && !skips.is_explained());
        let least = late.least(&skips);
        assert!((least.unexplained_ms - 1.0).abs() < 1e-9, "{least:?}");
        assert!(least.unexplained_skipped <= 0.0, "{least:?}");
    }

    #[test]
    fn a_flight_without_ticks_shows_nothing() {
        assert!(Cadence::of(Vec::new(), 0.0, &[Duration::ZERO]).is_none());
        assert!(Cadence::of(vec![1.0], 0.0, &[]).is_none());
    }
}
