//! A whole drone: firmware, airframe and sensors, fed with time and bytes.

use std::collections::VecDeque;
use std::time::Duration;

use ardrone_link::at::DecodeError;
use ardrone_link::navdata::{Demo, Navdata, OPTION_TIME, OPTION_VISION_DETECT};
use bytes::{Bytes, BytesMut};
use nalgebra::{Vector2, Vector3};
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, Uniform};

use crate::airframe::{Airframe, STEP_S};
use crate::firmware::{Firmware, Phase};
use crate::sensors::{SensorModel, Sensors};

/// What kind of drone it is.
#[derive(Debug, Clone, PartialEq)]
pub struct DroneConfig {
    /// Noise and delays of its sensors.
    pub sensors: SensorModel,
    /// Everything random follows from it.
    pub seed: u64,
    /// Charge at the start.
    pub battery_percent: f64,
    /// Blows towards (right, forward).
    pub wind_m_s: Vector2<f64>,
    /// Largest error of the level reference, which no pilot knows.
    pub trim_error_deg: f64,
}

impl Default for DroneConfig {
    fn default() -> Self {
        Self {
            sensors: SensorModel::nominal(),
            seed: 1,
            battery_percent: 90.0,
            wind_m_s: Vector2::zeros(),
            trim_error_deg: 0.3,
        }
    }
}

/// What really happens, and what nobody but the simulation knows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truth {
    /// The drone's own time.
    pub time: Duration,
    /// Right, forward, up from the place of the start.
    pub position_m: Vector3<f64>,
    /// Right, forward, up.
    pub velocity_m_s: Vector3<f64>,
    /// Clockwise from the heading at the start, not wrapped.
    pub yaw_deg: f64,
    /// What the firmware is doing.
    pub phase: Phase,
    /// The drone's own velocity integrated without delay: the frame of whoever hears only
    /// navdata. (right, forward)
    pub odometry_m: Vector2<f64>,
}

impl Truth {
    /// How far the drone's own velocity has led it astray. (right, forward)
    pub fn drift_m(&self) -> Vector2<f64> {
        self.odometry_m - self.position_m.xy()
    }
}

/// A simulated drone.
///
/// The shell advances it with [`Drone::advance`], hands it datagrams with [`Drone::handle_at`] and
/// [`Drone::handle_wake_up`], and sends on what [`Drone::poll_navdata`] and
/// [`Drone::poll_control`] return.
#[derive(Debug, Clone)]
pub struct Drone {
    firmware: Firmware,
    airframe: Airframe,
    sensors: Sensors,
    steps: u64,
    sequence: u32,
    listener: bool,
    next_navdata: Duration,
    outgoing: VecDeque<Bytes>,
}

const STEP: Duration = Duration::from_micros(2500);
const DEMO_PERIOD: Duration = Duration::from_micros(66_667);
const FULL_PERIOD: Duration = Duration::from_millis(5);
/// The drone's clock has run this long when the simulation starts.
const CLOCK_AT_START: Duration = Duration::from_millis(31_400);

