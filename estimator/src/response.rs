//! Whether what is measured follows the commands: a sensor that is dead, or drifts by itself, shows
//! the same when the drone is told to move and when it is not.
//!
//! The airframe is not known for sure, and what is learnt of it comes from the same sensors. So the
//! measurement must show the least that any published airframe does, and what
//! [`crate::identification`] has learnt plays no part.

use nalgebra::Vector2;

use crate::airframe::{Airframe, DroneLimits};
use crate::angle::wrap_deg;
use crate::horizontal::world_from_body;
use crate::orders::{Order, Orders, Sticks};
use crate::trust::Quantity;

/// A longer gap than this is not judged: whether the drone heard its commands is not known.
const MAX_GAP_S: f64 = 0.3;
/// What is missing of the response is forgotten with this time constant.
const FORGET_S: f64 = 10.0;

/// Of an axis that follows its stick as a rate: climb and turn.
#[derive(Debug, Clone, Copy)]
struct RateTolerance {
    /// The least share of what is asked for that an airframe does.
    share: f64,
    /// Drift of a healthy sensor, and rates too small to judge, per second.
    slack: f64,
    /// What may be missing in all.
    missing: f64,
    /// A measurement further than this from the expected one, and this much more a second, has
    /// jumped, which is judged elsewhere.
    jump: f64,
    jump_1_s: f64,
}

/// Published airframes climb with 1 to 1.7 times what is asked for, with a lag of 0.17 to 1.25 s.
const CLIMB: RateTolerance =
    RateTolerance { share: 0.5, slack: 0.03, missing: 0.25, jump: 0.15, jump_1_s: 1.0 };
/// They turn with 0.7 to 1 times of it, with a lag of 0.02 to 0.5 s.
const TURN: RateTolerance =
    RateTolerance { share: 0.6, slack: 1.0, missing: 15.0, jump: 6.0, jump_1_s: 60.0 };

/// Sticks beyond this share of their limit ask for all that there is.
const FULL_STICK: f64 = 0.9;
/// After full sticks for this long, in seconds, the drone has moved, whatever airframe it is; where the
/// sticks are limited it takes longer in proportion.
const FULL_STICK_S: f64 = 1.2;
/// Speed along the sticks that counts as motion, or as having moved before.
const MOVED_M_S: f64 = 0.25;
/// Less than this moves no drone noticeably.
const MIN_STICK_LIMIT: f64 = 0.05;
/// Sticks that turn further than this (cosine) ask for another motion.
const SAME_DIRECTION: f64 = 0.7;

/// Compares commands with what is measured.
#[derive(Debug, Clone)]
pub(crate) struct Response {
    at_s: Option<f64>,
    climb: Rate,
    turn: Rate,
    push: Option<Push>,
    /// No stick is moved further than this.
    stick_limit: f64,
}

/// An axis on which the stick asks for a rate.
#[derive(Debug, Clone, Copy)]
struct Rate {
    tolerance: RateTolerance,
    /// What an ordinary airframe does, and the way of that since the flight began.
    now: f64,
    asked: f64,
    last: Option<f64>,
    missing: f64,
}

/// Full sticks across the ground.
#[derive(Debug, Clone, Copy)]
struct Push {
    direction: Vector2<f64>,
    /// The least speed along them so far: noise must not be taken for motion.
    least_m_s: f64,
    lasts_s: f64,
}

/// What was measured, at one moment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measured {
    pub(crate) at_s: f64,
    pub(crate) altitude_m: f64,
    /// Compass heading; jumps at ±180.
    pub(crate) yaw_deg: f64,
    /// Heading in the world.
    pub(crate) heading_deg: f64,
    /// (right, forward) in the body.
    pub(crate) velocity_m_s: Vector2<f64>,
}

impl Default for Response {
    fn default() -> Self {
        Self {
            at_s: None,
            climb: Rate::new(CLIMB),
            turn: Rate::new(TURN),
            push: None,
            stick_limit: 1.0,
        }
    }
}

