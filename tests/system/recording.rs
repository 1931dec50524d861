//! Flight logs: what is written can be read, also when it was cut off, and flown again.

use std::io::Cursor;
use std::time::Duration;

use autopilot::pilot::{NavdataRate, PilotConfig, PilotOrder};
use autopilot::plan::ZOrigin;
use autopilot::recording::{Entry, Header, Log, LogWriter};
use autopilot::replay::Replay;
use autopilot::report;
use autopilot::settings;
use autopilot::sim::{SimulatedFlight, Simulation};
use serde_json::{Value, json};
use system_tests::{SQUARE, plan};

fn header(text: &str) -> Header {
    Header {
        start: Duration::from_secs(1_700_000_000),
        plan_name: "plan.txt".to_owned(),
        plan: text.to_owned(),
        settings: settings::DEFAULTS.to_owned(),
        z_origin: ZOrigin::Hover,
        drone: "simulated".to_owned(),
    }
}

/// Flies in simulated time and returns the flight with its log.
fn recorded(text: &str, simulation: &Simulation) -> (SimulatedFlight, Vec<u8>) {
    let mut writer = LogWriter::new(Cursor::new(Vec::new()), &header(text)).unwrap();
    let mut written = 0_u32;
    let record = |record| {
        writer.write(&record).unwrap();
        written += 1;
        // As often as in a real flight.
        if written.is_multiple_of(50) {
            writer.flush().unwrap();
        }
    };
    let flight = simulation.fly_recorded(plan(text), record).unwrap();
    (flight, writer.finish().unwrap().into_inner())
}

#[test]
fn a_flight_is_read_back_as_it_was_and_flies_again_the_same() {
    let second = Duration::from_secs(1);
    let orders = vec![
        (7 * second, PilotOrder::Hold),
        (8 * second, PilotOrder::Steer(autopilot::Demand { roll: 0.3, ..Default::default() })),
        (9 * second, PilotOrder::GoTo { x_m: 0.5, y_m: 0.25 }),
        (12 * second, PilotOrder::Resume),
    ];
    let simulation = Simulation { orders, ..Simulation::default() };
    let (flight, file) = recorded(SQUARE, &simulation);
    let log = Log::read(&file).unwrap();
    assert!(log.complete);
    assert_eq!((log.plan.as_str(), log.drone.as_str()), (SQUARE, "simulated"));
    assert!(log.agent.contains("+!land"));
    let (last, tick) = log.ticks().last().unwrap();
    assert_eq!(last, flight.duration);
    assert!(tick.agent.on_ground && tick.datagram.contains("AT*REF="), "{tick:?}");
    let orders = log.entries.iter().filter(|(_, entry)| matches!(entry, Entry::Order(_)));
    assert_eq!(orders.count(), 4);
    let told: Vec<String> = log.events().map(|(_, _, text)| text.to_owned()).collect();
    let happened: Vec<String> = flight.events.iter().map(|(_, event)| event.to_string()).collect();
    assert_eq!(told, happened);
    assert_eq!(log.outcome(), Some((false, flight.outcome.to_string().as_str())));
    let replay = Replay::new(&log).unwrap();
    assert!(replay.is_same(), "{replay}");
    assert_eq!(replay.outcome, Some(flight.outcome));
}

#[test]
fn other_code_is_told_apart() {
    let (_, file) = recorded(SQUARE, &Simulation::default());
    let mut log = Log::read(&file).unwrap();
    log.settings = log.settings.replace("law = \"cascade\"", "law = \"tum\"");
    let replay = Replay::new(&log).unwrap();
    assert!(!replay.is_same());
    assert!(replay.largest_stick_difference > 0.1, "{replay}");
    let first = replay.differences.first().unwrap();
    assert!(first.at > Duration::from_secs(3), "the take-off is the same: {replay}");
    assert!(replay.to_string().contains("then: Goto by"), "{replay}");
}

/// Wherever a process is killed, what was flushed before is there.
#[test]
fn a_log_that_was_cut_off_is_read_as_far_as_it_goes() {
    let (_, file) = recorded(SQUARE, &Simulation::default());
    let whole = Log::read(&file).unwrap().entries.len();
    let mut longest = 0;
    for part in 1..40 {
        let cut = &file[..file.len() * part / 40];
        let log = match Log::read(cut) {
            Ok(log) => log,
            Err(error) => {
                assert!(part < 4, "{part}: {error}");
                continue;
            }
        };
        // Behind the last entry there is an index.
        assert!(!log.complete && (log.entries.len() < whole || part > 35));
        assert!(log.entries.len() >= longest);
        longest = log.entries.len();
    }
    assert!(longest > whole / 2, "{longest} of {whole}");
}

#[test]
fn what_is_no_log_is_refused() {
    let (_, mut file) = recorded(SQUARE, &Simulation::default());
    for bytes in [&b""[..], b"takeoff\nland\n", &file[..7], &[0x89; 4096]] {
        assert!(Log::read(bytes).is_err());
    }
    // Whatever is spoiled, nothing panics.
    for place in (0..file.len()).step_by(file.len() / 500) {
        let old = std::mem::replace(&mut file[place], 0xff);
        _ = Log::read(&file);
        file[place] = old;
    }
}

