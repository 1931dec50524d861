//! A polygon, which need not be convex.

use std::f64::consts::PI;

use arrayvec::ArrayVec;
use nalgebra::Vector2;

/// Most corners of a polygon: as many as any outline of a room has. The nearest place inside costs their third power: with these
/// at most 0.04 ms of the tick, with twice as many 0.3 ms.
pub const MAX_CORNERS: usize = 32;
/// A corner is at most this far from the start, in metres, right or left and forward or back: as far as a circle may reach.
const FURTHEST_M: f64 = 200.0;
/// Least area in square metres: that of the smallest circle, of half a metre.
const LEAST_AREA_M2: f64 = PI * 0.25;
/// Sides nearer to each other than this, in metres, meet: nobody measures rooms to a tenth of a millimetre.
const MEETS_M: f64 = 1e-4;
/// The nearest place that is inside by a distance is sought no further away than this many distances, as in a corner of 60°.
/// Where there is none, as in a corridor, a place in the next room would be a flight that nobody ordered.
const ASIDE: f64 = 2.0;
/// Error of what is computed here, in metres.
const ROUNDING_M: f64 = 1e-9;

/// Why corners are no border.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum BorderError {
    /// Fewer than three.
    #[error("{0} corners enclose nothing: give at least three, [right, forward] in metres")]
    TooFew(usize),
    /// More than [`MAX_CORNERS`].
    #[error("{0} corners: at most {MAX_CORNERS} are taken, so leave out those that matter least")]
    TooMany(usize),
    /// One that is nowhere, or far away. Counted from one, as all that are named.
    #[error(
        "corner {0} is no place within {FURTHEST_M} m: give metres right and forward of the start"
    )]
    Far(usize),
    /// Two sides that meet elsewhere than in their common corner.
    #[error(
        "the sides from corner {0} and from corner {1} meet: give the corners in their order along the \
         border, each once"
    )]
    Meets(usize, usize),
    /// It encloses nearly nothing.
    #[error("it encloses {area_m2:.2} m², where a drone has no room: make it wider")]
    Small {
        /// Square metres.
        area_m2: f64,
    },
    /// The start of the flight is outside.
    #[error(
        "the start (0, 0) is outside: give the corners right and forward of where the drone starts"
    )]
    StartOutside,
}

/// A part of the border, as seen from a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wall {
    /// Distance to it in metres, negative outside.
    pub(crate) distance_m: f64,
    /// Unit vector towards it, or away from it outside; zero where there is no such direction.
    pub(crate) outward: Vector2<f64>,
}

/// A polygon with the start inside.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Polygon {
    /// Those behind the last are zero.
    corners_m: [[f64; 2]; MAX_CORNERS],
    count: usize,
    /// Whether the inside is to the left of each side.
    is_left: bool,
}

/// A side, from one corner to the next.
#[derive(Debug, Clone, Copy)]
struct Side {
    from_m: Vector2<f64>,
    /// The very corner where the next side begins: a ray through a corner passes one of the two, which rounding decides alike.
    to_m: Vector2<f64>,
    along: Vector2<f64>,
    length_m: f64,
    /// Unit vector out.
    out: Vector2<f64>,
}

impl Side {
    /// The nearest point of the side.
    fn nearest_m(&self, place_m: Vector2<f64>) -> Vector2<f64> {
        let passed_m = (place_m - self.from_m).dot(&self.along);
        self.from_m + self.along * passed_m.clamp(0.0, self.length_m)
    }

    fn distance_m(&self, place_m: Vector2<f64>) -> f64 {
        (place_m - self.nearest_m(place_m)).norm()
    }

    /// Where a ray passes the line through the side, if it does so on the side. Of two sides with a common corner one has it.
    fn crossed_at_m(&self, from_m: Vector2<f64>, heading: Vector2<f64>) -> Option<f64> {
        let [a, b] = [self.from_m - from_m, self.to_m - from_m];
        let [left, right] = [cross(heading, a), cross(heading, b)];
        ((left >= 0.0) != (right >= 0.0))
            .then(|| (a + (b - a) * (left / (left - right))).dot(&heading))
    }

