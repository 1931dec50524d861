//! The wind: one estimate, for whoever asks what it does to the drone.
//!
//! The newest disturbance follows every gust. Its mean over one time constant is what lasts: a storm moves it, the sooner the
//! stronger it is, and nothing else needs to remember for how long it has been blowing.

use estimator::Prediction;
use kinematics::Airframe;
use nalgebra::Vector2;

/// Time constant of the mean, in seconds: longer than a gust, shorter than a storm needs to carry a drone over a fence.
const TIME_S: f64 = 1.0;
/// Smallest wind that is a storm, as a share of full tilt. In less a drone that cannot brake before the fence is too fast by
/// its own sticks, and turns or brakes by them.
pub(crate) const STORM: f64 = 0.7;

/// The mean disturbance of the drone. It refers to a drone at rest: one that moves with the wind experiences less of it.
#[allow(clippy::struct_field_names, reason = "the unit belongs to the name")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wind {
    /// Towards right and forward.
    mean_m_s2: Vector2<f64>,
    /// The mean when the drone was last not flown to a place. It contains the errors of the airframe and of the level.
    usual_m_s2: Vector2<f64>,
    full_tilt_m_s2: f64,
}

impl Wind {
    /// No wind, for a drone that accelerates with this at full tilt in still air.
    pub(crate) const fn calm(full_tilt_m_s2: f64) -> Self {
        let none = Vector2::new(0.0, 0.0);
        Self { mean_m_s2: none, usual_m_s2: none, full_tilt_m_s2 }
    }

    /// Takes in the disturbance of one tick, felt by a drone that accelerates with `full_tilt_m_s2` at full tilt.
    pub(crate) fn feel(
        &mut self,
        disturbance_m_s2: Vector2<f64>,
        full_tilt_m_s2: f64,
        step_s: f64,
    ) {
        let share = (step_s / TIME_S).min(1.0);
        self.mean_m_s2 += (disturbance_m_s2 - self.mean_m_s2) * share;
        self.full_tilt_m_s2 = full_tilt_m_s2;
    }

    /// The drone is not flown to a place: so it blows usually.
    pub(crate) fn is_usual(&mut self) {
        self.usual_m_s2 = self.mean_m_s2;
    }

    /// What lasts: right, forward.
    pub(crate) fn mean_m_s2(&self) -> Vector2<f64> {
        self.mean_m_s2
    }

    /// What lasts, as a share of full tilt.
    pub(crate) fn share(&self) -> f64 {
        self.mean_m_s2.norm() / self.full_tilt_m_s2
    }

    /// What lasts in a direction, a unit vector, as a share of full tilt.
    pub(crate) fn lasting(&self, direction: &Vector2<f64>) -> f64 {
        self.mean_m_s2.dot(direction) / self.full_tilt_m_s2
    }

    /// Deceleration at full tilt against a motion in this wind, as a share of full tilt, and a drag.
    pub(crate) fn braking_m_s2(&self, share: f64, drag_1_s: f64, speed_m_s: f64) -> f64 {
        self.full_tilt_m_s2 * (1.0 - share) + drag_1_s * speed_m_s / 2.0
    }

    /// Whether it blows more than usual by a storm: one, or a velocity measurement that drifts. Full tilt is that of the
    /// drone as configured: the identification may take what pushes it for a weakness of its own.
    pub(crate) fn has_risen(&self, configured_full_tilt_m_s2: f64) -> bool {
        (self.mean_m_s2 - self.usual_m_s2).norm() > STORM * configured_full_tilt_m_s2
    }
}

/// The disturbance without what the strongest drag explains: against the motion it may be drag that is not identified yet.
pub(crate) fn without_drag(state: &Prediction, drag_1_s: f64) -> Vector2<f64> {
    let velocity_m_s = state.velocity_m_s.xy();
    let speed_m_s = velocity_m_s.norm();
    let along = velocity_m_s / speed_m_s.max(f64::EPSILON);
    let [_, strongest_1_s] = Airframe::DRAGS_1_S;
    let most_m_s2 = (strongest_1_s - drag_1_s).max(0.0) * speed_m_s;
    let disturbance_m_s2 = state.newest_disturbance_m_s2;
    let against_m_s2 = -disturbance_m_s2.dot(&along);
    disturbance_m_s2 + along * against_m_s2.clamp(0.0, most_m_s2)
}

