//! Whether a quantity is noisier than its sensor.
//!
//! Of three successive values the middle one is compared with the line between the others. A drone bends its course only
//! as fast as thrust, inertia and its orders allow; the rest is noise. The test needs no model of the airframe, and neither
//! the position nor the level of the values: it is the same for all quantities. It adds up over time (a cumulative sum; Page,
//! 1954), so that neither a single wrong echo nor a step of the floor is called noise.

use kinematics::{DroneLimits, GRAVITY_M_S2, wrap_deg};

use crate::Sample;
use crate::sensor::{ATTITUDE_DEG, COMPASS_DEG, FLOW_M_S, ULTRASOUND_M};
use crate::silence::GAP_S;
use crate::trust::Quantity;

/// A deviation counts by its square in units of the noise, but at most this much...
const MOST: f64 = 9.0;
/// ...less this much, so that noise up to 1.7 times the sensor's own is forgotten.
const LESS: f64 = 3.0;
/// Evidence that is enough: ten deviations of the largest kind. Two wrong echoes that follow one another make six.
const ENOUGH: f64 = 60.0;

/// The judges of all quantities in navdata.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct NoiseOfAll {
    velocity: [Noise; 2],
    altitude: Noise,
    heading: Noise,
    attitude: [Noise; 2],
    /// Compass and heading of the last packet; the heading does not jump at half a turn.
    compass_deg: f64,
    heading_deg: f64,
}

impl NoiseOfAll {
    /// Adds the values of a packet. `steered` is how far the sticks have moved lately, 1 for once through half of their
    /// way or for a drone that moves by itself. Returns a quantity that is noisier than its sensor.
    pub(crate) fn watch(
        &mut self,
        at_s: f64,
        sample: &Sample,
        limits: &DroneLimits,
        steered: f64,
    ) -> Option<Quantity> {
        let steered = steered.min(1.0);
        let still = Own { deviation: 0.0, step: 0.0, rate: 0.0, acceleration: 0.0 };
        let pull_m_s2 = 2.0 * GRAVITY_M_S2 * limits.tilt_rad.tan();
        let velocity = Own { deviation: FLOW_M_S, rate: pull_m_s2, ..still };
        let altitude = Own { deviation: ULTRASOUND_M, acceleration: CLIMB_M_S2, ..still };
        let turn_deg_s = 2.0 * limits.turn_deg_s * steered;
        let heading = Own { deviation: COMPASS_DEG, rate: turn_deg_s, ..still };
        let tilt_deg = 2.0 * limits.tilt_rad.to_degrees() * steered;
        let attitude = Own { deviation: ATTITUDE_DEG, step: tilt_deg, ..still };
        let turned_deg = wrap_deg(sample.yaw_deg - self.compass_deg);
        self.heading_deg += turned_deg;
        self.compass_deg = sample.yaw_deg;
        let [right, forward] = &mut self.velocity;
        let [roll, pitch] = &mut self.attitude;
        let watched = [
            (Quantity::Velocity, right, sample.velocity_right_m_s, velocity),
            (Quantity::Velocity, forward, sample.velocity_forward_m_s, velocity),
            (Quantity::Altitude, &mut self.altitude, sample.altitude_m, altitude),
            (Quantity::Heading, &mut self.heading, self.heading_deg, heading),
            (Quantity::Attitude, roll, sample.roll_deg, attitude),
            (Quantity::Attitude, pitch, sample.pitch_deg, attitude),
        ];
        let mut noisy = None;
        for (quantity, noise, value, own) in watched {
            if noise.watch(at_s, value, &own) {
                noisy = noisy.or(Some(quantity));
            }
        }
        noisy
    }
}

/// Largest acceleration upwards or downwards: full climb within 0.17 s.
const CLIMB_M_S2: f64 = 8.0;

/// Noise of a quantity that a healthy sensor has, and how far the drone's motion can bend its course.
#[derive(Debug, Clone, Copy)]
struct Own {
    /// Standard deviation of the noise that is left after the sensor's own filter, of the worse sensors.
    deviation: f64,
    /// Largest step of the value.
    step: f64,
    /// Largest step of its rate, per second.
    rate: f64,
    /// Largest acceleration, per second squared.
    acceleration: f64,
}

/// Evidence for noise of one quantity.
#[derive(Debug, Clone, Copy, Default)]
struct Noise {
    /// The last two values, with their times.
    last: [Option<(f64, f64)>; 2],
    evidence: f64,
}