    /// The part of a ray that is nearer to the side than `radius_m`.
    fn near_m(
        &self,
        from_m: Vector2<f64>,
        heading: Vector2<f64>,
        radius_m: f64,
    ) -> Option<[f64; 2]> {
        let around = |end_m: Vector2<f64>| {
            let to_end_m = end_m - from_m;
            let (ahead_m, aside_m) = (to_end_m.dot(&heading), cross(heading, to_end_m));
            let half_m2 = radius_m * radius_m - aside_m * aside_m;
            (half_m2 >= 0.0).then(|| [ahead_m - half_m2.sqrt(), ahead_m + half_m2.sqrt()])
        };
        let off_m = from_m - self.from_m;
        let within = |place_m: f64, speed: f64, [low_m, high_m]: [f64; 2]| {
            if speed.abs() < ROUNDING_M {
                return (low_m..=high_m)
                    .contains(&place_m)
                    .then_some([f64::NEG_INFINITY, f64::INFINITY]);
            }
            let [one, other] = [(low_m - place_m) / speed, (high_m - place_m) / speed];
            Some([one.min(other), one.max(other)])
        };
        let beside = within(off_m.dot(&self.along), heading.dot(&self.along), [0.0, self.length_m])
            .zip(within(off_m.dot(&self.out), heading.dot(&self.out), [-radius_m, radius_m]))
            .map(|(a, b)| [a[0].max(b[0]), a[1].min(b[1])])
            .filter(|[begins, ends]| begins <= ends);
        // The three overlap.
        let parts = [around(self.from_m), around(self.to_m), beside];
        parts.into_iter().flatten().reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }
}

/// A part of the border of what is inside by some distance: a line beside a side, or an arc around a corner that points in.
#[derive(Debug, Clone, Copy)]
enum Edge {
    Line { at_m: Vector2<f64>, along: Vector2<f64> },
    Arc { centre_m: Vector2<f64> },
}

impl Polygon {
    pub(super) fn new(corners_m: &[[f64; 2]]) -> Result<Self, BorderError> {
        let count = corners_m.len();
        if count < 3 {
            return Err(BorderError::TooFew(count));
        }
        if count > MAX_CORNERS {
            return Err(BorderError::TooMany(count));
        }
        let is_near = |[x, y]: &[f64; 2]| x.abs() <= FURTHEST_M && y.abs() <= FURTHEST_M;
        if let Some(far) = corners_m.iter().position(|corner| !is_near(corner)) {
            return Err(BorderError::Far(far + 1));
        }
        let mut kept = [[0.0; 2]; MAX_CORNERS];
        for (slot, corner) in kept.iter_mut().zip(corners_m) {
            *slot = *corner;
        }
        let mut polygon = Self { corners_m: kept, count, is_left: true };
        if let Some((one, other)) = polygon.meeting() {
            return Err(BorderError::Meets(one + 1, other + 1));
        }
        let area_m2: f64 = polygon.sides().map(|side| cross(side.from_m, side.to_m) / 2.0).sum();
        polygon.is_left = area_m2 > 0.0;
        if area_m2.abs() < LEAST_AREA_M2 {
            return Err(BorderError::Small { area_m2: area_m2.abs() });
        }
        if polygon.outside_m(Vector2::zeros()) >= 0.0 {
            return Err(BorderError::StartOutside);
        }
        Ok(polygon)
    }

    /// Two sides that meet elsewhere than in their common corner, by the numbers of their first corners.
    fn meeting(&self) -> Option<(usize, usize)> {
        let pairs = self.sides().enumerate().flat_map(|(i, one)| {
            self.sides().enumerate().skip(i + 1).map(move |(j, other)| ((i, one), (j, other)))
        });
        let meets = |((i, one), (j, other)): &((usize, Side), (usize, Side))| {
            if one.length_m < MEETS_M || other.length_m < MEETS_M {
                return true;
            }
            let touch = |side: &Side, end_m| side.distance_m(end_m) < MEETS_M;
            let [begins, ends] = [
                touch(one, other.to_m) || touch(other, one.from_m),
                touch(one, other.from_m) || touch(other, one.to_m),
            ];
            // Those with a common corner meet elsewhere if the far end of one lies on the other.
            if j - i == 1 {
                return begins;
            }
            if *i == 0 && j + 1 == self.count {
                return ends;
            }
            let crosses = |a: &Side, b: &Side| {
                let side_of = |place_m| cross(a.along, place_m - a.from_m) >= 0.0;
                side_of(b.from_m) != side_of(b.to_m)
            };
            begins || ends || crosses(one, other) && crosses(other, one)
        };
        pairs.into_iter().find(meets).map(|((i, _), (j, _))| (i, j))
    }