/// Whether a value keeps a JSON schema, of which ours use `type`, `properties`, `required` and `items`.
fn keeps(rules: &Value, value: &Value, path: &str) {
    let kind = match value {
        Value::Null => "null",
        Value::Bool(_) => "boolean",
        Value::Number(number) if number.is_f64() => "number",
        Value::Number(_) => "integer",
        Value::String(_) => "string",
        Value::Array(_) => "array",
        Value::Object(_) => "object",
    };
    let kinds = rules["type"].to_string();
    let fits = kinds.contains(kind) || (kind == "integer" && kinds.contains("number"));
    assert!(fits, "{path} is a {kind}, not {kinds}");
    for required in rules["required"].as_array().into_iter().flatten() {
        let name = required.as_str().unwrap();
        assert!(value.get(name).is_some(), "{path} has no {name}");
    }
    for (name, part) in value.as_object().into_iter().flatten() {
        let path = format!("{path}.{name}");
        let rules = rules["properties"].get(name);
        keeps(rules.unwrap_or_else(|| panic!("{path} is not told")), part, &path);
    }
    for part in value.as_array().into_iter().flatten() {
        if let Some(rules) = rules.get("items") {
            keeps(rules, part, path);
        }
    }
}

/// Others read it too: JSON with schemas, of which Foxglove knows some.
#[test]
fn each_topic_has_a_schema_that_its_messages_keep() {
    let (_, file) = recorded(SQUARE, &Simulation::default());
    let mut topics = std::collections::BTreeMap::new();
    for message in mcap::MessageStream::new(&file).unwrap() {
        let message = message.unwrap();
        let schema = message.channel.schema.clone().unwrap();
        assert_eq!(
            (schema.encoding.as_str(), message.channel.message_encoding.as_str()),
            ("jsonschema", "json")
        );
        let rules: Value = serde_json::from_slice(&schema.data).unwrap();
        let content: Value = serde_json::from_slice(&message.data).unwrap();
        assert_eq!((&rules["title"], &rules["type"]), (&json!(schema.name), &json!("object")));
        keeps(&rules, &content, &schema.name);
        *topics.entry(message.channel.topic.clone()).or_insert(0) += 1;
    }
    for topic in ["/tick", "/navdata", "/navdata/raw", "/control/raw", "/log", "/pose", "/target"] {
        assert!(topics.contains_key(topic), "{topic}: {topics:?}");
    }
    let summary = mcap::Summary::read(&file).unwrap().unwrap();
    assert_eq!(summary.attachment_indexes.len(), 3);
}

#[test]
fn ten_minutes_are_less_than_30_megabytes() {
    for (navdata, most) in [(NavdataRate::Demo, 8e6), (NavdataRate::Full, 30e6)] {
        let pilot = PilotConfig { navdata, ..PilotConfig::default() };
        let (flight, file) = recorded(SQUARE, &Simulation { pilot, ..Simulation::default() });
        let ten_minutes = file.len() as f64 * 600.0 / flight.duration.as_secs_f64();
        assert!(ten_minutes < most, "{navdata:?}: {ten_minutes:.0} bytes");
    }
}

/// The page needs nothing but itself, and text of the log stays text.
#[test]
fn a_report_answers_why() {
    let (flight, file) = recorded(SQUARE, &Simulation::default());
    let mut log = Log::read(&file).unwrap();
    log.plan_name = "<script>alert(1)</script>".to_owned();
    let page = report::html(&log).unwrap();
    assert_eq!(page.matches("<svg ").count(), 8);
    for outside in ["http://", "https://", "<link", "src=", "<script>alert"] {
        let inside = page.replace("http://www.w3.org/2000/svg", "");
        assert!(!inside.contains(outside), "{outside}");
    }
    // The decision that ended the first stay, with the plan's line and its text.
    let plan = "+!stay : target(X, Y, Z, Yaw) & stayingFor(Time)";
    let line = 1 + log.agent.lines().position(|line| line.starts_with(plan)).unwrap();
    assert!(page.contains(&format!("<pre>{line}: {}", plan.replace('&', "&amp;"))));
    assert!(page.contains("last order: Done") && page.contains("plan flown to its end"));
    let steps = flight.report.steps_done;
    assert!(page.contains(&format!("<b>{steps}</b>steps done")), "{steps}");
    log.entries.clear();
    assert!(report::html(&log).is_err());
}

#[test]
fn a_report_tells_what_went_wrong() {
    let scenario = mock_drone::scenario::Scenario::parse("faults", "8 battery 5\n").unwrap();
    let world = mock_drone::WorldConfig { scenario, ..Default::default() };
    let (_, file) = recorded(SQUARE, &Simulation { world, ..Simulation::default() });
    let page = report::html(&Log::read(&file).unwrap()).unwrap();
    for told in [
        "landed by a failsafe: battery",
        "landing: battery",
        "danger: BatteryEmpty",
        "@empty_battery",
    ] {
        assert!(page.contains(told), "{told}");
    }
}

/// Nothing was flown, and nothing was warned of in flight: the end itself is the news.
#[test]
fn a_refused_flight_is_not_told_as_a_good_one() {
    let mut world = mock_drone::WorldConfig::default();
    world.drone.battery_percent = 10.0;
    let (flight, file) = recorded(SQUARE, &Simulation { world, ..Simulation::default() });
    assert_ne!(flight.outcome.exit_status(), 0);
    let page = report::html(&Log::read(&file).unwrap()).unwrap();
    assert!(page.contains("<p class=\"outcome warn\">"), "{}", flight.outcome);
}
