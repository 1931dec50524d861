//! Setpoints of an operator's program: where the drone shall be, or how fast it shall fly, several times a second.

use kinematics::{Pose, world_from_body, wrap_deg};
use nalgebra::Vector2;
use pid::{Course, MotionLimits};
use serde::{Deserialize, Serialize};

use crate::fence::{Border, Wall};
use crate::safety::stopping_inside_m_s;

/// Fastest climb and descent, in m/s.
const CLIMB_MAX_M_S: f64 = 0.75;
/// Fastest turn, in degrees/s.
const TURN_MAX_DEG_S: f64 = 60.0;
/// The place that moves as it is wanted is never further from the drone than this, in metres: a drone that cannot follow
/// must not run after it later.
const LEASH_M: f64 = 0.6;
/// Likewise for its height.
const CLIMB_LEASH_M: f64 = 1.2;
/// Likewise for its heading, in degrees.
const LEASH_DEG: f64 = 45.0;

/// What an operator's program wants in this moment.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Setpoint {
    /// Horizontally.
    pub horizontal: Horizontal,
    /// Vertically.
    pub vertical: Vertical,
    /// Heading.
    pub heading: Heading,
}

/// Horizontal part of a [`Setpoint`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Horizontal {
    /// This place, in metres in the world, whose origin is the start unless that is surveyed.
    Place {
        /// Right of the origin.
        x_m: f64,
        /// Forward of the origin.
        y_m: f64,
    },
    /// This velocity, in m/s along the axes of the world.
    Velocity {
        /// Along x, to the right.
        x_m_s: f64,
        /// Along y, forward.
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
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Vertical {
    /// This height, in metres above the floor of the start.
    #[serde(rename = "height_m")]
    Height(f64),
    /// This rate of climb, in m/s, of which 0.75 m/s up or down are flown at most.
    #[serde(rename = "climb_m_s")]
    Climb(f64),
}

/// Heading of a [`Setpoint`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Heading {
    /// As it is.
    #[serde(rename = "keep")]
    Keep,
    /// This one, in degrees clockwise from the world's forward axis.
    #[serde(rename = "yaw_deg")]
    Yaw(f64),
    /// This rate of turn, in degrees/s, clockwise, of which 60 degrees/s are flown at most.
    #[serde(rename = "turn_deg_s")]
    Turn(f64),
}

