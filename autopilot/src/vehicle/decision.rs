//! What was decided in a tick, and why.

use std::time::Duration;

use ardrone_link::session::Order;
use estimator::Prediction;
use pid::Pose;

use super::Phase;
use crate::agent::{AgentCommand, ChosenPlans, Danger, Percepts, Report};
use crate::safety::Veto;

/// One tick, from what was known to what was ordered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decision {
    /// Since the start.
    pub at: Duration,
    /// What the flight was doing, in one word.
    pub phase: Phase,
    /// The step of the plan that was flown.
    pub step: Option<usize>,
    /// Where the drone was, and how it moved.
    pub state: Prediction,
    /// Standard deviation of the height.
    pub vertical_deviation_m: f64,
    /// What the agent knew.
    pub percepts: Percepts,
    /// The plans that it chose.
    pub plans: ChosenPlans,
    /// What it wanted.
    pub wanted: AgentCommand,
    /// What it said of its last order.
    pub report: Option<Report>,
    /// What it said of the flight.
    pub danger: Option<Danger>,
    /// Why something else was done.
    pub veto: Option<Veto>,
    /// Where the drone was sent.
    pub target: Option<Pose>,
    /// What the drone was told.
    pub order: Order,
}
