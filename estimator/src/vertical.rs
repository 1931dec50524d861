//! Height and climb, from heights with noise, wrong echoes and steps of the floor.
//!
//! Between the measurements the climb is a model's: it follows the sticks with a lag, so the estimate does not lag behind
//! the commands. A Kalman filter knows how uncertain that is, and with it how much a measurement may surprise.

use crate::orders::Order;
use crate::rejected::{Rejected, Shown};
use crate::sensor::{CLEAR, GATE, MODEL, ULTRASOUND_M};
use crate::silence::USUAL_STEP_S;
use kinematics::{Airframe, DroneLimits};
use nalgebra::{Matrix3, Vector1, Vector3};

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
    /// Height of the floor below above the floor at the start.
    floor_m: f64,
    /// Covariance of height, climb and floor, in m and m/s.
    covariance: Matrix3<f64>,
    /// The first height in the air, not confirmed by a second one: it may be a wrong echo.
    unconfirmed: bool,
    /// Variance that restarts have left to height and floor together, whatever is measured.
    restarted_m2: f64,
    /// What the last accepted height differed by from the corrected one.
    residual_m: f64,
    agreeing: Agreeing,
}

/// Consecutive rejected heights, each of which agrees with the one before.
#[derive(Debug, Clone, Copy, Default)]
struct Agreeing {
    rejected: Rejected<1>,
    /// Whether the first one may be a climb.
    is_climb: bool,
    /// The last one relative to the expected one, and to the floor at the start.
    by_m: f64,
    last_m: f64,
}

impl Agreeing {
    /// Whether a height is nearer to two rejected ones than to the expected one.
    fn is_nearer_to(&self, surprise_m: f64) -> bool {
        self.rejected.count() > 1 && (surprise_m - self.by_m).abs() < surprise_m.abs()
    }
}

/// Standard deviation of the climb that an order asks for which the drone, perhaps, has not received.
const UNHEARD_M_S: f64 = 0.9;

/// What is measured: the height above the floor below.
const ABOVE_FLOOR: Vector3<f64> = Vector3::new(1.0, 0.0, -1.0);

/// Covariance of height and floor that are moved together, by a metre.
const TOGETHER: Matrix3<f64> = Matrix3::new(1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0);

/// Covariance of what an order does to the height and the climb that the drone has or has not received for a time.
fn unheard(time_s: f64) -> Matrix3<f64> {
    let lag_s = Airframe::default().climb_lag_s;
    let followed = 1.0 - (-time_s / lag_s).exp();
    let changed = UNHEARD_M_S * Vector3::new(time_s - lag_s * followed, followed, 0.0);
    changed * changed.transpose()
}

/// Covariance of a change of the climb that the model has made of an order within a time: the airframe's answer may be another
/// one. What is left of the change is as uncertain as what is made of it, hence the lag.
fn followed(changed_m_s: f64, step_s: f64) -> Matrix3<f64> {
    let share = MODEL * (Airframe::default().climb_lag_s / step_s).sqrt();
    let changed = share * changed_m_s * Vector3::new(step_s / 2.0, 1.0, 0.0);
    changed * changed.transpose()
}