impl Response {
    /// Takes in a measurement; returns the quantity that does not follow the commands.
    pub(crate) fn watch(
        &mut self,
        measured: &Measured,
        orders: &Orders,
        limits: &DroneLimits,
    ) -> Option<Quantity> {
        let from_s = self.at_s.replace(measured.at_s).unwrap_or(measured.at_s);
        let step_s = measured.at_s - from_s;
        let order = orders.at(measured.at_s);
        let Order::Sticks(sticks) = order else {
            self.rest(measured);
            return None;
        };
        if step_s > MAX_GAP_S {
            self.rest(measured);
            return None;
        }
        let airframe = Airframe::default();
        let (climb, turn) = (&mut self.climb, &mut self.turn);
        let (mut rise_m, mut turn_deg) = (0.0, 0.0);
        orders.steps(from_s, measured.at_s, |_, step_s, order| {
            let sticks = match order {
                Order::Sticks(sticks) => sticks,
                Order::ByItself => Sticks::default(),
            };
            rise_m += climb.follow(sticks.up * limits.climb_m_s, airframe.climb_lag_s, step_s);
            turn_deg +=
                turn.follow(sticks.clockwise * limits.turn_deg_s, airframe.turn_lag_s, step_s);
        });
        self.climb.compare(measured.altitude_m, rise_m, step_s, |difference| difference);
        self.turn.compare(measured.yaw_deg, turn_deg, step_s, wrap_deg);
        let stands_still = self.stands_still(measured, sticks, step_s);
        if stands_still {
            Some(Quantity::Velocity)
        } else if self.climb.is_missing() {
            Some(Quantity::Altitude)
        } else if self.turn.is_missing() {
            Some(Quantity::Heading)
        } else {
            None
        }
    }

    /// Climb that the sticks have asked for since the flight began.
    pub(crate) fn asked_rise_m(&self) -> f64 {
        self.climb.asked
    }

    /// Turn that they have asked for.
    pub(crate) fn asked_turn_deg(&self) -> f64 {
        self.turn.asked
    }

    /// No stick will be moved further than this share, from 0 to 1.
    pub(crate) fn limit_sticks(&mut self, most: f64) {
        self.stick_limit = most.clamp(MIN_STICK_LIMIT, 1.0);
    }

    /// The drone moves by itself: nothing is asked of it.
    fn rest(&mut self, measured: &Measured) {
        self.climb.rest(measured.altitude_m);
        self.turn.rest(measured.yaw_deg);
        self.push = None;
    }

    /// Whether full sticks have moved nothing. A wind that holds the drone still against them is
    /// reason enough to give up as well.
    fn stands_still(&mut self, measured: &Measured, sticks: Sticks, step_s: f64) -> bool {
        let body = Vector2::new(sticks.right, sticks.forward);
        if body.amax() < FULL_STICK * self.stick_limit {
            self.push = None;
            return false;
        }
        let direction = world_from_body(body.normalize(), measured.heading_deg);
        let speed_m_s =
            world_from_body(measured.velocity_m_s, measured.heading_deg).dot(&direction);
        let goes_on = |push: &Push| {
            push.direction.dot(&direction) >= SAME_DIRECTION
                && speed_m_s - push.least_m_s < MOVED_M_S
                && speed_m_s < MOVED_M_S
        };
        let fresh = Push { direction, least_m_s: speed_m_s, lasts_s: 0.0 };
        let mut push = self.push.filter(goes_on).unwrap_or(fresh);
        push.least_m_s = push.least_m_s.min(speed_m_s);
        push.lasts_s += step_s;
        self.push = Some(push);
        push.lasts_s * self.stick_limit >= FULL_STICK_S
    }
}

impl Rate {
    fn new(tolerance: RateTolerance) -> Self {
        Self { tolerance, now: 0.0, asked: 0.0, last: None, missing: 0.0 }
    }

    /// The way that an ordinary airframe makes in a step.
    fn follow(&mut self, wanted: f64, lag_s: f64, step_s: f64) -> f64 {
        let before = self.now;
        self.now += (wanted - self.now) * (1.0 - (-step_s / lag_s).exp());
        let way = f64::midpoint(before, self.now) * step_s;
        self.asked += way;
        way
    }

    fn compare(&mut self, value: f64, asked: f64, step_s: f64, difference: fn(f64) -> f64) {
        let Some(last) = self.last.replace(value) else { return };
        let RateTolerance { share, slack, jump, jump_1_s, .. } = self.tolerance;
        let moved = difference(value - last);
        if (moved - asked).abs() > jump + jump_1_s * step_s {
            return;
        }
        let lacking = asked.signum() * (share * asked - moved) - slack * step_s;
        self.missing = (self.missing * (-step_s / FORGET_S).exp() + lacking).max(0.0);
    }

