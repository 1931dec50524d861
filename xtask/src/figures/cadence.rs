//! How regular the ticks of a flight over UDP are, in real time.

use serde_json::Value;

use super::programs::{Programs, output};
use super::record::Figures;
use crate::files::root;

/// Flies the simulated drone, as the README's first command does.
pub(super) fn measure(
    programs: &Programs,
    figures: &mut Figures,
) -> Result<(), Box<dyn std::error::Error>> {
    let mut flight = std::process::Command::new(programs.named("ardrone-pilot"));
    flight.args(["--plan", "plans/square.txt", "--mock", "--json", "--no-log"]);
    let said = output(flight.current_dir(root()))?;
    let (mut late_ms, mut skipped) = (Vec::new(), 0.0);
    for line in said.lines() {
        let message: Value = serde_json::from_str(line)?;
        // The worst one since the status before.
        late_ms.extend(message["tick_late_s"].as_f64().map(|late_s| late_s * 1e3));
        skipped = message["ticks_skipped"].as_f64().unwrap_or(skipped);
    }
    late_ms.sort_by(f64::total_cmp);
    if let Some(late_ms) = late_ms.get(late_ms.len() * 99 / 100) {
        figures.add("lateness of ticks, 99 of 100", "square.txt", *late_ms);
        figures.add("ticks skipped", "square.txt", skipped);
    }
    Ok(())
}
