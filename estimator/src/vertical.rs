//! Height and climb, from heights with noise, wrong echoes and steps of the floor.
//!
//! Between the measurements the climb is a model's: it follows the sticks with a lag, so the estimate does not lag behind
//! the commands. A Kalman filter knows how uncertain that is, and with it how much a measurement may surprise.

use crate::orders::Order;
use crate::sensor::{GATE, ULTRASOUND_M};
use crate::silence::USUAL_STEP_S;
use kinematics::{Airframe, DroneLimits};
use nalgebra::{Matrix2, Vector2};

/// Height above the floor at the start, and climb.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Vertical {
    pub(crate) height_m: f64,
    pub(crate) climb_m_s: f64,
}

impl Vertical {
    /// Propagates the state under an order.
    pub(crate) fn advance(
        &mut self,
        step_s: f64,
        order: Order,
        airframe: &Airframe,
        limits: &DroneLimits,
    ) {
        let before_m_s = self.climb_m_s;
        if let Order::Sticks(sticks) = order {
            let gain = if sticks.gaz > 0.0 { airframe.climb_gain } else { airframe.drop_gain };
            let wanted_m_s = sticks.gaz * limits.climb_m_s * gain;
            let followed = 1.0 - (-step_s / airframe.climb_lag_s).exp();
            self.climb_m_s += (wanted_m_s - self.climb_m_s) * followed;
        }
        self.height_m += f64::midpoint(before_m_s, self.climb_m_s) * step_s;
    }
}

/// Classification of a measured height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Echo {
    /// As expected.
    Good,
    /// A wrong echo: rejected.
    Wrong,
    /// A step of the floor: the height above the start stays as it was.
    FloorStep,
    /// The first one.
    First,
}

/// Corrects height and climb by measurements.
#[derive(Debug, Clone, Default)]
pub(crate) struct AltitudeFilter {
    state: Option<Vertical>,
    /// Covariance of the height, in m and m/s.
    covariance: Matrix2<f64>,
    /// The first height of a drone that was already flying, not confirmed by a second one: it may be a wrong
    /// echo.
    unconfirmed: bool,
    /// Height of the floor below above the floor at the start.
    floor_m: f64,
    /// Number of consecutive rejected heights that agree with the first of them, and that one relative to the expected one:
    /// what moves away from it is no step.
    rejected: u32,
    rejected_by_m: f64,
    /// The first of them, relative to the floor at the start.
    rejected_m: f64,
}

impl AltitudeFilter {
    /// What the climb does beside the model: standard deviation of its change in a second. While the drone follows the
    /// sticks...
    const STEERED_M_S: f64 = 0.1;
    /// ...and while it moves autonomously.
    const BY_ITSELF_M_S: f64 = 0.3;
    /// Standard deviation of the climb that an order asks for which the drone, perhaps, has not received.
    const UNHEARD_M_S: f64 = 0.9;
    /// Within this many standard deviations it is likelier that the drone climbed than that it flies over a box.
    const LIKELIER: f64 = 3.0;
    /// Number of agreeing heights that make a step of the floor.
    const AGREEING: u32 = 4;
    /// Difference between heights that the noise of the ultrasound explains. In a gap a larger one is accepted when the
    /// next height agrees: the first may be a wrong echo. They agree in their heights or in their differences to the
    /// expected ones: the drone may hold its height, or move as expected.
    const AGREEMENT_M: f64 = GATE * ULTRASOUND_M;

    /// The state at the last measurement; at rest on the floor before the first.
    pub(crate) fn state(&self) -> Vertical {
        self.state.unwrap_or_default()
    }

    /// Height above the floor below the drone.
    pub(crate) fn above_floor_m(&self, height_m: f64) -> f64 {
        height_m - self.floor_m
    }

