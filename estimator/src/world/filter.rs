//! An extended Kalman filter for the error of the odometry.
//!
//! State: correction of the position (2), bias of the flow in the body frame (2), correction of the heading
//! and its rate, two angles of the camera's centre (mounting, level reference, calibration), and for each tag
//! its position (2) and direction. Arrays of fixed size: no allocation.

mod landmarks;
mod same;

use nalgebra::{Matrix2, Vector2};

use super::SLOTS;
use super::camera::Look;
use super::history::Moment;
use crate::Start;
use crate::sensor::{FLOW_SCALE, GATE, ORIENTATION_DEG};
use kinematics::{world_from_body, wrap_deg, wrap_rad};

const PLACE: usize = 0;
const BIAS: usize = 2;
const HEADING: usize = 4;
const RATE: usize = 5;
const CAMERA: usize = 6;
const TAGS: usize = 8;
const STATES: usize = TAGS + 3 * SLOTS;

/// Initial standard deviation of the flow's bias, its random walk, and the time constant of its decay.
const BIAS_M_S: f64 = 0.013;
const BIAS_WALK_M_S: f64 = 0.003;
const BIAS_TIME_S: f64 = 120.0;
/// Variance that the flow's noise adds to the position, in m² per second.
const PLACE_WALK_M2_S: f64 = 1e-4;
/// Standard deviation of the heading's drift, and its random walk.
const RATE_DEG_S: f64 = 0.03;
const RATE_WALK_DEG_S: f64 = 0.0005;
const HEADING_WALK_DEG: f64 = 0.02;
/// Standard deviation of the camera's centre: 50 units, and a degree of mounting.
const CAMERA_RAD: f64 = 0.03;
/// Standard deviation with which a drone is placed at the start of the plan, and aligned.
const START_M: f64 = 0.15;
const START_DEG: f64 = 5.0;
/// Standard deviations of one sighting: a fraction of the height, a fraction of the offset (focal length),
/// the age of the picture, and a constant. Consecutive sightings have correlated errors, so each has more
/// variance than its noise alone.
const SIGHT_HEIGHT: f64 = 0.03;
const SIGHT_ASIDE: f64 = 0.06;
const SIGHT_AGE_S: f64 = 0.06;
const SIGHT_M: f64 = 0.01;
/// Standard deviation of a mean orientation.
const MEAN_ORIENTATION_DEG: f64 = 3.0;

/// Correction to be added to the odometry.
#[derive(Debug, Clone, Copy)]
pub(super) struct Correction {
    pub(super) place_m: Vector2<f64>,
    pub(super) heading_rad: f64,
}

/// A sighting in the world frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sighted {
    /// Estimated position of the tag.
    pub(super) place_m: Vector2<f64>,
    /// From the drone to the tag.
    from_drone_m: Vector2<f64>,
    /// World displacement (right, forward) per camera angle.
    camera_m: Matrix2<f64>,
    variance_m2: f64,
    /// Variance that the scale of the odometry adds to the gate.
    scale_m2: f64,
}

#[derive(Debug, Clone)]
pub(super) struct Filter {
    x: [f64; STATES],
    p: [[f64; STATES]; STATES],
    /// Number of states in use; the rest is not evaluated.
    used: usize,
}

type Row = [f64; STATES];

#[expect(clippy::needless_range_loop, reason = "rows and columns of matrices")]
impl Filter {
    /// `surveyed`: the world is given by tags, and the drone stands in it with the accuracy of its placement.
    pub(super) fn new(surveyed: bool, start: &Start) -> Self {
        let mut filter = Self { x: [0.0; STATES], p: [[0.0; STATES]; STATES], used: TAGS };
        filter.x[PLACE] = start.place_m.x;
        filter.x[PLACE + 1] = start.place_m.y;
        let mut set = |state: usize, deviation: f64| filter.p[state][state] = deviation * deviation;
        let [least_m, least_deg] = if surveyed { [START_M, START_DEG] } else { [0.0; 2] };
        for axis in 0..2 {
            set(BIAS + axis, BIAS_M_S);
            set(CAMERA + axis, CAMERA_RAD);
            set(PLACE + axis, start.uncertainty_m.max(least_m));
        }
        set(RATE, RATE_DEG_S.to_radians());
        set(HEADING, start.heading_uncertainty_deg.max(least_deg).to_radians());
        filter
    }

