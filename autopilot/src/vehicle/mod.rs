//! The vehicle: navdata and operator orders in, one AT datagram every 30 ms out, the agent in between.
//!
//! A [`Vehicle`] is a pure state machine. The shell passes in what arrives ([`Vehicle::handle`]): navdata, bytes from the
//! control port, operator orders, and every 30 ms a tick; then it sends and displays the outputs ([`Vehicle::poll`]). The
//! vehicle rests on the ground until an operator starts a mission, flies it, and rests again.

mod control;
mod cross_check;
mod decision;
mod event;
mod flight;
mod landing_reason;
mod life;
mod link;
mod manual;
mod manual_orders;
mod name;
mod neighbours;
mod operator_order;
mod operators;
mod orders;
mod phase;
mod place;
mod protocol;
mod readiness;
mod refused;
mod report;
mod saturation;
mod setpoint;
mod since;
mod stage;
mod status;
mod tags;
mod tick;
mod watch;

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

use ardrone_link::at::{Config, Identity};
use ardrone_link::navdata::{ControlState, Demo, DroneState, GpsFix, Navdata};
use ardrone_link::session::{self, Session, SessionConfig};
use ardrone_link::settings::{BitRateControl, Camera, Detection, Setting, SettingError};
use estimator::{EstimatorConfig, Prediction};
pub use estimator::{
    KnownTag, KnownTags, Quantity, Start, SurveyedTag, TagConfig, TagStatus, Trust, Worth,
};
use kinematics::Pose;
use pid::CascadeConfig;

pub use self::cross_check::{CrossCheck, RestsOn};
pub use self::decision::Decision;
pub use self::event::FlightEvent;
use self::flight::{Flight, is_airborne, sample};
pub use self::landing_reason::LandingReason;
use self::life::{Life, Watched};
pub use self::manual::ManualControl;
pub use self::name::{NoVehicleName, VehicleName};
pub use self::operator_order::{CommandsText, OperatorOrder, OrderText, Place, PlanText};
use self::operators::Controls;
pub use self::operators::{Operator, Station};
pub use self::phase::Phase;
use self::protocol::Pending;
pub use self::protocol::{Input, Output, Telemetry, Transmit};
pub use self::readiness::NotReady;
pub use self::refused::Refused;
pub use self::report::{FlightReport, Waypoint};
pub use self::setpoint::{Heading, Horizontal, Setpoint, Vertical};
pub use self::stage::Stage;
pub use self::status::Status;
use self::tags::{SignSearch, sights};
use crate::agent::{Danger, Report, distance};
use crate::mission::Mission;
use crate::outcome::Outcome;
use crate::plan::{AgentOrder, FlightLimits, Plan, Step, Target};
pub use crate::safety::Veto;
use crate::separation::Neighbours;

/// Control period.
pub const TICK: Duration = Duration::from_millis(30);

/// Rate and content of the navdata.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum NavdataRate {
    /// 15 packets a second with the data needed for flying.
    #[default]
    Demo,
    /// 200 packets a second with all options.
    Full,
}

/// How often the ultrasound measures. Two drones near each other hear each other's echoes unless theirs differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ultrasound {
    /// 22.22 Hz.
    Slow,
    /// 25 Hz, as in factory state.
    Fast,
}

