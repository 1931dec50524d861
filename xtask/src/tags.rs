//! Flies over tags on the floor, and tells how well the pilot then knows where it is.

use std::fmt::Write as _;
use std::time::Duration;

use autopilot::Plan;
use autopilot::outcome::Outcome;
use autopilot::plan::Commands;
use autopilot::vehicle::{OperatorOrder, TagConfig, VehicleConfig};
use kinematics::wrap_deg;
use mock_drone::scenario::Scenario;
use mock_drone::sensors::SensorModel;
use mock_drone::{CameraModel, DroneConfig, FloorTag, LinkFaults, OrientationSign, WorldConfig};
use nalgebra::Vector2;
use system_tests::sim::{Moment, Simulation, SimulationError};

use crate::parallel;

/// A flight over tags.
#[derive(Clone, Copy)]
struct Case {
    name: &'static str,
    /// What is flown again and again until the battery is empty.
    lap: fn() -> String,
    /// Right, forward, and which way they point.
    tags: &'static [(f64, f64, f64)],
    scenario: fn() -> String,
    camera: fn(CameraModel) -> CameraModel,
    /// Flown once, then lands on the nearest tag.
    lands_on_tag: bool,
    /// What must hold: nominal, hard.
    limits: Option<[Limits; 2]>,
}

#[derive(Clone, Copy)]
struct Limits {
    truth_rms_m: f64,
    truth_worst_m: f64,
    estimate_rms_m: f64,
    heading_deg: f64,
    landing_m: f64,
}

const NEVER: f64 = f64::INFINITY;

fn hover() -> String {
    "setStayTime 60\ngoto 0 0 0.65 0\n".to_owned()
}

/// A square of 1 m at a height of 2 m, again and again.
fn square() -> String {
    "setStayTime 1\ngoto 1 0 1.15 0\ngoto 1 1 1.15 0\ngoto 0 1 1.15 0\ngoto 0 0 1.15 0\n".to_owned()
}

/// Away from the tag and back above it.
fn once_around() -> String {
    "setStayTime 2\ngoto 1 0 0.65 0\ngoto 0 0 0.65 0\n".to_owned()
}

/// The drone starts above it, as near as one puts it by eye.
const ONE: &[(f64, f64, f64)] = &[(0.04, -0.06, 40.0)];

const PLAIN: Case = Case {
    name: "hover 1.5 m",
    lap: hover,
    tags: ONE,
    scenario: String::new,
    camera: |camera| camera,
    lands_on_tag: false,
    limits: Some([
        Limits {
            truth_rms_m: 0.04,
            truth_worst_m: 0.15,
            estimate_rms_m: 0.02,
            heading_deg: 1.5,
            landing_m: NEVER,
        },
        Limits {
            truth_rms_m: 0.12,
            truth_worst_m: 0.40,
            estimate_rms_m: 0.07,
            heading_deg: 2.5,
            landing_m: NEVER,
        },
    ]),
};

const fn robust(name: &'static str, camera: fn(CameraModel) -> CameraModel) -> Case {
    Case { name, camera, limits: None, ..PLAIN }
}

/// Somebody drags the tag away to the right, this fast, for so many metres.
fn dragged(speed_m_s: f64, metres: u32) -> String {
    let steps = (0..=metres * 50).map(|step| {
        let way_m = 0.02 * f64::from(step);
        format!("+{:.3} tag-moved 1 {:.3} -0.06 40\n", 60.0 + way_m / speed_m_s, 0.04 + way_m)
    });
    steps.collect()
}

/// Somebody turns the tag in place, half a degree a second, for five minutes.
fn turned() -> String {
    let steps = (0..=1500).map(|step| {
        let (at_s, turned_deg) = (60.0 + 0.2 * f64::from(step), 0.1 * f64::from(step));
        let heading_deg = wrap_deg(40.0 + turned_deg);
        format!("+{at_s:.1} tag-moved 1 0.04 -0.06 {heading_deg:.1}\n")
    });
    steps.collect()
}

/// How far from the tag a landing on it may end, and nothing else is asked.
const fn landing(landing_m: f64) -> Limits {
    Limits {
        truth_rms_m: NEVER,
        truth_worst_m: NEVER,
        estimate_rms_m: NEVER,
        heading_deg: NEVER,
        landing_m,
    }
}

