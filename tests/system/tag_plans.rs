//! The agent looks for tags and lands on them.

use std::time::Duration;

use autopilot::outcome::Outcome;
use autopilot::plan::{Border, FlightLimits};
use autopilot::vehicle::{FlightEvent, OperatorOrder, TagConfig, VehicleConfig};
use mock_drone::scenario::Scenario;
use mock_drone::sensors::SensorModel;
use mock_drone::{CameraModel, DroneConfig, FloorTag, LinkFaults, WorldConfig};
use nalgebra::Vector2;
use system_tests::plan;
use system_tests::sim::{Moment, SimulatedFlight, Simulation};

/// A flight over tags, on a nominal or a hard day.
fn day(seed: u64, hard: bool, tags: &[(f64, f64)], scenario: &str) -> Simulation {
    let mut drone = DroneConfig { seed, battery_percent: 100.0, ..DroneConfig::default() };
    let mut link = LinkFaults::default();
    drone.camera = CameraModel::nominal();
    if hard {
        drone.sensors = SensorModel::hard();
        drone.camera = CameraModel::hard();
        drone.wind_m_s = Vector2::new(0.5, -0.4);
        drone.gusts_m_s = 0.2;
        drone.trim_error_deg = 0.6;
        link.loss = 0.03;
    }
    let scenario = Scenario::parse("scenario", scenario).unwrap();
    let tags = tags.iter().map(|(x, y)| FloorTag::new(*x, *y, 40.0)).collect();
    let mut pilot = VehicleConfig::default();
    pilot.estimator.tags = Some(TagConfig::default());
    Simulation {
        world: WorldConfig { drone, link, scenario, tags, ..WorldConfig::default() },
        pilot,
        ..Simulation::default()
    }
}

fn happened(flight: &SimulatedFlight, event: &FlightEvent) -> bool {
    flight.events.iter().any(|(_, other)| other == event)
}

fn off_m(flight: &SimulatedFlight, tag: (f64, f64)) -> f64 {
    (flight.final_truth.position_m.xy() - Vector2::new(tag.0, tag.1)).norm()
}

#[test]
fn a_tag_two_metres_away_is_found_and_landed_on() {
    for (hard, within_m) in [(false, 0.10), (true, 0.20)] {
        let tag = (1.2, 1.6);
        let flight = day(3, hard, &[tag], "").fly(plan("takeoff\nfindTag\nlandOnTag\n")).unwrap();
        assert_eq!(flight.outcome, Outcome::Completed, "{:?}", flight.events);
        assert!(off_m(&flight, tag) < within_m, "{}", off_m(&flight, tag));
    }
}

#[test]
fn a_search_in_vain_ends_in_time_inside_the_fence_and_is_told() {
    let mut simulation = day(1, false, &[], "");
    simulation.pilot.limits =
        FlightLimits { border: Border::circle(1.5), ..FlightLimits::default() };
    let mut furthest_m = 0.0_f64;
    let flight = simulation
        .fly_watched(plan("takeoff\nfindTag\nland\n"), |moment: &Moment| {
            furthest_m = furthest_m.max(moment.truth.position_m.xy().norm());
        })
        .unwrap();
    assert!(happened(&flight, &FlightEvent::NoTagFound), "{:?}", flight.events);
    assert!(matches!(flight.outcome, Outcome::Failsafe { .. }), "{}", flight.outcome);
    assert!(flight.duration < Duration::from_secs(50), "{:?}", flight.duration);
    // It looked around, half a metre inside the fence.
    assert!((0.8..1.4).contains(&furthest_m), "{furthest_m}");
}

#[test]
fn landing_on_a_tag_needs_no_search_if_it_is_in_view() {
    let tag = (0.1, -0.1);
    let mut highest_m = 0.0_f64;
    let flight = day(2, false, &[tag], "")
        .fly_watched(plan("takeoff\ngoto 0 0 0.4 0\nlandOnTag\n"), |moment: &Moment| {
            highest_m = highest_m.max(moment.truth.position_m.z);
        })
        .unwrap();
    assert_eq!(flight.outcome, Outcome::Completed, "{:?}", flight.events);
    assert!(off_m(&flight, tag) < 0.10, "{}", off_m(&flight, tag));
    assert!(highest_m < 1.5, "{highest_m}");
}

