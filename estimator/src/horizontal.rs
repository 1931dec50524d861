//! Horizontal velocity and position, and the disturbance that acts on the drone.
//!
//! The position is the integral of the measured velocity and nothing else. Between and after measurements the
//! velocity is a model's: tilt follows the sticks, gravity turns tilt into acceleration, drag slows the
//! drone. The difference between measurement and model corrects the velocity and the estimated disturbance,
//! an acceleration by wind or a wrong level reference (a Luenberger observer with a disturbance state).

use nalgebra::Vector2;

use crate::orders::Order;
use kinematics::{Airframe, DroneLimits, GRAVITY_M_S2, body_from_world, world_from_body};

/// Time constant with which a drone brakes that holds its position by itself.
const BRAKING_TIME_S: f64 = 0.5;

/// Averaging time of the disturbance while the drone holds its position: it also tilts in order to brake.
const HOLD_TIME_S: f64 = 0.3;

/// Horizontal state at one time.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Horizontal {
    /// (right, forward) in the world.
    pub(crate) position_m: Vector2<f64>,
    pub(crate) velocity_m_s: Vector2<f64>,
    /// Acceleration that does not come from the sticks.
    pub(crate) disturbance_m_s2: Vector2<f64>,
    /// (right, forward) in the body frame.
    tilt_rad: Vector2<f64>,
    measured_m_s: Vector2<f64>,
    /// What the disturbance lacks of the one that the newest measurement shows.
    lacking_m_s2: Vector2<f64>,
}

/// Gains of the observer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ObserverGains {
    /// Gain of the velocity.
    pub(crate) velocity_1_s: f64,
    /// Gain of the disturbance.
    pub(crate) disturbance_1_s2: f64,
    /// Limit of the disturbance.
    pub(crate) disturbance_max_m_s2: f64,
}

impl Horizontal {
    /// Propagates the state under an order at a heading.
    pub(crate) fn advance(
        &mut self,
        step_s: f64,
        order: Order,
        yaw_deg: f64,
        airframe: &Airframe,
        limits: &DroneLimits,
    ) {
        let acceleration = match order {
            Order::Sticks(sticks) => {
                let most = limits.tilt_rad;
                let wanted = sticks
                    .tilt()
                    .map(|stick| (stick * most * airframe.tilt_gain).clamp(-most, most));
                let followed = 1.0 - (-step_s / airframe.tilt_lag_s).exp();
                self.tilt_rad += (wanted - self.tilt_rad) * followed;
                let pull = self.tilt_rad.map(|angle_rad| GRAVITY_M_S2 * angle_rad.tan());
                let speed_m_s = body_from_world(self.velocity_m_s, yaw_deg);
                let body = pull.component_mul(&airframe.thrust_gain)
                    - speed_m_s.component_mul(&airframe.drag_1_s);
                world_from_body(body, yaw_deg) + self.disturbance_m_s2
            }
            Order::ByItself => {
                self.tilt_rad = Vector2::zeros();
                -self.velocity_m_s / BRAKING_TIME_S
            }
        };
        self.position_m += (self.velocity_m_s + acceleration * (step_s / 2.0)) * step_s;
        self.velocity_m_s += acceleration * step_s;
    }

    /// Corrects the state by a measured velocity, `step_s` after the previous one, and integrates the
    /// position.
    pub(crate) fn correct(
        &mut self,
        measured_m_s: Vector2<f64>,
        position_m: Vector2<f64>,
        step_s: f64,
        order: Order,
        gains: &ObserverGains,
    ) {
        let surprise = measured_m_s - self.velocity_m_s;
        match order {
            Order::Sticks(_) => {
                let share = (gains.velocity_1_s * step_s).min(0.7);
                self.velocity_m_s += surprise * share;
                self.lacking_m_s2 += (surprise * gains.velocity_1_s - self.lacking_m_s2) * share;
                let most = gains.disturbance_max_m_s2;
                let learnt = surprise * (gains.disturbance_1_s2 * step_s.min(0.1));
                self.disturbance_m_s2 =
                    (self.disturbance_m_s2 + learnt).map(|value| value.clamp(-most, most));
            }
            // The model cannot predict what the drone does autonomously.
            Order::ByItself => {
                self.velocity_m_s = measured_m_s;
                self.lacking_m_s2 = Vector2::zeros();
            }
        }
        self.measured_m_s = measured_m_s;
        self.position_m = position_m;
    }

