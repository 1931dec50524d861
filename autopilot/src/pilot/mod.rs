//! The tick: navdata in, one datagram out, the agent between them.
//!
//! A [`Pilot`] is pure. The shell hands it what arrives ([`Pilot::handle`]): navdata, what it reads on the control
//! port, the operator's orders. Every 30 ms it calls [`Pilot::tick`], and then sends and shows what there is
//! ([`Pilot::poll`]). It goes on until [`Pilot::outcome`] tells how the flight ended.

mod control;
mod decision;
mod flight_phase;
mod hand;
mod preflight;
mod protocol;
mod report;
mod saturation;
mod stage;

use std::collections::VecDeque;
use std::time::Duration;

use ardrone_link::at::{Config, Datagram, EncodeError};
use ardrone_link::configuration::Configuration;
use ardrone_link::navdata::{ControlState, Demo, DroneState, Navdata};
use ardrone_link::session::{self, Received, Session, SessionConfig};
use ardrone_link::settings::{Setting, SettingError};
pub use estimator::{Airframe, Quantity, Trust};
use estimator::{Estimator, EstimatorConfig, Prediction, Sample};
use nalgebra::Vector2;
pub use pid::Law;
use pid::{CascadeConfig, Pose, PositionController};

pub use self::decision::Decision;
use self::flight_phase::FlightPhase;
pub use self::flight_phase::{LandingReason, Phase};
use self::hand::Hand;
pub use self::hand::PilotOrder;
use self::protocol::Pending;
pub use self::protocol::{Input, Output, Transmit};
pub use self::report::{FlightEvent, FlightReport, Status, Waypoint};
use self::saturation::Saturation;
pub use self::stage::Stage;
use crate::agent::{Activity, Agent, AgentCommand, AgentStep, Danger, Report, Senses, distance};
use crate::mission::{Due, Mission};
use crate::outcome::Outcome;
use crate::plan::{AgentOrder, FlightLimits, Plan, Target};
use crate::safety::{Circumstances, Guard, Veto};

/// The time between two ticks.
pub const TICK: Duration = Duration::from_millis(30);

/// How often and how much the drone tells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum NavdataRate {
    /// 15 packets a second with what a flight needs.
    #[default]
    Demo,
    /// 200 packets a second with everything.
    Full,
}

/// How to fly.
#[derive(Debug, Clone, PartialEq)]
pub struct PilotConfig {
    /// Heights between which the drone may fly.
    pub limits: FlightLimits,
    /// Whether the configuration is read back over the control port before take-off.
    pub read_back: bool,
    /// What the drone is asked to tell.
    pub navdata: NavdataRate,
    /// How poses are approached and held.
    pub law: Law,
    /// How late the drone tells and obeys, and what is assumed of the airframe.
    pub estimator: EstimatorConfig,
    /// Gains and limits of [`Law::Cascade`].
    pub cascade: CascadeConfig,
}

impl Default for PilotConfig {
    fn default() -> Self {
        Self {
            limits: FlightLimits::default(),
            read_back: true,
            navdata: NavdataRate::default(),
            law: Law::default(),
            estimator: EstimatorConfig::default(),
            cascade: CascadeConfig::default(),
        }
    }
}

/// The drone must answer within this time.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(5);
/// The drone must be configured within this time.
const CONFIGURE_TIMEOUT: Duration = Duration::from_secs(25);
/// After the level reference the drone gets this time to apply it, and is watched.
const SETTLE_TIME: Duration = Duration::from_millis(500);
/// A landing that takes longer than this is not reported as one.
const LANDING_TIMEOUT: Duration = Duration::from_secs(30);
/// After a loss of the link, landing is ordered blindly for this time.
const BLIND_LANDING_TIME: Duration = Duration::from_secs(4);
/// Nothing is allocated in flight: so many events may wait to be told.
const EVENTS: usize = 64;
/// A fault that the drone reports for this long ends the flight.
const FAULT_TIME: Duration = Duration::from_millis(300);
/// What pushes the drone for less than this is a gust.
const WIND_TIME_S: f64 = 2.0;
/// The rate of navdata is told over so long.
const RATE_TIME_S: f64 = 1.0;
const GRAVITY_M_S2: f64 = 9.81;

/// Asks for the drone's clock in demo mode. The key belongs to a category that firmware may only
/// let a custom configuration change, so the flight does not depend on it.
const NAVDATA_OPTIONS_KEY: &str = "general:navdata_options";

