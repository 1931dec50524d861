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
        HEIGHT_M.hypot(steps_m).hypot(UNSEEN_CLIMB_M_S * silence_s)
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
}
