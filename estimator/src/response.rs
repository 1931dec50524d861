//! Checks that measurements follow the commands. A sensor that is dead or drifts shows the same whether or
//! not the drone is commanded to move.
//!
//! The airframe is not known exactly, and its identification uses the same sensors. A measurement therefore
//! has to show at least the response of the weakest published airframe; [`crate::identification`] is not
//! used.

use nalgebra::Vector2;

use self::axis::Axis;
use crate::orders::{Order, Orders};
use crate::trust::Quantity;
use kinematics::Sticks;
use kinematics::wrap_deg;
use kinematics::{Airframe, DroneLimits};

mod axis;

/// Gaps longer than this are not judged, because it is unknown whether the drone received its commands.
const MAX_GAP_S: f64 = 0.3;
/// Time constant with which a missing response to a rate is forgotten.
const FORGET_S: f64 = 10.0;
/// Below this fraction of full stick the gains of the airframe make no difference, and neither do its lags
/// once the command has been this slow for this long.
const SLOW_SHARE: f64 = 0.35;
const SLOW_TIME_S: f64 = 2.0;
/// A drone that was commanded this fraction of full stick the other way may still be braking for this long.
const FAST_SHARE: f64 = 0.2;
const BRAKING_TIME_S: f64 = 2.0;
/// How long a response must be missing.
const MISSING_TIME_S: f64 = 0.12;

/// Tolerances of an axis that follows its stick as a rate: climb and turn.
#[derive(Debug, Clone, Copy)]
struct RateTolerance {
    /// Smallest fraction of the commanded rate that an airframe achieves.
    share: f64,
    /// Drift of a healthy sensor, and rates too small to judge, per second.
    slack: f64,
    /// Tolerated missing response in total: to all commands, and to slow commands.
    missing: f64,
    missing_slowly: f64,
    /// Largest gain of an airframe for a negative rate.
    most_down: f64,
    /// A measurement further than this from the expected one, plus this much per second, has jumped; jumps
    /// are judged elsewhere.
    jump: f64,
    jump_1_s: f64,
}

/// Published airframes climb with 1 to 1.7 times the commanded rate, with a lag of 0.17 to 1.25 s. A fraction
/// of one half would let an altitude that drifts down by 0.2 m/s raise the drone by 1.7 m.
const CLIMB: RateTolerance = RateTolerance {
    share: 0.6,
    slack: 0.03,
    missing: 0.3,
    missing_slowly: 0.5,
    most_down: 1.7,
    jump: 0.1,
    jump_1_s: 1.0,
};
/// Published airframes turn with 0.7 to 1 times the commanded rate, with a lag of 0.02 to 0.5 s.
const TURN: RateTolerance = RateTolerance {
    share: 0.6,
    slack: 1.0,
    missing: 15.0,
    missing_slowly: 20.0,
    most_down: 1.0,
    jump: 6.0,
    jump_1_s: 60.0,
};

/// Compares commands with measurements.
#[derive(Debug, Clone)]
pub(crate) struct Response {
    at_s: Option<f64>,
    climb: Rate,
    turn: Rate,
    axes: [Axis; 2],
    /// Heading of the body that the axes are those of.
    yaw_deg: f64,
}

/// An axis on which the stick asks for a rate.
#[derive(Debug, Clone, Copy)]
struct Rate {
    tolerance: RateTolerance,
    /// Rate of an ordinary airframe, and its integral since the flight began.
    now: f64,
    asked: f64,
    last: Option<f64>,
    missing: f64,
    /// For an ordinary response to a negative rate, and for the strongest.
    missing_slowly: [f64; 2],
    slow_for_s: f64,
    /// Time since the drone was last commanded to move fast: down and up, or left and right.
    fast_ago_s: [f64; 2],
    missing_for_s: f64,
}

/// The measurements of one moment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measured {
    pub(crate) at_s: f64,
    /// Height above the floor, without wrong echoes.
    pub(crate) altitude_m: f64,
    /// Heading, without the steps of the compass.
    pub(crate) yaw_deg: f64,
    /// (right, forward) in the body.
    pub(crate) velocity_m_s: Vector2<f64>,
    /// (right, forward) in the body.
    pub(crate) tilt_rad: Vector2<f64>,
}

impl Default for Response {
    fn default() -> Self {
        Self {
            at_s: None,
            climb: Rate::new(CLIMB),
            turn: Rate::new(TURN),
            axes: [Axis::new(), Axis::new()],
            yaw_deg: 0.0,
        }
    }
}

