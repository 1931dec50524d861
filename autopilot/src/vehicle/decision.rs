//! The decision of one tick, with its inputs and its reasons.

use std::time::Duration;

use ardrone_link::session::Order;
use estimator::{Prediction, Quantity, TagStatus, Worth};
use kinematics::Pose;
use nalgebra::Vector2;

use super::Phase;
use crate::agent::{AgentCommand, ChosenPlans, Danger, Percepts, Report};
use crate::safety::Veto;

/// One tick, from percepts to the order sent to the drone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decision {
    /// Time since the program started.
    pub at: Duration,
    /// Phase of the flight.
    pub phase: Phase,
    /// Index of the plan step that is flown in this tick, also if it ends here.
    pub step: Option<usize>,
    /// Predicted position and motion of the drone.
    pub state: Prediction,
    /// Standard deviation of the height, in metres.
    pub height_uncertainty_m: f64,
    /// What each quantity in navdata is worth, in the order of [`Quantity::ALL`].
    pub worth: [Worth; Quantity::ALL.len()],
    /// What lasts of the wind, as an acceleration of the drone along x and y in the world; of it the percepts have the share
    /// of full tilt.
    pub wind_m_s2: Vector2<f64>,
    /// The known tags and their status, if tags are used.
    pub tags: Option<TagStatus>,
    /// Percepts given to the agent.
    pub percepts: Percepts,
    /// Agent plans chosen in this step.
    pub plans: ChosenPlans,
    /// Command chosen by the agent.
    pub wanted: AgentCommand,
    /// How the agent's last order ended, if it ended in this tick.
    pub report: Option<Report>,
    /// Danger reported by the agent.
    pub danger: Option<Danger>,
    /// Why the safety layer replaced the agent's command.
    pub veto: Option<Veto>,
    /// Target pose of the position controller, if it was active.
    pub target: Option<Pose>,
    /// Order given to the session.
    pub order: Order,
}
