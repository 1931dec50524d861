//! Position control with one of two laws.

use kinematics::{DroneLimits, Sticks};

use crate::cascade::{Cascade, CascadeConfig};
use crate::inputs::Inputs;
use crate::tum::TumLaw;

/// Control law for approaching and holding a pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Law {
    /// Reference trajectory, feed-forward, and feedback on the predicted state.
    #[default]
    Cascade,
    /// The law of `tum_ardrone`, for comparison.
    Tum,
}

impl Law {
    /// All laws.
    pub const ALL: [Self; 2] = [Self::Cascade, Self::Tum];

    /// Its name in settings and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cascade => "cascade",
            Self::Tum => "tum",
        }
    }

    /// Whether it uses the state predicted for the time when a command takes effect, instead of the measured
    /// one.
    pub fn predicts(self) -> bool {
        self == Self::Cascade
    }
}

/// Approaches and holds a pose.
#[derive(Debug, Clone)]
pub struct PositionController {
    law: Flying,
}

#[derive(Debug, Clone)]
enum Flying {
    Cascade(Box<Cascade>),
    Tum(TumLaw),
}

impl Default for PositionController {
    fn default() -> Self {
        Self::new(Law::default(), CascadeConfig::default(), DroneLimits::default())
    }
}

impl PositionController {
    /// A controller in its initial state; `config` and the drone's limits apply to [`Law::Cascade`].
    pub fn new(law: Law, config: CascadeConfig, limits: DroneLimits) -> Self {
        let law = match law {
            Law::Cascade => Flying::Cascade(Box::new(Cascade::new(config, limits))),
            Law::Tum => Flying::Tum(TumLaw::default()),
        };
        Self { law }
    }

    /// Stick fractions for the next step, within the limit. Inputs that are NaN result in no motion.
    pub fn step(&mut self, inputs: &Inputs<'_>) -> Sticks {
        if !inputs.is_finite() {
            return Sticks::default();
        }
        let inputs = Inputs { limit: inputs.limit.clamp(0.0, 1.0), ..*inputs };
        match &mut self.law {
            Flying::Cascade(law) => law.step(&inputs),
            Flying::Tum(law) => law.step(&inputs),
        }
    }

    /// The drone holds by itself: resets the reference and keeps the integrals.
    pub fn rest(&mut self) {
        match &mut self.law {
            Flying::Cascade(law) => law.rest(),
            Flying::Tum(_) => {}
        }
    }

