//! The drone's firmware as the network sees it: its state, and the effect of AT commands.

use std::time::Duration;

use ardrone_link::at::{Command, ControlMode, Motion, Ref, decode};
use ardrone_link::navdata::{ControlState, DroneState};
use nalgebra::Vector2;

use crate::airframe::{Airframe, Attitude, Profile, STEP_S, Scaling, Thrust, body_from_world};
use crate::camera::Detector;
use crate::configuration::ConfigurationStore;
use crate::lies::Lies;

/// Time for which the motors run before the drone climbs.
const SPIN_UP: Duration = Duration::from_millis(900);
const TAKE_OFF_HEIGHT_M: f64 = 0.85;
const TAKE_OFF_CLIMB_M_S: f64 = 0.55;
/// Distance from the hover height at which the take-off is complete.
const TAKE_OFF_TOLERANCE_M: f64 = 0.06;
const LANDING_SPEED_M_S: f64 = 0.4;
const TOUCH_DOWN_SPEED_M_S: f64 = 0.25;
const TOUCH_DOWN_HEIGHT_M: f64 = 0.4;
const ALTITUDE_GAIN_1_S: f64 = 1.2;
/// A gaz demand below this holds the altitude.
const GAZ_DEAD_ZONE: f64 = 0.005;
/// Silence after which the watchdog bit is set.
const WATCHDOG: Duration = Duration::from_millis(50);
/// Silence after which the link counts as lost, and sequence numbers start again.
const LINK_LOSS: Duration = Duration::from_secs(2);
/// Time for which the drone hovers after a lost link before it lands.
const LINK_LOSS_HOVER: Duration = Duration::from_secs(2);
/// Duration of a full charge in level hover.
const BATTERY_LIFE_S: f64 = 720.0;
const BATTERY_REFUSES_TAKE_OFF_PERCENT: f64 = 20.0;
const BATTERY_LOW_PERCENT: f64 = 10.0;
const BATTERY_LANDS_PERCENT: f64 = 8.0;

/// Phase of the flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// On the ground, motors off.
    Landed,
    /// Spinning up, then climbing to the hover height.
    TakingOff {
        /// Time of the order.
        since: Duration,
    },
    /// In the air, following PCMD or holding position.
    Flying,
    /// Descending.
    Landing,
    /// Motors cut until the emergency is cleared.
    Emergency,
}

/// The key of the camera that the video shows, and its values.
const VIDEO_CHANNEL: &str = "video:video_channel";
const FRONT: &str = "0";
const BOTTOM: &str = "1";
const NEXT_CAMERA: &str = "4";

/// The firmware of one drone.
#[derive(Debug, Clone)]
#[expect(clippy::struct_excessive_bools, reason = "they are bits of the drone's state word")]
pub struct Firmware {
    profile: Profile,
    lies: Lies,
    phase: Phase,
    configuration: ConfigurationStore,
    bootstrapping: bool,
    acknowledge: bool,
    watchdog: bool,
    last_sequence: Option<u32>,
    last_command: Option<Duration>,
    /// How often the level reference was set in flight, which spoils it.
    trims_in_flight: u32,
    emergency_bit: bool,
    user_emergency: bool,
    cutout: bool,
    motion: DelayedMotion,
    hold: Hold,
    charge_percent: f64,
    battery: Load,
    dump_requested: Option<Dump>,
}

/// Load of the motors on the battery, and its effect on the measured charge.
#[derive(Debug, Clone, Copy, Default)]
struct Load {
    /// Reduction of the measured charge at full load.
    sag_percent: f64,
    /// Fraction of full load, filtered by the battery.
    share: f64,
}

impl Load {
    /// Time constant of the battery's response to its load.
    const TIME_CONSTANT_S: f64 = 0.5;

    fn step(&mut self, share: f64) {
        self.share += (share - self.share) * (STEP_S / Self::TIME_CONSTANT_S);
    }
}

/// A PCMD on its way to the motors.
#[derive(Debug, Clone, Default)]
struct DelayedMotion {
    waiting: std::collections::VecDeque<(Duration, Motion)>,
    active: Motion,
}

