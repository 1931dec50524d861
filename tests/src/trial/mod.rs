//! A flight and what its true course must be: world, vehicle, orders, and rules that hold in each tick.

mod must;

use std::time::Duration;

use autopilot::Plan;
use autopilot::plan::{Border, FlightLimits};
use autopilot::vehicle::VehicleConfig;
use mock_drone::airframe::Profile;
use mock_drone::firmware::Phase;
use mock_drone::scenario::Scenario;
use mock_drone::{DroneConfig, WorldConfig};

pub(crate) use self::must::Must;
use crate::sim::{Simulation, SimulationError};

/// The fence, unless a flight needs another one.
pub(crate) const FENCE: FlightLimits = FlightLimits::new(Border::circle(4.0), 0.3, 3.0);
/// A fault that does not end: longer than any flight.
pub(crate) const FOR_EVER: Duration = Duration::from_mins(30);
/// The drone holds its position above the start by then, 1.3 m high, and until the end of the plan.
pub(crate) const HOLDS_AT: Duration = Duration::from_secs(12);
pub(crate) const HOLD: &str = "takeoff\ngoto 0 0 0.5 0\nsetStayTime 60\ngoto 0 0 0.5 0\nland\n";
/// Time after the flight in which an uncontrolled drone must land by itself.
const AFTERMATH: Duration = Duration::from_secs(20);

/// Descriptions of all flights that did not end as they must.
///
/// # Errors
/// [`SimulationError`] if a flight never ends.
pub(crate) fn broken(
    trials: impl IntoIterator<Item = Trial>,
) -> Result<Vec<String>, SimulationError> {
    trials.into_iter().filter_map(|trial| trial.broken().transpose()).collect()
}

/// A flight and the rules for its true course.
pub(crate) struct Trial {
    what: String,
    plan: String,
    pub(crate) simulation: Simulation,
    must: Vec<Must>,
}

impl Trial {
    /// A flight of `plan` in still air, with an airframe and a scenario.
    pub(crate) fn new(
        what: String,
        plan: &str,
        profile: fn() -> Profile,
        scenario: Scenario,
    ) -> Self {
        let drone = DroneConfig { profile: profile(), ..DroneConfig::default() };
        let simulation = Simulation {
            world: WorldConfig { drone, scenario, ..WorldConfig::default() },
            pilot: VehicleConfig { limits: FENCE, ..VehicleConfig::default() },
            aftermath: AFTERMATH,
            ..Simulation::default()
        };
        Self { what, plan: plan.to_owned(), simulation, must: Vec::new() }
    }

    pub(crate) fn and(mut self, must: Must) -> Self {
        self.must.push(must);
        self
    }

    /// Description of the first violation, if any.
    fn broken(self) -> Result<Option<String>, SimulationError> {
        let Self { what, plan, simulation, mut must } = self;
        let plan = Plan::parse_within("trial", &plan, &simulation.pilot.limits)
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
