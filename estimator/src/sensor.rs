//! What the sensors of an AR.Drone can measure, ranges and noise, and how well a model foretells it.

use crate::Sample;
use crate::trust::Quantity;

/// Above the top speed of an AR.Drone.
const MAX_SPEED_M_S: f64 = 8.0;
/// The ultrasound ends at 6 m; the pressure sensor goes on to what the firmware allows.
const MAX_ALTITUDE_M: f64 = 120.0;
/// A drone on the floor of a pit reads no lower.
const MIN_ALTITUDE_M: f64 = -1.0;
/// The firmware cuts the motors long before.
const MAX_TILT_RAD: f64 = 1.2;

/// What is further from what is expected than this many standard deviations is something else.
pub(crate) const GATE: f64 = 5.0;
/// Of two explanations one is the right one if what was measured is this many standard deviations from the other.
pub(crate) const CLEAR: f64 = 3.0;
/// White noise of the worse sensors, after their own filters: standard deviations.
pub(crate) const FLOW_M_S: f64 = 0.05;
pub(crate) const ULTRASOUND_M: f64 = 0.02;
pub(crate) const COMPASS_DEG: f64 = 0.3;
pub(crate) const ATTITUDE_DEG: f64 = 0.4;
/// Standard deviation of the orientation of a tag, chosen large because consecutive errors are correlated.
pub(crate) const ORIENTATION_DEG: f64 = 8.0;
/// Standard deviation of the flow's scale, as a fraction of the way.
pub(crate) const FLOW_SCALE: f64 = 0.06;
/// Standard deviation of a change that the model of the airframe makes of an order, as a fraction of the change.
pub(crate) const MODEL: f64 = 0.2;

/// The quantity of a sample whose value is impossible for an AR.Drone.
pub(crate) fn impossible(sample: &Sample) -> Option<Quantity> {
    let speed_m_s = sample.velocity_forward_m_s.hypot(sample.velocity_right_m_s);
    let tilt_rad = sample.roll_deg.abs().max(sample.pitch_deg.abs()).to_radians();
    let is_level_number = sample.roll_deg.is_finite() && sample.pitch_deg.is_finite();
    [
        (Quantity::Velocity, speed_m_s <= MAX_SPEED_M_S),
        (Quantity::Altitude, (MIN_ALTITUDE_M..=MAX_ALTITUDE_M).contains(&sample.altitude_m)),
        (Quantity::Heading, sample.yaw_deg.abs() <= 360.0),
        (Quantity::Attitude, is_level_number && tilt_rad <= MAX_TILT_RAD),
    ]
    .into_iter()
    .find_map(|(quantity, possible)| (!possible).then_some(quantity))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The quantity that is impossible after a change.
    fn with(change: impl Fn(&mut Sample)) -> Option<Quantity> {
        let mut sample = Sample { altitude_m: 1.0, airborne: true, ..Sample::default() };
        change(&mut sample);
        impossible(&sample)
    }

    #[test]
    fn what_no_drone_does_is_impossible() {
        assert_eq!(with(|_| ()), None);
        for bad in [f64::NAN, f64::INFINITY, 1e6, -500.0] {
            assert_eq!(with(|s| s.altitude_m = bad), Some(Quantity::Altitude));
            assert_eq!(with(|s| s.velocity_right_m_s = bad), Some(Quantity::Velocity));
            assert_eq!(with(|s| s.velocity_forward_m_s = bad), Some(Quantity::Velocity));
            assert_eq!(with(|s| s.roll_deg = bad), Some(Quantity::Attitude));
            assert_eq!(with(|s| s.pitch_deg = bad), Some(Quantity::Attitude));
            assert_eq!(with(|s| s.yaw_deg = bad), Some(Quantity::Heading));
        }
    }

    #[test]
    fn the_limits_of_an_ar_drone_are_still_possible() {
        for sign in [-1.0, 1.0] {
            for (possible, share) in [(true, 0.999), (false, 1.001)] {
                let expected = |quantity| (!possible).then_some(quantity);
                // 3, 4, 5: both components count.
                let m_s = sign * share * MAX_SPEED_M_S / 5.0;
                let found = with(|s| {
                    (s.velocity_forward_m_s, s.velocity_right_m_s) = (3.0 * m_s, 4.0 * m_s);
                });
                assert_eq!(found, expected(Quantity::Velocity));
                let tilt_deg = sign * share * MAX_TILT_RAD.to_degrees();
                assert_eq!(with(|s| s.roll_deg = tilt_deg), expected(Quantity::Attitude));
                assert_eq!(with(|s| s.pitch_deg = tilt_deg), expected(Quantity::Attitude));
                assert_eq!(with(|s| s.yaw_deg = sign * share * 360.0), expected(Quantity::Heading));
            }
        }
        for (altitude_m, possible) in [(-1.0, true), (-1.01, false), (120.0, true), (120.1, false)]
        {
            let found = with(|s| s.altitude_m = altitude_m);
            assert_eq!(found.is_none(), possible, "{altitude_m}");
        }
    }
}
