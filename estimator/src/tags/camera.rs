//! From a position in the picture to a position on the floor below the drone.

use nalgebra::Vector2;

use super::history::Moment;
use super::{Sight, TagConfig};

/// Pattern size that the firmware assumes for its distance.
const FIRMWARE_SIZE_M: f64 = 0.222;
/// Relative error of distance or size beyond which a sighting is not one of our roundels.
const WRONG_SIZE: f64 = 0.4;
/// Largest angle from the vertical; the picture ends long before.
const STEEPEST_RAD: f64 = 1.0;

/// Position of a roundel relative to the drone.
#[derive(Debug, Clone, Copy)]
pub(super) struct Look {
    /// Right and forward of the point below the drone, levelled.
    pub(super) offset_m: Vector2<f64>,
    pub(super) height_m: f64,
    pub(super) orientation_deg: f64,
}

impl Look {
    /// `None` if the sighting cannot be one of our roundels on the floor, or is not complete.
    pub(super) fn new(sight: &Sight, moment: &Moment, config: &TagConfig) -> Option<Self> {
        let [focal_x, focal_y] = config.focal_units;
        let [centre_x, centre_y] = config.centre_units;
        let numbers = [sight.x, sight.y, sight.width, sight.height, sight.distance_m];
        let tilt_rad = moment.tilt_deg.map(f64::to_radians);
        if !numbers.iter().chain(&[sight.orientation_deg]).all(|number| number.is_finite()) {
            return None;
        }
        if touches_rim(sight.x, sight.width) || touches_rim(sight.y, sight.height) {
            return None;
        }
        // With the right side down the camera looks left, and points below appear further right.
        let right_rad = ((sight.x - centre_x) / focal_x).atan() - tilt_rad.x;
        let forward_rad = ((centre_y - sight.y) / focal_y).atan() + tilt_rad.y;
        if right_rad.abs().max(forward_rad.abs()) > STEEPEST_RAD {
            return None;
        }
        let height_m = moment.height_m;
        let offset_m = Vector2::new(right_rad.tan(), forward_rad.tan()) * height_m;
        let far_m = offset_m.norm().hypot(height_m);
        let told_m = sight.distance_m * config.size_m / FIRMWARE_SIZE_M;
        let expected_width = focal_x * config.size_m / far_m;
        let is_wrong = |share: f64| !(1.0 - WRONG_SIZE..=1.0 + WRONG_SIZE).contains(&share);
        if is_wrong(told_m / far_m) || is_wrong(sight.width / expected_width) {
            return None;
        }
        Some(Self { offset_m, height_m, orientation_deg: sight.orientation_deg })
    }
}

fn touches_rim(centre: f64, size: f64) -> bool {
    centre - size / 2.0 < 1.0 || centre + size / 2.0 > 999.0
}
