//! Tags on the floor: the drone finds them, and its place no longer drifts.

use std::fmt::Write as _;
use std::time::Duration;

use autopilot::plan::Commands;
use autopilot::vehicle::{FlightEvent, OperatorOrder, TagConfig, VehicleConfig};
use kinematics::wrap_deg;
use mock_drone::scenario::Scenario;
use mock_drone::sensors::SensorModel;
use mock_drone::{CameraModel, DroneConfig, FloorTag, WorldConfig};
use nalgebra::Vector2;
use system_tests::plan;
use system_tests::sim::{Moment, SimulatedFlight, Simulation};

const HOVER: &str = "setStayTime 60\ngoto 0 0 0.65 0\n";

/// How a flight went, from half a minute after it was sent to its first target.
#[derive(Debug, Default)]
struct Kept {
    truth_worst_m: f64,
    estimate_worst_m: f64,
    inside: f64,
    moments: f64,
    heading_deg: f64,
    flown_s: f64,
    /// The largest change of the drone's true speed in one tick.
    jolt_m_s: f64,
}

fn hover(seed: u64, hard: bool, scenario: &str) -> (Kept, SimulatedFlight) {
    let (sensors, camera) = if hard {
        (SensorModel::hard(), CameraModel::hard())
    } else {
        (SensorModel::nominal(), CameraModel::nominal())
    };
    let drone =
        DroneConfig { seed, sensors, camera, battery_percent: 100.0, ..DroneConfig::default() };
    let scenario = Scenario::parse("scenario", scenario).unwrap();
    let tags = vec![FloorTag::new(0.05, -0.05, 120.0)];
    let mut pilot = VehicleConfig::default();
    pilot.estimator.tags = Some(TagConfig::default());
    let laps = Commands::parse("laps", &HOVER.repeat(10)).unwrap();
    let simulation = Simulation {
        world: WorldConfig { drone, scenario, tags, ..WorldConfig::default() },
        pilot,
        orders: vec![(Duration::from_secs(20), OperatorOrder::Append(laps))],
        ..Simulation::default()
    };
    let mut kept = Kept::default();
    let mut since = None;
    let mut last_m_s: Option<Vector2<f64>> = None;
    let watch = |moment: &Moment| {
        let Some(target) = moment.status.target else { return };
        let since_s = moment.now.saturating_sub(*since.get_or_insert(moment.now)).as_secs_f64();
        let velocity_m_s = moment.truth.velocity_m_s.xy();
        let jolt_m_s =
            last_m_s.replace(velocity_m_s).map_or(0.0, |last| (velocity_m_s - last).norm());
        if since_s < 30.0 {
            return;
        }
        let truth = moment.truth.position_m.xy();
        let pose = moment.status.pose.unwrap_or_default();
        let off = truth - Vector2::new(pose.x_m, pose.y_m);
        let astray = truth - Vector2::new(target.x_m, target.y_m);
        kept.truth_worst_m = kept.truth_worst_m.max(astray.norm());
        kept.estimate_worst_m = kept.estimate_worst_m.max(off.norm());
        kept.jolt_m_s = kept.jolt_m_s.max(jolt_m_s);
        kept.moments += 1.0;
        let most_m = 2.0 * moment.status.uncertainty_m;
        kept.inside += f64::from(u8::from(off.x.abs() <= most_m && off.y.abs() <= most_m));
        let turned_deg = moment.truth.yaw_deg - pose.yaw_deg;
        kept.heading_deg = wrap_deg(turned_deg).abs();
        kept.flown_s = since_s;
    };
    let flight =
        simulation.fly_watched(plan(&format!("takeoff\n{}", HOVER.repeat(5))), watch).unwrap();
    (kept, flight)
}

#[test]
fn a_tag_holds_the_place_until_the_battery_is_empty() {
    for seed in 1..=3 {
        let (kept, flight) = hover(seed, false, "");
        assert!(flight.outcome.to_string().contains("battery"), "{}", flight.outcome);
        assert!(kept.flown_s > 560.0, "{kept:?}");
        assert!(kept.truth_worst_m < 0.15 && kept.estimate_worst_m < 0.1, "{seed}: {kept:?}");
        assert!(kept.heading_deg < 1.5, "{seed}: {kept:?}");
        assert!(kept.inside / kept.moments >= 0.9, "{seed}: {kept:?}");
    }
}

