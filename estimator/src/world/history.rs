//! Recent motion and tilt of the drone.

use std::collections::VecDeque;

use nalgebra::Vector2;

use super::OdometryStep;
use crate::silence::USUAL_STEP_S;

/// More than a second of navdata at 200 packets per second.
const MEMORY: usize = 220;

/// The odometry at one moment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moment {
    pub(super) place_m: Vector2<f64>,
    pub(super) speed_m_s: f64,
    pub(super) yaw_deg: f64,
    /// Right side down, nose up.
    pub(super) tilt_deg: Vector2<f64>,
    pub(super) height_m: f64,
}

/// Positions and velocities by time.
type Places = VecDeque<(f64, (Vector2<f64>, Vector2<f64>))>;

/// Recent odometry, tilt and height, each by its own time.
#[derive(Debug, Clone)]
pub(super) struct History {
    places: Places,
    tilts: VecDeque<(f64, Vector2<f64>)>,
    heights: VecDeque<(f64, f64)>,
    newest_s: Option<f64>,
}

impl History {
    pub(super) fn new() -> Self {
        Self {
            places: VecDeque::with_capacity(MEMORY),
            tilts: VecDeque::with_capacity(MEMORY),
            heights: VecDeque::with_capacity(MEMORY),
            newest_s: None,
        }
    }

    /// Returns the displacement since the last step, and its duration, if the odometry has advanced.
    pub(super) fn push(&mut self, step: &OdometryStep) -> Option<(Vector2<f64>, f64)> {
        self.newest_s = Some(step.made_s);
        push(&mut self.tilts, step.tilt.0, step.tilt.1);
        push(&mut self.heights, step.height.0, step.height.1);
        let last = self.places.back().copied();
        let place = (step.place_m, step.velocity_m_s);
        if !push(&mut self.places, step.at_s, place) {
            return None;
        }
        last.map(|(last_s, (last_m, _))| (step.place_m - last_m, step.at_s - last_s))
    }

    /// Time of the newest sample.
    pub(super) fn newest_s(&self) -> Option<f64> {
        self.newest_s
    }

    /// The odometry at a time; `None` before the first sample.
    pub(super) fn at(&self, at_s: f64, yaw_deg: f64) -> Option<Moment> {
        let (place_m, velocity_m_s) = place_at(&self.places, at_s)?;
        Some(Moment {
            place_m,
            speed_m_s: velocity_m_s.norm(),
            yaw_deg,
            tilt_deg: between(&self.tilts, at_s, |from, to, share| from + (to - from) * share)?,
            height_m: between(&self.heights, at_s, |from, to, share| from + (to - from) * share)?,
        })
    }
}

/// Returns whether the value is newer than the last.
fn push<T>(line: &mut VecDeque<(f64, T)>, at_s: f64, value: T) -> bool {
    if line.back().is_some_and(|(last_s, _)| at_s <= *last_s) {
        return false;
    }
    if line.len() == MEMORY {
        line.pop_front();
    }
    line.push_back((at_s, value));
    true
}

/// Interpolates linearly; constant beyond the ends.
fn between<T: Copy>(
    line: &VecDeque<(f64, T)>,
    at_s: f64,
    mix: impl Fn(T, T, f64) -> T,
) -> Option<T> {
    let after = line.partition_point(|(time_s, _)| *time_s <= at_s);
    let before = after.checked_sub(1).and_then(|i| line.get(i));
    match (before, line.get(after)) {
        (Some((from_s, from)), Some((to_s, to))) => {
            Some(mix(*from, *to, (at_s - from_s) / (to_s - from_s).max(1e-9)))
        }
        (Some((_, only)), None) | (None, Some((_, only))) => Some(*only),
        (None, None) => None,
    }
}

