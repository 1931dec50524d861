//! Fleets drawn at random: starts, plans, airframes, wind, faults, and an air that loses and delays messages.

use std::time::Duration;

use autopilot::vehicle::{Start, VehicleConfig};
use mock_drone::scenario::{Action, Direction, Scenario, When};
use mock_drone::{DroneConfig, WorldConfig};
use nalgebra::Vector2;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::{Air, Fleet, Member};
use crate::airframes::{AIRFRAMES, Airframes, strongest_wind_m_s};

/// The vehicles start within this square, and fly within another.
const STARTS_M: f64 = 4.5;
const TARGETS_M: f64 = 4.0;
/// Two do not start nearer to each other.
const APART_M: f64 = 2.2;
/// All have wind from one side, each at most this share of what its own airframe resists.
const MOST_WIND: f64 = 0.3;

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
            let drone = DroneConfig {
                profile,
                seed,
                wind_m_s: wind * strongest_m_s / 2.0,
                gusts_m_s: gusts * strongest_m_s / 2.0,
                ..DroneConfig::default()
            };
            Member {
                start: Start {
                    place_m,
                    heading_deg: random.random_range(-180.0..180.0),
                    deviation_m: 0.0,
                },
                plan: plan(random),
                world: WorldConfig { drone, scenario: scenario(random), ..WorldConfig::default() },
                pilot: VehicleConfig::default(),
                orders: Vec::new(),
            }
        });
        Self { members: members.collect(), air: air(random, seed) }
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

/// Now and then the drone is not heard for a while, or its battery is empty.
fn scenario(random: &mut ChaCha8Rng) -> Scenario {
    let at = When::SinceTakeOff(Duration::from_secs_f64(random.random_range(4.0..20.0)));
    let time = Duration::from_secs_f64(random.random_range(0.2..3.0));
    match random.random_range(0..10) {
        0 => Scenario::default().and(at, Action::Outage(Direction::Both, time)),
        1 => Scenario::default().and(at, Action::Battery(8.0)),
        _ => Scenario::default(),
    }
}

fn air(random: &mut ChaCha8Rng, seed: u64) -> Air {
    let begins_s = random.random_range(5.0..25.0);
    let ends_s = begins_s + random.random_range(0.5..6.0);
    Air {
        loss: if random.random_bool(0.5) { random.random_range(0.0..0.3) } else { 0.0 },
        delay: Duration::from_millis(random.random_range(0..200)),
        silent: random.random_bool(0.3).then(|| [begins_s, ends_s].map(Duration::from_secs_f64)),
        lie: None,
        seed,
        is_shared: false,
    }
}