impl AltitudeFilter {
    /// What the climb does beside the model: standard deviation of its change in a second. While the drone follows the
    /// sticks...
    const STEERED_M_S: f64 = 0.05;
    /// ...and while it moves autonomously.
    const BY_ITSELF_M_S: f64 = 0.1;
    /// Difference between heights that the noise of the ultrasound explains. In a gap a larger one is accepted when the
    /// next height agrees: the first may be a wrong echo. They agree in their heights or in their differences to the
    /// expected ones: the drone may hold its height, or move as expected.
    const AGREEMENT_M: f64 = GATE * ULTRASOUND_M;
    /// Standard deviation of height and floor together after a restart: the first altitudes after it may be old, and what
    /// follows them looks like another floor.
    const RESTART_M: f64 = 0.25;

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
        let changed_m_s = expected.climb_m_s - self.state().climb_m_s;
        self.covariance = self.covariance_after(step_s, order) + followed(changed_m_s, step_s);
        let surprise_m = altitude_m + self.floor_m - expected.height_m;
        let is_close = surprise_m.abs() <= Self::AGREEMENT_M && self.expects_closely();
        if is_close && !self.agreeing.is_nearer_to(surprise_m) {
            self.accept(surprise_m, expected);
            return Echo::Good;
        }
        if self.unconfirmed {
            return self.begin(altitude_m);
        }
        self.reject(surprise_m, expected, step_s)
    }

    /// The covariance after a time without a height: with what disturbances have done to the climb, and by it to the height,
    /// and with what an order does that the drone has or has not received for the time beyond the usual.
    fn covariance_after(&self, step_s: f64, order: Order) -> Matrix3<f64> {
        let disturbed_m_s = match order {
            Order::Sticks(_) => Self::STEERED_M_S,
            Order::ByItself => Self::BY_ITSELF_M_S,
        };
        let moved = Matrix3::new(1.0, step_s, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
        let (once, twice) = (step_s / 2.0, step_s * step_s / 3.0);
        let disturbed = Matrix3::new(twice, once, 0.0, once, 1.0, 0.0, 0.0, 0.0, 0.0);
        moved * self.covariance * moved.transpose()
            + disturbed_m_s * disturbed_m_s * step_s * disturbed
            + unheard((step_s - USUAL_STEP_S).max(0.0))
    }

    /// Whether one height beside the expected one confirms it. After a gap, a wrong echo would be beside it, too.
    fn expects_closely(&self) -> bool {
        self.expected_m2() <= Self::AGREEMENT_M * Self::AGREEMENT_M
    }

    /// Variance of the expected height above the floor below.
    fn expected_m2(&self) -> f64 {
        ABOVE_FLOOR.dot(&(self.covariance * ABOVE_FLOOR))
    }

    /// Variance of the difference between a height and the expected one.
    fn surprise_m2(&self) -> f64 {
        self.expected_m2() + ULTRASOUND_M * ULTRASOUND_M
    }

    fn accept(&mut self, surprise_m: f64, expected: Vertical) {
        let gain = self.covariance * ABOVE_FLOOR / self.surprise_m2();
        self.covariance -= gain * (ABOVE_FLOOR.transpose() * self.covariance);
        let correction = gain * surprise_m;
        self.state = Some(Vertical {
            height_m: expected.height_m + correction.x,
            climb_m_s: expected.climb_m_s + correction.y,
        });
        self.floor_m += correction.z;
        self.residual_m = surprise_m - ABOVE_FLOOR.dot(&correction);
        self.agreeing = Agreeing::default();
        self.unconfirmed = false;
    }

    /// A height far from the expected one: a wrong echo, unless others agree with it.
    fn reject(&mut self, surprise_m: f64, expected: Vertical, step_s: f64) -> Echo {
        let height_m = expected.height_m + surprise_m;
        let before = self.agreeing;
        let agrees = (surprise_m - before.by_m).abs() <= Self::AGREEMENT_M
            || (height_m - before.last_m).abs() <= Self::AGREEMENT_M;
        self.agreeing = if before.rejected.count() > 0 && agrees {
            before
        } else {
            // Likelier than that it flies over a box.
            let is_climb = surprise_m.abs() <= CLEAR * self.surprise_m2().sqrt();
            Agreeing { is_climb, ..Agreeing::default() }
        };
        let agreeing = &mut self.agreeing;
        agreeing.rejected.add(Vector1::new(surprise_m - self.residual_m), step_s);
        (agreeing.by_m, agreeing.last_m) = (surprise_m, height_m);
        self.state = Some(expected);
        if agreeing.rejected.count() > 1 && agreeing.is_climb {
            self.accept(surprise_m, expected);
            return Echo::Good;
        }
        let surprise_m2 = surprise_m * surprise_m;
        let echo = match agreeing.rejected.shown() {
            None => return Echo::Wrong,
            Some(Shown::Motion(_)) => {
                // As no order explains that it has received: with any climb.
                self.covariance[(0, 0)] += surprise_m2;
                self.covariance[(1, 1)] += UNHEARD_M_S * UNHEARD_M_S;
                Echo::Good
            }
            Some(Shown::Step) => {
                // The height is as uncertain as it was, however well that above the floor is measured.
                self.covariance[(2, 2)] += surprise_m2;
                Echo::FloorStep
            }
        };
        self.accept(surprise_m, expected);
        echo
    }

    /// Standard deviation of the height a time after the last one.
    pub(crate) fn uncertainty_m(&self, silence_s: f64, order: Order) -> f64 {
        self.covariance_after(silence_s, order)[(0, 0)].sqrt().hypot(self.agreeing.by_m)
    }

    /// The drone has restarted, or old packets are taken for those of a restarted one.
    pub(crate) fn handle_restart(&mut self) {
        let restarted_m2 = Self::RESTART_M * Self::RESTART_M;
        self.restarted_m2 += restarted_m2;
        self.covariance += restarted_m2 * TOGETHER;
    }

    fn begin(&mut self, altitude_m: f64) -> Echo {
        let deviations = Vector3::new(ULTRASOUND_M, Self::BY_ITSELF_M_S, 0.0);
        *self = Self {
            state: Some(Vertical { height_m: altitude_m, climb_m_s: 0.0 }),
            covariance: Matrix3::from_diagonal(&deviations.component_mul(&deviations))
                + self.restarted_m2 * TOGETHER,
            restarted_m2: self.restarted_m2,
            unconfirmed: true,
            ..Self::default()
        };
        Echo::First
    }

    /// The drone stands on the floor, whatever the ultrasound measures there. The first height in the air is one above that
    /// floor, however many packets were lost during the take-off.
    pub(crate) fn stand(&mut self) {
        *self = Self {
            state: Some(Vertical::default()),
            unconfirmed: true,
            covariance: self.restarted_m2 * TOGETHER,
            restarted_m2: self.restarted_m2,
            ..Self::default()
        };
    }
}

#[cfg(test)]
mod tests;
