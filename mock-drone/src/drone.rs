//! A complete drone: firmware, airframe and sensors, fed with time and bytes.

use std::collections::VecDeque;
use std::time::Duration;

use ardrone_link::at::{DecodeError, Motion};
use ardrone_link::navdata::{DroneState, NavdataError, PacketWriter};
use bytes::{Bytes, BytesMut};
use nalgebra::{Vector2, Vector3};
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, Uniform};

use crate::air::{Others, Presence};
use crate::airframe::{Airframe, Profile, STEP_S};
use crate::camera::{Camera, CameraModel, FloorTag};
use crate::faults::{Quantity, Reported, SensorFault, SensorFaults};
use crate::firmware::{Firmware, Phase};
use crate::gauss_markov::GaussMarkov;
use crate::lies::Lies;
use crate::sensors::{SensorModel, Sensors};
use crate::telemetry::{Tag27, Telemetry};
use crate::wind::Wind;

/// Configuration of a [`Drone`].
#[derive(Debug, Clone, PartialEq)]
pub struct DroneConfig {
    /// Model of its motion.
    pub profile: Profile,
    /// Noise and delays of its sensors.
    pub sensors: SensorModel,
    /// Its bottom camera, which detects tags if the configuration enables it.
    pub camera: CameraModel,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Initial charge.
    pub battery_percent: f64,
    /// Reduction of the measured charge at full load.
    pub battery_sag_percent: f64,
    /// The drone starts in flight at this height in metres, as left by another pilot: it hovers autonomously,
    /// and lands when it receives nothing.
    pub flies_at_m: Option<f64>,
    /// Wind towards (right, forward).
    pub wind_m_s: Vector2<f64>,
    /// Standard deviation of the gusts on each axis.
    pub gusts_m_s: f64,
    /// Content of option 27.
    pub tag_27: Tag27,
    /// Standard deviation of its GPS on each axis. The error stays for about a minute.
    pub gps_error_m: f64,
    /// Maximum error of the level reference in roll and in pitch, unknown to the pilot.
    pub trim_error_deg: f64,
    /// In which ways its firmware is not as it is assumed to be.
    pub lies: Lies,
}

impl Default for DroneConfig {
    fn default() -> Self {
        Self {
            profile: Profile::rec(),
            sensors: SensorModel::nominal(),
            camera: CameraModel::nominal(),
            seed: 1,
            battery_percent: 90.0,
            battery_sag_percent: 0.0,
            flies_at_m: None,
            wind_m_s: Vector2::zeros(),
            gusts_m_s: 0.0,
            tag_27: Tag27::Absent,
            gps_error_m: 0.0,
            trim_error_deg: 0.3,
            lies: Lies::default(),
        }
    }
}

/// The true state, which only the simulation knows.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Truth {
    /// Time since the start of the simulation, up to which the drone is simulated; a restart does not reset it.
    pub time: Duration,
    /// When it was last switched on; zero at the start.
    pub switched_on: Duration,
    /// Right, forward, up from the start.
    pub position_m: Vector3<f64>,
    /// Right, forward, up.
    pub velocity_m_s: Vector3<f64>,
    /// Clockwise from the initial heading, not wrapped.
    pub yaw_deg: f64,
    /// Phase of the firmware.
    pub phase: Phase,
    /// Velocity of the healthy sensors, integrated without delay: the frame of a client that only receives
    /// navdata. Injected sensor faults are excluded. (right, forward)
    pub odometry_m: Vector2<f64>,
    /// Motion command that the firmware executes in flight.
    pub motion: Motion,
    /// When the firmware last took a command; `None` if it has taken none since it was switched on.
    pub heard_at: Option<Duration>,
    /// How often the level reference was set in flight, which spoils it.
    pub trims_in_flight: u32,
    /// Remaining charge as measured by voltage.
    pub battery_percent: f64,
    /// Number of contacts with the floor during flight.
    pub floor_contacts: u32,
    /// Sink rate at the last contact with the floor, in any phase; `None` before the first.
    pub touch_down_m_s: Option<f64>,
}