/// Flies one plan.
#[derive(Debug)]
pub struct Pilot {
    session: Session,
    estimator: Estimator,
    controller: PositionController,
    law: Law,
    dead_time: Duration,
    agent: Agent,
    activity: Activity,
    mission: Mission,
    /// How long the plan takes.
    expected_time: Duration,
    settings: Vec<Config>,
    phase: FlightPhase,
    navdata: Option<Navdata>,
    due: Option<Active>,
    landing: Option<LandingReason>,
    guard: Guard,
    veto: Option<Veto>,
    hand: Hand,
    authority: Authority,
    /// When the drone was first asked for all navdata.
    asked_at: Duration,
    /// Why a drone that was taken over is not flown on.
    refusals: Vec<String>,
    /// Since when the drone reports a fault of its own.
    fault_since: Option<Duration>,
    /// What pushes the drone, gusts apart: right, forward.
    wind_m_s2: Vector2<f64>,
    /// What full tilt gives, if gravity alone made it.
    full_tilt_m_s2: f64,
    /// What full gaz gives.
    climb_m_s: f64,
    /// Whether it can hold against that.
    saturation: Saturation,
    target: Option<Pose>,
    last_tick: Option<Duration>,
    events: VecDeque<FlightEvent>,
    report: FlightReport,
    /// What the last tick decided; nothing before the first navdata.
    decision: Option<Decision>,
    /// Of the last tick; its buffer is allocated once.
    datagram: Datagram,
    pending: Pending,
    /// Packets a second, smoothed.
    navdata_hz: f64,
    /// When the last packet came.
    packet_at: Option<Duration>,
}

/// By what right the drone is spoken to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Authority {
    /// By none: it was not heard yet, or somebody else flies it. Nothing is sent.
    None,
    /// It was found on the ground.
    OnGround,
    /// It was found in the air, and the plan takes it over.
    TakenOver,
}

/// The step that is being flown.
#[derive(Debug, Clone, Copy)]
struct Active {
    due: Due,
    since: Duration,
    offered: bool,
}

impl Pilot {
    /// A pilot with a plan, on the ground.
    ///
    /// # Errors
    /// [`SettingError`] if the limits cannot be sent to a drone.
    pub fn new(plan: Plan, config: &PilotConfig) -> Result<Self, SettingError> {
        let settings = drone_settings(config)?;
        let session_config = SessionConfig {
            settings: settings.clone(),
            read_back: config.read_back,
            // The agent gives a take-off up, by its own time.
            take_off_timeout: Duration::MAX,
            ..SessionConfig::default()
        };
        let steps = plan.steps().len();
        let expected_time = plan.expected_time(&config.limits);
        let waypoints = Vec::with_capacity(steps);
        let report = FlightReport { steps, waypoints, ..FlightReport::default() };
        Ok(Self {
            session: Session::new(session_config),
            estimator: Estimator::new(config.estimator),
            controller: PositionController::new(config.law, config.cascade),
            law: config.law,
            dead_time: config.estimator.dead_time,
            agent: Agent::new(),
            activity: Activity::default(),
            expected_time,
            mission: Mission::new(plan, config.limits),
            settings,
            phase: FlightPhase::Connecting,
            navdata: None,
            due: None,
            landing: None,
            guard: Guard::new(config.limits),
            veto: None,
            hand: Hand::default(),
            authority: Authority::None,
            asked_at: Duration::ZERO,
            refusals: Vec::new(),
            fault_since: None,
            saturation: Saturation::default(),
            wind_m_s2: Vector2::zeros(),
            climb_m_s: config.estimator.limits.climb_m_s,
            full_tilt_m_s2: GRAVITY_M_S2 * config.estimator.limits.tilt_rad.tan(),
            target: None,
            last_tick: None,
            events: VecDeque::with_capacity(EVENTS),
            report,
            decision: None,
            datagram: Datagram::new(),
            pending: Pending::default(),
            navdata_hz: 0.0,
            packet_at: None,
        })
    }

    fn handle_navdata(&mut self, now: Duration, datagram: &[u8]) {
        match self.session.handle_navdata(now, datagram) {
            Received::Navdata(navdata) => {
                self.count_packet(now);
                self.session_events(now);
                if let Some(demo) = &navdata.demo {
                    self.estimator.update(&sample(now, &navdata, demo));
                }
                self.navdata = Some(navdata);
            }
            // Counted by the session.
            Received::Stale | Received::Damaged(_) => {}
        }
    }

    fn count_packet(&mut self, now: Duration) {
        if let Some(last) = self.packet_at.replace(now) {
            let period_s = now.saturating_sub(last).as_secs_f64().max(1e-3);
            let share = (period_s / RATE_TIME_S).min(1.0);
            self.navdata_hz += (1.0 / period_s - self.navdata_hz) * share;
        }
    }