    /// Processes a height above the floor below, measured `step_s` after the previous one, given the expected
    /// state.
    pub(crate) fn correct(
        &mut self,
        altitude_m: f64,
        expected: Vertical,
        step_s: f64,
        order: Order,
    ) -> Echo {
        if self.state.is_none() {
            return self.begin(altitude_m);
        }
        if step_s <= 0.0 {
            return Echo::Good;
        }
        let disturbance_m_s = match order {
            Order::Sticks(_) => Self::STEERED_M_S,
            Order::ByItself => Self::BY_ITSELF_M_S,
        };
        let moved = Matrix2::new(1.0, step_s, 0.0, 1.0);
        self.covariance = moved * self.covariance * moved.transpose();
        self.disturb(disturbance_m_s, step_s);
        self.unheard((step_s - USUAL_STEP_S).max(0.0));
        let surprise_m = altitude_m + self.floor_m - expected.height_m;
        if surprise_m.abs() <= Self::AGREEMENT_M {
            self.accept(surprise_m, expected);
            return Echo::Good;
        }
        if self.unconfirmed {
            return self.begin(altitude_m);
        }
        self.reject(surprise_m, expected)
    }

    /// Adds what a disturbance has done to the climb, and by it to the height, in a time.
    fn disturb(&mut self, change_m_s: f64, time_s: f64) {
        let Self { covariance, .. } = self;
        let (once, twice) = (time_s / 2.0, time_s * time_s / 3.0);
        *covariance += change_m_s * change_m_s * time_s * Matrix2::new(twice, once, once, 1.0);
    }

    /// Adds what an order does to the climb, and by it to the height, that the drone has or has not received for a time.
    fn unheard(&mut self, time_s: f64) {
        let lag_s = Airframe::default().climb_lag_s;
        let followed = 1.0 - (-time_s / lag_s).exp();
        let changed = Self::UNHEARD_M_S * Vector2::new(time_s - lag_s * followed, followed);
        self.covariance += changed * changed.transpose();
    }

    /// Variance of the difference between a height and the expected one.
    fn surprise_m2(&self) -> f64 {
        self.covariance[(0, 0)] + ULTRASOUND_M * ULTRASOUND_M
    }

    fn accept(&mut self, surprise_m: f64, expected: Vertical) {
        let gain = self.covariance.column(0) / self.surprise_m2();
        self.covariance -= gain * self.covariance.row(0);
        self.state = Some(Vertical {
            height_m: expected.height_m + gain.x * surprise_m,
            climb_m_s: expected.climb_m_s + gain.y * surprise_m,
        });
        self.rejected = 0;
        self.unconfirmed = false;
    }

    /// A height far from the expected one: a wrong echo, unless others agree with it.
    fn reject(&mut self, surprise_m: f64, expected: Vertical) -> Echo {
        let height_m = expected.height_m + surprise_m;
        let agrees = (surprise_m - self.rejected_by_m).abs() <= Self::AGREEMENT_M
            || (height_m - self.rejected_m).abs() <= Self::AGREEMENT_M;
        if self.rejected == 0 || !agrees {
            self.rejected = 0;
            (self.rejected_by_m, self.rejected_m) = (surprise_m, height_m);
        }
        self.rejected += 1;
        self.state = Some(expected);
        if self.rejected > 1 && surprise_m.abs() <= Self::LIKELIER * self.surprise_m2().sqrt() {
            self.accept(surprise_m, expected);
            return Echo::Good;
        }
        if self.rejected < Self::AGREEING {
            return Echo::Wrong;
        }
        self.rejected = 0;
        self.floor_m -= surprise_m;
        Echo::FloorStep
    }

    /// Difference between the newest heights and the expected one while it is undecided which is right.
    pub(crate) fn disputed_m(&self) -> f64 {
        if self.rejected > 0 { self.rejected_by_m.abs() } else { 0.0 }
    }

    fn begin(&mut self, altitude_m: f64) -> Echo {
        self.unconfirmed = true;
        self.covariance = Matrix2::from_diagonal(&Vector2::new(
            ULTRASOUND_M * ULTRASOUND_M,
            Self::BY_ITSELF_M_S * Self::BY_ITSELF_M_S,
        ));
        self.state = Some(Vertical { height_m: altitude_m, climb_m_s: 0.0 });
        Echo::First
    }

    /// The drone stands on the floor, whatever the ultrasound measures there.
    pub(crate) fn stand(&mut self) {
        *self = Self { state: Some(Vertical::default()), ..Self::default() };
    }
}

#[cfg(test)]
mod tests;
