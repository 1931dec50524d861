//! The last line at the fence: where the drone can only just stop inside it, the sticks brake, whatever was ordered.
//!
//! It reckons with what the drone does at full opposite stick, and only takes away: nobody is led anywhere by it.

use kinematics::{Airframe, Sticks, body_from_world};
use nalgebra::Vector2;

use super::stopping::Stopping;
use super::{BEYOND_M, Motion, Situation};
use crate::fence::{FlightLimits, Wall, across};
use crate::separation::Others;

/// The sticks go from full outward to full inward while the way to rest ends further out by this.
const BAND_M: f64 = 0.2;
/// Two walls whose directions have a smaller product are two: the drone is braked at both.
const ELSEWHERE: f64 = 0.7;
/// Braking that is left in any wind, as a fraction of full tilt: in more of it the storm rules decide.
const LEAST_BRAKING: f64 = 0.2;

/// What is left of the sticks in one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Brake {
    /// Where the drone would leave the fence: the wall that it would pass by most, and one in another direction, as in a
    /// corner.
    walls: [Limit; 2],
    /// Likewise where it would pass the lines between it and other vehicles.
    others: [Limit; 2],
    /// Smallest and largest gaz.
    least_gaz: f64,
    most_gaz: f64,
}

/// The largest stick in a direction: a unit vector to the right and forward of the drone.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Limit {
    outward: Vector2<f64>,
    most: f64,
}

impl Limit {
    const NONE: Self = Self { outward: Vector2::new(0.0, 0.0), most: 1.0 };
}

impl Default for Brake {
    fn default() -> Self {
        Self { walls: [Limit::NONE; 2], others: [Limit::NONE; 2], least_gaz: -1.0, most_gaz: 1.0 }
    }
}

impl Brake {
    /// For a fence. The gaz that was last sent is `gaz`.
    pub(super) fn of(now: &Situation, gaz: f64, fence: &FlightLimits) -> Self {
        let Motion { pose, velocity_m_s: [_, _, up_m_s] } = now.stops_from();
        let (velocity_m_s, stop_m) = stop(now);
        let passed = fence.border.passed(across(&pose), stop_m, BEYOND_M);
        let walls = strictest(passed, velocity_m_s, pose.yaw_deg);
        // One that sinks faster than it was identified will do so.
        let sinks_m_s = gaz.min(0.0) * Airframe::STRONGEST_DROP * now.climb_m_s;
        let up_m_s = if up_m_s < 0.0 { up_m_s.min(sinks_m_s) } else { up_m_s };
        // The rate of climb follows its stick with a lag, and changes the faster the further it is from the one asked for.
        let (opposite_m_s, lag_s) = if up_m_s > 0.0 {
            (now.sink_m_s, now.climb_lag_s)
        } else {
            // The floor is hard: nothing that was identified is trusted to be better than the worst.
            let ([weakest, _], [_, longest_lag_s]) = (Airframe::CLIMBS, Airframe::CLIMB_LAGS_S);
            (weakest * now.climb_m_s, now.climb_lag_s.max(longest_lag_s))
        };
        let stopping = Stopping {
            delay_s: now.tick_s,
            braking_m_s2: (opposite_m_s + up_m_s.abs() / 2.0) / lag_s,
        };
        let stop_z_m = pose.z_m + stopping.way_m(up_m_s);
        Self {
            walls,
            others: [Limit::NONE; 2],
            // Not far below the floor of the fence is the room's.
            least_gaz: if up_m_s < 0.0 { -left(2.0 * (fence.floor_m - stop_z_m)) } else { -1.0 },
            most_gaz: if up_m_s > 0.0 { left(stop_z_m - fence.ceiling_m - BEYOND_M) } else { 1.0 },
        }
    }

    /// Also where the drone could only just stop before the lines between it and other vehicles.
    pub(super) fn keep_apart(&mut self, now: &Situation, others: &Others) {
        let (velocity_m_s, stop_m) = stop(now);
        let walls = others.iter().map(|other| other.wall(stop_m));
        let passed = walls.filter(|wall| wall.distance_m < -BEYOND_M);
        self.others = strictest(passed, velocity_m_s, now.soon.pose.yaw_deg);
    }

