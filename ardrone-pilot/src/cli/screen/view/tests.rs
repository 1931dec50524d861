//! What the screen shows.

use std::collections::BTreeSet;

use kinematics::Pose;
use ratatui::Terminal;
use ratatui::backend::TestBackend;

use super::*;
use autopilot::agent::ChosenPlans;
use autopilot::plan::Plan;
use autopilot::vehicle::{CrossCheck, KnownTag, TagStatus, Trust, VehicleName, Veto};
use kinematics::Airframe;

/// A drone on its way to a target, which it has flown this share of.
fn status(share: f64) -> Status {
    let target = Pose { x_m: 1.0, y_m: 1.0, z_m: 0.85, yaw_deg: 0.0 };
    Status {
        phase: Phase::Flying,
        step: Some(2),
        steps: 4,
        steps_done: Some(2),
        mission_waits: false,
        landing: None,
        emergency: false,
        airborne: true,
        flight_time: None,
        camera: None,
        altitude_m: None,
        manual: None,
        controls: None,
        pose: Some(Pose { x_m: share, y_m: 1.0, z_m: 0.84, yaw_deg: 0.0 }),
        velocity_m_s: Some([0.5, 0.0, 0.0]),
        target: Some(target),
        distance_m: Some(1.0 - share),
        battery_percent: Some(87),
        battery_v: Some(11.9),
        turn_rate_deg_s: Some(0.0),
        uncertainty_m: 0.12,
        rests_on: RestsOn::Velocity,
        contradicted_by: None,
        height_uncertainty_m: 0.02,
        tags: None,
        gps: None,
        trust: Trust::Sound,
        airframe: Airframe::default(),
        navdata_age: Some(Duration::from_millis(40)),
        navdata_hz: 15.0,
        attitude_deg: Some([2.5, -1.0]),
        plans: ChosenPlans::default(),
        command: Some("Goto"),
    }
}

fn message(at: Duration, telemetry: Telemetry, ticks: TickHealth) -> Message {
    let content = Content::Telemetry(at, telemetry, ticks);
    Message { vehicle: VehicleName::default(), content }
}

#[test]
fn the_screen_shows_the_flight() {
    let plan = Plan::parse("p", "takeoff\ngoto 0 1 0 0\ngoto 1 1 0 0\nland\n").unwrap();
    let mut view = View::new(&FlightLimits::default());
    let steps = plan.steps().to_vec();
    let ticks = TickHealth { lateness: Duration::from_micros(230), skipped: 1 };
    let mut tell = |at, telemetry| view.take_in(&message(at, telemetry, ticks));
    tell(
        Duration::ZERO,
        Telemetry::Mission { name: String::new(), id: None, steps, steps_done: Some(0) },
    );
    for tick in 0..40_u32 {
        let status = status(f64::from(tick) / 40.0);
        tell(Duration::from_millis(u64::from(tick) * 90), Telemetry::Status(status));
    }
    let started = FlightEvent::StepStarted { step: 2 };
    tell(Duration::from_secs(3), Telemetry::Event(started));
    tell(Duration::from_secs(4), Telemetry::Event(FlightEvent::LinkLost));
    let mut terminal = Terminal::new(TestBackend::new(90, 26)).unwrap();
    terminal.draw(|frame| draw(frame, &Views::alone(&view))).unwrap();
    insta::assert_snapshot!(terminal.backend());
    // Any size must be drawn without a panic.
    for (columns, rows) in [(1, 1), (20, 5), (300, 80)] {
        let mut terminal = Terminal::new(TestBackend::new(columns, rows)).unwrap();
        terminal.draw(|frame| draw(frame, &Views::alone(&view))).unwrap();
    }
}

#[test]
fn tags_have_a_table_and_marks_on_eighty_columns() {
    let tag = |id: u32, x_m, seen_s: Option<u64>| KnownTag {
        id,
        place_m: [x_m, 0.4].into(),
        heading_deg: seen_s.map(|_| 120.0),
        uncertainty_m: 0.2,
        surveyed: id == 1,
        seen_ago: seen_s.map(Duration::from_secs),
    };
    let known = [tag(1, -2.0, None), tag(2, 0.3, Some(40)), tag(3, 0.9, Some(0))];
    let tags = TagStatus {
        known: known.into_iter().collect(),
        seen_ago: Some(Duration::from_millis(300)),
        ..TagStatus::default()
    };
    let mut view = View::new(&FlightLimits::default());
    let rests_on = RestsOn::of(Some(&tags));
    let status = Status { tags: Some(tags), rests_on, ..status(0.5) };
    let (at, status) = (Duration::from_secs(3), Telemetry::Status(status));
    view.take_in(&message(at, status, TickHealth::default()));
    let mut terminal = Terminal::new(TestBackend::new(80, 24)).unwrap();
    terminal.draw(|frame| draw(frame, &Views::alone(&view))).unwrap();
    insta::assert_snapshot!(terminal.backend());
}