impl DelayedMotion {
    fn at(&mut self, now: Duration) -> Motion {
        while let Some((due, motion)) = self.waiting.front().copied()
            && due <= now
        {
            self.active = motion;
            self.waiting.pop_front();
        }
        self.active
    }

    fn clear(&mut self) {
        *self = Self::default();
    }
}

/// Requests on the control port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Dump {
    Configuration,
    Identities,
}

/// Position and height that the drone holds autonomously.
#[derive(Debug, Clone, Copy, Default)]
struct Hold {
    place_m: Option<Vector2<f64>>,
    height_m: Option<f64>,
}

impl Firmware {
    /// A drone of this profile after its start, with this charge.
    pub fn new(profile: Profile, battery_percent: f64) -> Self {
        Self {
            profile,
            lies: Lies::default(),
            phase: Phase::Landed,
            configuration: ConfigurationStore::default(),
            bootstrapping: true,
            acknowledge: false,
            watchdog: false,
            last_sequence: None,
            last_command: None,
            trims_in_flight: 0,
            emergency_bit: false,
            user_emergency: false,
            cutout: false,
            motion: DelayedMotion::default(),
            hold: Hold::default(),
            charge_percent: battery_percent,
            battery: Load::default(),
            dump_requested: None,
        }
    }

    /// A drone of this profile that another pilot has configured and flown to a height, and whose commands
    /// have just ended.
    pub fn in_flight(profile: Profile, battery_percent: f64, height_m: f64) -> Self {
        let mut configuration = ConfigurationStore::default();
        configuration.set("general:navdata_demo", "TRUE");
        Self {
            phase: Phase::Flying,
            configuration,
            bootstrapping: false,
            last_command: Some(Duration::ZERO),
            hold: Hold { place_m: None, height_m: Some(height_m) },
            ..Self::new(profile, battery_percent)
        }
    }

    /// The same drone with a firmware that is not as it is assumed to be.
    #[must_use]
    pub fn lying(self, lies: Lies) -> Self {
        Self { lies, ..self }
    }

    /// The same drone after a power cycle: only its battery charge remains.
    #[must_use]
    pub fn restarted(&self) -> Self {
        Self {
            battery: self.battery,
            lies: self.lies,
            ..Self::new(self.profile, self.charge_percent)
        }
    }

    /// Processes a datagram of the AT port. Returns the errors of invalid commands; the others take effect.
    pub fn handle_at(
        &mut self,
        now: Duration,
        datagram: &[u8],
    ) -> Vec<ardrone_link::at::DecodeError> {
        let mut errors = Vec::new();
        for command in decode(datagram) {
            match command {
                Ok((sequence, command)) => self.command(now, sequence, command),
                Err(error) => errors.push(error),
            }
        }
        errors
    }

