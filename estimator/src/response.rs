//! Checks that measurements follow the commands. A sensor that is dead or drifts shows the same whether or
//! not the drone is commanded to move.
//!
//! The airframe is not known exactly, and its identification uses the same sensors. A measurement therefore
//! has to show at least the response of an airframe somewhat weaker than the published ones; [`crate::identification`] is not
//! used.

use nalgebra::Vector2;

use self::axis::Axis;
use self::rate::{Rate, Tolerance};
use crate::orders::{Order, Orders};
use crate::silence::GAP_S;
use crate::trust::Quantity;
use kinematics::Sticks;
use kinematics::wrap_deg;
use kinematics::{Airframe, DroneLimits};

mod axis;
mod rate;

/// An airframe that nobody published may differ from the published ones by this share of what they have.
const UNPUBLISHED: f64 = 0.4;
/// From the least of the published values to the largest, and beyond.
const fn with_unpublished([least, largest]: [f64; 2]) -> [f64; 2] {
    [(1.0 - UNPUBLISHED) * least, (1.0 + UNPUBLISHED) * largest]
}

/// What drifts faster than the slack misses the response; 0.2 m/s may raise the drone by 1 m.
const CLIMB: Tolerance = Tolerance {
    gains: with_unpublished(Airframe::CLIMBS),
    down: Airframe::STRONGEST_DROP,
    slack: 0.01,
    enough: 0.15,
};
const TURN: Tolerance =
    Tolerance { gains: with_unpublished(Airframe::TURNS), down: 1.0, slack: 1.0, enough: 10.0 };

/// The lag of an ordinary airframe, and the extremes.
fn with_extremes(ordinary_s: f64, published_s: [f64; 2]) -> [f64; 3] {
    let [shortest_s, longest_s] = with_unpublished(published_s);
    [ordinary_s, shortest_s, longest_s]
}

/// Compares commands with measurements.
#[derive(Debug, Clone)]
pub(crate) struct Response {
    at_s: Option<f64>,
    climb: Rate<3>,
    turn: Rate<3>,
    axes: [Axis; 2],
    /// Heading of the body that the axes are those of.
    yaw_deg: f64,
}

/// The measurements of one moment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measured {
    pub(crate) at_s: f64,
    /// Height, without wrong echoes and steps of the floor.
    pub(crate) altitude_m: f64,
    /// Heading, without the steps of the compass.
    pub(crate) yaw_deg: f64,
    /// (right, forward) in the body.
    pub(crate) velocity_m_s: Vector2<f64>,
    /// (right, forward) in the body.
    pub(crate) tilt_rad: Vector2<f64>,
}

impl Response {
    pub(crate) fn new() -> Self {
        let airframe = Airframe::default();
        Self {
            at_s: None,
            climb: Rate::new(CLIMB, with_extremes(airframe.climb_lag_s, Airframe::CLIMB_LAGS_S)),
            turn: Rate::new(TURN, with_extremes(airframe.turn_lag_s, Airframe::TURN_LAGS_S)),
            axes: [Axis::new(), Axis::new()],
            yaw_deg: 0.0,
        }
    }

    /// Processes a measurement. Returns the quantity that does not follow the commands.
    pub(crate) fn watch(
        &mut self,
        measured: &Measured,
        orders: &Orders,
        limits: &DroneLimits,
    ) -> Option<Quantity> {
        let from_s = self.at_s.replace(measured.at_s).unwrap_or(measured.at_s);
        let step_s = measured.at_s - from_s;
        if orders.at(measured.at_s) == Order::ByItself || step_s > GAP_S {
            self.rest(measured);
            return None;
        }
        let (climb, turn) = (&mut self.climb, &mut self.turn);
        orders.steps(from_s, measured.at_s, |_, step_s, order| {
            let sticks = match order {
                Order::Sticks(sticks) => sticks,
                Order::ByItself => Sticks::default(),
            };
            climb.follow(sticks.gaz * limits.climb_m_s, step_s);
            turn.follow(sticks.yaw * limits.turn_deg_s, step_s);
        });
        climb.compare(measured.altitude_m, step_s, |metres| metres);
        turn.compare(measured.yaw_deg, step_s, wrap_deg);
        let [right, forward] = &mut self.axes;
        let turned_deg = measured.yaw_deg - std::mem::replace(&mut self.yaw_deg, measured.yaw_deg);
        Axis::turn(right, forward, turned_deg);
        let (velocity_m_s, tilt_rad) = (measured.velocity_m_s, measured.tilt_rad);
        let at_s = measured.at_s;
        right.watch(at_s, step_s, velocity_m_s.x, tilt_rad.x, limits.tilt_rad);
        forward.watch(at_s, step_s, velocity_m_s.y, tilt_rad.y, limits.tilt_rad);
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

    /// The drone moves autonomously: nothing is commanded.
    fn rest(&mut self, measured: &Measured) {
        self.climb.rest(Some(measured.altitude_m));
        self.turn.rest(Some(measured.yaw_deg));
        self.yaw_deg = measured.yaw_deg;
        self.axes.iter_mut().for_each(Axis::rest);
    }

    /// The drone stands, and may be anywhere when it is next seen to fly.
    pub(crate) fn stand(&mut self) {
        self.climb.rest(None);
        self.turn.rest(None);
        self.axes.iter_mut().for_each(Axis::rest);
    }
}

#[cfg(test)]
mod tests;
