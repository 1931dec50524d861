//! Detects a drone that the wind carries over the fence: it moves outward and cannot brake in time.
//!
//! A drone that is landed only after it has left the fence has been carried towards it for a while, and its
//! own landing drifts further the higher it begins. Landing is therefore ordered as soon as this is detected.

use nalgebra::Vector2;

use super::{MARGIN_M, REACTION_S, STALE, Situation, Stopping};
use crate::fence::{Border, across};
use crate::wind::STORM;

/// Speed up to which a drone counts as holding its position, in m/s.
const SLOW_M_S: f64 = 0.3;
/// Only a drone counts that would be over the fence within this time at its speed. A storm that does not lead to the fence
/// soon is left to the agent, which lands when the sticks stay saturated: the gusts of a fair day are storms to a drone that
/// hardly tilts.
const SOON_S: f64 = 6.0;

/// Whether the wind carries the drone over the fence soon, at full tilt against its motion.
pub(super) fn is_carried_off(now: &Situation, border: &Border) -> bool {
    let [right_m_s, forward_m_s, _] = now.velocity_m_s;
    let velocity_m_s = Vector2::new(right_m_s, forward_m_s);
    let speed_m_s = velocity_m_s.norm();
    let heading = velocity_m_s / speed_m_s.max(f64::EPSILON);
    let wind = now.wind.lasting(&heading);
    let braking_m_s2 = now.wind.braking_m_s2(wind, now.drag_1_s, speed_m_s);
    let way_m = Stopping { delay_s: REACTION_S, braking_m_s2 }.way_m(speed_m_s);
    let room_m = |beyond_m| border.room_m(across(&now.pose), heading, beyond_m);
    now.blind_for <= STALE
        && speed_m_s > SLOW_M_S
        && wind >= STORM
        && room_m(0.0) <= speed_m_s * SOON_S
        && (braking_m_s2 <= 0.0 || way_m > room_m(MARGIN_M))
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use kinematics::Pose;

    use super::*;
    use crate::safety::tests::FINE;
    use crate::wind::Wind;

    const RADIUS_M: f64 = 10.0;
    const ROUND: Border = Border::circle(RADIUS_M);
    const TO_THE_REAR: [f64; 2] = [0.0, -1.1];

    /// So far inside the fence, moving backward at this speed, in an even wind.
    fn backward(room_m: f64, speed_m_s: f64, wind: [f64; 2]) -> Situation {
        let pose = Pose { y_m: room_m - RADIUS_M, ..FINE.pose };
        let wind = Wind::steady(wind, 2.0);
        Situation { pose, velocity_m_s: [0.0, -speed_m_s, 0.0], wind, ..FINE }
    }

    #[test]
    fn a_storm_carries_off_what_cannot_brake_before_the_fence() {
        let carried = |speed_m_s, wind| is_carried_off(&backward(3.0, speed_m_s, wind), &ROUND);
        assert!(carried(1.0, TO_THE_REAR));
        assert!(carried(1.0, [0.0, -0.98]), "it leans against more, but not enough");
        assert!(!carried(SLOW_M_S, TO_THE_REAR), "it holds its place");
        assert!(!carried(1.0, [0.0, -0.5]), "it can brake");
        assert!(!carried(1.0, [0.0, 1.1]), "the wind brakes it");
        assert!(!carried(1.0, [1.1, 0.0]), "the wind comes from the side");
    }

    #[test]
    fn a_gust_does_not_carry_off_and_a_storm_does() {
        let mut now = backward(3.0, 1.0, [0.0; 2]);
        let first = (0..300).find(|_| {
            now.wind.feel(Vector2::new(0.0, -2.2), 2.0, 0.01);
            is_carried_off(&now, &ROUND)
        });
        assert!(first.is_some_and(|tick| (100..300).contains(&tick)), "{first:?}");
    }

    #[test]
    fn the_way_to_brake_is_what_is_left_of_full_tilt() {
        // The braking acceleration is 0.4 m/s² of tilt and 0.3 m/s² of drag, so the way is 1.5 m + 9 m² / 1.4 m.
        let stops = |room_m: f64, wind: f64| {
            !is_carried_off(&backward(room_m - MARGIN_M, 3.0, [0.0, -wind]), &ROUND)
        };
        assert!(stops(7.94, 0.8));
        assert!(!stops(7.92, 0.8));
        assert!(stops(0.1, STORM - 0.01), "less is no storm");
        assert!(!stops(0.1, STORM + 0.01));
    }

    #[test]
    fn a_storm_counts_once_it_would_carry_the_drone_over_the_fence_soon() {
        let carried = |room_m| is_carried_off(&backward(room_m, 0.5, TO_THE_REAR), &ROUND);
        assert!(carried(0.5 * SOON_S - 0.1));
        assert!(!carried(0.5 * SOON_S + 0.1));
    }

    #[test]
    fn navdata_may_be_as_old_as_those_that_are_flown_by() {
        let carried = |blind_for| {
            is_carried_off(&Situation { blind_for, ..backward(3.0, 1.0, TO_THE_REAR) }, &ROUND)
        };
        assert!(carried(STALE));
        assert!(!carried(STALE + Duration::from_millis(1)), "nobody knows");
    }
}