/// Configuration of a [`Vehicle`].
#[derive(Debug, Clone, PartialEq)]
pub struct VehicleConfig {
    /// Its name.
    pub name: VehicleName,
    /// Number of its `MAVLink` system, 1 to 250.
    pub system: u8,
    /// The fence.
    pub limits: FlightLimits,
    /// Least distance from other vehicles, across, in metres.
    pub separation_m: f64,
    /// Numbers of the other vehicles in the room: while one of them is not heard, this one does not take off.
    pub peers: Vec<u8>,
    /// Whether the drone's configuration is read back over the control port before take-off.
    pub read_back: bool,
    /// Navdata rate requested from the drone.
    pub navdata: NavdataRate,
    /// Whether the drone is asked for the position by its flight recorder, which is only reported.
    pub gps: bool,
    /// Bit rate of the video that is asked for, 250 to 4000 kbit/s; otherwise the drone keeps its own.
    pub video_kbit_s: Option<u32>,
    /// Frequency of the ultrasound that is asked for; otherwise the drone keeps its own.
    pub ultrasound: Option<Ultrasound>,
    /// What a silent ground station means.
    pub station: StationPatience,
    /// Delays and airframe parameters assumed by the estimator.
    pub estimator: EstimatorConfig,
    /// Gains and limits of the control law.
    pub cascade: CascadeConfig,
}

/// How long a ground station that has the controls may be silent in flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StationPatience {
    /// After this time its mission is paused and the drone holds.
    pub hold_after: Duration,
    /// After this time the drone lands.
    pub land_after: Duration,
}

impl Default for StationPatience {
    fn default() -> Self {
        Self { hold_after: Duration::from_secs(10), land_after: Duration::from_secs(20) }
    }
}

impl VehicleConfig {
    /// The drone stands there at its first start, in a world that it shares with others: targets, fence and tags are places of
    /// that world. With `None` the world begins where the drone stands.
    pub fn starts_at(&mut self, start: Option<Start>) {
        self.estimator.start = start;
        self.limits.start = start.map(|Start { place_m, heading_deg, .. }| {
            let [x_m, y_m] = place_m.into();
            Pose { x_m, y_m, z_m: 0.0, yaw_deg: heading_deg }
        });
    }

    /// Settings made before each flight, because other clients may have left different values.
    ///
    /// # Errors
    /// [`SettingError`] if the ceiling, a limit of the drone or the video's bit rate is out of the range of its setting.
    pub fn drone_settings(&self) -> Result<Vec<Config>, SettingError> {
        let limits = &self.estimator.limits;
        // Options demo, time, raw_measures (for the battery's voltage) and vision_detect; and the flight recorder's.
        let options = [0, 1, 2, 16].into_iter().chain(self.gps.then_some(27));
        let mut settings = vec![
            Setting::NavdataDemo(self.navdata == NavdataRate::Demo),
            Setting::NavdataOptions(options.collect()),
            Setting::Outdoor(false),
            Setting::AltitudeMaxM(self.limits.ceiling_m),
            Setting::EulerAngleMaxDeg(limits.tilt_rad.to_degrees()),
            Setting::ClimbMaxMS(limits.climb_m_s),
            Setting::YawRateMaxDegS(limits.turn_deg_s),
        ];
        if self.estimator.tags.is_some() {
            // The selection counts for other values of the type; some clients of real drones set it too.
            settings.push(Setting::DetectionsBottom(ROUNDEL_BIT));
            settings.push(Setting::DetectType(Detection::OrientedRoundel));
        }
        if let Some(kbit_s) = self.video_kbit_s {
            settings.push(Setting::VideoBitRateControl(BitRateControl::Manual));
            settings.push(Setting::VideoBitRateKbitS(kbit_s));
        }
        if let Some(ultrasound) = self.ultrasound {
            settings.push(Setting::SlowUltrasound(ultrasound == Ultrasound::Slow));
        }
        settings.iter().map(Setting::config).collect()
    }
}

impl Default for VehicleConfig {
    fn default() -> Self {
        let cascade = CascadeConfig::default();
        let speed_max_m_s = cascade.speed_max_m_s;
        Self {
            name: VehicleName::default(),
            system: 1,
            limits: FlightLimits { speed_max_m_s, ..FlightLimits::default() },
            separation_m: 1.5,
            peers: Vec::new(),
            read_back: true,
            navdata: NavdataRate::default(),
            gps: false,
            video_kbit_s: None,
            ultrasound: None,
            station: StationPatience::default(),
            estimator: EstimatorConfig::default(),
            cascade,
        }
    }
}

