//! Healthy drones on a link that loses and delays datagrams: flights that nothing but a false alarm lands early.

use std::fmt::Write as _;
use std::time::Duration;

use autopilot::Plan;
use autopilot::outcome::Outcome;
use autopilot::plan::{Border, FlightLimits};
use autopilot::vehicle::{OperatorOrder, VehicleConfig};
use kinematics::Sticks;
use mock_drone::sensors::SensorModel;
use mock_drone::{DroneConfig, LinkFaults, WorldConfig};
use nalgebra::Vector2;
use rand::{Rng, RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use crate::sensors::AIRFRAMES;
use crate::sim::{Simulation, SimulationError};
use crate::trial::FENCE;

const LIMITS: FlightLimits = FlightLimits { border: Border::circle(12.0), ceiling_m: 6.0, ..FENCE };
/// The strongest wind of these days; the weakest airframe resists 2 m/s.
const MOST_WIND_M_S: f64 = 0.5;
/// Shortest and longest time that a datagram is under way, in milliseconds.
const DELAY_MS: [u64; 2] = [20, 150];
/// Up to this time of a datagram, in milliseconds, a link is an ordinary one: 40 to 150 ms there and back.
const ORDINARY_MS: u128 = 75;
/// Interval at which a held key repeats.
const REPEATED: Duration = Duration::from_millis(100);

/// A healthy flight.
#[derive(Debug, Clone, PartialEq)]
pub struct HealthyFlight {
    /// The flight, for reports.
    pub description: String,
    /// How it ended.
    pub outcome: Outcome,
    /// Whether the link was one of 40 to 150 ms there and back; else it was one of up to 300 ms.
    pub is_ordinary: bool,
}

impl HealthyFlight {
    /// Whether it was landed although nothing was wrong.
    pub fn is_landed_without_need(&self) -> bool {
        self.outcome != Outcome::Completed
    }
}

/// Flies the healthy flight of a seed: a plan with turns, interrupted by an operator with full sticks.
///
/// # Errors
/// [`SimulationError`] if it never ends.
pub fn fly(seed: u64) -> Result<HealthyFlight, SimulationError> {
    let (simulation, plan, description) = prepared(seed);
    let flight = simulation.fly(plan)?;
    Ok(HealthyFlight {
        description: format!("{:.1} s of {description}", flight.duration.as_secs_f64()),
        outcome: flight.outcome,
        is_ordinary: simulation.world.link.delay.as_millis() <= ORDINARY_MS,
    })
}

/// The flight of a seed, its plan, and its description.
///
/// # Panics
/// If it makes a plan that cannot be flown, which is a mistake here.
pub fn prepared(seed: u64) -> (Simulation, Plan, String) {
    let mut random = ChaCha8Rng::seed_from_u64(seed ^ 0x6865_616c);
    let random = &mut random;
    let airframe = AIRFRAMES[random.random_range(0..AIRFRAMES.len())];
    let is_hard = random.random_bool(0.5);
    let sensors = if is_hard { SensorModel::hard() } else { SensorModel::nominal() };
    let link = LinkFaults {
        loss: random.random_range(0.0..0.1),
        delay: Duration::from_millis(random.random_range(DELAY_MS[0]..=DELAY_MS[1])),
        jitter: Duration::from_millis(random.random_range(0..20)),
        ..LinkFaults::default()
    };
    let (sin, cos) = random.random_range(0.0..std::f64::consts::TAU).sin_cos();
    let wind_m_s = Vector2::new(sin, cos) * random.random_range(0.0..MOST_WIND_M_S);
    let text = plan(random);
    let (orders, by_hand) = manual(random);
    let drone = DroneConfig {
        profile: (airframe.profile)(),
        seed,
        sensors,
        wind_m_s,
        ..DroneConfig::default()
    };
    let simulation = Simulation {
        world: WorldConfig { drone, link, ..WorldConfig::default() },
        pilot: VehicleConfig { limits: LIMITS, ..VehicleConfig::default() },
        orders,
        ..Simulation::default()
    };
    let parsed = Plan::parse_within("healthy", &text, &LIMITS).unwrap_or_else(|e| panic!("{e}"));
    let description = format!(
        "{seed} {} {}, loss {:.1} %, delay {} ms, wind {:.1} {:.1}: {}; by hand{by_hand}",
        airframe.name,
        if is_hard { "hard" } else { "nominal" },
        100.0 * link.loss,
        link.delay.as_millis(),
        wind_m_s.x,
        wind_m_s.y,
        text.trim().replace('\n', "; "),
    );
    (simulation, parsed, description)
}

/// From short to long, with turns and climbs.
fn plan(random: &mut impl Rng) -> String {
    let mut text = "takeoff\n".to_owned();
    for _ in 0..random.random_range(1..12) {
        let [x, y] = [0; 2].map(|_| random.random_range(-3.0..3.0));
        let z = random.random_range(-0.2..2.0);
        let yaw = if random.random_bool(0.5) { random.random_range(-180.0..180.0) } else { 0.0 };
        _ = writeln!(text, "goto {x:.2} {y:.2} {z:.2} {yaw:.0}");
    }
    text + "land\n"
}

/// Full climbs, descents and turns by hand, each held for a while; then the mission goes on.
fn manual(random: &mut impl Rng) -> (Vec<(Duration, OperatorOrder)>, String) {
    let (mut orders, mut said) = (Vec::new(), String::new());
    let mut at = Duration::from_secs_f64(random.random_range(8.0..15.0));
    for _ in 0..random.random_range(0..4) {
        let full = if random.random_bool(0.5) { 1.0 } else { -1.0 };
        let still = Sticks::default();
        let (name, sticks, longest_s) = match random.random_range(0..4) {
            0 => ("climb", Sticks { gaz: full, ..still }, 3.0),
            1 => ("turn", Sticks { yaw: full, ..still }, 4.0),
            2 => ("roll", Sticks { roll: full, ..still }, 1.0),
            _ => ("pitch", Sticks { pitch: full, ..still }, 1.0),
        };
        let held_s = random.random_range(0.3..longest_s);
        _ = write!(said, " {:.2} s: {name} {full:+} for {held_s:.2} s;", at.as_secs_f64());
        let end = at + Duration::from_secs_f64(held_s);
        while at < end {
            orders.push((at, OperatorOrder::Steer(sticks)));
            at += REPEATED;
        }
        if random.random_bool(0.5) {
            orders.push((at, OperatorOrder::Hold));
            at += Duration::from_secs_f64(random.random_range(0.5..4.0));
        }
    }
    orders.push((at, OperatorOrder::Resume));
    (orders, said)
}