    fn command(&mut self, now: Duration, sequence: u32, command: Command) {
        // Sequence number 1 restarts the count, and so does a silence that lost the link.
        let silent = self.silence(now).is_none_or(|silence| silence >= LINK_LOSS);
        let restarts = sequence == 1 && !self.lies.contains(Lies::IGNORES_NUMBER_ONE);
        let old = self.lies.contains(Lies::OBEYS_OLD_NUMBERS) && sequence != 1;
        let fresh =
            restarts || silent || old || self.last_sequence.is_none_or(|last| sequence > last);
        if !fresh {
            return;
        }
        self.last_sequence = Some(sequence);
        self.last_command = Some(now);
        match command {
            Command::Ref(reference) => self.reference(now, reference),
            // The client's compass is not modelled.
            Command::Pcmd(motion) | Command::PcmdMagneto { motion, .. } => {
                self.motion.waiting.push_back((now + self.profile.dead_time, motion));
            }
            Command::Config(config) => {
                self.acknowledge = !self.lies.contains(Lies::NO_ACKNOWLEDGEMENT);
                if config.key() == "general:navdata_demo" {
                    self.bootstrapping = false;
                }
                let is_next = config.key() == VIDEO_CHANNEL && config.value() == NEXT_CAMERA;
                let is_bottom = self.configuration.text(VIDEO_CHANNEL) == Some(BOTTOM);
                let value = match (is_next, is_bottom) {
                    (false, _) => config.value(),
                    (true, true) => FRONT,
                    (true, false) => BOTTOM,
                };
                self.store(config.key(), value);
            }
            Command::Control(ControlMode::ClearAcknowledge) => {
                self.acknowledge &= self.lies.contains(Lies::STUCK_ACKNOWLEDGEMENT);
            }
            Command::Control(ControlMode::SendConfiguration) => {
                self.dump_requested = Some(Dump::Configuration);
            }
            Command::Control(ControlMode::SendCustomConfigurations) => {
                self.dump_requested = Some(Dump::Identities);
            }
            Command::CommunicationWatchdog => {
                self.watchdog &= self.lies.contains(Lies::STUCK_WATCHDOG);
            }
            // Only the place where the level reference is set matters; its value is not modelled.
            Command::FlatTrim => {
                let grounded = matches!(self.phase, Phase::Landed | Phase::Emergency);
                self.trims_in_flight += u32::from(!grounded);
            }
            // Identities are not modelled; the rest has no effect on flight.
            Command::CalibrateMagneto
            | Command::ConfigIds(_)
            | Command::Control(ControlMode::Other(_))
            | Command::Led { .. }
            | Command::Animation { .. }
            | Command::Pmode(_)
            | Command::Misc(_)
            | Command::ManualTrim { .. }
            | Command::Other { .. } => {}
        }
    }

    /// Sets a key.
    fn store(&mut self, key: &str, value: &str) {
        match key {
            "control:altitude_max" if self.lies.contains(Lies::FIXED_CEILING) => {}
            "control:euler_angle_max" if self.lies.contains(Lies::TILT_IN_DEGREES) => {
                let degrees = value.parse().map(f64::to_degrees).unwrap_or_default();
                self.configuration.set(key, &degrees.to_string());
            }
            _ => self.configuration.set(key, value),
        }
    }

    fn reference(&mut self, now: Duration, reference: Ref) {
        let emergency = reference == Ref::ToggleEmergency;
        let rising = emergency && !self.emergency_bit;
        self.emergency_bit = emergency;
        if rising {
            self.user_emergency = self.phase != Phase::Emergency;
            self.cutout = false;
            self.phase = match self.phase {
                Phase::Emergency => Phase::Landed,
                _ => Phase::Emergency,
            };
            return;
        }
        match (reference, self.phase) {
            (Ref::TakeOff, Phase::Landed)
                if self.battery_percent() > BATTERY_REFUSES_TAKE_OFF_PERCENT =>
            {
                self.phase = Phase::TakingOff { since: now };
                self.motion.clear();
                self.hold = Hold::default();
            }
            (Ref::Land, Phase::TakingOff { .. } | Phase::Flying) => self.start_landing(),
            _ => {}
        }
    }

    fn start_landing(&mut self) {
        self.phase = Phase::Landing;
        self.hold = Hold::default();
    }

    /// One physics step of [`STEP_S`]. Returns the command to the motors.
    pub fn step(&mut self, now: Duration, airframe: &Airframe) -> Thrust {
        let silence = self.silence(now);
        if silence.is_some_and(|silence| silence >= WATCHDOG) {
            self.watchdog = !self.lies.contains(Lies::NO_WATCHDOG);
        }
        let lost_for = silence.and_then(|silence| silence.checked_sub(self.patience()));
        self.drain_battery(airframe);
        self.change_phase(now, lost_for, airframe);
        let motion = self.motion.at(now);
        match self.phase {
            Phase::Landed | Phase::Emergency => Thrust::Off,
            Phase::TakingOff { since } if now.saturating_sub(since) < SPIN_UP => {
                Thrust::On(Attitude::default())
            }
            Phase::TakingOff { .. } => {
                let climb = ALTITUDE_GAIN_1_S * (TAKE_OFF_HEIGHT_M - airframe.position_m().z);
                let climb_m_s = climb.clamp(0.0, TAKE_OFF_CLIMB_M_S);
                Thrust::On(Attitude { climb_m_s, ..self.hover(airframe) })
            }
            Phase::Flying => {
                let motion = if lost_for.is_some() { Motion::Hover } else { motion };
                Thrust::On(self.fly(motion, airframe))
            }
            Phase::Landing => {
                let near_ground = airframe.position_m().z < TOUCH_DOWN_HEIGHT_M;
                let speed = if near_ground { TOUCH_DOWN_SPEED_M_S } else { LANDING_SPEED_M_S };
                Thrust::On(Attitude { climb_m_s: -speed, ..self.hover(airframe) })
            }
        }
    }

