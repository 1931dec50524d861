//! Height and climb, from heights with noise, wrong echoes and steps of the floor.
//!
//! Between the measurements the climb is a model's: it follows the sticks with a lag. The measurements
//! correct it as in an alpha-beta filter, so the estimate does not lag behind the commands.

use crate::orders::Order;
use crate::sensor::{GATE, ULTRASOUND_M};
use crate::silence::USUAL_STEP_S;
use kinematics::{Airframe, DroneLimits};

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
    /// The first height of a drone that was already flying, not confirmed by a second one: it may be a wrong
    /// echo.
    unconfirmed: bool,
    /// Height of the floor below above the floor at the start.
    floor_m: f64,
    /// Number of consecutive rejected heights, and the newest relative to the expected one.
    rejected: u32,
    rejected_by_m: f64,
    /// The newest rejected height, relative to the floor at the start.
    rejected_m: f64,
    /// Time without data, beyond the usual interval, since the last accepted height.
    gap_s: f64,
}

impl AltitudeFilter {
    /// Time constant of the correction while the drone follows the sticks.
    const TIME_CONSTANT_S: f64 = 0.2;
    /// Time constant while it moves autonomously, which the model cannot predict.
    const TIME_CONSTANT_BY_ITSELF_S: f64 = 0.12;
    /// Largest difference between a height and the expected one, which is smooth...
    const MAX_JUMP_M: f64 = GATE * ULTRASOUND_M;
    /// ...besides what a climb that changed by this much since the last height makes of it. In a gap a height that is
    /// plausible only because of it is accepted when the next one agrees: the first may be a wrong echo.
    const MAX_CHANGE_M_S: f64 = 1.0;
    /// Number of agreeing heights that make a step of the floor.
    const AGREEING: u32 = 4;
    /// Tolerance of the agreement, either of the heights or of their differences to the expected ones: the
    /// drone may hold its height, or move as expected.
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
        let surprise_m = altitude_m + self.floor_m - expected.height_m;
        self.gap_s += (step_s - USUAL_STEP_S).max(0.0);
        if surprise_m.abs() > Self::allowed_m(step_s.min(USUAL_STEP_S)) {
            if self.unconfirmed {
                return self.begin(altitude_m);
            }
            return self.reject(surprise_m, expected);
        }
        self.gap_s = 0.0;
        self.rejected = 0;
        self.unconfirmed = false;
        if step_s <= 0.0 {
            return Echo::Good;
        }
        let time_constant_s = match order {
            Order::Sticks(_) => Self::TIME_CONSTANT_S,
            Order::ByItself => Self::TIME_CONSTANT_BY_ITSELF_S,
        };
        // Critically damped: beta follows from alpha (Benedict and Bordner, 1962).
        let alpha = step_s / (step_s + time_constant_s);
        let beta = alpha * alpha / (2.0 - alpha);
        self.state = Some(Vertical {
            height_m: expected.height_m + alpha * surprise_m,
            climb_m_s: expected.climb_m_s + beta * surprise_m / step_s,
        });
        Echo::Good
    }

    /// How far from the expected height that of a drone may be, which climbs differently since a time.
    fn allowed_m(unseen_s: f64) -> f64 {
        let [lag_s, _] = Airframe::CLIMB_LAGS_S;
        let changed_s = unseen_s - lag_s * (1.0 - (-unseen_s / lag_s).exp());
        Self::MAX_JUMP_M + Self::MAX_CHANGE_M_S * changed_s
    }

    /// A height far from the expected one: a wrong echo, unless others agree with it.
    fn reject(&mut self, surprise_m: f64, expected: Vertical) -> Echo {
        let height_m = expected.height_m + surprise_m;
        let agrees = (surprise_m - self.rejected_by_m).abs() <= Self::AGREEMENT_M
            || (height_m - self.rejected_m).abs() <= Self::AGREEMENT_M;
        self.rejected = if self.rejected > 0 && agrees { self.rejected + 1 } else { 1 };
        self.rejected_by_m = surprise_m;
        self.rejected_m = height_m;
        self.state = Some(expected);
        let flown_unseen = surprise_m.abs() <= Self::allowed_m(USUAL_STEP_S + self.gap_s);
        if self.rejected > 1 && flown_unseen {
            self.rejected = 0;
            self.gap_s = 0.0;
            self.state = Some(Vertical { height_m, ..expected });
            return Echo::Good;
        }
        if self.rejected < Self::AGREEING {
            return Echo::Wrong;
        }
        self.rejected = 0;
        self.gap_s = 0.0;
        self.floor_m -= surprise_m;
        Echo::FloorStep
    }

    /// Difference between the newest heights and the expected one while it is undecided which is right.
    pub(crate) fn disputed_m(&self) -> f64 {
        if self.rejected > 0 { self.rejected_by_m.abs() } else { 0.0 }
    }

    fn begin(&mut self, altitude_m: f64) -> Echo {
        self.unconfirmed = true;
        self.state = Some(Vertical { height_m: altitude_m, climb_m_s: 0.0 });
        Echo::First
    }

    /// The drone stands on the floor, whatever the ultrasound measures there.
    pub(crate) fn stand(&mut self) {
        self.floor_m = 0.0;
        self.gap_s = 0.0;
        self.rejected = 0;
        self.unconfirmed = false;
        self.state = Some(Vertical::default());
    }
}

#[cfg(test)]
mod tests;