impl Truth {
    /// Drift of the drone's own velocity. (right, forward)
    pub fn drift_m(&self) -> Vector2<f64> {
        self.odometry_m - self.position_m.xy()
    }
}

/// Reported firmware states for a time, independent of the real state.
#[derive(Debug, Clone, Default)]
struct Claims {
    /// State bits, with the end of each.
    bits: Vec<(DroneState, Duration)>,
    /// Details of the control state, with the end of each; the last one counts.
    minor: Vec<(u16, Duration)>,
}

impl Claims {
    fn settle(&mut self, now: Duration) {
        self.bits.retain(|(_, ends)| *ends > now);
        self.minor.retain(|(_, ends)| *ends > now);
    }

    fn state(&self) -> DroneState {
        self.bits.iter().map(|(bits, _)| *bits).collect()
    }

    fn minor(&self) -> u16 {
        self.minor.last().map_or(0, |(minor, _)| *minor)
    }
}

/// A simulated drone.
///
/// The caller advances it with [`Drone::advance`], passes it datagrams with [`Drone::handle_at`] and
/// [`Drone::handle_wake_up`], and forwards the results of [`Drone::poll_navdata`] and
/// [`Drone::poll_control`].
#[derive(Debug, Clone)]
pub struct Drone {
    config: DroneConfig,
    wind: Wind,
    others: Others,
    gps_error_m: GaussMarkov,
    /// When it was switched on.
    switched_on: Duration,
    faults: SensorFaults,
    claims: Claims,
    /// Number of contacts with the floor during flight.
    floor_contacts: u32,
    firmware: Firmware,
    airframe: Airframe,
    sensors: Sensors,
    camera: Camera,
    /// Tags on the floor, relative to the start.
    tags: Vec<FloorTag>,
    steps: u64,
    sequence: u32,
    listener: bool,
    next_navdata: Duration,
    outgoing: VecDeque<Bytes>,
}

/// How long an error of the GPS stays: its satellites and reflections change slowly.
const GPS_ERROR_TIME_S: f64 = 60.0;
const STEP: Duration = Duration::from_micros(2500);
/// Pictures per number of steps: 30 per second.
const PICTURES: (u64, u64) = (3, 40);
const DEMO_PERIOD: Duration = Duration::from_micros(66_667);
const FULL_PERIOD: Duration = Duration::from_millis(5);
/// Large enough for a full packet.
const PACKET_BYTES: usize = 2304;
/// Reading of the drone's clock when the simulation starts.
const CLOCK_AT_START: Duration = Duration::from_millis(31_400);
/// Time without communication after a restart. The real drone takes longer; the shorter time is harder for
/// the pilot to notice.
const BOOT_TIME: Duration = Duration::from_secs(1);

