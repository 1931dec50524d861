//! Flight logs can be read, even if truncated, and replayed.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::io::{Cursor, ErrorKind, Seek, SeekFrom, Write};
use std::rc::Rc;
use std::time::Duration;

use ardrone_pilot::flight::{Connections, Flight};
use ardrone_pilot::recording::{Entry, Header, Log, LogError, LogWriter, Progress, Recorder};
use ardrone_pilot::replay::Replay;
use ardrone_pilot::report;
use ardrone_pilot::settings::Settings;
use autopilot::outcome::Outcome;
use autopilot::plan::{Commands, ZOrigin};
use autopilot::vehicle::{
    FlightEvent, NavdataRate, OperatorOrder, Place, VehicleConfig, VehicleName,
};
use mock_drone::server::{MockDrone, Ports};
use mock_drone::{Tag27, WorldConfig};
use serde_json::{Value, json};
use system_tests::sim::{SimulatedFlight, Simulation};
use system_tests::{SQUARE, plan};

fn header(text: &str) -> Header {
    Header {
        vehicle: VehicleName::default(),
        start: Duration::from_secs(1_700_000_000),
        plan_name: "plan.txt".to_owned(),
        plan: text.to_owned(),
        mission_agent: String::new(),
        settings: Settings::sample().unwrap(),
        z_origin: ZOrigin::Hover,
        drone: "simulated".to_owned(),
    }
}

