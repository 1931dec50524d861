//! Healthy drones on a link that loses and delays datagrams, above boxes, in gusts, while the drone's clock wraps: flights
//! that nothing but a false alarm lands early.

use std::fmt::Write as _;
use std::ops::Range;
use std::time::Duration;

use autopilot::Plan;
use autopilot::outcome::Outcome;
use autopilot::plan::{Border, FlightLimits};
use autopilot::vehicle::{OperatorOrder, VehicleConfig};
use kinematics::Sticks;
use mock_drone::airframe::Profile;
use mock_drone::firmware::Phase;
use mock_drone::scenario::{Action, Scenario, When};
use mock_drone::sensors::SensorModel;
use mock_drone::{DroneConfig, LinkFaults, Quantity, SensorFault, WorldConfig};
use nalgebra::Vector2;
use rand::{Rng, RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use crate::airframes::{AIRFRAMES, Airframes, strongest_wind_m_s};
use crate::sim::{Simulation, SimulationError};
use crate::trial::{FENCE, FOR_EVER};

const LIMITS: FlightLimits = FlightLimits { border: Border::circle(12.0), ceiling_m: 6.0, ..FENCE };
/// The strongest wind of these days, and its largest share of what the airframe resists: just so much that each published
/// one flies in all of these winds.
const MOST_WIND_M_S: f64 = 0.5;
const MOST_WIND_SHARE: f64 = 0.62;
/// A gust hardly ever exceeds this many standard deviations, and none of those the wind that the drone resists.
const GUST_DEVIATIONS: f64 = 3.0;
/// Shortest and longest time that a datagram is under way, in milliseconds.
const DELAY_MS: [u64; 2] = [20, 150];
/// Up to this time of a datagram, in milliseconds, a link is an ordinary one: 40 to 150 ms there and back.
const ORDINARY_MS: u128 = 75;
/// Interval at which a held key repeats.
const REPEATED: Duration = Duration::from_millis(100);
/// Reading of the drone's clock when it is switched on here, and the one after which it begins again at 0.
const CLOCK_S: f64 = 31.4;
const CLOCK_WRAP_S: f64 = 2048.0;
/// Height of a box, and what is free above it, in metres.
const BOX_M: [f64; 2] = [0.1, 0.5];
const ABOVE_BOX_M: f64 = 0.4;
/// How long the drone is above a box, and then above the floor, in seconds.
const ON_BOX_S: [f64; 2] = [0.5, 6.0];
const OFF_BOX_S: [f64; 2] = [1.0, 8.0];

/// A healthy flight.
#[derive(Debug, Clone, PartialEq)]
pub struct HealthyFlight {
    /// The flight, for reports.
    pub description: String,
    /// How it ended.
    pub outcome: Outcome,
    /// What it was made of: the kind of each ingredient, and which of that kind.
    pub ingredients: Vec<(&'static str, &'static str)>,
}

impl HealthyFlight {
    /// Whether it was landed although nothing was wrong.
    pub fn is_landed_without_need(&self) -> bool {
        self.outcome != Outcome::Completed
    }
}

/// A flight that is to be flown.
#[derive(Debug)]
struct Prepared {
    simulation: Simulation,
    plan: Plan,
    description: String,
    ingredients: Vec<(&'static str, &'static str)>,
}

/// Flies the healthy flight of a seed: a plan with turns, interrupted by an operator with full sticks.
///
/// # Errors
/// [`SimulationError`] if it never ends.
pub fn fly(airframes: Airframes, seed: u64) -> Result<HealthyFlight, SimulationError> {
    let Prepared { simulation, plan, description, ingredients } = prepared(airframes, seed)?;
    let flight = simulation.fly(plan)?;
    Ok(HealthyFlight {
        description: format!("{:.1} s of {description}", flight.duration.as_secs_f64()),
        outcome: flight.outcome,
        ingredients,
    })
}

/// The flight of a seed.
fn prepared(airframes: Airframes, seed: u64) -> Result<Prepared, SimulationError> {
    let mut random = ChaCha8Rng::seed_from_u64(seed ^ 0x6865_616c);
    let random = &mut random;
    let airframe = random.random_range(0..AIRFRAMES.len());
    let (profile, airframe) = (airframes.profile(airframe, seed), airframes.name(airframe));
    let is_hard = random.random_bool(0.5);
    let sensors = if is_hard { SensorModel::hard() } else { SensorModel::nominal() };
    let link = LinkFaults {
        loss: random.random_range(0.0..0.1),
        delay: Duration::from_millis(random.random_range(DELAY_MS[0]..=DELAY_MS[1])),
        jitter: Duration::from_millis(random.random_range(0..20)),
        ..LinkFaults::default()
    };
    let (sin, cos) = random.random_range(0.0..std::f64::consts::TAU).sin_cos();
    let most_wind_m_s = MOST_WIND_M_S.min(MOST_WIND_SHARE * strongest_wind_m_s(&profile));
    let wind_m_s = Vector2::new(sin, cos) * random.random_range(0.0..most_wind_m_s);
    let is_long = random.random_bool(0.3);
    let text = plan(random, if is_long { 12..24 } else { 1..12 });
    let (orders, by_hand) = manual(random);
    let gusts_m_s = if random.random_bool(0.5) {
        random.random_range(0.0..most_gusts_m_s(&profile, wind_m_s.norm()))
    } else {
        0.0
    };
    let wraps_at_s = random.random_bool(0.4).then(|| random.random_range(6.0..25.0));
    let mut scenario = Scenario::default();
    if let Some(at_s) = wraps_at_s {
        let offset = SensorFault::Offset(CLOCK_WRAP_S - CLOCK_S - at_s);
        let clock = Action::Sensor(Quantity::Clock, offset, FOR_EVER);
        scenario = scenario.and(When::SinceStart(Duration::ZERO), clock);
    }
    let drone =
        DroneConfig { profile, seed, sensors, wind_m_s, gusts_m_s, ..DroneConfig::default() };
    let mut simulation = Simulation {
        world: WorldConfig { drone, link, scenario, ..WorldConfig::default() },
        pilot: VehicleConfig { limits: LIMITS, ..VehicleConfig::default() },
        orders,
        ..Simulation::default()
    };
    let parsed = Plan::parse_within("healthy", &text, &LIMITS).unwrap_or_else(|e| panic!("{e}"));
    let under_it =
        if random.random_bool(0.5) { boxes(random, &mut simulation, &parsed)? } else { Vec::new() };
    let is_ordinary = link.delay.as_millis() <= ORDINARY_MS;
    let ingredients = vec![
        ("airframe", airframe),
        ("day", if is_hard { "hard" } else { "nominal" }),
        ("link there and back", if is_ordinary { "40 to 150 ms" } else { "150 to 300 ms" }),
        ("plan", if is_long { "long" } else { "short" }),
        ("by hand", if by_hand.is_empty() { "nothing" } else { "full sticks" }),
        ("air", if gusts_m_s > 0.0 { "gusts" } else { "steady" }),
        ("clock", if wraps_at_s.is_some() { "wraps" } else { "goes on" }),
        (
            "floor",
            match under_it.len() {
                0 => "flat",
                1 => "one box",
                _ => "several boxes",
            },
        ),
    ];
    let description = format!(
        "{seed} {airframe} {}, loss {:.1} %, delay {} ms, wind {:.1} {:.1} gusts {gusts_m_s:.2}{}: {}; by hand{by_hand}{}",
        if is_hard { "hard" } else { "nominal" },
        100.0 * link.loss,
        link.delay.as_millis(),
        wind_m_s.x,
        wind_m_s.y,
        wraps_at_s.map_or_else(String::new, |at_s| format!(", clock wraps at {at_s:.1} s")),
        text.trim().replace('\n', "; "),
        under_it.concat(),
    );
    Ok(Prepared { simulation, plan: parsed, description, ingredients })
}

/// The largest standard deviation of gusts beside a wind that the airframe still resists, and the weakest published one
/// besides.
fn most_gusts_m_s(profile: &Profile, wind_m_s: f64) -> f64 {
    let published = AIRFRAMES.map(|model| strongest_wind_m_s(&(model.profile)()));
    let resists_m_s = published.into_iter().fold(strongest_wind_m_s(profile), f64::min);
    (resists_m_s - wind_m_s) / GUST_DEVIATIONS
}

/// Puts boxes under the way of the drone, which only its altitude notices, and describes them. Each lies where the drone
/// is high enough above it, until its landing.
fn boxes(
    random: &mut impl Rng,
    simulation: &mut Simulation,
    plan: &Plan,
) -> Result<Vec<String>, SimulationError> {
    let mut heights_m: Vec<(f64, f64)> = Vec::new();
    simulation.fly_watched(plan.clone(), |moment| {
        if moment.truth.phase == Phase::Flying {
            heights_m.push((moment.now.as_secs_f64(), moment.truth.position_m.z));
        }
    })?;
    let [Some(first), Some(last)] = [heights_m.first(), heights_m.last()] else {
        return Ok(Vec::new());
    };
    let (mut at_s, last_s) = (first.0, last.0);
    let mut said = Vec::new();
    for _ in 0..random.random_range(1..5) {
        at_s += random.random_range(OFF_BOX_S[0]..OFF_BOX_S[1]);
        let end_s = at_s + random.random_range(ON_BOX_S[0]..ON_BOX_S[1]);
        let height_m = random.random_range(BOX_M[0]..BOX_M[1]);
        let around = at_s - OFF_BOX_S[0]..end_s + OFF_BOX_S[0];
        let above = heights_m.iter().filter(|(time_s, _)| around.contains(time_s));
        let lowest_m = above.map(|(_, height_m)| *height_m).fold(f64::INFINITY, f64::min);
        let height_m = height_m.min(lowest_m - ABOVE_BOX_M);
        if around.end < last_s && height_m >= BOX_M[0] {
            let [at, time] = [at_s, end_s - at_s].map(Duration::from_secs_f64);
            let lower = Action::Sensor(Quantity::Altitude, SensorFault::Offset(-height_m), time);
            let scenario = std::mem::take(&mut simulation.world.scenario);
            simulation.world.scenario = scenario.and(When::SinceStart(at), lower);
            said.push(format!("; a box of {height_m:.2} m from {at_s:.1} to {end_s:.1} s"));
        }
        at_s = end_s;
    }
    Ok(said)
}

/// Some targets, with turns and climbs.
fn plan(random: &mut impl Rng, targets: Range<usize>) -> String {
    let mut text = "takeoff\n".to_owned();
    for _ in 0..random.random_range(targets) {
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use ardrone_link::navdata::Navdata;
    use ardrone_pilot::recording::Record;

    use super::*;

    #[test]
    fn each_ingredient_is_common() {
        const FLIGHTS: u64 = 120;
        let mut counts: BTreeMap<(&str, &str), usize> = BTreeMap::new();
        for seed in 0..FLIGHTS {
            for ingredient in prepared(Airframes::Published, seed).unwrap().ingredients {
                *counts.entry(ingredient).or_default() += 1;
            }
        }
        assert_eq!(counts.len(), AIRFRAMES.len() + 6 * 2 + 3, "{counts:?}");
        assert!(counts.values().all(|count| *count >= 15), "{counts:?}");
    }

    #[test]
    fn a_box_is_where_the_drone_flies_well_above_it() {
        let with_boxes = |up_m: f64| {
            let text =
                format!("takeoff\ngoto 0 0 {up_m} 0\nsetStayTime 30\ngoto 0 0 {up_m} 0\nland\n");
            let plan = Plan::parse_within("boxes", &text, &LIMITS).unwrap();
            let pilot = VehicleConfig { limits: LIMITS, ..VehicleConfig::default() };
            let found = (0..20).filter(|seed| {
                let mut simulation = Simulation { pilot: pilot.clone(), ..Simulation::default() };
                let random = &mut ChaCha8Rng::seed_from_u64(*seed);
                let is_under = !boxes(random, &mut simulation, &plan).unwrap().is_empty();
                let mut lowest_m = f64::INFINITY;
                let flown = simulation.fly_watched(plan.clone(), |moment| {
                    let altitude_m = moment.status.altitude_m.unwrap_or(f64::INFINITY);
                    if moment.truth.phase == Phase::Flying {
                        lowest_m = lowest_m.min(altitude_m);
                    }
                });
                flown.unwrap();
                assert!(lowest_m > ABOVE_BOX_M - 0.15, "{lowest_m} m above a box");
                is_under
            });
            found.count()
        };
        assert_eq!(with_boxes(-0.45), 0, "it flies 0.4 m high");
        assert!(with_boxes(0.0) > 10);
    }

    #[test]
    fn a_clock_that_wraps_does_so_in_flight() {
        for seed in 0..20 {
            let Prepared { simulation, plan, ingredients, .. } =
                prepared(Airframes::Published, seed).unwrap();
            let (mut last, mut wrapped_s) = (Duration::ZERO, None);
            let flown = simulation.fly_recorded(plan, |record| {
                let Record::Navdata { at, packet } = record else { return };
                let Some(clock) = Navdata::decode(&packet).unwrap().time else { return };
                if clock + Duration::from_secs(1000) < last {
                    wrapped_s = Some(at.as_secs_f64());
                }
                last = clock;
            });
            let end_s = flown.unwrap().duration.as_secs_f64();
            let wraps = ingredients.contains(&("clock", "wraps"));
            assert_eq!(wraps, wrapped_s.is_some(), "seed {seed}");
            assert!(wrapped_s.is_none_or(|s| (5.9..end_s.min(25.5)).contains(&s)), "{wrapped_s:?}");
        }
    }
}