const CASES: [Case; 22] = [
    PLAIN,
    Case {
        name: "square 2 m",
        lap: square,
        limits: Some([
            Limits {
                truth_rms_m: NEVER,
                truth_worst_m: NEVER,
                estimate_rms_m: 0.20,
                heading_deg: NEVER,
                landing_m: NEVER,
            },
            Limits {
                truth_rms_m: NEVER,
                truth_worst_m: NEVER,
                estimate_rms_m: 0.50,
                heading_deg: NEVER,
                landing_m: NEVER,
            },
        ]),
        ..PLAIN
    },
    Case {
        name: "landing on the tag",
        lap: once_around,
        lands_on_tag: true,
        limits: Some([landing(0.10), landing(0.20)]),
        ..PLAIN
    },
    Case {
        name: "tag 2 m off",
        lap: || "findTag\n".to_owned(),
        tags: &[(1.2, 1.6, 40.0)],
        lands_on_tag: true,
        limits: None,
        ..PLAIN
    },
    Case { name: "no tag", tags: &[], limits: None, ..PLAIN },
    robust("focal ±15 %", |camera| CameraModel { focal_error: 0.15, at_extremes: true, ..camera }),
    robust("centre ±50, mount ±1°", |camera| CameraModel {
        centre_error_units: 50.0,
        mount_error_deg: 1.0,
        at_extremes: true,
        ..camera
    }),
    robust("delay 30 ms", |camera| CameraModel { delay: [Duration::from_millis(14); 2], ..camera }),
    robust("delay 150 ms", |camera| CameraModel {
        delay: [Duration::from_millis(134); 2],
        ..camera
    }),
    robust("1 % false", |camera| CameraModel { false_sights: 0.01, ..camera }),
    robust("clockwise", |camera| CameraModel { orientation: OrientationSign::Clockwise, ..camera }),
    robust("counter-clockwise", |camera| CameraModel {
        orientation: OrientationSign::CounterClockwise,
        ..camera
    }),
    Case {
        name: "4 tags, square",
        lap: square,
        tags: &[(0.1, 0.1, 40.0), (1.6, 0.2, 0.0), (-0.2, 1.7, 170.0), (1.5, 1.6, -90.0)],
        limits: None,
        ..PLAIN
    },
    Case { name: "carried away", scenario: || "+120 tag-gone 1".to_owned(), limits: None, ..PLAIN },
    Case {
        name: "moved 0.5 m",
        scenario: || "+120 tag-moved 1 0.5 0 10".to_owned(),
        limits: None,
        ..PLAIN
    },
    Case { name: "dragged 0.04 m/s, 2 m", scenario: || dragged(0.04, 2), limits: None, ..PLAIN },
    Case { name: "dragged 0.1 m/s, 8 m", scenario: || dragged(0.1, 8), limits: None, ..PLAIN },
    Case { name: "dragged 0.5 m/s, 8 m", scenario: || dragged(0.5, 8), limits: None, ..PLAIN },
    Case {
        name: "turned 30° at once",
        scenario: || "+120 tag-moved 1 0.04 -0.06 70".to_owned(),
        limits: None,
        ..PLAIN
    },
    Case { name: "turned 0.5°/s", scenario: turned, limits: None, ..PLAIN },
    Case { name: "turned 0.5°/s, square", lap: square, scenario: turned, limits: None, ..PLAIN },
    Case {
        name: "heading jumps",
        scenario: || "+60 lie heading 160 for 3600".to_owned(),
        limits: None,
        ..PLAIN
    },
];

#[derive(Clone, Copy)]
struct Job {
    case: usize,
    hard: bool,
    seed: u64,
}

/// What one flight was like, from half a minute after its take-off.
#[derive(Clone, Default)]
struct Flown {
    case: usize,
    hard: bool,
    seed: u64,
    time_s: f64,
    as_meant: bool,
    outcome: String,
    truth_squares: f64,
    truth_worst_m: f64,
    estimate_squares: f64,
    estimate_worst_m: f64,
    inside: f64,
    moments: f64,
    heading_deg: f64,
    landing_m: f64,
    seen: f64,
}

/// Results of the flights of one case on one day.
pub(crate) struct Row {
    pub(crate) name: String,
    hard: bool,
    pub(crate) flights: usize,
    /// Flights that did not end as they should.
    pub(crate) lost: usize,
    pub(crate) lands_on_tag: bool,
    time_s: f64,
    pub(crate) truth_rms_m: f64,
    truth_worst_m: f64,
    pub(crate) estimate_rms_m: f64,
    estimate_worst_m: f64,
    inside: f64,
    heading_deg: f64,
    pub(crate) landing_m: f64,
    seen: f64,
    is_good: bool,
}

