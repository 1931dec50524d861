//! Exact repetitions of a value: a sensor that works never measures the very same for long.

use crate::Sample;
use crate::trust::Quantity;

/// How long a quantity with noise of its own must repeat one value: the flow has 40 to 80 mm/s.
const NOISY_S: f64 = 0.4;
/// The altitude has a resolution of one millimetre and the attitude of a thousandth of a degree, so in a
/// quiet hover they may repeat a value for a while.
const QUIET_S: f64 = 1.0;
/// Least number of packets that repeat the value, because loss makes the time between packets long; and that repeat all values,
/// which no two sensors do by chance.
const PACKETS: u32 = 5;
const PACKETS_OF_ALL: u32 = 2;

/// The repetitions of all values in navdata.
#[derive(Debug, Clone, Default)]
pub(crate) struct Repetitions {
    values: [Repetition; 6],
}

/// Counts exact repetitions of a value.
#[derive(Debug, Clone, Copy, Default)]
struct Repetition {
    value: Option<f64>,
    count: u32,
    since_s: f64,
}

impl Repetitions {
    /// Adds a packet that arrived at a time. Returns a quantity that repeats its value for too long, and since when, of those
    /// that may not rest.
    pub(crate) fn watch(
        &mut self,
        at_s: f64,
        sample: &Sample,
        may_rest: impl Fn(Quantity) -> bool,
    ) -> Option<(Quantity, f64)> {
        let values = [
            (Quantity::Velocity, sample.velocity_right_m_s),
            (Quantity::Velocity, sample.velocity_forward_m_s),
            (Quantity::Altitude, sample.altitude_m),
            (Quantity::Heading, sample.yaw_deg),
            (Quantity::Attitude, sample.roll_deg),
            (Quantity::Attitude, sample.pitch_deg),
        ];
        for ((_, value), repetition) in values.into_iter().zip(&mut self.values) {
            repetition.watch(at_s, value, sample.airborne);
        }
        let all_repeat = self.values.iter().all(|repetition| repetition.count >= PACKETS_OF_ALL);
        let packets = if all_repeat { PACKETS_OF_ALL } else { PACKETS };
        let mut repeated = None;
        for ((quantity, _), repetition) in values.into_iter().zip(&self.values) {
            let is_flow = quantity == Quantity::Velocity;
            let patience_s = if is_flow { NOISY_S } else { QUIET_S };
            let lasts = at_s - repetition.since_s >= patience_s && repetition.count >= packets;
            if lasts && !may_rest(quantity) {
                repeated = repeated.or(Some((quantity, repetition.since_s)));
            }
        }
        repeated
    }
}

impl Repetition {
    /// A drone on the ground may report constant values.
    fn watch(&mut self, at_s: f64, value: f64, airborne: bool) {
        if self.value == Some(value) && airborne {
            self.count += 1;
        } else {
            *self = Self { value: Some(value), count: 0, since_s: at_s };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PACKET_S: f64 = 0.05;

    /// All quantities vary slightly.
    fn flying(packet: u32) -> Sample {
        let wobble = 0.001 * f64::from(packet % 7);
        Sample {
            yaw_deg: 10.0 + wobble,
            roll_deg: wobble,
            pitch_deg: -wobble,
            velocity_forward_m_s: wobble,
            velocity_right_m_s: 0.2 - wobble,
            altitude_m: 1.0 + wobble,
            airborne: true,
            ..Sample::default()
        }
    }

    /// The packet with which a repetition is noticed, of which quantity, and since when.
    fn noticed(
        packets: impl IntoIterator<Item = u32>,
        sample: impl Fn(u32) -> Sample,
    ) -> Option<(u32, Quantity, f64)> {
        let mut repetitions = Repetitions::default();
        packets.into_iter().find_map(|packet| {
            let found = repetitions.watch(PACKET_S * f64::from(packet), &sample(packet), |_| false);
            found.map(|(quantity, since_s)| (packet, quantity, since_s))
        })
    }

    #[test]
    fn one_quantity_that_repeats_its_value_is_noticed() {
        type Freeze = fn(&mut Sample);
        let still: [(Quantity, Freeze, u32); 6] = [
            (Quantity::Velocity, |s| s.velocity_forward_m_s = 0.0, 8),
            (Quantity::Velocity, |s| s.velocity_right_m_s = 1.2, 8),
            (Quantity::Altitude, |s| s.altitude_m = 1.0, 20),
            (Quantity::Heading, |s| s.yaw_deg = 3.0, 20),
            (Quantity::Attitude, |s| s.roll_deg = 3.0, 20),
            (Quantity::Attitude, |s| s.pitch_deg = 3.0, 20),
        ];
        for (quantity, freeze, patience) in still {
            let sample = |packet| {
                let mut sample = flying(packet);
                if packet >= 100 {
                    freeze(&mut sample);
                }
                sample
            };
            let expected = (100 + patience, quantity, 100.0 * PACKET_S);
            assert_eq!(noticed(0..150, sample), Some(expected));
        }
        assert_eq!(noticed(0..150, flying), None);
    }

    #[test]
    fn it_takes_five_packets_because_loss_makes_the_time_between_them_long() {
        let still = |packet| Sample { velocity_right_m_s: 0.3, ..flying(packet) };
        let packet = noticed((0..100).step_by(4), still).map(|(packet, ..)| packet);
        assert_eq!(packet, Some(20));
    }

    #[test]
    fn a_packet_in_which_nothing_changes_is_noticed_with_the_second() {
        let packet = noticed((0..100).step_by(5), |_| flying(3)).map(|(packet, ..)| packet);
        assert_eq!(packet, Some(10));
    }

    #[test]
    fn a_drone_on_the_ground_may_stand_still() {
        assert_eq!(noticed(0..100, |_| Sample::default()), None);
    }
}
