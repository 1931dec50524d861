//! Where the drone may fly: the only place that knows the shape of the fence. Whoever checks a plan, flies, stops, shows or
//! tells of the fence asks here.

mod border;
mod polygon;

use kinematics::Pose;
use nalgebra::Vector2;

pub use self::border::{Border, Shape};
pub(crate) use self::polygon::Wall;
pub use self::polygon::{BorderError, MAX_CORNERS};

/// Origin of a plan's heights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ZOrigin {
    /// Height of the hover after take-off, as in `tum_ardrone`'s plans.
    #[default]
    Hover,
    /// The floor.
    Floor,
}

impl ZOrigin {
    /// Its name on the command line and in logs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Hover => "hover",
            Self::Floor => "floor",
        }
    }

    /// The origin with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Hover, Self::Floor].into_iter().find(|origin| origin.name() == name)
    }
}

/// What limits a flight. The fence: lowest and highest height, and the border within which the drone may fly; and how fast.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightLimits {
    /// Lowest target height above the floor, in metres.
    pub floor_m: f64,
    /// Highest target height above the floor, in metres.
    pub ceiling_m: f64,
    /// Horizontally, around the origin of the world, which is the start unless that is surveyed.
    pub border: Border,
    /// Origin of the plan's heights.
    pub z_origin: ZOrigin,
    /// Where the drone stands at its first start, on the floor, if that is surveyed: plans are then of places in the world.
    /// Otherwise the world begins there.
    pub start: Option<Pose>,
    /// Largest horizontal speed of the control law, in m/s: how long the way to a target takes.
    pub speed_max_m_s: f64,
}

impl Default for FlightLimits {
    fn default() -> Self {
        Self::new(Border::circle(10.0), 0.3, 3.0)
    }
}

impl FlightLimits {
    /// Expected hover height after take-off, in metres. The true height is known only after take-off, and
    /// targets are checked against the fence again then.
    pub(crate) const EXPECTED_HOVER_M: f64 = 0.85;

    /// Tolerance of all questions about the fence, in metres: places are sums of numbers with a few digits, and a target on
    /// the fence is inside. No sensor and no wire can tell less.
    pub const TOLERANCE_M: f64 = 1e-6;

    /// A fence with this border, from a lowest to a highest height above the floor in metres. Heights of plans count from
    /// the hover.
    pub const fn new(border: Border, floor_m: f64, ceiling_m: f64) -> Self {
        let (z_origin, start, speed_max_m_s) = (ZOrigin::Hover, None, f64::INFINITY);
        Self { floor_m, ceiling_m, border, z_origin, start, speed_max_m_s }
    }

    /// No limits at all.
    pub const NONE: Self =
        Self::new(Border::circle(f64::INFINITY), f64::NEG_INFINITY, f64::INFINITY);

    /// Height above the floor of z = 0 in the take-off reference, in metres.
    pub fn origin_height_m(&self, hover_m: f64) -> f64 {
        match self.z_origin {
            ZOrigin::Hover => hover_m,
            ZOrigin::Floor => 0.0,
        }
    }

    /// Clamps a place to the fence, shrunk horizontally by `by_m`, or by as much as there is.
    pub fn nearest_inside(&self, place: &Pose, by_m: f64) -> Pose {
        let [x_m, y_m] = self.border.nearest_inside(across(place), by_m).into();
        Pose { x_m, y_m, z_m: place.z_m.clamp(self.floor_m, self.ceiling_m), ..*place }
    }

    /// Whether a place is inside the fence, widened by a margin.
    pub fn is_inside(&self, place: &Pose, margin_m: f64) -> bool {
        place.z_m >= self.floor_m - margin_m && self.is_inside_above(place, margin_m)
    }

    /// The same without the fence's floor.
    pub(crate) fn is_inside_above(&self, place: &Pose, margin_m: f64) -> bool {
        self.outside_m(place) <= margin_m && place.z_m <= self.ceiling_m + margin_m
    }

    /// Horizontal distance outside the fence in metres, negative inside.
    pub fn outside_m(&self, place: &Pose) -> f64 {
        self.border.outside_m(across(place))
    }

    /// Where to stop before a straight flight between two places leaves the border, widened by a margin: the nearest place
    /// inside, `by_m` from the border or as far as there is room, to where it leaves a polygon, or to `to` outside a circle.
    /// `None` if it stays inside, or comes in and stays.
    pub fn stop_before(&self, from: &Pose, to: &Pose, margin_m: f64, by_m: f64) -> Option<Pose> {
        let leaves_m = self.border.leaves_at(across(from), across(to), margin_m)?;
        let [x_m, y_m] = self.border.nearest_inside(leaves_m, by_m).into();
        Some(Pose { x_m, y_m, z_m: to.z_m.clamp(self.floor_m, self.ceiling_m), ..*to })
    }
}

/// The horizontal part of a place.
pub(crate) fn across(place: &Pose) -> Vector2<f64> {
    Vector2::new(place.x_m, place.y_m)
}

#[cfg(test)]
mod tests;
