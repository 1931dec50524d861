//! Sensor faults in navdata.
//!
//! Only navdata are falsified: the firmware's own hover and landing use the true motion, as in a drone whose
//! control loop works and whose telemetry does not.

use std::time::Duration;

use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, StandardNormal};

use crate::sensors::{DelayLine, Reading, SensorModel, wrapped_deg};

/// A quantity in navdata that can be falsified separately.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Quantity {
    /// Velocity towards the drone's right, in m/s.
    VelocityRight,
    /// Velocity towards the drone's front, in m/s.
    VelocityForward,
    /// Height above the ground, in metres. An integer of millimetres on the wire, which cannot be NaN.
    Altitude,
    /// Heading, clockwise, in degrees.
    Yaw,
    /// Right side down, in degrees.
    Roll,
    /// Nose up, in degrees.
    Pitch,
    /// The drone's clock, in seconds. An integer of microseconds on the wire, which cannot be NaN.
    Clock,
}

impl Quantity {
    /// All quantities.
    pub const ALL: [Self; 7] = [
        Self::VelocityRight,
        Self::VelocityForward,
        Self::Altitude,
        Self::Yaw,
        Self::Roll,
        Self::Pitch,
        Self::Clock,
    ];

    /// Quantities measured by a sensor.
    pub const SENSED: [Self; 6] = [
        Self::VelocityRight,
        Self::VelocityForward,
        Self::Altitude,
        Self::Yaw,
        Self::Roll,
        Self::Pitch,
    ];

    /// Whether it is a float on the wire, and so can be NaN.
    pub fn is_float(self) -> bool {
        !matches!(self, Self::Altitude | Self::Clock)
    }

    /// Whether it is measured from a zero that means something. A heading's is arbitrary, a clock's long ago.
    fn has_zero(self) -> bool {
        !matches!(self, Self::Yaw | Self::Clock)
    }

    /// Standard deviation of its noise in navdata.
    fn noise(self, model: &SensorModel) -> f64 {
        match self {
            Self::VelocityRight | Self::VelocityForward => model.filtered_flow_noise_m_s(),
            Self::Altitude => model.altitude_noise_m,
            Self::Yaw => model.yaw_noise_deg,
            Self::Roll | Self::Pitch => model.attitude_noise_deg,
            Self::Clock => 0.0,
        }
    }
}

/// Kind of a sensor fault. Numbers are in the unit of the [`Quantity`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SensorFault {
    /// Stays at its last value.
    Stuck,
    /// Stays at this value.
    StuckAt(f64),
    /// Stays at this value with its usual noise: a dead sensor that still has noise.
    DeadAt(f64),
    /// An offset is added.
    Offset(f64),
    /// A ramp is added, per second.
    Ramp(f64),
    /// White noise of this standard deviation is added.
    Noise(f64),
    /// Multiplied by this: what has a zero of its own from there, heading and clock from their value at the start.
    Gain(f64),
    /// NaN. Quantities that are not floats on the wire read zero.
    NotANumber,
    /// Additional delay.
    Late(Duration),
}

/// The motion reported in navdata, with its time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reported {
    pub(crate) reading: Reading,
    /// The drone's own clock.
    pub(crate) clock: Duration,
}

/// Time after which the clock wraps.
const CLOCK_WRAP_S: f64 = 2048.0;

impl Reported {
    fn get(&self, quantity: Quantity) -> f64 {
        let reading = &self.reading;
        match quantity {
            Quantity::VelocityRight => reading.velocity_m_s.x,
            Quantity::VelocityForward => reading.velocity_m_s.y,
            Quantity::Altitude => reading.altitude_m,
            Quantity::Yaw => reading.yaw_deg,
            Quantity::Roll => reading.roll_deg,
            Quantity::Pitch => reading.pitch_deg,
            Quantity::Clock => self.clock.as_secs_f64(),
        }
    }

    fn set(&mut self, quantity: Quantity, value: f64) {
        let reading = &mut self.reading;
        match quantity {
            Quantity::VelocityRight => reading.velocity_m_s.x = value,
            Quantity::VelocityForward => reading.velocity_m_s.y = value,
            Quantity::Altitude => reading.altitude_m = value,
            Quantity::Yaw => reading.yaw_deg = wrapped_deg(value),
            Quantity::Roll => reading.roll_deg = value,
            Quantity::Pitch => reading.pitch_deg = value,
            Quantity::Clock => {
                let since_wrap_s = value.rem_euclid(CLOCK_WRAP_S);
                self.clock = Duration::try_from_secs_f64(since_wrap_s).unwrap_or_default();
            }
        }
    }
}