/// Words of the screen: of what is cut in the middle of a word, another one is left.
fn words(view: &View, columns: u16, rows: u16) -> BTreeSet<String> {
    let mut terminal = Terminal::new(TestBackend::new(columns, rows)).unwrap();
    terminal.draw(|frame| draw(frame, &Views::alone(view))).unwrap();
    let shown = terminal.backend().to_string();
    // The map is drawn with dots.
    let is_drawn =
        |letter| "│┌┐└┘─\"█▉▊▋▌▍▎▏".contains(letter) || ('\u{2800}'..='\u{28ff}').contains(&letter);
    let words = shown.split(|letter: char| letter.is_whitespace() || is_drawn(letter));
    words.filter(|word| word.chars().any(char::is_alphanumeric)).map(str::to_owned).collect()
}

#[test]
fn on_eighty_columns_no_word_is_cut() {
    let mut view = View::new(&FlightLimits::default());
    let text = "takeoff\ngoto -9.125 -0.0625 -0.4375 -179.5 # to the far end of the hall\nland\n";
    let steps = Plan::parse("p", text).unwrap().steps().to_vec();
    let mut tell = |telemetry| {
        view.take_in(&message(Duration::from_secs(612), telemetry, TickHealth::default()));
    };
    tell(Telemetry::Mission { name: String::new(), id: None, steps, steps_done: Some(0) });
    let far = Pose { x_m: -9.125, y_m: -8.25, z_m: 2.85, yaw_deg: -179.0 };
    for (contradicted_by, manual) in
        [(None, Some(ManualControl::Hold)), (Some(CrossCheck::Gps), Some(ManualControl::Sticks))]
    {
        let status = Status {
            pose: Some(far),
            target: Some(far),
            distance_m: Some(12.5),
            uncertainty_m: 12.25,
            mission_waits: true,
            manual,
            contradicted_by,
            ..status(0.5)
        };
        tell(Telemetry::Status(status));
    }
    tell(Telemetry::Event(FlightEvent::Veto(Veto::CarriedOff)));
    view.decisions.clear();
    let decision = "Goto: +!approach 297, +!watchTheBattery 148, +!somethingElse 1234";
    view.decisions.push_back((Duration::from_secs(612), decision.to_owned()));
    view.not_ready = vec!["the drone has not applied its setting control:altitude_max".to_owned()];
    let (narrow, wide) = (words(&view, 80, 24), words(&view, 240, 60));
    // Their lines are clipped, not their words.
    let cut: Vec<&String> = narrow.difference(&wide).filter(|word| *word != "…").collect();
    assert!(cut.is_empty(), "{cut:?}");
    for word in ["uncertainty", "CONTRADICTED:", "hand", "control:altitude_max", "1234"] {
        assert!(narrow.contains(word), "{word}: {narrow:?}");
    }
}

/// Each has its number on the map and in the list; one is shown in full, and warnings of the others reach it.
#[test]
fn a_fleet_is_shown_with_one_vehicle_in_full() {
    let named = |name: &str, share: f64| {
        let mut view = View::new(&FlightLimits::default());
        let status = Telemetry::Status(status(share));
        view.take_in(&message(Duration::from_secs(9), status, TickHealth::default()));
        (name.parse().unwrap(), view)
    };
    let mut views = Views {
        all: vec![named("left", -1.0), named("right", 0.2)],
        elsewhere: Vec::new(),
        shown: 1,
    };
    let lost = Status { navdata_age: Some(Duration::from_secs(2)), ..status(-1.0) };
    views.all[0].1.status = Some(lost);
    let mut terminal = Terminal::new(TestBackend::new(80, 24)).unwrap();
    terminal.draw(|frame| draw(frame, &views)).unwrap();
    insta::assert_snapshot!(terminal.backend());
}
