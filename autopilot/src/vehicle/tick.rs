//! One tick: percepts, the agent's decision, the safety layer, and the datagram.

use std::sync::Arc;
use std::time::Duration;

use ardrone_link::at::Motion;
use ardrone_link::navdata::{ControlState, DroneState};
use ardrone_link::session::{FlightOrder, Input, Order, Request};
use estimator::Prediction;
use kinematics::{GRAVITY_M_S2, Pose};

use super::life::{Active, Life};
use super::{
    AgentOrder, Decision, FlightEvent, LandingReason, NotReady, Outcome, READINESS_TICKS, Report,
    RestsOn, Stage, TICK, TagStatus, Target, Vehicle, Waypoint, is_airborne, pose,
};
use crate::agent::{AgentCommand, AgentStep, Percepts, StationPercepts};
use crate::safety::{self, Situation};
use crate::wind::{Wind, without_drag};

/// A drone obeys within this time and the link's delay, and then leans to within this share of full tilt.
const OBEYS_WITHIN: Duration = Duration::from_millis(500);
const DISOBEDIENT: f64 = 0.7;
/// The slowest airframe has sunk by more than noise within this time and the link's delay.
const SINKS_WITHIN: Duration = Duration::from_secs(1);
/// Stick at which it is told to sink so fast.
const SINKS: f32 = -0.5;
/// Older navdata do not show whether it does.
const HEARD: Duration = Duration::from_millis(150);

impl Vehicle {
    /// Decides what the drone shall do, and encodes it; `done` is called at the end of each stage.
    pub(super) fn decide(&mut self, now: Duration, mut done: impl FnMut(Stage)) {
        let step_s = self
            .last_tick
            .map_or(TICK, |last| now.saturating_sub(last))
            .min(2 * TICK)
            .as_secs_f64();
        self.last_tick = Some(now);
        self.watch_readiness(now);
        self.watch(now);
        if self.navdata.is_none() || !self.life.commands() {
            self.pass_on(now, Input::Listen);
            return;
        }
        self.offer_order(now);
        let flown = self.life.due().map(|active| active.due.step);
        // The state is predicted once, so that everything below uses the same one.
        let state = self.state(now);
        self.feel_wind(&state, step_s);
        let tags = self.flight.estimator.tag_status(now);
        self.cross_check(now, tags.as_ref(), step_s);
        self.advance_setpoint(&state, step_s);
        let percepts = self.percepts(now, &state, tags.as_ref());
        let step = AgentStep::run(&mut self.flight.agent, &mut self.flight.activity, percepts);
        // An order that is refused because of a danger ends with that danger as its reason.
        if let Some(danger) = step.danger {
            self.endangered(now, danger);
        }
        if let Some(report) = step.report {
            self.order_ended(now, report);
        }
        done(Stage::Agent);
        // An agent without a command hovers. A way down by our orders that the drone does not hear is left to the drone.
        let wanted = step.command.unwrap_or(AgentCommand::Hover);
        let wanted = if self.flight.ignores_descent { AgentCommand::Land } else { wanted };
        // An order acts after a delay: by then the drone does what it has been sent before.
        let soon = self.state(now + self.flight.estimator.order_delay());
        let situation = self.situation(now, &state, &soon);
        let (command, veto) = self.flight.safety.check(wanted, &situation);
        let (command, apart) = self.kept_apart(now, command, &state, &situation);
        // One that lands is told of, whatever else is.
        let veto = [veto, apart].into_iter().flatten().max_by_key(|veto| veto.lands());
        if let Some(veto) = veto.filter(|_| veto != self.flight.veto) {
            self.events.push_back(FlightEvent::Veto(veto));
            if veto.lands() {
                self.land(now, LandingReason::Safety(veto));
            }
        }
        self.flight.veto = veto;
        let order = self.carry_out(now, command, &soon, step_s);
        self.watch_obedience(now, &order, state.position_m.z);
        self.decision = Some(Decision {
            at: now,
            phase: self.life.phase(),
            step: flown,
            state,
            height_uncertainty_m: self.flight.estimator.height_uncertainty_m(now),
            worth: self.flight.estimator.worth(),
            wind_m_s2: self.flight.wind.mean_m_s2(),
            tags,
            percepts,
            plans: step.plans,
            wanted,
            report: step.report,
            danger: step.danger,
            veto,
            target: self.flight.target,
            order,
        });
        done(Stage::Control);
        self.session.handle(now, Input::Tick(order));
        done(Stage::Encode);
        self.take_in(now);
    }

