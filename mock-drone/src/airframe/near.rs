//! Airframes near a published one: what nobody tuned a pilot for.

use std::time::Duration;

use nalgebra::Vector2;
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use super::GRAVITY_M_S2;
use super::profile::{AttitudeLoop, Profile, Scaling, ThrustLaw};

/// Strongest published thrust by tilt; a rotor that holds the height has no more to give sideways.
const MOST_THRUST_M_S2: f64 = 10.15;
/// With less damping an attitude swings on for longer than any firmware lets it.
const LEAST_DAMPING: f64 = 0.5;

impl Profile {
    /// An airframe near this one: each parameter is multiplied by a number of its own, drawn by `seed` evenly from
    /// `1 - share` to `1 + share` (0.4 for 40 %; at most 1), and keeps its unit. Thrust and damping stay within what is a drone;
    /// a thrust that carries the weight becomes one by the sine of the tilt, of which gravity is multiplied. What is absent here
    /// (a lag, a limit, quadratic drag) is absent there.
    #[must_use]
    pub fn near(&self, seed: u64, share: f64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed ^ 0x6e65_6172);
        let mut vary = |value: f64, least: f64, most: f64| {
            let changed = value * (1.0 + share * random.random_range(-1.0..=1.0));
            changed.clamp(least, most)
        };
        let mut any = |value: f64| vary(value, 0.0, f64::INFINITY);
        let dead_time = Duration::from_secs_f64(any(self.dead_time.as_secs_f64()));
        let scaling = Scaling {
            tilt: any(self.scaling.tilt),
            tilt_limit_rad: any(self.scaling.tilt_limit_rad),
            climb: any(self.scaling.climb),
            drop: any(self.scaling.drop),
            turn: any(self.scaling.turn),
        };
        let linear_drag_1_s =
            Vector2::new(any(self.linear_drag_1_s.x), any(self.linear_drag_1_s.y));
        let quadratic_drag_1_m = any(self.quadratic_drag_1_m);
        let climb_time_constant_s = any(self.climb_time_constant_s);
        let turn_time_constant_s = any(self.turn_time_constant_s);
        let [roll, pitch] = [self.roll, self.pitch].map(|attitude| match attitude {
            AttitudeLoop::Immediate => AttitudeLoop::Immediate,
            AttitudeLoop::FirstOrder { rate_1_s } => {
                AttitudeLoop::FirstOrder { rate_1_s: vary(rate_1_s, 0.0, f64::INFINITY) }
            }
            AttitudeLoop::SecondOrder { frequency_rad_s, damping } => AttitudeLoop::SecondOrder {
                frequency_rad_s: vary(frequency_rad_s, 0.0, f64::INFINITY),
                damping: vary(damping, LEAST_DAMPING, f64::INFINITY),
            },
        });
        let mut thrust = |acceleration_m_s2| vary(acceleration_m_s2, 0.0, MOST_THRUST_M_S2);
        let thrust = match self.thrust {
            ThrustLaw::CarriesWeight => ThrustLaw::Sine { acceleration_m_s2: thrust(GRAVITY_M_S2) },
            ThrustLaw::Sine { acceleration_m_s2 } => {
                ThrustLaw::Sine { acceleration_m_s2: thrust(acceleration_m_s2) }
            }
            ThrustLaw::Linear { acceleration_m_s2 } => ThrustLaw::Linear {
                acceleration_m_s2: Vector2::new(
                    thrust(acceleration_m_s2.x),
                    thrust(acceleration_m_s2.y),
                ),
            },
        };
        Self {
            dead_time,
            scaling,
            roll,
            pitch,
            thrust,
            linear_drag_1_s,
            quadratic_drag_1_m,
            climb_time_constant_s,
            turn_time_constant_s,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHARE: f64 = 0.4;

    /// All numbers of a profile.
    fn numbers(profile: &Profile) -> Vec<f64> {
        let Scaling { tilt, tilt_limit_rad, climb, drop, turn } = profile.scaling;
        let mut numbers = vec![
            profile.dead_time.as_secs_f64(),
            tilt,
            tilt_limit_rad,
            climb,
            drop,
            turn,
            profile.linear_drag_1_s.x,
            profile.linear_drag_1_s.y,
            profile.quadratic_drag_1_m,
            profile.climb_time_constant_s,
            profile.turn_time_constant_s,
        ];
        for attitude in [profile.roll, profile.pitch] {
            match attitude {
                AttitudeLoop::Immediate => {}
                AttitudeLoop::FirstOrder { rate_1_s } => numbers.push(rate_1_s),
                AttitudeLoop::SecondOrder { frequency_rad_s, damping } => {
                    numbers.extend([frequency_rad_s, damping]);
                }
            }
        }
        match profile.thrust {
            ThrustLaw::CarriesWeight => numbers.push(GRAVITY_M_S2),
            ThrustLaw::Sine { acceleration_m_s2 } => numbers.push(acceleration_m_s2),
            ThrustLaw::Linear { acceleration_m_s2 } => numbers.extend(acceleration_m_s2.iter()),
        }
        numbers
    }

    #[test]
    fn each_number_of_an_airframe_nearby_differs_by_at_most_the_share() {
        for base in [Profile::rec(), Profile::tum(), Profile::tf(), Profile::leo()] {
            let published = numbers(&base);
            let mut furthest = vec![0.0_f64; published.len()];
            for seed in 0..300 {
                let near = base.near(seed, SHARE);
                for ((is, was), far) in numbers(&near).iter().zip(&published).zip(&mut furthest) {
                    if *was > 0.0 && was.is_finite() {
                        *far = far.max((is / was - 1.0).abs());
                    } else {
                        assert!(is.total_cmp(was).is_eq(), "{near:?}");
                    }
                }
            }
            let varied =
                published.iter().zip(furthest).filter(|(was, _)| **was > 0.0 && was.is_finite());
            for (was, far) in varied {
                assert!(far > 0.9 * SHARE && far <= SHARE + 1e-9, "{was}: {far} of {base:?}");
            }
        }
    }

    #[test]
    fn the_same_seed_is_the_same_airframe() {
        let near = |seed| Profile::tum().near(seed, SHARE);
        assert_eq!(near(7), near(7));
        assert_ne!(near(7), near(8));
        assert_eq!(near(7).near(1, 0.0), near(7));
    }

    #[test]
    fn what_is_no_drone_is_not_drawn() {
        for seed in 0..300 {
            let near = Profile::rec().near(seed, 0.9);
            assert!(
                matches!(near.thrust, ThrustLaw::Sine { acceleration_m_s2 } if acceleration_m_s2 <= MOST_THRUST_M_S2)
            );
            assert!(
                matches!(near.roll, AttitudeLoop::SecondOrder { damping, .. } if damping >= LEAST_DAMPING)
            );
        }
    }
}
