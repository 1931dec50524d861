//! The border: a circle around the start, or a polygon.

use std::f64::consts::TAU;
use std::fmt;

use diagnostic::Figures;
use nalgebra::Vector2;

use super::polygon::{BorderError, Polygon, Wall};

/// Corners of a circle that is drawn.
const DRAWN_CORNERS: u32 = 360;

/// The border of the fence, seen from above, in metres right and forward of the start: of the origin of the world, where the
/// start is surveyed.
#[derive(Clone, Copy, PartialEq)]
pub struct Border(Kind);

#[derive(Clone, Copy, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "it is copied, and never in great number")]
enum Kind {
    Circle { radius_m: f64 },
    Polygon(Polygon),
}

/// The shape of a border, for whoever writes it down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape<'a> {
    /// A circle around the start.
    Circle {
        /// Its radius, in metres.
        radius_m: f64,
    },
    /// The corners of a polygon: right and forward of the start, in metres.
    Polygon(&'a [[f64; 2]]),
}

impl Border {
    /// A circle around the start.
    pub const fn circle(radius_m: f64) -> Self {
        Self(Kind::Circle { radius_m })
    }

    /// A polygon with the start inside; its corners right and forward of the start, in metres, in their order.
    ///
    /// # Errors
    /// [`BorderError`] if this is no border.
    pub fn polygon(corners_m: &[[f64; 2]]) -> Result<Self, BorderError> {
        Ok(Self(Kind::Polygon(Polygon::new(corners_m)?)))
    }

