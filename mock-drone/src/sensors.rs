//! Sensors of the drone's motion: optical flow, altitude, attitude, heading.

use std::collections::VecDeque;
use std::time::Duration;

use nalgebra::Vector2;
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, StandardNormal};

use crate::air::ForeignPulses;
use crate::airframe::{Airframe, STEP_S, world_from_body};

/// Errors of the sensors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorModel {
    /// White noise of each sample of the optical flow: the standard deviation on each axis.
    pub flow_noise_m_s: f64,
    /// Time constant of the flow's own filter.
    pub flow_filter: Duration,
    /// Delay of the flow besides its filter.
    pub flow_delay: Duration,
    /// Initial standard deviation of the flow's bias.
    pub flow_bias_m_s: f64,
    /// Random walk of the bias, in m/s per square root of a second.
    pub flow_bias_walk_m_s: f64,
    /// Scale error of the flow, 0.03 for 3 %.
    pub flow_scale_error: f64,
    /// White noise of each sample of the altitude.
    pub altitude_noise_m: f64,
    /// Fraction of ultrasound echoes that are wrong, from 0 to 1: then the altitude is anything from 0.3 m to 1.2 m.
    pub bad_echoes: f64,
    /// White noise of pitch and roll.
    pub attitude_noise_deg: f64,
    /// Delay of attitude, heading and altitude.
    pub attitude_delay: Duration,
    /// White noise of the heading.
    pub yaw_noise_deg: f64,
    /// Drift of the heading.
    pub yaw_drift_deg_s: f64,
    /// Initial reading of the heading.
    pub initial_heading_deg: f64,
}

impl SensorModel {
    /// Sensors without noise, delay or bias.
    pub fn perfect() -> Self {
        Self {
            flow_noise_m_s: 0.0,
            flow_filter: Duration::ZERO,
            flow_delay: Duration::ZERO,
            flow_bias_m_s: 0.0,
            flow_bias_walk_m_s: 0.0,
            flow_scale_error: 0.0,
            altitude_noise_m: 0.0,
            bad_echoes: 0.0,
            attitude_noise_deg: 0.0,
            attitude_delay: Duration::ZERO,
            yaw_noise_deg: 0.0,
            yaw_drift_deg_s: 0.0,
            initial_heading_deg: 37.0,
        }
    }

    /// A drone in a good room: bright, textured floor, no wind.
    pub fn nominal() -> Self {
        Self {
            flow_noise_m_s: 0.04,
            flow_filter: Duration::from_millis(40),
            flow_delay: Duration::from_millis(45),
            flow_bias_m_s: 0.004,
            flow_bias_walk_m_s: 0.001,
            flow_scale_error: 0.03,
            altitude_noise_m: 0.008,
            bad_echoes: 0.0,
            attitude_noise_deg: 0.1,
            attitude_delay: Duration::from_millis(20),
            yaw_noise_deg: 0.1,
            yaw_drift_deg_s: 0.01,
            initial_heading_deg: 37.0,
        }
    }
}

impl SensorModel {
    /// A bad room: dim light, smooth floor, obstacles below the ultrasound.
    pub fn hard() -> Self {
        Self {
            flow_noise_m_s: 0.08,
            flow_filter: Duration::from_millis(60),
            flow_delay: Duration::from_millis(70),
            flow_bias_m_s: 0.012,
            flow_bias_walk_m_s: 0.003,
            flow_scale_error: 0.06,
            altitude_noise_m: 0.015,
            bad_echoes: 0.003,
            attitude_noise_deg: 0.25,
            attitude_delay: Duration::from_millis(30),
            yaw_noise_deg: 0.2,
            yaw_drift_deg_s: 0.03,
            initial_heading_deg: 171.0,
        }
    }

    /// Standard deviation of the flow's white noise after its own filter.
    pub(crate) fn filtered_flow_noise_m_s(&self) -> f64 {
        let period_s = FLOW_STEPS as f64 * STEP_S;
        let share = period_s / (period_s + self.flow_filter.as_secs_f64());
        self.flow_noise_m_s * (share / (2.0 - share)).sqrt()
    }
}

/// Sensor readings at one time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Reading {
    /// (right, forward) in the levelled body frame.
    pub velocity_m_s: Vector2<f64>,
    /// Above the floor, not below 0.
    pub altitude_m: f64,
    /// Nose up.
    pub pitch_deg: f64,
    /// Right side down.
    pub roll_deg: f64,
    /// Clockwise, in [-180, 180).
    pub yaw_deg: f64,
}

