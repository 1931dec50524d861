//! The fault campaign: flights with random faults, and rules that must hold in all of them.
//!
//! Everything about a flight follows from its seed: airframe, sensors, air, link, faults and operator orders.
//! [`fly`] flies it and [judges](Verdict) it against the truth.

mod fault;
mod fence;
mod flight;
mod injected;
mod judge;
mod orders;
mod silence;
mod station;
mod tags;
mod targets;

use std::time::Duration;

use autopilot::outcome::Outcome;
use autopilot::vehicle::{FlightEvent, LandingReason};

use crate::airframes::Airframes;
use crate::sim::SimulationError;

pub use self::fault::{Danger, Fault};
use self::flight::Flight;
pub(crate) use self::flight::{injected, link};
pub(crate) use self::injected::Injected;
use self::judge::Judge;

/// Result of a flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// Seed, which determines everything.
    pub seed: u64,
    /// Outcome as reported by the vehicle.
    pub outcome: Outcome,
    /// Reason of an early landing.
    pub landing: Option<LandingReason>,
    /// Whether the safety monitor replaced a command.
    pub vetoed: bool,
    /// Largest distance outside the fence, corrected by the error of healthy sensors, in a wind that the
    /// airframe resists.
    pub outside_m: f64,
    /// Largest position error of healthy sensors.
    pub wrong_m: f64,
    /// Faults found, with their times; one of each kind.
    pub faults: Vec<(Duration, Fault)>,
    /// Events with their times.
    pub events: Vec<(Duration, FlightEvent)>,
    /// Description of the flight and its faults, one line each.
    pub circumstances: Vec<String>,
}

impl Verdict {
    /// Whether the plan was truly completed.
    pub fn is_success(&self) -> bool {
        self.outcome == Outcome::Completed && self.faults.is_empty()
    }
}

/// Flies the flight of a seed with a published airframe.
///
/// # Errors
/// As [`fly_of`].
pub fn fly(seed: u64) -> Result<Verdict, SimulationError> {
    fly_of(Airframes::Published, seed)
}

/// Flies the flight of a seed.
///
/// # Errors
/// [`SimulationError`] if the flight never ends, which is a failure of the campaign itself.
pub fn fly_of(airframes: Airframes, seed: u64) -> Result<Verdict, SimulationError> {
    let flight = Flight::of(airframes, seed);
    let mut judge = Judge::new(&flight);
    let flown = flight
        .simulation
        .fly_in_world(flight.plan.clone(), |moment, world| judge.watch(moment, world.drone()))?;
    let judged = judge.end(&flight, &flown);
    let landing = flown.events.iter().find_map(|(_, event)| match event {
        FlightEvent::LandingOrdered(reason) => Some(*reason),
        _ => None,
    });
    let vetoed = flown.events.iter().any(|(_, event)| matches!(event, FlightEvent::Veto(_)));
    Ok(Verdict {
        seed,
        outcome: flown.outcome,
        landing,
        vetoed,
        outside_m: judged.outside_m,
        wrong_m: judged.wrong_m,
        faults: judged.found,
        events: flown.events,
        circumstances: flight.circumstances(),
    })
}
