//! The way that a drone needs to come to rest: computed once, for whoever asks.

use nalgebra::Vector2;

use crate::fence::Wall;

/// A velocity in a corner that is too fast by this is given up, in m/s.
const INTO_A_CORNER_M_S: f64 = 0.05;

/// How a drone comes to rest: it goes on for a while, then decelerates evenly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stopping {
    /// Time before it brakes.
    pub(crate) delay_s: f64,
    /// Its deceleration, positive.
    pub(crate) braking_m_s2: f64,
}

impl Stopping {
    /// What every airframe reaches, also against the wind: for orders that have time to stop early.
    pub(crate) const CAUTIOUS: Self = Self { delay_s: super::REACTION_S, braking_m_s2: 0.6 };

    /// The way to rest from this speed, in its direction.
    pub(crate) fn way_m(self, speed_m_s: f64) -> f64 {
        speed_m_s * self.delay_s + speed_m_s * speed_m_s.abs() / (2.0 * self.braking_m_s2)
    }

    /// The largest speed from which it comes to rest within a distance.
    pub(crate) fn speed_m_s(self, room_m: f64) -> f64 {
        let delay_m_s = self.braking_m_s2 * self.delay_s;
        (delay_m_s * delay_m_s + 2.0 * self.braking_m_s2 * room_m.max(0.0)).sqrt() - delay_m_s
    }
}

/// A wanted velocity, or another, from which a drone that has this one can stop before all walls, whose distances are those
/// at which it shall stop.
pub(crate) fn stopping_inside_m_s(
    wanted_m_s: Vector2<f64>,
    velocity_m_s: Vector2<f64>,
    walls: &(impl Iterator<Item = Wall> + Clone),
) -> Vector2<f64> {
    let too_fast_m_s = |velocity_m_s: Vector2<f64>, wall: &Wall| {
        let most_m_s = Stopping::CAUTIOUS.speed_m_s(wall.distance_m);
        (velocity_m_s.dot(&wall.outward) - most_m_s).max(0.0)
    };
    let slowed =
        |velocity_m_s, wall: Wall| velocity_m_s - wall.outward * too_fast_m_s(velocity_m_s, &wall);
    let brakes_m_s = walls.clone().fold(velocity_m_s, slowed) - velocity_m_s;
    if brakes_m_s != Vector2::zeros() {
        // All that it can do is to brake.
        return brakes_m_s;
    }
    let kept_m_s = walls.clone().fold(wanted_m_s, slowed);
    // What avoids one wall may lead to another: then it stays where it is.
    let is_trapped = walls.clone().any(|wall| too_fast_m_s(kept_m_s, &wall) > INTO_A_CORNER_M_S);
    if is_trapped { Vector2::zeros() } else { kept_m_s }
}

/// A wanted velocity as far as a drone can stop from it before all walls.
pub(super) fn straight_on_m_s(
    wanted_m_s: Vector2<f64>,
    walls: impl Iterator<Item = Wall>,
) -> Vector2<f64> {
    let share = |wall: Wall| {
        let most_m_s = Stopping::CAUTIOUS.speed_m_s(wall.distance_m);
        let outward_m_s = wanted_m_s.dot(&wall.outward);
        if outward_m_s > most_m_s { most_m_s / outward_m_s } else { 1.0 }
    };
    wanted_m_s * walls.map(share).fold(1.0, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_on_it_flies_as_fast_as_every_wall_allows() {
        let wall = |distance_m, x, y| Wall { distance_m, outward: Vector2::new(x, y) };
        let wanted_m_s = Vector2::new(1.0, 0.0);
        let left_m_s = |walls: &[Wall]| straight_on_m_s(wanted_m_s, walls.iter().copied()).x;
        assert!((left_m_s(&[wall(0.0, 0.0, 1.0), wall(0.0, -1.0, 0.0)]) - 1.0).abs() < 1e-9);
        let most_m_s = Stopping::CAUTIOUS.speed_m_s(0.1);
        let ahead = [wall(0.1, 0.8, 0.6), wall(0.2, 0.8, -0.6)];
        assert!((left_m_s(&ahead) - most_m_s / 0.8).abs() < 1e-9);
        assert!(left_m_s(&[wall(-0.1, 0.8, 0.6)]).abs() < 1e-9);
    }

    #[test]
    fn the_largest_speed_needs_the_whole_room() {
        for room_m in [0.0, 0.1, 2.0] {
            let speed_m_s = Stopping::CAUTIOUS.speed_m_s(room_m);
            assert!((Stopping::CAUTIOUS.way_m(speed_m_s) - room_m).abs() < 1e-9);
            assert!((Stopping::CAUTIOUS.way_m(-speed_m_s) + room_m).abs() < 1e-9);
        }
    }
}
