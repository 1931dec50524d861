use autopilot::plan::Border;
use proptest::prelude::*;

use super::*;
use crate::mission::command::*;
use crate::mission::tests::{item, written};
use crate::place::ABSENT;

const LIMITS: FlightLimits = FlightLimits::new(Border::circle(10.0), 0.3, 3.0);
const RULES: Rules = Rules {
    origin: Origin {
        latitude_deg: 47.397_742,
        longitude_deg: 8.545_594,
        altitude_m: 488.0,
        heading_deg: 0.0,
    },
    fence: LIMITS,
    max_speed_m_s: 2.2,
};
const NED: u8 = 1;
const MISSION: u8 = 2;
const RELATIVE: u8 = 3;
const FRD: u8 = 20;
const GCS: u8 = 190;

/// An item at a place right and forward of the start, in a local frame.
fn at(command: u16, x_m: i32, y_m: i32, z_m: f32) -> Item {
    Item { x: y_m * 10_000, y: x_m * 10_000, z: -z_m, ..item(0, FRD, command) }
}

fn take_off() -> Item {
    Item { z: 1.5, ..item(0, RELATIVE, NAV_TAKEOFF) }
}

fn numbered(items: &[Item]) -> Vec<Item> {
    (0..).zip(items).map(|(seq, item)| Item { seq, ..*item }).collect()
}

fn translated_by(items: &[Item], rules: &Rules) -> Result<Translated, Problem> {
    translate(&numbered(items), GCS, rules)
}

fn translated(items: &[Item]) -> Translated {
    translated_by(items, &RULES).unwrap()
}

/// The commands without settings.
#[track_caller]
fn assert_flown(items: &[Item], expected: &[&str]) {
    let text = written(&translated(items).steps_from(0, false));
    let lines = text.lines().filter(|line| !line.starts_with("set"));
    assert_eq!(lines.collect::<Vec<_>>(), expected);
}

#[track_caller]
fn assert_problem(items: &[Item], result: MavMissionResult, reason: &str) {
    let problem = translated_by(items, &RULES).unwrap_err();
    assert_eq!(problem.result, result, "{problem}");
    assert!(problem.reason.contains(reason), "{problem}");
    assert!(problem.reason.starts_with(&format!("item {}", problem.item)), "{problem}");
    assert!(problem.reason.len() <= 200);
}

#[test]
fn what_is_moved_into_the_limits_is_told() {
    let speed = |m_s| Item { param1: 1.0, param2: m_s, ..item(0, MISSION, DO_CHANGE_SPEED) };
    let high = Item { z: 50.0, ..take_off() };
    let found = translated(&[high, speed(0.5), speed(9.0), at(NAV_WAYPOINT, 1, 2, 1.2)]);
    assert_eq!(
        found.limited(),
        [
            "item 0 (Takeoff): altitude 0.85 m, not 50.00",
            "item 2 (Change speed): speed 2.20 m/s, not 9.00"
        ]
    );
    assert!(found.limited().iter().all(|note| note.len() <= 100));
    assert!(translated(&[take_off(), speed(0.5)]).limited().is_empty());
}

#[test]
fn a_mission_is_a_whole_program() {
    let mission = [
        take_off(),
        Item { param1: 1.0, param2: 0.5, ..item(0, MISSION, DO_CHANGE_SPEED) },
        Item { param1: 2.0, param2: 1.0, param4: 90.0, ..at(NAV_WAYPOINT, 1, 2, 1.2) },
        item(0, MISSION, NAV_RETURN_TO_LAUNCH),
    ];
    let steps = translated(&mission).steps_from(0, false);
    let items: Vec<u16> = steps.iter().map(|step| step.item).collect();
    let expected = "setReference $START$\nsetSpeed 2.2\ntakeoff\n\
                    setInitialReachDist 0.2\nsetStayWithinDist 0.5\nsetStayTime 0.3\ngoto 0 0 1.5 0\n\
                    setSpeed 0.5\n\
                    setInitialReachDist 1\nsetStayWithinDist 1.3\nsetStayTime 2\ngoto 1 2 1.2 90\n\
                    setInitialReachDist 0.2\nsetStayWithinDist 0.5\nsetStayTime 0.3\ngoto 0 0 1.2 90\n\
                    land\n";
    assert_eq!(written(&steps), expected);
    assert_eq!(items, [0, 0, 0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 3, 3, 3, 3, 3]);
    // A stay in the middle begins with the way to its place.
    let delay = Item { param1: 5.0, ..item(0, MISSION, NAV_DELAY) };
    let mission = [take_off(), at(NAV_WAYPOINT, 1, 0, 1.0), delay];
    let text = written(&translated(&mission).steps_from(2, true));
    assert!(text.ends_with("setStayTime 5\ngoto 1 0 1 0\n"), "{text}");
    assert_eq!(translated(&[]).steps_from(0, false), []);
}