    pub(super) fn correction(&self) -> Correction {
        Correction {
            place_m: Vector2::new(self.x[PLACE], self.x[PLACE + 1]),
            heading_rad: self.x[HEADING],
        }
    }

    /// Standard deviation of the heading.
    pub(super) fn heading_uncertainty_deg(&self) -> f64 {
        self.p[HEADING][HEADING].sqrt().to_degrees()
    }

    pub(super) fn bias_m_s(&self) -> Vector2<f64> {
        Vector2::new(self.x[BIAS], self.x[BIAS + 1])
    }

    /// Variance of the position on the worse axis.
    pub(super) fn place_variance_m2(&self) -> f64 {
        self.p[PLACE][PLACE].max(self.p[PLACE + 1][PLACE + 1])
    }

    /// Propagates by a displacement of the odometry at a heading, in this much time of flight.
    pub(super) fn fly(&mut self, way_m: Vector2<f64>, yaw_deg: f64, step_s: f64) {
        let heading_rad = self.x[HEADING];
        let turned = world_from_body(way_m, heading_rad.to_degrees());
        let yaw_deg = yaw_deg + heading_rad.to_degrees();
        let (right, forward) =
            (world_from_body(Vector2::x(), yaw_deg), world_from_body(Vector2::y(), yaw_deg));
        let biased = (right * self.x[BIAS] + forward * self.x[BIAS + 1]) * step_s;
        // Derivative with respect to the heading.
        let by_heading = Vector2::new(turned.y, -turned.x);
        let kept = (1.0 - step_s / BIAS_TIME_S).max(0.0);
        for axis in 0..2 {
            self.x[PLACE + axis] += turned[axis] - way_m[axis] - biased[axis];
            self.x[BIAS + axis] *= kept;
        }
        self.x[HEADING] += self.x[RATE] * step_s;
        let transition = |row: &mut dyn FnMut(usize) -> f64| -> [f64; TAGS] {
            let mut new = [0.0; TAGS];
            for axis in 0..2 {
                new[PLACE + axis] = row(PLACE + axis) + by_heading[axis] * row(HEADING)
                    - (right[axis] * row(BIAS) + forward[axis] * row(BIAS + 1)) * step_s;
                new[BIAS + axis] = kept * row(BIAS + axis);
                new[CAMERA + axis] = row(CAMERA + axis);
            }
            new[HEADING] = row(HEADING) + row(RATE) * step_s;
            new[RATE] = row(RATE);
            new
        };
        for column in 0..self.used {
            let new = transition(&mut |state| self.p[state][column]);
            for (state, value) in new.into_iter().enumerate() {
                self.p[state][column] = value;
            }
        }
        for row in self.p.iter_mut().take(self.used) {
            let new = transition(&mut |state| row[state]);
            row[..TAGS].copy_from_slice(&new);
        }
        let mut add = |state: usize, variance: f64| self.p[state][state] += variance * step_s;
        for axis in 0..2 {
            add(PLACE + axis, PLACE_WALK_M2_S);
            add(BIAS + axis, BIAS_WALK_M_S * BIAS_WALK_M_S);
        }
        add(HEADING, HEADING_WALK_DEG.to_radians().powi(2));
        add(RATE, RATE_WALK_DEG_S.to_radians().powi(2));
    }

    pub(super) fn doubt_place(&mut self, variance_m2: f64) {
        self.p[PLACE][PLACE] += variance_m2;
        self.p[PLACE + 1][PLACE + 1] += variance_m2;
    }

