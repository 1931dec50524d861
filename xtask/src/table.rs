//! Scores of many flights as a table and as CSV.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io;
use std::path::Path;

use crate::cases::CASES;
use crate::score::{Score, mean};

/// One flight with its scores.
pub(crate) struct Flown {
    pub(crate) case: usize,
    pub(crate) plan: usize,
    pub(crate) seed: u64,
    pub(crate) score: Score,
}

/// Results of one case: sums over the plans, means over the seeds.
pub(crate) struct Row {
    pub(crate) case: usize,
    pub(crate) flights: usize,
    pub(crate) completed: usize,
    pub(crate) transit_s: f64,
    pub(crate) overshoot_mean_m: f64,
    pub(crate) overshoot_worst_m: f64,
    pub(crate) late_rmse_m: f64,
    /// Drift of the estimate relative to that of the odometry, both as root mean squares.
    pub(crate) drift: f64,
}

pub(crate) fn rows(flown: &[Flown]) -> Vec<Row> {
    let mut by_case: BTreeMap<usize, Vec<&Flown>> = BTreeMap::new();
    for flight in flown {
        by_case.entry(flight.case).or_default().push(flight);
    }
    by_case.into_iter().map(|(case, flights)| row(case, &flights)).collect()
}

fn row(case: usize, flights: &[&Flown]) -> Row {
    let all = |of: fn(&Score) -> Vec<f64>| -> Vec<f64> {
        flights.iter().flat_map(|flight| of(&flight.score)).collect()
    };
    let transit_s = (0..CASES[case].plans.len())
        .map(|plan| {
            let times = flights.iter().filter(|flight| flight.plan == plan);
            mean(&times.map(|flight| flight.score.transit_s).collect::<Vec<_>>())
        })
        .sum();
    let overshoots_m = all(|score| score.overshoots_m.clone());
    let square = |of: fn(&Score) -> f64| {
        mean(&flights.iter().map(|flight| of(&flight.score).powi(2)).collect::<Vec<_>>()).sqrt()
    };
    Row {
        case,
        flights: flights.len(),
        completed: flights.iter().filter(|flight| flight.score.completed).count(),
        transit_s,
        overshoot_mean_m: mean(&overshoots_m),
        overshoot_worst_m: overshoots_m.iter().copied().fold(0.0, f64::max),
        late_rmse_m: mean(&all(|score| score.late_square_m2.clone())).sqrt(),
        drift: square(|score| score.estimate_drift_m) / square(|score| score.odometry_drift_m),
    }
}

pub(crate) fn table(rows: &[Row]) -> String {
    let mut text = format!(
        "{:<10}{:<7}{:<9}{:>10}{:>10}{:>9}{:>22}{:>9}{:>8}\n",
        "plans",
        "frame",
        "what",
        "completed",
        "transit s",
        "/ bound",
        "overshoot mean/worst",
        "late m",
        "drift"
    );
    for row in rows {
        let case = &CASES[row.case];
        let hovers = case.bound_s.is_none();
        let dash = || "-".to_owned();
        _ = writeln!(
            text,
            "{:<10}{:<7}{:<9}{:>10}{:>10}{:>9}{:>22}{:>9.3}{:>8.2}",
            if hovers { "hover" } else { "figures" },
            case.airframe,
            case.conditions,
            format!("{}/{}", row.completed, row.flights),
            if hovers { dash() } else { format!("{:.1}", row.transit_s) },
            case.bound_s.map_or_else(dash, |bound_s| format!("{:.2}", row.transit_s / bound_s)),
            if hovers {
                dash()
            } else {
                format!("{:.3} / {:.2}", row.overshoot_mean_m, row.overshoot_worst_m)
            },
            row.late_rmse_m,
            row.drift,
        );
    }
    text
}

pub(crate) fn write_csv(path: &Path, flown: &[Flown]) -> io::Result<()> {
    let mut writer = csv::Writer::from_path(path)?;
    writer.write_record([
        "airframe",
        "conditions",
        "plan",
        "seed",
        "completed",
        "waypoints",
        "transit_s",
        "overshoot_mean_m",
        "overshoot_worst_m",
        "late_rmse_m",
        "odometry_drift_m",
        "estimate_drift_m",
    ])?;
    for Flown { case, plan, seed, score } in flown {
        let worst = score.overshoots_m.iter().copied().fold(0.0, f64::max);
        writer.write_record([
            CASES[*case].airframe.to_owned(),
            CASES[*case].conditions.to_owned(),
            CASES[*case].plans[*plan].name.to_owned(),
            seed.to_string(),
            score.completed.to_string(),
            score.waypoints.to_string(),
            format!("{:.3}", score.transit_s),
            format!("{:.4}", mean(&score.overshoots_m)),
            format!("{worst:.4}"),
            format!("{:.4}", mean(&score.late_square_m2).sqrt()),
            format!("{:.4}", score.odometry_drift_m),
            format!("{:.4}", score.estimate_drift_m),
        ])?;
    }
    writer.flush()
}
