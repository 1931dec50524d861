//! The last line at the fence: where the drone can only just stop inside it, the sticks brake, whatever was ordered.
//!
//! It reckons with what the drone does at full opposite stick, and only takes away: nobody is led anywhere by it.

use kinematics::{Sticks, body_from_world};
use nalgebra::Vector2;

use super::Situation;
use super::stopping::Stopping;

/// Distance beyond the fence up to which the drone may come to rest. A target on the fence is flown to with less.
const BEYOND_M: f64 = 0.15;
/// The sticks go from full outward to full inward while the way to rest ends further out by this.
const BAND_M: f64 = 0.2;
/// Braking that is left in any wind, as a fraction of full tilt: in more of it the storm rules decide.
const LEAST_BRAKING: f64 = 0.2;

/// What is left of the sticks in one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Brake {
    /// Where the drone would leave the fence: a unit vector to the right and forward of the drone.
    outward: Vector2<f64>,
    /// Largest stick in this direction.
    most: f64,
    /// Largest gaz.
    most_gaz: f64,
}

impl Default for Brake {
    fn default() -> Self {
        Self { outward: Vector2::zeros(), most: 1.0, most_gaz: 1.0 }
    }
}

impl Brake {
    /// For a fence of this radius and ceiling.
    pub(super) fn of(now: &Situation, radius_m: f64, ceiling_m: f64) -> Self {
        let [right_m_s, forward_m_s, up_m_s] = now.velocity_m_s;
        let velocity_m_s = Vector2::new(right_m_s, forward_m_s);
        let speed_m_s = velocity_m_s.norm();
        let along = velocity_m_s / speed_m_s.max(f64::EPSILON);
        let tilted = 1.0 - along.dot(&Vector2::from(now.wind));
        let braking_m_s2 =
            now.full_tilt_m_s2 * tilted.max(LEAST_BRAKING) + now.drag_1_s * speed_m_s / 2.0;
        let stopping = Stopping { delay_s: now.tilts_after_s, braking_m_s2 };
        let stop_m = Vector2::new(now.pose.x_m, now.pose.y_m) + along * stopping.way_m(speed_m_s);
        let outward = stop_m / stop_m.norm().max(f64::EPSILON);
        let leaves = velocity_m_s.dot(&outward) > 0.0;
        let climbing = Stopping {
            delay_s: now.climb_delay_s,
            // The rate of climb follows its stick with a lag, and falls the faster the higher it is.
            braking_m_s2: (now.sink_m_s + up_m_s / 2.0) / now.climb_lag_s,
        };
        let stop_z_m = now.pose.z_m + climbing.way_m(up_m_s.max(0.0));
        Self {
            outward: body_from_world(outward, now.pose.yaw_deg),
            most: if leaves { left(stop_m.norm() - radius_m) } else { 1.0 },
            most_gaz: if up_m_s > 0.0 { left(stop_z_m - ceiling_m) } else { 1.0 },
        }
    }

    /// The sticks that are left of these.
    pub(super) fn leave(&self, sticks: &Sticks) -> Sticks {
        let tilt = Vector2::new(sticks.roll, -sticks.pitch);
        let excess = tilt.dot(&self.outward) - self.most;
        let tilt =
            if self.most < 1.0 && excess > 0.0 { tilt - self.outward * excess } else { tilt };
        Sticks { roll: tilt.x, pitch: -tilt.y, gaz: sticks.gaz.min(self.most_gaz), ..*sticks }
    }
}

/// What is left of a stick that leads to a rest this far outside.
fn left(outside_m: f64) -> f64 {
    (1.0 - 2.0 * (outside_m - BEYOND_M) / BAND_M).clamp(-1.0, 1.0)
}

#[cfg(test)]
mod tests {
    use kinematics::Pose;

    use super::*;
    use crate::safety::tests::FINE;

    /// What is left of full sticks to the right and up, in a fence of 4 m, 3 m high.
    fn left_of_full(x_m: f64, velocity_m_s: [f64; 3], yaw_deg: f64) -> Sticks {
        let now = Situation { pose: Pose { x_m, yaw_deg, ..FINE.pose }, velocity_m_s, ..FINE };
        let (roll, gaz) = (1.0, 1.0);
        Brake::of(&now, 4.0, 3.0).leave(&Sticks { roll, gaz, ..Sticks::default() })
    }

    #[test]
    fn a_drone_that_could_only_just_stop_brakes_and_any_other_flies_as_it_likes() {
        // From 2 m/s it stops within 0.4 m and 4 m² / (2 · 2.2) = 1.31 m.
        assert!((left_of_full(2.8, [2.0, 0.0, 0.0], 0.0).roll - 1.0).abs() < 1e-9);
        assert!((left_of_full(3.2, [2.0, 0.0, 0.0], 0.0).roll + 1.0).abs() < 1e-9);
        assert!((left_of_full(3.2, [-2.0, 0.0, 0.0], 0.0).roll - 1.0).abs() < 1e-9, "it goes in");
        assert!((left_of_full(4.3, [0.0; 3], 0.0).roll - 1.0).abs() < 1e-9, "it stands");
        // It looks outward: what it must not tilt by is its pitch.
        let sideways = left_of_full(3.2, [2.0, 0.0, 0.0], 90.0);
        assert!((sideways.roll - 1.0).abs() < 1e-9 && sideways.pitch > 0.9, "{sideways:?}");
    }

    #[test]
    fn a_climb_ends_below_the_ceiling() {
        let gaz = |z_m| {
            let pose = Pose { z_m, ..FINE.pose };
            let now = Situation { pose, velocity_m_s: [0.0, 0.0, 0.7], ..FINE };
            Brake::of(&now, 4.0, 3.0).leave(&Sticks { gaz: 1.0, ..Sticks::default() }).gaz
        };
        assert!((gaz(2.5) - 1.0).abs() < 1e-9);
        assert!((gaz(3.2) + 1.0).abs() < 1e-9);
    }
}
