//! Uncertainty of the estimate. A position that is integrated from a velocity drifts, and its users need a
//! bound on the drift.
//!
//! The deviations are those of the worse sensors of the flight model, so that the figure is conservative
//! indoors: the bias of the flow, its scale, the drift of the heading, and motion that was not measured.

use nalgebra::Vector2;

/// Initial standard deviation of the flow's bias; its random walk per square root of a second; and the time
/// constant of its decay.
const BIAS_M_S: f64 = 0.013;
const BIAS_WALK_M_S: f64 = 0.003;
const BIAS_TIME_S: f64 = 120.0;
/// Standard deviation of the flow's scale, as a fraction of the distance from the start.
const SCALE: f64 = 0.06;
/// Standard deviation of the heading's drift.
const HEADING_DRIFT_DEG_S: f64 = 0.03;
/// Standard deviation of the velocity while nothing is received: in a hover, as a fraction of the speed, and
/// as a fraction of the change of speed meanwhile.
const UNSEEN_M_S: f64 = 0.15;
const UNSEEN_SPEED: f64 = 0.2;
const UNSEEN_CHANGE: f64 = 0.25;
/// Time after which a drone that receives nothing hovers and lands by itself, and drifts in the wind.
const ALONE_AFTER_S: f64 = 2.0;
const ALONE_M_S: f64 = 0.5;
/// It may also be accelerating: full tilt, a fifth of gravity, is the worst case.
const UNSEEN_M_S2: f64 = 0.3;
/// Limit up to which a rejected velocity counts; a larger one is hardly that of a drone.
const MAX_DISPUTED_M_S: f64 = 1.2;
/// Standard deviation of the heading after each step of the compass.
pub(crate) const HEADING_STEP_DEG: f64 = 2.0;
/// Standard deviation of the position while navdata are late.
const FLOOR_M: f64 = 0.02;
/// Standard deviation of the climb while nothing is received.
const UNSEEN_CLIMB_M_S: f64 = 0.3;
/// Standard deviation of a height.
const HEIGHT_M: f64 = 0.015;
/// Standard deviation of the height after each restart: the first altitudes after it may be old, and what follows
/// them looks like another floor.
const RESTART_M: f64 = 0.25;
/// Standard deviation of the height after each step of the floor.
const FLOOR_STEP_M: f64 = 0.05;

/// Contributions to the uncertainty.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Uncertainty {
    flown_s: f64,
    unseen_m2: f64,
    /// Distance flown if the rejected velocities were right after all.
    disputed_m: f64,
    floor_steps: u32,
    restarts: u32,
    heading_steps: u32,
}

impl Uncertainty {
    /// Adds a step of measured flight.
    pub(crate) fn fly(&mut self, step_s: f64) {
        self.flown_s += step_s;
    }

    /// Adds a gap: of the velocity only its values before and after are known.
    pub(crate) fn fly_unseen(
        &mut self,
        gap_s: f64,
        before_m_s: Vector2<f64>,
        after_m_s: Vector2<f64>,
    ) {
        let speed_m_s = before_m_s.norm().max(after_m_s.norm());
        let change_m_s = (after_m_s - before_m_s).norm();
        let unseen_m_s = UNSEEN_M_S + UNSEEN_SPEED * speed_m_s + UNSEEN_CHANGE * change_m_s;
        let alone_m = ALONE_M_S * (gap_s - ALONE_AFTER_S).max(0.0);
        self.unseen_m2 += (unseen_m_s * gap_s + alone_m).powi(2);
    }

    /// Adds a step with a rejected velocity that differed this much from the expected one.
    pub(crate) fn fly_disputed(&mut self, step_s: f64, surprise_m_s: f64) {
        self.disputed_m += surprise_m_s.min(MAX_DISPUTED_M_S) * step_s;
    }

    /// Variance of the position on each axis from motion that was not measured or was rejected.
    pub(crate) fn unmeasured_m2(&self) -> f64 {
        self.unseen_m2 + self.disputed_m * self.disputed_m
    }

    /// Standard deviation of the position that a silence adds, at a speed.
    pub(crate) fn silence_m(silence_s: f64, speed_m_s: f64) -> f64 {
        (UNSEEN_M_S + UNSEEN_SPEED * speed_m_s + UNSEEN_M_S2 * silence_s) * silence_s
    }

    pub(crate) fn step_of_the_heading(&mut self) {
        self.heading_steps += 1;
    }

    /// The drone has restarted, or old packets are taken for those of a restarted one.
    pub(crate) fn handle_restart(&mut self) {
        self.restarts += 1;
    }

    pub(crate) fn step_of_the_floor(&mut self) {
        self.floor_steps += 1;
    }

