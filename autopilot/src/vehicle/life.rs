//! What the vehicle is doing: one state, from which everything else is derived.
//!
//! What belongs to a state is kept in it, so that it ends with the state: a step that is flown, sticks and setpoints with the
//! flight, the reason of a landing with the landing. `ARCHITECTURE.md` draws the states and what leads from one to another.

use std::time::Duration;

use super::manual::Manual;
use super::{LandingReason, Phase};
use crate::mission::Due;
use crate::plan::AgentOrder;

/// What the vehicle is doing.
#[derive(Debug, Clone, PartialEq)]
#[allow(
    clippy::large_enum_variant,
    reason = "there is one, and a box would be asked for in flight"
)]
pub(super) enum Life {
    /// On the ground as far as is known, and not ready to fly.
    Preparing {
        /// How far it is.
        stage: Preparation,
        /// The flight that was ordered and has not begun.
        departure: Option<Departure>,
    },
    /// On the ground, configured: waiting for an order to fly.
    Standby {
        /// Start of this state.
        since: Duration,
        /// It came from a flight, so that an old order of ours may lift the drone again.
        has_flown: bool,
    },
    /// Flying the mission or an operator's orders, or waiting in the air for more of them.
    Flying(Flying),
    /// Landing for good. It lasts until the drone is certainly down, even if the outcome is known earlier.
    Landing {
        /// When the landing was ordered.
        since: Duration,
        /// Why.
        why: Why,
    },
}

/// What is done before a drone can fly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Preparation {
    /// Waiting for the first navdata.
    Connecting,
    /// The drone was found in the air: it is monitored without sending anything until it is decided whether to take it over.
    Observing(Watched),
    /// Setting the drone's configuration.
    Configuring {
        /// When the drone was first heard.
        since: Duration,
    },
    /// Setting the level reference (flat trim), and monitoring the drone.
    Trimming(Watched),
}

/// A drone that is monitored before it is flown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Watched {
    pub(super) since: Duration,
    /// Navdata packets received before that.
    pub(super) received: u64,
}

/// A flight that was ordered and has not begun.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Departure {
    /// When it was ordered.
    pub(super) ordered: Duration,
    /// A drone that was found in the air is taken over.
    pub(super) takes_over: bool,
}

/// A flight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Flying {
    /// The drone has been in the air.
    pub(super) has_flown: bool,
    /// It has been since it was landed last.
    pub(super) has_risen: bool,
    /// The step being flown.
    pub(super) due: Option<Active>,
    /// Whether the mission is flown, or what an operator does instead.
    pub(super) manual: Manual,
}

/// A step that is being flown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Active {
    pub(super) due: Due,
    pub(super) since: Duration,
    /// The order has been handed to the agent.
    pub(super) offered: bool,
}

/// Why the vehicle lands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Why {
    /// The mission was given up.
    GivenUp(LandingReason),
    /// A drone that was taken over in the air must not be flown on, for these reasons.
    TakeOverRefused(Vec<String>),
    /// The mission was replaced during a landing that was one of its steps, and ends with it.
    Replaced {
        /// The landing.
        step: usize,
    },
    /// The flight has its outcome, and the drone is in the air all the same.
    StillUp,
}

impl Why {
    /// The reason for operators.
    pub(super) fn reason(&self) -> Option<LandingReason> {
        match self {
            Self::GivenUp(reason) => Some(*reason),
            Self::TakeOverRefused(_) => Some(LandingReason::TakeOverRefused),
            Self::Replaced { .. } | Self::StillUp => None,
        }
    }
}

impl Life {
    pub(super) const BEGINNING: Self =
        Self::Preparing { stage: Preparation::Connecting, departure: None };

    /// The state without its data.
    pub(super) fn phase(&self) -> Phase {
        match self {
            Self::Preparing { stage, .. } => match stage {
                Preparation::Connecting => Phase::Connecting,
                Preparation::Observing(_) => Phase::Observing,
                Preparation::Configuring { .. } => Phase::Configuring,
                Preparation::Trimming(_) => Phase::Trimming,
            },
            Self::Standby { .. } => Phase::Standby,
            Self::Flying(_) => Phase::Flying,
            Self::Landing { .. } => Phase::Landing,
        }
    }

    /// Goes on to another state.
    pub(super) fn enter(&mut self, next: Self) {
        let (from, to) = (self.phase(), next.phase());
        debug_assert!(from == to || from.next().contains(&to), "{from} is never followed by {to}");
        *self = next;
    }

    /// Goes on to another stage of preparation. A flight that was ordered still is.
    pub(super) fn prepare(&mut self, stage: Preparation) {
        let departure = self.departure();
        self.enter(Self::Preparing { stage, departure });
    }

    /// The flight that was ordered and has not begun.
    pub(super) fn departure(&self) -> Option<Departure> {
        match self {
            Self::Preparing { departure, .. } => *departure,
            _ => None,
        }
    }

    /// Whether a drone is being taken over that was found in the air.
    pub(super) fn takes_over(&self) -> bool {
        self.departure().is_some_and(|departure| departure.takes_over)
    }

    /// Whether the drone is flown, or landed for good.
    pub(super) fn is_in_flight(&self) -> bool {
        matches!(self, Self::Flying(_) | Self::Landing { .. })
    }

    /// Whether commands are sent to the drone: not before it has been heard, nor while another pilot flies it.
    pub(super) fn commands(&self) -> bool {
        use Preparation::{Connecting, Observing};
        !matches!(self, Self::Preparing { stage: Connecting | Observing(_), .. })
    }

    pub(super) fn flying(&self) -> Option<&Flying> {
        match self {
            Self::Flying(flying) => Some(flying),
            _ => None,
        }
    }

    pub(super) fn flying_mut(&mut self) -> Option<&mut Flying> {
        match self {
            Self::Flying(flying) => Some(flying),
            _ => None,
        }
    }

    /// The step being flown.
    pub(super) fn due(&self) -> Option<Active> {
        self.flying()?.due
    }

    /// The order of the step being flown.
    pub(super) fn due_order(&self) -> Option<AgentOrder> {
        self.due().map(|active| active.due.order)
    }

    /// What an operator does with the drone by hand.
    pub(super) fn manual(&self) -> &Manual {
        self.flying().map_or(&Manual::NONE, |flying| &flying.manual)
    }

    /// Why the drone is landed before the end of the plan.
    pub(super) fn landing_reason(&self) -> Option<LandingReason> {
        match self {
            Self::Landing { why, .. } => why.reason(),
            _ => None,
        }
    }
}