#[cfg(test)]
impl Wind {
    /// A wind that has been even for long: right and forward, as shares of full tilt.
    pub(crate) fn steady(share: [f64; 2], full_tilt_m_s2: f64) -> Self {
        let mean_m_s2 = Vector2::from(share) * full_tilt_m_s2;
        Self { mean_m_s2, ..Self::calm(full_tilt_m_s2) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RIGHT: Vector2<f64> = Vector2::new(1.0, 0.0);
    const FORWARD: Vector2<f64> = Vector2::new(0.0, 1.0);

    fn felt(mut wind: Wind, disturbance_m_s2: impl Fn(u32) -> [f64; 2], ticks: u32) -> Wind {
        for tick in 0..ticks {
            wind.feel(disturbance_m_s2(tick).into(), 2.0, 0.01);
        }
        wind
    }

    #[test]
    fn what_lasts_is_known_after_its_time_and_a_gust_passes() {
        let storm = |ticks| felt(Wind::calm(2.0), |_| [2.0, -1.0], ticks);
        let later = storm(100);
        assert!((later.lasting(&RIGHT) - 0.634).abs() < 0.001, "{later:?}");
        assert!((later.lasting(&-FORWARD) - 0.317).abs() < 0.001, "{later:?}");
        assert!((later.share() - 0.634_f64.hypot(0.317)).abs() < 0.001, "{later:?}");
        assert!(storm(1500).lasting(&RIGHT) > 0.999);
        let gusty =
            felt(Wind::calm(2.0), |tick| [if tick % 2 == 0 { 4.0 } else { -4.0 }, 2.1], 3000);
        assert!(gusty.lasting(&RIGHT).abs() < 0.02, "{gusty:?}");
        assert!(gusty.lasting(&FORWARD) > 1.0 && gusty.lasting(&-FORWARD) < -1.0, "{gusty:?}");
    }

    #[test]
    fn a_storm_takes_seven_tenths_of_full_tilt_more_than_usual() {
        let after = |usual: f64, then_m_s2: f64| {
            let mut wind = Wind::steady([usual, 0.0], 2.0);
            wind.is_usual();
            felt(wind, |_| [then_m_s2, 0.0], 3000).has_risen(2.0)
        };
        assert!(!after(0.75, 1.5), "it was there");
        assert!(!after(0.0, 1.39), "a breeze");
        assert!(after(0.0, 1.41) && after(0.75, 0.09));
    }

    #[test]
    fn one_that_feels_nothing_for_longer_than_its_time_knows_the_newest_only() {
        let mut wind = Wind::calm(1.0);
        wind.feel(Vector2::new(3.0, 4.0), 10.0, 2.0 * TIME_S);
        assert_eq!(wind, Wind::steady([0.3, 0.4], 10.0));
        assert!((wind.share() - 0.5).abs() < 1e-12);
    }

    #[test]
    fn wind_along_takes_from_the_braking_and_drag_adds() {
        let braking_m_s2 = Wind::calm(2.0).braking_m_s2(0.75, 0.2, 3.0);
        assert!((braking_m_s2 - 0.8).abs() < 1e-12, "{braking_m_s2}");
    }

    #[test]
    fn a_disturbance_against_the_motion_may_be_drag() {
        let state = |velocity: [f64; 2], disturbance: [f64; 2]| Prediction {
            velocity_m_s: Vector2::from(velocity).push(0.0),
            newest_disturbance_m_s2: disturbance.into(),
            ..Prediction::default()
        };
        let left = |velocity, disturbance| without_drag(&state(velocity, disturbance), 0.95);
        assert!((left([0.5, 0.0], [-0.8, 0.3]) - Vector2::new(-0.3, 0.3)).norm() < 1e-9);
        assert!((left([0.5, 0.0], [-0.4, 0.3]) - Vector2::new(0.0, 0.3)).norm() < 1e-9);
        assert!((left([0.5, 0.0], [0.8, 0.3]) - Vector2::new(0.8, 0.3)).norm() < 1e-9, "along");
        assert!((left([0.0, 0.0], [-0.8, 0.3]) - Vector2::new(-0.8, 0.3)).norm() < 1e-9);
    }
}