    /// Standard deviation of the horizontal position on each axis, `distance_m` from the start; the newest
    /// sample is `silence_s` old and had this speed.
    pub(crate) fn horizontal_m(&self, distance_m: f64, silence_s: f64, speed_m_s: f64) -> f64 {
        let steps_deg = HEADING_STEP_DEG * f64::from(self.heading_steps).sqrt();
        let turned = (HEADING_DRIFT_DEG_S * self.flown_s).hypot(steps_deg).to_radians();
        let unseen_m_s = UNSEEN_M_S + UNSEEN_SPEED * speed_m_s + UNSEEN_M_S2 * silence_s;
        [
            FLOOR_M,
            bias_m(self.flown_s),
            SCALE * distance_m,
            turned * distance_m,
            self.unseen_m2.sqrt(),
            self.disputed_m,
            unseen_m_s * silence_s,
        ]
        .iter()
        .map(|part| part * part)
        .sum::<f64>()
        .sqrt()
    }

    /// Standard deviation of the height.
    pub(crate) fn vertical_m(&self, silence_s: f64) -> f64 {
        let steps_m = FLOOR_STEP_M * f64::from(self.floor_steps).sqrt();
        let restarts_m = RESTART_M * f64::from(self.restarts).sqrt();
        HEIGHT_M.hypot(steps_m).hypot(restarts_m).hypot(UNSEEN_CLIMB_M_S * silence_s)
    }
}

