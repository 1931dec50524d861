//! Whether navdata can be believed.

use std::fmt;

use crate::Sample;

/// Whether navdata can be believed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Trust {
    /// They look like those of a drone that flies.
    #[default]
    Sound,
    /// Packets keep coming, but what they say does not change: the drone's own computer or sensors
    /// hang.
    Frozen,
    /// They say what no AR.Drone does.
    Implausible,
}

impl fmt::Display for Trust {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Sound => "sound",
            Self::Frozen => "frozen",
            Self::Implausible => "implausible",
        })
    }
}

/// Faster is no AR.Drone.
const MAX_SPEED_M_S: f64 = 8.0;
/// The ultrasound ends at 6 m; the pressure goes on to what the firmware allows.
const MAX_ALTITUDE_M: f64 = 120.0;
/// The firmware cuts the motors long before.
const MAX_TILT_RAD: f64 = 1.2;
/// What is wrong or the same for so long is told.
const PATIENCE_S: f64 = 0.4;
/// So many packets must say the same.
const SAME_PACKETS: u32 = 5;
/// A velocity further than this from the expected one is wrong.
const MAX_SURPRISE_M_S: f64 = 1.5;

/// Watches what navdata say.
#[derive(Debug, Clone, Default)]
pub(crate) struct Plausibility {
    last: Option<Values>,
    same: u32,
    same_since_s: f64,
    wrong_since_s: Option<f64>,
    trust: Trust,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Values([f64; 6]);

impl Values {
    fn of(sample: &Sample) -> Self {
        Self([
            sample.yaw_deg,
            sample.velocity_forward_m_s,
            sample.velocity_right_m_s,
            sample.altitude_m,
            sample.roll_deg,
            sample.pitch_deg,
        ])
    }
}

/// Whether the values of a sample are possible at all.
pub(crate) fn is_possible(sample: &Sample) -> bool {
    let Values(values) = Values::of(sample);
    let speed_m_s = sample.velocity_forward_m_s.hypot(sample.velocity_right_m_s);
    let tilt_rad = sample.roll_deg.abs().max(sample.pitch_deg.abs()).to_radians();
    values.iter().all(|value| value.is_finite())
        && speed_m_s <= MAX_SPEED_M_S
        && (-1.0..=MAX_ALTITUDE_M).contains(&sample.altitude_m)
        && tilt_rad <= MAX_TILT_RAD
        && sample.yaw_deg.abs() <= 360.0
}

/// Whether a velocity so far from the expected one can be.
pub(crate) fn is_foreseeable(surprise_m_s: f64) -> bool {
    surprise_m_s <= MAX_SURPRISE_M_S
}

impl Plausibility {
    /// Looks at a sample that was made at a time; `believed` tells whether it was used.
    pub(crate) fn watch(&mut self, at_s: f64, sample: &Sample, believed: bool) {
        let values = Values::of(sample);
        if self.last == Some(values) && sample.airborne {
            self.same += 1;
        } else {
            self.same = 0;
            self.same_since_s = at_s;
        }
        self.last = Some(values);
        self.wrong_since_s = if believed { None } else { self.wrong_since_s.or(Some(at_s)) };
        let frozen = self.same >= SAME_PACKETS && at_s - self.same_since_s >= PATIENCE_S;
        let implausible = self.wrong_since_s.is_some_and(|since_s| at_s - since_s >= PATIENCE_S);
        self.trust = match (implausible, frozen) {
            (true, _) => Trust::Implausible,
            (false, true) => Trust::Frozen,
            (false, false) => Trust::Sound,
        };
    }

    pub(crate) fn trust(&self) -> Trust {
        self.trust
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flying(step: u32) -> Sample {
        Sample {
            altitude_m: 1.0 + 0.001 * f64::from(step % 7),
            airborne: true,
            ..Sample::default()
        }
    }

    #[test]
    fn packets_that_say_the_same_for_long_are_frozen() {
        let mut plausibility = Plausibility::default();
        for step in 0..100 {
            plausibility.watch(0.066 * f64::from(step), &flying(step), true);
            assert_eq!(plausibility.trust(), Trust::Sound);
        }
        for step in 100..120 {
            plausibility.watch(0.066 * f64::from(step), &flying(3), true);
            assert_eq!(plausibility.trust() == Trust::Frozen, step > 106, "{step}");
        }
        plausibility.watch(8.0, &flying(2), true);
        assert_eq!(plausibility.trust(), Trust::Sound);
    }

    #[test]
    fn a_drone_on_the_ground_may_stand_still() {
        let mut plausibility = Plausibility::default();
        for step in 0..100 {
            plausibility.watch(0.066 * f64::from(step), &Sample::default(), true);
        }
        assert_eq!(plausibility.trust(), Trust::Sound);
    }

    #[test]
    fn what_no_drone_does_is_not_possible() {
        assert!(is_possible(&flying(0)));
        for bad in [f64::NAN, f64::INFINITY, 1e6, -500.0] {
            assert!(!is_possible(&Sample { altitude_m: bad, ..flying(0) }));
            assert!(!is_possible(&Sample { velocity_right_m_s: bad, ..flying(0) }));
            assert!(!is_possible(&Sample { roll_deg: bad, ..flying(0) }));
            assert!(!is_possible(&Sample { yaw_deg: bad, ..flying(0) }));
        }
        let mut plausibility = Plausibility::default();
        plausibility.watch(0.0, &flying(0), false);
        assert_eq!(plausibility.trust(), Trust::Sound, "one packet is no reason to worry");
        plausibility.watch(0.5, &flying(1), false);
        assert_eq!(plausibility.trust(), Trust::Implausible);
    }
}
