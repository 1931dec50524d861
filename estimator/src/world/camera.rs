//! From a position in the picture to a position on the floor below the drone.

use nalgebra::Vector2;

use super::history::Moment;
use super::{Sight, TagConfig};

/// Pattern size that the firmware assumes for its distance.
const FIRMWARE_SIZE_M: f64 = 0.222;
/// Relative error of distance or size beyond which a sighting is not one of our tags.
const WRONG_SIZE: f64 = 0.4;
/// Largest angle from the vertical; the picture ends long before.
const STEEPEST_RAD: f64 = 1.0;

/// Position of a tag relative to the drone.
#[derive(Debug, Clone, Copy)]
pub(super) struct Look {
    /// Right and forward of the point below the drone, levelled.
    pub(super) offset_m: Vector2<f64>,
    pub(super) height_m: f64,
    pub(super) orientation_deg: f64,
}

impl Look {
    /// `None` if the sighting cannot be one of our tags on the floor, or is not complete.
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
        let reported_m = sight.distance_m * config.size_m / FIRMWARE_SIZE_M;
        let expected_width = focal_x * config.size_m / far_m;
        let is_wrong = |share: f64| !(1.0 - WRONG_SIZE..=1.0 + WRONG_SIZE).contains(&share);
        if is_wrong(reported_m / far_m) || is_wrong(sight.width / expected_width) {
            return None;
        }
        Some(Self { offset_m, height_m, orientation_deg: sight.orientation_deg })
    }
}

/// Error of the camera and its mounting that tags do not reveal, as a fraction of the height.
const CAMERA_ERROR: f64 = 0.1;

/// Whether a tag is whole in the picture, wherever within `margin_m` of this offset (right, forward, levelled) it lies.
pub(super) fn is_surely_whole(
    offset_m: Vector2<f64>,
    margin_m: f64,
    moment: &Moment,
    config: &TagConfig,
) -> bool {
    let height_m = moment.height_m;
    let half_m = config.size_m / 2.0 + margin_m + CAMERA_ERROR * height_m;
    let tilt_rad = moment.tilt_deg.map(f64::to_radians);
    let [focal_x, focal_y] = config.focal_units;
    let [centre_x, centre_y] = config.centre_units;
    [-half_m, half_m].iter().all(|aside_m| {
        let right_rad = ((offset_m.x + aside_m) / height_m).atan() + tilt_rad.x;
        let forward_rad = ((offset_m.y + aside_m) / height_m).atan() - tilt_rad.y;
        let x = centre_x + focal_x * right_rad.tan();
        let y = centre_y - focal_y * forward_rad.tan();
        !touches_rim(x, 0.0) && !touches_rim(y, 0.0)
    })
}

