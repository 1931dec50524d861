//! Identifies in flight how this airframe responds to its sticks.
//!
//! The published models of the AR.Drone disagree by factors of two, so none is assumed to be right.
//! Measurements are compared with the sticks as changes over a short window, so that trim, floor and initial
//! height cancel: tilt and turn by the measured attitude, climb by the measured height, thrust and drag by
//! the measured velocity.

mod tilt;

use std::collections::VecDeque;

use nalgebra::{SVector, Vector2};

use self::tilt::TiltLearner;
use crate::bank::{Assumption, Bank};
use crate::orders::{Order, Orders};
use kinematics::GRAVITY_M_S2;
use kinematics::Sticks;
use kinematics::{Airframe, DroneLimits};

/// Hypotheses of the climb's time constant.
const CLIMB_LAGS_S: [f64; 7] = [0.15, 0.25, 0.38, 0.52, 0.72, 0.98, 1.3];
/// Hypotheses of the turn's time constant.
const TURN_LAGS_S: [f64; 5] = [0.03, 0.1, 0.2, 0.35, 0.55];
/// Length of the window whose changes are compared.
const WINDOW_S: f64 = 0.5;
/// Covers the window at 200 packets per second.
const MEMORY: usize = 128;
/// The gain of a thrust learner that is the wind, and its standard deviation before anything is known of it. Once the drone
/// has turned it blows from another side of the body.
const WIND: usize = 2;
const WIND_M_S2: f64 = 0.3;
/// A window in which the drone turns further is discarded, because it mixes the axes.
const MAX_TURN_DEG: f64 = 10.0;

/// A measured value, and the excitation of each hypothesis at the same time.
#[derive(Debug, Clone, Copy)]
struct Answer<const LAGS: usize, const GAINS: usize> {
    at_s: f64,
    value: f64,
    causes: [SVector<f64, GAINS>; LAGS],
}

impl<const LAGS: usize, const GAINS: usize> Answer<LAGS, GAINS> {
    /// Whether the sticks asked for at least this much. Without excitation a response is noise, and noise
    /// that goes round the control loop is correlated with the sticks.
    fn is_caused(&self, least: f64) -> bool {
        self.causes.iter().any(|cause| cause.amax() >= least)
    }
}

/// The responses of the last window.
#[derive(Debug, Clone)]
struct Window<const LAGS: usize, const GAINS: usize> {
    answers: VecDeque<Answer<LAGS, GAINS>>,
}

impl<const LAGS: usize, const GAINS: usize> Window<LAGS, GAINS> {
    fn new() -> Self {
        Self { answers: VecDeque::with_capacity(MEMORY) }
    }

    /// The change over the window, once it is full.
    fn change(&mut self, answer: Answer<LAGS, GAINS>) -> Option<Answer<LAGS, GAINS>> {
        if self.answers.len() == MEMORY {
            self.answers.pop_front();
        }
        self.answers.push_back(answer);
        let begin_s = answer.at_s - WINDOW_S;
        while self.answers.get(1).is_some_and(|second| second.at_s <= begin_s) {
            self.answers.pop_front();
        }
        let first = self.answers.front().filter(|first| first.at_s <= begin_s)?;
        let causes = std::array::from_fn(|i| answer.causes[i] - first.causes[i]);
        Some(Answer { at_s: answer.at_s, value: answer.value - first.value, causes })
    }
}

/// The stick commands filtered by each lag of a bank, and the integral of that.
#[derive(Debug, Clone)]
struct Followers<const LAGS: usize, const GAINS: usize> {
    lags_s: [f64; LAGS],
    value: [SVector<f64, GAINS>; LAGS],
    way: [SVector<f64, GAINS>; LAGS],
    at_s: Option<f64>,
}

impl<const LAGS: usize, const GAINS: usize> Followers<LAGS, GAINS> {
    fn new(lags_s: [f64; LAGS]) -> Self {
        let zeros = [SVector::zeros(); LAGS];
        Self { lags_s, value: zeros, way: zeros, at_s: None }
    }

    /// Advances to the orders that were sent at a time.
    fn advance(
        &mut self,
        to_s: f64,
        orders: &Orders,
        asked: impl Fn(Sticks) -> SVector<f64, GAINS>,
    ) {
        let from_s = self.at_s.replace(to_s).unwrap_or(to_s);
        orders.steps_sent(from_s, to_s, |_, step_s, order| {
            let asked = match order {
                Order::Sticks(sticks) => asked(sticks),
                Order::ByItself => SVector::zeros(),
            };
            let followers = self.value.iter_mut().zip(&mut self.way);
            for ((value, way), lag_s) in followers.zip(self.lags_s) {
                let before = *value;
                *value += (asked - *value) * (1.0 - (-step_s / lag_s).exp());
                *way += (before + *value) * (step_s / 2.0);
            }
        });
    }

