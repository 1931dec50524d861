//! Fleets drawn at random: starts, plans, airframes, wind, the faults of the campaign of single flights, and an air that loses,
//! delays and falsifies messages.

use std::time::Duration;

use autopilot::vehicle::{OperatorOrder, Start, Ultrasound, VehicleConfig};
use kinematics::body_from_world;
use mock_drone::scenario::{Action, When};
use mock_drone::{DroneConfig, LinkFaults, WorldConfig};
use nalgebra::Vector2;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::{Air, Falsehood, Fleet, Injected, Lie, Member, Partition};
use crate::airframes::{AIRFRAMES, Airframes, strongest_wind_m_s};
use crate::campaign;

/// The vehicles start within this square, and fly within another.
const STARTS_M: f64 = 4.5;
const TARGETS_M: f64 = 4.0;
/// Two do not start nearer to each other.
const APART_M: f64 = 2.2;
/// All have wind from one side, each at most this share of what its own airframe resists.
const MOST_WIND: f64 = 0.3;
/// How many of the vehicles have faults of their own, and a bad link.
const FAULTY: f64 = 0.4;
const BAD_LINK: f64 = 0.15;
/// How many fleets meet a storm, in how many an operator cuts motors, one tells what is not so, and some do not hear some.
const STORM: f64 = 0.05;
const CUT: f64 = 0.04;
const LIE: f64 = 0.3;
const SILENCE: f64 = 0.15;
const PARTITION: f64 = 0.3;

impl Fleet {
    /// The fleet of a seed.
    pub fn random(seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let random = &mut random;
        let wind = Vector2::new(random.random_range(-1.0..1.0), random.random_range(-1.0..1.0));
        let gusts = random.random_range(0.0..0.5);
        let mut starts_m: Vec<Vector2<f64>> = Vec::new();
        let count = random.random_range(2..=5);
        while starts_m.len() < count {
            let place_m = place(random, STARTS_M);
            if starts_m.iter().all(|other| (other - place_m).norm() > APART_M) {
                starts_m.push(place_m);
            }
        }
        let members = starts_m.into_iter().zip(0..).map(|(place_m, number)| {
            let airframe = random.random_range(0..AIRFRAMES.len());
            let seed = seed * 8 + number;
            let profile = Airframes::Any.profile(airframe, seed);
            let strongest_m_s = strongest_wind_m_s(&profile) * MOST_WIND;
            let heading_deg = random.random_range(-180.0..180.0);
            let drone = DroneConfig {
                profile,
                seed,
                // In the frame of its start.
                wind_m_s: body_from_world(wind * strongest_m_s / 2.0, heading_deg),
                gusts_m_s: gusts * strongest_m_s / 2.0,
                ..DroneConfig::default()
            };
            let is_faulty = random.random_bool(FAULTY);
            let injected = if is_faulty {
                campaign::injected(random, strongest_m_s, false)
            } else {
                Injected::default()
            };
            let has_bad_link = random.random_bool(BAD_LINK);
            let link = if has_bad_link { campaign::link(random) } else { LinkFaults::default() };
            let ultrasound = if number % 2 == 0 { Ultrasound::Fast } else { Ultrasound::Slow };
            Member {
                start: Start { place_m, heading_deg, ..Start::default() },
                plan: plan(random),
                world: WorldConfig { drone, link, ..WorldConfig::default() },
                pilot: VehicleConfig { ultrasound: Some(ultrasound), ..VehicleConfig::default() },
                orders: Vec::new(),
                stands: None,
                is_foreign: false,
                injected,
            }
        });
        let mut members: Vec<Member> = members.collect();
        if random.random_bool(STORM) {
            storm(random, &mut members);
        }
        if random.random_bool(CUT) {
            let number = random.random_range(0..count);
            members[number].orders = vec![(seconds(random, 6.0, 30.0), OperatorOrder::Cut)];
        }
        for member in &mut members {
            member.world.scenario = member.injected.scenario();
        }
        Self { members, air: air(random, count, seed) }
    }
}