/// Flies in simulated time; returns the flight and its log.
pub(crate) fn recorded(text: &str, simulation: &Simulation) -> (SimulatedFlight, Vec<u8>) {
    let mut writer = LogWriter::new(Cursor::new(Vec::new()), &header(text)).unwrap();
    let mut written = 0_u32;
    let record = |record| {
        writer.write(&record).unwrap();
        written += 1;
        // The same interval as in a real flight.
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
        (7 * second, OperatorOrder::Hold),
        (8 * second, OperatorOrder::Steer(kinematics::Sticks { roll: 0.3, ..Default::default() })),
        (9 * second, OperatorOrder::GoTo(Place::at(0.5, 0.25))),
        (12 * second, OperatorOrder::Resume),
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
    let logged: Vec<String> = log.events().map(|(_, _, text)| text.to_owned()).collect();
    let happened: Vec<String> = flight.events.iter().map(|(_, event)| event.to_string()).collect();
    assert_eq!(logged, happened);
    assert_eq!(log.outcome(), Some((false, flight.outcome.to_string().as_str())));
    let replay = Replay::new(&log).unwrap();
    assert!(replay.is_same(), "{replay}");
    assert_eq!(replay.outcome, Some(flight.outcome));
}

#[test]
fn other_code_is_recognised() {
    let (_, file) = recorded(SQUARE, &Simulation::default());
    let mut log = Log::read(&file).unwrap();
    log.settings = log.settings.replace("speed_max_m_s = 2.2", "speed_max_m_s = 0.5");
    let replay = Replay::new(&log).unwrap();
    assert!(!replay.is_same());
    assert!(replay.largest_stick_difference > 0.1, "{replay}");
    let first = replay.differences.first().unwrap();
    assert!(first.at > Duration::from_secs(3), "the take-off is the same: {replay}");
    assert!(replay.to_string().contains("then: Goto by"), "{replay}");
}

/// Topics of a log with their schemas, and whether there are messages in them.
fn topics(file: &[u8]) -> BTreeSet<(String, String, Vec<u8>, bool)> {
    let summary = mcap::Summary::read(file).unwrap().unwrap();
    let counts = summary.stats.unwrap().channel_message_counts;
    let channels = summary.channels.values().map(|channel| {
        let schema = channel.schema.as_ref().unwrap();
        let has_messages = counts.get(&channel.id).is_some_and(|count| *count > 0);
        (channel.topic.clone(), schema.name.clone(), schema.data.to_vec(), has_messages)
    });
    channels.collect()
}

#[test]
fn a_simulated_flight_and_the_same_over_udp_leave_the_same_topics() {
    const PLAN: &str = "takeoff\ngoto 0 0 0 0\nland\n";
    let (_, simulated) = recorded(PLAN, &Simulation::default());
    let mock = MockDrone::start(&WorldConfig::default(), Ports::LOOPBACK).unwrap();
    let address = crate::udp::address(&mock);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("flight.mcap");
    let (recorder, recording) = Recorder::start(&path, &header(PLAN)).unwrap();
    let config = VehicleConfig::default();
    let runtime = crate::udp::runtime();
    let flight = Flight::start(
        &runtime,
        Some(plan(PLAN)),
        &config,
        &address,
        Connections { recorder: Some(recorder), ..Connections::default() },
    )
    .unwrap();
    assert_eq!(flight.finish().unwrap().outcome, Outcome::Completed);
    recording.finish().unwrap();
    let flown = std::fs::read(path).unwrap();
    let [simulated, flown] = [&simulated, &flown].map(|file| topics(file));
    assert_eq!(simulated, flown);
    let with_messages = flown.iter().filter(|(.., has_messages)| *has_messages).count();
    // Navdata raw and decoded, control, mission, progress, log, tick, pose and target.
    assert_eq!(with_messages, 9);
}

/// Size of the plan, the settings and the agent's source in a log.
fn attached_bytes(file: &[u8]) -> usize {
    let summary = mcap::Summary::read(file).unwrap().unwrap();
    let bytes: u64 = summary.attachment_indexes.iter().map(|attached| attached.length).sum();
    usize::try_from(bytes).unwrap()
}

/// However a process is killed, flushed records are in the log.
#[test]
fn a_log_that_was_cut_off_is_read_as_far_as_it_goes() {
    let (_, file) = recorded(SQUARE, &Simulation::default());
    let whole = Log::read(&file).unwrap().entries.len();
    let attached = attached_bytes(&file) + 8192;
    let mut longest = 0;
    for part in 1..40 {
        let cut = &file[..file.len() * part / 40];
        let log = match Log::read(cut) {
            Ok(log) => log,
            Err(error) => {
                // Without the agent's source and the settings no log can be read.
                assert!(cut.len() < attached, "{part}: {error}");
                continue;
            }
        };
        // The index follows the last entry.
        assert!(!log.complete && (log.entries.len() < whole || part > 35));
        assert!(log.entries.len() >= longest);
        longest = log.entries.len();
    }
    assert!(longest > whole / 2, "{longest} of {whole}");
}

/// A file on a disk with so much room. What is over it is lost, and reported.
#[derive(Clone)]
struct OnFullDisk {
    file: Rc<RefCell<Cursor<Vec<u8>>>>,
    room: usize,
}

impl Write for OnFullDisk {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let mut file = self.file.borrow_mut();
        let left = self.room.saturating_sub(usize::try_from(file.position()).unwrap());
        if left == 0 {
            return Err(ErrorKind::StorageFull.into());
        }
        file.write(&bytes[..left.min(bytes.len())])
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl Seek for OnFullDisk {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.file.borrow_mut().seek(to)
    }
}

/// The length of a chunk is written behind its content.
#[test]
fn a_log_on_a_disk_that_became_full_is_read_as_far_as_it_goes() {
    let (_, whole) = recorded(SQUARE, &Simulation::default());
    let mut longest = 0;
    for part in 12..24 {
        let file = Rc::default();
        let disk = OnFullDisk { file: Rc::clone(&file), room: whole.len() * part / 24 };
        let mut writer = LogWriter::new(disk, &header(SQUARE)).unwrap();
        let mut written = 0_u32;
        let record = |record| {
            // It ends with the first error, as the recorder does.
            let goes_on = writer.write(&record).is_ok();
            written += 1;
            if goes_on && written.is_multiple_of(50) {
                _ = writer.flush();
            }
        };
        Simulation::default().fly_recorded(plan(SQUARE), record).unwrap();
        drop(writer);
        let log = Log::read(file.borrow().get_ref()).unwrap();
        assert!(!log.complete && log.entries.len() >= longest, "{part}");
        longest = log.entries.len();
    }
    assert!(longest > Log::read(&whole).unwrap().entries.len() / 2, "{longest}");
}

#[test]
fn what_is_no_log_is_refused() {
    let (_, mut file) = recorded(SQUARE, &Simulation::default());
    for bytes in [&b""[..], b"takeoff\nland\n", &file[..7], &[0x89; 4096]] {
        assert!(Log::read(bytes).is_err());
    }
    // A damaged log never causes a panic, and is not read as a shorter flight.
    let whole = Log::read(&file).unwrap().entries.len();
    let mut refused = 0;
    for place in (0..file.len()).step_by(file.len() / 500) {
        let old = std::mem::replace(&mut file[place], 0xff);
        match Log::read(&file) {
            Ok(log) => assert_eq!(log.entries.len(), whole, "damaged at {place}"),
            Err(_) => refused += 1,
        }
        file[place] = old;
    }
    assert!(refused > 300, "{refused} of 500");
}

/// A file like a flight log with arbitrary messages, compressed like a flight log.
fn foreign_log(
    plan: &str,
    agent: &str,
    topic: &str,
    messages: usize,
    content: impl Fn(usize) -> String,
) -> Vec<u8> {
    let options = mcap::WriteOptions::new()
        .compression(Some(mcap::Compression::Lz4))
        .chunk_size(Some(4 << 20))
        .emit_message_indexes(false);
    let mut writer = options.create(Cursor::new(Vec::new())).unwrap();
    let metadata = [
        ("format", "7"),
        ("start_ns", "0"),
        ("plan", "p"),
        ("drone", "d"),
        ("version", "0"),
        ("vehicle", "v"),
    ];
    let mut metadata: std::collections::BTreeMap<String, String> =
        metadata.into_iter().map(|(key, value)| (key.to_owned(), value.to_owned())).collect();
    metadata.insert("z_origin".to_owned(), ZOrigin::Hover.name().to_owned());
    let metadata = mcap::records::Metadata { name: "flight".to_owned(), metadata };
    writer.write_metadata(&metadata).unwrap();
    let settings = Settings::sample().unwrap();
    for (name, text) in
        [("plan.txt", plan), ("pilot.toml", settings.as_str()), ("autopilot.asl", agent)]
    {
        let attachment = mcap::Attachment {
            log_time: 0,
            create_time: 0,
            name: name.to_owned(),
            media_type: String::new(),
            data: text.as_bytes().into(),
        };
        writer.attach(&attachment).unwrap();
    }
    let channel = writer.add_channel(0, topic, "json", &std::collections::BTreeMap::new()).unwrap();
    for number in 0..messages {
        let header = mcap::records::MessageHeader {
            channel_id: channel,
            sequence: 0,
            log_time: 0,
            publish_time: 0,
        };
        writer.write_to_known_channel(&header, content(number).as_bytes()).unwrap();
    }
    writer.finish().unwrap();
    writer.into_inner().into_inner()
}

/// Neither the name of a topic nor compressed data can make a small file need much memory.
#[test]
fn a_small_log_needs_little_memory() {
    let long = "t".repeat(4000);
    let file = foreign_log(SQUARE, "", &long, 300_000, |_| String::new());
    assert!(file.len() < 70_000, "{}", file.len());
    let mut read = None;
    let used = allocation_counter::measure(|| read = Some(Log::read(&file)));
    assert!(matches!(read, Some(Err(LogError::Bomb))), "{read:?}");
    assert!(used.bytes_max < 64 << 20, "{} bytes", used.bytes_max);
}

/// A file with an implausible compression ratio is not unpacked to its end.
#[test]
fn a_log_that_unpacks_to_too_much_is_refused() {
    let words = "{\"data\":\"\"}".to_owned() + &" ".repeat(4000);
    let file = foreign_log(SQUARE, "", "/control/raw", 40_000, |_| words.clone());
    assert!(file.len() < 1_000_000, "{}", file.len());
    let mut read = None;
    let used = allocation_counter::measure(|| read = Some(Log::read(&file)));
    assert!(matches!(read, Some(Err(LogError::Bomb))), "{read:?}");
    assert!(used.bytes_max < 100 << 20, "{} bytes", used.bytes_max);
    // Real logs are far below the limit.
    let (_, file) = recorded(SQUARE, &Simulation::default());
    let unpacked: usize =
        mcap::MessageStream::new(&file).unwrap().map(|message| message.unwrap().data.len()).sum();
    assert!(unpacked < 8 * file.len(), "{unpacked} of {}", file.len());
}

/// Checks a value against a JSON schema that uses only `type`, `properties`, `required` and `items`.
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
        keeps(rules.unwrap_or_else(|| panic!("{path} is not documented")), part, &path);
    }
    for part in value.as_array().into_iter().flatten() {
        if let Some(rules) = rules.get("items") {
            keeps(rules, part, path);
        }
    }
}