/// Our own configuration on the drone: any numbers but zero.
const IDENTITY: Identity =
    Identity { session: 0x0a0d_0001, user: 0x0a0d_0002, application: 0x0a0d_0003 };
/// Longest wait for the first navdata.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(5);
/// Longest wait for the drone to acknowledge its configuration.
const CONFIGURE_TIMEOUT: Duration = Duration::from_secs(25);
/// Longest wait for other vehicles to be heard, and to leave the place, before a flight that was ordered is refused.
const ROOM_TIMEOUT: Duration = Duration::from_secs(30);
/// Wait after flat trim, for the drone to apply it; navdata are monitored meanwhile.
const SETTLE_TIME: Duration = Duration::from_millis(500);
/// After this time a landing is no longer awaited, and the flight ends without one.
const LANDING_TIMEOUT: Duration = Duration::from_secs(30);
/// Likewise for a landing on a tag, which may begin with a search of 30 s and settling above the tag for 20 s.
const TAG_LANDING_TIMEOUT: Duration = Duration::from_secs(90);
/// After a link loss, landing is ordered without navdata for this time.
const BLIND_LANDING_TIME: Duration = Duration::from_secs(4);
/// Event queue capacity; preallocated, because a tick must not allocate.
const EVENTS: usize = 64;
/// A fault bit that stays set for this long ends the flight.
const FAULT_TIME: Duration = Duration::from_millis(300);
/// A drone that has said for this long that it is on the ground is.
const ON_GROUND_TIME: Duration = Duration::from_millis(500);

/// Ticks between two readiness checks.
const READINESS_TICKS: u32 = 10;

/// The black and white oriented roundel in the selection of the bottom camera.
const ROUNDEL_BIT: u32 = 1 << 7;

/// State machine that flies one drone.
#[derive(Debug)]
pub struct Vehicle {
    config: VehicleConfig,
    session: Session,
    settings: Vec<Config>,
    configured: Configured,
    controls: Controls,
    mission: Mission,
    life: Life,
    flight: Flight,
    navdata: Option<Navdata>,
    /// The flight recorder's last position, and when it arrived.
    gps: Option<(Duration, GpsFix)>,
    last_tick: Option<Duration>,
    /// Navdata packets per second, low-pass filtered.
    navdata_hz: f64,
    /// Arrival of the newest packet, and of the newest one from a drone that is not on the ground.
    packet_at: Option<Duration>,
    off_ground_at: Option<Duration>,
    /// Reasons not to take off, and the ticks until they are checked again.
    readiness: Arc<[NotReady]>,
    /// The only one in flight.
    in_flight: Arc<[NotReady]>,
    readiness_in: u32,
    events: VecDeque<FlightEvent>,
    /// Decision of the last tick; `None` before the first navdata.
    decision: Option<Decision>,
    /// The camera that was ordered last.
    camera: Option<Camera>,
    /// The other vehicles in the room.
    neighbours: Neighbours,
    pending: Pending,
    /// Ends of earlier flights that nobody was told of yet: orders may end a flight and begin the next before a tick.
    untold: VecDeque<(Outcome, Arc<FlightReport>)>,
}

/// Why a vehicle cannot fly a plan.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CannotFly {
    /// See [`VehicleConfig::drone_settings`].
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// The plan was refused.
    #[error("the plan cannot be flown: {0}")]
    Refused(#[from] Refused),
}

/// Settings that the drone has not applied.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
struct Configured {
    /// Keys that were not acknowledged, or read back with another value.
    unconfirmed: Vec<String>,
    /// The configuration could not be read back.
    not_read: bool,
    /// It does not look for tags.
    no_detection: bool,
    /// The drone has not confirmed the video's bit rate.
    no_video_rate: bool,
}