    fn change_phase(&mut self, now: Duration, lost_for: Option<Duration>, airframe: &Airframe) {
        let height_m = airframe.position_m().z;
        match self.phase {
            Phase::TakingOff { since } => {
                let climbing = now.saturating_sub(since) >= SPIN_UP;
                if climbing && height_m > TAKE_OFF_HEIGHT_M - TAKE_OFF_TOLERANCE_M {
                    self.phase = Phase::Flying;
                    self.hold = Hold { height_m: Some(TAKE_OFF_HEIGHT_M), ..self.hold };
                }
            }
            Phase::Landing if height_m <= 0.0 => self.phase = Phase::Landed,
            _ => {}
        }
        let lost = lost_for.is_some_and(|lost_for| lost_for >= LINK_LOSS_HOVER);
        let empty = self.battery_percent() <= BATTERY_LANDS_PERCENT;
        if (lost || empty) && matches!(self.phase, Phase::Flying | Phase::TakingOff { .. }) {
            self.start_landing();
        }
    }

    fn drain_battery(&mut self, airframe: &Airframe) {
        /// Additional load of full tilt, relative to hovering.
        const TILT_SHARE: f64 = 0.6;
        if matches!(self.phase, Phase::Landed | Phase::Emergency) {
            self.battery.step(0.0);
            return;
        }
        let tilt = (airframe.pitch_rad().hypot(airframe.roll_rad()) / 0.2).min(1.0);
        let load = 1.0 + TILT_SHARE * tilt;
        let drain = 100.0 / BATTERY_LIFE_S * load * STEP_S;
        self.charge_percent = (self.charge_percent - drain).max(0.0);
        self.battery.step(load / (1.0 + TILT_SHARE));
    }

    fn fly(&mut self, motion: Motion, airframe: &Airframe) -> Attitude {
        let Motion::Progressive { roll, pitch, gaz, yaw } = motion else {
            let climb_m_s = self.hold_height(airframe);
            return Attitude { climb_m_s, ..self.hover(airframe) };
        };
        self.hold.place_m = None;
        let [roll, pitch, gaz, yaw] = [roll, pitch, gaz, yaw].map(|value| f64::from(value.get()));
        let Scaling { tilt, tilt_limit_rad, climb, drop, turn } = self.profile.scaling;
        let tilt_rad = self.configuration.number("control:euler_angle_max") * tilt;
        let climb_max_m_s = self.configuration.number("control:control_vz_max") / 1000.0;
        let ceiling_m = self.configuration.number("control:altitude_max") / 1000.0;
        let mut climb_m_s = if gaz.abs() < GAZ_DEAD_ZONE {
            self.hold_height(airframe)
        } else {
            self.hold.height_m = None;
            gaz * climb_max_m_s * if gaz > 0.0 { climb } else { drop }
        };
        if airframe.position_m().z >= ceiling_m {
            climb_m_s = climb_m_s.min(0.0);
        }
        Attitude {
            pitch_rad: (pitch * tilt_rad).clamp(-tilt_limit_rad, tilt_limit_rad),
            roll_rad: (roll * tilt_rad).clamp(-tilt_limit_rad, tilt_limit_rad),
            climb_m_s,
            turn_rad_s: yaw * self.configuration.number("control:control_yaw") * turn,
        }
    }

