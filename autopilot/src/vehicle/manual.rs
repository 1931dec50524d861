//! Manual control: hold, fly by stick, fly to a place, go on with the mission.

use std::time::Duration;

use pid::{Demand, Pose};

use super::{FlightEvent, Refused, Vehicle};
use crate::agent::Report;
use crate::safety::INSIDE_M;

/// Sticks expire after this time: a key that is held repeats faster.
const STICK_TIME: Duration = Duration::from_millis(600);

/// What the operator makes the drone do besides its mission.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Manual {
    /// The mission waits.
    pub(super) holds_mission: bool,
    /// The agent's next step serves a pre-empting order. Anything else that it were given in the same tick
    /// would outlast that order.
    pub(super) pre_empts: bool,
    mode: Mode,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
enum Mode {
    /// The drone holds, or flies its mission.
    #[default]
    None,
    Steered {
        sticks: Demand,
        since: Duration,
    },
    SentTo {
        place: Pose,
        /// The agent has been given it.
        offered: bool,
    },
}

impl Manual {
    /// The sticks, until they expire.
    pub(super) fn sticks(&self, now: Duration) -> Option<Demand> {
        match self.mode {
            Mode::Steered { sticks, since } if now.saturating_sub(since) < STICK_TIME => {
                Some(sticks)
            }
            _ => None,
        }
    }

    /// Whether the drone is sent somewhere.
    pub(super) fn sends(&self) -> bool {
        matches!(self.mode, Mode::SentTo { .. })
    }
}

impl Vehicle {
    pub(super) fn hold_here(&mut self) {
        self.begin_manual(FlightEvent::Held);
        self.agent_holds();
    }

    pub(super) fn steer(&mut self, now: Duration, sticks: Demand) {
        if self.flight.manual.sticks(now).is_none() {
            self.begin_manual(FlightEvent::Steered);
            self.flight.manual.pre_empts = true;
            // Pre-empting: always accepted.
            let accepted = self.flight.agent.achieve_steer();
            debug_assert!(accepted);
        }
        self.flight.manual.mode = Mode::Steered { sticks, since: now };
    }

    pub(super) fn send_to(&mut self, now: Duration, x_m: f64, y_m: f64) {
        let wanted = Pose { x_m, y_m, ..self.flight.target.unwrap_or_else(|| self.pose(now)) };
        self.begin_manual(FlightEvent::SentByHand);
        self.agent_holds();
        let place = self.mission.inside(&wanted, INSIDE_M);
        self.flight.manual.mode = Mode::SentTo { place, offered: false };
    }

    pub(super) fn resume(&mut self, now: Duration) -> Result<(), Refused> {
        if !self.flight.manual.holds_mission {
            return Err(Refused::NothingHeld);
        }
        // Landing for good: the mission does not go on.
        if self.flight.landing.is_some() {
            return Err(Refused::Landing);
        }
        // The agent's order for manual control ends unreported: its end is not the step's.
        self.agent_holds();
        self.flight.manual.holds_mission = false;
        self.events.push_back(FlightEvent::Resumed);
        // The order for the step was pre-empted.
        if let Some(active) = &mut self.flight.due {
            active.offered = false;
            active.since = now;
        }
        Ok(())
    }

    /// Ends manual control because the mission was replaced. A mission that waits goes on waiting.
    pub(super) fn manual_ends(&mut self) {
        self.flight.manual.mode = Mode::None;
        self.flight.manual.pre_empts = true;
    }

    /// Gives the agent the place to which the drone is sent, once it holds.
    pub(super) fn offer_manual_target(&mut self) {
        let flight = &mut self.flight;
        if let Mode::SentTo { place, offered: offered @ false } = &mut flight.manual.mode {
            *offered = flight.agent.achieve_go_to(place.x_m, place.y_m, place.z_m, place.yaw_deg);
        }
    }

    /// The agent has reported how its order for manual control ended.
    pub(super) fn manual_target_ended(&mut self, report: Report) {
        if let Mode::SentTo { offered: true, .. } = self.flight.manual.mode {
            self.flight.manual.mode = Mode::None;
            // It only fails on the ground, which ends the flight for that reason.
            if report == Report::Done {
                self.events.push_back(FlightEvent::ManualTargetReached);
            }
        }
    }

    fn agent_holds(&mut self) {
        self.flight.manual.mode = Mode::None;
        self.flight.manual.pre_empts = true;
        // Pre-empting: always accepted.
        let accepted = self.flight.agent.achieve_hold();
        debug_assert!(accepted);
    }

    fn begin_manual(&mut self, event: FlightEvent) {
        if !self.flight.manual.holds_mission || event != FlightEvent::Held {
            self.events.push_back(event);
        }
        self.flight.manual.holds_mission = true;
        self.flight.manual.mode = Mode::None;
    }
}