/// Standard deviation of the integral of the flow's bias, an Ornstein-Uhlenbeck process (Gillespie, 1996).
fn bias_m(flown_s: f64) -> f64 {
    let times = flown_s / BIAS_TIME_S;
    let faded = 1.0 - (-times).exp();
    let at_start_m = BIAS_M_S * BIAS_TIME_S * faded;
    let faded_twice = 1.0 - (-2.0 * times).exp();
    let walked = (times - 2.0 * faded + faded_twice / 2.0).max(0.0).sqrt();
    let walked_m = BIAS_WALK_M_S * BIAS_TIME_S.powf(1.5) * walked;
    at_start_m.hypot(walked_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The standard deviation of 1500 such biases, simulated separately, was 0.136 m after 10 s and 0.90 m
    /// after a minute.
    #[test]
    fn the_bias_walks_and_forgets() {
        for (flown_s, expected_m) in [(0.0, 0.0), (10.0, 0.136), (60.0, 0.90)] {
            let m = bias_m(flown_s);
            assert!((m - expected_m).abs() < 0.015, "{m} after {flown_s} s");
        }
    }

    #[test]
    fn it_only_grows() {
        let mut uncertainty = Uncertainty::default();
        let mut last_m = uncertainty.horizontal_m(0.0, 0.0, 0.0);
        for step in 0..100 {
            uncertainty.fly(0.066);
            if step % 10 == 0 {
                uncertainty.fly_unseen(0.2, Vector2::zeros(), Vector2::zeros());
            }
            let now_m = uncertainty.horizontal_m(0.0, 0.0, 0.0);
            assert!(now_m > last_m);
            last_m = now_m;
        }
        assert!(uncertainty.horizontal_m(3.0, 0.0, 0.0) > last_m);
        assert!(uncertainty.horizontal_m(0.0, 1.0, 0.0) > last_m);
        let before_m = uncertainty.vertical_m(0.0);
        uncertainty.step_of_the_floor();
        assert!(uncertainty.vertical_m(0.0) > before_m);
        let before_m = uncertainty.horizontal_m(3.0, 0.0, 0.0);
        uncertainty.step_of_the_heading();
        assert!(uncertainty.horizontal_m(3.0, 0.0, 0.0) > before_m);
    }

    #[test]
    fn what_was_flown_unseen_counts_by_the_speed_that_was_flown() {
        let unseen_m = |before_m_s: f64, after_m_s: f64| {
            let mut uncertainty = Uncertainty::default();
            let along = |m_s| Vector2::new(m_s, 0.0);
            uncertainty.fly_unseen(1.0, along(before_m_s), along(after_m_s));
            uncertainty.horizontal_m(0.0, 0.0, 0.0)
        };
        assert!(unseen_m(0.0, 0.0) < 0.2);
        assert!((0.5..0.8).contains(&unseen_m(2.5, 2.5)), "it flew on");
        assert!(unseen_m(2.5, 0.0) > 1.0, "the time of braking is unknown");
        let silent_m = |speed_m_s| Uncertainty::default().horizontal_m(0.0, 1.0, speed_m_s);
        assert!(silent_m(2.5) > silent_m(0.0) + 0.4);
    }

    fn assert_near(value: f64, expected: f64) {
        assert!((value - expected).abs() < 1e-9, "{value} is not {expected}");
    }

    /// The deviation by the covariance of a bias that decays and is pushed at random, integrated in small
    /// steps.
    #[test]
    fn the_bias_follows_its_covariance() {
        const STEP_S: f64 = 0.01;
        let (mut bias, mut shared, mut place) = (BIAS_M_S * BIAS_M_S, 0.0, 0.0);
        for step in 1..=60_000_u32 {
            place += 2.0 * shared * STEP_S;
            shared += (bias - shared / BIAS_TIME_S) * STEP_S;
            bias += (BIAS_WALK_M_S * BIAS_WALK_M_S - 2.0 * bias / BIAS_TIME_S) * STEP_S;
            if [300, 3_000, 12_000, 60_000].contains(&step) {
                let flown_s = STEP_S * f64::from(step);
                let (m, expected_m) = (bias_m(flown_s), place.sqrt());
                assert!((m / expected_m - 1.0).abs() < 0.003, "{flown_s} s: {m}, {expected_m}");
            }
        }
    }

    #[test]
    fn each_part_adds_by_its_own_rule_and_independently() {
        let fresh = Uncertainty::default();
        assert_near(fresh.horizontal_m(0.0, 0.0, 0.0), FLOOR_M);
        assert_near(fresh.horizontal_m(3.0, 0.0, 0.0), FLOOR_M.hypot(SCALE * 3.0));
        // 100 s of drift are 3 degrees, four steps of the compass are 4: together 5 degrees.
        let mut turned = Uncertainty::default();
        for _ in 0..50 {
            turned.fly(2.0);
        }
        (0..4).for_each(|_| turned.step_of_the_heading());
        let at_start_m = turned.horizontal_m(0.0, 0.0, 0.0);
        assert_near(at_start_m, FLOOR_M.hypot(bias_m(100.0)));
        let aside_m = 5_f64.to_radians() * 3.0;
        let far_m = at_start_m.hypot(SCALE * 3.0).hypot(aside_m);
        assert_near(turned.horizontal_m(3.0, 0.0, 0.0), far_m);
        // Two seconds of silence at 3 m/s: 0.15 m/s, a fifth of the speed, and 0.3 m/s² for two seconds.
        assert_near(Uncertainty::silence_m(2.0, 3.0), (0.15 + 0.6 + 0.6) * 2.0);
        assert_near(fresh.horizontal_m(0.0, 2.0, 3.0), FLOOR_M.hypot(2.7));
    }

    #[test]
    fn gaps_are_independent_of_each_other_and_rejected_velocities_are_not() {
        let unseen_m = |gap_s, before_m_s, after_m_s| {
            let mut uncertainty = Uncertainty::default();
            uncertainty.fly_unseen(gap_s, before_m_s, after_m_s);
            uncertainty.unmeasured_m2().sqrt()
        };
        let (still, along, aside) =
            (Vector2::zeros(), Vector2::new(2.0, 0.0), Vector2::new(0.0, 1.5));
        assert_near(unseen_m(1.0, still, still), 0.15);
        assert_near(unseen_m(2.0, along, along), (0.15 + 0.2 * 2.0) * 2.0);
        assert_near(unseen_m(1.0, still, along), 0.15 + 0.2 * 2.0 + 0.25 * 2.0);
        assert_near(unseen_m(1.0, along, aside), 0.15 + 0.2 * 2.0 + 0.25 * 2.5);
        // After two seconds the drone is alone and drifts with half a metre per second more.
        assert_near(unseen_m(3.0, still, still), 0.15 * 3.0 + 0.5);
        let mut uncertainty = Uncertainty::default();
        uncertainty.fly_unseen(1.0, still, still);
        uncertainty.fly_unseen(2.0, still, still);
        assert_near(uncertainty.unmeasured_m2(), 0.15_f64.powi(2) + 0.3_f64.powi(2));
        // A rejected velocity is wrong by the same error for as long as it is rejected; above 1.2 m/s it is
        // hardly that of a drone.
        uncertainty.fly_disputed(0.5, 0.8);
        uncertainty.fly_disputed(0.5, 5.0);
        let disputed_m: f64 = 0.5 * 0.8 + 0.5 * MAX_DISPUTED_M_S;
        let unseen_m2 = 0.15_f64.powi(2) + 0.3_f64.powi(2);
        assert_near(uncertainty.unmeasured_m2(), unseen_m2 + disputed_m.powi(2));
        let known_m = uncertainty.horizontal_m(0.0, 0.0, 0.0);
        assert_near(known_m, FLOOR_M.hypot(uncertainty.unmeasured_m2().sqrt()));
    }

    #[test]
    fn a_height_is_as_good_as_its_echo_until_the_floor_steps_or_silence_begins() {
        let mut uncertainty = Uncertainty::default();
        assert_near(uncertainty.vertical_m(0.0), HEIGHT_M);
        assert_near(uncertainty.vertical_m(2.0), HEIGHT_M.hypot(0.6));
        (0..4).for_each(|_| uncertainty.step_of_the_floor());
        assert_near(uncertainty.vertical_m(0.0), HEIGHT_M.hypot(2.0 * FLOOR_STEP_M));
        let mut restarted = Uncertainty::default();
        (0..4).for_each(|_| restarted.handle_restart());
        assert_near(restarted.vertical_m(0.0), HEIGHT_M.hypot(2.0 * RESTART_M));
    }
}
