//! Landings with a gap in the link or another order around the landing order, which must not be lost. A gap
//! that begins just before the order swallows it, one that begins just after it swallows the drone's answer;
//! an order in the same tick could replace it. Random flights hardly ever hit these tenths of a second.

use std::time::Duration;

use autopilot::plan::FlightLimits;
use autopilot::vehicle::{OperatorOrder, Place, TICK};
use kinematics::Sticks;
use mock_drone::airframe::Profile;
use mock_drone::scenario::{Action, Direction, Scenario, When};
use nalgebra::Vector2;

use crate::plan;
use crate::sim::SimulationError;
use crate::trial::{self, HOLD, HOLDS_AT as ORDERED_AT, Must, Trial};

/// Time from the begin of the first gap to the order, and step of the other gaps' begins.
const BEFORE: Duration = Duration::from_millis(500);
const LATER: Duration = Duration::from_millis(100);
const BEGINNINGS: u32 = 12;
/// Too short for the drone to land by itself.
const LENGTHS: [Duration; 3] =
    [Duration::from_millis(500), Duration::from_secs(1), Duration::from_millis(1700)];
/// Other orders come up to this many ticks before and after the landing.
const TICKS_AROUND: u32 = 4;
/// The drone sinks by at least a third of a metre per second.
const LANDS_WITHIN: Duration = Duration::from_secs(8);

/// Descriptions of all landings that were not completed.
///
/// # Errors
/// [`SimulationError`] if a flight never ends.
pub fn forgotten() -> Result<Vec<String>, SimulationError> {
    trial::broken(gaps().into_iter().chain(orders()))
}

/// A landing with a disturbance around the order, which must be complete when it is due.
fn landing(
    what: String,
    scenario: Scenario,
    orders: Vec<(Duration, OperatorOrder)>,
    due: Duration,
) -> Trial {
    let mut trial = Trial::new(what, HOLD, Profile::rec, scenario)
        .and(Must::BeUp { at: ORDERED_AT.saturating_sub(TICK) })
        .and(Must::BeDown { by: due });
    trial.simulation.pilot.limits = FlightLimits::default();
    trial.simulation.orders = orders;
    trial
}

/// Datagrams are lost in one direction, or in both, for a while.
fn gaps() -> Vec<Trial> {
    let mut landings = Vec::new();
    for direction in [Direction::Both, Direction::Up, Direction::Down] {
        for length in LENGTHS {
            for index in 0..BEGINNINGS {
                let begins = ORDERED_AT.saturating_sub(BEFORE) + LATER * index;
                let outage = Action::Outage(direction, length);
                landings.push(landing(
                    format!("a landing, a gap {direction:?} from {begins:?} for {length:?}"),
                    Scenario::default().and(When::SinceStart(begins), outage),
                    vec![(ORDERED_AT, OperatorOrder::Land)],
                    ORDERED_AT.max(begins + length) + LANDS_WITHIN,
                ));
            }
        }
    }
    landings
}

/// Another order comes in nearly the same tick. In a breeze the agent flies the first part of the descent.
fn orders() -> Vec<Trial> {
    let mut landings = Vec::new();
    let others = [
        OperatorOrder::Hold,
        OperatorOrder::Steer(Sticks { roll: 0.5, ..Sticks::default() }),
        OperatorOrder::GoTo(Place::at(0.0, 1.0)),
        OperatorOrder::Load(plan("takeoff\ngoto 0 1 0 0\nland\n")),
        OperatorOrder::Clear,
    ];
    for wind_m_s in [0.0, 1.0] {
        let wind = Action::Wind(Vector2::new(wind_m_s, 0.0), 0.0);
        for other in &others {
            for tick in 0..=2 * TICKS_AROUND {
                let at = (ORDERED_AT + TICK * tick).saturating_sub(TICK * TICKS_AROUND);
                let mut orders = vec![(ORDERED_AT, OperatorOrder::Land), (at, other.clone())];
                orders.sort_by_key(|(at, _)| *at);
                landings.push(landing(
                    format!("a landing, {} at {at:?}, {wind_m_s} m/s of wind", other.name()),
                    Scenario::default().and(When::SinceStart(Duration::ZERO), wind),
                    orders,
                    ORDERED_AT + LANDS_WITHIN,
                ));
            }
        }
    }
    landings
}
