//! What an operator orders, and whether the vehicle accepts it.

use std::time::Duration;

use super::readiness::NotReady;
use super::{Authority, FlightEvent, FlightPhase, LandingReason, Operator, Vehicle};
use crate::mission::AppendError;
use crate::outcome::Outcome;
use crate::plan::{AgentOrder, Commands, Plan};
use ardrone_link::navdata::DroneState;
use pid::Demand;

/// What an operator wants.
///
/// Anyone may give [`Hold`](Self::Hold), [`Land`](Self::Land) and [`Cut`](Self::Cut); everything else needs
/// the controls, see [`Operator`].
#[derive(Debug, Clone, PartialEq)]
pub enum OperatorOrder {
    /// Take this mission in place of the one before. On the ground it waits for [`Start`](Self::Start); in
    /// the air the drone holds, and goes on with the new one at once unless it was held. Coordinates begin
    /// where the flight took off.
    Load(Plan),
    /// Add commands at the end of the mission, before a landing that its plan does not spell out. Behind a
    /// mission that has ended they begin a new one.
    Append(Commands),
    /// Drop the mission. In the air the drone holds.
    Clear,
    /// Fly the mission: go on where it waits, or from its beginning.
    Start {
        /// Wait for a drone that is not ready yet, for a limited time.
        when_ready: bool,
    },
    /// Stay where the drone is; the mission waits.
    Hold,
    /// Go on with the mission.
    Resume,
    /// Manual control: stick fractions with the drone's signs. They expire after 600 ms unless repeated.
    Steer(Demand),
    /// Fly to this place and stay there, at the same height and heading; the mission waits. A place at or
    /// outside the fence becomes the nearest one inside. In the estimator's frame.
    GoTo {
        /// To the right of the start.
        x_m: f64,
        /// Before the start.
        y_m: f64,
    },
    /// Land. The mission is given up.
    Land,
    /// Cut the motors now. **The drone falls.**
    Cut,
    /// Clear the drone's emergency state, so that it can fly again. A person must have looked at it.
    Recover,
    /// Give up the controls.
    Release,
}

/// Why an order was not accepted. Nothing has changed then.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Refused {
    /// Another operator has the controls.
    #[error("{0} has the controls")]
    ControlsHeld(Operator),
    /// The vehicle cannot take off now, for each of these reasons.
    #[error("not ready: {}", .0.join("; "))]
    NotReady(Vec<String>),
    /// There is nothing to fly.
    #[error("no mission is loaded")]
    NoMission,
    /// The mission has no take-off.
    #[error("the mission never takes off: begin it with `takeoff`")]
    NeverTakesOff,
    /// The drone is coming down.
    #[error("the drone is landing")]
    Landing,
    /// The drone must fly for this.
    #[error("the drone is on the ground")]
    OnGround,
    /// The mission is being flown already.
    #[error("the mission is being flown already")]
    Flying,
    /// Nothing waits to be resumed.
    #[error("nothing is held: there is nothing to resume")]
    NothingHeld,
    /// A command leads outside the fence, or does not fit where it stands.
    #[error("{0}")]
    Command(#[from] AppendError),
    /// A coordinate is not a number.
    #[error("this is no place: its coordinates must be numbers")]
    NoPlace,
    /// The drone is not in its emergency state, or not on the ground.
    #[error("there is no emergency to recover from on the ground")]
    NoEmergency,
    /// Sent from outside the tick loop, which had no room for it.
    #[error("too many orders are waiting: try again")]
    Busy,
    /// Nobody flies any more.
    #[error("the vehicle has been left")]
    Left,
}

impl OperatorOrder {
    /// Whether every operator may give it at any time.
    pub fn is_for_anyone(&self) -> bool {
        matches!(self, Self::Hold | Self::Land | Self::Cut)
    }

    /// Its name in logs and in JSON.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Load(_) => "load",
            Self::Append(_) => "append",
            Self::Clear => "clear",
            Self::Start { .. } => "start",
            Self::Hold => "hold",
            Self::Resume => "resume",
            Self::Steer(_) => "steer",
            Self::GoTo { .. } => "goto",
            Self::Land => "land",
            Self::Cut => "cut",
            Self::Recover => "recover",
            Self::Release => "release",
        }
    }
}

impl Vehicle {
    /// An operator orders something. What is accepted is acted on in the next tick.
    ///
    /// # Errors
    /// [`Refused`], and why; nothing has changed then.
    pub fn order(
        &mut self,
        now: Duration,
        by: Operator,
        order: OperatorOrder,
    ) -> Result<(), Refused> {
        self.admit(by, &order)?;
        match order {
            OperatorOrder::Load(plan) => self.load(plan),
            OperatorOrder::Append(commands) => return self.append(now, commands),
            OperatorOrder::Clear => self.clear(now),
            OperatorOrder::Start { when_ready } => return self.start(now, when_ready),
            OperatorOrder::Land => {
                self.flight.safety.land_here();
                self.land(now, LandingReason::Operator);
            }
            OperatorOrder::Cut => {
                self.events.push_back(FlightEvent::CutOrdered);
                self.session.request_emergency_stop();
            }
            OperatorOrder::Recover => return self.recover(),
            OperatorOrder::Release => self.controls.release(by),
            OperatorOrder::Hold => {
                self.can_be_held()?;
                self.hold_here();
            }
            OperatorOrder::Steer(demand) => {
                self.can_be_held()?;
                self.steer(now, demand);
            }
            OperatorOrder::GoTo { x_m, y_m } if x_m.is_finite() && y_m.is_finite() => {
                self.can_be_held()?;
                self.send_to(now, x_m, y_m);
            }
            OperatorOrder::GoTo { .. } => return Err(Refused::NoPlace),
            OperatorOrder::Resume => return self.resume(now),
        }
        Ok(())
    }

