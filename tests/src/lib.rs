//! Common code of the whole-system tests: plans, simulations, and judges of flights.
#![forbid(unsafe_code)]

pub mod airframes;
mod alone;
pub mod campaign;
pub mod cross_checks;
pub mod fleet;
pub mod healthy;
pub mod landings;
pub mod lateness;
pub mod rules;
pub mod sensors;
pub mod sim;
pub mod streams;
pub mod tick_times;
mod trial;

use autopilot::Plan;
use autopilot::vehicle::Waypoint;
use mock_drone::Truth;
use nalgebra::{Vector2, Vector3};

/// The square of the README.
pub const SQUARE: &str = include_str!("../../plans/square.txt");

/// Parses a plan that must be valid.
///
/// # Panics
/// If it is not.
pub fn plan(text: &str) -> Plan {
    Plan::parse("plan.txt", text).unwrap_or_else(|error| panic!("{error}"))
}

/// The true position in the frame that navdata span: the best that could be known in flight.
pub fn place_in_navdata_frame(truth: &Truth) -> Vector3<f64> {
    truth.odometry_m.push(truth.position_m.z)
}

/// True distance from a waypoint's target, in the frame that navdata span.
pub fn true_error_m(waypoint: &Waypoint, truth: &Truth) -> f64 {
    let target = Vector2::new(waypoint.target.x_m, waypoint.target.y_m).push(waypoint.target.z_m);
    (place_in_navdata_frame(truth) - target).norm()
}