    /// Its shape.
    pub fn shape(&self) -> Shape<'_> {
        match &self.0 {
            Kind::Circle { radius_m } => Shape::Circle { radius_m: *radius_m },
            Kind::Polygon(polygon) => Shape::Polygon(polygon.corners_m()),
        }
    }

    /// Its corners, as it is drawn, each once: those of a circle are 360 points of it.
    pub fn outline_m(&self) -> impl Iterator<Item = [f64; 2]> + Clone + '_ {
        let (radius_m, corners_m) = match self.shape() {
            Shape::Circle { radius_m } => (Some(radius_m), &[][..]),
            Shape::Polygon(corners_m) => (None, corners_m),
        };
        let round = radius_m.into_iter().flat_map(|radius_m| {
            (0..DRAWN_CORNERS).map(move |part| {
                let angle = TAU * f64::from(part) / f64::from(DRAWN_CORNERS);
                [radius_m * angle.sin(), radius_m * angle.cos()]
            })
        });
        round.chain(corners_m.iter().copied())
    }

    /// Its sides, as they are drawn.
    pub fn sides_m(&self) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
        self.outline_m().zip(self.outline_m().cycle().skip(1)).map(|(from, to)| [from, to])
    }

    /// How far from the start it is at most, in metres.
    pub fn furthest_m(&self) -> f64 {
        match &self.0 {
            Kind::Circle { radius_m } => *radius_m,
            Kind::Polygon(polygon) => polygon.furthest_m(),
        }
    }

    /// Distance outside in metres, negative inside.
    pub fn outside_m(&self, place_m: Vector2<f64>) -> f64 {
        match &self.0 {
            Kind::Circle { radius_m } => place_m.x.hypot(place_m.y) - radius_m,
            Kind::Polygon(polygon) => polygon.outside_m(place_m),
        }
    }

    /// How a place outside lies to it, for people.
    pub fn how_far(&self, place_m: Vector2<f64>) -> String {
        match &self.0 {
            Kind::Circle { radius_m } => {
                let (away_m, radius_m) = (Figures(place_m.x.hypot(place_m.y)), Figures(*radius_m));
                format!("{away_m:.2} m from the start, beyond the fence of {radius_m} m")
            }
            Kind::Polygon(polygon) => {
                format!("{:.2} m outside the fence", Figures(polygon.outside_m(place_m)))
            }
        }
    }

    /// The nearest place that is inside by `by_m`, or by as much as there is.
    pub fn nearest_inside(&self, place_m: Vector2<f64>, by_m: f64) -> Vector2<f64> {
        match &self.0 {
            Kind::Circle { radius_m } => {
                let away_m = place_m.x.hypot(place_m.y);
                let allowed_m = (radius_m - by_m).max(0.0);
                let share = if away_m > allowed_m { allowed_m / away_m } else { 1.0 };
                place_m * share
            }
            Kind::Polygon(polygon) => polygon.nearest_inside(place_m, by_m),
        }
    }

    /// The unit vector that leads out by the shortest way, or further out; zero where there is none.
    pub(crate) fn outward(&self, place_m: Vector2<f64>) -> Vector2<f64> {
        match &self.0 {
            Kind::Circle { .. } => place_m / place_m.x.hypot(place_m.y).max(f64::EPSILON),
            Kind::Polygon(polygon) => polygon.nearest_wall(place_m).outward,
        }
    }

    /// The unit vector that leads away from where a motion would pass the border: how a drone leans that cannot brake. In a
    /// circle it is the way to its centre.
    pub(crate) fn back_from(&self, place_m: Vector2<f64>, heading: Vector2<f64>) -> Vector2<f64> {
        match &self.0 {
            Kind::Circle { .. } => -self.outward(place_m),
            Kind::Polygon(polygon) => {
                let room_m = polygon.room_m(place_m, heading, 0.0).max(0.0);
                -self.outward(place_m + heading * room_m)
            }
        }
    }

    /// Way in the direction of a unit vector until the drone is outside by `beyond_m`, and stays there for a while. Outside it
    /// is the way to where it would leave again, negative if it does not come in.
    pub(crate) fn room_m(
        &self,
        place_m: Vector2<f64>,
        heading: Vector2<f64>,
        beyond_m: f64,
    ) -> f64 {
        match &self.0 {
            Kind::Circle { radius_m } => {
                let radius_m = radius_m + beyond_m;
                let passed_m = place_m.x * heading.x + place_m.y * heading.y;
                let aside_m = heading.x * place_m.y - heading.y * place_m.x;
                (radius_m * radius_m - aside_m * aside_m).max(0.0).sqrt() - passed_m
            }
            Kind::Polygon(polygon) => polygon.room_m(place_m, heading, beyond_m),
        }
    }

    /// Where the straight way between two places leaves a polygon, widened by a margin; of a circle it is `to_m`, if that is
    /// outside. `None` if the way stays inside, or comes in and stays.
    pub fn leaves_at(
        &self,
        from_m: Vector2<f64>,
        to_m: Vector2<f64>,
        margin_m: f64,
    ) -> Option<Vector2<f64>> {
        match &self.0 {
            Kind::Circle { .. } => (self.outside_m(to_m) > margin_m).then_some(to_m),
            Kind::Polygon(polygon) => polygon.leaves_at(from_m, to_m, margin_m),
        }
    }

    /// Whether a drone that stops at `stop_m` is inside by `by_m`, or comes nearer to that, without leaving on its way.
    pub(crate) fn is_stop_inside(
        &self,
        from_m: Vector2<f64>,
        stop_m: Vector2<f64>,
        by_m: f64,
    ) -> bool {
        let stop_outside_m = self.outside_m(stop_m);
        let is_nearer = stop_outside_m <= -by_m || stop_outside_m < self.outside_m(from_m);
        is_nearer
            && match &self.0 {
                Kind::Circle { .. } => true,
                // Outside, and coming in, it has not left.
                Kind::Polygon(polygon) => {
                    let margin_m = self.outside_m(from_m).max(0.0);
                    polygon.leaves_at(from_m, stop_m, margin_m).is_none()
                }
            }
    }

    /// Where a drone is told to stop that would come to rest at `stop_m`, too near to the border: inside by `by_m`, before it
    /// leaves.
    pub(crate) fn stop_inside(
        &self,
        from_m: Vector2<f64>,
        stop_m: Vector2<f64>,
        by_m: f64,
    ) -> Vector2<f64> {
        let stop_m = self.leaves_at(from_m, stop_m, 0.0).unwrap_or(stop_m);
        self.nearest_inside(stop_m, by_m)
    }

    /// The walls that a drone can meet from a place: those of a polygon, each by itself, because a drone that avoids only the
    /// nearest flies into the corner with the next.
    pub(crate) fn walls(&self, place_m: Vector2<f64>) -> impl Iterator<Item = Wall> + Clone + '_ {
        let (round, polygon) = match &self.0 {
            Kind::Circle { .. } => (Some(self.wall_at(place_m)), None),
            Kind::Polygon(polygon) => (None, Some(polygon)),
        };
        round.into_iter().chain(polygon.into_iter().flat_map(move |walls| walls.walls(place_m)))
    }

    /// The walls that a drone passes which stops at `stop_m`, each with how far outside that would be.
    pub(crate) fn passed(
        &self,
        from_m: Vector2<f64>,
        stop_m: Vector2<f64>,
        margin_m: f64,
    ) -> impl Iterator<Item = Wall> + Clone + '_ {
        let (round, polygon) = match &self.0 {
            Kind::Circle { .. } => (Some(self.wall_at(stop_m)), None),
            Kind::Polygon(polygon) => {
                (None, polygon.leaves_at(from_m, stop_m, margin_m).map(|_| polygon))
            }
        };
        let way_m = stop_m - from_m;
        let walls = polygon.into_iter().flat_map(move |polygon| polygon.walls(from_m));
        let left = move |wall: Wall| Wall {
            distance_m: wall.distance_m - way_m.dot(&wall.outward),
            ..wall
        };
        round.into_iter().chain(walls.map(left))
    }

    fn wall_at(&self, place_m: Vector2<f64>) -> Wall {
        Wall { distance_m: -self.outside_m(place_m), outward: self.outward(place_m) }
    }
}

impl fmt::Debug for Border {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.shape().fmt(f)
    }
}

/// For people, as in "the fence, 4 m around the start".
impl fmt::Display for Border {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.shape() {
            Shape::Circle { radius_m } => write!(f, "{} m around the start", Figures(radius_m)),
            Shape::Polygon(corners_m) => write!(f, "a polygon of {} corners", corners_m.len()),
        }
    }
}
