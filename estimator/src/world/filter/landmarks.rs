//! Adds tags to the state and removes them.

use nalgebra::{Matrix2, Vector2};

use kinematics::wrap_rad;

use super::{
    Filter, HEADING, MEAN_ORIENTATION_DEG, PLACE, Row, START_DEG, START_M, STATES, Sighted, TAGS,
    dot,
};

/// Accuracy of a tape measure, and of the angle of a sheet of paper.
const SURVEY_M: f64 = 0.02;
const SURVEY_DEG: f64 = 2.0;

#[expect(clippy::needless_range_loop, reason = "rows and columns of matrices")]
impl Filter {
    /// Adds a tag at the position where it was seen; its error is correlated with that of the drone's
    /// position.
    pub(in crate::world) fn begin_tag(&mut self, tag: usize, sighted: &Sighted) {
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
    pub(in crate::world) fn survey_tag(
        &mut self,
        tag: usize,
        place_m: Vector2<f64>,
        heading_rad: Option<f64>,
    ) {
        let state = TAGS + 3 * tag;
        self.used = self.used.max(state + 3);
        for axis in 0..2 {
            self.forget(state + axis, SURVEY_M * SURVEY_M);
            self.x[state + axis] = place_m[axis];
        }
        self.forget(state + 2, 0.0);
        if let Some(heading_rad) = heading_rad {
            self.survey_heading(tag, heading_rad);
        }
    }

    fn survey_heading(&mut self, tag: usize, heading_rad: f64) {
        let state = TAGS + 3 * tag + 2;
        self.forget(state, SURVEY_DEG.to_radians().powi(2));
        self.x[state] = heading_rad;
    }

    /// The world is now given by surveyed tags and no longer by the start of the drone, which stood there with
    /// the accuracy of its placement: everything known may be displaced and turned together. The drone is at
    /// `place_m`.
    pub(in crate::world) fn doubt_frame(&mut self, place_m: Vector2<f64>) {
        let mut displaced = [[0.0; STATES]; 2];
        let mut turned = [0.0; STATES];
        // A clockwise turn about the origin moves what is forward to the right.
        let mut moves = |state: usize, place_m: Vector2<f64>| {
            (displaced[0][state], displaced[1][state + 1]) = (START_M, START_M);
            turned[state] = place_m.y * START_DEG.to_radians();
            turned[state + 1] = -place_m.x * START_DEG.to_radians();
        };
        moves(PLACE, place_m);
        for tag in 0..(self.used - TAGS) / 3 {
            moves(TAGS + 3 * tag, self.tag_place_m(tag));
        }
        turned[HEADING] = START_DEG.to_radians();
        for tag in 0..(self.used - TAGS) / 3 {
            turned[TAGS + 3 * tag + 2] = START_DEG.to_radians();
        }
        for way in [displaced[0], displaced[1], turned] {
            for i in 0..self.used {
                for j in 0..self.used {
                    self.p[i][j] += way[i] * way[j];
                }
            }
        }
    }

    /// A known tag was surveyed: corrects the state by its position and, if it was measured, its direction.
    /// `has_heading`: whether its direction is known.
    pub(in crate::world) fn correct_by_survey(
        &mut self,
        tag: usize,
        place_m: Vector2<f64>,
        heading_rad: Option<f64>,
        has_heading: bool,
    ) {
        let state = TAGS + 3 * tag;
        let mut rows = [[0.0; STATES]; 2];
        (rows[0][state], rows[1][state + 1]) = (1.0, 1.0);
        self.correct_two(&rows, self.tag_place_m(tag) - place_m, SURVEY_M * SURVEY_M);
        let Some(heading_rad) = heading_rad else { return };
        if has_heading {
            let mut row: Row = [0.0; STATES];
            row[state + 2] = 1.0;
            let off = wrap_rad(heading_rad - self.x[state + 2]);
            self.correct_one(&row, off, SURVEY_DEG.to_radians().powi(2));
        } else {
            self.survey_heading(tag, heading_rad);
        }
    }

    /// Adds the direction of a tag: its mean by the estimated heading.
    pub(in crate::world) fn begin_heading(&mut self, tag: usize, direction_rad: f64) {
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
    pub(in crate::world) fn use_tags(&mut self, tags: usize) {
        self.used = TAGS + 3 * tags;
    }

    /// Removes a tag.
    pub(in crate::world) fn forget_tag(&mut self, tag: usize) {
        for axis in 0..3 {
            self.forget(TAGS + 3 * tag + axis, 0.0);
        }
    }
}