    pub(super) fn corners_m(&self) -> &[[f64; 2]] {
        self.corners_m.get(..self.count).unwrap_or_default()
    }

    pub(super) fn furthest_m(&self) -> f64 {
        self.corners_m().iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max)
    }

    fn sides(&self) -> impl Iterator<Item = Side> + Clone + '_ {
        let corners_m = self.corners_m();
        corners_m.iter().zip(corners_m.iter().cycle().skip(1)).map(|(from, to)| {
            let (from_m, to_m) = (Vector2::from(*from), Vector2::from(*to));
            let length_m = (to_m - from_m).norm();
            let along = (to_m - from_m) / length_m.max(f64::EPSILON);
            let right = Vector2::new(along.y, -along.x);
            Side { from_m, to_m, along, length_m, out: if self.is_left { right } else { -right } }
        })
    }

    fn is_inside(&self, place_m: Vector2<f64>) -> bool {
        self.outside_m(place_m) < 0.0
    }

    /// This is asked most, so that it does without roots and unit vectors.
    pub(super) fn outside_m(&self, place_m: Vector2<f64>) -> f64 {
        let (mut nearest_m2, mut is_inside) = (f64::INFINITY, false);
        let corners_m = self.corners_m();
        for (from_m, to_m) in corners_m.iter().zip(corners_m.iter().cycle().skip(1)) {
            let (from_m, to_m) = (Vector2::from(*from_m) - place_m, Vector2::from(*to_m) - place_m);
            let side_m = to_m - from_m;
            let passed = -from_m.dot(&side_m) / side_m.norm_squared().max(f64::MIN_POSITIVE);
            let off_m = from_m + side_m * passed.clamp(0.0, 1.0);
            nearest_m2 = nearest_m2.min(off_m.norm_squared());
            // Whether a ray to the right crosses it.
            if (from_m.y > 0.0) != (to_m.y > 0.0) {
                is_inside ^= (cross(from_m, to_m) > 0.0) == (to_m.y > from_m.y);
            }
        }
        if is_inside { -nearest_m2.sqrt() } else { nearest_m2.sqrt() }
    }

    /// The nearest part of the border.
    pub(super) fn nearest_wall(&self, place_m: Vector2<f64>) -> Wall {
        let is_inside = self.is_inside(place_m);
        let walls = self.sides().map(|side| wall(&side, place_m, is_inside));
        let nearer = |a: Wall, b: Wall| if b.distance_m.abs() < a.distance_m.abs() { b } else { a };
        let none = Wall { distance_m: f64::INFINITY, outward: Vector2::zeros() };
        walls.fold(none, nearer)
    }

    /// All walls; from outside the one that is to be passed back, and the others as they are seen from where it is: who is just
    /// outside one side of a corner can fly over the other.
    pub(super) fn walls(&self, place_m: Vector2<f64>) -> impl Iterator<Item = Wall> + Clone + '_ {
        let passed = (!self.is_inside(place_m)).then(|| self.nearest_wall(place_m));
        let from_m = passed.map_or(place_m, |wall| place_m + wall.outward * wall.distance_m);
        self.sides().map(move |side| wall(&side, from_m, true)).chain(passed)
    }

    pub(super) fn room_m(
        &self,
        place_m: Vector2<f64>,
        heading: Vector2<f64>,
        beyond_m: f64,
    ) -> f64 {
        let outside_m = self.outside_m(place_m);
        if heading == Vector2::zeros() {
            return beyond_m - outside_m;
        }
        let near: ArrayVec<[f64; 2], MAX_CORNERS> =
            self.sides().filter_map(|side| side.near_m(place_m, heading, beyond_m)).collect();
        let crossed: ArrayVec<f64, MAX_CORNERS> =
            self.sides().filter_map(|side| side.crossed_at_m(place_m, heading)).collect();
        let ahead = |after_m: f64| crossed.iter().copied().filter(move |at_m| *at_m > after_m);
        let mut room_m = if outside_m <= beyond_m {
            0.0
        } else {
            let enters = near.iter().map(|[begins_m, _]| *begins_m).chain(crossed.iter().copied());
            let enters_m = enters.filter(|at_m| *at_m >= 0.0).fold(f64::INFINITY, f64::min);
            if enters_m.is_infinite() {
                return beyond_m - outside_m;
            }
            enters_m
        };
        // It goes on inside to the next side, and near a side to the end of that; each part is entered at most once.
        for _ in 0..2 * MAX_CORNERS {
            let here_m = room_m + ROUNDING_M;
            // It is inside if what lies ahead is an odd number of sides.
            let is_inside = ahead(here_m).count() % 2 == 1;
            let inside_to_m =
                if is_inside { ahead(here_m).fold(f64::INFINITY, f64::min) } else { room_m };
            let begun = near.iter().filter(|[begins_m, _]| *begins_m <= here_m);
            let next_m = begun.map(|[_, ends_m]| *ends_m).fold(inside_to_m, f64::max);
            if next_m <= here_m {
                break;
            }
            room_m = next_m;
        }
        room_m
    }

    pub(super) fn leaves_at(
        &self,
        from_m: Vector2<f64>,
        to_m: Vector2<f64>,
        margin_m: f64,
    ) -> Option<Vector2<f64>> {
        let way_m = to_m - from_m;
        let length_m = way_m.norm();
        if self.outside_m(from_m) + length_m <= margin_m {
            return None;
        }
        let heading = way_m / length_m.max(f64::EPSILON);
        let room_m = self.room_m(from_m, heading, margin_m);
        (room_m < length_m - ROUNDING_M).then(|| from_m + heading * room_m.max(0.0))
    }

    pub(super) fn nearest_inside(&self, place_m: Vector2<f64>, by_m: f64) -> Vector2<f64> {
        let outside_m = self.outside_m(place_m);
        // Where it is too narrow for the whole distance, half of it is kept, and so on.
        let shares = (0..8).map(|halved| 0.5_f64.powi(halved)).chain([0.0]);
        for by_m in shares.map(|share| share * by_m) {
            if outside_m <= -by_m + ROUNDING_M {
                return place_m;
            }
            let most_m = outside_m.max(0.0) + ASIDE * by_m + ROUNDING_M;
            if let Some(nearest_m) = self.nearest_on_edges(place_m, by_m, most_m) {
                return nearest_m;
            }
        }
        self.nearest_on_edges(place_m, 0.0, f64::INFINITY).unwrap_or_default()
    }

    /// The parts of which the border of what is inside by `by_m` consists.
    fn edges(&self, by_m: f64) -> impl Iterator<Item = Edge> + Clone + '_ {
        let sides = self.sides();
        let lines = sides
            .clone()
            .map(move |side| Edge::Line { at_m: side.from_m - side.out * by_m, along: side.along });
        let next = sides.clone().cycle().skip(1);
        let arcs = sides.zip(next).filter_map(|(side, next)| {
            let points_in = side.out.dot(&next.along) > 0.0;
            points_in.then_some(Edge::Arc { centre_m: next.from_m })
        });
        lines.chain(arcs)
    }

    /// The nearest of the places where the border of what is inside by `by_m` can be nearest: on one of its parts, or where two
    /// of them meet; at most `most_m` away.
    fn nearest_on_edges(
        &self,
        place_m: Vector2<f64>,
        by_m: f64,
        most_m: f64,
    ) -> Option<Vector2<f64>> {
        let away_m = |candidate_m: &Vector2<f64>| (candidate_m - place_m).norm();
        let is_inside =
            |candidate_m: &Vector2<f64>| self.outside_m(*candidate_m) <= -by_m + 2.0 * ROUNDING_M;
        let mut edges: ArrayVec<(f64, Vector2<f64>, Edge), { 2 * MAX_CORNERS }> = self
            .edges(by_m)
            .map(|edge| {
                let nearest_m = nearest_on(&edge, place_m, by_m);
                (away_m(&nearest_m), nearest_m, edge)
            })
            .filter(|(nearest_away_m, ..)| *nearest_away_m <= most_m)
            .collect();
        edges.sort_unstable_by(|(one_m, ..), (other_m, ..)| one_m.total_cmp(other_m));
        let best = edges.iter().position(|(_, nearest_m, _)| is_inside(nearest_m));
        // Only parts that come nearer can meet nearer.
        let asked = edges.get(..best.unwrap_or(edges.len())).unwrap_or_default();
        let on_one = best.and_then(|best| edges.get(best));
        let mut found_m = on_one.map(|(_, nearest_m, _)| *nearest_m);
        let mut best_m = on_one.map_or(most_m, |(best_m, ..)| *best_m);
        for (i, (_, _, one)) in asked.iter().enumerate() {
            for (_, _, other) in asked.iter().skip(i + 1) {
                for met_m in meet(one, other, by_m).into_iter().flatten() {
                    if away_m(&met_m) < best_m && is_inside(&met_m) {
                        (best_m, found_m) = (away_m(&met_m), Some(met_m));
                    }
                }
            }
        }
        found_m
    }
}