    /// The drone holds its position by itself with this tilt (right, forward) at a heading: the tilt
    /// compensates the disturbance.
    pub(crate) fn learn_from_hold(
        &mut self,
        tilt_rad: Vector2<f64>,
        yaw_deg: f64,
        step_s: f64,
        airframe: &Airframe,
        gains: &ObserverGains,
    ) {
        let pull = tilt_rad.map(|angle_rad| GRAVITY_M_S2 * angle_rad.tan());
        let drag = body_from_world(self.measured_m_s, yaw_deg).component_mul(&airframe.drag_1_s);
        let leaning = world_from_body(pull.component_mul(&airframe.thrust_gain) - drag, yaw_deg);
        let most = gains.disturbance_max_m_s2;
        let share = (step_s / HOLD_TIME_S).min(1.0);
        self.disturbance_m_s2 = (self.disturbance_m_s2 - (self.disturbance_m_s2 + leaning) * share)
            .map(|value| value.clamp(-most, most));
    }

    /// The drone has been pushed for a time, unnoticed.
    pub(crate) fn push(&mut self, by_m_s2: Vector2<f64>, for_s: f64, gains: &ObserverGains) {
        let most = gains.disturbance_max_m_s2;
        self.velocity_m_s += by_m_s2 * for_s;
        self.disturbance_m_s2 =
            (self.disturbance_m_s2 + by_m_s2).map(|value| value.clamp(-most, most));
    }

    /// The disturbance that the newest measurement shows, with its noise: where the observer's velocity stays behind the
    /// measured one, this is what pushes it.
    pub(crate) fn newest_disturbance_m_s2(&self) -> Vector2<f64> {
        self.disturbance_m_s2 + self.lacking_m_s2
    }

    /// (right, forward) in the body frame, as the sticks ask for it.
    pub(crate) fn tilt_rad(&self) -> Vector2<f64> {
        self.tilt_rad
    }