    /// Levels and holds the position where the drone came to rest.
    fn hover(&mut self, airframe: &Airframe) -> Attitude {
        const PLACE_GAIN: f64 = 0.06;
        const SPEED_GAIN: f64 = 0.16;
        const MAX_TILT_RAD: f64 = 0.2;
        const SLOW_M_S: f64 = 0.2;
        let velocity = airframe.body_velocity_m_s();
        if self.hold.place_m.is_none() && velocity.norm() < SLOW_M_S {
            self.hold.place_m = Some(airframe.position_m().xy());
        }
        let offset = self.hold.place_m.map_or(Vector2::zeros(), |place| {
            let error = place - airframe.position_m().xy();
            body_from_world(error.x, error.y, airframe.yaw_rad())
        });
        let tilt = offset * PLACE_GAIN - velocity * SPEED_GAIN;
        Attitude {
            roll_rad: tilt.x.clamp(-MAX_TILT_RAD, MAX_TILT_RAD),
            pitch_rad: (-tilt.y).clamp(-MAX_TILT_RAD, MAX_TILT_RAD),
            ..Attitude::default()
        }
    }

    fn hold_height(&mut self, airframe: &Airframe) -> f64 {
        let height_m = airframe.position_m().z;
        let held_m = *self.hold.height_m.get_or_insert(height_m);
        let limit_m_s = self.configuration.number("control:control_vz_max") / 1000.0;
        (ALTITUDE_GAIN_1_S * (held_m - height_m)).clamp(-limit_m_s, limit_m_s)
    }

    fn silence(&self, now: Duration) -> Option<Duration> {
        self.last_command.map(|last| now.saturating_sub(last))
    }

    /// Blocks a propeller: the firmware cuts all motors.
    pub fn block_propeller(&mut self) {
        self.user_emergency = false;
        self.cutout = true;
        self.phase = Phase::Emergency;
    }

    /// How often the level reference was set in flight.
    pub fn trims_in_flight(&self) -> u32 {
        self.trims_in_flight
    }

    /// Time of the last command that was taken; `None` before the first.
    pub fn last_command(&self) -> Option<Duration> {
        self.last_command
    }

    /// Motion command in effect.
    pub fn motion(&self) -> Motion {
        self.motion.active
    }

    /// Phase of the flight.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// Whether the client has been silent for long enough, 2 s, for the link to count as lost.
    pub fn link_is_lost(&self, now: Duration) -> bool {
        self.silence(now).is_some_and(|silence| silence >= self.patience())
    }

    /// Silence after which the link counts as lost.
    fn patience(&self) -> Duration {
        if self.lies.contains(Lies::PATIENT_LINK) { Duration::from_secs(10) } else { LINK_LOSS }
    }

    /// In which ways it is not as it is assumed to be.
    pub(crate) fn lies(&self) -> Lies {
        self.lies
    }

    /// Enters bootstrap mode: the drone has to be configured again.
    pub fn start_bootstrap(&mut self) {
        self.bootstrapping = true;
    }

    /// Whether only status packets are sent.
    pub fn is_bootstrapping(&self) -> bool {
        self.bootstrapping
    }

    /// Whether only the demo set of options is sent.
    pub fn is_demo(&self) -> bool {
        self.configuration.is_set("general:navdata_demo")
    }

    /// Whether option `tag` is requested in demo mode; one above 31 cannot be.
    pub fn wants_option(&self, tag: u16) -> bool {
        if self.lies.contains(Lies::FIXED_OPTIONS) {
            return matches!(tag, 0 | 16);
        }
        let mask = self.configuration.text("general:navdata_options");
        let mask = mask.and_then(|mask| mask.parse::<u32>().ok()).unwrap_or(0);
        mask.checked_shr(tag.into()).is_some_and(|rest| rest & 1 == 1)
    }

    /// Whether the video shows the bottom camera.
    #[cfg(feature = "video")]
    pub(crate) fn shows_bottom(&self) -> bool {
        self.configuration.text(VIDEO_CHANNEL) == Some(BOTTOM)
    }

    /// Whether the motors are on.
    pub(crate) fn turns_rotors(&self) -> bool {
        matches!(self.phase, Phase::TakingOff { .. } | Phase::Flying | Phase::Landing)
    }

    /// The number of the ultrasound's frequency, 7 or 8.
    pub(crate) fn ultrasound(&self) -> i64 {
        let number = self.configuration.text("pic:ultrasound_freq");
        number.and_then(|number| number.parse().ok()).unwrap_or_default()
    }