#[test]
fn it_does_so_on_a_hard_day_too() {
    for seed in 1..=3 {
        let (kept, flight) = hover(seed, true, "0 loss 3\n+0 wind 0.5 -0.4 gusts 0.2");
        assert!(flight.outcome.to_string().contains("battery"), "{}", flight.outcome);
        assert!(kept.truth_worst_m < 0.4 && kept.estimate_worst_m < 0.25, "{seed}: {kept:?}");
        assert!(kept.heading_deg < 2.5, "{seed}: {kept:?}");
    }
}

#[test]
fn a_tag_that_comes_back_does_not_jolt_the_drone() {
    let (quiet, _) = hover(6, false, "");
    // Not for so long that it looks for it.
    let (kept, _) = hover(6, false, "+60 tag-gone 1\n+125 tag 0.05 -0.05 120");
    assert!(kept.estimate_worst_m > 0.2, "it had drifted: {kept:?}");
    assert!(kept.jolt_m_s < quiet.jolt_m_s + 0.02, "{kept:?}, and without {quiet:?}");
}

#[test]
fn a_heading_that_jumps_above_a_tag_changes_nothing() {
    let (kept, flight) = hover(2, false, "+60 lie heading 160 for 3600");
    assert!(flight.outcome.to_string().contains("battery"), "{}", flight.outcome);
    assert!(kept.truth_worst_m < 0.15 && kept.heading_deg < 2.0, "{kept:?}");
}

#[test]
fn a_tag_that_is_dragged_away_does_not_take_the_drone_along() {
    let mut scenario = String::new();
    for step in 0..400 {
        let way_m = 0.02 * f64::from(step);
        let at_s = 60.0 + 10.0 * way_m;
        _ = writeln!(scenario, "+{at_s:.2} tag-moved 1 {:.2} -0.05 120", 0.05 + way_m);
    }
    let (kept, flight) = hover(1, false, &scenario);
    assert!(flight.outcome.to_string().contains("uncertain"), "it knows: {}", flight.outcome);
    assert!(kept.truth_worst_m < 3.0, "{kept:?}");
}

#[test]
fn a_tag_that_is_turned_in_place_does_not_turn_the_world() {
    // By 30 degrees at once, and by half a degree per second for five minutes.
    let at_once = "+90 tag-moved 1 0.05 -0.05 150".to_owned();
    let mut slowly = String::new();
    for step in 0..=1500 {
        let (at_s, turned_deg) = (60.0 + 0.2 * f64::from(step), 0.1 * f64::from(step));
        let heading_deg = wrap_deg(120.0 + turned_deg);
        _ = writeln!(slowly, "+{at_s:.1} tag-moved 1 0.05 -0.05 {heading_deg:.1}");
    }
    for (scenario, most_deg) in [(at_once, 8.0), (slowly, 15.0)] {
        let (kept, flight) = hover(1, false, &scenario);
        assert!(flight.outcome.to_string().contains("battery"), "{}", flight.outcome);
        assert!(kept.heading_deg < most_deg, "{kept:?}");
        assert!(kept.truth_worst_m < 0.15 && kept.estimate_worst_m < 0.1, "{kept:?}");
    }
}

/// Whether the flight reports that the drone does not look for tags.
#[test]
fn tags_are_looked_for_only_if_they_are_used() {
    let detects = |tags: Option<TagConfig>| {
        let mut pilot = VehicleConfig::default();
        pilot.estimator.tags = tags;
        let simulation = Simulation {
            world: WorldConfig {
                tags: vec![FloorTag::new(0.0, 0.0, 0.0)],
                ..WorldConfig::default()
            },
            pilot,
            ..Simulation::default()
        };
        let mut seen = false;
        let watch = |moment: &Moment| {
            seen |= moment.status.tags.is_some_and(|tags| tags.known.count() > 0);
        };
        let flight = simulation.fly_watched(plan("takeoff\ngoto 0 0 0.5 0\nland"), watch).unwrap();
        let happened =
            |wanted: fn(&FlightEvent) -> bool| flight.events.iter().any(|(_, e)| wanted(e));
        assert!(!happened(|event| *event == FlightEvent::NoTagDetection));
        seen
    };
    assert!(detects(Some(TagConfig::default())));
    assert!(!detects(None));
}