#[test]
fn a_take_off_climbs_to_the_height_of_its_item() {
    assert_flown(&[take_off()], &["takeoff", "goto 0 0 1.5 0"]);
    // Without a height there is only the take-off; too high or low is moved into the fence.
    for z in [0.0, f32::NAN] {
        assert_flown(&[Item { z, ..take_off() }], &["takeoff"]);
    }
    // Outside the limits it is the vehicle's own: the way to the ceiling is nobody's wish.
    for z in [3.048, 10.0, 0.1] {
        assert_flown(&[Item { z, ..take_off() }], &["takeoff", "goto 0 0 0.85 0"]);
    }
    assert_flown(&[Item { z: 3.01, ..take_off() }], &["takeoff", "goto 0 0 3 0"]);
    assert_flown(&[Item { z: 490.0, frame: 0, ..take_off() }], &["takeoff", "goto 0 0 2 0"]);
    // Near the start, or nowhere.
    assert_flown(&[at(NAV_TAKEOFF, 1, 2, 1.0)], &["takeoff", "goto 1 2 1 0"]);
    let nowhere = Item { x: ABSENT, y: ABSENT, ..take_off() };
    assert_flown(&[nowhere], &["takeoff", "goto 0 0 1.5 0"]);
    assert_flown(&[Item { param4: 90.0, ..take_off() }], &["takeoff", "goto 0 0 1.5 90"]);
    // The local one has radians.
    let local = Item { param4: std::f32::consts::FRAC_PI_2, ..at(NAV_TAKEOFF_LOCAL, 0, 1, 1.0) };
    assert_flown(&[local], &["takeoff", "goto 0 1 1 90"]);
    let again = [at(NAV_WAYPOINT, 1, 0, 1.0), take_off()];
    assert_flown(&again, &["takeoff", "goto 1 0 1 0", "goto 1 0 1.5 0"]);
    assert_problem(
        &[at(NAV_TAKEOFF, 11, 0, 1.0)],
        result::INVALID_PARAM5_X,
        "11.00 m from the start, beyond the fence of 10 m",
    );
}

#[test]
fn a_way_point_is_flown_to_and_held() {
    // A way-point before any take-off: the mission may start in the air.
    let way_point = Item { param1: 2.5, param2: 0.4, ..at(NAV_WAYPOINT, -1, 2, 0.3) };
    let steps = translated(&[way_point]).steps_from(0, true);
    let expected = "setReference $START$\nsetSpeed 2.2\nsetInitialReachDist 0.4\n\
                    setStayWithinDist 0.7\nsetStayTime 2.5\ngoto -1 2 0.3 0\n";
    assert_eq!(written(&steps), expected);
    // NaN keeps the heading of the item before; a place or height that is not given stays.
    let turned = Item { param4: -90.0, ..at(NAV_WAYPOINT, 1, 0, 1.0) };
    let here = Item { x: ABSENT, y: ABSENT, z: f32::NAN, ..at(NAV_WAYPOINT, 0, 0, 0.0) };
    assert_flown(
        &[turned, at(NAV_WAYPOINT, 2, 0, 1.0), here],
        &["takeoff", "goto 1 0 1 -90", "goto 2 0 1 -90", "goto 2 0 1 -90"],
    );
    assert_problem(&[here], result::INVALID_PARAM5_X, "no place");
    let no_height = Item { z: f32::NAN, ..way_point };
    assert_problem(&[no_height], result::INVALID_PARAM7, "no height");
    let all_nan = Item { param1: f32::NAN, param2: f32::NAN, param3: f32::NAN, ..turned };
    assert_flown(&[all_nan], &["takeoff", "goto 1 0 1 -90"]);
    for (param1, param2, result) in [
        (-1.0, 0.0, result::INVALID_PARAM1),
        (601.0, 0.0, result::INVALID_PARAM1),
        (0.0, -1.0, result::INVALID_PARAM2),
    ] {
        assert_problem(&[Item { param1, param2, ..way_point }], result, "");
    }
}

