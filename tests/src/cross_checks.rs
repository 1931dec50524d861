//! What contradicts a wrong place: tags on the floor, and GPS. Healthy flights must never be contradicted; how often wrong
//! ones are is counted.

use std::time::Duration;

use autopilot::Plan;
use autopilot::outcome::Outcome;
use autopilot::plan::{Border, FlightLimits};
use autopilot::vehicle::{FlightEvent, SurveyedTag, TagConfig, VehicleConfig};
use mock_drone::firmware::Phase;
use mock_drone::scenario::{Action, Scenario, When};
use mock_drone::sensors::SensorModel;
use mock_drone::{
    CameraModel, DroneConfig, FloorTag, LinkFaults, Quantity, SensorFault, Tag27, WorldConfig,
};
use nalgebra::Vector2;
use rand::{Rng, RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use crate::airframes::AIRFRAMES;
use crate::sim::{Simulation, SimulationError};
use crate::trial::{self, FOR_EVER};

/// Far enough for a drone to get lost in.
const FENCE: FlightLimits = FlightLimits { border: Border::circle(30.0), ..trial::FENCE };
/// A velocity becomes wrong by then at the earliest: the drone has seen its tag.
const EARLIEST: Duration = Duration::from_secs(12);
/// Steady wind at most, in m/s.
const WIND_M_S: f64 = 0.8;
/// A drone that is this far from where it says is elsewhere.
const ELSEWHERE_M: f64 = 3.0;
/// Standard deviation of a healthy GPS on each axis: it is 3 to 5 m off.
const GPS_M: std::ops::Range<f64> = 2.2..3.6;
/// Tags further apart than they can be confused.
const TAGS: [[f64; 2]; 4] = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0]];

/// What is wrong with the velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wrong {
    /// Nothing.
    Nothing,
    /// Both components are noise around zero.
    Dead,
    /// It is multiplied by this.
    Gain(f64),
}

/// What else knows of the place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Knows {
    /// One to four tags, surveyed or not.
    Tags,
    /// A flight recorder.
    Gps,
}

/// All combinations that are flown, with their names.
pub const CASES: [(&str, Wrong, Knows); 8] = [
    ("healthy, tags", Wrong::Nothing, Knows::Tags),
    ("healthy, GPS", Wrong::Nothing, Knows::Gps),
    ("velocity dead with noise, tags", Wrong::Dead, Knows::Tags),
    ("velocity dead with noise, GPS", Wrong::Dead, Knows::Gps),
    ("velocity gain 0.4, tags", Wrong::Gain(0.4), Knows::Tags),
    ("velocity gain 0.4, GPS", Wrong::Gain(0.4), Knows::Gps),
    ("velocity gain -1, tags", Wrong::Gain(-1.0), Knows::Tags),
    ("velocity gain -1, GPS", Wrong::Gain(-1.0), Knows::Gps),
];

/// How a flight ended, and whether its place was contradicted.
#[derive(Debug, Clone, PartialEq)]
pub struct Told {
    /// Determines everything.
    pub seed: u64,
    /// Its outcome.
    pub outcome: Outcome,
    /// Whether something contradicted the place.
    pub contradicted: bool,
    /// How far the drone was from where it said, at most and in the air.
    pub off_m: f64,
}

impl Told {
    /// Whether the drone was elsewhere.
    pub fn was_elsewhere(&self) -> bool {
        self.off_m > ELSEWHERE_M
    }

    /// Whether it was elsewhere and said that its plan was flown.
    pub fn is_false_success(&self) -> bool {
        self.was_elsewhere() && self.outcome == Outcome::Completed
    }
}