/// Other tools read the log too: JSON with schemas, some of them Foxglove's.
#[test]
fn each_topic_has_a_schema_that_its_messages_keep() {
    // With all that a drone can tell.
    let mut simulation = crate::tag_log::with_tags();
    simulation.pilot.gps = true;
    simulation.world.drone.tag_27 = Tag27::Gps;
    let (_, file) = recorded(SQUARE, &simulation);
    assert!(
        Log::read(&file)
            .unwrap()
            .entries
            .iter()
            .any(|(_, entry)| matches!(entry, Entry::Decoded(decoded) if decoded.gps.is_some()))
    );
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
    for topic in [
        "/tick",
        "/navdata",
        "/navdata/raw",
        "/control/raw",
        "/mission",
        "/progress",
        "/log",
        "/pose",
        "/target",
        "/tags",
    ] {
        assert!(topics.contains_key(topic), "{topic}: {topics:?}");
    }
    let summary = mcap::Summary::read(&file).unwrap().unwrap();
    assert_eq!(summary.attachment_indexes.len(), 3);
}

#[test]
fn ten_minutes_are_less_than_30_megabytes() {
    for (navdata, most) in [(NavdataRate::Demo, 8e6), (NavdataRate::Full, 30e6)] {
        let pilot = VehicleConfig { navdata, ..VehicleConfig::default() };
        let (flight, file) = recorded(SQUARE, &Simulation { pilot, ..Simulation::default() });
        // What is attached, as the agent's source, is so once.
        let attached = attached_bytes(&file);
        let grown = (file.len() - attached) as f64;
        let ten_minutes = attached as f64 + grown * 600.0 / flight.duration.as_secs_f64();
        assert!(ten_minutes < most, "{navdata:?}: {ten_minutes:.0} bytes");
    }
}