    /// Notices a drone that does not tilt as it is told, and makes it listen: it may have heard higher numbers than ours, of
    /// another client. No wind and no airframe lets a drone lean the other way for so long.
    ///
    /// Nor does one that is told to land and to sink stay where it is: it lands by itself then, for which it need hear a
    /// single order.
    fn watch_obedience(&mut self, now: Duration, order: &Order, height_m: f64) {
        let full_deg = self.config.estimator.limits.tilt_rad.to_degrees();
        // Of what is not heard nothing is known.
        let heard = self.session.silence(now).is_some_and(|age| age <= HEARD);
        let off = match (order.motion, self.demo()) {
            (Motion::Progressive { roll, pitch, .. }, Some(demo)) if heard && !self.on_ground() => {
                let off = [(roll, demo.roll_deg), (pitch, demo.pitch_deg)]
                    .map(|(told, deg)| (f64::from(told.get()) - deg / full_deg).abs());
                off[0].max(off[1])
            }
            _ => 0.0,
        };
        // In a landing it hovers only while it does not know enough to sink by its sticks.
        let sinks = match order.motion {
            Motion::Progressive { gaz, .. } => gaz.get() <= SINKS,
            Motion::Hover => order.flight == FlightOrder::StayAirborne,
        };
        let delay = self.flight.estimator.order_delay();
        let told = sinks && heard && self.lands();
        let stays_up = self.flight.stays_up.lasts(now, told, height_m, SINKS_WITHIN + delay);
        // What is flown after that landing is another matter.
        self.flight.ignores_descent =
            (self.flight.ignores_descent || stays_up) && !self.on_ground();
        let leans_otherwise =
            self.flight.disobeys.lasts(now, off > DISOBEDIENT, OBEYS_WITHIN + delay);
        if leans_otherwise || self.flight.ignores_descent {
            self.request(now, Request::Insist);
        }
    }

    /// Checks the readiness every [`READINESS_TICKS`]. Only a change in the kinds of reasons is reported, not
    /// a change of a number in one of them.
    fn watch_readiness(&mut self, now: Duration) {
        self.readiness_in = self.readiness_in.saturating_sub(1);
        if self.readiness_in > 0 {
            return;
        }
        self.readiness_in = READINESS_TICKS;
        // A tick in flight must not allocate.
        if self.life.is_in_flight() {
            if !Arc::ptr_eq(&self.readiness, &self.in_flight) {
                self.readiness = Arc::clone(&self.in_flight);
                self.pending.readiness = true;
            }
            return;
        }
        let reasons = self.not_ready(now);
        let kinds = |reasons: &[NotReady]| -> Vec<_> {
            reasons.iter().map(std::mem::discriminant).collect()
        };
        self.pending.readiness |= kinds(&reasons) != kinds(&self.readiness);
        self.readiness = reasons.into();
    }

    /// Predicted position and motion at `at`.
    pub(super) fn state(&self, at: Duration) -> Prediction {
        self.flight.estimator.predicted(at)
    }

    pub(super) fn pose(&self, now: Duration) -> Pose {
        pose(&self.state(now))
    }

    fn percepts(&self, now: Duration, state: &Prediction, tags: Option<&TagStatus>) -> Percepts {
        let hovering = self.demo().is_some_and(|demo| {
            matches!(demo.control_state, ControlState::Hovering | ControlState::Flying)
                && is_airborne(self.drone_state(), demo.control_state)
        });
        Percepts {
            now_ms: i64::try_from(now.as_millis()).unwrap_or(i64::MAX),
            pose: self.demo().map(|_| pose(state)),
            on_ground: self.on_ground(),
            hovering,
            battery_percent: self.battery_percent(),
            blind_for_ms: i64::try_from(self.blind_for(now).as_millis()).unwrap_or(i64::MAX),
            uncertainty_m: self.flight.estimator.uncertainty_m(now),
            saturated_for_ms: self.flight.saturation.for_ms(),
            wind: self.flight.wind.share(),
            steering: self.life.manual().sticks(now).is_some(),
            setpoint: self.life.manual().setpoint(now),
            station: self.station_percepts(now),
            settings: self.mission.settings(),
            speed_m_s: state.velocity_m_s.xy().norm(),
            fence: self.config.limits,
            tags: tags.map(|status| self.tag_percepts(now, state, status)),
        }
    }

    fn station_percepts(&self, now: Duration) -> StationPercepts {
        let ms = |time: Duration| i64::try_from(time.as_millis()).unwrap_or(i64::MAX);
        StationPercepts {
            silent_for_ms: ms(self.controls.silence(now)),
            hold_after_ms: ms(self.config.station.hold_after),
            land_after_ms: ms(self.config.station.land_after),
        }
    }

    /// Remaining charge; zero if the drone itself reports that it is too low.
    fn battery_percent(&self) -> Option<u32> {
        let empty = self.drone_state().contains(DroneState::BATTERY_LOW);
        self.demo().map(|demo| if empty { 0 } else { demo.battery_percent })
    }

    /// Time since the newest plausible navdata. Before the first ones, the time since they were requested.
    pub(super) fn blind_for(&self, now: Duration) -> Duration {
        let since = self.flight.estimator.sound_at().unwrap_or(self.flight.asked_at);
        now.saturating_sub(since)
    }

    /// Horizontal acceleration at full tilt with thrust that balances gravity, in m/s².
    pub(super) fn full_tilt_m_s2(&self) -> f64 {
        GRAVITY_M_S2 * self.config.estimator.limits.tilt_rad.tan()
    }

    pub(super) fn least_thrust(&self) -> f64 {
        self.flight.estimator.airframe().thrust_gain.amin()
    }

