//! Four axes: position and heading to stick fractions.

use crate::axis::{Gains, Pid};

/// A place and a heading. x right, y forward, z up in metres; yaw in degrees, clockwise.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose {
    /// Right.
    pub x_m: f64,
    /// Forward.
    pub y_m: f64,
    /// Up.
    pub z_m: f64,
    /// Clockwise from above.
    pub yaw_deg: f64,
}

/// How the drone moves, in the world.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// Right.
    pub x_m_s: f64,
    /// Forward.
    pub y_m_s: f64,
    /// Up.
    pub z_m_s: f64,
}

/// Stick fractions in [-1, 1] with the drone's signs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Demand {
    /// Positive flies right.
    pub roll: f64,
    /// Positive flies backward.
    pub pitch: f64,
    /// Positive climbs.
    pub gaz: f64,
    /// Positive turns clockwise.
    pub yaw: f64,
}

/// Gains of all axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ControllerGains {
    /// x and y: stick per metre, metre second, metre per second.
    pub horizontal: Gains,
    /// z, likewise.
    pub vertical: Gains,
    /// Yaw: stick per degree.
    pub yaw: Gains,
}

impl Default for ControllerGains {
    /// For the drone's indoor limits: 12° of tilt, 0.7 m/s of climb, 100°/s of turn. One unit of
    /// horizontal stick is then about 2 m/s², so the horizontal loop has 1 rad/s and is well
    /// damped with 0.3 s of total delay.
    fn default() -> Self {
        Self {
            horizontal: Gains {
                proportional: 0.5,
                integral: 0.12,
                derivative: 0.6,
                integral_limit: 0.2,
                integral_zone: 0.4,
            },
            vertical: Gains {
                proportional: 1.2,
                integral: 0.0,
                derivative: 0.1,
                integral_limit: 0.0,
                integral_zone: 0.0,
            },
            yaw: Gains {
                proportional: 0.015,
                integral: 0.0,
                derivative: 0.0,
                integral_limit: 0.0,
                integral_zone: 0.0,
            },
        }
    }
}

/// Holds and approaches a pose.
#[derive(Debug, Clone)]
pub struct PositionController {
    x: Pid,
    y: Pid,
    z: Pid,
    yaw: Pid,
}

impl Default for PositionController {
    fn default() -> Self {
        Self::new(&ControllerGains::default())
    }
}

impl PositionController {
    /// A controller that has learnt nothing yet.
    pub fn new(gains: &ControllerGains) -> Self {
        Self {
            x: Pid::new(gains.horizontal),
            y: Pid::new(gains.horizontal),
            z: Pid::new(gains.vertical),
            yaw: Pid::new(gains.yaw),
        }
    }

    /// The stick fractions for the next `step_s` seconds, none larger than `limit`.
    pub fn step(
        &mut self,
        pose: &Pose,
        motion: &Motion,
        target: &Pose,
        step_s: f64,
        limit: f64,
    ) -> Demand {
        let limit = limit.clamp(0.0, 1.0);
        let world_x = self.x.step(target.x_m - pose.x_m, motion.x_m_s, step_s, limit);
        let world_y = self.y.step(target.y_m - pose.y_m, motion.y_m_s, step_s, limit);
        let gaz = self.z.step(target.z_m - pose.z_m, motion.z_m_s, step_s, limit);
        let turn_deg = wrap_deg(target.yaw_deg - pose.yaw_deg);
        let yaw = self.yaw.step(turn_deg, 0.0, step_s, limit);
        // A turned frame can ask for more than the limit on one axis: keep the direction.
        let (right, forward) = body_from_world(world_x, world_y, pose.yaw_deg);
        let largest = right.abs().max(forward.abs());
        let scale = if largest > limit { limit / largest } else { 1.0 };
        Demand { roll: right * scale, pitch: -forward * scale, gaz, yaw }
    }

    /// Forgets what was learnt of disturbances.
    pub fn reset(&mut self) {
        for axis in [&mut self.x, &mut self.y, &mut self.z, &mut self.yaw] {
            axis.reset();
        }
    }
}

/// World to body at a clockwise heading: (right, forward).
fn body_from_world(x: f64, y: f64, yaw_deg: f64) -> (f64, f64) {
    let (sin, cos) = yaw_deg.to_radians().sin_cos();
    (cos * x - sin * y, sin * x + cos * y)
}

/// The same direction in [-180, 180): the short way round.
fn wrap_deg(angle_deg: f64) -> f64 {
    (angle_deg + 180.0).rem_euclid(360.0) - 180.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn demand(pose: Pose, target: Pose) -> Demand {
        PositionController::default().step(&pose, &Motion::default(), &target, 0.03, 1.0)
    }

    #[test]
    fn each_error_moves_the_stick_that_mends_it() {
        let here = Pose::default();
        let ahead = demand(here, Pose { y_m: 1.0, ..here });
        assert!(ahead.pitch < -0.1 && ahead.roll.abs() < 1e-9, "{ahead:?}");
        let right = demand(here, Pose { x_m: 1.0, ..here });
        assert!(right.roll > 0.1 && right.pitch.abs() < 1e-9, "{right:?}");
        assert!(demand(here, Pose { z_m: 0.2, ..here }).gaz > 0.1);
        assert!(demand(here, Pose { yaw_deg: 20.0, ..here }).yaw > 0.1);
    }

    #[test]
    fn a_turned_drone_flies_to_the_same_place() {
        // Facing right: a target to the right is ahead.
        let pose = Pose { yaw_deg: 90.0, ..Pose::default() };
        let demand = demand(pose, Pose { x_m: 1.0, ..pose });
        assert!(demand.pitch < -0.1 && demand.roll.abs() < 1e-9, "{demand:?}");
    }

    #[test]
    fn yaw_goes_the_short_way_round() {
        let pose = Pose { yaw_deg: 171.0, ..Pose::default() };
        assert!(demand(pose, Pose { yaw_deg: -170.0, ..pose }).yaw > 0.0);
        assert!(demand(pose, Pose { yaw_deg: 181.0 + 360.0, ..pose }).yaw > 0.0);
    }

    #[test]
    fn the_limit_holds_on_every_axis_at_every_heading() {
        for yaw_deg in 0..360 {
            let pose = Pose { yaw_deg: f64::from(yaw_deg), ..Pose::default() };
            let target = Pose { x_m: 9.0, y_m: -7.0, z_m: 5.0, yaw_deg: pose.yaw_deg + 179.0 };
            let demand =
                PositionController::default().step(&pose, &Motion::default(), &target, 0.03, 0.3);
            for stick in [demand.roll, demand.pitch, demand.gaz, demand.yaw] {
                assert!(stick.abs() <= 0.3 + 1e-12, "{demand:?}");
            }
        }
    }
}