    fn handle_control(&mut self, now: Duration, bytes: &[u8]) {
        self.session.handle_control(bytes);
        self.session_events(now);
    }

    /// As [`Pilot::tick`]; `done` is called at the end of each stage.
    ///
    /// # Errors
    /// See [`Session::tick`].
    pub fn tick_timed(
        &mut self,
        now: Duration,
        mut done: impl FnMut(Stage),
    ) -> Result<(), EncodeError> {
        self.datagram.clear();
        self.decide(now, &mut done)?;
        self.pending.command = !self.datagram.as_bytes().is_empty();
        self.pending.wake_up = self.session.wake_up_due(now);
        Ok(())
    }

    /// Decides what the drone is to do, and encodes it.
    fn decide(&mut self, now: Duration, done: &mut impl FnMut(Stage)) -> Result<(), EncodeError> {
        let step_s = self
            .last_tick
            .map_or(TICK, |last| now.saturating_sub(last))
            .min(2 * TICK)
            .as_secs_f64();
        self.last_tick = Some(now);
        self.watch(now);
        if self.navdata.is_none() || self.authority == Authority::None {
            return Ok(());
        }
        self.offer_order(now);
        // The estimate is flown on to this moment once: everything below looks at the same.
        let prediction = self.estimator.predicted(now);
        let state = match self.law {
            Law::Cascade => prediction,
            Law::Tum => self.state(now),
        };
        self.feel_wind(prediction.disturbance_m_s2, step_s);
        let senses = self.senses(now, &state);
        let step = AgentStep::run(&mut self.agent, &mut self.activity, senses);
        self.hand.pre_empts = false;
        // What is refused for a danger ends for that reason.
        if let Some(danger) = step.danger {
            self.endangered(now, danger);
        }
        if let Some(report) = step.report {
            self.order_ended(now, report);
        }
        done(Stage::Agent);
        // An agent that asks for nothing gets a hover.
        let wanted = step.command.unwrap_or(AgentCommand::Hover);
        let circumstances = self.circumstances(now, &state);
        let (command, veto) = self.guard.check(wanted, &circumstances);
        if let Some(veto) = veto.filter(|_| veto != self.veto) {
            self.events.push_back(FlightEvent::Veto(veto));
            if veto.lands() {
                self.land(now, LandingReason::Guard(veto));
            }
        }
        self.veto = veto;
        let order = self.carry_out(now, command, &state, step_s);
        self.decision = Some(Decision {
            at: now,
            phase: self.phase.phase(),
            step: self.due.as_ref().map(|active| active.due.step),
            state,
            vertical_deviation_m: self.estimator.vertical_deviation_m(now),
            senses,
            plans: step.plans,
            wanted,
            report: step.report,
            danger: step.danger,
            veto,
            target: self.target,
            order,
        });
        done(Stage::Control);
        self.session.tick(now, order, &mut self.datagram)?;
        done(Stage::Encode);
        self.session_events(now);
        Ok(())
    }

    /// A tick of a pilot that leaves: the order to land, by the session alone, whatever has happened to the rest.
    /// See [`Session::part`].
    ///
    /// # Errors
    /// See [`Session::part`].
    pub fn part(&mut self, now: Duration) -> Result<(), EncodeError> {
        self.session.part(now, &mut self.datagram)?;
        self.pending.command = !self.datagram.as_bytes().is_empty();
        Ok(())
    }

    /// How many datagrams told something, and how many meant nothing.
    pub fn link_statistics(&self) -> session::Statistics {
        self.session.statistics()
    }

    /// The datagram of the last tick, empty if there was none.
    pub fn datagram(&self) -> &[u8] {
        self.datagram.as_bytes()
    }

    /// What the last tick decided and why; nothing before the first navdata.
    pub fn decision(&self) -> Option<&Decision> {
        self.decision.as_ref()
    }

    /// How the flight ended, once it has.
    pub fn outcome(&self) -> Option<&Outcome> {
        match &self.phase {
            FlightPhase::Ended(outcome) => Some(outcome),
            _ => None,
        }
    }

    /// The flight so far.
    pub fn report(&self) -> &FlightReport {
        &self.report
    }

