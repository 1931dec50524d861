//! Where the drone may fly.

use kinematics::Pose;

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

/// The fence: lowest and highest height and the radius within which the drone may fly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightLimits {
    /// Lowest target height above the floor, in metres.
    pub floor_m: f64,
    /// Highest target height above the floor, in metres.
    pub ceiling_m: f64,
    /// Largest horizontal distance of a target from the start, in metres.
    pub radius_m: f64,
    /// Origin of the plan's heights.
    pub z_origin: ZOrigin,
}

impl Default for FlightLimits {
    fn default() -> Self {
        Self { floor_m: 0.3, ceiling_m: 3.0, radius_m: 10.0, z_origin: ZOrigin::Hover }
    }
}

impl FlightLimits {
    /// Expected hover height after take-off, in metres. The true height is known only after take-off, and
    /// targets are checked against the fence again then.
    pub(crate) const EXPECTED_HOVER_M: f64 = 0.85;

    /// Tolerance of the fence check: heights are typed with a few digits, and a target on the limit is
    /// inside.
    pub(crate) const TOLERANCE_M: f64 = 1e-9;

    /// Height above the floor of z = 0 in the take-off reference, in metres.
    pub fn origin_height_m(&self, hover_m: f64) -> f64 {
        match self.z_origin {
            ZOrigin::Hover => hover_m,
            ZOrigin::Floor => 0.0,
        }
    }

    /// Clamps a place to the fence, shrunk horizontally by `by_m`.
    pub fn nearest_inside(&self, place: &Pose, by_m: f64) -> Pose {
        let away_m = place.x_m.hypot(place.y_m);
        let allowed_m = (self.radius_m - by_m).max(0.0);
        let share = if away_m > allowed_m { allowed_m / away_m } else { 1.0 };
        Pose {
            x_m: place.x_m * share,
            y_m: place.y_m * share,
            z_m: place.z_m.clamp(self.floor_m, self.ceiling_m),
            ..*place
        }
    }
}
