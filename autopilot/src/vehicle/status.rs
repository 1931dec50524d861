//! A snapshot of the vehicle.

use std::time::Duration;

use ardrone_link::navdata::GpsFix;
use ardrone_link::settings::Camera;
use estimator::{TagStatus, Trust};
use kinematics::{Airframe, Pose};

use super::{CrossCheck, LandingReason, ManualControl, Operator, Phase, RestsOn};
use crate::agent::ChosenPlans;

/// A snapshot for displays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Status {
    /// Phase of the flight.
    pub phase: Phase,
    /// Why the drone is landed before the end of the plan, until it is down.
    pub landing: Option<LandingReason>,
    /// The drone has cut its motors, and must be recovered before it can fly.
    pub emergency: bool,
    /// Whether the drone is off the ground.
    pub airborne: bool,
    /// Time since the take-off was ordered, or of the last flight; `None` before the take-off has ended.
    pub flight_time: Option<Duration>,
    /// The camera whose video was ordered last from this drone; `None` if nobody has ordered one: it may show either.
    pub camera: Option<Camera>,
    /// Index of the step being flown.
    pub step: Option<usize>,
    /// Number of plan steps.
    pub steps: usize,
    /// How many of them are done, in the current or last flight; `None` if they are for the next one.
    pub steps_done: Option<usize>,
    /// The mission is paused: an operator holds or flies the drone.
    pub mission_waits: bool,
    /// What an operator does with the drone by hand, while the mission is paused.
    pub manual: Option<ManualControl>,
    /// The operator who has the controls.
    pub controls: Option<Operator>,
    /// Estimated pose in the world; `None` until the drone has been heard.
    pub pose: Option<Pose>,
    /// Estimated velocity in the world, x, y and z; `None` until the drone has been heard.
    pub velocity_m_s: Option<[f64; 3]>,
    /// Turn rate, clockwise, in degrees per second: measured, and predicted since; `None` until the drone has been heard.
    pub turn_rate_deg_s: Option<f64>,
    /// Target pose of the position controller; `None` while it is not active.
    pub target: Option<Pose>,
    /// Distance to the target.
    pub distance_m: Option<f64>,
    /// Remaining charge.
    pub battery_percent: Option<u32>,
    /// Voltage of the battery, if the drone tells it.
    pub battery_v: Option<f64>,
    /// Standard deviation of the position on the worse horizontal axis. It grows with time, because velocity is
    /// integrated.
    pub uncertainty_m: f64,
    /// What that deviation rests on.
    pub rests_on: RestsOn,
    /// What has contradicted the position in this flight.
    pub contradicted_by: Option<CrossCheck>,
    /// Standard deviation of the height.
    pub height_uncertainty_m: f64,
    /// What is known by tags, if they are used.
    pub tags: Option<TagStatus>,
    /// Position by the drone's flight recorder, if it has one and is asked. Nothing is flown by it.
    pub gps: Option<GpsFix>,
    /// Whether navdata are plausible.
    pub trust: Trust,
    /// Identified response of this airframe to its sticks.
    pub airframe: Airframe,
    /// Age of the newest navdata.
    pub navdata_age: Option<Duration>,
    /// Navdata packets per second, low-pass filtered.
    pub navdata_hz: f64,
    /// Height above what is below the drone, by its ultrasound.
    pub altitude_m: Option<f64>,
    /// Roll and pitch reported by the drone: right side down, nose up.
    pub attitude_deg: Option<[f64; 2]>,
    /// Agent plans chosen in the last tick.
    pub plans: ChosenPlans,
    /// The agent's command; `None` before the first navdata.
    pub command: Option<&'static str>,
}