/// The page is self-contained, and text of the log is escaped.
#[test]
fn a_report_answers_why() {
    let (flight, file) = recorded(SQUARE, &Simulation::default());
    let mut log = Log::read(&file).unwrap();
    log.plan_name = "<script>alert(1)</script>".to_owned();
    let page = report::html(&log, &[]).unwrap();
    for outside in ["http://", "https://", "<link", "src=", "<script>alert"] {
        let inside = page.replace("http://www.w3.org/2000/svg", "");
        assert!(!inside.contains(outside), "{outside}");
    }
    // The decision that ended the first stay, with line and text of the plan.
    let plan = "+!stay : target(X, Y, Z, Yaw) & stayingFor(Time)";
    let line = 1 + log.agent.lines().position(|line| line.starts_with(plan)).unwrap();
    assert!(page.contains(&format!("<pre>{line}: {}", plan.replace('&', "&amp;"))));
    assert!(
        page.contains("the last order was carried out") && page.contains("plan flown to its end")
    );
    // They are not read from texts.
    for (_, entry) in &mut log.entries {
        if let Entry::Event { text, .. } = entry {
            text.clear();
        }
    }
    let page = report::html(&log, &[]).unwrap();
    let (done, all) = (flight.report.steps_done, flight.report.steps);
    assert!(page.contains(&format!("<b>{done} of {all}</b>steps done")), "{done} of {all}");
    log.entries.clear();
    assert!(report::html(&log, &[]).is_err());
}