    /// The sticks that are left of these.
    pub(super) fn leave(&self, sticks: &Sticks) -> Sticks {
        let mut tilt = Vector2::new(sticks.roll, -sticks.pitch);
        for Limit { outward, most } in self.walls.into_iter().chain(self.others) {
            let excess = tilt.dot(&outward) - most;
            if most < 1.0 && excess > 0.0 {
                tilt -= outward * excess;
            }
        }
        let gaz = sticks.gaz.min(self.most_gaz).max(self.least_gaz);
        Sticks { roll: tilt.x, pitch: -tilt.y, gaz, ..*sticks }
    }
}

/// The velocity of a drone, and where it would come to rest from it with all that it has.
fn stop(now: &Situation) -> (Vector2<f64>, Vector2<f64>) {
    let Motion { pose, velocity_m_s: [right_m_s, forward_m_s, _] } = now.stops_from();
    let velocity_m_s = Vector2::new(right_m_s, forward_m_s);
    let speed_m_s = velocity_m_s.norm();
    let along = velocity_m_s / speed_m_s.max(f64::EPSILON);
    let wind = now.wind.lasting(&along).min(1.0 - LEAST_BRAKING);
    let braking_m_s2 = now.wind.braking_m_s2(wind, now.drag_1_s, speed_m_s);
    let stopping = Stopping { delay_s: now.tilts_after_s, braking_m_s2 };
    (velocity_m_s, across(&pose) + along * stopping.way_m(speed_m_s))
}

/// What is left of the sticks by the wall that would be passed by most, and by one in another direction, of those towards
/// which the drone flies.
fn strictest(
    passed: impl Iterator<Item = Wall> + Clone,
    velocity_m_s: Vector2<f64>,
    yaw_deg: f64,
) -> [Limit; 2] {
    let limits = passed
        .filter(|wall| velocity_m_s.dot(&wall.outward) > 0.0)
        .map(|wall| Limit { outward: wall.outward, most: left(-wall.distance_m - BEYOND_M) });
    let stricter = |a: Limit, b: Limit| if b.most < a.most { b } else { a };
    let first = limits.clone().fold(Limit::NONE, stricter);
    let is_other = |limit: &Limit| limit.outward.dot(&first.outward) < ELSEWHERE;
    [first, limits.filter(is_other).fold(Limit::NONE, stricter)]
        .map(|limit| Limit { outward: body_from_world(limit.outward, yaw_deg), ..limit })
}

/// What is left of a stick that leads to a rest this far outside.
fn left(outside_m: f64) -> f64 {
    (1.0 - 2.0 * outside_m / BAND_M).clamp(-1.0, 1.0)
}

#[cfg(test)]
mod tests {
    use kinematics::Pose;

    use super::*;
    use crate::fence::Border;
    use crate::safety::tests::FINE;
    use crate::separation::{Neighbour, Neighbours, Oneself, Presence};
    use crate::wind::Wind;

    const FENCE: FlightLimits = FlightLimits::new(Border::circle(4.0), 0.3, 3.0);

