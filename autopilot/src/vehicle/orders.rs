//! Whether the vehicle accepts an operator's order, and what it does then.

use std::time::Duration;

use super::life::{Active, Departure, Life, Preparation, Why};
use super::readiness::NotReady;
use super::{FlightEvent, LandingReason, Operator, OperatorOrder, Refused, Vehicle, Veto};
use crate::agent::AgentCommand;
use crate::mission::Underway;
use crate::outcome::Outcome;
use crate::plan::{AgentOrder, Commands, Plan};
use ardrone_link::navdata::DroneState;
use ardrone_link::session::Request;
use ardrone_link::settings::{Camera, Setting};

impl Vehicle {
    /// Handles an order from an operator.
    pub(super) fn order(
        &mut self,
        now: Duration,
        by: Operator,
        order: OperatorOrder,
    ) -> Result<(), Refused> {
        self.admit(by, &order)?;
        let flies = order.changes_the_flight();
        let accepted = self.obey(now, by, order);
        if accepted.is_ok() && flies {
            self.controls.has_ordered(now, by);
        }
        self.controls.heard(now, by);
        accepted
    }

    fn obey(&mut self, now: Duration, by: Operator, order: OperatorOrder) -> Result<(), Refused> {
        match order {
            OperatorOrder::Load(plan) => return self.load(now, plan),
            OperatorOrder::Append(commands) => return self.append(now, commands),
            OperatorOrder::Clear => self.clear(now),
            OperatorOrder::Start { when_ready } => return self.start(now, when_ready),
            OperatorOrder::Land => {
                self.flight.safety.land_here();
                self.land(now, LandingReason::Operator);
            }
            // Nothing is sent to such a drone, so a cut would have no effect.
            OperatorOrder::Cut if self.life.departure().is_none() && self.is_foreign() => {
                return Err(Refused::FlownByAnother);
            }
            OperatorOrder::Cut => {
                // A start that waits is no reason to fly once the motors have been cut. A drone that is
                // being taken over in the air is landed, in case the cut does not reach it.
                if self.life.departure().is_some() {
                    self.land(now, LandingReason::Operator);
                }
                self.events.push_back(FlightEvent::CutOrdered);
                self.request(now, Request::EmergencyStop);
            }
            OperatorOrder::Recover => return self.recover(now),
            OperatorOrder::Camera { camera } => return self.show_camera(now, by, camera),
            // They have been taken already; whoever is there was heard.
            OperatorOrder::Take | OperatorOrder::Present => {}
            OperatorOrder::Release => self.controls.release(by),
            // Before the drone has left the ground a hold keeps it there.
            OperatorOrder::Hold if self.is_about_to_fly() => {
                self.land(now, LandingReason::Operator);
            }
            OperatorOrder::Hold => {
                self.can_be_held()?;
                self.hold_here();
            }
            OperatorOrder::Steer(sticks) if !sticks.are_possible() => {
                return Err(Refused::NoSticks);
            }
            OperatorOrder::Steer(sticks) => {
                self.can_be_held()?;
                self.steer(now, by, sticks);
            }
            OperatorOrder::GoTo(place) if place.is_place() => {
                self.can_be_held()?;
                self.send_to(now, &place);
            }
            OperatorOrder::Follow(setpoint) if setpoint.is_finite() => {
                self.can_be_held()?;
                self.follow(now, setpoint);
            }
            OperatorOrder::Setpoint(setpoint) if setpoint.is_finite() => {
                return self.next_setpoint(now, setpoint);
            }
            OperatorOrder::GoTo(_) | OperatorOrder::Follow(_) | OperatorOrder::Setpoint(_) => {
                return Err(Refused::NoPlace);
            }
            OperatorOrder::Resume => return self.resume(now),
        }
        Ok(())
    }

    fn admit(&mut self, by: Operator, order: &OperatorOrder) -> Result<(), Refused> {
        let before = self.controls.holder();
        if order.is_for_anyone() {
            self.controls.admit_any(by);
        } else if !matches!(
            order,
            OperatorOrder::Release | OperatorOrder::Camera { .. } | OperatorOrder::Present
        ) {
            self.controls.admit(by).map_err(Refused::ControlsHeld)?;
        }
        if before.is_some_and(|before| self.controls.holder() != Some(before)) {
            self.events.push_back(FlightEvent::ControlsTaken { by });
        }
        Ok(())
    }

    /// Whether a flight has been started that has not lifted the drone yet.
    fn is_about_to_fly(&self) -> bool {
        match &self.life {
            Life::Preparing { departure, .. } => departure.is_some(),
            Life::Flying(flying) => {
                // In the tick after the landing the flight has yet to end.
                let has_flown = flying.has_flown && flying.due.is_none();
                self.on_ground() && !self.lands() && !has_flown
            }
            Life::Standby { .. } | Life::Landing { .. } => false,
        }
    }

    /// Whether the drone flies and is not landing, so that an operator may change what it does.
    fn can_be_held(&self) -> Result<(), Refused> {
        if self.lands() {
            Err(Refused::Landing)
        } else if self.is_foreign() {
            Err(Refused::FlownByAnother)
        } else if self.life.flying().is_none() || self.on_ground() {
            Err(Refused::OnGround)
        } else {
            Ok(())
        }
    }

    /// Whether another client flies the drone.
    fn is_foreign(&self) -> bool {
        !self.life.commands() && self.navdata.is_some() && !self.on_ground()
    }

    /// Whether the drone is landing, either by order or because the mission has reached its landing step.
    pub(super) fn lands(&self) -> bool {
        let step = self.life.due_order() == Some(AgentOrder::Land);
        step || self.goes_down_onto_tag() || matches!(self.life, Life::Landing { .. })
    }

