//! Tags that are surveyed while the drone flies.

use super::*;
use crate::{KnownTag, MAX_TAGS, NoRoom};

fn surveyed(right_m: f64, forward_m: f64, heading_deg: Option<f64>) -> SurveyedTag {
    SurveyedTag { place_m: Vector2::new(right_m, forward_m), heading_deg }
}

fn known(bench: &Bench) -> Vec<KnownTag> {
    bench.estimator.tag_status(bench.now()).unwrap().known.iter().copied().collect()
}

/// A drone whose flow has no bias, above a tag that it has found.
fn above_a_found_tag() -> Bench {
    let mut bench = Bench::new(Some(&TagConfig::default()));
    bench.flow_m_s = Vector2::zeros();
    bench.fly(300, none);
    assert!(known(&bench).len() == 1 && !known(&bench)[0].surveyed);
    bench
}

#[test]
fn a_tag_that_is_surveyed_in_flight_corrects_the_drone_like_one_that_was_before() {
    let tag = surveyed(1.8, 0.1, None);
    let mut config = TagConfig::default();
    config.surveyed[0] = Some(tag);
    let mut before = Bench::new(Some(&config));
    let mut later = Bench::new(Some(&TagConfig::default()));
    for bench in [&mut before, &mut later] {
        bench.sees = false;
        bench.flow_m_s = Vector2::new(0.3, 0.0);
        bench.fly(75, none);
    }
    assert_eq!(later.estimator.survey(&[tag]), Ok(()));
    assert!(known(&later)[0].surveyed && known(&later)[0].seen_ago.is_none());
    let off_m = (before.uncertainty_m(), later.uncertainty_m());
    assert!((off_m.0 - off_m.1).abs() < 0.02, "the start is as uncertain: {off_m:?}");
    // The drone believes to be at 1.5 m, but stood 0.1 m aside.
    for bench in [&mut before, &mut later] {
        bench.sees = true;
        bench.flow_m_s = Vector2::zeros();
        bench.fly(100, none);
        assert_eq!(known(bench).len(), 1);
        let expected = tag.place_m - bench.tag_m;
        assert!((bench.place_m() - expected).norm() < 0.1, "{}", bench.place_m());
        assert!(bench.uncertainty_m() < 0.15);
    }
}

#[test]
fn a_found_tag_near_it_is_taken_for_it_and_takes_the_drone_to_its_place() {
    let mut bench = above_a_found_tag();
    let (before_m, found) = (bench.place_m(), known(&bench)[0]);
    let tag = surveyed(found.place_m.x + 0.3, found.place_m.y - 0.1, Some(45.0));
    bench.estimator.survey(&[tag]).unwrap();
    let same = known(&bench);
    assert_eq!((same.len(), same[0].id, same[0].surveyed), (1, found.id, true));
    assert!((same[0].place_m - tag.place_m).norm() < 0.02, "{same:?}");
    assert!((same[0].heading_deg.unwrap() - 45.0).abs() < 1e-9);
    let moved_m = bench.place_m() - before_m;
    assert!((moved_m - Vector2::new(0.3, -0.1)).norm() < 0.04, "{moved_m}");
    // The controller sees a motion.
    let prediction = bench.estimator.predicted(bench.now());
    let seen_m = bench.estimator.smooth(&prediction).position_m.xy() - before_m;
    assert!(seen_m.norm() < 1e-3, "{seen_m}");
    bench.fly(100, none);
    assert!((bench.place_m() - before_m - moved_m).norm() < 0.02);
}

#[test]
fn a_surveyed_tag_keeps_its_place_and_its_world() {
    let mut bench = above_a_found_tag();
    let found = known(&bench)[0];
    let tag = surveyed(found.place_m.x, found.place_m.y, None);
    bench.estimator.survey(&[tag]).unwrap();
    let before = (known(&bench), bench.place_m(), bench.uncertainty_m());
    let again = surveyed(tag.place_m.x + 0.7, tag.place_m.y, Some(10.0));
    bench.estimator.survey(&[again]).unwrap();
    assert_eq!((known(&bench), bench.place_m(), bench.uncertainty_m()), before);
    // Further away it is another one.
    bench.estimator.survey(&[surveyed(tag.place_m.x + 0.8, tag.place_m.y, None)]).unwrap();
    assert_eq!(known(&bench).iter().map(|tag| tag.id).collect::<Vec<_>>(), [1, 2]);
    assert!((bench.uncertainty_m() - before.2).abs() < 1e-9, "the world was surveyed before");
}

#[test]
fn tags_for_which_there_is_no_room_change_nothing() {
    let mut bench = above_a_found_tag();
    let row: Vec<SurveyedTag> =
        (0..8).map(|i| surveyed(2.0 * f64::from(i) - 9.0, 4.0, None)).collect();
    let before = (known(&bench), bench.uncertainty_m());
    assert_eq!(bench.estimator.survey(&row), Err(NoRoom));
    assert_eq!((known(&bench), bench.uncertainty_m()), before);
    // With the found one among them there are eight.
    let found = known(&bench)[0].place_m;
    let mut eight = row[..7].to_vec();
    eight.push(surveyed(found.x, found.y, None));
    bench.estimator.survey(&eight).unwrap();
    assert_eq!(known(&bench).len(), MAX_TAGS);
    assert!(known(&bench).iter().all(|tag| tag.surveyed));
    // Without tags nothing is added.
    let mut without = Bench::new(None);
    assert_eq!(without.estimator.survey(&row), Ok(()));
    assert_eq!(without.estimator.tag_status(without.now()), None);
}
