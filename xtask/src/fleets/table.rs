//! The table of fleets: how near vehicles came to each other, what was bad, and how many met which faults.

use std::collections::BTreeMap;
use std::fmt;
use std::time::Duration;

use system_tests::fleet::{FleetFlight, NEAREST_M, Nearest};

use super::Kind;

/// All that was flown.
#[derive(Debug, Default)]
pub(super) struct Table {
    rows: BTreeMap<Kind, Row>,
    /// Random fleets with each kind of fault: all, those in which all plans were flown to the end, runaways, astray, and bad.
    faults: BTreeMap<&'static str, [u64; 5]>,
    bad: Vec<(u64, String)>,
}

#[derive(Debug, Default)]
struct Row {
    flown: u64,
    nearest_m: Option<f64>,
    too_near: u64,
    runaways: Vec<u64>,
    astray: Vec<u64>,
    not_down: u64,
    arrived: u64,
    vehicles: usize,
    completed: usize,
    slowest: Duration,
    /// Of those that meet in one point: how often they were measured, all their time together, and as much alone.
    beside_alone: (u32, Duration, Duration),
}

fn is_too_near(near: Option<Nearest>) -> bool {
    near.is_some_and(|near| near.across_m < NEAREST_M)
}

impl Table {
    pub(super) fn add(&mut self, kind: Kind, seed: u64, flight: &FleetFlight, bad: Option<&str>) {
        let row = self.rows.entry(kind).or_default();
        let nearest_m = flight.nearest_m();
        let [runs_away, is_astray] = [flight.least.runaway, flight.least.astray].map(is_too_near);
        row.flown += 1;
        row.nearest_m = Some(row.nearest_m.map_or(nearest_m, |known| known.min(nearest_m)));
        row.too_near += u64::from(nearest_m < NEAREST_M);
        row.runaways.extend(runs_away.then_some(seed));
        row.astray.extend(is_astray.then_some(seed));
        row.not_down += u64::from(!flight.is_down);
        row.arrived += u64::from(flight.is_complete());
        row.vehicles += flight.members.len();
        row.completed += flight.members.iter().filter(|member| member.is_complete()).count();
        row.slowest = row.slowest.max(flight.duration());
        if kind == Kind::Random {
            for fault in &flight.kinds {
                let counts = [true, flight.is_complete(), runs_away, is_astray, bad.is_some()];
                let known = self.faults.entry(fault).or_default();
                for (known, counts) in known.iter_mut().zip(counts) {
                    *known += u64::from(counts);
                }
            }
        }
        self.bad.extend(bad.map(|bad| (seed, bad.to_owned())));
    }

    /// How long the same vehicles take if nobody is in anybody's way.
    pub(super) fn add_alone(&mut self, kind: Kind, flight: &FleetFlight, alone: Duration) {
        let (count, together, apart) = &mut self.rows.entry(kind).or_default().beside_alone;
        *count += 1;
        *together += flight.duration();
        *apart += alone;
    }

    pub(super) fn is_good(&self) -> bool {
        self.bad.is_empty()
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:<15}{:>8}{:>11}{:>10}{:>10}{:>8}{:>10}{:>9}{:>19}{:>11}",
            "fleets",
            "flown",
            "nearest",
            "too near",
            "runaways",
            "astray",
            "not down",
            "arrived",
            "vehicles arrived",
            "slowest"
        )?;
        for (kind, row) in &self.rows {
            writeln!(
                f,
                "{:<15}{:>8}{:>9.2} m{:>10}{:>10}{:>8}{:>10}{:>9}{:>19}{:>9.1} s",
                kind.to_string(),
                row.flown,
                row.nearest_m.unwrap_or(f64::INFINITY),
                row.too_near,
                row.runaways.len(),
                row.astray.len(),
                row.not_down,
                row.arrived,
                format!("{} of {}", row.completed, row.vehicles),
                row.slowest.as_secs_f64(),
            )?;
        }
        for (kind, row) in &self.rows {
            let (count, together, alone) = row.beside_alone;
            if count > 0 {
                let [together_s, alone_s] =
                    [together, alone].map(|all| (all / count).as_secs_f64());
                let times = together_s / alone_s;
                writeln!(f, "{kind}: {together_s:.1} s, {times:.2} times as long as alone")?;
            }
        }
        writeln!(
            f,
            "\n{:<40}{:>8}{:>9}{:>10}{:>8}{:>6}",
            "random fleets with this fault", "flown", "arrived", "runaways", "astray", "bad"
        )?;
        for (fault, [flown, arrived, runaways, astray, bad]) in &self.faults {
            writeln!(f, "{fault:<40}{flown:>8}{arrived:>9}{runaways:>10}{astray:>8}{bad:>6}")?;
        }
        for (kind, row) in &self.rows {
            for (what, seeds) in [("runaways", &row.runaways), ("astray", &row.astray)] {
                if !seeds.is_empty() {
                    let seeds: Vec<String> = seeds.iter().map(u64::to_string).collect();
                    writeln!(f, "{kind}, {what}: {}", seeds.join(", "))?;
                }
            }
        }
        for (seed, bad) in &self.bad {
            writeln!(f, "BAD {bad}\n    cargo xtask fleets --fleets 1 --first {seed}")?;
        }
        Ok(())
    }
}
