//! Flies plans on every airframe with many seeds, on all cores, and tells how well it went.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use autopilot::Plan;
use autopilot::pilot::{Law, PilotConfig};
use autopilot::sim::{Simulation, SimulationError};
use mock_drone::airframe::Profile;
use mock_drone::sensors::SensorModel;
use mock_drone::{DroneConfig, LinkFaults, WorldConfig};
use nalgebra::Vector2;

use crate::score::{Score, Scorer, mean};

/// The plans of the figures that we compare with.
const PLANS: [(&str, &str); 3] = [
    ("square1x1", include_str!("../../plans/square1x1.txt")),
    ("xyz", include_str!("../../plans/xyz.txt")),
    ("NikolausVertical", include_str!("../../plans/NikolausVertical.txt")),
];

/// A case: what is flown with what.
#[derive(Debug, Clone, Copy)]
struct Case {
    airframe: &'static str,
    profile: fn() -> Profile,
    sensors: &'static str,
    model: fn() -> SensorModel,
    /// Wind, a worse level reference, and 3 % of all datagrams lost.
    bad_day: bool,
    /// The time that nobody can beat on the three plans together: per leg the time-optimal way from
    /// rest to rest into the ball of 0.2 m.
    bound_s: f64,
}

const REC: Case = Case {
    airframe: "rec",
    profile: Profile::rec,
    sensors: "nominal",
    model: SensorModel::nominal,
    bad_day: false,
    bound_s: 52.6,
};

const CASES: [Case; 5] = [
    REC,
    Case { airframe: "tum", profile: Profile::tum, bound_s: 59.0, ..REC },
    Case { airframe: "tf", profile: Profile::tf, bound_s: 56.5, ..REC },
    Case { airframe: "leo", profile: Profile::leo, bound_s: 61.4, ..REC },
    Case { sensors: "hard", model: SensorModel::hard, bad_day: true, ..REC },
];

const LAWS: [(&str, Law); 2] = [("tum", Law::Tum), ("cascade", Law::Cascade)];

/// What went wrong with the measurement, not with a flight.
#[derive(Debug, thiserror::Error)]
pub(crate) enum FlyError {
    #[error("a plan that is built in is wrong: {0}")]
    Plan(String),
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    #[error("cannot write {}: {source}", path.display())]
    Write { path: PathBuf, source: io::Error },
}

/// One flight and its figures.
struct Flown {
    law: usize,
    case: usize,
    plan: usize,
    seed: u64,
    score: Score,
}

pub(crate) fn run(seeds: u64, csv_path: Option<&Path>) -> Result<String, FlyError> {
    let mut jobs = Vec::new();
    for case in 0..CASES.len() {
        for law in 0..LAWS.len() {
            for plan in 0..PLANS.len() {
                jobs.extend((1..=seeds).map(|seed| (law, case, plan, seed)));
            }
        }
    }
    let next = AtomicUsize::new(0);
    let flown = Mutex::new(Vec::new());
    let failed = Mutex::new(None);
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some((law, case, plan, seed)) =
                    jobs.get(next.fetch_add(1, Ordering::Relaxed))
                {
                    match fly(*law, *case, *plan, *seed) {
                        Ok(score) => lock(&flown).push(Flown {
                            law: *law,
                            case: *case,
                            plan: *plan,
                            seed: *seed,
                            score,
                        }),
                        Err(error) => *lock(&failed) = Some(error),
                    }
                }
            });
        }
    });
    if let Some(error) = lock(&failed).take() {
        return Err(error);
    }
    let mut flown = std::mem::take(&mut *lock(&flown));
    flown.sort_by_key(|flight| (flight.case, flight.law, flight.plan, flight.seed));
    if let Some(path) = csv_path {
        write_csv(path, &flown)
            .map_err(|source| FlyError::Write { path: path.to_owned(), source })?;
    }
    Ok(table(&flown))
}

/// A poisoned lock holds what was pushed before; nothing of it is half done.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