    pub(crate) fn measured_m_s(&self) -> Vector2<f64> {
        self.measured_m_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kinematics::Sticks;

    const GAINS: ObserverGains =
        ObserverGains { velocity_1_s: 4.0, disturbance_1_s2: 4.0, disturbance_max_m_s2: 1.0 };

    fn forward(forward: f64) -> Order {
        Order::Sticks(Sticks { pitch: -forward, ..Sticks::default() })
    }

    #[test]
    fn a_steady_tilt_ends_at_the_speed_where_drag_holds_it() {
        let mut motion = Horizontal::default();
        let (airframe, limits) = (Airframe::default(), DroneLimits::default());
        for _ in 0..2000 {
            // Facing right: forward is +x.
            motion.advance(0.01, forward(0.5), 90.0, &airframe, &limits);
        }
        let speed_m_s = GRAVITY_M_S2 * 6_f64.to_radians().tan() / 0.5;
        let expected = Vector2::new(speed_m_s, 0.0);
        assert!((motion.velocity_m_s - expected).norm() < 1e-3, "{motion:?}");
    }

    #[test]
    fn a_wind_is_learnt_and_then_foreseen() {
        let disturbance_m_s2 = Vector2::new(0.3, -0.2);
        let mut truth = Horizontal { disturbance_m_s2, ..Horizontal::default() };
        let mut motion = Horizontal::default();
        let (airframe, limits) = (Airframe::default(), DroneLimits::default());
        for step in 0..400 {
            let order = forward(0.3 * (f64::from(step) * 0.02).sin());
            truth.advance(0.015, order, 0.0, &airframe, &limits);
            motion.advance(0.015, order, 0.0, &airframe, &limits);
            motion.correct(truth.velocity_m_s, truth.position_m, 0.015, order, &GAINS);
        }
        assert!((motion.disturbance_m_s2 - truth.disturbance_m_s2).norm() < 0.01, "{motion:?}");
        let mut soon = motion;
        for _ in 0..20 {
            soon.advance(0.01, forward(0.0), 0.0, &airframe, &limits);
            truth.advance(0.01, forward(0.0), 0.0, &airframe, &limits);
        }
        assert!((soon.position_m - truth.position_m).norm() < 0.002);
    }

    #[test]
    fn a_drone_that_holds_by_itself_is_not_pushed() {
        let mut motion = Horizontal::default();
        let (airframe, limits) = (Airframe::default(), DroneLimits::default());
        let place = Vector2::new(1.0, 2.0);
        for _ in 0..100 {
            motion.advance(0.05, Order::ByItself, 0.0, &airframe, &limits);
            motion.correct(Vector2::new(0.1, 0.0), place, 0.05, Order::ByItself, &GAINS);
        }
        assert_eq!(motion.disturbance_m_s2, Vector2::zeros());
        assert_eq!(motion.measured_m_s(), Vector2::new(0.1, 0.0));
        assert_eq!(motion.position_m, place);
    }

    fn assert_same(vector: Vector2<f64>, right: f64, forward: f64) {
        let expected = Vector2::new(right, forward);
        assert!((vector - expected).norm() < 1e-9, "{vector} is not {expected}");
    }

    /// One axis of a step of the model, in the body: tilt, and acceleration without the disturbance.
    fn axis(tilt_rad: f64, wanted_rad: f64, speed_m_s: f64, thrust: f64, drag_1_s: f64) -> f64 {
        // After a step of one lag.
        let tilt_rad = tilt_rad + (wanted_rad - tilt_rad) * (1.0 - (-1_f64).exp());
        GRAVITY_M_S2 * tilt_rad.tan() * thrust - drag_1_s * speed_m_s
    }

    #[test]
    fn gravity_turns_tilt_into_acceleration_and_drag_slows_it() {
        let airframe = Airframe {
            tilt_gain: 1.2,
            thrust_gain: Vector2::new(0.8, 0.9),
            drag_1_s: Vector2::new(0.4, 0.7),
            ..Airframe::default()
        };
        let limits = DroneLimits { tilt_rad: 0.2, ..DroneLimits::default() };
        let mut motion = Horizontal {
            position_m: Vector2::new(1.0, 2.0),
            velocity_m_s: Vector2::new(0.5, -0.3),
            disturbance_m_s2: Vector2::new(0.05, -0.04),
            tilt_rad: Vector2::new(-0.03, 0.02),
            ..Horizontal::default()
        };
        let sticks = Sticks { roll: 0.5, pitch: 0.25, ..Sticks::default() };
        let step_s = airframe.tilt_lag_s;
        // Facing right: the body's right is -y of the world, and its forward is x.
        let right = axis(-0.03, 0.5 * 0.2 * 1.2, 0.3, 0.8, 0.4);
        let forward = axis(0.02, -0.25 * 0.2 * 1.2, 0.5, 0.9, 0.7);
        let (x_m_s2, y_m_s2) = (forward + 0.05, -right - 0.04);
        motion.advance(step_s, Order::Sticks(sticks), 90.0, &airframe, &limits);
        assert_same(motion.velocity_m_s, 0.5 + x_m_s2 * step_s, -0.3 + y_m_s2 * step_s);
        let way_m = |m_s: f64, m_s2: f64| (m_s + m_s2 * step_s / 2.0) * step_s;
        assert_same(motion.position_m, 1.0 + way_m(0.5, x_m_s2), 2.0 + way_m(-0.3, y_m_s2));
        // By itself it levels and brakes within half a second, whatever pushes it.
        let before = motion;
        motion.advance(0.1, Order::ByItself, 90.0, &airframe, &limits);
        let m_s = before.velocity_m_s;
        assert_same(motion.velocity_m_s, m_s.x * 0.8, m_s.y * 0.8);
        let moved_m = motion.position_m - before.position_m;
        assert_same(moved_m, m_s.x * 0.09, m_s.y * 0.09);
        assert_same(motion.tilt_rad, 0.0, 0.0);
    }

    #[test]
    fn a_tilt_ends_at_the_limit_whatever_its_gain() {
        let airframe = Airframe { tilt_gain: 2.0, ..Airframe::default() };
        let limits = DroneLimits { tilt_rad: 0.2, ..DroneLimits::default() };
        for (stick, tilt_rad) in [(1.0, 0.2), (-1.0, -0.2), (0.3, 0.12)] {
            let mut motion = Horizontal::default();
            motion.advance(10.0, forward(stick), 0.0, &airframe, &limits);
            assert_same(motion.tilt_rad, 0.0, tilt_rad);
        }
    }

    #[test]
    fn a_measured_velocity_corrects_by_the_gains_within_their_limits() {
        let order = forward(0.0);
        let corrected = |surprise: Vector2<f64>, step_s| {
            let mut motion = Horizontal {
                velocity_m_s: Vector2::new(1.0, -1.0),
                disturbance_m_s2: Vector2::new(0.1, 0.2),
                ..Horizontal::default()
            };
            let measured_m_s = motion.velocity_m_s + surprise;
            motion.correct(measured_m_s, Vector2::new(3.0, 4.0), step_s, order, &GAINS);
            assert_same(motion.position_m, 3.0, 4.0);
            assert_eq!(motion.measured_m_s(), measured_m_s);
            motion
        };
        // A fifth of the surprise after 0.05 s; the same of the disturbance.
        let motion = corrected(Vector2::new(0.5, -0.2), 0.05);
        assert_same(motion.velocity_m_s, 1.0 + 0.1, -1.0 - 0.04);
        assert_same(motion.disturbance_m_s2, 0.1 + 0.1, 0.2 - 0.04);
        // At most 70 % of it, and a gap counts as a tenth of a second.
        let motion = corrected(Vector2::new(0.5, -0.2), 1.0);
        assert_same(motion.velocity_m_s, 1.0 + 0.35, -1.0 - 0.14);
        assert_same(motion.disturbance_m_s2, 0.1 + 0.2, 0.2 - 0.08);
        // The disturbance is limited.
        let motion = corrected(Vector2::new(9.0, -9.0), 1.0);
        assert_same(motion.disturbance_m_s2, 1.0, -1.0);
    }

    #[test]
    fn a_velocity_that_stays_behind_shows_the_disturbance_at_once() {
        // The observer's velocity and disturbance have settled after 5 s; what it is told rises by 1 m/s² more.
        let (mut motion, mut measured_m_s) = (Horizontal::default(), 0.0);
        let order = forward(0.0);
        let (airframe, limits) = (Airframe::default(), DroneLimits::default());
        let airframe = Airframe { drag_1_s: Vector2::zeros(), ..airframe };
        let mut fly = |steps: u32, m_s2: f64| {
            for _ in 0..steps {
                measured_m_s += m_s2 * 0.01;
                motion.advance(0.01, order, 0.0, &airframe, &limits);
                motion.correct(
                    Vector2::new(measured_m_s, 0.0),
                    Vector2::zeros(),
                    0.01,
                    order,
                    &GAINS,
                );
            }
            [motion.disturbance_m_s2.x, motion.newest_disturbance_m_s2().x]
        };
        let settled = fly(500, -0.5);
        assert!(settled.iter().all(|m_s2| (m_s2 + 0.5).abs() < 0.01), "{settled:?}");
        let [slow_m_s2, newest_m_s2] = fly(50, 0.5);
        assert!(slow_m_s2 < 0.0 && newest_m_s2 > 0.2, "{slow_m_s2} {newest_m_s2}");
        // What it does by itself is measured by its tilt.
        motion.correct(Vector2::zeros(), Vector2::zeros(), 0.01, Order::ByItself, &GAINS);
        assert_eq!(motion.newest_disturbance_m_s2(), motion.disturbance_m_s2);
    }

    #[test]
    fn one_that_was_pushed_moves_on_so() {
        let mut motion = Horizontal {
            velocity_m_s: Vector2::new(1.0, 0.0),
            disturbance_m_s2: Vector2::new(0.2, 0.1),
            ..Horizontal::default()
        };
        motion.push(Vector2::new(-4.0, 0.5), 0.25, &GAINS);
        assert_same(motion.velocity_m_s, 0.0, 0.125);
        assert_same(motion.disturbance_m_s2, -1.0, 0.6);
    }

    #[test]
    fn the_tilt_that_holds_a_drone_shows_the_wind() {
        let airframe = Airframe {
            thrust_gain: Vector2::new(0.8, 0.9),
            drag_1_s: Vector2::new(0.4, 0.7),
            ..Airframe::default()
        };
        let held = |disturbance_m_s2, tilt_rad: Vector2<f64>, measured_m_s, step_s| {
            let mut motion = Horizontal { disturbance_m_s2, measured_m_s, ..Horizontal::default() };
            motion.learn_from_hold(tilt_rad, 90.0, step_s, &airframe, &GAINS);
            motion.disturbance_m_s2
        };
        let (none, tilt_rad) = (Vector2::zeros(), Vector2::new(0.04, -0.05));
        let right = 0.8 * GRAVITY_M_S2 * 0.04_f64.tan();
        let forward = -0.9 * GRAVITY_M_S2 * 0.05_f64.tan();
        // Facing right. After 0.3 s it is known; after a quarter of it a quarter.
        assert_same(held(none, tilt_rad, none, 0.3), -forward, right);
        assert_same(held(none, tilt_rad, none, 3.0), -forward, right);
        assert_same(held(none, tilt_rad, none, 0.075), -forward / 4.0, right / 4.0);
        let before = Vector2::new(0.2, 0.4);
        let expected = before * 0.75 + Vector2::new(-forward, right) * 0.25;
        assert_same(held(before, tilt_rad, none, 0.075), expected.x, expected.y);
        // While it moves, part of the tilt is against the drag: at 0.5 m/s forward and 0.3 m/s to the right.
        let (right, forward) = (right - 0.4 * 0.3, forward - 0.7 * 0.5);
        assert_same(held(none, tilt_rad, Vector2::new(0.5, -0.3), 1.0), -forward, right);
        // It is limited.
        assert_same(held(none, Vector2::new(0.3, 0.3), none, 1.0), -1.0, 1.0);
    }
}
