//! Set-points of an operator's program: where the drone shall be, or how fast it shall fly, several times a second.

use kinematics::{Pose, world_from_body, wrap_deg};
use nalgebra::Vector2;

/// Fastest horizontal velocity that is followed, in m/s: that of the controller's default reference.
const SPEED_MAX_M_S: f64 = 2.2;
/// Fastest climb and descent, in m/s.
const CLIMB_MAX_M_S: f64 = 0.75;
/// Fastest turn, in degrees/s.
const TURN_MAX_DEG_S: f64 = 60.0;
/// The place that moves with a wanted velocity is never further from the drone than this, horizontally and vertically, in
/// metres: a drone that cannot follow must not run after it later.
const LEASH_M: f64 = 1.2;
/// Likewise for its heading, in degrees.
const LEASH_DEG: f64 = 45.0;

/// What an operator's program wants in this moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setpoint {
    /// Horizontally.
    pub horizontal: Horizontal,
    /// Vertically.
    pub vertical: Vertical,
    /// Heading.
    pub heading: Heading,
}

/// Horizontal part of a [`Setpoint`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Horizontal {
    /// This place, in metres in the estimator's frame.
    Place {
        /// Right of the start.
        x_m: f64,
        /// Forward of the start.
        y_m: f64,
    },
    /// This velocity, in m/s in the estimator's frame.
    Velocity {
        /// To the right of the start.
        x_m_s: f64,
        /// Forward of the start.
        y_m_s: f64,
    },
    /// This velocity, in m/s as seen from the drone.
    BodyVelocity {
        /// To its right.
        right_m_s: f64,
        /// Forward.
        forward_m_s: f64,
    },
}

/// Vertical part of a [`Setpoint`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Vertical {
    /// This height, in metres above the floor of the start.
    Height(f64),
    /// This rate of climb, in m/s.
    Climb(f64),
}

/// Heading of a [`Setpoint`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Heading {
    /// As it is.
    Keep,
    /// This one, in degrees clockwise from that of the start.
    Yaw(f64),
    /// This rate of turn, in degrees/s, clockwise.
    Turn(f64),
}

impl Setpoint {
    /// Whether all its numbers are finite.
    pub(super) fn is_finite(&self) -> bool {
        let horizontal = match self.horizontal {
            Horizontal::Place { x_m: x, y_m: y }
            | Horizontal::Velocity { x_m_s: x, y_m_s: y }
            | Horizontal::BodyVelocity { right_m_s: x, forward_m_s: y } => {
                x.is_finite() && y.is_finite()
            }
        };
        let (Vertical::Height(vertical) | Vertical::Climb(vertical)) = self.vertical;
        let heading = match self.heading {
            Heading::Keep => true,
            Heading::Yaw(angle) | Heading::Turn(angle) => angle.is_finite(),
        };
        horizontal && vertical.is_finite() && heading
    }

