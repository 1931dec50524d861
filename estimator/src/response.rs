//! Checks that measurements follow the commands. A sensor that is dead or drifts shows the same whether or
//! not the drone is commanded to move.
//!
//! The airframe is not known exactly, and its identification uses the same sensors. A measurement therefore
//! has to show at least the response of the weakest published airframe; [`crate::identification`] is not
//! used.

use std::collections::VecDeque;

use nalgebra::Vector2;

use crate::orders::{Order, Orders};
use crate::trust::Quantity;
use kinematics::GRAVITY_M_S2;
use kinematics::Sticks;
use kinematics::wrap_deg;
use kinematics::{Airframe, DroneLimits};

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

/// The most sluggish airframe: the published ones accelerate with 0.5 to 1.03 of gravity's component at a
/// tilt, and their drag is 0.45 to 1.95 1/s.
const LEAST_THRUST: f64 = 0.4;
const LARGEST_DRAG_1_S: f64 = 1.95;
/// If the velocity of the weakest airframe would have varied this much (standard deviation) in this many
/// seconds, either quickly or slowly...
const AXIS_DEVIATION_M_S: f64 = 0.08;
const AXIS_WINDOWS_S: [f64; 2] = [3.0, 8.0];
/// ...a working flow shows more than this fraction of it, also while the drone compensates gusts; the noise
/// of a dead one is less.
const AXIS_SHARE: f64 = 0.3;
/// A drone that starts to tilt by this fraction of full tilt, and keeps it for a while, accelerates or
/// brakes. If it seems to stand this still (standard deviation, and mean), its flow is dead. A drone that has
/// been tilted for longer may hold its position in the wind.
const LEANS_SHARE: f64 = 0.8;
const LEANS_S: f64 = 2.0;
const LEVEL_SHARE: f64 = 0.0;
const LEVEL_S: f64 = 5.0;
const STILL_DEVIATION_M_S: f64 = 0.02;
const STILL_M_S: f64 = 0.04;
const SMOOTHING_S: f64 = 0.2;
const AXIS_INTERVAL_S: f64 = 0.05;
const AXIS_MEMORY: usize = 176;

/// Compares commands with measurements.
#[derive(Debug, Clone)]
pub(crate) struct Response {
    at_s: Option<f64>,
    climb: Rate,
    turn: Rate,
    axes: [Axis; 2],
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

/// Whether the measured velocity follows the measured tilt, along one body axis.
#[derive(Debug, Clone)]
struct Axis {
    /// Velocity that the most sluggish airframe would have from the tilt, in m/s.
    least_m_s: f64,
    /// The measured velocity, smoothed.
    measured_m_s: f64,
    recent: VecDeque<Moment>,
    /// The tilt moves the drone, but the velocity does not show it. Evaluated only for each moment that is
    /// kept, because full navdata come four times as often.
    is_dead: bool,
}

/// State of an axis at one moment of the last seconds.
#[derive(Debug, Clone, Copy)]
struct Moment {
    at_s: f64,
    tilt_rad: f64,
    least_m_s: f64,
    measured_m_s: f64,
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
        let (velocity_m_s, tilt_rad) = (measured.velocity_m_s, measured.tilt_rad);
        let (at_s, full_rad) = (measured.at_s, limits.tilt_rad);
        right.watch(at_s, step_s, velocity_m_s.x, tilt_rad.x, full_rad);
        forward.watch(at_s, step_s, velocity_m_s.y, tilt_rad.y, full_rad);
        if self.axes.iter().any(|axis| axis.is_dead) {
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
        self.axes.iter_mut().for_each(Axis::rest);
    }
}

impl Axis {
    fn new() -> Self {
        let recent = VecDeque::with_capacity(AXIS_MEMORY);
        Self { least_m_s: 0.0, measured_m_s: 0.0, recent, is_dead: false }
    }

    fn watch(
        &mut self,
        at_s: f64,
        step_s: f64,
        velocity_m_s: f64,
        tilt_rad: f64,
        full_tilt_rad: f64,
    ) {
        let pull_m_s2 = LEAST_THRUST * GRAVITY_M_S2 * tilt_rad.tan();
        self.least_m_s += (pull_m_s2 - LARGEST_DRAG_1_S * self.least_m_s) * step_s;
        let share = 1.0 - (-step_s / SMOOTHING_S).exp();
        self.measured_m_s += (velocity_m_s - self.measured_m_s) * share;
        if self.recent.back().is_none_or(|last| at_s - last.at_s >= AXIS_INTERVAL_S) {
            if self.recent.len() == AXIS_MEMORY {
                self.recent.pop_front();
            }
            let Self { least_m_s, measured_m_s, .. } = *self;
            self.recent.push_back(Moment { at_s, tilt_rad, least_m_s, measured_m_s });
            self.is_dead =
                self.misses_swings(at_s) || self.stands_while_leaning(at_s, full_tilt_rad);
        }
    }

    /// The moments of the last `window_s` seconds.
    fn within(&self, at_s: f64, window_s: f64) -> impl ExactSizeIterator<Item = &Moment> + Clone {
        let first = self.recent.partition_point(|then| at_s - then.at_s > window_s);
        self.recent.range(first..)
    }

    /// The tilt varies, and the velocity does not. A steady wind varies neither.
    fn misses_swings(&self, at_s: f64) -> bool {
        AXIS_WINDOWS_S.iter().any(|window_s| {
            let recent = self.within(at_s, *window_s);
            let expected_m_s = deviation(recent.clone().map(|moment| moment.least_m_s));
            let measured_m_s = deviation(recent.map(|moment| moment.measured_m_s));
            expected_m_s >= AXIS_DEVIATION_M_S && measured_m_s < AXIS_SHARE * expected_m_s
        })
    }

    /// The drone has started to tilt, and does not move.
    fn stands_while_leaning(&self, at_s: f64, full_tilt_rad: f64) -> bool {
        let recent = self.within(at_s, LEANS_S);
        let Some(first) = recent.clone().next() else { return false };
        let lasts = at_s - first.at_s >= LEANS_S - 2.0 * AXIS_INTERVAL_S;
        let lean = |moment: &Moment| moment.tilt_rad * first.tilt_rad.signum() / full_tilt_rad;
        let leans = recent.clone().all(|moment| lean(moment) >= LEANS_SHARE);
        let was_level = self.within(at_s, LEVEL_S).any(|moment| lean(moment) <= LEVEL_SHARE);
        let measured = recent.map(|moment| moment.measured_m_s);
        let stands =
            mean(measured.clone()).abs() < STILL_M_S && deviation(measured) < STILL_DEVIATION_M_S;
        lasts && leans && was_level && stands
    }

    fn rest(&mut self) {
        self.least_m_s = 0.0;
        self.measured_m_s = 0.0;
        self.recent.clear();
        self.is_dead = false;
    }
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    values.sum::<f64>() / count
}

/// Standard deviation.
fn deviation(values: impl ExactSizeIterator<Item = f64> + Clone) -> f64 {
    let count = values.len().max(1) as f64;
    let mean = mean(values.clone());
    (values.map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt()
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