/// Logs may come from anywhere. Their text must not be executed by the page or a terminal.
#[test]
fn a_hostile_log_does_nothing_to_page_and_terminal() {
    const HOSTILE: &str =
        "<!--<script>alert(1)</script>\u{2028}'\"&\x1b[2J\x1b]0;x\x07\u{9b}2J\u{202e}\n";
    let (_, file) = recorded(SQUARE, &Simulation::default());
    let clean = Log::read(&file).unwrap();
    let mut log = clean.clone();
    log.agent = log.agent.replace("+!", &format!("// {HOSTILE}+!"));
    for text in [&mut log.plan_name, &mut log.drone, &mut log.version] {
        *text += HOSTILE;
    }
    for (_, entry) in &mut log.entries {
        match entry {
            Entry::Event { text, .. } | Entry::Outcome { text, .. } => *text += HOSTILE,
            Entry::Tick(tick) => {
                tick.phase += HOSTILE;
                tick.datagram.clear();
                tick.agent.command += HOSTILE;
                tick.command.flight += HOSTILE;
                tick.veto = Some(HOSTILE.to_owned());
                tick.agent.danger = Some(HOSTILE.to_owned());
                tick.agent.report = Some(HOSTILE.to_owned());
                tick.agent.plans.iter_mut().for_each(|plan| plan.trigger += HOSTILE);
            }
            _ => {}
        }
    }
    let page = report::html(&log, &[]).unwrap();
    let count = |of: &str| report::html(&clean, &[]).unwrap().matches(of).count();
    for markup in ["<script", "</script", "<!--"] {
        assert_eq!(page.matches(markup).count(), count(markup), "{markup}");
    }
    let (_, data) = page.split_once("id=\"decided\">").unwrap();
    let (data, _) = data.split_once("</script>").unwrap();
    assert!(!data.contains(['<', '>', '&']));
    let decided: Value = serde_json::from_str(data).unwrap();
    assert!(decided["decisions"].as_array().unwrap().len() > 10);
    let replay = Replay::new(&log).unwrap().to_string();
    assert!(replay.contains("then:"), "{replay}");
    for text in [page, replay] {
        let odd = text.chars().find(|c| (c.is_control() && *c != '\n') || *c == '\u{202e}');
        assert_eq!(odd, None);
    }
}

/// The firmware version comes over the network and may contain anything.
#[test]
fn the_drone_says_nothing_to_the_terminal() {
    let version = Some("2.4.8\x1b]0;x\x07\u{9b}2J\u{202e}\n".to_owned());
    let text = FlightEvent::ConfigurationRead { version }.to_string();
    assert!(text.contains("firmware 2.4.8\\u{1b}]0;x"), "{text:?}");
    assert!(!text.contains(|c: char| c.is_control() || c == '\u{202e}'), "{text:?}");
}

/// The size of the page is bounded by that of the log: long texts are not repeated for each moment.
#[test]
fn a_hostile_log_makes_no_large_page() {
    let tick = {
        let (_, file) = recorded(SQUARE, &Simulation::default());
        let log = Log::read(&file).unwrap();
        log.ticks().find(|(_, tick)| tick.agent.plans.len() > 1).unwrap().1.clone()
    };
    let plan = format!("takeoff\ngoto {0} 0 0 0\ngoto 1{0} 0 0 0\nland\n", "0".repeat(20_000));
    let agent = "+!a <- b\n".repeat(4_000);
    let messages = 4_000;
    let file = foreign_log(&plan, &agent, "/tick", messages, |number| {
        let mut tick = tick.clone();
        tick.step = Some(1 + number % 2);
        tick.agent.plans.iter_mut().for_each(|plan| plan.line = u32::try_from(number).unwrap());
        serde_json::to_string(&tick).unwrap()
    });
    assert!(file.len() < 1_000_000, "{}", file.len());
    let log = Log::read(&file).unwrap();
    let mut length = 0;
    let used = allocation_counter::measure(|| length = report::html(&log, &[]).unwrap().len());
    assert!(length < 10_000_000, "{length} characters");
    assert!(used.bytes_max < 100 << 20, "{} bytes", used.bytes_max);
}

