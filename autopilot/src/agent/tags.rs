//! What the agent is given of tags, and where it looks for them.

use kinematics::Pose;

use crate::fence::FlightLimits;

/// Places to look from are at least this far inside the fence, in metres, so that overshoot does not lead over it.
const INSIDE_M: f64 = 0.5;
/// Likewise below its ceiling, in metres.
const BELOW_CEILING_M: f64 = 0.2;

/// What is known of tags on the floor, where they are in use.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TagPercepts {
    /// Time since a tag was seen whose place is known, or since the flight began, in milliseconds.
    pub age_ms: i64,
    /// Whether that was just now.
    pub seen: bool,
    /// The nearest of the tags whose place is known: (x, y) in the world, in metres.
    pub nearest_m: Option<[f64; 2]>,
    /// Displacement during the drone's own landing from low above the floor, because of the wind: (x, y) in
    /// the world, in metres.
    pub landing_drift_m: [f64; 2],
}

impl TagPercepts {
    /// Where the drone's own landing has to begin to end on the nearest tag.
    pub(super) fn landing_m(&self) -> Option<[f64; 2]> {
        let ([x_m, y_m], [right_m, forward_m]) = (self.nearest_m?, self.landing_drift_m);
        Some([x_m - right_m, y_m - forward_m])
    }
}

/// The nearest place from which a tag may be looked for.
pub(super) fn place_to_look_from(wanted: &Pose, fence: &FlightLimits) -> Pose {
    let highest_m = (fence.ceiling_m - BELOW_CEILING_M).max(fence.floor_m);
    let inside = fence.nearest_inside(wanted, INSIDE_M);
    Pose { z_m: inside.z_m.min(highest_m), ..inside }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fence::Border;

    #[test]
    fn places_to_look_from_are_well_inside_the_fence() {
        let fence = FlightLimits::new(Border::circle(2.0), 0.3, 2.0);
        let wanted = Pose { x_m: 3.0, y_m: -4.0, z_m: 2.5, yaw_deg: 7.0 };
        let place = place_to_look_from(&wanted, &fence);
        assert!((fence.outside_m(&place) + INSIDE_M).abs() < 1e-9);
        assert!((place.z_m - 1.8).abs() < 1e-9 && (place.yaw_deg - 7.0).abs() < 1e-9);
        let near = Pose { x_m: 0.5, z_m: 1.0, ..Pose::default() };
        assert_eq!(place_to_look_from(&near, &fence), near);
    }

    #[test]
    fn a_landing_begins_against_the_wind_from_the_tag() {
        let tag = TagPercepts {
            age_ms: 0,
            seen: true,
            nearest_m: Some([1.0, 2.0]),
            landing_drift_m: [0.1, -0.2],
        };
        let [x_m, y_m] = tag.landing_m().unwrap();
        assert!((x_m - 0.9).abs() < 1e-9 && (y_m - 2.2).abs() < 1e-9);
        assert_eq!(TagPercepts { nearest_m: None, ..tag }.landing_m(), None);
    }
}