fn touches_rim(centre: f64, size: f64) -> bool {
    centre - size / 2.0 < 1.0 || centre + size / 2.0 > 999.0
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOMENT: Moment = Moment {
        place_m: Vector2::new(0.0, 0.0),
        speed_m_s: 0.0,
        yaw_deg: 0.0,
        tilt_deg: Vector2::new(0.0, 0.0),
        height_m: 1.5,
    };

    /// What the camera of a drone with this tilt sees of a tag at this offset.
    fn seen(offset_m: Vector2<f64>, tilt_deg: Vector2<f64>) -> (Sight, Moment) {
        let config = TagConfig::default();
        let tilt_rad = tilt_deg.map(f64::to_radians);
        let right_rad = (offset_m.x / MOMENT.height_m).atan() + tilt_rad.x;
        let forward_rad = (offset_m.y / MOMENT.height_m).atan() - tilt_rad.y;
        let far_m = offset_m.norm().hypot(MOMENT.height_m);
        let width = config.focal_units[0] * config.size_m / far_m;
        let sight = Sight {
            x: config.centre_units[0] + config.focal_units[0] * right_rad.tan(),
            y: config.centre_units[1] - config.focal_units[1] * forward_rad.tan(),
            width,
            height: width,
            distance_m: far_m * FIRMWARE_SIZE_M / config.size_m,
            orientation_deg: 33.0,
        };
        (sight, Moment { tilt_deg, ..MOMENT })
    }

    fn look(sight: &Sight) -> Option<Look> {
        Look::new(sight, &MOMENT, &TagConfig::default())
    }

    #[test]
    fn a_tag_is_found_where_it_lies_however_the_drone_tilts() {
        for offset_m in [Vector2::zeros(), Vector2::new(0.3, -0.2), Vector2::new(-0.2, 0.3)] {
            for tilt_deg in [Vector2::zeros(), Vector2::new(5.0, 0.0), Vector2::new(-3.0, 4.0)] {
                let (sight, moment) = seen(offset_m, tilt_deg);
                let look = Look::new(&sight, &moment, &TagConfig::default()).unwrap();
                assert!((look.offset_m - offset_m).norm() < 1e-9, "{offset_m}, {tilt_deg}");
                assert!((look.height_m - 1.5).abs() < 1e-9);
                assert!((look.orientation_deg - 33.0).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_tag_has_the_size_and_distance_of_ours_within_two_fifths() {
        let (sight, _) = seen(Vector2::new(0.3, -0.2), Vector2::zeros());
        for (share, fits) in [(0.61, true), (0.59, false), (1.39, true), (1.41, false)] {
            let near = Sight { distance_m: sight.distance_m * share, ..sight };
            assert_eq!(look(&near).is_some(), fits, "{share}");
            let wide = Sight { width: sight.width * share, ..sight };
            assert_eq!(look(&wide).is_some(), fits, "{share}");
        }
    }

    #[test]
    fn a_tag_is_surely_seen_only_where_all_errors_leave_it_in_the_picture() {
        let whole = |offset_m: Vector2<f64>, margin_m| {
            is_surely_whole(offset_m, margin_m, &MOMENT, &TagConfig::default())
        };
        // 1.5 m high the picture's sides are 0.70 m away, its top 0.46 m and its bottom 0.57 m; half a tag and the camera's
        // error are 0.245 m.
        assert!(whole(Vector2::new(0.45, 0.0), 0.0) && !whole(Vector2::new(0.46, 0.0), 0.0));
        assert!(whole(Vector2::new(0.0, 0.21), 0.0) && !whole(Vector2::new(0.0, 0.23), 0.0));
        assert!(whole(Vector2::new(0.0, -0.31), 0.0) && !whole(Vector2::new(0.0, -0.33), 0.0));
        assert!(whole(Vector2::zeros(), 0.21) && !whole(Vector2::zeros(), 0.23));
        // A nose that is down by 5 degrees looks back by 0.13 m.
        let down = Moment { tilt_deg: Vector2::new(0.0, -5.0), ..MOMENT };
        let looks = |forward_m| {
            is_surely_whole(Vector2::new(0.0, forward_m), 0.0, &down, &TagConfig::default())
        };
        assert!(!looks(0.12) && looks(-0.32));
    }

    #[test]
    fn a_tag_at_the_rim_is_not_complete() {
        assert!(!touches_rim(500.0, 100.0));
        for (centre, touches) in [(51.0, false), (50.9, true), (949.0, false), (949.1, true)] {
            assert_eq!(touches_rim(centre, 100.0), touches, "{centre}");
        }
        let (sight, _) = seen(Vector2::zeros(), Vector2::zeros());
        assert!(look(&sight).is_some());
        assert!(look(&Sight { x: 20.0, ..sight }).is_none(), "left");
        assert!(look(&Sight { y: 990.0, ..sight }).is_none(), "below");
    }

    #[test]
    fn what_a_tilt_would_put_at_the_horizon_is_no_tag() {
        // A tag in the centre of a picture taken at this tilt, with its size and distance.
        let tilted = |axis: usize, rad: f64| {
            let (mut sight, mut moment) = seen(Vector2::zeros(), Vector2::zeros());
            moment.tilt_deg[axis] = rad.to_degrees();
            let far_m = MOMENT.height_m / rad.cos();
            sight.width *= MOMENT.height_m / far_m;
            sight.distance_m *= far_m / MOMENT.height_m;
            Look::new(&sight, &moment, &TagConfig::default()).is_some()
        };
        for axis in 0..2 {
            for sign in [-1.0, 1.0] {
                assert!(tilted(axis, sign * 0.99) && !tilted(axis, sign * 1.01));
            }
        }
    }
}