impl Drone {
    /// A drone that has just started, on the ground.
    pub fn new(config: &DroneConfig) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(config.seed ^ 0x7472_696d);
        let trim_rad = Uniform::new_inclusive(-1.0, 1.0).map_or(Vector2::zeros(), |unit| {
            Vector2::new(unit.sample(&mut random), unit.sample(&mut random))
                * config.trim_error_deg.to_radians()
        });
        debug_assert!((STEP.as_secs_f64() - STEP_S).abs() < 1e-12);
        Self {
            firmware: Firmware::new(config.battery_percent),
            airframe: Airframe::new(trim_rad, config.wind_m_s),
            sensors: Sensors::new(config.sensors, config.seed),
            steps: 0,
            sequence: 0,
            listener: false,
            next_navdata: Duration::ZERO,
            outgoing: VecDeque::new(),
        }
    }

    /// Lives on until `now`, on the drone's own clock from its start.
    pub fn advance(&mut self, now: Duration) {
        while self.time() + STEP <= now {
            self.steps += 1;
            let time = self.time();
            let thrust = self.firmware.step(time, &self.airframe);
            self.airframe.step(thrust);
            self.sensors.step(self.steps, time, &self.airframe);
            if self.listener && time >= self.next_navdata {
                self.send_navdata(time);
            }
        }
    }

    /// The time up to which the drone has lived.
    pub fn time(&self) -> Duration {
        STEP * u32::try_from(self.steps).unwrap_or(u32::MAX)
    }

    /// Takes in a datagram of the AT port; returns what was not understood.
    pub fn handle_at(&mut self, now: Duration, datagram: &[u8]) -> Vec<DecodeError> {
        self.advance(now);
        self.firmware.handle_at(now, datagram)
    }

    /// Takes in a datagram of the navdata port: somebody wants to listen.
    pub fn handle_wake_up(&mut self, now: Duration) {
        self.advance(now);
        if !self.listener {
            self.listener = true;
            self.send_navdata(now);
        }
    }

    /// The next navdata packet for whoever woke the drone last.
    pub fn poll_navdata(&mut self) -> Option<Bytes> {
        self.outgoing.pop_front()
    }

    /// What goes out on the control port, if it was asked for.
    pub fn poll_control(&mut self) -> Option<String> {
        self.firmware.take_dump()
    }

    /// Something stops a propeller: the drone cuts its motors and falls.
    pub fn block_propeller(&mut self) {
        self.firmware.block_propeller();
    }

    /// What really happens.
    pub fn truth(&self) -> Truth {
        Truth {
            time: self.time(),
            position_m: self.airframe.position_m(),
            velocity_m_s: self.airframe.velocity_m_s(),
            yaw_deg: self.airframe.yaw_rad().to_degrees(),
            phase: self.firmware.phase(),
            odometry_m: self.sensors.odometry_m(),
        }
    }

    /// Remaining charge.
    pub fn battery_percent(&self) -> f64 {
        self.firmware.battery_percent()
    }

    fn send_navdata(&mut self, now: Duration) {
        if self.firmware.link_is_lost(now) && !self.firmware.is_bootstrapping() {
            // The pilot has gone: the drone stops talking until somebody wakes it again.
            self.listener = false;
            self.firmware.start_bootstrap();
            return;
        }
        let demo_only = self.firmware.is_demo() || self.firmware.is_bootstrapping();
        self.next_navdata = now + if demo_only { DEMO_PERIOD } else { FULL_PERIOD };
        self.sequence += 1;
        let mut navdata = Navdata {
            state: self.firmware.state(now),
            sequence: self.sequence,
            vision: 1,
            demo: None,
            time: None,
        };
        let mut with_vision_detect = false;
        if !self.firmware.is_bootstrapping() {
            let wants = |tag| !demo_only || self.firmware.wants_option(tag);
            navdata.time = wants(OPTION_TIME).then_some(now + CLOCK_AT_START);
            with_vision_detect = wants(OPTION_VISION_DETECT);
            navdata.demo = Some(self.demo(now));
        }
        let mut packet = BytesMut::with_capacity(512);
        navdata.encode(with_vision_detect, &mut packet);
        self.outgoing.push_back(packet.freeze());
    }

    fn demo(&mut self, now: Duration) -> Demo {
        let reading = self.sensors.read(now);
        // A percentage: it fits.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let battery_percent = self.firmware.battery_percent().round() as u32;
        Demo {
            control_state: self.firmware.control_state(),
            control_state_minor: 0,
            battery_percent,
            pitch_deg: reading.pitch_deg,
            roll_deg: reading.roll_deg,
            yaw_deg: reading.yaw_deg,
            altitude_m: reading.altitude_m,
            velocity_forward_m_s: reading.velocity_m_s.y,
            velocity_right_m_s: reading.velocity_m_s.x,
            velocity_down_m_s: 0.0,
        }
    }
}

#[cfg(test)]
mod tests;