impl Row {
    /// What kind of day it was.
    pub(crate) fn day(&self) -> &'static str {
        if self.hard { "hard" } else { "nominal" }
    }

    /// Of flights of one case on one day, of which there is at least one.
    fn new(name: &str, flights: &[Flown]) -> Self {
        let (case, hard) = (&CASES[flights[0].case], flights[0].hard);
        let sum = |of: fn(&Flown) -> f64| flights.iter().map(of).sum::<f64>();
        let worst = |of: fn(&Flown) -> f64| flights.iter().map(of).fold(0.0, f64::max);
        let moments = sum(|f| f.moments).max(1.0);
        let mut headings: Vec<f64> = flights.iter().map(|flight| flight.heading_deg).collect();
        headings.sort_by(f64::total_cmp);
        let mut row = Self {
            name: name.to_owned(),
            hard,
            flights: flights.len(),
            lost: flights.iter().filter(|flight| !flight.as_meant).count(),
            lands_on_tag: case.lands_on_tag,
            time_s: sum(|f| f.time_s) / flights.len() as f64,
            truth_rms_m: (sum(|f| f.truth_squares) / moments).sqrt(),
            truth_worst_m: worst(|f| f.truth_worst_m),
            estimate_rms_m: (sum(|f| f.estimate_squares) / moments).sqrt(),
            estimate_worst_m: worst(|f| f.estimate_worst_m),
            inside: sum(|f| f.inside) / moments,
            heading_deg: headings[(headings.len() * 95).div_ceil(100).saturating_sub(1)],
            landing_m: worst(|f| f.landing_m),
            seen: sum(|f| f.seen) / moments,
            is_good: true,
        };
        let limits = case.limits.map(|limits| limits[usize::from(hard)]);
        row.is_good = limits.is_none_or(|limits| {
            row.truth_rms_m <= limits.truth_rms_m
                && row.truth_worst_m <= limits.truth_worst_m
                && row.estimate_rms_m <= limits.estimate_rms_m
                && row.heading_deg <= limits.heading_deg
                && row.landing_m <= limits.landing_m
                && (limits.estimate_rms_m >= NEVER || row.inside >= 0.9)
                && row.lost == 0
        });
        row
    }

    fn line(&self) -> String {
        format!(
            "{:<22}{:<8}{:>8.0}{:>20}{:>20}{:>9.3}{:>9.2}{:>9.3}{:>8.2}{:>7}",
            self.name,
            self.day(),
            self.time_s,
            format!("{:.3} / {:.2}", self.truth_rms_m, self.truth_worst_m),
            format!("{:.3} / {:.2}", self.estimate_rms_m, self.estimate_worst_m),
            self.inside,
            self.heading_deg,
            self.landing_m,
            self.seen,
            self.lost,
        )
    }
}

/// Flies the cases that are wanted with seeds from 1.
fn flown(seeds: u64, wanted: impl Fn(&Case) -> bool) -> Result<Vec<Flown>, String> {
    let mut jobs = Vec::new();
    for (case, _) in CASES.iter().enumerate().filter(|(_, case)| wanted(case)) {
        for hard in [false, true] {
            jobs.extend((1..=seeds).map(|seed| Job { case, hard, seed }));
        }
    }
    parallel::map(&jobs, fly).map_err(|error| error.to_string())
}

/// The flights of each case and day.
fn by_day(flown: &[Flown]) -> impl Iterator<Item = &[Flown]> {
    flown.chunk_by(|one, next| (one.case, one.hard) == (next.case, next.hard))
}

/// Results of the cases for which something must hold.
///
/// # Errors
/// What went wrong with the measurement.
pub(crate) fn judged(seeds: u64) -> Result<Vec<Row>, String> {
    let flown = flown(seeds, |case| case.limits.is_some())?;
    Ok(by_day(&flown).map(|flights| Row::new(CASES[flights[0].case].name, flights)).collect())
}

/// Flies all cases whose name contains `only` with seeds from 1.
///
/// # Errors
/// What went wrong with the measurement.
pub(crate) fn run(seeds: u64, only: Option<&str>, each: bool) -> Result<(String, bool), String> {
    let mut text = format!(
        "{:<22}{:<8}{:>8}{:>20}{:>20}{:>9}{:>9}{:>9}{:>8}{:>7}\n",
        "what",
        "day",
        "time s",
        "truth rms/worst m",
        "estimate rms/worst",
        "in 2 σ",
        "heading°",
        "landing",
        "seen",
        "lost"
    );
    let mut good = true;
    let flown = flown(seeds, |case| only.is_none_or(|only| case.name.contains(only)))?;
    for flights in by_day(&flown) {
        let row = Row::new(CASES[flights[0].case].name, flights);
        good &= row.is_good;
        _ = writeln!(text, "{}{}", row.line(), if row.is_good { "" } else { "  BAD" });
        for flight in flights.iter().filter(|_| each) {
            let name = format!("  seed {} {}", flight.seed, flight.outcome);
            _ = writeln!(text, "{}", Row::new(&name, std::slice::from_ref(flight)).line());
        }
    }
    Ok((text, good))
}

