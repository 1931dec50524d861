//! Tags in the flight log and in the report.

use std::time::Duration;

use ardrone_pilot::recording::{Log, Tag};
use ardrone_pilot::replay::Replay;
use ardrone_pilot::report;
use autopilot::vehicle::{SurveyedTag, TagConfig, VehicleConfig};
use mock_drone::{FloorTag, WorldConfig};
use nalgebra::Vector2;
use system_tests::sim::Simulation;

use crate::recording::recorded;

/// A tag below the start, which is found, and one that is surveyed and far away.
pub(crate) fn with_tags() -> Simulation {
    let mut pilot = VehicleConfig::default();
    let mut tags = TagConfig::default();
    let place_m = Vector2::new(-4.0, 3.0);
    tags.surveyed[0] = Some(SurveyedTag { place_m, heading_deg: Some(-90.0) });
    pilot.estimator.tags = Some(tags);
    let tags = vec![FloorTag::new(0.05, -0.05, 30.0)];
    Simulation {
        pilot,
        world: WorldConfig { tags, ..WorldConfig::default() },
        ..Simulation::default()
    }
}

#[test]
fn tags_are_logged_once_a_second_and_when_one_is_found_and_replay_the_same() {
    let (_, file) = recorded("takeoff\ngoto 0 0 0.6 0\nland", &with_tags());
    let mut log = Log::read(&file).unwrap();
    let moments: Vec<(Duration, &[Tag])> =
        log.tags().map(|(at, tags)| (at, tags.tags.as_slice())).collect();
    let surveyed = moments[0].1[0];
    assert_eq!((moments[0].1.len(), surveyed.id, surveyed.surveyed), (1, 1, true));
    assert_eq!((surveyed.x_m, surveyed.y_m, surveyed.heading_deg), (-4.0, 3.0, Some(-90.0)));
    assert_eq!(surveyed.seen_s, None);
    let mut found = 0;
    for pair in moments.windows(2) {
        let apart = pair[1].0.saturating_sub(pair[0].0);
        let is_new = pair[0].1.len() != pair[1].1.len();
        found += u32::from(is_new);
        let fits = apart >= Duration::from_secs(1) && apart < Duration::from_millis(1100);
        assert!(fits || is_new && apart < Duration::from_secs(1), "{pair:?}");
    }
    assert_eq!(found, 1, "{moments:?}");
    let last = moments.last().unwrap().1[1];
    assert!(last.id == 2 && !last.surveyed && last.seen_s.is_some(), "{last:?}");
    assert!((last.x_m - 0.05).hypot(last.y_m + 0.05) < 2.0 * last.uncertainty_m, "{last:?}");
    let page = report::html(&log, &[]).unwrap();
    assert!(page.contains("id=\"tagtext\"") && page.contains("\"uncertainty_m\""));
    log.settings = log
        .settings
        .replace("detect = false", "detect = true")
        .replace("surveyed = []", "surveyed = [[-4.0, 3.0, -90.0]]");
    let replay = Replay::new(&log).unwrap();
    assert!(replay.is_same(), "{replay}");
}