/// The sensors of one drone.
#[derive(Debug, Clone)]
pub struct Sensors {
    model: SensorModel,
    random: ChaCha8Rng,
    bias_m_s: Vector2<f64>,
    filtered_m_s: Vector2<f64>,
    flow: DelayLine<Vector2<f64>>,
    attitude: DelayLine<AttitudeReading>,
    altitude: DelayLine<f64>,
    yaw_drift_deg: f64,
    odometry_m: Vector2<f64>,
    foreign: ForeignPulses,
}

#[derive(Debug, Clone, Copy, Default)]
#[allow(clippy::struct_field_names, reason = "the unit belongs to the name")]
struct AttitudeReading {
    pitch_deg: f64,
    roll_deg: f64,
    yaw_deg: f64,
}

/// Steps between two samples of each sensor: 60 Hz, 25 Hz, 200 Hz.
const FLOW_STEPS: u64 = 7;
const ALTITUDE_STEPS: u64 = 16;
const ATTITUDE_STEPS: u64 = 2;
/// The flow's bias fades with this time constant.
const BIAS_LEAK_S: f64 = 120.0;

impl Sensors {
    /// Sensors with noise from `seed`.
    pub fn new(model: SensorModel, seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let bias_m_s = gaussian_pair(&mut random) * model.flow_bias_m_s;
        Self {
            random,
            bias_m_s,
            filtered_m_s: Vector2::zeros(),
            flow: DelayLine::new(model.flow_delay),
            attitude: DelayLine::new(model.attitude_delay),
            altitude: DelayLine::new(model.attitude_delay),
            yaw_drift_deg: 0.0,
            odometry_m: Vector2::zeros(),
            foreign: ForeignPulses::new(seed),
            model,
        }
    }

    /// The same sensors after a long time at rest: delay lines and filters are settled.
    #[must_use]
    pub fn settled(mut self, airframe: &Airframe) -> Self {
        let attitude = AttitudeReading {
            pitch_deg: airframe.pitch_rad().to_degrees(),
            roll_deg: airframe.roll_rad().to_degrees(),
            yaw_deg: wrapped_deg(self.model.initial_heading_deg + airframe.yaw_rad().to_degrees()),
        };
        self.attitude = DelayLine::starting_at(attitude, self.model.attitude_delay);
        let height_m = airframe.position_m().z;
        self.altitude = DelayLine::starting_at(height_m, self.model.attitude_delay);
        self
    }

    /// The same sensors after a power cycle. The integrated velocity continues, because it is part of the
    /// simulation and not of the drone.
    #[must_use]
    pub fn restarted(self, seed: u64) -> Self {
        Self { odometry_m: self.odometry_m, ..Self::new(self.model, seed) }
    }

    /// Tells what share of the pulses of other drones is heard.
    pub(crate) fn hear(&mut self, share: f64) {
        self.foreign.heard = share;
    }

    /// Samples the airframe after physics step number `step`, at time `now`.
    pub fn step(&mut self, step: u64, now: Duration, airframe: &Airframe) {
        if step.is_multiple_of(FLOW_STEPS) {
            self.sample_flow(now, airframe);
        }
        if step.is_multiple_of(ALTITUDE_STEPS) {
            let noise_m = self.gaussian() * self.model.altitude_noise_m;
            let altitude_m = (airframe.position_m().z + noise_m).max(0.0);
            let bad = self.model.bad_echoes > 0.0 && self.random.random_bool(self.model.bad_echoes);
            let echo_m = if bad { self.random.random_range(0.3..1.2) } else { altitude_m };
            if let Some(echo_m) = self.foreign.disturb(echo_m) {
                self.altitude.push(now, echo_m);
            }
        }
        if step.is_multiple_of(ATTITUDE_STEPS) {
            self.sample_attitude(now, airframe);
        }
    }

    fn sample_flow(&mut self, now: Duration, airframe: &Airframe) {
        let period_s = FLOW_STEPS as f64 * STEP_S;
        let walk = gaussian_pair(&mut self.random) * self.model.flow_bias_walk_m_s;
        self.bias_m_s += walk * period_s.sqrt() - self.bias_m_s * (period_s / BIAS_LEAK_S);
        let flying = airframe.position_m().z > 0.0;
        let noise = gaussian_pair(&mut self.random) * self.model.flow_noise_m_s;
        let measured = if flying {
            airframe.body_velocity_m_s() * (1.0 + self.model.flow_scale_error)
                + self.bias_m_s
                + noise
        } else {
            Vector2::zeros()
        };
        let filter_s = self.model.flow_filter.as_secs_f64();
        self.filtered_m_s += (measured - self.filtered_m_s) * (period_s / (period_s + filter_s));
        let heading_rad = airframe.yaw_rad() + self.yaw_drift_deg.to_radians();
        self.odometry_m +=
            world_from_body(self.filtered_m_s.x, self.filtered_m_s.y, heading_rad) * period_s;
        self.flow.push(now, self.filtered_m_s);
    }

