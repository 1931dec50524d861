//! Flights in which a single rule keeps the drone safe. Where several layers protect against a danger, random
//! flights cannot show that one of them is missing: these lead the drone into the situation that is left to it.
//!
//! As everywhere, only the truth is judged. The uncertainty that the vehicle claims is compared with the truth.

mod estimate;
mod monitor;

use crate::sim::SimulationError;
use crate::trial;

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
    trial::broken(families.into_iter().flatten())
}