#[test]
fn a_landing_on_a_tag_that_is_carried_away_ends_on_the_ground() {
    for seed in 1..=3 {
        // Away while it settles above the tag, or while it goes there.
        for at_s in [9, 11] {
            let scenario = format!("+{at_s} tag-gone 1");
            let text = "takeoff\nsetStayTime 1\ngoto 0 0 0.65 0\nlandOnTag\n";
            let flight = day(seed, false, &[(0.1, -0.1)], &scenario).fly(plan(text)).unwrap();
            let down = flight.final_truth.position_m.z < 0.01;
            assert!(down && flight.duration < Duration::from_secs(70), "{:?}", flight.events);
        }
    }
}

#[test]
fn a_surveyed_tag_of_the_plan_is_used() {
    let text = "tag 0 2\ntakeoff\nfindTag\nlandOnTag\n";
    let flight = day(4, false, &[(0.0, 2.0)], "").fly(plan(text)).unwrap();
    assert_eq!(flight.outcome, Outcome::Completed, "{:?}", flight.events);
    assert!(off_m(&flight, (0.0, 2.0)) < 0.10, "{}", off_m(&flight, (0.0, 2.0)));
}

/// A drone that has lost its tag, and no longer knows well where it is, looks for it and goes on.
#[test]
fn a_doubtful_place_is_a_reason_to_look_for_the_tag() {
    let simulation = day(1, false, &[(0.1, -0.1)], "");
    let (mut most_m, mut off_m) = (0.0_f64, 0.0_f64);
    let text = "takeoff\nsetStayTime 1\ngoto 0 0 0.65 0\nsetStayTime 240\ngoto 3 0 0.65 0\n";
    let flight = simulation
        .fly_watched(plan(text), |moment: &Moment| {
            let pose = moment.status.pose.unwrap_or_default();
            let truth = moment.truth.position_m.xy();
            most_m = most_m.max(moment.status.uncertainty_m);
            off_m = off_m.max((truth - Vector2::new(pose.x_m, pose.y_m)).norm());
        })
        .unwrap();
    assert!(happened(&flight, &FlightEvent::SearchingTag), "{:?}", flight.events);
    assert!(!happened(&flight, &FlightEvent::NoTagFound), "{:?}", flight.events);
    assert_eq!(flight.outcome, Outcome::Completed, "{:?}", flight.events);
    assert!(most_m < 1.3 && off_m < 1.3, "{most_m} {off_m}");
    // Searches do not make it stay longer than was ordered, but for the way.
    assert!(flight.duration < Duration::from_secs(330), "{:?}", flight.duration);
}

#[test]
fn plans_with_tag_commands_land_where_tags_are_not_in_use() {
    let mut simulation = day(1, false, &[(0.1, -0.1)], "");
    simulation.pilot.estimator.tags = None;
    for text in ["takeoff\nfindTag\nland\n", "takeoff\nlandOnTag\n"] {
        let flight = simulation.fly(plan(text)).unwrap();
        assert!(happened(&flight, &FlightEvent::NoTagFound), "{:?}", flight.events);
        assert!(flight.duration < Duration::from_secs(20), "{:?}", flight.duration);
        assert!(flight.final_truth.position_m.z < 0.01);
    }
}

#[test]
fn a_plan_that_is_loaded_in_flight_brings_its_tags() {
    let mut simulation = day(2, false, &[(1.5, 1.0)], "");
    let text = "tag 1.6 1.0\ntakeoff\ngoto 1.5 0.9 0.7 0\ngoto 1.5 0.9 0.7 0\nlandOnTag\n";
    simulation.orders = vec![(Duration::from_secs(8), OperatorOrder::Load(plan(text)))];
    let (mut known, mut from_tag_m) = (Vec::new(), [Vector2::zeros(); 2]);
    let watch = |moment: &Moment| {
        known = moment.status.tags.unwrap().known.iter().copied().collect();
        let (pose, truth_m) =
            (moment.status.pose.unwrap_or_default(), moment.truth.position_m.xy());
        if let [tag] = known.as_slice() {
            let estimated_m = Vector2::new(pose.x_m, pose.y_m) - tag.place_m;
            from_tag_m = [truth_m - Vector2::new(1.5, 1.0), estimated_m];
        }
    };
    let flight = simulation
        .fly_watched(plan("takeoff\nsetStayTime 9\ngoto 0 0 0.5 0\nland"), watch)
        .unwrap();
    assert_eq!(flight.outcome, Outcome::Completed, "{:?}", flight.events);
    assert!(off_m(&flight, (1.5, 1.0)) < 0.1, "{}", off_m(&flight, (1.5, 1.0)));
    // It was seen, and taken for the declared one, so the world counts from there.
    assert!(known.len() == 1 && known[0].surveyed && known[0].seen_ago.is_some(), "{known:?}");
    assert!((from_tag_m[0] - from_tag_m[1]).norm() < 0.1, "{from_tag_m:?}");
}
