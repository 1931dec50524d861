//! Searches for tags, and landings on them.

use super::*;

const TAGS: TagPercepts =
    TagPercepts { age_ms: 0, seen: false, nearest_m: None, landing_drift_m: [0.1, 0.0] };

/// Percepts above a tag, which lies at (2, 1) if its place is known.
fn tag(seen: bool, known: bool) -> TagPercepts {
    TagPercepts { seen, nearest_m: known.then_some([2.0, 1.0]), ..TAGS }
}

#[test]
fn a_search_climbs_looks_around_and_ends_when_a_tag_is_seen() {
    let mut bench = Bench::new(Percepts { tags: Some(tag(false, false)), ..HOVERING });
    assert!(bench.agent.achieve_find_tag());
    let mut places = Vec::new();
    for _ in 0..800 {
        let (command, report) = bench.step();
        assert_eq!(report, None);
        let Some(AgentCommand::GoTo(place)) = command else { panic!("{command:?}") };
        if places.last() != Some(&place) {
            places.push(place);
        }
    }
    assert_eq!(places.len(), 8, "above here, then around: {places:?}");
    assert!(places.iter().all(|place| (place.z_m - 2.5).abs() < 1e-9));
    assert!(places.iter().all(|place| place.x_m.abs() <= 1.4 && place.y_m.abs() <= 1.4));
    bench.percepts.tags = Some(tag(true, true));
    let here = bench.percepts.pose.unwrap();
    assert_eq!(bench.step(), (Some(AgentCommand::GoTo(here)), Some(Report::Done)));
}

#[test]
fn a_search_in_vain_is_told_and_ends() {
    let mut bench = Bench::new(Percepts { tags: Some(tag(false, true)), ..HOVERING });
    assert!(bench.agent.achieve_find_tag());
    let first = bench.run();
    let above = Pose { x_m: 2.0, y_m: 1.0, z_m: 2.5, yaw_deg: 0.0 };
    assert_eq!(first.command, Some(AgentCommand::GoTo(above)), "where one should be");
    let waited = std::iter::repeat_with(|| bench.run()).take(1100).position(|step| {
        assert_eq!(step.report, None);
        step.danger == Some(Danger::NoTag)
    });
    assert!(waited.is_some_and(|step| (990..1010).contains(&step)), "after 30 s: {waited:?}");
    assert_eq!(bench.step(), (Some(AgentCommand::Hover), Some(Report::Failed)));
}

#[test]
fn no_search_begins_or_goes_on_without_reserve_or_outside_the_fence() {
    let outside = Some(Pose { x_m: 10.1, ..TARGET });
    for spoilt in
        [Percepts { battery_percent: Some(20), ..HOVERING }, Percepts { pose: outside, ..HOVERING }]
    {
        for begun in [false, true] {
            let mut bench = Bench::new(Percepts { tags: Some(tag(false, false)), ..HOVERING });
            if !begun {
                bench.percepts = Percepts { tags: Some(tag(false, false)), ..spoilt };
            }
            assert!(bench.agent.achieve_find_tag());
            bench.step();
            bench.percepts = Percepts { tags: Some(tag(false, false)), ..spoilt };
            bench.percepts.now_ms = 100;
            assert_eq!(bench.step().0, Some(AgentCommand::Hover), "{spoilt:?}");
            assert_eq!(bench.step().1, Some(Report::Failed));
        }
    }
}

#[test]
fn without_tags_in_use_there_is_nothing_to_find() {
    let mut bench = Bench::new(HOVERING);
    assert!(bench.agent.achieve_find_tag());
    assert_eq!(bench.step(), (Some(AgentCommand::Hover), Some(Report::Failed)));
    assert!(bench.agent.achieve_land_on_tag());
    assert_eq!(bench.step(), (Some(AgentCommand::Land), Some(Report::Failed)));
}

