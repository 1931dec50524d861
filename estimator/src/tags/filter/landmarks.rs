//! Adds tags to the state and removes them.

use nalgebra::{Matrix2, Vector2};

use super::{Filter, HEADING, MEAN_ORIENTATION_DEG, Sighted, TAGS, dot};

#[expect(clippy::needless_range_loop, reason = "rows and columns of matrices")]
impl Filter {
    /// Adds a tag at the position where it was seen; its error is correlated with that of the drone's
    /// position.
    pub(in crate::tags) fn begin_tag(&mut self, tag: usize, sighted: &Sighted) {
        let state = TAGS + 3 * tag;
        self.used = self.used.max(state + 3);
        for axis in 0..3 {
            self.forget(state + axis, 0.0);
        }
        let rows = Self::rows(sighted);
        let gains = [self.gain(&rows[0]), self.gain(&rows[1])];
        let spread = Matrix2::from_fn(|i, j| dot(&rows[i], &gains[j], self.used));
        for axis in 0..2 {
            for other in 0..self.used {
                self.p[state + axis][other] = gains[axis][other];
                self.p[other][state + axis] = gains[axis][other];
            }
        }
        for i in 0..2 {
            for j in 0..2 {
                self.p[state + i][state + j] = spread[(i, j)];
            }
            self.p[state + i][state + i] += sighted.variance_m2;
            self.x[state + i] = sighted.place_m[i];
        }
    }

    /// Adds a tag with a known position.
    pub(in crate::tags) fn survey_tag(
        &mut self,
        tag: usize,
        place_m: Vector2<f64>,
        heading_rad: Option<f64>,
    ) {
        /// Accuracy of a tape measure, and of the angle of a sheet of paper.
        const SURVEY_M: f64 = 0.02;
        const SURVEY_DEG: f64 = 2.0;
        let state = TAGS + 3 * tag;
        self.used = self.used.max(state + 3);
        for axis in 0..2 {
            self.forget(state + axis, SURVEY_M * SURVEY_M);
            self.x[state + axis] = place_m[axis];
        }
        self.forget(state + 2, 0.0);
        if let Some(heading_rad) = heading_rad {
            self.p[state + 2][state + 2] = SURVEY_DEG.to_radians().powi(2);
            self.x[state + 2] = heading_rad;
        }
    }

    /// Adds the direction of a tag: its mean by the estimated heading.
    pub(in crate::tags) fn begin_heading(&mut self, tag: usize, direction_rad: f64) {
        let state = TAGS + 3 * tag + 2;
        self.forget(state, 0.0);
        for other in 0..self.used {
            let covariance = self.p[HEADING][other];
            self.p[state][other] = covariance;
            self.p[other][state] = covariance;
        }
        self.p[state][state] = self.p[HEADING][HEADING] + MEAN_ORIENTATION_DEG.to_radians().powi(2);
        self.x[state] = direction_rad;
    }

    /// Sets the number of tags in use.
    pub(in crate::tags) fn use_tags(&mut self, tags: usize) {
        self.used = TAGS + 3 * tags;
    }

    /// Removes a tag.
    pub(in crate::tags) fn forget_tag(&mut self, tag: usize) {
        for axis in 0..3 {
            self.forget(TAGS + 3 * tag + axis, 0.0);
        }
    }
}