impl Noise {
    /// Adds a new measurement; of a heading the unwrapped one. Returns whether the quantity is too noisy.
    fn watch(&mut self, at_s: f64, value: f64, own: &Own) -> bool {
        let [first, middle] = self.last;
        // Navdata come more often than most sensors measure.
        #[allow(clippy::float_cmp, reason = "the very same number, not a near one")]
        if middle.is_some_and(|(_, last)| last == value) {
            return self.is_enough();
        }
        if middle.is_some_and(|(middle_s, _)| at_s <= middle_s) {
            return self.is_enough();
        }
        self.last = [middle, Some((at_s, value))];
        let (Some((from_s, from)), Some((middle_s, middle))) = (first, middle) else {
            return self.is_enough();
        };
        let whole_s = at_s - from_s;
        if whole_s > GAP_S {
            return self.is_enough();
        }
        let [before_s, after_s] = [middle_s - from_s, at_s - middle_s];
        let share = before_s / whole_s;
        let off = (middle - from - (value - from) * share).abs();
        let mean_s = before_s * after_s / whole_s;
        let bends = own.step + own.rate * mean_s + own.acceleration * before_s * after_s / 2.0;
        let deviation = own.deviation * (1.0 + share * share + (1.0 - share).powi(2)).sqrt();
        let excess = (off - bends).max(0.0) / deviation;
        self.evidence =
            (self.evidence + (excess * excess).min(MOST) - LESS).clamp(0.0, 2.0 * ENOUGH);
        self.is_enough()
    }

    fn is_enough(&self) -> bool {
        self.evidence >= ENOUGH
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OWN: Own = Own { deviation: 0.02, step: 0.0, rate: 0.0, acceleration: 8.0 };
    const STEP_S: f64 = 1.0 / 15.0;

    /// Noise of deviation 1 without a generator: quantiles in a shuffled order.
    fn noise(step: u32) -> f64 {
        const VALUES: [f64; 8] = [-1.53, 0.49, 1.53, -0.16, 0.89, -0.89, 0.16, -0.49];
        VALUES[(step.wrapping_mul(2_654_435_761) >> 20) as usize % VALUES.len()]
    }

    /// When a value with noise is called noisy.
    fn noisy_after_s(deviation: f64, value: impl Fn(f64) -> f64) -> Option<f64> {
        let mut judge = Noise::default();
        (0..900_u32).map(|step| (step, f64::from(step) * STEP_S)).find_map(|(step, at_s)| {
            let is_noisy = judge.watch(at_s, value(at_s) + deviation * noise(step), &OWN);
            is_noisy.then_some(at_s)
        })
    }

    #[test]
    fn noise_is_found_within_a_second_and_a_healthy_sensor_is_not_accused() {
        let climb = |at_s: f64| 1.0 + 0.5 * at_s;
        for deviation in [0.0, 0.015, 0.025] {
            assert_eq!(noisy_after_s(deviation, climb), None, "{deviation}");
        }
        for deviation in [0.1, 0.4, 1.0] {
            let after_s = noisy_after_s(deviation, climb).unwrap_or(f64::INFINITY);
            assert!(after_s < 2.0, "{deviation}: {after_s} s");
        }
    }

    #[test]
    fn what_a_drone_can_fly_is_no_noise() {
        // From full climb to full descent within a tenth of a second, again and again.
        let swings = |at_s: f64| 0.4 * (1.4 * std::f64::consts::PI * at_s).sin();
        assert_eq!(noisy_after_s(0.015, swings), None);
    }

    #[test]
    fn steps_and_single_wrong_values_are_no_noise() {
        let stairs = |at_s: f64| 0.5 * (at_s / 2.0).floor();
        assert_eq!(noisy_after_s(0.015, stairs), None, "a floor of stairs");
        let echoes = |at_s: f64| if (at_s * 15.0).round() % 12.0 < 0.5 { 3.0 } else { 1.0 };
        assert_eq!(noisy_after_s(0.015, echoes), None, "a wrong echo each 0.8 s");
    }

    #[test]
    fn values_far_apart_show_nothing_and_values_at_once_neither() {
        let mut judge = Noise::default();
        for step in 0..100_u32 {
            let value = f64::from(step % 2);
            assert!(!judge.watch(f64::from(step) * 0.2, value, &OWN));
        }
        let mut judge = Noise::default();
        for step in 0..100_u32 {
            assert!(!judge.watch(1.0, f64::from(step % 2), &OWN));
        }
    }

    #[test]
    fn noise_that_has_ended_is_forgotten() {
        let mut judge = Noise::default();
        let mut watch = |steps: std::ops::Range<u32>, deviation: f64| {
            steps.fold(false, |_, step| {
                judge.watch(f64::from(step) * STEP_S, deviation * noise(step), &OWN)
            })
        };
        assert!(watch(0..60, 0.5));
        assert!(!watch(60..90, 0.01), "two seconds later");
    }
}
