//! The fault campaign: flights on which anything may go wrong, and what must hold all the same.
//!
//! Everything about a flight follows from its seed: the airframe, its sensors, the air, the link, what
//! breaks and when, and what the pilot orders meanwhile. [`fly`] flies it and [judges](Verdict) it
//! against the truth.

mod fault;
mod fence;
mod flight;
mod injected;
mod judge;
mod orders;
mod targets;

use std::time::Duration;

use autopilot::outcome::Outcome;
use autopilot::vehicle::{FlightEvent, LandingReason};

use crate::sim::SimulationError;

pub use self::fault::{Danger, Fault};
use self::flight::Flight;
use self::judge::Judge;

/// How a flight was, seen from outside.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// Everything follows from it.
    pub seed: u64,
    /// How the pilot says that it ended.
    pub outcome: Outcome,
    /// Why the plan was given up, if it was.
    pub landing: Option<LandingReason>,
    /// The safety layer had its say.
    pub vetoed: bool,
    /// How far the drone was outside the fence, less what healthy sensors were wrong by, in a wind that
    /// its airframe resists.
    pub outside_m: f64,
    /// How wrong the place was at most that healthy sensors gave.
    pub wrong_m: f64,
    /// What must never happen and did, and when. One of a kind.
    pub faults: Vec<(Duration, Fault)>,
    /// What happened, and when.
    pub events: Vec<(Duration, FlightEvent)>,
    /// What was flown with what, and what went wrong: one line each.
    pub circumstances: Vec<String>,
}

impl Verdict {
    /// Whether the plan was flown to its end, in truth.
    pub fn is_success(&self) -> bool {
        self.outcome == Outcome::Completed && self.faults.is_empty()
    }
}

/// Flies the flight of a seed.
///
/// # Errors
/// [`SimulationError`] if the flight never ends: that is the campaign's own failure.
pub fn fly(seed: u64) -> Result<Verdict, SimulationError> {
    let flight = Flight::of(seed);
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