    /// The drone moves autonomously, up to a time.
    fn rest(&mut self, at_s: f64) {
        self.at_s = Some(at_s);
        self.value = [SVector::zeros(); LAGS];
    }
}

/// Response of climb to gaz: one gain upwards and one downwards.
#[derive(Debug, Clone)]
struct ClimbLearner {
    bank: Bank<7, 2>,
    followers: Followers<7, 2>,
    window: Window<7, 2>,
}

/// Response of the heading to its stick.
#[derive(Debug, Clone)]
struct TurnLearner {
    bank: Bank<5, 1>,
    followers: Followers<5, 1>,
    window: Window<5, 1>,
}

/// Response of velocity to tilt on one body axis: thrust, drag and disturbance.
#[derive(Debug, Clone)]
struct ThrustLearner {
    bank: Bank<1, 3>,
    window: Window<1, 3>,
    /// Integral of the acceleration that gravity alone gives at the tilt.
    pull_m_s: f64,
    way_m: f64,
}

/// Identified parameters of the airframe.
#[derive(Debug, Clone)]
pub(crate) struct Identification {
    airframe: Airframe,
    limits: DroneLimits,
    climb: ClimbLearner,
    tilt: TiltLearner,
    turn: TurnLearner,
    thrust: [ThrustLearner; 2],
    /// The tilt that velocity follows (right, forward), and its time.
    tilt_rad: Vector2<f64>,
    velocity_at_s: Option<f64>,
    /// Heading at the start of the velocity window.
    window_yaw_deg: f64,
}

impl Identification {
    pub(crate) fn new(airframe: Airframe, limits: DroneLimits) -> Self {
        let climb = Assumption {
            gains: [airframe.climb_gain, airframe.drop_gain],
            spreads: [0.4; 2],
            lag_s: airframe.climb_lag_s,
            lag_spread: 0.5,
            noise: 0.04,
        };
        let turn = Assumption {
            gains: [airframe.turn_gain],
            spreads: [0.3],
            lag_s: airframe.turn_lag_s,
            lag_spread: 1.0,
            noise: 1.0,
        };
        let thrust = |axis: usize| {
            let assumption = Assumption {
                gains: [airframe.thrust_gain[axis], airframe.drag_1_s[axis], 0.0],
                spreads: [0.25, 0.5, WIND_M_S2],
                lag_s: 1.0,
                lag_spread: 1.0,
                noise: 0.12,
            };
            ThrustLearner {
                bank: Bank::new([1.0], &assumption),
                window: Window::new(),
                pull_m_s: 0.0,
                way_m: 0.0,
            }
        };
        Self {
            airframe,
            limits,
            climb: ClimbLearner {
                bank: Bank::new(CLIMB_LAGS_S, &climb),
                followers: Followers::new(CLIMB_LAGS_S),
                window: Window::new(),
            },
            tilt: TiltLearner::new(&airframe),
            turn: TurnLearner {
                bank: Bank::new(TURN_LAGS_S, &turn),
                followers: Followers::new(TURN_LAGS_S),
                window: Window::new(),
            },
            thrust: [thrust(0), thrust(1)],
            tilt_rad: Vector2::zeros(),
            velocity_at_s: None,
            window_yaw_deg: 0.0,
        }
    }

    pub(crate) fn airframe(&self) -> &Airframe {
        &self.airframe
    }

    /// Adds a measured height. The caller leaves out floor steps and wrong echoes. With its stick at rest the drone goes
    /// back by itself to where it was when the stick was released, which teaches nothing.
    pub(crate) fn height(&mut self, at_s: f64, height_m: f64, orders: &Orders) {
        if orders.at(at_s) == Order::ByItself {
            self.forget_heights(at_s, orders);
            return;
        }
        let most = self.limits.climb_m_s;
        let sent_s = orders.sent_s(at_s, self.tilt.delay_s());
        let ClimbLearner { bank, followers, window } = &mut self.climb;
        followers.advance(sent_s, orders, |sticks| {
            SVector::<f64, 2>::new(sticks.gaz.max(0.0), sticks.gaz.min(0.0)) * most
        });
        if orders.is_level(at_s) {
            window.answers.clear();
            return;
        }
        let answer = Answer { at_s, value: height_m, causes: followers.way };
        let change = window.change(answer).filter(|change| change.is_caused(LEAST_CLIMB_M));
        if let Some(change) = change {
            bank.learn(change.value, &change.causes);
            let (lag_s, gains) = bank.estimate();
            self.airframe.climb_lag_s = lag_s;
            self.airframe.climb_gain = gains.x.clamp(MIN_GAIN, MAX_GAIN);
            self.airframe.drop_gain = gains.y.clamp(MIN_GAIN, MAX_GAIN);
        }
    }

    /// The height has jumped, or the drone moves autonomously: discards the window.
    pub(crate) fn forget_heights(&mut self, at_s: f64, orders: &Orders) {
        self.climb.window.answers.clear();
        self.climb.followers.rest(orders.sent_s(at_s, self.tilt.delay_s()));
    }

