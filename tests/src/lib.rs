//! What the whole-system tests share: plans, and how a flight is judged.
#![forbid(unsafe_code)]

mod alone;
pub mod campaign;
pub mod drive;
pub mod gaps;
pub mod sensors;
pub mod sim;

use autopilot::Plan;
use autopilot::vehicle::Waypoint;
use mock_drone::Truth;
use nalgebra::{Vector2, Vector3};

/// The square of the README.
pub const SQUARE: &str = include_str!("../../plans/square.txt");

/// A plan, which must be valid.
///
/// # Panics
/// If it is not.
pub fn plan(text: &str) -> Plan {
    Plan::parse("plan.txt", text).unwrap_or_else(|error| panic!("{error}"))
}

/// Where the drone really was, in the frame that navdata spans: what a pilot could know at best.
pub fn place_in_navdata_frame(truth: &Truth) -> Vector3<f64> {
    truth.odometry_m.push(truth.position_m.z)
}

/// How far the drone really was from a waypoint's target, in the frame that navdata spans.
pub fn true_error_m(waypoint: &Waypoint, truth: &Truth) -> f64 {
    let target = Vector2::new(waypoint.target.x_m, waypoint.target.y_m).push(waypoint.target.z_m);
    (place_in_navdata_frame(truth) - target).norm()
}
