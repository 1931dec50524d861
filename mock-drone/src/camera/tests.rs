use super::*;
use crate::airframe::{Attitude, Profile, Thrust};

const DETECTOR: Detector = Detector { source: 1, kind: 8 };

/// A drone after a flight with a demand, at this height.
fn flown(demand: Attitude, height_m: f64) -> Airframe {
    let mut airframe = Airframe::new(Profile::rec(), Vector2::zeros()).at_height(height_m);
    for _ in 0..400 {
        airframe.step(Thrust::On(demand), Vector2::zeros());
    }
    airframe
}

/// Reports of tags at these positions relative to the point below the drone, in its own axes.
fn reported(model: CameraModel, airframe: &Airframe, tags: &[(f64, f64, f64)]) -> VisionDetect {
    let yaw_rad = airframe.yaw_rad();
    let tags: Vec<FloorTag> = tags
        .iter()
        .map(|(right, forward, turned_deg)| {
            let place = airframe.position_m().xy()
                + crate::airframe::world_from_body(*right, *forward, yaw_rad);
            FloorTag::new(place.x, place.y, yaw_rad.to_degrees() + turned_deg)
        })
        .collect();
    let mut camera = Camera::new(model, 1);
    camera.take(Duration::ZERO, airframe, &tags, Some(DETECTOR));
    camera.read(Duration::ZERO)
}

#[test]
fn a_level_drone_sees_a_tag_where_it_lies() {
    for turn_rad_s in [0.0, 0.8] {
        let airframe = flown(Attitude { turn_rad_s, ..Attitude::default() }, 2.0);
        let seen = reported(CameraModel::perfect(), &airframe, &[(0.4, 0.2, 0.0)]);
        assert_eq!((seen.count, seen.kinds[0], seen.cameras[0]), (1, 1 << 16 | 8, 1));
        assert!(seen.x[0].abs_diff(714) <= 1, "right: {}", seen.x[0]);
        assert!(seen.y[0].abs_diff(305) <= 1, "forward is up: {}", seen.y[0]);
        // 1072 · 0.19 / 2, with noise.
        assert!(seen.widths[0].abs_diff(102) <= 10, "{}", seen.widths[0]);
        assert!((seen.orientations_deg[0] - 270.0).abs() < 1.0, "{}", seen.orientations_deg[0]);
        // A pattern smaller than the firmware assumes seems further away.
        assert!((seen.distances_m[0] - 2.0 * 0.222 / 0.19).abs() < 0.3, "{}", seen.distances_m[0]);
    }
}

#[test]
fn a_drone_that_leans_right_sees_what_is_below_further_right() {
    let airframe = flown(Attitude { roll_rad: 0.1, ..Attitude::default() }, 2.0);
    let seen = reported(CameraModel::perfect(), &airframe, &[(0.0, 0.0, 0.0)]);
    let expected = 500.0 + 1072.0 * airframe.roll_rad().tan();
    assert!((f64::from(seen.x[0]) - expected).abs() < 3.0, "{} {expected}", seen.x[0]);
    let airframe = flown(Attitude { pitch_rad: 0.1, ..Attitude::default() }, 2.0);
    let seen = reported(CameraModel::perfect(), &airframe, &[(0.0, 0.0, 0.0)]);
    // Nose up: the camera looks ahead, so points below appear towards the back.
    let expected = 450.0 + 1452.0 * airframe.pitch_rad().tan();
    assert!((f64::from(seen.y[0]) - expected).abs() < 3.0, "{} {expected}", seen.y[0]);
}

#[test]
fn orientations_count_either_way_by_the_seed() {
    let airframe = flown(Attitude::default(), 1.5);
    let turned = |orientation| {
        let model = CameraModel { orientation, ..CameraModel::perfect() };
        reported(model, &airframe, &[(0.0, 0.0, -30.0)]).orientations_deg[0]
    };
    // The tag points to the left of the drone: the drone has turned clockwise relative to it.
    assert!((turned(OrientationSign::Clockwise) - 300.0).abs() < 1.0);
    assert!((turned(OrientationSign::CounterClockwise) - 240.0).abs() < 1.0);
}

#[test]
fn only_whole_tags_are_seen_and_at_most_four() {
    let airframe = flown(Attitude::default(), 1.0);
    let count = |tags: &[(f64, f64, f64)]| reported(CameraModel::perfect(), &airframe, tags).count;
    assert_eq!(count(&[(0.35, 0.0, 0.0)]), 1);
    assert_eq!(count(&[(0.45, 0.0, 0.0)]), 0, "cut by the rim");
    let many: Vec<_> = (0..6).map(|i| (0.05 * f64::from(i), 0.0, 0.0)).collect();
    assert_eq!(count(&many), 4);
    assert_eq!(reported(CameraModel::perfect(), &flown(Attitude::default(), 5.0), &many).count, 0);
}

#[test]
fn pictures_are_late_and_some_are_missed() {
    let airframe = flown(Attitude::default(), 1.5);
    let model = CameraModel { delay: [Duration::from_millis(100); 2], ..CameraModel::hard() };
    let mut camera = Camera::new(model, 3);
    let place = airframe.position_m().xy();
    let tags = [FloorTag::new(place.x, place.y, 0.0)];
    let ms = Duration::from_millis;
    let mut seen = 0;
    for picture in 0..300 {
        camera.take(ms(33 * picture), &airframe, &tags, Some(DETECTOR));
        if picture < 3 {
            assert_eq!(camera.read(ms(33 * picture)).count, 0, "still delayed");
        }
        seen += camera.read(ms(33 * picture)).count;
    }
    assert!((140..230).contains(&seen), "{seen} of 300");
    camera.take(ms(9900), &airframe, &tags, None);
    assert_eq!(camera.read(ms(20_000)).count, 0, "no detector is active");
}

#[test]
fn no_two_cameras_are_the_same() {
    let one = Camera::new(CameraModel::hard(), 1);
    let other = Camera::new(CameraModel::hard(), 2);
    assert_ne!(one.focal_units, other.focal_units);
    assert_ne!(one.centre_units, other.centre_units);
    let signs: Vec<f64> = (0..20).map(|seed| Camera::new(CameraModel::hard(), seed).sign).collect();
    assert!(signs.contains(&1.0) && signs.contains(&-1.0));
}

/// The field of view in `docs/position.md`, which `check` uses too.
#[test]
fn a_level_drone_sees_less_ahead_than_behind() {
    for (height_m, expected_m) in [
        (1.0, [0.37, 0.21, 0.28]),
        (1.5, [0.60, 0.37, 0.47]),
        (2.0, [0.84, 0.52, 0.66]),
        (2.5, [1.07, 0.68, 0.85]),
    ] {
        let level = Airframe::new(Profile::rec(), Vector2::zeros()).at_height(height_m);
        for (way, expected_m) in [(1.0, 0.0), (0.0, 1.0), (0.0, -1.0)].into_iter().zip(expected_m) {
            let sees = |metres: f64| {
                let tag = (way.0 * metres, way.1 * metres, 0.0);
                reported(CameraModel::perfect(), &level, &[tag]).count == 1
            };
            let steps = (0..200_u32).take_while(|step| sees(0.01 * f64::from(*step))).count();
            let seen_m = 0.01 * (steps as f64 - 1.0);
            assert!((seen_m - expected_m).abs() < 0.011, "{way:?} at {height_m} m: {seen_m}");
        }
    }
}
