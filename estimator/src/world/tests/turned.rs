//! Tags that are turned in place, and a compass that drifts.

use super::*;
use crate::OrientationSign;
use crate::Start;
use crate::world::MAX_TAGS;
use crate::world::filter::Filter;
use crate::world::map::Map;

/// A drone that has hovered above a tag for a minute.
fn settled(surveyed: bool) -> Bench {
    let mut config =
        TagConfig { orientation: Some(OrientationSign::Clockwise), ..TagConfig::default() };
    if surveyed {
        let place_m = Vector2::new(0.2, 0.1);
        config.surveyed[0] = Some(SurveyedTag { place_m, heading_deg: Some(30.0) });
    }
    let mut bench = Bench::new(Some(&config));
    bench.fly(900, none);
    assert!(heading_deg(&bench).is_some(), "it corrects the heading");
    bench
}

/// The direction of the only tag, while it is used.
fn heading_deg(bench: &Bench) -> Option<f64> {
    let tags = bench.estimator.tag_status(bench.now()).unwrap();
    assert_eq!(tags.known.count(), 1, "its position is still used");
    tags.known.iter().next().unwrap().heading_deg
}

fn yaw_error_deg(bench: &Bench) -> f64 {
    kinematics::wrap_deg(bench.estimator.predicted(bench.now()).yaw_deg - bench.yaw_deg).abs()
}

#[test]
fn a_tag_that_is_turned_at_once_does_not_turn_the_world() {
    for surveyed in [false, true] {
        for turn_deg in [-120.0, -30.0, 15.0, 30.0, 90.0] {
            let mut bench = settled(surveyed);
            bench.direction_deg += turn_deg;
            bench.fly(1500, none);
            let off_deg = yaw_error_deg(&bench);
            assert!(off_deg < 5.0, "{surveyed}, {turn_deg}: {off_deg}");
            assert_eq!(heading_deg(&bench), None);
            assert!(bench.place_m().norm() < 0.1, "{}", bench.place_m());
        }
    }
}

#[test]
fn a_tag_that_turns_slowly_does_not_turn_the_world() {
    for surveyed in [false, true] {
        for turn_deg_s in [-2.0, 0.5] {
            let mut bench = settled(surveyed);
            for _ in 0..4500 {
                bench.direction_deg += turn_deg_s / 15.0;
                bench.fly(1, none);
            }
            let off_deg = yaw_error_deg(&bench);
            assert!(off_deg < 16.0, "{surveyed}, {turn_deg_s}: {off_deg}");
            assert_eq!(heading_deg(&bench), None);
        }
    }
}

#[test]
fn a_compass_that_drifts_is_no_turning_tag() {
    let mut bench = settled(false);
    // Twice the standard deviation of its drift.
    for _ in 0..4500 {
        bench.yaw_deg += 0.06 / 15.0;
        bench.direction_deg += 0.06 / 15.0;
        bench.tag_m = kinematics::world_from_body(bench.tag_m, 0.06 / 15.0);
        bench.fly(1, none);
    }
    assert!(heading_deg(&bench).is_some());
    let off_deg = bench.estimator.predicted(bench.now()).yaw_deg;
    assert!(off_deg.abs() < 2.0, "the drone has not turned: {off_deg}");
}

#[test]
fn residuals_of_a_direction_that_do_not_average_out_show_that_a_tag_turns() {
    let watched = |residuals: &[(f64, u32)], uncertainty_deg: f64| {
        let place_m = Vector2::zeros();
        let mut surveyed = [None; MAX_TAGS];
        surveyed[0] = Some(SurveyedTag { place_m, heading_deg: Some(0.0) });
        let mut map = Map::new(&surveyed, &mut Filter::new(true, &Start::default()));
        let sights = residuals.iter().flat_map(|(off_deg, sights)| (0..*sights).map(|_| *off_deg));
        sights.fold(false, |_, off_deg| map.watch_direction(0, off_deg, uncertainty_deg))
    };
    // A mean of twenty, of ten degrees at most.
    assert!(!watched(&[(9.9, 500)], 0.0) && watched(&[(10.1, 500)], 0.0));
    assert!(!watched(&[(-30.0, 7)], 0.0) && watched(&[(-30.0, 8)], 0.0));
    // Sightings of something else count with forty degrees.
    assert!(!watched(&[(180.0, 5)], 0.0) && watched(&[(180.0, 6)], 0.0));
    // Three standard deviations of an uncertain heading.
    assert!(!watched(&[(23.0, 500)], 8.0) && watched(&[(25.0, 500)], 8.0));
    assert!(!watched(&[(25.0, 500), (0.0, 500)], 8.0), "it averages out");
}

#[test]
fn with_a_wrong_sign_of_the_orientation_a_tag_seems_to_turn() {
    let config =
        TagConfig { orientation: Some(OrientationSign::CounterClockwise), ..TagConfig::default() };
    let mut bench = Bench::new(Some(&config));
    bench.fly(900, none);
    for _ in 0..90 {
        bench.yaw_deg += 1.0;
        bench.fly(1, none);
    }
    bench.fly(900, none);
    let off_deg = yaw_error_deg(&bench);
    assert!(off_deg < 6.0, "{off_deg}");
    assert_eq!(heading_deg(&bench), None);
}
