//! What a tick costs a vehicle among others, beside one that is alone: measured side by side in simulated time.
#![expect(clippy::disallowed_methods, reason = "it measures")]

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use crate::plan;
use ardrone_pilot::drive::{Driver, Simulated, Surroundings, Take};
use autopilot::Vehicle;
use autopilot::separation::{Neighbour, Presence};
use autopilot::vehicle::{CannotFly, Input, Start, Transmit, VehicleConfig};
use mock_drone::{World, WorldConfig};
use nalgebra::Vector2;

/// The vehicle goes to and fro in the middle of the others.
const PLAN: &str = "takeoff\ngoto 0 1 0 0\ngoto 0 -1 0 0\ngoto 0 1 0 0\ngoto 0 -1 0 0\nland\n";
/// The others stand in the air on a ring around it.
const RING_M: f64 = 6.0;

/// A simulated drone, with the time that each tick of its vehicle takes.
struct Timed {
    drone: Simulated,
    begun: Option<Instant>,
    spent: Vec<Duration>,
}

impl Surroundings for Timed {
    fn now(&self) -> Duration {
        self.drone.now()
    }

    fn wait(&mut self, until: Duration) {
        self.drone.wait(until);
    }

    fn receive(&mut self, now: Duration, until: Option<Duration>, take: impl Take) {
        self.drone.receive(now, until, take);
        // What is received belongs to the simulation, too.
        self.begun = until.is_none().then(Instant::now);
    }

    fn send(&mut self, now: Duration, transmit: Transmit<'_>) {
        if let Some(begun) = self.begun.take() {
            self.spent.push(begun.elapsed());
        }
        self.drone.send(now, transmit);
    }
}

/// A row for a vehicle alone, and one for each number of others.
///
/// # Errors
/// [`CannotFly`] if the plan or the limits are refused.
pub fn report(others: &[u8]) -> Result<String, CannotFly> {
    let mut text =
        format!("\n{:<22}{:>8}{:>10}{:>10}{:>10}\n", "a tick", "ticks", "median", "p99", "worst");
    for count in [0].iter().chain(others) {
        let mut spent = ticks(*count)?;
        spent.sort_unstable();
        let share = |percent: usize| {
            let at = (spent.len() * percent / 100).min(spent.len().saturating_sub(1));
            spent.get(at).copied().unwrap_or_default().as_secs_f64() * 1e6
        };
        // Writing to a string cannot fail.
        _ = writeln!(
            text,
            "{:<22}{:>8}{:>7.1} µs{:>7.1} µs{:>7.1} µs",
            format!("with {count} others"),
            spent.len(),
            share(50),
            share(99),
            share(100)
        );
    }
    Ok(text)
}

/// The time of each tick of a flight among so many others.
fn ticks(others: u8) -> Result<Vec<Duration>, CannotFly> {
    let mut config = VehicleConfig { system: 100, ..VehicleConfig::default() };
    config.starts_at(Some(Start::default()));
    let drone = Simulated::new(World::new(&WorldConfig::default()));
    let timed = Timed { drone, begun: None, spent: Vec::new() };
    let mut driver = Driver::over(Vehicle::flying(plan(PLAN), &config)?, timed);
    while driver.vehicle.outcome().is_none() && driver.now() < Duration::from_mins(2) {
        let now = driver.now();
        for system in 1..=others {
            let angle_rad = std::f64::consts::TAU * f64::from(system) / f64::from(others);
            let place_m = Vector2::new(angle_rad.sin(), angle_rad.cos()) * RING_M;
            let neighbour = Neighbour {
                system,
                at: now,
                place_m,
                velocity_m_s: Vector2::zeros(),
                deviation_m: 0.1,
                separation_m: 1.5,
                presence: Presence::Flies,
                claim: None,
            };
            // It is at rest, and believed.
            _ = driver.handle(Input::Neighbour(neighbour), |_, _| {});
        }
        driver.step(|_, _| {});
        driver.pass();
    }
    Ok(driver.surroundings.spent)
}
