//! The flown path as shown on maps.

use std::collections::VecDeque;

/// Maximum number of points; the oldest are dropped.
const PLACES: usize = 2000;
/// Minimum distance of a new point from the last one.
const STEP_M: f64 = 0.02;

/// Points (right, forward) in metres relative to the start, oldest first.
#[derive(Debug, Clone, Default)]
pub(crate) struct FlownPath {
    places_m: VecDeque<(f64, f64)>,
}

impl FlownPath {
    /// Adds the drone's position.
    pub(crate) fn add(&mut self, x_m: f64, y_m: f64) {
        let far = |last: &(f64, f64)| (last.0 - x_m).hypot(last.1 - y_m) > STEP_M;
        if self.places_m.back().is_none_or(far) {
            self.places_m.push_back((x_m, y_m));
            if self.places_m.len() > PLACES {
                self.places_m.pop_front();
            }
        }
    }

    /// All points.
    pub(crate) fn places_m(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.places_m.iter().copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn standing_still_adds_nothing_and_old_places_go() {
        let mut path = FlownPath::default();
        for _ in 0..10 {
            path.add(1.0, 2.0);
        }
        assert_eq!(path.places_m().collect::<Vec<_>>(), [(1.0, 2.0)]);
        for step in 0..3000 {
            path.add(f64::from(step), 0.0);
        }
        assert_eq!(path.places_m().count(), PLACES);
        assert_eq!(path.places_m().last(), Some((2999.0, 0.0)));
    }
}