impl Setpoint {
    /// Whether all its numbers are finite.
    pub fn is_finite(&self) -> bool {
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

    /// Moves a course as this setpoint wants, for `step_s`. The drone is at `pose`; the course stays inside the border by
    /// `by_m`. A drone that slows down is also braked by its drag.
    pub(super) fn advance(
        &self,
        course: &mut Course,
        pose: &Pose,
        (limits, drag_1_s): (&MotionLimits, f64),
        (border, by_m): (&Border, f64),
        step_s: f64,
    ) {
        let wanted_m_s = match self.horizontal {
            Horizontal::Place { x_m, y_m } => {
                let place_m = border.nearest_inside(Vector2::new(x_m, y_m), by_m);
                course.velocity_to(&place_m, limits)
            }
            Horizontal::Velocity { x_m_s, y_m_s } => Vector2::new(x_m_s, y_m_s),
            Horizontal::BodyVelocity { right_m_s, forward_m_s } => {
                world_from_body(Vector2::new(right_m_s, forward_m_s), pose.yaw_deg)
            }
        };
        let wanted_m_s = capped(wanted_m_s, limits.speed_m_s);
        let here_m = Vector2::new(pose.x_m, pose.y_m);
        let inside_m_s = kept_inside_m_s(wanted_m_s, course, here_m, (border, by_m));
        let speed_m_s = course.velocity_m_s.norm();
        let slows = course.velocity_m_s.dot(&(inside_m_s - course.velocity_m_s)) < 0.0;
        let drag_m_s2 = if slows { drag_1_s * speed_m_s / 2.0 } else { 0.0 };
        let acceleration_m_s2 = limits.acceleration_m_s2 + drag_m_s2;
        course.advance(inside_m_s, &MotionLimits { acceleration_m_s2, ..*limits }, step_s);
        course.position_m = here_m + (course.position_m - here_m).cap_magnitude(LEASH_M);
    }

    /// The pose to be flown to after another `step_s`, if it was `target`, the course is there and the drone at `pose`.
    pub(super) fn target(&self, target: &Pose, course: &Course, pose: &Pose, step_s: f64) -> Pose {
        let place_m = match self.horizontal {
            Horizontal::Place { x_m, y_m } => Vector2::new(x_m, y_m),
            Horizontal::Velocity { .. } | Horizontal::BodyVelocity { .. } => course.position_m,
        };
        let z_m = match self.vertical {
            Vertical::Height(height_m) => height_m,
            Vertical::Climb(climb_m_s) => {
                let moved = target.z_m + climb_m_s.clamp(-CLIMB_MAX_M_S, CLIMB_MAX_M_S) * step_s;
                pose.z_m + (moved - pose.z_m).clamp(-CLIMB_LEASH_M, CLIMB_LEASH_M)
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
        Pose { x_m: place_m.x, y_m: place_m.y, z_m, yaw_deg: wrap_deg(yaw_deg) }
    }
}

/// A vector of at most this length. That of a huge one is not squared, which would be infinite.
fn capped(vector: Vector2<f64>, most: f64) -> Vector2<f64> {
    let length = vector.x.hypot(vector.y);
    if length > most { vector * (most / length) } else { vector }
}

/// A wanted velocity from which a drone that follows the course can stop while it is inside the border by `by_m`.
fn kept_inside_m_s(
    wanted_m_s: Vector2<f64>,
    course: &Course,
    here_m: Vector2<f64>,
    (border, by_m): (&Border, f64),
) -> Vector2<f64> {
    let is_behind = border.outside_m(here_m) > border.outside_m(course.position_m);
    let walls = border.walls(if is_behind { here_m } else { course.position_m });
    let walls = walls.map(|wall| Wall { distance_m: wall.distance_m - by_m, ..wall });
    stopping_inside_m_s(wanted_m_s, course.velocity_m_s, &walls)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::safety::Stopping;

    const HERE: Pose = Pose { x_m: 1.0, y_m: 2.0, z_m: 1.0, yaw_deg: 90.0 };

    fn setpoint(horizontal: Horizontal) -> Setpoint {
        Setpoint { horizontal, vertical: Vertical::Climb(0.0), heading: Heading::Keep }
    }

    #[track_caller]
    fn assert_pose(pose: &Pose, [x_m, y_m, z_m, yaw_deg]: [f64; 4]) {
        let off = (pose.x_m - x_m).abs() + (pose.y_m - y_m).abs() + (pose.z_m - z_m).abs();
        assert!(off + (pose.yaw_deg - yaw_deg).abs() < 1e-9, "{pose:?}");
    }

    const LIMITS: MotionLimits =
        MotionLimits { speed_m_s: 2.0, acceleration_m_s2: 1.5, jerk_m_s3: 14.0 };
    const STEP_S: f64 = 0.03;

    fn at_rest() -> Course {
        Course::new(Vector2::new(HERE.x_m, HERE.y_m), Vector2::zeros())
    }

    /// The course and the target after a time, flown by a drone that is always on its course.
    fn flown(setpoint: &Setpoint, seconds: f64, radius_m: f64) -> (Course, Pose) {
        let (mut course, mut target, mut pose) = (at_rest(), HERE, HERE);
        let mut time_s = 0.0;
        while time_s < seconds {
            let border = (&Border::circle(radius_m), 0.0);
            setpoint.advance(&mut course, &pose, (&LIMITS, 0.0), border, STEP_S);
            target = setpoint.target(&target, &course, &pose, STEP_S);
            let (x_m, y_m) = (course.position_m.x, course.position_m.y);
            pose = Pose { x_m, y_m, ..pose };
            time_s += STEP_S;
        }
        (course, target)
    }

    #[test]
    fn a_place_is_flown_to_and_a_velocity_is_flown() {
        let there = setpoint(Horizontal::Place { x_m: -3.0, y_m: 4.0 });
        let (course, target) = flown(&there, 10.0, 9.0);
        assert_pose(&target, [-3.0, 4.0, 1.0, 90.0]);
        assert!((course.position_m - Vector2::new(-3.0, 4.0)).norm() < 0.02, "{course:?}");
        // The drone looks to the right.
        for horizontal in [
            Horizontal::Velocity { x_m_s: 1.0, y_m_s: 0.0 },
            Horizontal::BodyVelocity { right_m_s: 0.0, forward_m_s: 1.0 },
        ] {
            let (course, target) = flown(&setpoint(horizontal), 3.0, 9.0);
            assert!((course.velocity_m_s - Vector2::new(1.0, 0.0)).norm() < 0.01, "{course:?}");
            assert!((target.x_m - 3.6).abs() < 0.3 && (target.y_m - 2.0).abs() < 1e-9);
        }
    }

    #[test]
    fn no_velocity_and_no_place_leads_outside() {
        for horizontal in [
            Horizontal::Velocity { x_m_s: 2.0, y_m_s: 1.0 },
            Horizontal::Velocity { x_m_s: 1e300, y_m_s: -1e300 },
            Horizontal::Place { x_m: -1e300, y_m: 1e300 },
        ] {
            let mut furthest_m: f64 = 0.0;
            let (mut course, mut pose) = (at_rest(), HERE);
            for _ in 0..900 {
                let border = (&Border::circle(4.0), 0.0);
                setpoint(horizontal).advance(&mut course, &pose, (&LIMITS, 0.0), border, STEP_S);
                pose = Pose { x_m: course.position_m.x, y_m: course.position_m.y, ..pose };
                furthest_m = furthest_m.max(course.position_m.norm());
            }
            assert!((3.8..4.05).contains(&furthest_m), "{horizontal:?}: {furthest_m:.2} m");
        }
    }

    #[test]
    fn height_and_heading_are_wanted_or_change() {
        let still = Horizontal::Velocity { x_m_s: 0.0, y_m_s: 0.0 };
        let (vertical, heading) = (Vertical::Height(1.5), Heading::Yaw(-170.0));
        let there = Setpoint { horizontal: still, vertical, heading };
        assert_pose(&there.target(&HERE, &at_rest(), &HERE, 0.1), [1.0, 2.0, 1.5, -170.0]);
        let (vertical, heading) = (Vertical::Climb(-0.5), Heading::Turn(20.0));
        let moves = Setpoint { horizontal: still, vertical, heading };
        assert_pose(&moves.target(&HERE, &at_rest(), &HERE, 0.1), [1.0, 2.0, 0.95, 92.0]);
    }

    #[test]
    fn a_drone_that_does_not_follow_is_not_left_behind() {
        let far = Pose { z_m: 9.0, yaw_deg: -90.0, ..HERE };
        let (vertical, heading) = (Vertical::Climb(99.0), Heading::Turn(999.0));
        let horizontal = Horizontal::Velocity { x_m_s: 99.0, y_m_s: 0.0 };
        let moves = Setpoint { horizontal, vertical, heading };
        let mut course = Course::new(Vector2::new(50.0, 2.0), Vector2::zeros());
        let border = (&Border::circle(99.0), 0.0);
        moves.advance(&mut course, &HERE, (&LIMITS, 0.0), border, STEP_S);
        let target = moves.target(&far, &course, &HERE, STEP_S);
        assert_pose(&target, [1.0 + LEASH_M, 2.0, 1.0 + CLIMB_LEASH_M, 45.0]);
        let target = moves.target(&HERE, &course, &HERE, 1.0);
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

    #[test]
    fn drag_helps_a_drone_to_slow_down_and_to_nothing_else() {
        let limits = MotionLimits { jerk_m_s3: 1e9, ..LIMITS };
        for (flies_m_s, wanted_m_s, expected_m_s2) in [
            ([2.0, 0.0], [0.0, 0.0], 1.5 + 0.4 * 2.0 / 2.0),
            ([0.5, 0.0], [2.0, 0.0], 1.5),
            ([1.0, 0.0], [1.0, 1.0], 1.5),
        ] {
            let mut course = Course::new(Vector2::zeros(), flies_m_s.into());
            let [x_m_s, y_m_s] = wanted_m_s;
            let wanted = setpoint(Horizontal::Velocity { x_m_s, y_m_s });
            let here = Pose { x_m: 0.0, y_m: 0.0, ..HERE };
            let border = (&Border::circle(99.0), 0.0);
            wanted.advance(&mut course, &here, (&limits, 0.4), border, STEP_S);
            let found_m_s2 = course.acceleration_m_s2.norm();
            assert!((found_m_s2 - expected_m_s2).abs() < 1e-9, "{wanted_m_s:?}: {found_m_s2}");
        }
    }

    #[test]
    fn near_the_fence_a_drone_flies_outward_no_faster_than_it_can_stop_and_inward_as_it_likes() {
        let inside = |wanted: [f64; 2], course_m: f64, here_m: f64, flies_m_s: f64| {
            let course = Course::new(Vector2::new(course_m, 0.0), Vector2::new(flies_m_s, 0.0));
            let border = (&Border::circle(4.0), 0.0);
            kept_inside_m_s(wanted.into(), &course, Vector2::new(here_m, 0.0), border)
        };
        let most_m_s = Stopping::CAUTIOUS.speed_m_s(0.1);
        let is = |found: Vector2<f64>, x, y| (found - Vector2::new(x, y)).norm() < 1e-9;
        // Whichever is further out counts: the course or the drone.
        for (course_m, here_m) in [(3.9, 3.0), (3.0, 3.9)] {
            assert!(is(inside([2.0, 1.0], course_m, here_m, 0.0), most_m_s, 1.0));
            assert!(is(inside([-2.0, 1.0], course_m, here_m, 0.0), -2.0, 1.0));
            let brakes = inside([0.0, 1.0], course_m, here_m, 2.0);
            assert!(is(brakes, most_m_s - 2.0, 0.0), "{brakes}");
        }
        assert!(is(inside([-1.0, 0.5], 4.2, 4.2, 0.0), -1.0, 0.5), "it stands outside");
    }

    #[test]
    fn in_a_polygon_every_side_counts_and_a_corner_is_no_trap() {
        let square = [[-4.0, -4.0], [4.0, -4.0], [4.0, 4.0], [-4.0, 4.0]];
        let border = Border::polygon(&square).unwrap();
        let inside = |[x_m, y_m]: [f64; 2], wanted: [f64; 2]| {
            let here_m = Vector2::new(x_m, y_m);
            let course = Course::new(here_m, Vector2::zeros());
            kept_inside_m_s(wanted.into(), &course, here_m, (&border, 0.5))
        };
        let most_m_s = Stopping::CAUTIOUS.speed_m_s(0.1);
        let is = |found: Vector2<f64>, x, y| (found - Vector2::new(x, y)).norm() < 1e-9;
        assert!(is(inside([3.4, 0.0], [2.0, 1.0]), most_m_s, 1.0), "along the side it flies on");
        assert!(is(inside([3.4, 3.4], [2.0, 2.0]), most_m_s, most_m_s), "into the corner");
        assert!(is(inside([-3.4, 3.4], [2.0, 2.0]), 2.0, most_m_s), "out of another");
        // What avoids the one side of a sharp corner leads to the other.
        let sharp = [[-4.0, -1.0], [6.0, 0.0], [-4.0, 1.0]];
        let sharp = Border::polygon(&sharp).unwrap();
        let here_m = Vector2::new(0.5, 0.0);
        let course = Course::new(here_m, Vector2::zeros());
        let kept_m_s = kept_inside_m_s(Vector2::new(2.0, 0.0), &course, here_m, (&sharp, 0.5));
        assert_eq!(kept_m_s, Vector2::zeros());
    }
}