    /// Bit rate of the video.
    #[cfg(feature = "video")]
    pub(crate) fn video_kbit_s(&self) -> u32 {
        self.configuration.video_kbit_s()
    }

    /// The tag detector, if the configuration enables it.
    pub(crate) fn detector(&self) -> Option<Detector> {
        /// The black and white oriented roundel, as a kind and as a selection bit.
        const ROUNDEL: u32 = 8;
        let selected = |key| {
            let bits = self.configuration.text(key).and_then(|bits| bits.parse::<u32>().ok());
            bits.is_some_and(|bits| bits >> (ROUNDEL - 1) & 1 == 1)
        };
        let source = match self.configuration.text("detect:detect_type") {
            Some("12") => 1,
            Some("10") if selected("detect:detections_select_v") => 1,
            Some("10") if selected("detect:detections_select_v_hsync") => 2,
            _ => return None,
        };
        (!self.bootstrapping).then_some(Detector { source, kind: ROUNDEL })
    }

    /// Sets the charge.
    pub fn set_battery_percent(&mut self, percent: f64) {
        self.charge_percent = percent.clamp(0.0, 100.0);
    }

    /// Sets the reduction of the measured charge at full load.
    pub fn set_battery_sag_percent(&mut self, percent: f64) {
        self.battery.sag_percent = percent.clamp(0.0, 100.0);
    }

    /// Remaining charge as measured by voltage, which sags under load.
    pub fn battery_percent(&self) -> f64 {
        (self.charge_percent - self.battery.sag_percent * self.battery.share).max(0.0)
    }

    /// Remaining charge without any load.
    pub fn charge_percent(&self) -> f64 {
        self.charge_percent
    }

    /// The state word for navdata.
    pub fn state(&self, now: Duration) -> DroneState {
        let mut state = DroneState::ALTITUDE_CONTROL
            | DroneState::CAMERA_READY
            | DroneState::PIC_VERSION_OK
            | DroneState::AT_THREAD
            | DroneState::NAVDATA_THREAD
            | DroneState::VIDEO_THREAD
            | DroneState::ACQUISITION_THREAD;
        let airborne =
            matches!(self.phase, Phase::TakingOff { .. } | Phase::Flying | Phase::Landing);
        for (condition, bit) in [
            (airborne || self.lies.contains(Lies::CLAIMS_TO_FLY), DroneState::FLYING),
            (self.acknowledge, DroneState::COMMAND_ACKNOWLEDGE),
            (self.bootstrapping, DroneState::NAVDATA_BOOTSTRAP),
            (self.is_demo(), DroneState::NAVDATA_DEMO),
            (self.watchdog, DroneState::COMMUNICATION_WATCHDOG),
            (self.link_is_lost(now), DroneState::COMMUNICATION_LOST),
            (self.battery_percent() <= BATTERY_LOW_PERCENT, DroneState::BATTERY_LOW),
            (self.phase == Phase::Emergency, DroneState::EMERGENCY),
            (self.cutout, DroneState::CUTOUT_DETECTED),
            (self.user_emergency && self.phase == Phase::Emergency, DroneState::USER_EMERGENCY),
        ] {
            state.set(bit, condition);
        }
        state
    }

    /// The control state for navdata.
    pub fn control_state(&self) -> ControlState {
        match self.phase {
            Phase::Landed if self.lies.contains(Lies::CLAIMS_TO_HOVER) => ControlState::Hovering,
            Phase::Landed => ControlState::Landed,
            Phase::TakingOff { .. } => ControlState::TakingOff,
            Phase::Flying if self.motion.active == Motion::Hover => ControlState::Hovering,
            Phase::Flying => ControlState::Flying,
            Phase::Landing => ControlState::Landing,
            Phase::Emergency => ControlState::Default,
        }
    }

    /// The reply for the control port, if one was requested since the last call.
    pub fn take_dump(&mut self) -> Option<String> {
        match self.dump_requested.take()? {
            Dump::Configuration => self.lies.spoil_configuration(self.configuration.dump()),
            Dump::Identities => Some(self.configuration.identities()),
        }
    }
}