    /// The pose to be flown to after another `step_s`, if it was `target` and the drone is at `pose`.
    pub(super) fn target(&self, target: &Pose, pose: &Pose, step_s: f64) -> Pose {
        let moved = |velocity_m_s: Vector2<f64>| {
            let place = Vector2::new(target.x_m, target.y_m)
                + velocity_m_s.cap_magnitude(SPEED_MAX_M_S) * step_s;
            let here = Vector2::new(pose.x_m, pose.y_m);
            here + (place - here).cap_magnitude(LEASH_M)
        };
        let place = match self.horizontal {
            Horizontal::Place { x_m, y_m } => Vector2::new(x_m, y_m),
            Horizontal::Velocity { x_m_s, y_m_s } => moved(Vector2::new(x_m_s, y_m_s)),
            Horizontal::BodyVelocity { right_m_s, forward_m_s } => {
                moved(world_from_body(Vector2::new(right_m_s, forward_m_s), pose.yaw_deg))
            }
        };
        let z_m = match self.vertical {
            Vertical::Height(height_m) => height_m,
            Vertical::Climb(climb_m_s) => {
                let moved = target.z_m + climb_m_s.clamp(-CLIMB_MAX_M_S, CLIMB_MAX_M_S) * step_s;
                pose.z_m + (moved - pose.z_m).clamp(-LEASH_M, LEASH_M)
            }
        };
        let yaw_deg = match self.heading {
            Heading::Keep => target.yaw_deg,
            Heading::Yaw(yaw_deg) => yaw_deg,
            Heading::Turn(turn_deg_s) => {
                let turn_deg_s = turn_deg_s.clamp(-TURN_MAX_DEG_S, TURN_MAX_DEG_S);
                let ahead_deg = wrap_deg(target.yaw_deg + turn_deg_s * step_s - pose.yaw_deg);
                pose.yaw_deg + ahead_deg.clamp(-LEASH_DEG, LEASH_DEG)
            }
        };
        Pose { x_m: place.x, y_m: place.y, z_m, yaw_deg: wrap_deg(yaw_deg) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERE: Pose = Pose { x_m: 1.0, y_m: 2.0, z_m: 1.0, yaw_deg: 90.0 };

    fn setpoint(horizontal: Horizontal) -> Setpoint {
        Setpoint { horizontal, vertical: Vertical::Climb(0.0), heading: Heading::Keep }
    }

    #[track_caller]
    fn assert_pose(pose: &Pose, [x_m, y_m, z_m, yaw_deg]: [f64; 4]) {
        let off = (pose.x_m - x_m).abs() + (pose.y_m - y_m).abs() + (pose.z_m - z_m).abs();
        assert!(off + (pose.yaw_deg - yaw_deg).abs() < 1e-9, "{pose:?}");
    }

    #[test]
    fn a_place_is_flown_to_and_a_velocity_moves_the_place() {
        let there = setpoint(Horizontal::Place { x_m: -3.0, y_m: 4.0 });
        assert_pose(&there.target(&HERE, &HERE, 0.03), [-3.0, 4.0, 1.0, 90.0]);
        let right = setpoint(Horizontal::Velocity { x_m_s: 1.0, y_m_s: 0.0 });
        assert_pose(&right.target(&HERE, &HERE, 0.1), [1.1, 2.0, 1.0, 90.0]);
        // The drone looks to the right.
        let forward = setpoint(Horizontal::BodyVelocity { right_m_s: 0.0, forward_m_s: 1.0 });
        assert_pose(&forward.target(&HERE, &HERE, 0.1), [1.1, 2.0, 1.0, 90.0]);
    }

    #[test]
    fn height_and_heading_are_wanted_or_change() {
        let still = Horizontal::Velocity { x_m_s: 0.0, y_m_s: 0.0 };
        let (vertical, heading) = (Vertical::Height(1.5), Heading::Yaw(-170.0));
        let there = Setpoint { horizontal: still, vertical, heading };
        assert_pose(&there.target(&HERE, &HERE, 0.1), [1.0, 2.0, 1.5, -170.0]);
        let (vertical, heading) = (Vertical::Climb(-0.5), Heading::Turn(20.0));
        let moves = Setpoint { horizontal: still, vertical, heading };
        assert_pose(&moves.target(&HERE, &HERE, 0.1), [1.0, 2.0, 0.95, 92.0]);
    }

    #[test]
    fn a_drone_that_does_not_follow_is_not_left_behind() {
        let far = Pose { x_m: 50.0, z_m: 9.0, yaw_deg: -90.0, ..HERE };
        let (vertical, heading) = (Vertical::Climb(99.0), Heading::Turn(999.0));
        let horizontal = Horizontal::Velocity { x_m_s: 99.0, y_m_s: 0.0 };
        let moves = Setpoint { horizontal, vertical, heading };
        let target = moves.target(&far, &HERE, 0.03);
        assert_pose(&target, [1.0 + LEASH_M, 2.0, 1.0 + LEASH_M, 45.0]);
        let target = moves.target(&HERE, &HERE, 1.0);
        assert_pose(&target, [1.0 + LEASH_M, 2.0, 1.0 + CLIMB_MAX_M_S, 135.0]);
    }

    #[test]
    fn numbers_must_be_finite() {
        let still = setpoint(Horizontal::Place { x_m: 0.0, y_m: 0.0 });
        assert!(still.is_finite());
        let horizontal = Horizontal::BodyVelocity { right_m_s: f64::NAN, forward_m_s: 0.0 };
        assert!(!Setpoint { horizontal, ..still }.is_finite());
        assert!(!Setpoint { vertical: Vertical::Climb(f64::INFINITY), ..still }.is_finite());
        assert!(!Setpoint { heading: Heading::Turn(f64::NAN), ..still }.is_finite());
    }
}