#[test]
fn acceptance_radii_are_within_reason() {
    for (param2, expected) in
        [(0.0, "0.2"), (f32::NAN, "0.2"), (0.01, "0.1"), (0.5, "0.5"), (9.0, "1")]
    {
        let way_point = Item { param2, ..at(NAV_WAYPOINT, 1, 0, 1.0) };
        let text = written(&translated(&[way_point]).steps_from(0, true));
        assert!(text.contains(&format!("setInitialReachDist {expected}\n")), "{text}");
    }
}

#[test]
fn way_points_of_all_frames_are_understood() {
    let origin = Origin { heading_deg: 90.0, ..RULES.origin };
    let rules = Rules { origin, ..RULES };
    for (frame, yaw) in [(0, 180.0), (1, 180.0), (3, 180.0), (4, 180.0), (5, 180.0), (6, 180.0)]
        .into_iter()
        .chain([(20, 90.0), (21, 90.0)])
    {
        let place = Place { ground_m: Some((1.0, 2.0)), z_m: Some(1.5) };
        let (x, y, z) = origin.fields(Frame::from_number(frame).unwrap(), &place);
        let way_point = Item { x, y, z, param4: yaw, ..item(0, frame, NAV_WAYPOINT) };
        let translated = translated_by(&[way_point], &rules).unwrap();
        let Some(Command::GoTo(pose)) = translated.steps.last().map(|step| step.command) else {
            panic!("no way")
        };
        assert!((pose.x_m - 1.0).abs() < 0.012 && (pose.y_m - 2.0).abs() < 0.012, "{pose:?}");
        assert!((pose.z_m - 1.5).abs() < 1e-4 && (pose.yaw_deg - 90.0).abs() < 1e-9, "{pose:?}");
    }
    let frame = |frame| [Item { frame, ..take_off() }, Item { frame, ..take_off() }];
    for number in [10, 11] {
        assert_problem(&frame(number), result::UNSUPPORTED_FRAME, "terrain");
    }
    assert_problem(&frame(12), result::UNSUPPORTED_FRAME, "frame 12 is not supported");
    let nowhere = [item(0, MISSION, NAV_WAYPOINT)];
    assert_problem(&nowhere, result::UNSUPPORTED_FRAME, "a way-point needs a frame with a place");
}

#[test]
fn a_loiter_stays_at_its_place_or_here() {
    let loiter = Item { param1: 5.0, param4: 1.0, ..at(NAV_LOITER_TIME, 1, 0, 1.0) };
    let text = written(&translated(&[loiter]).steps_from(0, true));
    assert!(text.ends_with("setStayTime 5\ngoto 1 0 1 0\n"), "{text}");
    let here = Item { param1: 7.0, ..item(0, RELATIVE, NAV_LOITER_TIME) };
    let text = written(&translated(&[loiter, here]).steps_from(0, true));
    assert!(text.ends_with("setStayTime 7\ngoto 1 0 1 0\n"), "{text}");
    let text = written(&translated(&[here]).steps_from(0, true));
    assert!(text.ends_with("setStayTime 7\nmoveByRel 0 0 0 0\n"), "{text}");
    // Higher at the same place.
    let above = Item { z: 2.0, ..here };
    assert_flown(&[loiter, above], &["takeoff", "goto 1 0 1 0", "goto 1 0 2 0"]);
    let long = Item { param1: 1e9, ..loiter };
    assert_problem(&[long], result::INVALID_PARAM1, "1e9 s is not between 0 and 600");
}

