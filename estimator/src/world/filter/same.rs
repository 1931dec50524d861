//! Whether two tags are one. All tags look alike, so only position and direction distinguish them.

use nalgebra::{Matrix2, Vector2};

use super::{Filter, Row, STATES, TAGS, squared_deviations};
use crate::sensor::{CLEAR, FLOW_SCALE, GATE};

impl Filter {
    /// Whether two tags may be one, `way_m` from the last sighting.
    pub(in crate::world) fn may_be_one(&self, one: usize, other: usize, way_m: f64) -> bool {
        self.squared_deviations(one, other, way_m) < GATE * GATE
    }

    /// Whether a tag is this one rather than a rival, `way_m` from the last sighting.
    pub(in crate::world) fn is_rather(
        &self,
        tag: usize,
        this: usize,
        rival: usize,
        way_m: f64,
    ) -> bool {
        let off = |other: usize| self.squared_deviations(tag, other, way_m);
        // All tags look alike.
        off(rival) >= off(this) + CLEAR * CLEAR
    }

    /// Logarithm of the odds, by their positions, that two tags are one and not a known tag and one that is not
    /// in the map yet, `way_m` from the last sighting. The larger the uncertainty, the more room there is for
    /// others, of which `others_1_m2` are expected per square metre.
    pub(in crate::world) fn log_odds_of_one(
        &self,
        one: usize,
        other: usize,
        way_m: f64,
        others_1_m2: f64,
    ) -> f64 {
        let (off, spread) = self.between(one, other, way_m);
        let room_m2 = std::f64::consts::TAU * spread.determinant().max(0.0).sqrt();
        -squared_deviations(off, spread) / 2.0 - (room_m2 * others_1_m2).ln()
    }

    /// Square of the number of standard deviations between two tags; infinite if that is not known.
    fn squared_deviations(&self, one: usize, other: usize, way_m: f64) -> f64 {
        let (off, spread) = self.between(one, other, way_m);
        squared_deviations(off, spread)
    }

    /// From one tag to the other, and the covariance of that, `way_m` from the last sighting.
    fn between(&self, one: usize, other: usize, way_m: f64) -> (Vector2<f64>, Matrix2<f64>) {
        let (_, spread) = self.spread(&Self::same_rows(one, other));
        let off = self.tag_place_m(one) - self.tag_place_m(other);
        (off, spread + Matrix2::identity() * same_variance_m2(way_m))
    }

    /// Merges two tags that are one.
    pub(in crate::world) fn make_one(&mut self, one: usize, other: usize, way_m: f64) {
        let off = self.tag_place_m(one) - self.tag_place_m(other);
        self.correct_two(&Self::same_rows(one, other), off, same_variance_m2(way_m));
    }

    pub(super) fn same_rows(one: usize, other: usize) -> [Row; 2] {
        let mut rows = [[0.0; STATES]; 2];
        for (axis, row) in rows.iter_mut().enumerate() {
            row[TAGS + 3 * one + axis] = 1.0;
            row[TAGS + 3 * other + axis] = -1.0;
        }
        rows
    }
}

/// Variance that the flow's scale adds between two sightings of the same tag.
pub(super) fn same_variance_m2(way_m: f64) -> f64 {
    const SAME_M: f64 = 0.02;
    SAME_M * SAME_M + (FLOW_SCALE * way_m).powi(2)
}
