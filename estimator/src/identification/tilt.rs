//! Response of tilt to its stick, the same for both axes, and the time that orders and navdata spend on the link.
//!
//! Nothing answers the sticks as fast as tilt, whatever the wind does: it shows when an order arrived.

use nalgebra::{SVector, Vector2};

use super::{Answer, Followers, LEAST_TILT_RAD, MAX_GAIN, MIN_GAIN, Window};
use crate::bank::{Assumption, Bank};
use crate::orders::Orders;
use kinematics::{Airframe, DroneLimits};

/// Hypotheses of the tilt's time constant.
const LAGS_S: [f64; 4] = [0.04, 0.09, 0.13, 0.19];
const LAGS: usize = LAGS_S.len();
/// Hypotheses of the time on the link, to the drone and back; less than none where the drone is faster than its dead time.
const DELAYS_S: [f64; 11] = [-0.04, 0.0, 0.04, 0.08, 0.12, 0.16, 0.2, 0.24, 0.28, 0.32, 0.36];
const DELAYS: usize = DELAYS_S.len();
const LONGEST_DELAY_S: f64 = DELAYS_S[DELAYS - 1];
/// Standard deviation of the delay around the one that was measured before the flight.
const DELAY_SPREAD_S: f64 = 0.04;
/// One hypothesis for each lag with each delay.
const ALL: usize = LAGS * DELAYS;

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
    followers: [Followers<LAGS, 1>; DELAYS],
    window: Window<ALL, 1>,
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
                followers: std::array::from_fn(|_| Followers::new(LAGS_S)),
                window: Window::new(),
            }),
            delays_s: std::array::from_fn(|i| DELAYS_S[i / LAGS]),
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
            for Axis { followers, window } in &mut self.axes {
                window.answers.clear();
                for (followers, delay_s) in followers.iter_mut().zip(DELAYS_S) {
                    followers.rest(orders.sent_s(at_s, delay_s));
                }
            }
            return;
        }
        // Tilt saturates whatever its gain: what the stick asks for beyond the limit is not asked for.
        let full = 1.0 / airframe.tilt_gain.max(1.0);
        let most = limits.tilt_rad;
        for (axis, Axis { followers, window }) in self.axes.iter_mut().enumerate() {
            for (followers, delay_s) in followers.iter_mut().zip(DELAYS_S) {
                followers.advance(orders.sent_s(at_s, delay_s), orders, |sticks| {
                    SVector::<f64, 1>::new(sticks.tilt()[axis].clamp(-full, full) * most)
                });
            }
            let causes = std::array::from_fn(|i| followers[i / LAGS].value[i % LAGS]);
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