fn wall(side: &Side, place_m: Vector2<f64>, is_inside: bool) -> Wall {
    let off_m = side.nearest_m(place_m) - place_m;
    let distance_m = off_m.norm();
    let sign = if is_inside { 1.0 } else { -1.0 };
    let outward = if distance_m > ROUNDING_M { off_m * (sign / distance_m) } else { side.out };
    Wall { distance_m: sign * distance_m, outward }
}

fn nearest_on(edge: &Edge, place_m: Vector2<f64>, by_m: f64) -> Vector2<f64> {
    match edge {
        Edge::Line { at_m, along } => at_m + along * (place_m - at_m).dot(along),
        Edge::Arc { centre_m } => {
            centre_m + (place_m - centre_m).try_normalize(0.0).unwrap_or_default() * by_m
        }
    }
}

/// Where two lines or circles of this radius meet.
fn meet(one: &Edge, other: &Edge, radius_m: f64) -> [Option<Vector2<f64>>; 2] {
    match (one, other) {
        (Edge::Line { at_m: a, along: u }, Edge::Line { at_m: b, along: v }) => {
            let turn = cross(*u, *v);
            [(turn.abs() > ROUNDING_M).then(|| a + u * (cross(b - a, *v) / turn)), None]
        }
        (Edge::Line { at_m, along }, Edge::Arc { centre_m })
        | (Edge::Arc { centre_m }, Edge::Line { at_m, along }) => {
            let foot_m = at_m + along * (centre_m - at_m).dot(along);
            on_both_sides(foot_m, *along, radius_m, (foot_m - centre_m).norm())
        }
        (Edge::Arc { centre_m: a }, Edge::Arc { centre_m: b }) => {
            let apart_m = b - a;
            let across = Vector2::new(-apart_m.y, apart_m.x).try_normalize(0.0).unwrap_or_default();
            on_both_sides((a + b) / 2.0, across, radius_m, apart_m.norm() / 2.0)
        }
    }
}

/// The ends of a circle's chord with this middle, which is `off_m` from its centre.
fn on_both_sides(
    middle_m: Vector2<f64>,
    along: Vector2<f64>,
    radius_m: f64,
    off_m: f64,
) -> [Option<Vector2<f64>>; 2] {
    let half_m2 = radius_m * radius_m - off_m * off_m;
    let half_m = (half_m2 >= 0.0).then(|| half_m2.sqrt());
    [1.0, -1.0].map(|side| half_m.map(|half_m| middle_m + along * (side * half_m)))
}

fn cross(a: Vector2<f64>, b: Vector2<f64>) -> f64 {
    a.x * b.y - a.y * b.x
}
