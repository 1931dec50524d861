//! Tags on the floor: what the agent is given of them, and the turn that teaches how to read them.

use ardrone_link::at::Ref;
use nalgebra::Vector2;

use super::bench::{Bench, SECOND, START};
use super::*;
use crate::agent::TagPercepts;

/// A vehicle above a tag at its start; another tag is two metres to the right.
fn above_a_tag() -> Bench {
    flying_above_a_tag("takeoff\nland")
}

fn flying_above_a_tag(plan: &str) -> Bench {
    let surveyed = |x_m| Some(SurveyedTag { place_m: Vector2::new(x_m, 0.0), heading_deg: None });
    let mut tags = TagConfig::default();
    (tags.surveyed[0], tags.surveyed[1]) = (surveyed(2.0), surveyed(0.0));
    let mut config = VehicleConfig { read_back: false, ..VehicleConfig::default() };
    config.estimator.tags = Some(tags);
    let mut bench = Bench::with(&config);
    bench.run(3 * SECOND);
    bench.accepted(OperatorOrder::Load(Plan::parse("plan", plan).unwrap()));
    bench.accepted(START);
    bench.until(SECOND, |bench| bench.phase() == Phase::Flying);
    bench.sees_tag = true;
    bench.rises();
    bench.control_state = ControlState::TakingOff;
    bench.run(3 * SECOND);
    bench
}

fn percepts(vehicle: &Vehicle, now: Duration, state: &Prediction) -> Option<TagPercepts> {
    let status = vehicle.flight.estimator.tag_status(now)?;
    Some(vehicle.tag_percepts(now, state, &status))
}

#[test]
fn the_agent_is_given_the_nearest_tag_and_how_long_ago_one_was_seen() {
    let mut bench = above_a_tag();
    let percepts = |bench: &Bench| bench.vehicle.decision().unwrap().percepts.tags.unwrap();
    let seen = percepts(&bench);
    let [x_m, y_m] = seen.nearest_m.unwrap();
    assert!(seen.seen && x_m.hypot(y_m) < 0.3, "{seen:?}");
    assert!((0..500).contains(&seen.age_ms), "{seen:?}");
    bench.sees_tag = false;
    bench.run(SECOND + SECOND / 10);
    let then = percepts(&bench);
    assert!(!then.seen && (1000..1500).contains(&then.age_ms), "{then:?}");
    assert!(then.nearest_m.is_some_and(|[x_m, y_m]| x_m.hypot(y_m) < 0.3), "known all the same");
}

#[test]
fn a_tag_that_was_never_seen_is_as_old_as_the_flight() {
    let mut config = VehicleConfig { read_back: false, ..VehicleConfig::default() };
    assert_eq!(percepts(&Bench::with(&config).vehicle, SECOND, &Prediction::default()), None);
    config.estimator.tags = Some(TagConfig::default());
    let mut bench = Bench::with(&config);
    bench.step();
    let later = bench.now + 5 * SECOND;
    let percepts = percepts(&bench.vehicle, later, &Prediction::default()).unwrap();
    assert_eq!((percepts.age_ms, percepts.seen, percepts.nearest_m), (5000, false, None));
}

#[test]
fn above_a_tag_of_unknown_orientation_the_drone_turns_to_and_fro() {
    let mut bench = above_a_tag();
    assert!(bench.vehicle.flight.estimator.would_learn_from_a_turn(bench.now));
    let now = bench.now;
    let target = Pose { x_m: 1.0, y_m: 2.0, z_m: 1.0, yaw_deg: 40.0 };
    bench.vehicle.flight.sign_search = SignSearch::default();
    // A quarter of the swing's six seconds, again and again.
    let turned: Vec<f64> = (0..600)
        .map(|_| bench.vehicle.turned_to_learn(now, &target, 0.01).yaw_deg - target.yaw_deg)
        .collect();
    for (tick, expected_deg) in [(149, 8.0), (299, 0.0), (449, -8.0), (599, 0.0)] {
        assert!((turned[tick] - expected_deg).abs() < 0.01, "{tick}: {}", turned[tick]);
    }
    // Out of sight nothing is learnt, and the next swing begins anew.
    let later = now + 5 * SECOND;
    assert_eq!(bench.vehicle.turned_to_learn(later, &target, 0.01), target);
    let again = bench.vehicle.turned_to_learn(now, &target, 1.5);
    assert!((again.yaw_deg - 48.0).abs() < 0.01, "{again:?}");
    assert_eq!(Pose { yaw_deg: 40.0, ..again }, target);
}

#[test]
fn a_landing_on_a_tag_may_be_taken_back_until_the_way_down() {
    let mut bench = flying_above_a_tag("takeoff\nlandOnTag");
    bench.drifts_m_s = 0.12;
    bench.run(SECOND / 2);
    bench.control_state = ControlState::Hovering;
    bench.until(SECOND, |bench| bench.vehicle.status(bench.now).step == Some(1));
    bench.step();
    assert!(!bench.vehicle.lands(), "it becomes steady above the tag first");
    bench.drifts_m_s = 0.0;
    bench.until(30 * SECOND, |bench| bench.vehicle.flight.activity.is_descending());
    assert!(bench.vehicle.lands());
    assert_eq!(bench.order(OperatorOrder::Hold), Err(Refused::Landing));
    bench.until(10 * SECOND, |bench| bench.reference() == Some(Ref::Land));
    bench.run(SECOND);
    assert_eq!(bench.order(OperatorOrder::Hold), Err(Refused::Landing));
}