/// Extrapolates with the velocity for a moment beyond the newest position.
fn place_at(places: &Places, at_s: f64) -> Option<(Vector2<f64>, Vector2<f64>)> {
    let (place_m, velocity_m_s) = between(places, at_s, |from, to, share| {
        (from.0 + (to.0 - from.0) * share, from.1 + (to.1 - from.1) * share)
    })?;
    let ahead_s = places.back().map_or(0.0, |(newest_s, _)| at_s - newest_s);
    Some((place_m + velocity_m_s * ahead_s.clamp(0.0, USUAL_STEP_S), velocity_m_s))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(at_s: f64) -> OdometryStep {
        OdometryStep {
            made_s: at_s + 0.06,
            at_s,
            place_m: Vector2::new(2.0 * at_s, -at_s),
            velocity_m_s: Vector2::new(3.0 * at_s, 4.0 * at_s),
            yaw_deg: 0.0,
            tilt: (at_s + 0.04, Vector2::new(at_s, 5.0 * at_s)),
            height: (at_s + 0.02, 1.0 + at_s),
            echo_m: 1.0 + at_s,
            airborne: true,
            unseen_m2: 0.0,
        }
    }

    fn assert_same(vector: Vector2<f64>, right: f64, forward: f64) {
        let expected = Vector2::new(right, forward);
        assert!((vector - expected).norm() < 1e-9, "{vector} is not {expected}");
    }

    #[test]
    fn a_step_is_the_way_since_the_last_and_its_time() {
        let mut history = History::new();
        assert!(history.at(1.0, 0.0).is_none() && history.newest_s().is_none());
        assert!(history.push(&step(1.0)).is_none(), "the first");
        let (way_m, step_s) = history.push(&step(1.5)).unwrap();
        assert_same(way_m, 1.0, -0.5);
        assert!((step_s - 0.5).abs() < 1e-9);
        assert!(history.push(&step(1.5)).is_none(), "the same again");
        assert!(history.push(&step(1.2)).is_none(), "an older one");
        // The odometry may repeat while the other sensors go on.
        let newer = OdometryStep { made_s: 2.0, tilt: (1.9, Vector2::x()), ..step(1.5) };
        assert!(history.push(&newer).is_none());
        assert_eq!(history.newest_s(), Some(2.0));
        assert_same(history.at(1.9, 0.0).unwrap().tilt_deg, 1.0, 0.0);
    }

    #[test]
    fn each_quantity_is_read_at_its_own_time() {
        let mut history = History::new();
        for at_s in [1.0, 2.0, 4.0] {
            history.push(&step(at_s));
        }
        let moment = history.at(2.5, 12.0).unwrap();
        assert_same(moment.place_m, 5.0, -2.5);
        assert!((moment.speed_m_s - 12.5).abs() < 1e-9);
        assert_same(moment.tilt_deg, 2.46, 12.3);
        assert!((moment.height_m - 3.48).abs() < 1e-9, "{}", moment.height_m);
        assert!((moment.yaw_deg - 12.0).abs() < 1e-9);
        // Before the first sample all is as then.
        let moment = history.at(0.0, 0.0).unwrap();
        assert_same(moment.place_m, 2.0, -1.0);
        assert_same(moment.tilt_deg, 1.0, 5.0);
        // Beyond the newest the drone flies on for a tenth of a second.
        assert_same(history.at(4.05, 0.0).unwrap().place_m, 8.0 + 0.6, -4.0 + 0.8);
        assert_same(history.at(5.0, 0.0).unwrap().place_m, 8.0 + 1.2, -4.0 + 1.6);
        assert!((history.at(5.0, 0.0).unwrap().height_m - 5.0).abs() < 1e-9);
    }

    #[test]
    fn only_the_newest_steps_are_kept() {
        let mut history = History::new();
        for i in 0..1000 {
            history.push(&step(f64::from(i)));
        }
        assert_eq!(history.places.len(), MEMORY);
        assert_same(history.at(0.0, 0.0).unwrap().place_m, 2.0 * 780.0, -780.0);
    }
}