impl Vehicle {
    /// A vehicle without a mission that has not received navdata yet.
    ///
    /// # Errors
    /// As [`VehicleConfig::drone_settings`].
    pub fn new(config: &VehicleConfig) -> Result<Self, SettingError> {
        let settings = config.drone_settings()?;
        let session_config = SessionConfig {
            settings: settings.clone(),
            // Only a configuration of one's own has a bit rate that can be set. Without need the drone's own is used, as ever.
            identity: config.video_kbit_s.map(|_| IDENTITY),
            read_back: config.read_back,
            // The agent gives up a take-off after its own time limit.
            take_off_timeout: Duration::MAX,
            ..SessionConfig::default()
        };
        Ok(Self {
            config: config.clone(),
            session: Session::new(session_config),
            settings,
            configured: Configured::default(),
            controls: Controls::default(),
            mission: Mission::new(config.limits),
            life: Life::BEGINNING,
            flight: Flight::new(config, Duration::ZERO),
            navdata: None,
            gps: None,
            last_tick: None,
            navdata_hz: 0.0,
            packet_at: None,
            off_ground_at: None,
            readiness: Arc::new([]),
            in_flight: Arc::new([NotReady::InFlight]),
            readiness_in: 0,
            events: VecDeque::with_capacity(EVENTS),
            decision: None,
            camera: None,
            neighbours: Neighbours::default(),
            pending: Pending::default(),
            untold: VecDeque::new(),
        })
    }

    /// A vehicle that flies `plan` as soon as the drone is ready, ordered by the terminal's operator.
    ///
    /// # Errors
    /// [`CannotFly`] if the limits cannot be encoded, or the plan does not fit the configuration.
    pub fn flying(plan: Plan, config: &VehicleConfig) -> Result<Self, CannotFly> {
        let mut vehicle = Self::new(config)?;
        for order in [OperatorOrder::Load(plan), OperatorOrder::Start { when_ready: true }] {
            vehicle.order(Duration::ZERO, Operator::TERMINAL, order)?;
        }
        Ok(vehicle)
    }

    /// Resets the state of the last flight.
    fn begin_flight(&mut self, now: Duration) {
        let untold = self.end_to_tell();
        self.untold.extend(untold);
        self.start_here(now);
        self.flight = Flight::new(&self.with_mission_tags(), now);
        self.expect_link_delay();
        self.pending.waypoints = 0;
        self.mission.rewind();
        self.mission_changed();
    }

    /// Tells the estimator how long the drone took to answer its settings. An answer waits for the next packet, for half an
    /// interval on average; the shortest of them hardly less, because each setting is sent just after a packet.
    fn expect_link_delay(&mut self) {
        if let Some(round_trip) = self.session.round_trip() {
            let interval =
                Duration::from_secs_f64(self.navdata_hz.max(readiness::LEAST_NAVDATA_HZ).recip());
            self.flight.estimator.expect_link_delay(round_trip.saturating_sub(interval / 2));
        }
    }

    /// Reserves room for all steps in the report, because a tick must not allocate. What comes after the landing is for the next
    /// flight, and this one's report stays what it is.
    fn mission_changed(&mut self) {
        self.pending.mission = true;
        if self.flight.outcome.is_some() || self.lands() {
            self.flight.mission_is_for_next = true;
            return;
        }
        let steps = self.mission.steps().len();
        let report = self.flight.report_mut();
        report.steps = steps;
        // Those of a mission that was replaced in flight stay.
        report.waypoints.reserve(steps);
    }

    /// The drone is monitored from now on.
    fn watched_from(&self, now: Duration) -> Watched {
        Watched { since: now, received: self.session.statistics().received }
    }

    /// Its name.
    pub fn name(&self) -> VehicleName {
        self.config.name
    }

    /// Decision of the last tick; `None` before the first navdata.
    pub fn decision(&self) -> Option<&Decision> {
        self.decision.as_ref()
    }