    /// Whether a landing on a tag has got to the way down: before that an operator may take it back.
    fn goes_down_onto_tag(&self) -> bool {
        let lands = self.decision.is_some_and(|decision| decision.wanted == AgentCommand::Land);
        self.life.due_order() == Some(AgentOrder::LandOnTag)
            && (lands || self.flight.activity.is_descending())
    }

    /// Ends the flight of a drone that is down for good, as one of the next ticks would: a mission that comes in between is for the
    /// next flight, and must not lift it.
    fn end_if_down(&mut self, now: Duration) {
        let Some(flying) = self.life.flying().filter(|_| self.on_ground()) else { return };
        if flying.has_risen && !self.lands() {
            // It has come down by itself.
            self.land(now, LandingReason::Safety(Veto::Landing));
            return;
        }
        let waits = flying.has_flown && flying.due.is_none() && !flying.manual.pauses_mission();
        if waits && !self.mission.takes_off_again() {
            self.next_step(now);
        }
    }

    fn load(&mut self, now: Duration, plan: Plan) -> Result<(), Refused> {
        self.end_if_down(now);
        self.take_tags_of(&plan)?;
        self.mission.load(plan, self.life.flying().is_some());
        self.events.push_back(FlightEvent::MissionLoaded { steps: self.mission.steps().len() });
        self.mission_replaced(now);
        Ok(())
    }

    fn clear(&mut self, now: Duration) {
        self.end_if_down(now);
        if self.is_about_to_fly() {
            self.land(now, LandingReason::Operator);
        }
        self.mission.clear();
        self.events.push_back(FlightEvent::MissionCleared);
        self.mission_replaced(now);
    }

    /// Drops the current step because the mission was replaced. A landing goes on and ends the flight.
    fn mission_replaced(&mut self, now: Duration) {
        self.mission_changed();
        if self.lands() {
            if let Some(Active { due, .. }) = self.life.due() {
                self.give_up(now, Why::Replaced { step: due.step });
            }
            return;
        }
        if self.flight.outcome.is_none() {
            self.flight.report_mut().steps_done = 0;
        }
        if let Life::Flying(flying) = &mut self.life {
            flying.due = None;
            flying.manual.mission_replaced();
        }
    }

    fn append(&mut self, now: Duration, commands: Commands) -> Result<(), Refused> {
        self.end_if_down(now);
        if self.lands() {
            return Err(Refused::Landing);
        }
        let underway = self.life.flying().map(|flying| Underway {
            here: self.pose(now),
            airborne: !self.on_ground(),
            due: flying.due.map(|active| active.due),
        });
        self.mission.append(commands, underway)?;
        self.mission_changed();
        self.events.push_back(FlightEvent::MissionExtended { steps: self.mission.steps().len() });
        Ok(())
    }

    fn start(&mut self, now: Duration, when_ready: bool) -> Result<(), Refused> {
        match &self.life {
            Life::Landing { .. } => return Err(Refused::Landing),
            Life::Flying(flying) if flying.manual.pauses_mission() => return self.resume(now),
            Life::Flying(_) | Life::Preparing { departure: Some(_), .. } => {
                return Err(Refused::Flying);
            }
            Life::Standby { .. } | Life::Preparing { departure: None, .. } => {}
        }
        if self.mission.steps().is_empty() {
            return Err(Refused::NoMission);
        }
        if !self.mission.takes_off() {
            return Err(Refused::NeverTakesOff);
        }
        let reasons = self.reasons_not_to_fly(now);
        let stage = match self.life {
            // The drone is monitored for a moment before take-off.
            Life::Preparing { stage, .. } => stage,
            _ => Preparation::Trimming(self.watched_from(now)),
        };
        let waits = match stage {
            Preparation::Observing(_) if self.mission.takes_over() => true,
            _ => when_ready && matches!(self.life, Life::Preparing { .. }),
        };
        if !reasons.is_empty() && !waits {
            return Err(Refused::NotReady(reasons.iter().map(ToString::to_string).collect()));
        }
        self.begin_flight(now);
        let departure = Some(Departure { ordered: now, takes_over: false });
        self.life.enter(Life::Preparing { stage, departure });
        Ok(())
    }

    fn show_camera(&mut self, now: Duration, by: Operator, camera: Camera) -> Result<(), Refused> {
        match self.controls.holder() {
            Some(holder) if holder != by && !by.local && !holder.yields() => {
                return Err(Refused::ControlsHeld(holder));
            }
            _ if self.is_foreign() => return Err(Refused::FlownByAnother),
            _ => {}
        }
        if let Ok(config) = Setting::VideoChannel(camera).config() {
            self.request(now, Request::Setting(config));
            self.camera = Some(camera);
        }
        Ok(())
    }

    fn recover(&mut self, now: Duration) -> Result<(), Refused> {
        let emergency = self.drone_state().contains(DroneState::EMERGENCY);
        if !emergency || !self.on_ground() || !self.life.commands() {
            return Err(Refused::NoEmergency);
        }
        // A start that waits must not outlive the emergency.
        if self.life.departure().is_some() {
            self.end(now, Outcome::CalledOff);
        }
        self.request(now, Request::EmergencyReset);
        Ok(())
    }

    /// Reasons why the vehicle cannot take off now. Also valid before the drone was found on the ground.
    fn reasons_not_to_fly(&self, now: Duration) -> Vec<NotReady> {
        let mut reasons = self.not_ready(now);
        if !reasons.iter().any(|reason| matches!(reason, NotReady::EmptyBattery { .. })) {
            reasons.extend(self.battery_too_low_for_mission());
        }
        reasons
    }
}