impl Response {
    /// Processes a measurement. Returns the quantity that does not follow the commands.
    pub(crate) fn watch(
        &mut self,
        measured: &Measured,
        orders: &Orders,
        limits: &DroneLimits,
    ) -> Option<Quantity> {
        let from_s = self.at_s.replace(measured.at_s).unwrap_or(measured.at_s);
        let step_s = measured.at_s - from_s;
        if orders.at(measured.at_s) == Order::ByItself || step_s > MAX_GAP_S {
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
            rise_m += climb.follow(sticks.gaz * limits.climb_m_s, airframe.climb_lag_s, step_s);
            turn_deg += turn.follow(sticks.yaw * limits.turn_deg_s, airframe.turn_lag_s, step_s);
        });
        let DroneLimits { climb_m_s, turn_deg_s, .. } = *limits;
        self.climb.compare(measured.altitude_m, rise_m, step_s, climb_m_s, |metres| metres);
        self.turn.compare(measured.yaw_deg, turn_deg, step_s, turn_deg_s, wrap_deg);
        let [right, forward] = &mut self.axes;
        let turned_deg = measured.yaw_deg - std::mem::replace(&mut self.yaw_deg, measured.yaw_deg);
        Axis::turn(right, forward, turned_deg);
        let (velocity_m_s, tilt_rad) = (measured.velocity_m_s, measured.tilt_rad);
        let (at_s, full_rad) = (measured.at_s, limits.tilt_rad);
        right.watch(at_s, step_s, velocity_m_s.x, tilt_rad.x, full_rad);
        forward.watch(at_s, step_s, velocity_m_s.y, tilt_rad.y, full_rad);
        if self.axes.iter().any(Axis::is_dead) {
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

    /// Turn that the sticks have asked for since the flight began.
    pub(crate) fn asked_turn_deg(&self) -> f64 {
        self.turn.asked
    }

    /// The drone moves autonomously: nothing is commanded.
    fn rest(&mut self, measured: &Measured) {
        self.climb.rest(measured.altitude_m);
        self.turn.rest(measured.yaw_deg);
        self.yaw_deg = measured.yaw_deg;
        self.axes.iter_mut().for_each(Axis::rest);
    }
}

impl Rate {
    fn new(tolerance: RateTolerance) -> Self {
        Self {
            tolerance,
            now: 0.0,
            asked: 0.0,
            last: None,
            missing: 0.0,
            missing_slowly: [0.0; 2],
            slow_for_s: 0.0,
            fast_ago_s: [f64::INFINITY; 2],
            missing_for_s: 0.0,
        }
    }

    /// Integral of the rate of an ordinary airframe over a step.
    fn follow(&mut self, wanted: f64, lag_s: f64, step_s: f64) -> f64 {
        let before = self.now;
        self.now += (wanted - self.now) * (1.0 - (-step_s / lag_s).exp());
        let way = f64::midpoint(before, self.now) * step_s;
        self.asked += way;
        way
    }

    fn compare(
        &mut self,
        value: f64,
        asked: f64,
        step_s: f64,
        full: f64,
        difference: fn(f64) -> f64,
    ) {
        let Some(last) = self.last.replace(value) else { return };
        let RateTolerance { share, slack, jump, jump_1_s, most_down, .. } = self.tolerance;
        let moved = difference(value - last);
        if (moved - asked).abs() > jump + jump_1_s * step_s {
            return;
        }
        let forgotten = (-step_s / FORGET_S).exp();
        let lacking = asked.signum() * (share * asked - moved) - slack * step_s;
        let [down_ago_s, up_ago_s] = &mut self.fast_ago_s;
        *down_ago_s = if self.now < -FAST_SHARE * full { 0.0 } else { *down_ago_s + step_s };
        *up_ago_s = if self.now > FAST_SHARE * full { 0.0 } else { *up_ago_s + step_s };
        let other_ago_s = if asked > 0.0 { *down_ago_s } else { *up_ago_s };
        let lacking = if other_ago_s < BRAKING_TIME_S { 0.0 } else { lacking };
        self.missing = (self.missing * forgotten + lacking).max(0.0);
        self.missing_slowly = self.missing_slowly.map(|missing| missing * forgotten);
        let is_slow = self.now.abs() < SLOW_SHARE * full;
        self.slow_for_s = if is_slow { self.slow_for_s + step_s } else { 0.0 };
        if self.slow_for_s > SLOW_TIME_S {
            // A drone that descends faster than it climbs needs more up than down to keep its height.
            let most = if asked < 0.0 { most_down * asked } else { asked };
            self.missing_slowly[0] += asked - moved;
            self.missing_slowly[1] += most - moved;
        }
        let RateTolerance { missing, missing_slowly, .. } = self.tolerance;
        let [ordinary, most] = self.missing_slowly;
        let alike = ordinary.signum() == most.signum();
        let slowly = alike && ordinary.abs().min(most.abs()) > missing_slowly;
        let is_missing = self.missing > missing || slowly;
        self.missing_for_s = if is_missing { self.missing_for_s + step_s } else { 0.0 };
    }

    /// One wrong echo may look like it.
    fn is_missing(&self) -> bool {
        self.missing_for_s >= MISSING_TIME_S
    }

    fn rest(&mut self, value: f64) {
        self.now = 0.0;
        self.missing = 0.0;
        self.missing_slowly = [0.0; 2];
        self.slow_for_s = 0.0;
        self.fast_ago_s = [f64::INFINITY; 2];
        self.missing_for_s = 0.0;
        self.last = Some(value);
    }
}

#[cfg(test)]
mod tests;