    fn is_missing(&self) -> bool {
        self.missing > self.tolerance.missing
    }

    fn rest(&mut self, value: f64) {
        self.now = 0.0;
        self.missing = 0.0;
        self.last = Some(value);
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    const PERIOD_MS: u64 = 60;

    /// When a quantity is found not to follow the sticks, in seconds, within `seconds`.
    fn found(
        sticks: Sticks,
        seconds: u64,
        measured: impl Fn(f64) -> Measured,
    ) -> Option<(f64, Quantity)> {
        let mut orders = Orders::new(Duration::ZERO);
        let mut response = Response::default();
        let limits = DroneLimits::default();
        (0..1000 * seconds / PERIOD_MS).find_map(|i| {
            let now = Duration::from_millis(PERIOD_MS * i);
            orders.push(now, Order::Sticks(sticks));
            let at_s = now.as_secs_f64();
            response.watch(&measured(at_s), &orders, &limits).map(|quantity| (at_s, quantity))
        })
    }

    fn still(at_s: f64) -> Measured {
        Measured {
            at_s,
            altitude_m: 1.0,
            yaw_deg: 0.0,
            heading_deg: 0.0,
            velocity_m_s: Vector2::zeros(),
        }
    }

    #[test]
    fn a_drone_that_is_told_to_move_and_shows_no_motion_is_noticed_within_about_a_second() {
        let none = Sticks::default();
        let cases = [
            (Sticks { right: 1.0, ..none }, Quantity::Velocity),
            (Sticks { forward: -0.9, ..none }, Quantity::Velocity),
            (Sticks { up: 1.0, ..none }, Quantity::Altitude),
            (Sticks { up: -1.0, ..none }, Quantity::Altitude),
            (Sticks { clockwise: -0.6, ..none }, Quantity::Heading),
        ];
        for (sticks, quantity) in cases {
            let (at_s, which) = found(sticks, 5, still).unwrap();
            assert_eq!(which, quantity);
            assert!(at_s < 1.4, "{quantity}: {at_s}");
        }
        assert_eq!(found(none, 60, still), None);
    }

    #[test]
    fn a_drift_that_the_sticks_hide_is_noticed() {
        // The controller holds the height that it sees: it sinks as fast as the sensor says it climbs.
        let sinking = Sticks { up: -0.3, ..Sticks::default() };
        let (at_s, which) = found(sinking, 10, still).unwrap();
        assert!(which == Quantity::Altitude && at_s < 6.0, "{at_s}");
    }

    #[test]
    fn the_most_sluggish_airframes_are_not_accused() {
        let up = Sticks { up: 1.0, right: 1.0, clockwise: 0.6, ..Sticks::default() };
        let lag = |at_s: f64, lag_s: f64| at_s - lag_s * (1.0 - (-at_s / lag_s).exp());
        let sluggish = |at_s: f64| Measured {
            altitude_m: 1.0 + 0.7 * lag(at_s, 1.25),
            yaw_deg: wrap_deg(0.7 * 60.0 * lag(at_s, 0.5)),
            // Half of gravity's pull at full tilt, and the largest drag.
            velocity_m_s: Vector2::new(1.04 / 1.95 * (1.0 - (-1.95 * at_s).exp()), 0.0),
            ..still(at_s)
        };
        assert_eq!(found(up, 20, sluggish), None);
    }

    #[test]
    fn a_drone_that_leans_against_the_wind_is_not_accused() {
        let leaning = Sticks { right: 0.85, ..Sticks::default() };
        assert_eq!(found(leaning, 20, still), None);
    }

    #[test]
    fn a_jump_is_judged_elsewhere() {
        let stepping = |at_s: f64| Measured {
            altitude_m: 1.0 + 0.7 * at_s - if at_s > 1.0 { 0.8 } else { 0.0 },
            ..still(at_s)
        };
        let up = Sticks { up: 1.0, ..Sticks::default() };
        assert_eq!(found(up, 5, stepping), None);
    }
}