#[test]
fn an_endless_loiter_is_the_end() {
    let endless = at(NAV_LOITER_UNLIM, 1, 0, 1.0);
    assert_flown(&[take_off(), endless], &["takeoff", "goto 0 0 1.5 0", "goto 1 0 1 0"]);
    assert_problem(
        &[endless, at(NAV_WAYPOINT, 1, 0, 1.0)],
        result::UNSUPPORTED,
        "item 1 (Waypoint): nothing is flown behind the endless hold of item 0",
    );
    let here = item(0, MISSION, NAV_LOITER_UNLIM);
    assert_flown(&[take_off(), here], &["takeoff", "goto 0 0 1.5 0", "goto 0 0 1.5 0"]);
}

#[test]
fn a_delay_stays() {
    let delay = Item { param1: 3.0, param2: -1.0, ..item(0, MISSION, NAV_DELAY) };
    for command in [NAV_DELAY, CONDITION_DELAY] {
        let text =
            written(&translated(&[take_off(), Item { command, ..delay }]).steps_from(0, false));
        assert!(text.ends_with("goto 0 0 1.5 0\nsetStayTime 3\ngoto 0 0 1.5 0\n"), "{text}");
    }
    let clock = Item { param1: -1.0, ..delay };
    assert_problem(&[clock], result::INVALID_PARAM1, "time of day");
    let wrong = Item { command: CONDITION_DELAY, ..clock };
    assert_problem(&[wrong], result::INVALID_PARAM1, "-1 s");
}

#[test]
fn a_turn_is_on_the_spot() {
    let turn = |angle, direction, relative| Item {
        param1: angle,
        param3: direction,
        param4: relative,
        ..item(0, MISSION, CONDITION_YAW)
    };
    let facing = Item { param4: 90.0, ..at(NAV_WAYPOINT, 1, 0, 1.0) };
    let last = |turn| {
        let text = written(&translated(&[facing, turn]).steps_from(1, true));
        let yaws = text.lines().filter_map(|line| line.strip_prefix("goto 1 0 1 "));
        yaws.map(|yaw| yaw.parse().unwrap()).collect::<Vec<f64>>()
    };
    assert_eq!(last(turn(45.0, 0.0, 0.0)), [45.0]);
    assert_eq!(last(turn(45.0, f32::NAN, f32::NAN)), [45.0]);
    assert_eq!(last(turn(45.0, 0.0, 1.0)), [135.0]);
    assert_eq!(last(turn(45.0, -1.0, 1.0)), [45.0]);
    assert_eq!(last(turn(45.0, 1.0, 1.0)), [135.0]);
    // The long way round, in parts.
    assert_eq!(last(turn(0.0, 1.0, 0.0)), [-180.0, -90.0, 0.0]);
    assert_eq!(last(turn(0.0, -1.0, 0.0)), [0.0]);
    assert_eq!(last(turn(180.0, -1.0, 0.0)), [0.0, -90.0, -180.0]);
    assert_eq!(last(turn(360.0, 1.0, 1.0)), [-150.0, -30.0, 90.0]);
    assert_eq!(last(turn(90.0, 1.0, 0.0)), [90.0]);
    for (wrong, result) in [
        (turn(361.0, 0.0, 0.0), result::INVALID_PARAM1),
        (turn(f32::NAN, 0.0, 0.0), result::INVALID_PARAM1),
        (turn(1.0, 2.0, 0.0), result::INVALID_PARAM3),
        (turn(1.0, 0.0, 0.5), result::INVALID_PARAM4),
    ] {
        assert_problem(&[facing, wrong], result, "item 1");
    }
    assert_problem(&[turn(1.0, 0.0, 0.0)], result::DENIED, "a turn needs");
}