/// The active faults of one drone's sensors.
#[derive(Debug, Clone)]
pub(crate) struct SensorFaults {
    random: ChaCha8Rng,
    /// In the order of their start: each acts on the result of the earlier ones.
    active: Vec<ActiveFault>,
}

#[derive(Debug, Clone)]
struct ActiveFault {
    quantity: Quantity,
    began: Duration,
    ends: Duration,
    effect: Effect,
}

#[derive(Debug, Clone)]
enum Effect {
    StuckAt(f64),
    DeadAt(f64),
    Offset(f64),
    Ramp(f64),
    Noise(f64),
    Gain { factor: f64, zero: f64 },
    Late(DelayLine<f64>),
}

impl SensorFaults {
    pub(crate) fn new(seed: u64) -> Self {
        Self { random: ChaCha8Rng::seed_from_u64(seed ^ 0x6661_756c), active: Vec::new() }
    }

    /// Starts a fault for a time; `reported` are the values without it.
    pub(crate) fn begin(
        &mut self,
        now: Duration,
        quantity: Quantity,
        fault: SensorFault,
        time: Duration,
        reported: &Reported,
    ) {
        let effect = match fault {
            SensorFault::Stuck => Effect::StuckAt(reported.get(quantity)),
            SensorFault::StuckAt(value) => Effect::StuckAt(value),
            SensorFault::DeadAt(value) => Effect::DeadAt(value),
            SensorFault::Offset(offset) => Effect::Offset(offset),
            SensorFault::Ramp(rate) => Effect::Ramp(rate),
            SensorFault::Noise(deviation) => Effect::Noise(deviation),
            SensorFault::Gain(factor) => {
                let zero = if quantity.has_zero() { 0.0 } else { reported.get(quantity) };
                Effect::Gain { factor, zero }
            }
            SensorFault::NotANumber => {
                Effect::StuckAt(if quantity.is_float() { f64::NAN } else { 0.0 })
            }
            SensorFault::Late(delay) => {
                Effect::Late(DelayLine::starting_at(reported.get(quantity), delay))
            }
        };
        self.active.push(ActiveFault { quantity, began: now, ends: now + time, effect });
    }

