//! Response of tilt to its stick, the same for both axes, and the time that orders and navdata spend on the link.
//!
//! Nothing answers the sticks as fast as tilt, whatever the wind does: it shows when an order arrived.

use nalgebra::{SVector, Vector2};

use super::{Answer, LEAST_TILT_RAD, MAX_GAIN, MIN_GAIN, Window};
use crate::bank::{Assumption, Bank};
use crate::orders::{Order, Orders};
use kinematics::{Airframe, DroneLimits, Sticks};

/// Hypotheses of the tilt's time constant.
const LAGS_S: [f64; 4] = [0.04, 0.09, 0.13, 0.19];
const LAGS: usize = LAGS_S.len();
/// Hypotheses of the time on the link, to the drone and back; less than none where the drone is faster than its dead time.
const DELAYS_S: [f64; 11] = [-0.04, 0.0, 0.04, 0.08, 0.12, 0.16, 0.2, 0.24, 0.28, 0.32, 0.36];
const DELAYS: usize = DELAYS_S.len();
const LONGEST_DELAY_S: f64 = DELAYS_S[DELAYS - 1];
/// Standard deviation of the delay around the one that was measured before the flight.
const DELAY_SPREAD_S: f64 = 0.04;
/// Published attitude loops are of first order (tum, leo) or of second (rec). A second order begins as slowly as a first
/// one behind a longer link: without a hypothesis of its own it would count as delay.
const ORDERS: usize = 2;
/// Of all delays, the hypotheses of each order and lag.
const ALL: usize = LAGS * ORDERS * DELAYS;

/// Identifies tilt and delay.
#[derive(Debug, Clone)]
pub(super) struct TiltLearner {
    assumption: Assumption<1>,
    pub(super) bank: Bank<ALL, 1>,
    axes: [Axis; 2],
    /// Delay of each hypothesis, and their mean.
    delays_s: [f64; ALL],
    delay_s: f64,
}

#[derive(Debug, Clone)]
struct Axis {
    /// For each delay.
    loops: [AttitudeLoops; DELAYS],
    window: Window<ALL, 1>,
}

/// Where the stick would have led attitude loops of each lag: of first order, and of second, as two equal stages one
/// behind the other with the same lag in all.
#[derive(Debug, Clone)]
struct AttitudeLoops {
    /// Both in radians.
    first_rad: [f64; LAGS],
    second_rad: [[f64; 2]; LAGS],
    at_s: Option<f64>,
}

impl AttitudeLoops {
    const AT_REST: Self = Self { first_rad: [0.0; LAGS], second_rad: [[0.0; 2]; LAGS], at_s: None };

    /// Advances to the orders that were sent at a time. Nothing is asked for while the drone moves autonomously.
    fn advance(&mut self, to_s: f64, orders: &Orders, asked_rad: impl Fn(Sticks) -> f64) {
        let from_s = self.at_s.replace(to_s).unwrap_or(to_s);
        orders.steps_sent(from_s, to_s, |_, step_s, order| {
            let asked_rad = match order {
                Order::Sticks(sticks) => asked_rad(sticks),
                Order::ByItself => 0.0,
            };
            for (lag_s, (first_rad, stages_rad)) in
                LAGS_S.into_iter().zip(self.first_rad.iter_mut().zip(&mut self.second_rad))
            {
                let stays = (-step_s / lag_s).exp();
                *first_rad = asked_rad + (*first_rad - asked_rad) * stays;
                // Each stage has half of the lag.
                let (stays, [inner_rad, outer_rad]) = (stays * stays, stages_rad);
                let before_rad = *inner_rad;
                *inner_rad = asked_rad + (*inner_rad - asked_rad) * stays;
                let led_rad = f64::midpoint(before_rad, *inner_rad);
                *outer_rad = led_rad + (*outer_rad - led_rad) * stays;
            }
        });
    }

    /// The drone moves autonomously, up to a time.
    fn rest(&mut self, at_s: f64) {
        *self = Self { at_s: Some(at_s), ..Self::AT_REST };
    }

    /// The tilt of a hypothesis.
    fn tilt_rad(&self, hypothesis: usize) -> f64 {
        let lag = hypothesis % LAGS;
        [self.first_rad[lag], self.second_rad[lag][1]][hypothesis / LAGS % ORDERS]
    }
}

impl TiltLearner {
    pub(super) fn new(airframe: &Airframe) -> Self {
        let assumption = Assumption {
            gains: [airframe.tilt_gain],
            spreads: [0.5],
            lag_s: airframe.tilt_lag_s,
            lag_spread: 0.6,
            noise: 0.012,
        };
        let mut learner = Self {
            bank: Bank::new(std::array::from_fn(|i| LAGS_S[i % LAGS]), &assumption),
            assumption,
            axes: std::array::from_fn(|_| Axis {
                loops: [AttitudeLoops::AT_REST; DELAYS],
                window: Window::new(),
            }),
            delays_s: std::array::from_fn(|i| DELAYS_S[i / (LAGS * ORDERS)]),
            delay_s: 0.0,
        };
        learner.expect_delay(0.0);
        learner
    }

    /// The delay was measured before the flight.
    pub(super) fn expect_delay(&mut self, delay_s: f64) {
        let likely = |its_s: f64| -((its_s - delay_s) / DELAY_SPREAD_S).powi(2) / 2.0;
        self.bank.expect(&self.assumption, &self.delays_s.map(likely));
        self.delay_s = delay_s.min(LONGEST_DELAY_S);
    }

    /// Time that an order and the packet that shows its effect spend on the link.
    pub(super) fn delay_s(&self) -> f64 {
        self.delay_s
    }

    /// Adds a measured tilt (right, forward), and corrects the airframe.
    pub(super) fn learn(
        &mut self,
        at_s: f64,
        tilt_rad: Vector2<f64>,
        orders: &Orders,
        limits: &DroneLimits,
        airframe: &mut Airframe,
    ) {
        if orders.may_move_by_itself(at_s, LONGEST_DELAY_S) {
            for Axis { loops, window } in &mut self.axes {
                window.answers.clear();
                for (loops, delay_s) in loops.iter_mut().zip(DELAYS_S) {
                    loops.rest(orders.sent_s(at_s, delay_s));
                }
            }
            return;
        }
        // Tilt saturates whatever its gain: what the stick asks for beyond the limit is not asked for.
        let full = 1.0 / airframe.tilt_gain.max(1.0);
        let most = limits.tilt_rad;
        for (axis, Axis { loops, window }) in self.axes.iter_mut().enumerate() {
            for (loops, delay_s) in loops.iter_mut().zip(DELAYS_S) {
                loops.advance(orders.sent_s(at_s, delay_s), orders, |sticks| {
                    sticks.tilt()[axis].clamp(-full, full) * most
                });
            }
            let tilt_rad_of = |i: usize| loops[i / (LAGS * ORDERS)].tilt_rad(i);
            let causes = std::array::from_fn(|i| SVector::<f64, 1>::new(tilt_rad_of(i)));
            let change = window.change(Answer { at_s, value: tilt_rad[axis], causes });
            if let Some(change) = change.filter(|change| change.is_caused(LEAST_TILT_RAD)) {
                self.bank.learn(change.value, &change.causes);
            }
        }
        let (lag_s, gains, delay_s) = self.bank.estimate_with(&self.delays_s);
        airframe.tilt_lag_s = lag_s;
        airframe.tilt_gain = gains.x.clamp(MIN_GAIN, MAX_GAIN);
        self.delay_s = delay_s;
    }
}