fn fly(law: usize, case: usize, plan: usize, seed: u64) -> Result<Score, FlyError> {
    let (name, text) = PLANS[plan];
    let plan = Plan::parse(name, text).map_err(|error| FlyError::Plan(error.to_string()))?;
    let Case { profile, model, bad_day, .. } = CASES[case];
    let mut drone =
        DroneConfig { seed, profile: profile(), sensors: model(), ..DroneConfig::default() };
    let mut link = LinkFaults::default();
    if bad_day {
        drone.wind_m_s = Vector2::new(0.5, -0.4);
        drone.gusts_m_s = 0.2;
        drone.trim_error_deg = 0.6;
        link.loss = 0.03;
    }
    let world = WorldConfig { drone, link, ..WorldConfig::default() };
    let pilot = PilotConfig { law: LAWS[law].1, ..PilotConfig::default() };
    let simulation = Simulation { world, pilot, ..Simulation::default() };
    let mut scorer = Scorer::default();
    let flight = simulation.fly_watched(plan, |moment| scorer.watch(moment))?;
    Ok(scorer.score(&flight))
}

/// One line a case: sums over the plans, means over the seeds.
fn table(flown: &[Flown]) -> String {
    let mut text = format!(
        "{:<6}{:<9}{:>10}{:>10}{:>9}{:>22}{:>12}\n",
        "frame",
        "sensors",
        "completed",
        "transit s",
        "/ bound",
        "overshoot mean/worst",
        "late RMSE m"
    );
    let mut by_case: BTreeMap<(usize, usize), Vec<&Flown>> = BTreeMap::new();
    for flight in flown {
        by_case.entry((flight.case, flight.law)).or_default().push(flight);
    }
    for ((case, law), flights) in by_case {
        let completed = flights.iter().filter(|flight| flight.score.completed).count();
        let transit: f64 = (0..PLANS.len())
            .map(|plan| {
                let times = flights.iter().filter(|flight| flight.plan == plan);
                mean(&times.map(|flight| flight.score.transit_s).collect::<Vec<_>>())
            })
            .sum();
        let overshoots: Vec<f64> =
            flights.iter().flat_map(|flight| flight.score.overshoots_m.clone()).collect();
        let late: Vec<f64> =
            flights.iter().flat_map(|flight| flight.score.late_square_m2.clone()).collect();
        _ = writeln!(
            text,
            "{:<6}{:<9}{:<9}{:>10}{:>10.1}{:>9.2}{:>22}{:>12.3}",
            CASES[case].airframe,
            CASES[case].sensors,
            LAWS[law].0,
            format!("{completed}/{}", flights.len()),
            transit,
            transit / CASES[case].bound_s,
            format!(
                "{:.3} / {:.2}",
                mean(&overshoots),
                overshoots.iter().copied().fold(0.0, f64::max)
            ),
            mean(&late).sqrt(),
        );
    }
    text
}

fn write_csv(path: &Path, flown: &[Flown]) -> io::Result<()> {
    let mut writer = csv::Writer::from_path(path)?;
    writer.write_record([
        "airframe",
        "sensors",
        "law",
        "plan",
        "seed",
        "completed",
        "waypoints",
        "transit_s",
        "overshoot_mean_m",
        "overshoot_worst_m",
        "late_rmse_m",
    ])?;
    for Flown { law, case, plan, seed, score } in flown {
        let worst = score.overshoots_m.iter().copied().fold(0.0, f64::max);
        writer.write_record([
            CASES[*case].airframe.to_owned(),
            CASES[*case].sensors.to_owned(),
            LAWS[*law].0.to_owned(),
            PLANS[*plan].0.to_owned(),
            seed.to_string(),
            score.completed.to_string(),
            score.waypoints.to_string(),
            format!("{:.3}", score.transit_s),
            format!("{:.4}", mean(&score.overshoots_m)),
            format!("{worst:.4}"),
            format!("{:.4}", mean(&score.late_square_m2).sqrt()),
        ])?;
    }
    writer.flush()
}