fn simulation(job: Job) -> Result<Simulation, String> {
    let case = &CASES[job.case];
    let (sensors, camera) = if job.hard {
        (SensorModel::hard(), CameraModel::hard())
    } else {
        (SensorModel::nominal(), CameraModel::nominal())
    };
    let mut drone = DroneConfig {
        seed: job.seed,
        sensors,
        camera: (case.camera)(camera),
        battery_percent: 100.0,
        ..DroneConfig::default()
    };
    let mut link = LinkFaults::default();
    if job.hard {
        drone.wind_m_s = Vector2::new(0.5, -0.4);
        drone.gusts_m_s = 0.2;
        drone.trim_error_deg = 0.6;
        link.loss = 0.03;
    }
    let scenario =
        Scenario::parse("scenario", &(case.scenario)()).map_err(|error| error.to_string())?;
    let tags = case.tags.iter().map(|(x, y, heading)| FloorTag::new(*x, *y, *heading)).collect();
    let mut pilot = VehicleConfig::default();
    pilot.estimator.tags = Some(TagConfig::default());
    Ok(Simulation {
        world: WorldConfig { drone, link, scenario, tags, ..WorldConfig::default() },
        pilot,
        ..Simulation::default()
    })
}

fn fly(job: Job) -> Result<Flown, TagError> {
    const SETTLED: Duration = Duration::from_secs(30);
    const LAPS: usize = 50;
    // No plan may outlast the battery. So the laps are appended in flight.
    let lap = (CASES[job.case].lap)();
    let case = &CASES[job.case];
    let text = if case.lands_on_tag { format!("{lap}landOnTag") } else { lap.repeat(5) };
    let plan = Plan::parse("plan", &format!("takeoff\n{text}"))
        .map_err(|error| TagError::Text(error.to_string()))?;
    let laps = Commands::parse("laps", &lap.repeat(LAPS))
        .map_err(|error| TagError::Text(error.to_string()))?;
    let mut simulation = simulation(job).map_err(TagError::Text)?;
    if !case.lands_on_tag {
        simulation.orders = vec![(Duration::from_secs(20), OperatorOrder::Append(laps))];
    }
    let mut flown = Flown { case: job.case, hard: job.hard, seed: job.seed, ..Flown::default() };
    let mut took_off = None;
    let flight = simulation.fly_watched(plan, |moment: &Moment| {
        let Some(target) = moment.status.target else { return };
        let since = moment.now.saturating_sub(*took_off.get_or_insert(moment.now));
        if since < SETTLED {
            return;
        }
        let truth = moment.truth.position_m.xy();
        let pose = moment.status.pose.unwrap_or_default();
        let off = truth - Vector2::new(pose.x_m, pose.y_m);
        let astray_m = (truth - Vector2::new(target.x_m, target.y_m)).norm();
        flown.time_s = since.as_secs_f64();
        flown.moments += 1.0;
        flown.truth_squares += astray_m * astray_m;
        flown.truth_worst_m = flown.truth_worst_m.max(astray_m);
        flown.estimate_squares += off.norm_squared();
        flown.estimate_worst_m = flown.estimate_worst_m.max(off.norm());
        let most_m = 2.0 * moment.status.uncertainty_m;
        flown.inside +=
            off.iter().map(|off| f64::from(u8::from(off.abs() <= most_m)) / 2.0).sum::<f64>();
        let turned = moment.truth.yaw_deg - pose.yaw_deg;
        flown.heading_deg = wrap_deg(turned).abs();
        let seen = moment.status.tags.and_then(|tags| tags.seen_ago);
        flown.seen += f64::from(u8::from(seen.is_some_and(|ago| ago < Duration::from_millis(500))));
    })?;
    let meant_m = case.tags.first().filter(|_| case.lands_on_tag);
    let meant_m = meant_m.map_or(Vector2::zeros(), |(x, y, _)| Vector2::new(*x, *y));
    flown.landing_m = (flight.final_truth.position_m.xy() - meant_m).norm();
    flown.outcome = flight.outcome.to_string();
    flown.as_meant = if case.lands_on_tag {
        flight.outcome == Outcome::Completed
    } else {
        flown.outcome.contains("battery")
    };
    if case.lands_on_tag {
        flown.time_s = flight.duration.as_secs_f64();
    }
    Ok(flown)
}

/// What went wrong with the measurement, not with a flight.
#[derive(Debug, thiserror::Error)]
enum TagError {
    #[error("{0}")]
    Text(String),
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}