    fn sample_attitude(&mut self, now: Duration, airframe: &Airframe) {
        let period_s = ATTITUDE_STEPS as f64 * STEP_S;
        self.yaw_drift_deg += self.model.yaw_drift_deg_s * period_s;
        let [pitch, roll, yaw] = std::array::from_fn(|_| self.gaussian());
        let heading_deg = self.model.initial_heading_deg
            + airframe.yaw_rad().to_degrees()
            + self.yaw_drift_deg
            + yaw * self.model.yaw_noise_deg;
        let reading = AttitudeReading {
            pitch_deg: airframe.pitch_rad().to_degrees() + pitch * self.model.attitude_noise_deg,
            roll_deg: airframe.roll_rad().to_degrees() + roll * self.model.attitude_noise_deg,
            yaw_deg: wrapped_deg(heading_deg),
        };
        self.attitude.push(now, reading);
    }

    /// The readings that the drone reports at `now`.
    pub fn read(&mut self, now: Duration) -> Reading {
        let attitude = self.attitude.read(now);
        Reading {
            velocity_m_s: self.flow.read(now),
            altitude_m: self.altitude.read(now),
            pitch_deg: attitude.pitch_deg,
            roll_deg: attitude.roll_deg,
            yaw_deg: attitude.yaw_deg,
        }
    }

    /// The velocity of the healthy sensors, integrated without delay: the best position estimate that is
    /// possible from navdata alone. Injected faults are excluded. (right, forward) from the start.
    pub fn odometry_m(&self) -> Vector2<f64> {
        self.odometry_m
    }

    fn gaussian(&mut self) -> f64 {
        StandardNormal.sample(&mut self.random)
    }
}

/// Wraps an angle to [-180, 180).
pub(crate) fn wrapped_deg(deg: f64) -> f64 {
    (deg + 180.0).rem_euclid(360.0) - 180.0
}

fn gaussian_pair(random: &mut ChaCha8Rng) -> Vector2<f64> {
    Vector2::new(StandardNormal.sample(random), StandardNormal.sample(random))
}

/// Delays values by a fixed time.
#[derive(Debug, Clone)]
pub(crate) struct DelayLine<T> {
    delay: Duration,
    waiting: VecDeque<(Duration, T)>,
    visible: T,
}

impl<T: Copy + Default> DelayLine<T> {
    pub(crate) fn new(delay: Duration) -> Self {
        Self::starting_at(T::default(), delay)
    }

    /// A delay line that returns this value until the first one has passed.
    pub(crate) fn starting_at(value: T, delay: Duration) -> Self {
        Self { delay, waiting: VecDeque::new(), visible: value }
    }

    pub(crate) fn push(&mut self, now: Duration, value: T) {
        self.waiting.push_back((now + self.delay, value));
        self.settle(now);
    }

    pub(crate) fn read(&mut self, now: Duration) -> T {
        self.settle(now);
        self.visible
    }

    fn settle(&mut self, now: Duration) {
        while let Some((due, value)) = self.waiting.front().copied()
            && due <= now
        {
            self.visible = value;
            self.waiting.pop_front();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::airframe::Profile;

    #[test]
    fn a_delay_line_shows_values_late_and_in_order() {
        let ms = Duration::from_millis;
        let mut line = DelayLine::new(ms(10));
        line.push(ms(0), 1);
        line.push(ms(5), 2);
        assert_eq!(line.read(ms(9)), 0);
        assert_eq!(line.read(ms(10)), 1);
        assert_eq!(line.read(ms(100)), 2);
    }

    #[test]
    fn the_same_seed_reads_the_same() {
        let read = |seed| {
            let airframe = Airframe::new(Profile::rec(), Vector2::zeros());
            let mut sensors = Sensors::new(SensorModel::nominal(), seed);
            for step in 0..1000 {
                sensors.step(step, Duration::from_secs_f64(step as f64 * STEP_S), &airframe);
            }
            sensors.read(Duration::from_secs(3))
        };
        assert_eq!(read(1), read(1));
        assert_ne!(read(1), read(2));
    }
}
