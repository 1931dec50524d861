//! Gaps in the link around the moment at which a landing is ordered. The order is the one thing that must not be
//! lost in them: a gap that begins just before it swallows the order itself, one that begins just after it the
//! drone's answer. Random flights hardly ever hit these tenths of a second.

use std::time::Duration;

use autopilot::vehicle::OperatorOrder;
use mock_drone::WorldConfig;
use mock_drone::firmware::Phase;
use mock_drone::scenario::{Action, Direction, Scenario, When};

use crate::plan;
use crate::sim::{Simulation, SimulationError};

/// The drone holds its place then, 1.3 m high.
const ORDERED_AT: Duration = Duration::from_secs(12);
/// The first gap begins so long before the order, the others each so much later.
const BEFORE: Duration = Duration::from_millis(500);
const LATER: Duration = Duration::from_millis(100);
const BEGINNINGS: u32 = 12;
/// None is so long that the drone lands by itself.
const LENGTHS: [Duration; 3] =
    [Duration::from_millis(500), Duration::from_millis(1000), Duration::from_millis(1700)];
/// The drone sinks by a third of a metre a second at least.
const LANDS_WITHIN: Duration = Duration::from_secs(8);

/// Every landing that was not flown to the ground, in words.
///
/// # Errors
/// [`SimulationError`] if a flight never ends.
pub fn forgotten_landings() -> Result<Vec<String>, SimulationError> {
    let mut found = Vec::new();
    for direction in [Direction::Both, Direction::Up, Direction::Down] {
        for length in LENGTHS {
            for index in 0..BEGINNINGS {
                let begins = ORDERED_AT.saturating_sub(BEFORE) + LATER * index;
                let gap = Gap { direction, begins, length };
                found.extend(gap.forgotten()?);
            }
        }
    }
    Ok(found)
}

/// Nothing passes one way, or both.
#[derive(Debug, Clone, Copy)]
struct Gap {
    direction: Direction,
    begins: Duration,
    length: Duration,
}

impl Gap {
    /// What became of a landing that was ordered beside it, if the drone was not down in time for good.
    fn forgotten(self) -> Result<Option<String>, SimulationError> {
        let outage = Action::Outage(self.direction, self.length);
        let scenario = Scenario::default().and(When::SinceStart(self.begins), outage);
        let simulation = Simulation {
            world: WorldConfig { scenario, ..WorldConfig::default() },
            orders: vec![(ORDERED_AT, OperatorOrder::Land)],
            aftermath: Duration::from_secs(3),
            ..Simulation::default()
        };
        let due = ORDERED_AT.max(self.begins + self.length) + LANDS_WITHIN;
        let mut flew = false;
        let mut late = None;
        let text = "takeoff\ngoto 0 0 0.5 0\nsetStayTime 60\ngoto 0 0 0.5 0\nland\n";
        let flown = simulation.fly_watched(plan(text), |moment| {
            let lands = moment.truth.phase == Phase::Landed;
            flew |= moment.now < ORDERED_AT && moment.truth.phase == Phase::Flying;
            if moment.now >= due && !lands {
                late.get_or_insert(moment.truth.phase);
            }
        })?;
        let phase = late.or((!flew).then_some(flown.final_truth.phase));
        Ok(phase.map(|phase| format!("a landing was forgotten after {self:?}: {phase:?}")))
    }
}