    /// The wind of one flight; none on the ground.
    pub(super) fn feel_wind(&mut self, state: &Prediction, step_s: f64) {
        let full_tilt_m_s2 = self.full_tilt_m_s2() * self.least_thrust();
        if self.on_ground() {
            self.flight.wind = Wind::calm(full_tilt_m_s2);
        } else {
            let drag_1_s = self.flight.estimator.airframe().drag_1_s.min();
            let disturbance_m_s2 = without_drag(state, drag_1_s);
            self.flight.wind.feel(disturbance_m_s2, full_tilt_m_s2, step_s);
        }
    }

    pub(super) fn situation(
        &self,
        now: Duration,
        state: &Prediction,
        soon: &Prediction,
    ) -> Situation {
        let airframe = self.flight.estimator.airframe();
        Situation {
            now,
            blind_for: self.blind_for(now),
            emergency: self.drone_state().contains(DroneState::EMERGENCY),
            airborne: !self.on_ground(),
            landing: self.demo().is_some_and(|demo| demo.control_state == ControlState::Landing),
            sticks: self.life.manual().sticks(now).unwrap_or_default(),
            pose: pose(state),
            velocity_m_s: state.velocity_m_s.into(),
            soon: safety::Motion { pose: pose(soon), velocity_m_s: soon.velocity_m_s.into() },
            wind: self.flight.wind,
            drag_1_s: airframe.drag_1_s.min(),
            tick_s: TICK.as_secs_f64(),
            tilts_after_s: TICK.as_secs_f64() + airframe.tilt_lag_s,
            climb_lag_s: airframe.climb_lag_s,
            climb_m_s: self.config.estimator.limits.climb_m_s,
            sink_m_s: self.config.estimator.limits.climb_m_s * airframe.drop_gain,
        }
    }

    /// Hands the next order to the agent when the last one has ended.
    fn offer_order(&mut self, now: Duration) {
        if self.offer_goal() {
            return;
        }
        if self.life.manual().pauses_mission() {
            self.offer_manual_target();
            return;
        }
        if self.life.flying().is_some_and(|flying| flying.due.is_none()) {
            self.next_step(now);
        }
        let due = self.life.flying_mut().and_then(|flying| flying.due.as_mut());
        let Some(active @ Active { offered: false, .. }) = due else { return };
        let agent = &mut self.flight.agent;
        active.offered = match active.due.order {
            AgentOrder::TakeOff => agent.achieve_take_off(),
            AgentOrder::Land => agent.achieve_land(),
            AgentOrder::FindTag => agent.achieve_find_tag(),
            AgentOrder::LandOnTag => agent.achieve_land_on_tag(),
            AgentOrder::GoTo(Target { pose, .. }) => {
                agent.achieve_go_to(pose.x_m, pose.y_m, pose.z_m, pose.yaw_deg)
            }
        };
    }

    /// Begins the next step. After the last one, the flight ends if the drone is on the ground; in the air it
    /// holds until it gets another order.
    pub(super) fn next_step(&mut self, now: Duration) {
        match self.mission.advance(&self.pose(now)) {
            Some(due) => {
                if let Life::Flying(flying) = &mut self.life {
                    flying.due = Some(Active { due, since: now, offered: false });
                }
                self.events.push_back(FlightEvent::StepStarted { step: due.step });
                if due.is_corrected() {
                    self.events.push_back(FlightEvent::TargetCorrected { step: due.step });
                }
            }
            None if self.on_ground() => self.end(now, Outcome::Completed),
            None => {}
        }
    }

    /// The agent has reported how its last order ended.
    fn order_ended(&mut self, now: Duration, report: Report) {
        // The end of a landing is detected from the drone's state.
        let Life::Flying(flying) = &mut self.life else { return };
        if report == Report::Paused {
            if let Some(active) = &mut flying.due {
                active.offered = false;
            }
            self.order_paused();
            return;
        }
        if flying.manual.pauses_mission() {
            self.manual_target_ended(report);
            return;
        }
        let Some(active) = flying.due.take() else { return };
        if report != Report::Done {
            self.land(now, LandingReason::StepFailed { step: active.due.step });
            return;
        }
        let pose = self.pose(now);
        self.flight.report_mut().steps_done = active.due.step + 1;
        match active.due.order {
            AgentOrder::TakeOff => {
                self.mission.take_off_ended(&self.hover_place(pose));
                self.flight.report_mut().took_off_at.get_or_insert(active.since);
            }
            AgentOrder::GoTo(target) => {
                let waypoint = Waypoint {
                    step: active.due.step,
                    target: target.pose,
                    pose,
                    uncertainty_m: self.flight.estimator.uncertainty_m(now),
                    rests_on: RestsOn::of(self.flight.estimator.tag_status(now).as_ref()),
                    at: now,
                };
                self.flight.report_mut().waypoints.push(waypoint);
            }
            AgentOrder::FindTag => self.mission.stopped_at(&pose),
            AgentOrder::Land | AgentOrder::LandOnTag => {}
        }
        self.events.push_back(FlightEvent::StepDone { step: active.due.step });
    }
}