#[test]
fn a_doubtful_place_is_searched_for_and_then_the_approach_goes_on() {
    let mut bench = Bench::new(Percepts { tags: Some(tag(false, true)), ..HOVERING });
    bench.go_to(TARGET);
    assert_eq!(bench.step().0, Some(AgentCommand::GoTo(TARGET)));
    bench.percepts.uncertainty_m = 1.1;
    let searching = bench.run();
    assert_eq!(searching.danger, Some(Danger::Searching));
    assert_ne!(searching.command, Some(AgentCommand::GoTo(TARGET)));
    bench.percepts.tags = Some(tag(true, true));
    assert_eq!(bench.step(), (Some(AgentCommand::GoTo(TARGET)), None));
    // Not again at once.
    bench.percepts.tags = Some(tag(false, true));
    assert_eq!(bench.step(), (Some(AgentCommand::GoTo(TARGET)), None));
    bench.percepts.now_ms += 61_000;
    bench.activity.approached_ms = 0;
    bench.activity.pursuit = None;
    assert_eq!(bench.run().danger, Some(Danger::Searching));
}

/// A drone that settles above the tag at (2, 1).
fn above_the_tag() -> Bench {
    let above = Pose { x_m: 2.0, y_m: 1.0, z_m: 0.8, yaw_deg: 0.0 };
    let mut bench = Bench::new(Percepts { tags: Some(tag(true, true)), ..HOVERING });
    assert!(bench.agent.achieve_land_on_tag());
    assert_eq!(bench.step(), (Some(AgentCommand::GoTo(above)), None));
    bench.percepts.pose = Some(above);
    bench
}

#[test]
fn a_landing_on_a_tag_settles_above_it_and_descends_against_the_wind_from_it() {
    let mut bench = above_the_tag();
    bench.percepts.speed_m_s = 0.3;
    let above = bench.percepts.pose.unwrap();
    assert_eq!(bench.step().0, Some(AgentCommand::GoTo(above)), "it is not steady yet");
    bench.percepts.speed_m_s = 0.0;
    let Some(AgentCommand::GoTo(down)) = bench.step().0 else { panic!() };
    assert!((down.x_m - 1.9).abs() < 1e-9 && (down.z_m - 0.3).abs() < 1e-9, "{down:?}");
    bench.percepts.pose = Some(Pose { z_m: 0.31, ..down });
    assert_eq!(bench.step().0, Some(AgentCommand::Land));
    // Nothing takes it back.
    assert!(bench.agent.achieve_hold());
    assert_eq!(bench.step().0, Some(AgentCommand::Land));
    bench.percepts.on_ground = true;
    assert_eq!(bench.step(), (Some(AgentCommand::Standby), Some(Report::Done)));
}

#[test]
fn a_hold_ends_the_settling_above_a_tag_but_not_the_descent() {
    let mut bench = above_the_tag();
    let above = bench.percepts.pose.unwrap();
    assert!(bench.agent.achieve_hold());
    assert_eq!(bench.step().0, Some(AgentCommand::GoTo(above)));
    assert_eq!(bench.step().0, Some(AgentCommand::GoTo(above)), "it stays up");
    let mut bench = above_the_tag();
    bench.step();
    assert!(bench.agent.achieve_hold());
    assert_eq!(bench.step().0, Some(AgentCommand::Land));
}

#[test]
fn a_tag_that_is_lost_is_landed_without() {
    let lost = Some(TagPercepts { age_ms: 2001, ..tag(false, true) });
    for descends in [false, true] {
        let mut bench = above_the_tag();
        if descends {
            bench.step();
        }
        bench.percepts.tags = lost;
        let step = bench.run();
        let landing = (Some(AgentCommand::Land), Some(Report::Failed), Some(Danger::TagLost));
        assert_eq!((step.command, step.report, step.danger), landing);
    }
    // So low it is not seen anyway.
    let mut bench = above_the_tag();
    bench.step();
    bench.percepts.tags = lost;
    bench.percepts.pose = Some(Pose { z_m: 0.5, ..TARGET });
    assert!(matches!(bench.step().0, Some(AgentCommand::GoTo(_))));
}