    fn admit(&mut self, by: Operator, order: &OperatorOrder) -> Result<(), Refused> {
        let before = self.controls.holder();
        if order.is_for_anyone() {
            self.controls.admit_any(by);
        } else if !matches!(order, OperatorOrder::Release) {
            self.controls.admit(by).map_err(Refused::ControlsHeld)?;
        }
        if before.is_some_and(|before| self.controls.holder() != Some(before)) {
            self.events.push_back(FlightEvent::ControlsTaken { by });
        }
        Ok(())
    }

    /// Whether the drone flies and may be made to do something else.
    fn can_be_held(&self) -> Result<(), Refused> {
        if self.lands() {
            Err(Refused::Landing)
        } else if self.phase != FlightPhase::Flying || self.on_ground() {
            Err(Refused::OnGround)
        } else {
            Ok(())
        }
    }

    /// Whether a landing goes on: for a reason, or because the mission is at that step.
    fn lands(&self) -> bool {
        let step = self.flight.due.is_some_and(|active| active.due.order == AgentOrder::Land);
        step || matches!(self.phase, FlightPhase::Landing { .. })
    }

    fn load(&mut self, plan: Plan) {
        let airborne = self.phase == FlightPhase::Flying;
        self.mission.load(plan, airborne);
        self.events.push_back(FlightEvent::MissionLoaded { steps: self.mission.steps().len() });
        self.mission_replaced();
    }

    fn clear(&mut self, now: Duration) {
        if self.departure.is_some() {
            self.end(now, Outcome::Interrupted);
        }
        self.mission.clear();
        self.events.push_back(FlightEvent::MissionCleared);
        self.mission_replaced();
    }

    /// What was ordered for the mission before is given up, but for its landing, with which the flight ends.
    fn mission_replaced(&mut self) {
        self.mission_changed();
        if self.phase != FlightPhase::Flying {
            return;
        }
        if self.lands() {
            self.flight.ends_on_ground = true;
            return;
        }
        self.flight.due = None;
        self.manual_ends();
        // Pre-empting: always accepted.
        let accepted = self.flight.agent.achieve_new_mission();
        debug_assert!(accepted);
    }

    fn append(&mut self, now: Duration, commands: Commands) -> Result<(), Refused> {
        if self.lands() {
            return Err(Refused::Landing);
        }
        let airborne = self.phase == FlightPhase::Flying;
        if !airborne && self.mission.has_ended() {
            self.mission.clear();
        }
        let here = self.pose(now);
        let due = self.flight.due.map(|active| active.due);
        self.mission.append(commands, &here, airborne && !self.on_ground(), due)?;
        self.mission_changed();
        self.events.push_back(FlightEvent::MissionExtended { steps: self.mission.steps().len() });
        Ok(())
    }

    fn start(&mut self, now: Duration, when_ready: bool) -> Result<(), Refused> {
        match self.phase {
            FlightPhase::Landing { .. } => return Err(Refused::Landing),
            FlightPhase::Flying if self.flight.manual.holds_mission => return self.resume(now),
            FlightPhase::Flying => return Err(Refused::Flying),
            _ if self.departure.is_some() => return Err(Refused::Flying),
            _ => {}
        }
        if self.mission.steps().is_empty() {
            return Err(Refused::NoMission);
        }
        if !self.mission.takes_off() {
            return Err(Refused::NeverTakesOff);
        }
        if matches!(self.phase, FlightPhase::Standby { .. }) {
            let reasons = self.reasons_not_to_fly(now);
            if !reasons.is_empty() {
                return Err(Refused::NotReady(reasons.iter().map(ToString::to_string).collect()));
            }
            self.begin_flight(now);
            self.watch_before_take_off(now);
        } else {
            let takes_over =
                matches!(self.phase, FlightPhase::Observing { .. }) && self.mission.takes_over();
            if !when_ready && !takes_over {
                let reasons = self.reasons_not_to_fly(now);
                return Err(Refused::NotReady(reasons.iter().map(ToString::to_string).collect()));
            }
            self.begin_flight(now);
        }
        self.departure = Some(now);
        Ok(())
    }

    fn recover(&mut self) -> Result<(), Refused> {
        let emergency = self.drone_state().contains(DroneState::EMERGENCY);
        if !emergency || !self.on_ground() || self.authority == Authority::None {
            return Err(Refused::NoEmergency);
        }
        self.session.request_emergency_reset();
        Ok(())
    }

    /// Why the vehicle cannot take off now, on the ground or before it was found there.
    fn reasons_not_to_fly(&self, now: Duration) -> Vec<NotReady> {
        let mut reasons = self.not_ready(now);
        if !reasons.iter().any(|reason| matches!(reason, NotReady::EmptyBattery { .. })) {
            reasons.extend(self.battery_too_low_for_mission());
        }
        reasons
    }
}
