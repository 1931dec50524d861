//! Turns jumps of the estimate into a motion for the controller.
//!
//! When a tag is seen again the estimate jumps to the drone's position. The reference jumps along, so that
//! the controller sees no step, and then moves back to its place.

use nalgebra::Vector2;

use crate::silence::USUAL_STEP_S;

/// Natural frequency of the motion back.
const FREQUENCY_1_S: f64 = 1.2;
const FASTEST_M_S: f64 = 0.25;
const MOST_M_S2: f64 = 0.4;
const FASTEST_DEG_S: f64 = 8.0;

/// The remaining offset.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct TakeBack {
    place_m: Vector2<f64>,
    rate_m_s: Vector2<f64>,
    heading_deg: f64,
}

impl TakeBack {
    /// The estimate has jumped.
    pub(super) fn jumped(&mut self, place_m: Vector2<f64>, heading_rad: f64) {
        self.place_m += place_m;
        self.heading_deg += heading_rad.to_degrees();
    }

    pub(super) fn advance(&mut self, step_s: f64) {
        // A longer time step is a pause.
        let step_s = step_s.clamp(0.0, USUAL_STEP_S);
        let wanted_m_s = (-self.place_m * (FREQUENCY_1_S / 2.0)).cap_magnitude(FASTEST_M_S);
        let change = (wanted_m_s - self.rate_m_s) * (2.0 * FREQUENCY_1_S);
        self.rate_m_s += change.cap_magnitude(MOST_M_S2) * step_s;
        self.place_m += self.rate_m_s * step_s;
        let turn_deg_s = (self.heading_deg * FREQUENCY_1_S).clamp(-FASTEST_DEG_S, FASTEST_DEG_S);
        self.heading_deg -= turn_deg_s * step_s;
    }

    pub(super) fn place_m(&self) -> Vector2<f64> {
        self.place_m
    }

    pub(super) fn rate_m_s(&self) -> Vector2<f64> {
        self.rate_m_s
    }

    pub(super) fn heading_deg(&self) -> f64 {
        self.heading_deg
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jump_becomes_a_motion_that_ends() {
        let mut take_back = TakeBack::default();
        take_back.jumped(Vector2::new(0.5, -0.3), 10_f64.to_radians());
        let mut last = take_back;
        for step in 0..500 {
            take_back.advance(0.03);
            let moved = take_back.place_m() - last.place_m();
            assert!(moved.norm() <= FASTEST_M_S * 0.03 + 1e-9, "{step}");
            let faster = take_back.rate_m_s() - last.rate_m_s();
            assert!(faster.norm() <= MOST_M_S2 * 0.03 + 1e-9, "{step}");
            last = take_back;
        }
        assert!(take_back.place_m().norm() < 1e-3 && take_back.heading_deg().abs() < 1e-2);
    }

    fn assert_same(vector: Vector2<f64>, right: f64, forward: f64) {
        let expected = Vector2::new(right, forward);
        assert!((vector - expected).norm() < 1e-9, "{vector} is not {expected}");
    }

    #[test]
    fn jumps_add_up() {
        let mut take_back = TakeBack::default();
        take_back.jumped(Vector2::new(0.5, -0.3), 0.1);
        take_back.jumped(Vector2::new(-0.2, 0.1), 0.2);
        assert_same(take_back.place_m(), 0.3, -0.2);
        assert!((take_back.heading_deg() - 0.3_f64.to_degrees()).abs() < 1e-9);
        assert_same(take_back.rate_m_s(), 0.0, 0.0);
    }

    #[test]
    fn the_motion_back_begins_and_goes_within_its_limits() {
        // A small jump: a critically damped motion of 1.2 1/s, so -0.6 of it is the wanted rate, which is
        // approached with 2.4 1/s.
        let mut take_back = TakeBack::default();
        take_back.jumped(Vector2::new(0.1, -0.05), 2_f64.to_radians());
        take_back.advance(0.05);
        let rate_m_s = [-0.1, 0.05].map(|m: f64| m * 0.6 * 2.4 * 0.05);
        assert_same(take_back.rate_m_s(), rate_m_s[0], rate_m_s[1]);
        assert_same(take_back.place_m(), 0.1 + rate_m_s[0] * 0.05, -0.05 + rate_m_s[1] * 0.05);
        assert!((take_back.heading_deg() - 2.0 * (1.0 - 1.2 * 0.05)).abs() < 1e-9);
        // What has been reached is taken into account.
        let (place_m, rate_m_s) = (take_back.place_m(), take_back.rate_m_s());
        take_back.advance(0.05);
        let expected = rate_m_s + (place_m * -0.6 - rate_m_s) * 2.4 * 0.05;
        assert_same(take_back.rate_m_s(), expected.x, expected.y);
        // A large one: 0.4 m/s² at first, and 8 degrees per second.
        for sign in [-1.0, 1.0] {
            let mut take_back = TakeBack::default();
            take_back.jumped(Vector2::new(sign * 3.0, 0.0), sign * 30_f64.to_radians());
            take_back.advance(0.1);
            assert_same(take_back.rate_m_s(), -sign * 0.04, 0.0);
            assert!((take_back.heading_deg() - sign * (30.0 - 0.8)).abs() < 1e-9);
            // A pause is no longer step, and time does not run backward.
            take_back.advance(5.0);
            assert!((take_back.heading_deg() - sign * (30.0 - 1.6)).abs() < 1e-9);
            take_back.advance(-1.0);
            assert!((take_back.heading_deg() - sign * (30.0 - 1.6)).abs() < 1e-9);
            // It settles at a quarter of a metre per second.
            (0..30).for_each(|_| take_back.advance(0.1));
            assert!((take_back.rate_m_s().norm() - 0.25).abs() < 1e-3, "{take_back:?}");
        }
    }
}