fn place(random: &mut ChaCha8Rng, within_m: f64) -> Vector2<f64> {
    Vector2::from_fn(|_, _| random.random_range(-within_m..within_m))
}

fn plan(random: &mut ChaCha8Rng) -> String {
    let steps = (0..random.random_range(1..=3)).map(|_| {
        let [x_m, y_m] = place(random, TARGETS_M).into();
        let (z_m, yaw_deg) = (random.random_range(-0.2..0.9), random.random_range(-180.0..180.0));
        format!("goto {x_m:.2} {y_m:.2} {z_m:.2} {yaw_deg:.0}\n")
    });
    let steps: String = steps.collect();
    format!("takeoff\n{steps}land\n")
}

/// A wind for all, from one side, that is stronger than at least one airframe resists.
fn storm(random: &mut ChaCha8Rng, members: &mut [Member]) {
    let strongest_m_s = members.iter().map(|it| strongest_wind_m_s(&it.world.drone.profile));
    let weakest_m_s = strongest_m_s.fold(f64::INFINITY, f64::min);
    let (sin, cos) = random.random_range(0.0..std::f64::consts::TAU).sin_cos();
    let wind_m_s = Vector2::new(sin, cos) * weakest_m_s * random.random_range(1.1..1.5);
    let at = When::SinceStart(seconds(random, 8.0, 30.0));
    for member in members {
        let own_m_s = body_from_world(wind_m_s, member.start.heading_deg);
        member.injected.accidents.push((at, Action::Wind(own_m_s, 0.0)));
    }
}

fn air(random: &mut ChaCha8Rng, count: usize, seed: u64) -> Air {
    let silent = random.random_bool(SILENCE).then(|| interval(random, 0.5, 6.0));
    let partitions = if random.random_bool(PARTITION) { partitions(random, count) } else { vec![] };
    Air {
        loss: if random.random_bool(0.5) { random.random_range(0.0..0.3) } else { 0.0 },
        delay: Duration::from_millis(random.random_range(0..200)),
        jitter: if random.random_bool(0.5) { seconds(random, 0.0, 0.2) } else { Duration::ZERO },
        silent,
        partitions,
        lie: random.random_bool(LIE).then(|| lie(random, count)),
        seed,
        is_shared: true,
    }
}

/// Two of which one does not hear the other, or neither does.
fn partitions(random: &mut ChaCha8Rng, count: usize) -> Vec<Partition> {
    let of = random.random_range(0..count);
    let by = (of + random.random_range(1..count)) % count;
    let at = interval(random, 0.5, 20.0);
    let one = Partition { of, by, at };
    let other = Partition { of: by, by: of, at };
    if random.random_bool(0.5) { vec![one] } else { vec![one, other] }
}

fn lie(random: &mut ChaCha8Rng, count: usize) -> Lie {
    let (sin, cos) = random.random_range(0.0..std::f64::consts::TAU).sin_cos();
    let direction = Vector2::new(sin, cos);
    let what = match random.random_range(0..6) {
        0 => Falsehood::Place(direction * random.random_range(2.0..8.0)),
        1 => Falsehood::Jumps(random.random_range(1.0..8.0)),
        2 => Falsehood::Creeps(direction * random.random_range(0.1..1.0)),
        3 => Falsehood::Velocity(direction * random.random_range(0.5..3.0)),
        4 => Falsehood::Stale,
        _ => Falsehood::Repeats,
    };
    Lie { who: random.random_range(0..count), since: seconds(random, 6.0, 25.0), what }
}

/// A time in flight that lasts so long, in seconds.
fn interval(random: &mut ChaCha8Rng, least_s: f64, most_s: f64) -> [Duration; 2] {
    let begins = seconds(random, 5.0, 25.0);
    [begins, begins + seconds(random, least_s, most_s)]
}

fn seconds(random: &mut ChaCha8Rng, from: f64, to: f64) -> Duration {
    Duration::from_secs_f64(random.random_range(from..to))
}
