//! Manual control: hold, fly by stick, fly to a place, go on with the mission.

use std::time::Duration;

use kinematics::{Pose, Sticks};

use super::{FlightEvent, Operator, Refused, Station, Vehicle};
use crate::agent::Report;
use crate::safety::INSIDE_M;

/// Stick input expires after this time. Key repeat is faster, so a held key keeps flying.
const STICK_TIME: Duration = Duration::from_millis(600);
/// Stick input from a page, which repeats it every 100 ms and knows when a key is released.
const PAGE_STICK_TIME: Duration = Duration::from_millis(250);

/// Manual control of the current flight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Manual {
    /// The mission is paused.
    pub(super) holds_mission: bool,
    /// The agent's next step serves a pre-empting order. An order offered in the same tick would replace the
    /// pre-empting one.
    pub(super) pre_empts: bool,
    mode: Mode,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
enum Mode {
    /// No manual control: the drone holds, or flies its mission.
    #[default]
    None,
    Steered {
        sticks: Sticks,
        until: Duration,
    },
    SentTo {
        place: Pose,
        /// The target has been handed to the agent.
        offered: bool,
    },
}

impl Manual {
    /// The current stick input; `None` once it has expired.
    pub(super) fn sticks(&self, now: Duration) -> Option<Sticks> {
        match self.mode {
            Mode::Steered { sticks, until } if now < until => Some(sticks),
            _ => None,
        }
    }

    /// Whether a manual target is being flown to.
    pub(super) fn sends(&self) -> bool {
        matches!(self.mode, Mode::SentTo { .. })
    }
}

impl Vehicle {
    pub(super) fn hold_here(&mut self) {
        self.begin_manual(FlightEvent::Held);
        self.agent_holds();
    }

    pub(super) fn steer(&mut self, now: Duration, by: Operator, sticks: Sticks) {
        if self.flight.manual.sticks(now).is_none() {
            self.begin_manual(FlightEvent::Steered);
            self.flight.manual.pre_empts = true;
            // Pre-empting goals are always accepted.
            let accepted = self.flight.agent.achieve_steer();
            debug_assert!(accepted);
        }
        let lasts = match by.station {
            Station::Browser => PAGE_STICK_TIME,
            Station::Terminal | Station::Program | Station::Mavlink => STICK_TIME,
        };
        self.flight.manual.mode = Mode::Steered { sticks, until: now + lasts };
    }

    pub(super) fn send_to(&mut self, now: Duration, x_m: f64, y_m: f64) {
        let wanted = Pose { x_m, y_m, ..self.flight.target.unwrap_or_else(|| self.pose(now)) };
        self.begin_manual(FlightEvent::ManualTargetSet);
        self.agent_holds();
        let place = self.mission.inside(&wanted, INSIDE_M);
        self.flight.manual.mode = Mode::SentTo { place, offered: false };
    }

    pub(super) fn resume(&mut self, now: Duration) -> Result<(), Refused> {
        if !self.flight.manual.holds_mission {
            return Err(Refused::NothingHeld);
        }
        // This landing is final: the mission does not resume.
        if self.flight.landing.is_some() {
            return Err(Refused::Landing);
        }
        // The manual order is ended without a report, which would be taken for the report of the step.
        self.agent_holds();
        self.flight.manual.holds_mission = false;
        self.events.push_back(FlightEvent::Resumed);
        // The order of the step was pre-empted and must be offered again.
        if let Some(active) = &mut self.flight.due {
            active.offered = false;
            active.since = now;
        }
        Ok(())
    }

    /// Ends manual control because the mission was replaced. A paused mission stays paused.
    pub(super) fn manual_ends(&mut self) {
        self.flight.manual.mode = Mode::None;
        self.flight.manual.pre_empts = true;
    }

    /// Hands the manual target to the agent once the agent holds.
    pub(super) fn offer_manual_target(&mut self) {
        let flight = &mut self.flight;
        if let Mode::SentTo { place, offered: offered @ false } = &mut flight.manual.mode {
            *offered = flight.agent.achieve_go_to(place.x_m, place.y_m, place.z_m, place.yaw_deg);
        }
    }

    /// The agent has reported how its order for the manual target ended.
    pub(super) fn manual_target_ended(&mut self, report: Report) {
        if let Mode::SentTo { offered: true, .. } = self.flight.manual.mode {
            self.flight.manual.mode = Mode::None;
            // It fails only on the ground, which ends the flight with that reason.
            if report == Report::Done {
                self.events.push_back(FlightEvent::ManualTargetReached);
            }
        }
    }

    fn agent_holds(&mut self) {
        self.flight.manual.mode = Mode::None;
        self.flight.manual.pre_empts = true;
        // Pre-empting goals are always accepted.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stick_input_expires() {
        let (sticks, until) = (Sticks { roll: 0.5, ..Sticks::default() }, Duration::from_secs(5));
        let manual = Manual { mode: Mode::Steered { sticks, until }, ..Manual::default() };
        let last = until.saturating_sub(Duration::from_millis(1));
        assert_eq!(manual.sticks(last), Some(sticks));
        assert_eq!(manual.sticks(until), None);
        assert_eq!(Manual::default().sticks(last), None);
        assert!(!manual.sends(), "no place was given");
        let mode = Mode::SentTo { place: Pose::default(), offered: false };
        assert!(Manual { mode, ..manual }.sends());
    }
}
