//! The flown path as shown on maps.

use std::collections::VecDeque;

use kinematics::Pose;

/// Maximum number of points; the oldest are dropped.
const PLACES: usize = 2000;
/// Minimum distance of a new point from the last one.
const STEP_M: f64 = 0.02;

/// Points (right, forward, up) in metres relative to the start, oldest first.
#[derive(Debug, Clone, Default)]
pub(crate) struct FlownPath {
    places_m: VecDeque<[f64; 3]>,
}

impl FlownPath {
    /// Adds the drone's position.
    pub(crate) fn add(&mut self, pose: &Pose) {
        let place_m = [pose.x_m, pose.y_m, pose.z_m];
        let far = |last: &[f64; 3]| {
            (last[0] - pose.x_m).hypot(last[1] - pose.y_m).hypot(last[2] - pose.z_m) > STEP_M
        };
        if self.places_m.back().is_none_or(far) {
            self.places_m.push_back(place_m);
            if self.places_m.len() > PLACES {
                self.places_m.pop_front();
            }
        }
    }

    /// All points.
    pub(crate) fn places_m(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        self.places_m.iter().copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn standing_still_adds_nothing_and_old_places_go() {
        let at = |x_m, y_m, z_m| Pose { x_m, y_m, z_m, yaw_deg: 0.0 };
        let mut path = FlownPath::default();
        for _ in 0..10 {
            path.add(&at(1.0, 2.0, 0.5));
        }
        assert_eq!(path.places_m().collect::<Vec<_>>(), [[1.0, 2.0, 0.5]]);
        path.add(&at(1.0, 2.0, 0.6));
        assert_eq!(path.places_m().count(), 2, "it has climbed");
        for step in 0..3000 {
            path.add(&at(f64::from(step), 0.0, 1.0));
        }
        assert_eq!(path.places_m().count(), PLACES);
        assert_eq!(path.places_m().last(), Some([2999.0, 0.0, 1.0]));
    }
}