    pub(super) fn doubt_heading(&mut self, deviation_rad: f64) {
        self.p[HEADING][HEADING] += deviation_rad * deviation_rad;
    }

    /// The flow's bias is unknown again, as at the start.
    pub(super) fn forget_bias(&mut self) {
        for axis in 0..2 {
            self.forget(BIAS + axis, BIAS_M_S * BIAS_M_S);
            self.x[BIAS + axis] = 0.0;
        }
    }

    /// The drift of the heading is unknown again, as at the start.
    pub(super) fn forget_rate(&mut self) {
        self.forget(RATE, RATE_DEG_S.to_radians().powi(2));
        self.x[RATE] = 0.0;
    }

    /// Drift of the heading.
    pub(super) fn heading_rate_deg_s(&self) -> f64 {
        self.x[RATE].to_degrees()
    }

    /// Resets a state to zero with a variance.
    fn forget(&mut self, state: usize, variance: f64) {
        for other in 0..STATES {
            self.p[state][other] = 0.0;
            self.p[other][state] = 0.0;
        }
        self.p[state][state] = variance;
    }

    /// Transforms a look to the world; `way_m` is the distance from the last sighting of a tag.
    pub(super) fn sighted(&self, look: &Look, moment: &Moment, way_m: f64) -> Sighted {
        let yaw_deg = moment.yaw_deg + self.x[HEADING].to_degrees();
        let height_m = look.height_m;
        let off = Vector2::new(self.x[CAMERA], self.x[CAMERA + 1]) * height_m;
        let from_drone_m = world_from_body(look.offset_m + off, yaw_deg);
        let camera_m = Matrix2::from_columns(&[
            world_from_body(Vector2::x(), yaw_deg) * height_m,
            world_from_body(Vector2::y(), yaw_deg) * height_m,
        ]);
        let parts = [
            SIGHT_M,
            SIGHT_HEIGHT * height_m,
            SIGHT_ASIDE * look.offset_m.norm(),
            SIGHT_AGE_S * moment.speed_m_s,
        ];
        Sighted {
            place_m: moment.place_m + self.correction().place_m + from_drone_m,
            from_drone_m,
            camera_m,
            variance_m2: parts.iter().map(|part| part * part).sum(),
            scale_m2: (FLOW_SCALE * way_m).powi(2),
        }
    }

    /// Rows of the Jacobian of a sighting, without the tag's own position.
    fn rows(sighted: &Sighted) -> [Row; 2] {
        let mut rows = [[0.0; STATES]; 2];
        let by_heading = Vector2::new(sighted.from_drone_m.y, -sighted.from_drone_m.x);
        for (axis, row) in rows.iter_mut().enumerate() {
            row[PLACE + axis] = 1.0;
            row[HEADING] = by_heading[axis];
            row[CAMERA] = sighted.camera_m[(axis, 0)];
            row[CAMERA + 1] = sighted.camera_m[(axis, 1)];
        }
        rows
    }

    fn tag_rows(sighted: &Sighted, tag: usize) -> [Row; 2] {
        let mut rows = Self::rows(sighted);
        for (axis, row) in rows.iter_mut().enumerate() {
            row[TAGS + 3 * tag + axis] = -1.0;
        }
        rows
    }

    pub(super) fn tag_place_m(&self, tag: usize) -> Vector2<f64> {
        let state = TAGS + 3 * tag;
        Vector2::new(self.x[state], self.x[state + 1])
    }

    pub(super) fn tag_heading_deg(&self, tag: usize) -> f64 {
        wrap_deg(self.x[TAGS + 3 * tag + 2].to_degrees())
    }

    pub(super) fn tag_uncertainty_m(&self, tag: usize) -> f64 {
        let state = TAGS + 3 * tag;
        self.p[state][state].max(self.p[state + 1][state + 1]).sqrt()
    }

