//! Motion that was not measured: how far the drone may have come meanwhile.
//!
//! What measured flight adds to the uncertainty is in the covariance of [`crate::world`].

use nalgebra::Vector2;

use crate::silence::KEPT_S;

/// Standard deviation of the velocity while nothing is received: in a hover, as a fraction of the speed, and
/// as a fraction of the change of speed meanwhile.
const UNSEEN_M_S: f64 = 0.15;
const UNSEEN_SPEED: f64 = 0.2;
const UNSEEN_CHANGE: f64 = 0.25;
/// Until it is known, the change may be that of more than half of full tilt.
const UNSEEN_M_S2: f64 = 1.2;
/// Then a drone that receives nothing hovers and lands by itself, and drifts in the wind.
const ALONE_M_S: f64 = 0.5;
/// Limit up to which a rejected velocity counts; a larger one is hardly that of a drone.
const MAX_DISPUTED_M_S: f64 = 1.2;

/// Standard deviation of the position after a time in which only this speed and its change are known.
fn unseen_m(unseen_s: f64, speed_m_s: f64, change_m_s: f64) -> f64 {
    (UNSEEN_M_S + UNSEEN_SPEED * speed_m_s + UNSEEN_CHANGE * change_m_s) * unseen_s
}

/// Standard deviation of the position that a silence adds that has not ended, at a speed before.
pub(crate) fn silence_m(silence_s: f64, speed_m_s: f64) -> f64 {
    unseen_m(silence_s, speed_m_s, UNSEEN_M_S2 * silence_s)
}

/// Contributions to the uncertainty.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Uncertainty {
    unseen_m2: f64,
    /// Distance flown if the rejected velocities were right after all.
    disputed_m: f64,
}

impl Uncertainty {
    /// Adds a gap: of the velocity only its values before and after are known.
    pub(crate) fn fly_unseen(
        &mut self,
        gap_s: f64,
        before_m_s: Vector2<f64>,
        after_m_s: Vector2<f64>,
    ) {
        let speed_m_s = before_m_s.norm().max(after_m_s.norm());
        let alone_m = ALONE_M_S * (gap_s - KEPT_S).max(0.0);
        let gap_m = unseen_m(gap_s, speed_m_s, (after_m_s - before_m_s).norm());
        self.unseen_m2 += (gap_m + alone_m).powi(2);
    }

    /// Adds a step with a rejected velocity that differed this much from the expected one.
    pub(crate) fn fly_disputed(&mut self, step_s: f64, surprise_m_s: f64) {
        self.disputed_m += surprise_m_s.min(MAX_DISPUTED_M_S) * step_s;
    }

    /// Variance of the position on each axis from motion that was not measured or was rejected.
    pub(crate) fn unmeasured_m2(&self) -> f64 {
        self.unseen_m2 + self.disputed_m * self.disputed_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_near(value: f64, expected: f64) {
        assert!((value - expected).abs() < 1e-9, "{value} is not {expected}");
    }

    #[test]
    fn a_silence_counts_by_the_speed_before_it_and_by_what_may_have_changed() {
        // Two seconds at 3 m/s: 0.15 m/s, a fifth of the speed, and a quarter of 1.2 m/s² for two seconds.
        assert_near(silence_m(2.0, 3.0), (0.15 + 0.6 + 0.6) * 2.0);
        assert_near(silence_m(0.0, 3.0), 0.0);
        assert!(silence_m(1.0, 2.5) > silence_m(1.0, 0.0) + 0.4);
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
    }
}