    /// A snapshot for whoever watches.
    pub fn status(&self, now: Duration) -> Status {
        // The last tick has flown the estimate on already.
        let pose = match &self.decision {
            Some(decision) => pose(&decision.state),
            None => self.pose(now),
        };
        Status {
            phase: self.phase.phase(),
            step: self.due.as_ref().map(|active| active.due.step),
            steps: self.report.steps,
            plan_waits: self.hand.holds_plan,
            pose,
            target: self.target,
            distance_m: self.target.map(|target| distance(&pose, &target)),
            battery_percent: self.demo().map(|demo| demo.battery_percent),
            horizontal_deviation_m: self.estimator.horizontal_deviation_m(now),
            vertical_deviation_m: self.estimator.vertical_deviation_m(now),
            trust: self.estimator.trust(),
            airframe: *self.estimator.airframe(),
            navdata_age: self.session.silence(now),
            navdata_hz: self.navdata_hz,
            attitude_deg: self.demo().map(|demo| [demo.roll_deg, demo.pitch_deg]),
            plans: self.decision.map(|decision| decision.plans).unwrap_or_default(),
            command: self.decision.map(|decision| decision.wanted.name()),
        }
    }

    fn demo(&self) -> Option<&Demo> {
        self.navdata.as_ref().and_then(|navdata| navdata.demo.as_ref())
    }

    fn drone_state(&self) -> DroneState {
        self.session.state()
    }

    fn on_ground(&self) -> bool {
        let flying = self.drone_state().contains(DroneState::FLYING);
        let landed = self.demo().is_none_or(|demo| demo.control_state == ControlState::Landed);
        !flying && (landed || self.drone_state().contains(DroneState::EMERGENCY))
    }

    /// Where the drone is, and how it moves.
    fn state(&self, at: Duration) -> Prediction {
        match self.law {
            Law::Cascade => self.estimator.predicted(at),
            // It knows no prediction.
            Law::Tum => {
                let estimate = self.estimator.estimate();
                Prediction {
                    position_m: estimate.position_m,
                    velocity_m_s: estimate.velocity_m_s,
                    yaw_deg: estimate.yaw_deg,
                    ..Prediction::default()
                }
            }
        }
    }

    fn pose(&self, now: Duration) -> Pose {
        pose(&self.state(now))
    }

    fn senses(&self, now: Duration, state: &Prediction) -> Senses {
        let hovering = self.demo().is_some_and(|demo| {
            matches!(demo.control_state, ControlState::Hovering | ControlState::Flying)
        });
        Senses {
            now_ms: i64::try_from(now.as_millis()).unwrap_or(i64::MAX),
            pose: self.demo().map(|_| pose(state)),
            on_ground: self.on_ground(),
            hovering: hovering && self.drone_state().contains(DroneState::FLYING),
            battery_percent: self.battery_percent(),
            blind_for_ms: i64::try_from(self.blind_for(now).as_millis()).unwrap_or(i64::MAX),
            doubt_m: self.estimator.horizontal_deviation_m(now),
            saturated_for_ms: self.saturation.for_ms(),
            wind: self.wind().norm(),
            steering: self.hand.sticks(now).is_some(),
            settings: self.mission.settings(),
        }
    }

    /// What is left; nothing, if the drone itself says that it is too little.
    fn battery_percent(&self) -> Option<u32> {
        let empty = self.drone_state().contains(DroneState::BATTERY_LOW);
        self.demo().map(|demo| if empty { 0 } else { demo.battery_percent })
    }

    /// Time since the newest navdata that could be believed. Until there are any the time counts from
    /// when the drone was asked for them.
    fn blind_for(&self, now: Duration) -> Duration {
        let since = self.estimator.sound_at().unwrap_or(self.asked_at);
        now.saturating_sub(since)
    }

    fn least_thrust(&self) -> f64 {
        self.estimator.airframe().thrust_gain.amin()
    }

    /// The wind's push as a share of what the drone can lean against.
    fn wind(&self) -> Vector2<f64> {
        self.wind_m_s2 / (self.full_tilt_m_s2 * self.least_thrust())
    }

    fn feel_wind(&mut self, push_m_s2: Vector2<f64>, step_s: f64) {
        let push_m_s2 = if self.on_ground() { Vector2::zeros() } else { push_m_s2 };
        self.wind_m_s2 += (push_m_s2 - self.wind_m_s2) * (step_s / WIND_TIME_S);
    }

    fn circumstances(&self, now: Duration, state: &Prediction) -> Circumstances {
        let full_tilt_m_s2 = self.full_tilt_m_s2 * self.least_thrust();
        Circumstances {
            now,
            blind_for: self.blind_for(now),
            emergency: self.drone_state().contains(DroneState::EMERGENCY),
            airborne: !self.on_ground(),
            landing: self.demo().is_some_and(|demo| demo.control_state == ControlState::Landing),
            pose: pose(state),
            velocity_m_s: state.velocity_m_s.into(),
            wind: (state.disturbance_m_s2 / full_tilt_m_s2).into(),
            full_tilt_m_s2,
            drag_1_s: self.estimator.airframe().drag_1_s.min(),
        }
    }