#[test]
fn a_report_shows_what_went_wrong() {
    let scenario = mock_drone::scenario::Scenario::parse("faults", "8 battery 5\n").unwrap();
    let world = WorldConfig { scenario, ..Default::default() };
    let (_, file) = recorded(SQUARE, &Simulation { world, ..Simulation::default() });
    let page = report::html(&Log::read(&file).unwrap(), &[]).unwrap();
    for part in [
        "landed by a failsafe: battery",
        "landing: battery",
        "the agent says: the battery is too low to fly on",
        "@empty_battery",
    ] {
        assert!(page.contains(part), "{part}");
    }
}

/// A refused flight has no warnings in flight, but its outcome is one.
#[test]
fn a_refused_flight_is_not_reported_as_a_good_one() {
    let mut world = WorldConfig::default();
    world.drone.battery_percent = 10.0;
    let (flight, file) = recorded(SQUARE, &Simulation { world, ..Simulation::default() });
    assert_ne!(flight.outcome.exit_status(), 0);
    let page = report::html(&Log::read(&file).unwrap(), &[]).unwrap();
    assert!(page.contains("<p class=\"outcome warn\">"), "{}", flight.outcome);
}

/// As the vehicle counts them: of a mission that was loaded in flight and never flown none is done, and one that was loaded
/// during the landing is for the next flight.
#[test]
fn steps_are_those_of_the_mission_that_was_flown_last() {
    let (second, mission) = (Duration::from_secs(1), "takeoff\ngoto 0 0 0 0\n");
    // A command that is carried out at once is done with the step behind it.
    let slow = "takeoff\nsetSpeed 0.1\nsetStayTime 0\ngoto 0 1 0 0\nland\n";
    let append = OperatorOrder::Append(Commands::parse("more", mission).unwrap());
    for (flown, orders, done) in [
        (SQUARE, [OperatorOrder::Load(plan(mission)), OperatorOrder::Land], 0),
        (SQUARE, [OperatorOrder::Land, OperatorOrder::Load(plan(mission))], 2),
        (SQUARE, [append, OperatorOrder::Land], 2),
        (slow, [OperatorOrder::Hold, OperatorOrder::Land], 1),
    ] {
        let orders = orders.map(|order| (9 * second, order)).into();
        let (flight, file) = recorded(flown, &Simulation { orders, ..Simulation::default() });
        let steps = flight.report.steps;
        assert_eq!(flight.report.steps_done, done);
        let mut log = Log::read(&file).unwrap();
        // What comes to the drone on the ground is for the next flight.
        let (end, _) = *log.entries.last().unwrap();
        log.entries.push((end, Entry::Progress(Progress { steps_done: 0, steps: 9 })));
        let shown = format!("<b>{done} of {steps}</b>steps done");
        assert!(report::html(&log, &[]).unwrap().contains(&shown), "{shown}");
        let is_outcome = |(_, entry): &(_, Entry)| matches!(entry, Entry::Outcome { .. });
        let outcome = log.entries.iter().position(is_outcome).unwrap();
        let (at, _) = log.entries[outcome];
        let at_the_end = (at, Entry::Progress(Progress { steps_done: done, steps }));
        assert!(log.entries[..outcome].contains(&at_the_end), "{shown}");
        // A log that was cut off has no end.
        log.entries.retain(|(then, _)| *then < at);
        assert!(report::html(&log, &[]).unwrap().contains(&shown), "{shown}");
    }
}

#[test]
fn a_log_of_another_format_is_refused_with_the_version_that_wrote_it() {
    let refused = |format: &str| {
        let mut file = Cursor::new(Vec::new());
        let mut writer = mcap::Writer::new(&mut file).unwrap();
        let entries = [("format", format), ("version", "9.8.7")];
        let metadata = entries.map(|(key, value)| (key.to_owned(), value.to_owned())).into();
        let name = "flight".to_owned();
        writer.write_metadata(&mcap::records::Metadata { name, metadata }).unwrap();
        writer.finish().unwrap();
        drop(writer);
        Log::read(&file.into_inner()).unwrap_err().to_string()
    };
    for unknown in ["8", "6", "0", "-1", "two"] {
        let text = refused(unknown);
        assert!(text.contains(&format!("format is {unknown}")) && text.contains("9.8.7"), "{text}");
    }
    assert!(refused("7").contains("has no"), "known, and the rest is missing");
}