    /// `P Hᵀ` of one row.
    fn gain(&self, row: &Row) -> Row {
        let mut gain = [0.0; STATES];
        for (value, line) in gain.iter_mut().zip(&self.p).take(self.used) {
            *value = dot(row, line, self.used);
        }
        gain
    }

    /// `P Hᵀ` and `H P Hᵀ` of two rows.
    fn spread(&self, rows: &[Row; 2]) -> ([Row; 2], Matrix2<f64>) {
        let gains = [self.gain(&rows[0]), self.gain(&rows[1])];
        let spread = Matrix2::from_fn(|i, j| dot(&rows[i], &gains[j], self.used));
        (gains, spread)
    }

    /// Whether a sighting passes the gate of this tag.
    pub(super) fn admits(&self, sighted: &Sighted, tag: usize) -> bool {
        let off = sighted.place_m - self.tag_place_m(tag);
        let (_, spread) = self.spread(&Self::tag_rows(sighted, tag));
        let spread = spread + Matrix2::identity() * (sighted.variance_m2 + sighted.scale_m2);
        squared_deviations(off, spread) < GATE * GATE
    }

    /// Corrects the state by a sighting of a tag.
    pub(super) fn correct(&mut self, sighted: &Sighted, tag: usize) {
        let off = sighted.place_m - self.tag_place_m(tag);
        let rows = Self::tag_rows(sighted, tag);
        self.correct_two(&rows, off, sighted.variance_m2 + sighted.scale_m2);
    }

    /// Corrects by two rows whose measured value should be zero and was `off`, with a variance.
    fn correct_two(&mut self, rows: &[Row; 2], off: Vector2<f64>, variance_m2: f64) {
        let (gains, spread) = self.spread(rows);
        let spread = spread + Matrix2::identity() * variance_m2;
        let Some(inverse) = spread.try_inverse() else { return };
        let weighted = inverse * off;
        for (state, value) in self.x.iter_mut().enumerate().take(self.used) {
            *value -= gains[0][state] * weighted.x + gains[1][state] * weighted.y;
        }
        for i in 0..self.used {
            let left = inverse * Vector2::new(gains[0][i], gains[1][i]);
            for j in i..self.used {
                let less = left.x * gains[0][j] + left.y * gains[1][j];
                let value = self.p[i][j] - less;
                self.p[i][j] = value;
                self.p[j][i] = value;
            }
        }
    }

    /// Corrects the heading by one orientation: the direction of the tag by the current heading.
    pub(super) fn correct_heading(&mut self, tag: usize, direction_rad: f64) {
        let state = TAGS + 3 * tag + 2;
        let mut row = [0.0; STATES];
        row[HEADING] = 1.0;
        row[state] = -1.0;
        let variance = ORIENTATION_DEG.to_radians().powi(2);
        let off = wrap_rad(self.x[state] - direction_rad);
        if off * off <= GATE * GATE * (dot(&row, &self.gain(&row), self.used) + variance) {
            self.correct_one(&row, off, variance);
        }
    }

    /// Corrects by a row whose measured value is larger than the estimated one by `off`, with a variance.
    fn correct_one(&mut self, row: &Row, off: f64, variance: f64) {
        let gain = self.gain(row);
        let spread = dot(row, &gain, self.used) + variance;
        for (value, gain) in self.x.iter_mut().zip(&gain).take(self.used) {
            *value += gain * off / spread;
        }
        for i in 0..self.used {
            for j in i..self.used {
                let value = self.p[i][j] - gain[i] * gain[j] / spread;
                self.p[i][j] = value;
                self.p[j][i] = value;
            }
        }
    }
}

fn squared_deviations(off: Vector2<f64>, spread: Matrix2<f64>) -> f64 {
    spread.try_inverse().map_or(f64::INFINITY, |inverse| (off.transpose() * inverse * off).x)
}

fn dot(left: &Row, right: &Row, used: usize) -> f64 {
    left.iter().zip(right).take(used).map(|(left, right)| left * right).sum()
}

#[cfg(test)]
mod tests;
