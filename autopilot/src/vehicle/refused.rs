//! Why an order is refused.

use estimator::MAX_TAGS;

use super::Operator;
use crate::mission::AppendError;
use crate::separation::NotHeard;

/// Why an input was refused. What it changes all the same is said at [`Vehicle::handle`](super::Vehicle::handle).
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Refused {
    /// Another operator has the controls.
    #[error("{0} has the controls")]
    ControlsHeld(Operator),
    /// The vehicle cannot take off now; all reasons.
    #[error("not ready: {}", .0.join("; "))]
    NotReady(Vec<String>),
    /// No mission is loaded.
    #[error("no mission is loaded")]
    NoMission,
    /// The mission has no take-off.
    #[error("the mission never takes off: begin it with `takeoff`")]
    NeverTakesOff,
    /// The drone is landing.
    #[error("the drone is landing")]
    Landing,
    /// Another client flies the drone.
    #[error("another client flies the drone")]
    FlownByAnother,
    /// The order needs a drone in the air.
    #[error("the drone is on the ground")]
    OnGround,
    /// The mission is already being flown.
    #[error("the mission is being flown already")]
    Flying,
    /// No setpoints are followed.
    #[error("setpoints are not followed: order it first")]
    NotFollowing,
    /// Nothing is paused.
    #[error("nothing is held: there is nothing to resume")]
    NothingHeld,
    /// A command leads outside the fence, or does not fit at its position in the mission.
    #[error("{0}")]
    Command(#[from] AppendError),
    /// The plan declares more tags than there is room for.
    #[error(
        "the plan declares {declared} tags besides {known} others: at most {MAX_TAGS} can be known"
    )]
    TooManyTags {
        /// Tags that the plan declares.
        declared: usize,
        /// Tags that are given by the settings or, in a flight, known.
        known: usize,
    },
    /// No coordinate is given, or one is not a finite number.
    #[error("this is not a place: its numbers must be finite")]
    NoPlace,
    /// A stick is further out than it can be.
    #[error("sticks are from -1 to 1")]
    NoSticks,
    /// The drone is not in its emergency state, or not on the ground.
    #[error("there is no emergency to recover from on the ground")]
    NoEmergency,
    /// A datagram is damaged, or older than another one.
    #[error("the datagram is damaged or old")]
    Datagram,
    /// What another vehicle tells of itself is not believed.
    #[error(transparent)]
    Neighbour(#[from] NotHeard),
    /// The tick loop's queue was full.
    #[error("too many orders are waiting: try again")]
    Busy,
    /// The tick loop has ended.
    #[error("the vehicle has been left")]
    Left,
}
