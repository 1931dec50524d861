//! How near vehicles came to each other in truth, and whose fault that was.
//!
//! Two in the air that are nearer to each other across than [`NEAREST_M`] are *too near*, however high they fly, but for:
//!
//! - *runaways*: one of the two cannot be steered by its pilot. The link to it is silent in one direction for more than 0.3 s,
//!   somebody else flies it, its motors are cut, or the wind is stronger than its airframe; then, for 2 s more, or until a
//!   landing that has begun meanwhile ends.
//! - *astray*: one of the two has had a wrong sensor, or tells a false place that nobody could notice, and the two are *not*
//!   too near by the places that they tell of themselves. What is taken off is the error of these places and nothing else: who
//!   flies too near by what is known has made a mistake, whatever is wrong with its sensors.

use std::fmt;
use std::time::Duration;

use nalgebra::{Vector2, Vector3};

/// No two in the air may be nearer to each other across, in truth.
pub const NEAREST_M: f64 = 0.8;

/// Two vehicles in the air, and how near they were to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// Their numbers.
    pub who: [usize; 2],
    /// When.
    pub at: Duration,
    /// Their distance across, in truth.
    pub across_m: f64,
    /// Their heights.
    pub heights_m: [f64; 2],
}

impl fmt::Display for Nearest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { who: [a, b], at, across_m, heights_m: [one_m, other_m] } = self;
        let (a, b, at_s) = (a + 1, b + 1, at.as_secs_f64());
        write!(
            f,
            "vehicles {a} and {b} {across_m:.2} m from each other after {at_s:.1} s, {one_m:.1} and {other_m:.1} m high"
        )
    }
}

/// The least distances of two vehicles in the air; none if there never were two.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Least {
    /// Of two for which there is no excuse.
    pub judged: Option<Nearest>,
    /// If one of them could not be steered.
    pub runaway: Option<Nearest>,
    /// If one of them was not where it could know that it was.
    pub astray: Option<Nearest>,
}

/// One vehicle in one tick.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    /// Its true place in the common frame.
    pub(super) place_m: Vector3<f64>,
    /// The place that it tells of itself, if a fault may have made it wrong unnoticed.
    pub(super) told_m: Option<Vector2<f64>>,
    /// Whether it is in the air.
    pub(super) is_up: bool,
    /// Whether its pilot cannot steer it.
    pub(super) is_lost: bool,
}

impl Least {
    /// Takes in all vehicles in one tick.
    pub(super) fn watch(&mut self, at: Duration, seen: &[Seen]) {
        for (b, other) in seen.iter().enumerate() {
            for (a, one) in seen.iter().enumerate().take(b) {
                if !one.is_up || !other.is_up {
                    continue;
                }
                let across_m = (one.place_m - other.place_m).xy().norm();
                let heights_m = [one.place_m.z, other.place_m.z];
                let known = self.of(one, other, across_m);
                if known.is_none_or(|known| across_m < known.across_m) {
                    *known = Some(Nearest { who: [a, b], at, across_m, heights_m });
                }
            }
        }
    }

    fn of(&mut self, one: &Seen, other: &Seen, across_m: f64) -> &mut Option<Nearest> {
        let told_m = |of: &Seen| of.told_m.unwrap_or(of.place_m.xy());
        let is_apart = (told_m(one) - told_m(other)).norm() >= NEAREST_M;
        if one.is_lost || other.is_lost {
            &mut self.runaway
        } else if across_m < NEAREST_M && is_apart {
            &mut self.astray
        } else {
            &mut self.judged
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x_m: f64) -> Seen {
        let place_m = Vector3::new(x_m, 0.0, 1.0);
        Seen { place_m, told_m: None, is_up: true, is_lost: false }
    }

    fn least(one: Seen, other: Seen) -> [Option<f64>; 3] {
        let mut least = Least::default();
        least.watch(Duration::ZERO, &[one, other]);
        [least.judged, least.runaway, least.astray].map(|near| near.map(|near| near.across_m))
    }

    #[test]
    fn only_the_error_of_a_told_place_and_a_lost_drone_excuse_two_that_are_too_near() {
        let told = |x_m, told_m| Seen { told_m: Some(Vector2::new(told_m, 0.0)), ..at(x_m) };
        assert_eq!(least(at(0.0), at(0.5)), [Some(0.5), None, None]);
        assert_eq!(least(at(0.0), Seen { is_up: false, ..at(0.5) }), [None; 3]);
        assert_eq!(least(at(0.0), Seen { is_lost: true, ..at(0.5) }), [None, Some(0.5), None]);
        assert_eq!(least(at(0.0), told(0.5, 0.9)), [None, None, Some(0.5)]);
        assert_eq!(least(at(0.0), told(0.5, 0.7)), [Some(0.5), None, None], "it knew");
        assert_eq!(least(told(0.0, 0.4), told(0.5, 0.9)), [Some(0.5), None, None], "both knew");
        assert_eq!(least(at(0.0), told(2.0, 0.1)), [Some(2.0), None, None], "in truth it is not");
    }
}