    /// What is left of full sticks to the right and up, in a fence of 4 m, 3 m high.
    fn left_of_full(x_m: f64, velocity_m_s: [f64; 3], yaw_deg: f64) -> Sticks {
        let pose = Pose { x_m, yaw_deg, ..FINE.pose };
        let now = Situation { soon: Motion { pose, velocity_m_s }, ..FINE };
        let (roll, gaz) = (1.0, 1.0);
        Brake::of(&now, 0.0, &FENCE).leave(&Sticks { roll, gaz, ..Sticks::default() })
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

    const L: [[f64; 2]; 6] =
        [[-4.0, -4.0], [1.0, -4.0], [1.0, 1.0], [4.0, 1.0], [4.0, 4.0], [-4.0, 4.0]];

    /// What is left of full sticks to the right and forward of a drone in an L, as (right, forward).
    fn left_in_an_l([x_m, y_m]: [f64; 2], [right_m_s, forward_m_s]: [f64; 2]) -> [f64; 2] {
        let fence = FlightLimits::new(Border::polygon(&L).unwrap(), 0.3, 3.0);
        let pose = Pose { x_m, y_m, ..FINE.pose };
        let velocity_m_s = [right_m_s, forward_m_s, 0.0];
        let now = Situation { soon: Motion { pose, velocity_m_s }, ..FINE };
        let sticks = Sticks { roll: 1.0, pitch: -1.0, ..Sticks::default() };
        let left = Brake::of(&now, 0.0, &fence).leave(&sticks);
        [left.roll, -left.pitch]
    }

    #[test]
    fn in_a_corner_both_sides_are_braked_at() {
        let [right, forward] = left_in_an_l([3.2, 3.2], [2.0, 2.0]);
        assert!((right + 1.0).abs() < 1e-9 && (forward + 1.0).abs() < 1e-9, "{right} {forward}");
        let [right, forward] = left_in_an_l([3.2, 2.0], [2.0, 0.1]);
        assert!((right + 1.0).abs() < 1e-9 && (forward - 1.0).abs() < 1e-9, "{right} {forward}");
    }

    #[test]
    fn a_side_brakes_a_drone_that_would_pass_it_and_not_one_that_flies_by() {
        // From 2 m/s it stops within 1.31 m: beyond the side at x = 1 m, though the other leg is there.
        assert!(left_in_an_l([0.5, 0.5], [2.0, 0.0])[0] < -0.99);
        assert!((left_in_an_l([0.5, 1.5], [2.0, 0.0])[0] - 1.0).abs() < 1e-9, "past the corner");
        assert!((left_in_an_l([0.9, -1.0], [0.0, 2.0])[0] - 1.0).abs() < 1e-9, "along it");
    }

    /// What is left of full sticks to the right of a drone at 2 m/s, this far from where another one hovers.
    fn left_before_another(away_m: f64) -> f64 {
        let soon = Motion { velocity_m_s: [2.0, 0.0, 0.0], ..FINE.soon };
        let here_m = across(&soon.pose);
        let mut neighbours = Neighbours::default();
        let neighbour = Neighbour {
            system: 2,
            at: FINE.now,
            place_m: here_m + Vector2::new(away_m, 0.0),
            velocity_m_s: Vector2::zeros(),
            uncertainty_m: 0.0,
            separation_m: 1.5,
            presence: Presence::Flies,
            claim: None,
        };
        neighbours.hear(neighbour).unwrap();
        let velocity_m_s = Vector2::new(2.0, 0.0);
        let oneself = Oneself {
            system: 1,
            rank: None,
            place_m: here_m,
            velocity_m_s,
            uncertainty_m: 0.0,
            separation_m: 1.5,
        };
        let now = Situation { soon, ..FINE };
        let mut brake = Brake::of(&now, 0.0, &FENCE);
        brake.keep_apart(&now, &neighbours.others(FINE.now, &oneself));
        brake.leave(&Sticks { roll: 1.0, ..Sticks::default() }).roll
    }

    #[test]
    fn a_drone_that_could_only_just_stop_before_another_brakes() {
        // From 2 m/s it stops within 1.31 m.
        assert!((left_before_another(3.0) - 1.0).abs() < 1e-9);
        assert!((left_before_another(2.45) + 1.0).abs() < 1e-9);
        let way_m = 0.2 * 2.0 + 4.0 / (2.0 * 2.2);
        assert!(
            left_before_another(1.5 + way_m - 0.25).abs() < 1e-9,
            "half a band beyond the line"
        );
    }

    #[test]
    fn a_climb_ends_below_the_ceiling() {
        let gaz = |z_m| {
            let pose = Pose { z_m, ..FINE.pose };
            let soon = Motion { pose, velocity_m_s: [0.0, 0.0, 0.7] };
            let now = Situation { soon, ..FINE };
            Brake::of(&now, 0.0, &FENCE).leave(&Sticks { gaz: 1.0, ..Sticks::default() }).gaz
        };
        assert!((gaz(2.5) - 1.0).abs() < 1e-9);
        assert!((gaz(3.2) + 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_descent_ends_above_the_floor() {
        let gaz = |z_m, up_m_s| {
            let pose = Pose { z_m, ..FINE.pose };
            let soon = Motion { pose, velocity_m_s: [0.0, 0.0, up_m_s] };
            let now = Situation { soon, ..FINE };
            Brake::of(&now, 0.0, &FENCE).leave(&Sticks { gaz: -1.0, ..Sticks::default() }).gaz
        };
        assert!((gaz(1.0, -0.7) + 1.0).abs() < 1e-9);
        assert!((gaz(0.3, -0.7) - 1.0).abs() < 1e-9);
        assert!((gaz(0.3, 0.0) + 1.0).abs() < 1e-9, "it stands");
        // From 0.55 m it stops at 0.45 m, unless it sinks as the strongest does.
        let soon = Motion { pose: Pose { z_m: 0.55, ..FINE.pose }, velocity_m_s: [0.0, 0.0, -0.3] };
        let least = |gaz| Brake::of(&Situation { soon, ..FINE }, gaz, &FENCE).least_gaz;
        assert!((least(-0.3) + 1.0).abs() < 1e-9);
        assert!(least(-0.6) > -0.9, "{}", least(-0.6));
    }

    /// Half of the sticks is left where the way to rest ends 5 cm beyond what is tolerated.
    #[test]
    fn wind_lengthens_the_way_to_rest_and_drag_shortens_it() {
        for (wind, drag_1_s, braking_m_s2) in
            [(0.0, 0.2, 2.2), (0.0, 0.6, 2.6), (0.5, 0.2, 1.2), (-0.5, 0.2, 3.2), (0.95, 0.2, 0.6)]
        {
            let way_m = 0.2 * 2.0 + 4.0 / (2.0 * braking_m_s2);
            let pose = Pose { x_m: 4.2 - way_m, ..FINE.pose };
            let soon = Motion { pose, velocity_m_s: [2.0, 0.0, 0.0] };
            let wind_felt = Wind::steady([wind, 0.0], 2.0);
            let now = Situation { soon, wind: wind_felt, drag_1_s, ..FINE };
            let sticks = Sticks { roll: 1.0, ..Sticks::default() };
            let left = Brake::of(&now, 0.0, &FENCE).leave(&sticks).roll;
            assert!((left - 0.5).abs() < 1e-9, "{wind} {drag_1_s}: {left}");
        }
    }

    /// What is left of the gaz, up and down, of a drone that climbs at this rate, and was last sent this gaz.
    fn gaz_left(z_m: f64, up_m_s: f64, gaz: f64) -> [f64; 2] {
        let soon = Motion { pose: Pose { z_m, ..FINE.pose }, velocity_m_s: [0.0, 0.0, up_m_s] };
        let brake = Brake::of(&Situation { soon, ..FINE }, gaz, &FENCE);
        [brake.most_gaz, brake.least_gaz]
    }

    #[test]
    fn half_of_the_gaz_is_left_where_the_way_to_rest_ends_half_a_band_away() {
        let way_m = 0.7 * 0.1 + 0.7 * 0.7 / (2.0 * (0.7 + 0.35) / 0.5);
        let [up, down] = gaz_left(3.2 - way_m, 0.7, 0.0);
        assert!((up - 0.5).abs() < 1e-9 && (down + 1.0).abs() < 1e-9, "{up} {down}");
        let [_, lag_s] = Airframe::CLIMB_LAGS_S;
        let climbs_m_s = Airframe::CLIMBS[0] * 0.7;
        let way_m = 0.3 * 0.1 + 0.3 * 0.3 / (2.0 * (climbs_m_s + 0.15) / lag_s);
        let [up, down] = gaz_left(0.275 + way_m, -0.3, 0.0);
        assert!((up - 1.0).abs() < 1e-9 && (down + 0.5).abs() < 1e-9, "{up} {down}");
        // One that stands goes nowhere, wherever it is.
        for z_m in [0.2, 1.0, 3.4] {
            let [up, down] = gaz_left(z_m, 0.0, -1.0);
            assert!((up - 1.0).abs() < 1e-9 && (down + 1.0).abs() < 1e-9, "{z_m}: {up} {down}");
        }
    }

    #[test]
    fn both_sticks_at_once_are_left_where_there_is_room() {
        let soon = Motion { velocity_m_s: [0.5, 0.5, 0.0], ..FINE.soon };
        let sticks = Sticks { roll: 1.0, pitch: -1.0, ..Sticks::default() };
        assert_eq!(Brake::of(&Situation { soon, ..FINE }, 0.0, &FENCE).leave(&sticks), sticks);
    }
}