    /// Resets the reference and the integrals.
    pub fn reset(&mut self) {
        match &mut self.law {
            Flying::Cascade(law) => law.reset(),
            Flying::Tum(law) => *law = TumLaw::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use kinematics::{Airframe, Pose, Velocity};
    use nalgebra::Vector2;

    use super::*;
    use crate::course::Course;

    const LAWS: [Law; 2] = Law::ALL;

    /// Sticks after a while at one place.
    fn demand(law: Law, pose: Pose, target: Pose, limit: f64) -> Sticks {
        let mut controller =
            PositionController::new(law, CascadeConfig::default(), DroneLimits::default());
        let step = |controller: &mut PositionController, target: &Pose| {
            let velocity = &Velocity::default();
            controller.step(&Inputs {
                pose: &pose,
                velocity,
                target,
                disturbance_m_s2: Vector2::zeros(),
                airframe: Airframe::default(),
                step_s: 0.03,
                limit,
                speed_m_s: 99.0,
                course: None,
            })
        };
        step(&mut controller, &pose);
        (0..10).map(|_| step(&mut controller, &target)).last().unwrap()
    }

    #[test]
    fn each_error_moves_the_stick_that_mends_it() {
        for law in LAWS {
            let here = Pose::default();
            let ahead = demand(law, here, Pose { y_m: 1.0, ..here }, 1.0);
            assert!(ahead.pitch < -0.1 && ahead.roll.abs() < 1e-9, "{ahead:?}");
            let right = demand(law, here, Pose { x_m: 1.0, ..here }, 1.0);
            assert!(right.roll > 0.1 && right.pitch.abs() < 1e-9, "{right:?}");
            assert!(demand(law, here, Pose { z_m: 0.2, ..here }, 1.0).gaz > 0.1);
            assert!(demand(law, here, Pose { z_m: -0.2, ..here }, 1.0).gaz < -0.1);
            assert!(demand(law, here, Pose { yaw_deg: 20.0, ..here }, 1.0).yaw > 0.1);
        }
    }

    #[test]
    fn a_turned_drone_flies_to_the_same_place() {
        for law in LAWS {
            // Facing right: a target to the right is ahead.
            let pose = Pose { yaw_deg: 90.0, ..Pose::default() };
            let demand = demand(law, pose, Pose { x_m: 1.0, ..pose }, 1.0);
            assert!(demand.pitch < -0.1 && demand.roll.abs() < 1e-9, "{demand:?}");
        }
    }

    #[test]
    fn yaw_goes_the_short_way_round() {
        for law in LAWS {
            let pose = Pose { yaw_deg: 171.0, ..Pose::default() };
            for yaw_deg in [-170.0, 181.0 + 360.0] {
                assert!(demand(law, pose, Pose { yaw_deg, ..pose }, 1.0).yaw > 0.0);
            }
        }
    }

    #[test]
    fn the_limit_holds_on_every_axis_at_every_heading() {
        for (law, yaw_deg) in LAWS.into_iter().flat_map(|law| (0..360).map(move |yaw| (law, yaw))) {
            let pose = Pose { yaw_deg: f64::from(yaw_deg), ..Pose::default() };
            let target = Pose { x_m: 9.0, y_m: -7.0, z_m: 5.0, yaw_deg: pose.yaw_deg + 179.0 };
            let demand = demand(law, pose, target, 0.3);
            for stick in [demand.roll, demand.pitch, demand.gaz, demand.yaw] {
                assert!(stick.abs() <= 0.3 + 1e-12, "{demand:?}");
            }
        }
    }

    #[test]
    fn the_cascade_follows_a_course() {
        let here = Pose::default();
        let mut controller = PositionController::default();
        let mut step = |course: Option<&Course>| {
            controller.step(&Inputs {
                pose: &here,
                velocity: &Velocity::default(),
                target: &here,
                disturbance_m_s2: Vector2::zeros(),
                airframe: Airframe::default(),
                step_s: 0.03,
                limit: 1.0,
                speed_m_s: 99.0,
                course,
            })
        };
        assert_eq!(step(None), Sticks::default());
        let forward = Course::new(Vector2::zeros(), Vector2::new(0.0, 0.5));
        let demand = step(Some(&forward));
        assert!(demand.pitch < -0.1 && demand.roll.abs() < 1e-9, "{demand:?}");
        assert!(step(None).pitch.abs() < 0.01, "it is at the target");
        let nowhere = Course::new(Vector2::new(0.0, f64::NAN), Vector2::zeros());
        assert_eq!(step(Some(&nowhere)), Sticks::default());
    }

    #[test]
    fn what_is_no_number_moves_nothing_and_spoils_nothing() {
        for (law, bad) in LAWS
            .into_iter()
            .flat_map(|law| [f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(|bad| (law, bad)))
        {
            let mut controller =
                PositionController::new(law, CascadeConfig::default(), DroneLimits::default());
            let good = Pose::default();
            let target = Pose { y_m: 1.0, ..good };
            for pose in [Pose { x_m: bad, ..good }, Pose { yaw_deg: bad, ..good }] {
                let velocity = &Velocity::default();
                let inputs = Inputs {
                    pose: &pose,
                    velocity,
                    target: &target,
                    disturbance_m_s2: Vector2::zeros(),
                    airframe: Airframe::default(),
                    step_s: 0.03,
                    limit: 1.0,
                    speed_m_s: 99.0,
                    course: None,
                };
                assert_eq!(controller.step(&inputs), Sticks::default());
                let demand = controller.step(&Inputs { pose: &good, ..inputs });
                assert!(demand.pitch.is_finite() && demand.pitch <= 0.0);
            }
        }
    }
}