    /// Applies the faults to the values at `now`.
    pub(crate) fn apply(&mut self, now: Duration, model: &SensorModel, reported: &mut Reported) {
        self.active.retain(|fault| fault.ends > now);
        for ActiveFault { quantity, began, effect, .. } in &mut self.active {
            let value = reported.get(*quantity);
            let wrong = match effect {
                Effect::StuckAt(stuck) => *stuck,
                Effect::DeadAt(dead) => {
                    let noise: f64 = StandardNormal.sample(&mut self.random);
                    *dead + noise * quantity.noise(model)
                }
                Effect::Offset(offset) => value + *offset,
                Effect::Ramp(rate) => value + *rate * now.saturating_sub(*began).as_secs_f64(),
                Effect::Noise(deviation) => {
                    let noise: f64 = StandardNormal.sample(&mut self.random);
                    value + noise * *deviation
                }
                Effect::Gain { factor, zero } => {
                    let change = value - *zero;
                    let is_angle = *quantity == Quantity::Yaw;
                    *zero + *factor * if is_angle { wrapped_deg(change) } else { change }
                }
                Effect::Late(line) => {
                    line.push(now, value);
                    line.read(now)
                }
            };
            reported.set(*quantity, wrong);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);
    const MODEL: fn() -> SensorModel = SensorModel::nominal;

    /// A quantity that reads the seconds since the start.
    fn healthy(quantity: Quantity, now: Duration) -> Reported {
        let mut reported = Reported { reading: Reading::default(), clock: Duration::ZERO };
        reported.set(quantity, now.as_secs_f64());
        reported
    }

    /// The values at 1.5 s and at 3.5 s with a fault from 1 s to 3 s.
    fn reported(quantity: Quantity, fault: SensorFault) -> [f64; 2] {
        let mut faults = SensorFaults::new(1);
        faults.begin(SECOND, quantity, fault, 2 * SECOND, &healthy(quantity, SECOND));
        [SECOND + SECOND / 2, 3 * SECOND + SECOND / 2].map(|now| {
            let mut reported = healthy(quantity, now);
            faults.apply(now, &MODEL(), &mut reported);
            reported.get(quantity)
        })
    }

    #[test]
    fn each_fault_does_what_it_says_and_ends() {
        for quantity in Quantity::ALL {
            for (fault, during) in [
                (SensorFault::Stuck, 1.0),
                (SensorFault::StuckAt(5.0), 5.0),
                (SensorFault::Offset(2.0), 3.5),
                (SensorFault::Ramp(4.0), 3.5),
                (SensorFault::Late(SECOND), 1.0),
            ] {
                let [then, later] = reported(quantity, fault);
                assert!((then - during).abs() < 1e-9, "{quantity:?} {fault:?}: {then}");
                assert!((later - 3.5).abs() < 1e-9, "{quantity:?} {fault:?}: {later}");
            }
            let [then, later] = reported(quantity, SensorFault::NotANumber);
            assert_eq!(then.is_nan(), quantity.is_float(), "{quantity:?}: {then}");
            assert!((later - 3.5).abs() < 1e-9);
        }
    }

    #[test]
    fn a_dead_sensor_rattles_as_a_healthy_one() {
        for quantity in Quantity::SENSED {
            let mut faults = SensorFaults::new(1);
            let at = healthy(quantity, SECOND);
            faults.begin(SECOND, quantity, SensorFault::DeadAt(0.5), SECOND, &at);
            let values: Vec<f64> = (0..500)
                .map(|step| {
                    let now = SECOND + Duration::from_millis(step);
                    let mut reported = healthy(quantity, now);
                    faults.apply(now, &MODEL(), &mut reported);
                    reported.get(quantity) - 0.5
                })
                .collect();
            let deviation = (values.iter().map(|value| value.powi(2)).sum::<f64>() / 500.0).sqrt();
            let usual = quantity.noise(&MODEL());
            assert!((deviation / usual - 1.0).abs() < 0.15, "{quantity:?}: {deviation} {usual}");
        }
    }

    #[test]
    fn noise_is_added_to_the_measured_value() {
        for quantity in Quantity::SENSED {
            let mut faults = SensorFaults::new(1);
            let at = healthy(quantity, SECOND);
            faults.begin(SECOND, quantity, SensorFault::Noise(0.3), SECOND, &at);
            let values: Vec<f64> = (0..2000)
                .map(|_| {
                    let mut reported = at;
                    faults.apply(SECOND, &MODEL(), &mut reported);
                    reported.get(quantity) - 1.0
                })
                .collect();
            let mean = values.iter().sum::<f64>() / 2000.0;
            let deviation = (values.iter().map(|value| value.powi(2)).sum::<f64>() / 2000.0).sqrt();
            assert!(mean.abs() < 0.03 && (deviation / 0.3 - 1.0).abs() < 0.05, "{quantity:?}");
        }
    }

    #[test]
    fn a_gain_multiplies_from_zero_or_from_where_it_began() {
        for quantity in Quantity::ALL {
            let mut faults = SensorFaults::new(1);
            let at = healthy(quantity, SECOND);
            faults.begin(SECOND, quantity, SensorFault::Gain(-2.0), 9 * SECOND, &at);
            let mut reported = healthy(quantity, 3 * SECOND);
            faults.apply(3 * SECOND, &MODEL(), &mut reported);
            let expected = match quantity {
                Quantity::Yaw => 1.0 - 2.0 * 2.0,
                Quantity::Clock => 2048.0 + 1.0 - 2.0 * 2.0,
                _ => -6.0,
            };
            assert!((reported.get(quantity) - expected).abs() < 1e-9, "{quantity:?}");
        }
    }

    #[test]
    fn several_quantities_are_wrong_at_once_and_others_stay() {
        let mut faults = SensorFaults::new(1);
        let at = healthy(Quantity::Roll, SECOND);
        faults.begin(SECOND, Quantity::Yaw, SensorFault::Offset(170.0), SECOND, &at);
        faults.begin(SECOND, Quantity::Yaw, SensorFault::Offset(20.0), SECOND, &at);
        faults.begin(SECOND, Quantity::Clock, SensorFault::Offset(-1.0), SECOND, &at);
        let mut reported = at;
        faults.apply(SECOND, &MODEL(), &mut reported);
        assert!((reported.get(Quantity::Yaw) + 170.0).abs() < 1e-9, "headings turn round");
        assert!((reported.get(Quantity::Clock) - 2047.0).abs() < 1e-9, "and so does the clock");
        assert!((reported.get(Quantity::Roll) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn what_is_late_arrives_in_order_with_its_delay() {
        let mut faults = SensorFaults::new(1);
        let at = healthy(Quantity::Pitch, SECOND);
        faults.begin(SECOND, Quantity::Pitch, SensorFault::Late(SECOND / 2), 9 * SECOND, &at);
        for step in 0..100_u32 {
            let now = SECOND + SECOND / 10 * step;
            let mut reported = healthy(Quantity::Pitch, now);
            faults.apply(now, &MODEL(), &mut reported);
            let expected = if step < 90 { now.saturating_sub(SECOND / 2).max(SECOND) } else { now };
            assert!(
                (reported.get(Quantity::Pitch) - expected.as_secs_f64()).abs() < 1e-9,
                "{step}"
            );
        }
    }
}