#[test]
fn the_speed_is_limited() {
    let speed = |param1, param2| Item { param1, param2, ..item(0, MISSION, DO_CHANGE_SPEED) };
    let way_point = at(NAV_WAYPOINT, 1, 0, 1.0);
    for (wanted, expected) in
        [(1.0, "1"), (0.0, "0.1"), (9.0, "1.5"), (-2.0, "1.5"), (-1.0, "0.5"), (f32::NAN, "0.5")]
    {
        let rules = Rules { max_speed_m_s: 1.5, ..RULES };
        let mission = [way_point, speed(1.0, 0.5), speed(0.0, wanted), way_point];
        let text = written(&translated_by(&mission, &rules).unwrap().steps_from(3, true));
        assert!(text.contains(&format!("setSpeed {expected}\n")), "{wanted}: {text}");
    }
    assert_problem(&[speed(2.0, 1.0)], result::INVALID_PARAM1, "parameter 1 is 2");
    assert_problem(&[speed(1.0, -3.0)], result::INVALID_PARAM2, "negative");
    assert_problem(&[speed(1.0, f32::INFINITY)], result::INVALID_PARAM2, "infinite");
}

#[test]
fn a_return_lands_at_the_start() {
    let home = item(0, MISSION, NAV_RETURN_TO_LAUNCH);
    let way_point = Item { param4: 30.0, ..at(NAV_WAYPOINT, 1, 0, 1.2) };
    assert_flown(&[way_point, home], &["takeoff", "goto 1 0 1.2 30", "goto 0 0 1.2 30", "land"]);
    assert_problem(&[home, way_point], result::UNSUPPORTED, "behind the landing of item 0");
}

#[test]
fn a_landing_is_at_its_place_or_here() {
    let way_point = at(NAV_WAYPOINT, 1, 0, 1.2);
    let there = &["takeoff", "goto 1 0 1.2 0", "goto 2 3 1.2 0", "land"];
    assert_flown(&[way_point, at(NAV_LAND, 2, 3, 0.0)], there);
    assert_flown(&[way_point, at(NAV_LAND_LOCAL, 2, 3, 0.0)], there);
    let here = &["takeoff", "goto 1 0 1.2 0", "land"];
    for land in [
        item(0, RELATIVE, NAV_LAND),
        item(0, MISSION, NAV_LAND),
        Item { x: ABSENT, y: ABSENT, z: f32::NAN, ..item(0, 6, NAV_LAND) },
        Item { x: ABSENT, y: ABSENT, z: f32::NAN, ..item(0, NED, NAV_LAND_LOCAL) },
    ] {
        assert_flown(&[way_point, land], here);
    }
    // In a local frame zeros are the start.
    let start = &["takeoff", "goto 1 0 1.2 0", "goto 0 0 1.2 0", "land"];
    assert_flown(&[way_point, item(0, NED, NAV_LAND)], start);
    assert_problem(&[at(NAV_LAND, 0, -20, 0.0)], result::INVALID_PARAM5_X, "20.00 m");
    let behind = [item(0, MISSION, NAV_LAND), take_off()];
    assert_problem(&behind, result::UNSUPPORTED, "behind the landing of item 0");
}

#[test]
fn other_commands_are_refused_by_name() {
    for (command, reason) in [
        (177, "DO_JUMP"),
        (530, "camera"),
        (2000, "camera"),
        (2001, "camera"),
        (1000, "gimbal"),
        (1001, "gimbal"),
        (195, "regions of interest"),
        (201, "regions of interest"),
        (18, "circles"),
        (82, "splines"),
        (65_000, "command 65000 is not supported"),
    ] {
        assert_problem(&[take_off(), item(0, MISSION, command)], result::UNSUPPORTED, reason);
    }
}