#[test]
fn surveyed_tags_are_known_before_they_are_seen() {
    let bench = above_a_tag();
    let known = bench.vehicle.status(bench.now).tags.unwrap().known;
    let places: Vec<_> = known.iter().map(|tag| tag.place_m.x).collect();
    assert_eq!(places.len(), 2);
    assert!(known.iter().all(|tag| tag.surveyed));
}

#[test]
fn the_nearest_tag_is_the_nearest_to_the_drone() {
    let surveyed =
        |x_m, y_m| Some(SurveyedTag { place_m: Vector2::new(x_m, y_m), heading_deg: None });
    let mut tags = TagConfig::default();
    (tags.surveyed[0], tags.surveyed[1]) = (surveyed(2.0, 0.0), surveyed(0.0, 2.0));
    let mut config = VehicleConfig::default();
    config.estimator.tags = Some(tags);
    let vehicle = Vehicle::new(&config).unwrap();
    for (here_m, nearest_m) in [([0.6, 0.5], [2.0, 0.0]), ([0.5, 0.6], [0.0, 2.0])] {
        let position_m = nalgebra::Vector3::new(here_m[0], here_m[1], 1.0);
        let state = Prediction { position_m, ..Prediction::default() };
        let percepts = percepts(&vehicle, SECOND, &state).unwrap();
        assert_eq!(percepts.nearest_m, Some(nearest_m), "{here_m:?}");
        assert!(!percepts.seen, "known, but never seen");
    }
}

#[test]
fn a_tag_is_in_view_for_half_a_second() {
    let bench = above_a_tag();
    let ago = bench.vehicle.flight.estimator.tag_status(bench.now).unwrap().seen_ago.unwrap();
    let is_seen = |ago_ms: u64| {
        let now = bench.now + Duration::from_millis(ago_ms).saturating_sub(ago);
        percepts(&bench.vehicle, now, &Prediction::default()).unwrap().seen
    };
    assert!(is_seen(499));
    assert!(!is_seen(500));
    assert!(!is_seen(501));
}

fn plan_with_tags(tags: &[(f64, f64)]) -> OperatorOrder {
    let tags: Vec<String> = tags.iter().map(|(x, y)| format!("tag {x} {y}")).collect();
    let text = format!("{}\ntakeoff\nlandOnTag", tags.join("\n"));
    OperatorOrder::Load(Plan::parse("plan", &text).unwrap())
}

fn known(bench: &Bench) -> Vec<KnownTag> {
    bench.vehicle.status(bench.now).tags.unwrap().known.iter().copied().collect()
}

#[test]
fn a_plan_that_is_loaded_in_the_air_brings_its_tags() {
    let mut bench = above_a_tag();
    assert_eq!(known(&bench).len(), 2);
    bench.accepted(plan_with_tags(&[(0.1, 0.0), (5.0, 1.0)]));
    let tags = known(&bench);
    assert_eq!(tags.len(), 3, "one of them was known: {tags:?}");
    assert!(tags[2].surveyed && (tags[2].place_m - Vector2::new(5.0, 1.0)).norm() < 1e-9);
    // Six more are too many: nothing of the mission changes.
    let (steps, row) = (bench.vehicle.mission().to_vec(), [-9.0, -7.0, -5.0, -3.0, -1.0, 1.0]);
    let six = row.map(|x_m| (x_m, -4.0));
    let refused = Err(Refused::TooManyTags { declared: 6, known: 3 });
    assert_eq!(bench.order(plan_with_tags(&six)), refused);
    assert_eq!((known(&bench), bench.vehicle.mission()), (tags, steps.as_slice()));
    bench.accepted(plan_with_tags(&six[..5]));
    assert_eq!(known(&bench).len(), 8);
    // From the landing on a plan is for the next flight, and brings its tags there.
    bench.accepted(OperatorOrder::Land);
    bench.accepted(plan_with_tags(&six));
    assert_eq!(known(&bench).len(), 8);
    bench.comes_down();
    bench.until(5 * SECOND, |bench| bench.phase() == Phase::Standby);
    bench.accepted(START);
    let x_m: Vec<_> = known(&bench)[2..].iter().map(|tag| tag.place_m.x).collect();
    assert_eq!(x_m, row);
}

#[test]
fn more_tags_than_can_be_known_are_refused_with_the_plan() {
    let mut config = VehicleConfig::default();
    let mut tags = TagConfig::default();
    let given = |x_m| Some(SurveyedTag { place_m: Vector2::new(x_m, 6.0), heading_deg: None });
    (tags.surveyed[0], tags.surveyed[1]) = (given(-2.0), given(2.0));
    config.estimator.tags = Some(tags);
    let row: Vec<(f64, f64)> = (0..7).map(|i| (2.0 * f64::from(i) - 6.0, 0.0)).collect();
    let load = |vehicle: &mut Vehicle, tags| {
        vehicle.order(SECOND, Operator::TERMINAL, plan_with_tags(tags))
    };
    let mut vehicle = Vehicle::new(&config).unwrap();
    let refused = Refused::TooManyTags { declared: 7, known: 2 };
    assert_eq!(load(&mut vehicle, &row), Err(refused.clone()));
    assert!(vehicle.mission().is_empty());
    let text = refused.to_string();
    assert!(text.contains("7 tags besides 2 others: at most 8"), "{text}");
    assert_eq!(load(&mut vehicle, &row[..6]), Ok(()));
    let OperatorOrder::Load(plan) = plan_with_tags(&row) else { unreachable!() };
    let error = Vehicle::flying(plan.clone(), &config).unwrap_err();
    assert_eq!(error, CannotFly::Refused(refused));
    // Without tags in use there is nothing to be known.
    assert!(Vehicle::flying(plan, &VehicleConfig::default()).is_ok());
}
