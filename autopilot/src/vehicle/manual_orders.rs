//! Manual control: hold, fly by stick, fly to a place, follow setpoints, go on with the mission.

use std::time::Duration;

use estimator::Prediction;
use kinematics::{Pose, Sticks};
use nalgebra::Vector2;
use pid::{Course, MotionLimits};

use super::life::{Flying, Life};
use super::manual::{Goal, Mode};
use super::{FlightEvent, Operator, Place, Refused, Setpoint, Station, Vehicle, pose};
use crate::agent::{Report, distance};
use crate::safety::INSIDE_M;

/// Stick input expires after this time. Key repeat is faster, so a held key keeps flying.
const STICK_TIME: Duration = Duration::from_millis(600);
/// Stick input from a page, which repeats it every 100 ms and knows when a key is released.
const PAGE_STICK_TIME: Duration = Duration::from_millis(250);

impl Vehicle {
    pub(super) fn hold_here(&mut self) {
        self.fly_by_hand(Mode::Hold, Goal::Hold, FlightEvent::Held);
    }

    pub(super) fn steer(&mut self, now: Duration, by: Operator, sticks: Sticks) {
        let lasts = match by.station {
            Station::Browser => PAGE_STICK_TIME,
            Station::Terminal | Station::Program | Station::Mavlink | Station::Agent => STICK_TIME,
        };
        let mode = Mode::Steered { sticks, until: now + lasts };
        match self.life.flying_mut() {
            Some(flying) if flying.manual.sticks(now).is_some() => flying.manual.mode = mode,
            _ => self.fly_by_hand(mode, Goal::Steer, FlightEvent::Steered),
        }
    }

    /// Begins to follow setpoints.
    pub(super) fn follow(&mut self, now: Duration, setpoint: Setpoint) {
        if self.next_setpoint(now, setpoint).is_ok() {
            return;
        }
        let state = self.state(now);
        let target = self.flight.target.unwrap_or_else(|| pose(&state));
        // A course begins where the last one, or the hold, has led: begun anew with the drone's motion in every tick it
        // would never brake it.
        let holds = self.flight.activity.stays() && self.flight.target.is_some();
        let course = match self.life.manual().flown {
            Some(course) => course,
            None if holds => Course::new(Vector2::new(target.x_m, target.y_m), Vector2::zeros()),
            None => course_of(&state),
        };
        let mode = Mode::Following { setpoint, at: now, target, course, stopped: false };
        self.fly_by_hand(mode, Goal::Follow, FlightEvent::FollowingSetpoints);
    }

    /// The next setpoint. After the agent has stopped following it only shows that its sender is there.
    pub(super) fn next_setpoint(&mut self, now: Duration, next: Setpoint) -> Result<(), Refused> {
        let mode = self.life.flying_mut().map(|flying| &mut flying.manual.mode);
        let Some(Mode::Following { setpoint, at, stopped, .. }) = mode else {
            return Err(Refused::NotFollowing);
        };
        (*setpoint, *at) = (next, now);
        if *stopped { Err(Refused::NotFollowing) } else { Ok(()) }
    }

    /// Moves the target of the setpoints that are followed.
    pub(super) fn advance_setpoint(&mut self, state: &Prediction, step_s: f64) {
        let fence = self.config.limits;
        let limits = self.course_limits();
        let drag_1_s = self.flight.estimator.airframe().drag_1_s.min();
        // It hovered by itself, and may be elsewhere.
        let flown = self.flight.target.is_some();
        let Life::Flying(Flying { manual, .. }) = &mut self.life else { return };
        manual.flown = None;
        if let Mode::Following { setpoint, target, course, stopped: false, .. } = &mut manual.mode {
            if !flown {
                *course = course_of(state);
            }
            let pose = pose(state);
            let border = (&fence.border, INSIDE_M);
            setpoint.advance(course, &pose, (&limits, drag_1_s), border, step_s);
            let wanted = setpoint.target(target, course, &pose, step_s);
            *target = fence.nearest_inside(&wanted, INSIDE_M);
            manual.flown = Some(*course);
        }
    }

    /// Those of the controller's own reference.
    pub(super) fn course_limits(&self) -> MotionLimits {
        self.config.cascade.motion_limits(
            self.full_tilt_m_s2() * self.least_thrust(),
            self.flight.wind.mean_m_s2().norm(),
            self.mission.max_control(),
            self.mission.speed_m_s().unwrap_or(f64::INFINITY),
        )
    }