    /// How the last flight ended; `None` until then, and again once the next flight is ordered.
    pub fn outcome(&self) -> Option<&Outcome> {
        self.flight.outcome.as_ref()
    }

    /// Whether the program may exit: the vehicle neither flies nor lands, and no flight is about to begin.
    pub fn is_at_rest(&self) -> bool {
        !self.life.is_in_flight() && self.life.departure().is_none()
    }

    /// Reasons why the vehicle cannot take off with a short mission, by the last check, which every tenth tick makes; empty if
    /// it can, and before the first tick.
    pub fn readiness(&self) -> &[NotReady] {
        &self.readiness
    }

    /// How many steps of the mission are done; `None` if it is for the next flight.
    fn steps_done(&self) -> Option<usize> {
        (!self.flight.mission_is_for_next).then_some(self.flight.report().steps_done)
    }

    /// The mission's steps.
    pub fn mission(&self) -> &[Step] {
        self.mission.steps()
    }

    /// Report of the current or last flight.
    pub fn report(&self) -> &FlightReport {
        self.flight.report()
    }

    /// A snapshot for displays.
    pub fn status(&self, now: Duration) -> Status {
        // The last tick has already predicted the state for this moment.
        let pose = match &self.decision {
            Some(decision) => pose(&decision.state),
            None => self.pose(now),
        };
        let tags = self.flight.estimator.tag_status(now);
        Status {
            phase: self.life.phase(),
            landing: self.life.landing_reason(),
            emergency: self.drone_state().contains(DroneState::EMERGENCY),
            airborne: self.navdata.is_some() && !self.on_ground(),
            flight_time: self.flight.report().flight_time_at(now),
            camera: self.camera,
            step: self.life.due().map(|active| active.due.step),
            steps: self.mission.steps().len(),
            steps_done: self.steps_done(),
            mission_waits: self.life.manual().pauses_mission(),
            manual: self.life.manual().control(now),
            controls: self.controls.holder(),
            pose: self.session.silence(now).map(|_| pose),
            velocity_m_s: self
                .session
                .silence(now)
                .and(self.decision.as_ref().map(|decision| decision.state.velocity_m_s.into())),
            turn_rate_deg_s: self
                .session
                .silence(now)
                .map(|_| self.flight.estimator.turn_rate_deg_s(now)),
            target: self.flight.target,
            distance_m: self.flight.target.map(|target| distance(&pose, &target)),
            battery_percent: self.demo().map(|demo| demo.battery_percent),
            battery_v: self.battery_v(),
            uncertainty_m: self.flight.estimator.uncertainty_m(now),
            height_uncertainty_m: self.flight.estimator.height_uncertainty_m(now),
            rests_on: RestsOn::of(tags.as_ref()),
            contradicted_by: self.flight.cross_checks.contradicts(),
            tags,
            gps: self.gps(now),
            trust: self.flight.estimator.trust(),
            airframe: *self.flight.estimator.airframe(),
            navdata_age: self.session.silence(now),
            navdata_hz: self.navdata_hz,
            altitude_m: self.demo().map(|demo| demo.altitude_m),
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

    /// Whether the drone has said without a break for [`ON_GROUND_TIME`] that it is on the ground: a single packet may be
    /// damaged, and whoever is let go of in the air falls.
    fn on_ground(&self) -> bool {
        let lasts = match (self.packet_at, self.off_ground_at) {
            (Some(now), Some(off)) => now.saturating_sub(off) >= ON_GROUND_TIME,
            _ => true,
        };
        lasts && self.says_on_ground()
    }

    fn says_on_ground(&self) -> bool {
        let state = self.drone_state();
        match self.demo() {
            Some(demo) => {
                let landed = demo.control_state == ControlState::Landed;
                let airborne = is_airborne(state, demo.control_state);
                !airborne && (landed || state.contains(DroneState::EMERGENCY))
            }
            None => !state.contains(DroneState::FLYING),
        }
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

#[cfg(test)]
mod tests;