#[test]
fn the_fence_is_respected_to_a_centimetre() {
    let outside = [take_off(), at(NAV_WAYPOINT, 8, 9, 1.0)];
    assert_problem(&outside, result::INVALID_PARAM5_X, "item 1 (Waypoint): 12.04 m from the start");
    for z_m in [0.2, 3.1, -1.0] {
        assert_problem(
            &[at(NAV_WAYPOINT, 1, 0, z_m)],
            result::INVALID_PARAM7,
            "between 0.3 and 3 m",
        );
    }
    // On the edge by the grid of latitudes or a sea level in 32 bits.
    let edge = Item { x: 100_100, ..at(NAV_WAYPOINT, 0, 0, 1.0) };
    assert_flown(&[edge], &["takeoff", "goto 0 9.9998 1 0"]);
    let (x, y) = (473_977_420, 85_455_940);
    let low = Item { x, y, z: 488.3, ..item(0, 0, NAV_WAYPOINT) };
    assert_flown(&[low], &["takeoff", "goto 0 0 0.3 0"]);
    let elsewhere = Item { z: 1.0, ..item(0, RELATIVE, NAV_WAYPOINT) };
    assert_problem(&[elsewhere], result::INVALID_PARAM5_X, "beyond the fence");
}

#[test]
fn a_straight_way_that_leaves_a_polygon_is_refused() {
    let corners_m = [[-2.0, -2.0], [1.0, -2.0], [1.0, 1.0], [4.0, 1.0], [4.0, 4.0], [-2.0, 4.0]];
    let rules =
        Rules { fence: FlightLimits::new(Border::polygon(&corners_m).unwrap(), 0.3, 3.0), ..RULES };
    let there = at(NAV_WAYPOINT, 3, 2, 1.0);
    let direct = [take_off(), at(NAV_WAYPOINT, 0, -1, 1.0), there];
    let problem = translated_by(&direct, &rules).unwrap_err();
    assert_eq!((problem.item, problem.result), (2, result::INVALID_PARAM5_X));
    assert!(problem.reason.contains("the straight way"), "{problem}");
    let around = [take_off(), at(NAV_WAYPOINT, 0, -1, 1.0), at(NAV_WAYPOINT, 0, 2, 1.0), there];
    assert!(translated_by(&around, &rules).is_ok());
    let outside = translated_by(&[take_off(), at(NAV_WAYPOINT, 2, 0, 1.0)], &rules).unwrap_err();
    assert!(outside.reason.contains("1.00 m outside the fence"), "{outside}");
}

#[test]
fn infinite_numbers_are_refused_and_named() {
    let way_point = at(NAV_WAYPOINT, 1, 0, 1.0);
    let inf = f32::INFINITY;
    for (wrong, result) in [
        (Item { param1: inf, ..way_point }, result::INVALID_PARAM1),
        (Item { param2: -inf, ..way_point }, result::INVALID_PARAM2),
        (Item { param3: inf, ..way_point }, result::INVALID_PARAM3),
        (Item { param4: inf, ..way_point }, result::INVALID_PARAM4),
        (Item { z: -inf, ..way_point }, result::INVALID_PARAM7),
        (Item { x: ABSENT, ..way_point }, result::INVALID_PARAM5_X),
        (Item { y: ABSENT, ..way_point }, result::INVALID_PARAM6_Y),
    ] {
        assert_problem(&[wrong], result, "");
    }
}

#[test]
fn items_are_counted() {
    let way_point = at(NAV_WAYPOINT, 1, 0, 1.0);
    assert!(translated_by(&[way_point; 200], &RULES).is_ok());
    assert_problem(&[way_point; 201], result::NO_SPACE, "item 200 (Waypoint): at most 200 items");
    let problem = translate(&[way_point, way_point], GCS, &RULES).unwrap_err();
    assert_eq!((problem.item, problem.result), (1, result::INVALID_SEQUENCE));
    let fence = Item { mission_type: 1, ..way_point };
    assert_problem(&[fence], result::UNSUPPORTED, "fence");
}

