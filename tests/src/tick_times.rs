//! What a tick costs a vehicle among others, beside one that is alone: measured side by side in simulated time.
#![expect(clippy::disallowed_methods, reason = "it measures")]

use std::time::{Duration, Instant};

use crate::plan;
use ardrone_pilot::drive::{Driver, Simulated, Surroundings, Take};
use autopilot::Vehicle;
use autopilot::separation::{Neighbour, Presence};
use autopilot::vehicle::{CannotFly, Input, Start, Transmit, VehicleConfig};
use kinematics::Pose;
use mission_agent::MissionAgent;
use mock_drone::{World, WorldConfig};
use nalgebra::Vector2;

/// The vehicle goes to and fro in the middle of the others.
const PLAN: &str = "takeoff\ngoto 0 1 0 0\ngoto 0 -1 0 0\ngoto 0 1 0 0\ngoto 0 -1 0 0\nland\n";
/// A round that it flies with an agent: home, and two places.
const ROUND_M: [f64; 3] = [0.0, 1.0, -1.0];
/// The others stand in the air on a ring around it.
const RING_M: f64 = 6.0;

/// A simulated drone, with the time that each tick of its vehicle takes.
struct Timed {
    drone: Simulated,
    begun: Option<Instant>,
    /// When the last datagram of the tick was sent: what follows is the agent's.
    sent: Option<Instant>,
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
        self.sent = Some(Instant::now());
        self.drone.send(now, transmit);
    }
}

/// A row for a vehicle alone, one for each number of others, and one for a step of a mission agent, which follows a tick.
///
/// # Errors
/// [`CannotFly`] if the plan or the limits are refused.
///
/// # Panics
/// Never: the agent is built in.
pub fn report(others: &[u8]) -> Result<String, CannotFly> {
    let mut text =
        format!("\n{:<22}{:>8}{:>10}{:>10}{:>10}\n", "a tick", "ticks", "median", "p99", "worst");
    for count in [0].iter().chain(others) {
        let (ticks, _) = fly(*count, None)?;
        text += &row(&format!("with {count} others"), ticks);
    }
    let most = others.iter().copied().max().unwrap_or_default();
    let places = ROUND_M.map(|y_m| Pose { x_m: 0.0, y_m, z_m: 1.0, yaw_deg: 0.0 });
    let agent = MissionAgent::new("wingman", "leader", places.to_vec(), false)
        .expect("it is one of the agents that are built in, and one of its names");
    let (ticks, steps) = fly(most, Some(agent))?;
    text += &row("and with an agent", ticks);
    text += &row("a step of that agent", steps);
    Ok(text)
}

fn row(what: &str, mut spent: Vec<Duration>) -> String {
    spent.sort_unstable();
    let share = |percent: usize| {
        let at = (spent.len() * percent / 100).min(spent.len().saturating_sub(1));
        spent.get(at).copied().unwrap_or_default().as_secs_f64() * 1e6
    };
    format!(
        "{what:<22}{:>8}{:>7.1} µs{:>7.1} µs{:>7.1} µs\n",
        spent.len(),
        share(50),
        share(99),
        share(100)
    )
}

/// The time of each tick of a flight among so many others, and of each step of its agent, which flies instead of the plan.
fn fly(
    others: u8,
    agent: Option<MissionAgent>,
) -> Result<(Vec<Duration>, Vec<Duration>), CannotFly> {
    let mut config = VehicleConfig { system: 100, ..VehicleConfig::default() };
    config.starts_at(Some(Start::default()));
    let drone = Simulated::new(World::new(&WorldConfig::default()));
    let timed = Timed { drone, begun: None, sent: None, spent: Vec::new() };
    let vehicle = match agent {
        Some(_) => Vehicle::new(&config)?,
        None => Vehicle::flying(plan(PLAN), &config)?,
    };
    let mut driver = Driver::over(vehicle, timed);
    driver.agent = agent;
    let mut steps = Vec::new();
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
                uncertainty_m: 0.1,
                separation_m: 1.5,
                presence: Presence::Flies,
                claim: None,
            };
            // It is at rest, and believed.
            _ = driver.handle(Input::Neighbour(neighbour), |_, _| {});
        }
        let ticked = driver.step(|_, _| {});
        let sent = driver.surroundings.sent.take().filter(|_| ticked && driver.agent.is_some());
        steps.extend(sent.map(|sent| sent.elapsed()));
        driver.pass();
    }
    Ok((driver.surroundings.spent, steps))
}