/// Flies the flight of a seed.
///
/// # Errors
/// [`SimulationError`] if it never ends.
///
/// # Panics
/// If it makes a plan that cannot be flown, which is a mistake here.
pub fn fly(wrong: Wrong, knows: Knows, seed: u64) -> Result<Told, SimulationError> {
    let mut random = ChaCha8Rng::seed_from_u64(seed ^ 0x7769_746e);
    let random = &mut random;
    let is_hard = random.random_bool(0.5);
    let (sin, cos) = random.random_range(0.0..std::f64::consts::TAU).sin_cos();
    let (sensors, camera) = if is_hard {
        (SensorModel::hard(), CameraModel::hard())
    } else {
        (SensorModel::nominal(), CameraModel::nominal())
    };
    let drone = DroneConfig {
        seed,
        profile: (AIRFRAMES[random.random_range(0..AIRFRAMES.len())].profile)(),
        sensors,
        camera,
        wind_m_s: Vector2::new(sin, cos) * random.random_range(0.0..WIND_M_S),
        gusts_m_s: random.random_range(0.0..0.3),
        tag_27: if knows == Knows::Gps { Tag27::Gps } else { Tag27::Absent },
        gps_error_m: random.random_range(GPS_M),
        ..DroneConfig::default()
    };
    let link = LinkFaults { loss: random.random_range(0.0..0.05), ..LinkFaults::default() };
    let plan = plan(random);
    let mut scenario = faults(wrong, EARLIEST + seconds(random, 0.0, 20.0));
    let mut pilot = VehicleConfig { limits: FENCE, ..VehicleConfig::default() };
    pilot.gps = knows == Knows::Gps;
    if knows == Knows::Tags {
        let tags = &TAGS[..random.random_range(1..=TAGS.len())];
        pilot.estimator.tags = Some(tag_config(tags, random.random_bool(0.5)));
        for [x_m, y_m] in tags {
            let tag = FloorTag::new(*x_m, *y_m, 0.0);
            scenario = scenario.and(When::SinceStart(Duration::ZERO), Action::LayTag(tag));
        }
    }
    let world = WorldConfig { drone, link, scenario, ..WorldConfig::default() };
    let simulation = Simulation { world, pilot, ..Simulation::default() };
    let mut off_m: f64 = 0.0;
    let flight = simulation.fly_watched(plan, |moment| {
        let truth = &moment.truth;
        if let (Phase::Flying, Some(pose)) = (truth.phase, moment.status.pose) {
            off_m = off_m.max((truth.position_m.xy() - Vector2::new(pose.x_m, pose.y_m)).norm());
        }
    })?;
    let contradicted = flight
        .events
        .iter()
        .any(|(_, event)| matches!(event, FlightEvent::PlaceContradicted { .. }));
    Ok(Told { seed, outcome: flight.outcome, contradicted, off_m })
}

fn tag_config(tags: &[[f64; 2]], surveyed: bool) -> TagConfig {
    let mut config = TagConfig::default();
    for (slot, [x_m, y_m]) in config.surveyed.iter_mut().zip(tags).filter(|_| surveyed) {
        let place_m = Vector2::new(*x_m, *y_m);
        *slot = Some(SurveyedTag { place_m, heading_deg: Some(0.0) });
    }
    config
}

fn faults(wrong: Wrong, at: Duration) -> Scenario {
    let fault = match wrong {
        Wrong::Nothing => return Scenario::default(),
        Wrong::Dead => SensorFault::DeadAt(0.0),
        Wrong::Gain(gain) => SensorFault::Gain(gain),
    };
    [Quantity::VelocityRight, Quantity::VelocityForward].into_iter().fold(
        Scenario::default(),
        |scenario, quantity| {
            scenario.and(When::SinceStart(at), Action::Sensor(quantity, fault, FOR_EVER))
        },
    )
}

/// From tag to tag and beyond, with stays and some turns, back to the start.
fn plan(random: &mut impl Rng) -> Plan {
    use std::fmt::Write as _;
    let mut text = "takeoff\nsetReference $START$\ngoto 0 0 1.5 0\n".to_owned();
    // In a long hold in the wind a dead velocity leads furthest.
    let longest_s = if random.random_bool(0.3) { 60.0 } else { 10.0 };
    for _ in 0..random.random_range(2..6) {
        let [x, y] = if random.random_bool(0.6) {
            TAGS[random.random_range(0..TAGS.len())]
        } else {
            [0; 2].map(|_| random.random_range(-4.0..4.0))
        };
        let z = random.random_range(1.0..2.4);
        let yaw = if random.random_bool(0.3) { random.random_range(-180.0..180.0) } else { 0.0 };
        let stay_s = random.random_range(0.5..longest_s);
        // Writing to a string cannot fail.
        _ = write!(text, "setStayTime {stay_s:.1}\ngoto {x:.2} {y:.2} {z:.2} {yaw:.0}\n");
    }
    text += "goto 0 0 1.5 0\nland\n";
    Plan::parse_within("cross-checks", &text, &FENCE).unwrap_or_else(|error| panic!("{error}"))
}

fn seconds(random: &mut impl Rng, from: f64, to: f64) -> Duration {
    Duration::from_secs_f64(random.random_range(from..to))
}