#[test]
fn the_home_of_mavproxy_is_no_way_point() {
    let (x, y) = (473_977_420, 85_455_940);
    let home = Item { x, y, z: 488.0, current: 1, ..item(0, 0, NAV_WAYPOINT) };
    let mission = numbered(&[home, take_off()]);
    let steps = translate(&mission, MAVPROXY, &RULES).unwrap().steps_from(0, false);
    assert!(!written(&steps).contains("goto 0 0 0.3"), "{steps:?}");
    assert_eq!(steps.iter().map(|step| step.item).max(), Some(1));
    // Others mean a place by it, and so does MAVProxy in other frames, later, or further away.
    assert!(translate(&mission, GCS, &RULES).is_err());
    for other in [
        [Item { frame: 3, ..home }, take_off()],
        [take_off(), home],
        [Item { x: x + 300, ..home }, take_off()],
        [Item { command: NAV_LOITER_TIME, ..home }, take_off()],
    ] {
        assert!(translate(&numbered(&other), MAVPROXY, &RULES).is_err(), "{other:?}");
    }
}

fn any_item() -> impl Strategy<Value = Item> {
    let number = || {
        prop_oneof![
            Just(0.0_f32),
            Just(1.0_f32),
            Just(-1.0_f32),
            Just(f32::NAN),
            -5.0_f32..5.0,
            any::<f32>(),
        ]
    };
    let commands = vec![16, 16, 16, 17, 19, 20, 21, 22, 22, 23, 24, 93, 112, 115, 115, 178, 177];
    let coordinate = || prop_oneof![-60_000..60_000_i32, Just(0), Just(ABSENT), any::<i32>()];
    (
        prop::sample::select(vec![0, 1, 2, 3, 4, 5, 6, 20, 21, 20, 21, 10, 99]),
        prop_oneof![8 => prop::sample::select(commands), 1 => any::<u16>()],
        (number(), number(), number(), number()),
        (coordinate(), coordinate(), number()),
    )
        .prop_map(|(frame, command, (param1, param2, param3, param4), (x, y, z))| Item {
            param1,
            param2,
            param3,
            param4,
            z,
            x,
            y,
            ..item(0, frame, command)
        })
}

/// Checks steps as the plan language would.
fn assert_flies(steps: &[Step], mut airborne: bool) {
    assert!(steps.is_sorted_by_key(|step| step.item));
    let lines = written(steps).lines().count();
    assert_eq!(lines, steps.len());
    let mut has_landed = false;
    for step in steps {
        match step.command {
            Command::SetReferenceStart => {}
            TAKE_OFF => assert!(!std::mem::replace(&mut airborne, true)),
            Command::SetSpeed { speed_m_s } => assert!((0.1..=2.2).contains(&speed_m_s)),
            Command::SetReachDistance { distance_m } => assert!((0.1..=1.0).contains(&distance_m)),
            Command::SetStayDistance { distance_m } => assert!((0.5..=1.3).contains(&distance_m)),
            Command::SetStayTime { time_s } => assert!((0.0..=600.0).contains(&time_s)),
            Command::GoTo(Pose { x_m, y_m, z_m, yaw_deg }) => {
                assert!(airborne && !has_landed);
                assert!(x_m.hypot(y_m) <= 10.0 && (0.3..=3.0).contains(&z_m), "{step:?}");
                assert!((-180.0..=180.0).contains(&yaw_deg), "{step:?}");
            }
            Command::MoveByRelative(by) => assert!(airborne && by == Pose::default()),
            Command::Land => assert!(airborne && !std::mem::replace(&mut has_landed, true)),
            _ => panic!("unknown: {step:?}"),
        }
    }
}

proptest! {
    #[test]
    fn any_mission_is_inside_the_fence_or_refused(
        items in prop::collection::vec(any_item(), 0..6),
        first in 0_u16..7,
        airborne: bool,
    ) {
        // Each item alone, too: long random missions are seldom right.
        let whole = numbered(&items);
        for items in std::iter::once(&whole[..]).chain(whole.chunks(1)) {
            match translated_by(items, &RULES) {
                Ok(translated) => {
                    let steps = translated.steps_from(first, airborne);
                    prop_assert!(steps.iter().all(|step| step.item >= first));
                    assert_flies(&steps, airborne);
                    assert_flies(&translated.steps_from(0, airborne), airborne);
                }
                Err(problem) => {
                    prop_assert!(usize::from(problem.item) < items.len());
                    prop_assert!(problem.reason.len() <= 200, "{problem}");
                }
            }
        }
    }
}