    /// The agent has set its order aside because whoever gave it is silent.
    pub(super) fn order_paused(&mut self) {
        let Life::Flying(Flying { manual, .. }) = &mut self.life else { return };
        match &mut manual.mode {
            Mode::Following { stopped, .. } => {
                *stopped = true;
                self.events.push_back(FlightEvent::SetpointsSilent);
            }
            // It waits already.
            Mode::Hold => {}
            mode => {
                *mode = Mode::Hold;
                self.events.push_back(FlightEvent::PausedForStation);
            }
        }
    }

    pub(super) fn send_to(&mut self, now: Duration, to: &Place) {
        let present = self.flight.target.unwrap_or_else(|| self.pose(now));
        let wanted = Pose {
            x_m: to.x_m.unwrap_or(present.x_m),
            y_m: to.y_m.unwrap_or(present.y_m),
            z_m: to.height_m.unwrap_or(present.z_m),
            yaw_deg: to.yaw_deg.unwrap_or(present.yaw_deg),
        };
        let place = self.mission.inside(&wanted, INSIDE_M);
        match self.life.flying_mut().map(|flying| &mut flying.manual.mode) {
            // It is on its way there.
            Some(Mode::SentTo { place: last, .. })
                if distance(last, &place) <= f64::EPSILON
                    && last.yaw_deg.to_bits() == place.yaw_deg.to_bits() => {}
            // The agent has yet to hear of the last one. To hold once more would let no place through.
            Some(Mode::SentTo { place: last, offered: false }) => {
                *last = place;
                self.events.push_back(FlightEvent::ManualTargetSet);
            }
            _ => {
                let mode = Mode::SentTo { place, offered: false };
                self.fly_by_hand(mode, Goal::Hold, FlightEvent::ManualTargetSet);
            }
        }
    }

    pub(super) fn resume(&mut self, now: Duration) -> Result<(), Refused> {
        let flying = match &mut self.life {
            Life::Flying(flying) if flying.manual.pauses_mission() => flying,
            // This landing is final: the mission does not resume.
            Life::Landing { .. } => return Err(Refused::Landing),
            _ => return Err(Refused::NothingHeld),
        };
        // The manual order is ended without a report, which would be taken for the report of the step.
        flying.manual.mode = Mode::Mission;
        flying.manual.goal = Some(Goal::Hold);
        // The order of the step was pre-empted and must be offered again.
        if let Some(active) = &mut flying.due {
            active.offered = false;
            active.since = now;
        }
        self.events.push_back(FlightEvent::Resumed);
        Ok(())
    }

    /// Tells the agent what the last order was; whether there was one.
    pub(super) fn offer_goal(&mut self) -> bool {
        let goal = self.life.flying_mut().and_then(|flying| flying.manual.goal.take());
        let Some(goal) = goal else { return false };
        let agent = &mut self.flight.agent;
        // Pre-empting goals are always accepted.
        let accepted = match goal {
            Goal::Hold => agent.achieve_hold(),
            Goal::Steer => agent.achieve_steer(),
            Goal::Follow => agent.achieve_follow(),
            Goal::NewMission => agent.achieve_new_mission(),
        };
        debug_assert!(accepted);
        true
    }

    /// Hands the manual target to the agent once the agent holds.
    pub(super) fn offer_manual_target(&mut self) {
        let mode = self.life.flying_mut().map(|flying| &mut flying.manual.mode);
        if let Some(Mode::SentTo { place, offered: offered @ false }) = mode {
            let Pose { x_m, y_m, z_m, yaw_deg } = *place;
            *offered = self.flight.agent.achieve_go_to(x_m, y_m, z_m, yaw_deg);
        }
    }

    /// The agent has reported how its order for the manual target ended.
    pub(super) fn manual_target_ended(&mut self, report: Report) {
        let Life::Flying(Flying { manual, .. }) = &mut self.life else { return };
        if let Mode::SentTo { offered: true, .. } = manual.mode {
            manual.mode = Mode::Hold;
            // It fails only on the ground, which ends the flight with that reason.
            if report == Report::Done {
                self.events.push_back(FlightEvent::ManualTargetReached);
            }
        }
    }

    /// Pauses the mission and does this instead.
    fn fly_by_hand(&mut self, mode: Mode, goal: Goal, event: FlightEvent) {
        let Life::Flying(Flying { manual, .. }) = &mut self.life else { return };
        if !manual.pauses_mission() || event != FlightEvent::Held {
            self.events.push_back(event);
        }
        manual.mode = mode;
        manual.goal = Some(goal);
    }
}

/// A course that goes on as the drone moves.
fn course_of(state: &Prediction) -> Course {
    Course::new(state.position_m.xy(), state.velocity_m_s.xy())
}
