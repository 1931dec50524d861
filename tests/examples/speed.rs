//! How much faster than real time the simulation flies: `cargo run --release -p system-tests
//! --example speed`.
#![allow(clippy::print_stdout, clippy::disallowed_methods, reason = "it measures and prints")]

use std::time::{Duration, Instant};

use autopilot::sim::{Simulation, SimulationError};
use system_tests::{SQUARE, plan};

const FLIGHTS: u32 = 100;

fn main() -> Result<(), SimulationError> {
    let start = Instant::now();
    let mut flown = Duration::ZERO;
    for seed in 0..FLIGHTS {
        let mut simulation = Simulation::default();
        simulation.world.drone.seed = u64::from(seed);
        flown += simulation.fly(plan(SQUARE))?.duration;
    }
    let took = start.elapsed();
    let factor = flown.as_secs_f64() / took.as_secs_f64();
    println!(
        "{FLIGHTS} flights, {:.0} s of flight in {:.3} s: {factor:.0} times real time",
        flown.as_secs_f64(),
        took.as_secs_f64()
    );
    Ok(())
}
