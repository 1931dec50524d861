//! Stick positions as directions of flight.

use crate::at::{Fraction, Motion};

/// Stick positions, each as a fraction in \[-1, 1\] of the limit configured in the drone. Larger values are
/// clamped, and NaN is treated as zero.
///
/// ```
/// use ardrone_link::Steering;
///
/// let backwards_and_up = Steering { forward: -0.1, up: 0.2, ..Steering::default() };
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Steering {
    /// Fraction of [`crate::Setting::EulerAngleMaxDeg`]; negative flies backward.
    pub forward: f64,
    /// Fraction of [`crate::Setting::EulerAngleMaxDeg`]; negative flies left.
    pub right: f64,
    /// Fraction of [`crate::Setting::ClimbMaxMS`]; negative descends.
    pub up: f64,
    /// Fraction of [`crate::Setting::YawRateMaxDegS`], seen from above; negative turns anticlockwise.
    pub clockwise: f64,
}

impl Steering {
    /// Forward only.
    #[must_use]
    pub fn forward(fraction: f64) -> Self {
        Self { forward: fraction, ..Self::default() }
    }

    /// To the right only.
    #[must_use]
    pub fn right(fraction: f64) -> Self {
        Self { right: fraction, ..Self::default() }
    }

    /// Up only.
    #[must_use]
    pub fn up(fraction: f64) -> Self {
        Self { up: fraction, ..Self::default() }
    }

    /// A turn on the spot, clockwise seen from above.
    #[must_use]
    pub fn clockwise(fraction: f64) -> Self {
        Self { clockwise: fraction, ..Self::default() }
    }

    /// The PCMD arguments. All zeros mean hover, because level sticks alone would let the drone drift.
    pub(super) fn motion(self) -> Motion {
        let [roll, pitch, gaz, yaw] =
            [self.right, -self.forward, self.up, self.clockwise].map(Fraction::saturating);
        if [roll, pitch, gaz, yaw] == [Fraction::ZERO; 4] {
            return Motion::Hover;
        }
        Motion::Progressive { roll, pitch, gaz, yaw }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forward_is_negative_pitch_and_nothing_is_a_hover() {
        let fraction = |value: f32| Fraction::new(value).unwrap();
        let steering = Steering { forward: 0.5, right: -0.25, up: 7.0, clockwise: f64::NAN };
        let expected = Motion::Progressive {
            roll: fraction(-0.25),
            pitch: fraction(-0.5),
            gaz: fraction(1.0),
            yaw: Fraction::ZERO,
        };
        assert_eq!(steering.motion(), expected);
        assert_eq!(Steering::default().motion(), Motion::Hover);
        assert_eq!(Steering::clockwise(-0.0).motion(), Motion::Hover);
    }
}