impl Drone {
    /// A drone in its initial state, on the ground unless its configuration says otherwise.
    pub fn new(config: &DroneConfig) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(config.seed ^ 0x7472_696d);
        let trim_rad = Uniform::new_inclusive(-1.0, 1.0).map_or(Vector2::zeros(), |unit| {
            Vector2::new(unit.sample(&mut random), unit.sample(&mut random))
                * config.trim_error_deg.to_radians()
        });
        debug_assert!((STEP.as_secs_f64() - STEP_S).abs() < 1e-12);
        let mut firmware = match config.flies_at_m {
            Some(height_m) => Firmware::in_flight(config.profile, config.battery_percent, height_m),
            None => Firmware::new(config.profile, config.battery_percent),
        };
        firmware.set_battery_sag_percent(config.battery_sag_percent);
        let firmware = firmware.lying(config.lies);
        let airframe = Airframe::new(config.profile, trim_rad);
        let sensors = Sensors::new(config.sensors, config.seed);
        let (airframe, sensors) = match config.flies_at_m {
            Some(height_m) => {
                let airframe = airframe.at_height(height_m);
                let sensors = sensors.settled(&airframe);
                (airframe, sensors)
            }
            None => (airframe, sensors),
        };
        Self {
            config: config.clone(),
            wind: Wind::new(config.wind_m_s, config.gusts_m_s, config.seed),
            others: Others::new(config.seed),
            gps_error_m: GaussMarkov::settled(
                config.gps_error_m,
                GPS_ERROR_TIME_S,
                ChaCha8Rng::seed_from_u64(config.seed ^ 0x6770_7320),
            ),
            switched_on: Duration::ZERO,
            faults: SensorFaults::new(config.seed),
            claims: Claims::default(),
            floor_contacts: 0,
            firmware,
            airframe,
            sensors,
            camera: Camera::new(config.camera, config.seed),
            tags: Vec::new(),
            steps: 0,
            sequence: 0,
            listener: false,
            next_navdata: Duration::ZERO,
            outgoing: VecDeque::new(),
        }
    }

    /// Advances to `now`, the time since the start of the simulation, by whole steps of [`STEP_S`]; an earlier time changes
    /// nothing.
    pub fn advance(&mut self, now: Duration) {
        while self.time() + STEP <= now {
            self.steps += 1;
            let time = self.time();
            let thrust = self.firmware.step(time, &self.airframe);
            let contacts = self.airframe.floor_contacts();
            let mut wind_m_s = self.wind.step();
            let wash = self.others.wash(self.airframe.position_m());
            self.airframe.set_downwash(wash.map_or(0.0, |wash| wash.down_m_s));
            if let Some(wash) = wash {
                wind_m_s += wash.across_m_s;
            }
            self.airframe.step(thrust, wind_m_s);
            self.gps_error_m.step();
            if self.firmware.phase() == Phase::Flying {
                self.floor_contacts += self.airframe.floor_contacts() - contacts;
            }
            let heard = if self.others.is_alone() {
                0.0
            } else {
                self.others.heard(self.airframe.position_m(), self.firmware.ultrasound())
            };
            self.sensors.hear(heard);
            self.sensors.step(self.steps, time, &self.airframe);
            if self.steps * PICTURES.0 % PICTURES.1 < PICTURES.0 {
                let detector = self.firmware.detector();
                self.camera.take(time, &self.airframe, &self.tags, detector);
            }
            if self.listener && time >= self.next_navdata {
                self.send_navdata(time);
            }
        }
    }

    /// The time up to which the drone is simulated.
    pub fn time(&self) -> Duration {
        STEP * u32::try_from(self.steps).unwrap_or(u32::MAX)
    }

    /// Processes a datagram of the AT port. Returns its decoding errors. For a second after a restart nothing is heard.
    pub fn handle_at(&mut self, now: Duration, datagram: &[u8]) -> Vec<DecodeError> {
        self.advance(now);
        if self.is_booting() { Vec::new() } else { self.firmware.handle_at(now, datagram) }
    }

    /// Processes a datagram of the navdata port: a client asks for navdata.
    pub fn handle_wake_up(&mut self, now: Duration) {
        self.advance(now);
        let is_deaf =
            self.config.lies.contains(Lies::DEAF_AFTER_LOSS) && self.firmware.link_is_lost(now);
        if !self.listener && !self.is_booting() && !is_deaf {
            self.listener = true;
            self.send_navdata(now);
        }
    }

    /// The next navdata packet for the client that sent the last wake-up.
    pub fn poll_navdata(&mut self) -> Option<Bytes> {
        self.outgoing.pop_front()
    }

    /// The reply on the control port, if one was requested.
    pub fn poll_control(&mut self) -> Option<String> {
        self.firmware.take_dump()
    }

    /// Blocks a propeller: the drone cuts its motors and falls.
    pub fn block_propeller(&mut self) {
        self.firmware.block_propeller();
    }

    /// Power-cycles the drone wherever it is: it loses its state, and falls if it was flying.
    pub fn restart(&mut self, now: Duration) {
        self.advance(now);
        self.firmware = self.firmware.restarted();
        self.sensors = self.sensors.clone().restarted(self.config.seed);
        self.switched_on = now;
        self.sequence = 0;
        self.listener = false;
        self.outgoing.clear();
    }

    fn is_booting(&self) -> bool {
        let starts_anew = self.switched_on > Duration::ZERO;
        starts_anew && self.time() < self.switched_on + BOOT_TIME
    }

    /// Falsifies one quantity in navdata for a time. Several faults may be active at once; each acts on the
    /// result of the earlier ones.
    pub fn break_sensor(&mut self, quantity: Quantity, fault: SensorFault, time: Duration) {
        let now = self.time();
        let reported = self.reported(now);
        self.faults.begin(now, quantity, fault, time, &reported);
    }

    /// Places a tag on the floor.
    pub fn lay_tag(&mut self, tag: FloorTag) {
        self.tags.push(tag);
    }

    /// From where the chosen camera sees.
    #[cfg(feature = "video")]
    pub fn view(&self) -> crate::video::View {
        crate::video::View {
            position_m: self.airframe.position_m(),
            yaw_rad: self.airframe.yaw_rad(),
            pitch_rad: self.airframe.pitch_rad(),
            roll_rad: self.airframe.roll_rad(),
            is_bottom: self.firmware.shows_bottom(),
        }
    }

    /// Bit rate of the video that the configuration asks for, in kbit/s, from 250 to 4000.
    #[cfg(feature = "video")]
    pub fn video_kbit_s(&self) -> u32 {
        self.firmware.video_kbit_s()
    }

    /// In which ways it is not as it is assumed to be.
    #[cfg(feature = "video")]
    pub(crate) fn lies(&self) -> Lies {
        self.config.lies
    }

    /// The tags on the floor, in the order of their placement.
    pub fn tags(&self) -> &[FloorTag] {
        &self.tags
    }

    /// Moves or removes a tag; the first one placed is 0.
    pub fn move_tag(&mut self, tag: usize, to: Option<FloorTag>) {
        match (self.tags.get_mut(tag), to) {
            (Some(tag), Some(to)) => *tag = to,
            (Some(_), None) => _ = self.tags.remove(tag),
            (None, _) => {}
        }
    }

    /// Sets bits of the reported state word for a time. The firmware's behaviour does not change.
    pub fn claim_state(&mut self, bits: DroneState, time: Duration) {
        self.claims.bits.push((bits, self.time() + time));
    }

    /// Sets the reported detail of the control state for a time.
    pub fn claim_minor_state(&mut self, minor: u16, time: Duration) {
        self.claims.minor.push((minor, self.time() + time));
    }

    /// Weakens a motor to a fraction of its thrust, from 0 to 1, over a time, permanently.
    pub fn weaken_motor(&mut self, share: f64, within: Duration) {
        self.airframe.weaken_motor(share, within);
    }

    /// Changes the steady wind, which blows towards (right, forward), and its gusts.
    pub fn set_wind(&mut self, steady_m_s: Vector2<f64>, gusts_m_s: f64) {
        self.wind.steady_m_s = steady_m_s;
        self.wind.gusts_m_s.deviation = gusts_m_s;
    }

    /// Sets the reduction of the measured charge at full load.
    pub fn set_battery_sag_percent(&mut self, percent: f64) {
        self.firmware.set_battery_sag_percent(percent);
    }

    /// Sets the charge.
    pub fn set_battery_percent(&mut self, percent: f64) {
        self.firmware.set_battery_percent(percent);
    }

    /// How others in the air notice the drone; its place is in its own frame.
    pub(crate) fn presence(&self) -> Presence {
        Presence {
            position_m: self.airframe.position_m(),
            rotors_turn: self.firmware.turns_rotors(),
            ultrasound: self.firmware.ultrasound(),
        }
    }

    /// Tells of the others in the air; their places are in the drone's own frame.
    pub(crate) fn meet(&mut self, others: impl IntoIterator<Item = Presence>) {
        self.others.are(others);
    }

    /// The true state.
    pub fn truth(&self) -> Truth {
        Truth {
            time: self.time(),
            switched_on: self.switched_on,
            position_m: self.airframe.position_m(),
            velocity_m_s: self.airframe.velocity_m_s(),
            yaw_deg: self.airframe.yaw_rad().to_degrees(),
            phase: self.firmware.phase(),
            odometry_m: self.sensors.odometry_m(),
            motion: self.firmware.motion(),
            heard_at: self.firmware.last_command(),
            trims_in_flight: self.firmware.trims_in_flight(),
            battery_percent: self.firmware.battery_percent(),
            floor_contacts: self.floor_contacts,
            touch_down_m_s: self.airframe.touch_down_m_s(),
        }
    }

    /// Remaining charge as measured by voltage.
    pub fn battery_percent(&self) -> f64 {
        self.firmware.battery_percent()
    }

    fn send_navdata(&mut self, now: Duration) {
        if self.firmware.link_is_lost(now) && !self.firmware.is_bootstrapping() {
            // The client has gone: no navdata until the next wake-up.
            self.listener = false;
            self.firmware.start_bootstrap();
            return;
        }
        let demo_only = self.firmware.is_demo() || self.firmware.is_bootstrapping();
        let lies = self.config.lies;
        self.next_navdata = now
            + match demo_only {
                true if lies.contains(Lies::SLOW_DEMO) => 3 * DEMO_PERIOD,
                false if !lies.contains(Lies::SLOW_FULL) => FULL_PERIOD,
                _ => DEMO_PERIOD,
            };
        let is_repeated = lies.contains(Lies::REPEATED_NUMBER) && self.steps.is_multiple_of(10);
        self.sequence += u32::from(!is_repeated);
        let mut bytes = BytesMut::with_capacity(PACKET_BYTES);
        // All options together are shorter than the maximum packet.
        if self.write_packet(now, demo_only, &mut bytes).is_ok() {
            self.outgoing.push_back(lies.spoil(self.sequence, bytes));
        }
    }

    fn write_packet(
        &mut self,
        now: Duration,
        demo_only: bool,
        bytes: &mut BytesMut,
    ) -> Result<(), NavdataError> {
        self.claims.settle(now);
        let state = self.firmware.state(now) | self.claims.state();
        let mut packet = PacketWriter::new(bytes, state, self.sequence, 1);
        if !self.firmware.is_bootstrapping() {
            let Reported { reading, clock } = self.reported(now);
            let telemetry = Telemetry {
                reading,
                tags: self.camera.read(now),
                minor_state: self.claims.minor(),
                firmware: &self.firmware,
                airframe: &self.airframe,
                wind_m_s: self.wind.steady_m_s,
                clock,
                tag_27: self.config.tag_27,
                gps_error_m: self.gps_error_m.value(),
            };
            let firmware = &self.firmware;
            // The demo option is always sent.
            let wanted = |tag| !demo_only || tag == 0 || firmware.wants_option(tag);
            telemetry.write(wanted, &mut packet)?;
        }
        packet.finish();
        Ok(())
    }

    /// The motion as reported in navdata, true or not.
    fn reported(&mut self, now: Duration) -> Reported {
        let since = now.saturating_sub(self.switched_on);
        let lies = self.config.lies;
        let since = if lies.contains(Lies::FAST_CLOCK) { since * 11 / 10 } else { since };
        let mut reported =
            Reported { reading: self.sensors.read(now), clock: since + CLOCK_AT_START };
        if lies.contains(Lies::TILTED) {
            reported.reading.pitch_deg = 10.0 - reported.reading.pitch_deg;
        }
        if lies.contains(Lies::MOVES_AT_REST) {
            reported.reading.velocity_m_s.x += 0.5;
        }
        self.faults.apply(now, &self.config.sensors, &mut reported);
        reported
    }
}

#[cfg(test)]
mod tests;