    /// The time on the link was measured before the flight.
    pub(crate) fn expect_link_delay(&mut self, delay_s: f64) {
        self.tilt.expect_delay(delay_s);
    }

    /// Time that an order and the packet that shows its effect spend on the link.
    pub(crate) fn link_delay_s(&self) -> f64 {
        self.tilt.delay_s()
    }

    /// Adds a measured tilt (right, forward).
    pub(crate) fn tilt(&mut self, at_s: f64, tilt_rad: Vector2<f64>, orders: &Orders) {
        self.tilt.learn(at_s, tilt_rad, orders, &self.limits, &mut self.airframe);
    }

    /// Adds a measured heading, unwrapped.
    pub(crate) fn heading(&mut self, at_s: f64, yaw_deg: f64, orders: &Orders) {
        let TurnLearner { bank, followers, window } = &mut self.turn;
        let sent_s = orders.sent_s(at_s, self.tilt.delay_s());
        if orders.at(at_s) == Order::ByItself {
            window.answers.clear();
            followers.rest(sent_s);
            return;
        }
        let most = self.limits.turn_deg_s;
        followers.advance(sent_s, orders, |sticks| SVector::<f64, 1>::new(sticks.yaw * most));
        let answer = Answer { at_s, value: yaw_deg, causes: followers.way };
        let change = window.change(answer).filter(|change| change.is_caused(LEAST_TURN_DEG));
        if let Some(change) = change {
            bank.learn(change.value, &change.causes);
            let (lag_s, gains) = bank.estimate();
            self.airframe.turn_lag_s = lag_s;
            self.airframe.turn_gain = gains.x.clamp(MIN_GAIN, MAX_GAIN);
        }
    }

    /// Adds a measured velocity (right, forward) of the body at a heading.
    pub(crate) fn velocity(
        &mut self,
        at_s: f64,
        body_m_s: Vector2<f64>,
        yaw_deg: f64,
        orders: &Orders,
    ) {
        let from_s = self.velocity_at_s.replace(at_s).unwrap_or(at_s);
        let turned_deg = (yaw_deg - self.window_yaw_deg).abs();
        let turned = turned_deg > MAX_TURN_DEG;
        if orders.at(at_s) == Order::ByItself || turned {
            self.window_yaw_deg = yaw_deg;
            for learner in &mut self.thrust {
                learner.window.answers.clear();
                if turned {
                    // Turned round, it differs by twice itself: by no more.
                    learner.bank.doubt(WIND, WIND_M_S2 * turned_deg.to_radians().min(2.0));
                }
            }
        }
        let (airframe, most) = (self.airframe, self.limits.tilt_rad);
        orders.steps(from_s, at_s, |_, step_s, order| {
            let wanted = match order {
                Order::Sticks(sticks) => sticks
                    .tilt()
                    .map(|stick| (stick * most * airframe.tilt_gain).clamp(-most, most)),
                Order::ByItself => Vector2::zeros(),
            };
            let followed = 1.0 - (-step_s / airframe.tilt_lag_s).exp();
            self.tilt_rad += (wanted - self.tilt_rad) * followed;
            for (axis, learner) in self.thrust.iter_mut().enumerate() {
                learner.pull_m_s += GRAVITY_M_S2 * self.tilt_rad[axis].tan() * step_s;
                learner.way_m += body_m_s[axis] * step_s;
            }
        });
        if orders.at(at_s) == Order::ByItself {
            return;
        }
        for (axis, learner) in self.thrust.iter_mut().enumerate() {
            let causes = [SVector::<f64, 3>::new(learner.pull_m_s, -learner.way_m, at_s)];
            let answer = Answer { at_s, value: body_m_s[axis], causes };
            let change = learner.window.change(answer);
            let caused = |change: &Answer<1, 3>| {
                let [pull_m_s, way_m] = [change.causes[0].x, change.causes[0].y];
                pull_m_s.abs().max(way_m.abs()) >= LEAST_SPEED_CHANGE_M_S
            };
            if let Some(change) = change.filter(caused) {
                learner.bank.learn(change.value, &change.causes);
                let (_, gains) = learner.bank.estimate();
                self.airframe.thrust_gain[axis] = gains.x.clamp(MIN_GAIN, MAX_GAIN);
                self.airframe.drag_1_s[axis] = gains.y.clamp(0.0, MAX_DRAG_1_S);
            }
        }
    }
}

/// Smallest excitation within a window that is used.
const LEAST_CLIMB_M: f64 = 0.04;
const LEAST_TILT_RAD: f64 = 0.035;
const LEAST_TURN_DEG: f64 = 4.0;
const LEAST_SPEED_CHANGE_M_S: f64 = 0.25;

/// Range of the gains, wider than those of all known airframes.
const MIN_GAIN: f64 = 0.4;
const MAX_GAIN: f64 = 2.5;
const MAX_DRAG_1_S: f64 = 3.0;

#[cfg(test)]
mod tests;
