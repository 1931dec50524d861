//! Flights in which a single rule keeps the drone safe. Where several layers protect against a danger, random
//! flights cannot show that one of them is missing: these lead the drone into the situation that is left to it.
//!
//! As everywhere, only the truth is judged. The uncertainty that the vehicle claims is compared with the truth.

mod estimate;
mod monitor;
mod must;

use std::time::Duration;

use autopilot::Plan;
use autopilot::plan::{FlightLimits, ZOrigin};
use autopilot::vehicle::VehicleConfig;
use mock_drone::airframe::Profile;
use mock_drone::firmware::Phase;
use mock_drone::scenario::Scenario;
use mock_drone::{DroneConfig, WorldConfig};

use self::must::Must;
use crate::sim::{Simulation, SimulationError};

/// The fence of all flights.
const FENCE: FlightLimits =
    FlightLimits { radius_m: 4.0, ceiling_m: 3.0, floor_m: 0.3, z_origin: ZOrigin::Hover };
/// The drone holds its position above the start by then, and until the end of the plan.
const HOLDS_AT: Duration = Duration::from_secs(12);
const HOLD: &str = "takeoff\ngoto 0 0 0.5 0\nsetStayTime 60\ngoto 0 0 0.5 0\nland\n";
/// Time after the flight in which an uncontrolled drone must land by itself.
const AFTERMATH: Duration = Duration::from_secs(20);

/// Descriptions of all flights that did not end as they must.
///
/// # Errors
/// [`SimulationError`] if a flight never ends.
pub fn broken() -> Result<Vec<String>, SimulationError> {
    let families = [
        monitor::above_the_ceiling(),
        monitor::blind(),
        monitor::down_before_the_take_off()?,
        monitor::kept_away(),
        monitor::slow(),
        estimate::led_to_the_floor(),
        estimate::wrong_in_pulses(),
        estimate::right_again(),
        estimate::false_sights(),
        estimate::wrong_from_the_start(),
        estimate::wrong_after_a_gap(),
        estimate::wrong_after_a_gap_in_motion(),
        estimate::disturbed_turns()?,
        estimate::steps_in_a_turn()?,
        estimate::turns_in_the_wind(),
    ];
    let mut found = Vec::new();
    for trial in families.into_iter().flatten() {
        found.extend(trial.broken()?);
    }
    Ok(found)
}

/// A flight and the rules for its true course.
struct Trial {
    what: String,
    plan: String,
    simulation: Simulation,
    must: Vec<Must>,
}

impl Trial {
    /// A flight of `plan` in still air, with an airframe and a scenario.
    fn new(what: String, plan: &str, profile: fn() -> Profile, scenario: Scenario) -> Self {
        let drone = DroneConfig { profile: profile(), ..DroneConfig::default() };
        let simulation = Simulation {
            world: WorldConfig { drone, scenario, ..WorldConfig::default() },
            pilot: VehicleConfig { limits: FENCE, ..VehicleConfig::default() },
            aftermath: AFTERMATH,
            ..Simulation::default()
        };
        Self { what, plan: plan.to_owned(), simulation, must: Vec::new() }
    }

    fn and(mut self, must: Must) -> Self {
        self.must.push(must);
        self
    }

    /// Description of the first violation, if any.
    fn broken(self) -> Result<Option<String>, SimulationError> {
        let Self { what, plan, simulation, mut must } = self;
        let plan = Plan::parse_within("rules", &plan, &simulation.pilot.limits)
            .unwrap_or_else(|error| panic!("{error}"));
        let mut found = None;
        let flown = simulation.fly_watched(plan, |moment| {
            for must in &mut must {
                let violation = must.violated(moment);
                found = found.take().or(violation);
            }
        })?;
        let phase = flown.final_truth.phase;
        if !matches!(phase, Phase::Landed | Phase::Emergency) {
            found.get_or_insert_with(|| format!("{phase:?} at the end"));
        }
        Ok(found.map(|found| format!("{what}: {found}")))
    }
}