    /// Gives the agent the next order when the last one has ended.
    fn offer_order(&mut self, now: Duration) {
        let waits = self.landing.is_some() || self.hand.pre_empts;
        if self.phase != FlightPhase::Flying || waits {
            return;
        }
        if self.hand.holds_plan {
            self.offer_hand_target();
            return;
        }
        if self.due.is_none() {
            match self.mission.advance(&self.pose(now)) {
                Some(due) => {
                    self.due = Some(Active { due, since: now, offered: false });
                    self.events.push_back(FlightEvent::StepStarted { step: due.step });
                    if due.is_corrected() {
                        self.events.push_back(FlightEvent::TargetCorrected { step: due.step });
                    }
                }
                None => self.end(Outcome::Completed),
            }
        }
        let Some(active) = &mut self.due else { return };
        if active.offered {
            return;
        }
        active.offered = match active.due.order {
            AgentOrder::TakeOff => self.agent.achieve_take_off(),
            AgentOrder::Land => self.agent.achieve_land(),
            AgentOrder::GoTo(Target { pose, .. }) => {
                self.agent.achieve_go_to(pose.x_m, pose.y_m, pose.z_m, pose.yaw_deg)
            }
        };
    }

    /// The agent has reported how its last order ended.
    fn order_ended(&mut self, now: Duration, report: Report) {
        if self.landing.is_some() {
            // The end of a landing is judged by the drone's state.
            return;
        }
        if self.hand.holds_plan {
            self.hand_target_ended(report);
            return;
        }
        let Some(active) = self.due.take() else { return };
        if report != Report::Done {
            self.land(now, LandingReason::StepFailed { step: active.due.step });
            return;
        }
        let pose = self.pose(now);
        self.report.steps_done = active.due.step + 1;
        match active.due.order {
            AgentOrder::TakeOff => {
                self.mission.take_off_ended(&pose);
                self.report.took_off_at.get_or_insert(active.since);
            }
            AgentOrder::GoTo(target) => {
                let waypoint = Waypoint {
                    step: active.due.step,
                    target: target.pose,
                    pose,
                    horizontal_deviation_m: self.estimator.horizontal_deviation_m(now),
                    at: now,
                };
                self.report.waypoints.push(waypoint);
            }
            AgentOrder::Land => self.report.landed_at = Some(now),
        }
        self.events.push_back(FlightEvent::StepDone { step: active.due.step });
    }
}

fn pose(state: &Prediction) -> Pose {
    Pose {
        x_m: state.position_m.x,
        y_m: state.position_m.y,
        z_m: state.position_m.z,
        yaw_deg: state.yaw_deg,
    }
}

/// What a navdata packet says of the drone's motion.
fn sample(now: Duration, navdata: &Navdata, demo: &Demo) -> Sample {
    Sample {
        arrival: now,
        drone_time: navdata.time,
        yaw_deg: demo.yaw_deg,
        roll_deg: demo.roll_deg,
        pitch_deg: demo.pitch_deg,
        velocity_forward_m_s: demo.velocity_forward_m_s,
        velocity_right_m_s: demo.velocity_right_m_s,
        altitude_m: demo.altitude_m,
        airborne: navdata.state.contains(DroneState::FLYING),
        reported_lost: reported_lost(navdata.state, demo),
    }
}

/// What the drone says it has lost.
fn reported_lost(state: DroneState, demo: &Demo) -> Option<Quantity> {
    if demo.has_lost_vision() {
        Some(Quantity::Velocity)
    } else if demo.has_lost_altitude() || state.contains(DroneState::ULTRASOUND_DEAF) {
        Some(Quantity::Altitude)
    } else {
        None
    }
}

/// What is set on the drone before each flight: other clients may have left anything there.
fn drone_settings(config: &PilotConfig) -> Result<Vec<Config>, SettingError> {
    let limits = &config.estimator.limits;
    [
        Setting::NavdataDemo(config.navdata == NavdataRate::Demo),
        // Demo, time and vision_detect.
        Setting::NavdataOptions(vec![0, 1, 16]),
        Setting::Outdoor(false),
        Setting::AltitudeMaxM(config.limits.ceiling_m),
        Setting::EulerAngleMaxDeg(limits.tilt_rad.to_degrees()),
        Setting::ClimbMaxMS(limits.climb_m_s),
        Setting::YawRateMaxDegS(limits.turn_deg_s),
    ]
    .iter()
    .map(Setting::config)
    .collect()
}

#[cfg(test)]
mod tests;
