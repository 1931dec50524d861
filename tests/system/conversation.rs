//! A vehicle process with orders on standard input, over UDP.

use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use ardrone_pilot::recording::Log;
use mock_drone::WorldConfig;
use mock_drone::firmware::Phase;
use mock_drone::server::{MockDrone, Ports};
use serde_json::{Value, json};
use system_tests::lateness::Lateness;

use crate::processes::program;

/// Timeout, longer than any flight here takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(90);

/// A vehicle process and its mock drone.
struct Conversation {
    /// None once it has been switched off.
    mock: Option<MockDrone>,
    child: Child,
    orders: Option<ChildStdin>,
    said: Receiver<Value>,
    next: u64,
}

fn pilot(mock: &MockDrone, arguments: &[&str]) -> Command {
    let ports = mock.ports();
    let mut command = program("ardrone-pilot");
    command.args(["--drone", &ports.host.to_string()]).args(arguments);
    for (name, port) in [
        ("--at-port", ports.at),
        ("--navdata-port", ports.navdata),
        ("--control-port", ports.control),
    ] {
        command.arg(name).arg(port.to_string());
    }
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

impl Conversation {
    fn start(log: &Path) -> Self {
        let mock = MockDrone::start(&WorldConfig::default(), Ports::LOOPBACK).unwrap();
        let log = log.display().to_string();
        let mut child = pilot(&mock, &["--json", "--log", &log]).spawn().unwrap();
        let errors = child.stderr.take().unwrap();
        std::thread::spawn(move || BufReader::new(errors).lines().for_each(drop));
        let (sender, said) = channel();
        let output = child.stdout.take().unwrap();
        std::thread::spawn(move || {
            for line in BufReader::new(output).lines() {
                let object = serde_json::from_str(&line.unwrap()).unwrap();
                if sender.send(object).is_err() {
                    return;
                }
            }
        });
        let orders = child.stdin.take();
        Self { mock: Some(mock), child, orders, said, next: 0 }
    }

    fn write(&mut self, line: &str) {
        let orders = self.orders.as_mut().unwrap();
        orders.write_all(line.as_bytes()).unwrap();
        orders.write_all(b"\n").unwrap();
    }

    /// The next message for which `is_wanted` is true.
    #[track_caller]
    fn until(&mut self, what: &str, is_wanted: impl Fn(&Value) -> bool) -> Value {
        let start = Instant::now();
        loop {
            let left = PATIENCE.saturating_sub(start.elapsed());
            let object = self.said.recv_timeout(left).unwrap_or_else(|_| panic!("never: {what}"));
            if is_wanted(&object) {
                return object;
            }
        }
    }

    /// Gives an order and returns its answer.
    #[track_caller]
    fn order(&mut self, mut order: Value) -> Value {
        self.next += 1;
        order["id"] = self.next.into();
        self.write(&order.to_string());
        let id = order["id"].clone();
        self.until("an answer", |object| object["type"] == "answer" && object["id"] == id)
    }

    #[track_caller]
    fn accepted(&mut self, order: Value) {
        let said = order.to_string();
        let answer = self.order(order);
        assert_eq!(answer["accepted"], true, "{said}: {answer}");
    }

    fn drone_phase(&self) -> Phase {
        self.mock.as_ref().unwrap().truth().phase
    }

    #[track_caller]
    fn until_ready(&mut self) {
        self.until("ready", |object| object["type"] == "ready" && object["ready"] == true);
    }

    #[track_caller]
    fn until_status(&mut self, is_so: impl Fn(&Value) -> bool) {
        self.until("a status", |object| object["type"] == "status" && is_so(object));
    }

    #[track_caller]
    fn until_landed(&mut self) -> Value {
        self.until("a landing", |object| object["type"] == "landed");
        let ended = self.until("an end", |object| object["type"] == "flight_ended");
        self.until_ready();
        assert_eq!(self.drone_phase(), Phase::Landed);
        ended
    }

    fn take_off(&mut self) {
        self.until_ready();
        self.accepted(json!({ "order": "append", "commands": "takeoff" }));
        self.accepted(json!({ "order": "start" }));
        self.until_status(|status| status["pose"]["z_m"].as_f64() > Some(0.7));
    }

    /// A flight in which the mission is changed, held, resumed and extended.
    fn fly(&mut self) {
        self.accepted(json!({ "order": "load", "plan": "takeoff\ngoto 0 1 0 0\nland\n" }));
        assert_eq!(self.order(json!({ "order": "resume" }))["accepted"], false);
        self.accepted(json!({ "order": "start" }));
        self.until_status(|status| status["step"] == 1);
        self.accepted(json!({ "order": "hold" }));
        self.until_status(|status| status["mission_waits"] == true);
        let outside = self.order(json!({ "order": "append", "commands": "goto 50 0 0 0" }));
        assert!(outside["reason"].as_str().unwrap().contains("beyond the fence"), "{outside}");
        self.accepted(
            json!({ "order": "load", "plan": "takeoff\nsetStayTime 0.5\ngoto -1 0 0 0\n" }),
        );
        self.accepted(json!({ "order": "append", "commands": "goto 0 0 0.3 90" }));
        self.accepted(json!({ "order": "resume" }));
        assert_eq!(self.until_landed()["outcome"], "plan flown to its end");
    }

    fn quit(mut self) {
        self.accepted(json!({ "order": "quit" }));
        let end = self.until("the end", |object| object["type"] == "end");
        assert_eq!(end["exit_status"], 0);
        assert_eq!(self.child.wait().unwrap().code(), Some(0));
    }
}

impl Drop for Conversation {
    fn drop(&mut self) {
        // The process may have ended already.
        _ = self.child.kill();
        _ = self.child.wait();
    }
}

/// `VEHICLE_SECONDS` makes the test longer.
#[test]
fn a_program_flies_a_vehicle_again_and_again() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("session.mcap");
    let mut vehicle = Conversation::start(&log);
    let start = Instant::now();
    let seconds = std::env::var("VEHICLE_SECONDS").map_or(0.0, |text| text.parse().unwrap());
    assert_eq!(vehicle.order(json!({ "order": "start" }))["reason"], "no mission is loaded");
    vehicle.until_ready();
    let mut flights = 0;
    loop {
        vehicle.fly();
        // The motors are cut in the air, and the operator has inspected the drone.
        vehicle.accepted(json!({ "order": "start" }));
        vehicle.until_status(|status| status["step"] == 2);
        vehicle.accepted(json!({ "order": "cut" }));
        let ended = vehicle.until("an end", |object| object["type"] == "flight_ended");
        assert_eq!(ended["exit_status"], 50);
        assert_eq!(vehicle.order(json!({ "order": "start" }))["accepted"], false);
        std::thread::sleep(Duration::from_secs(1));
        vehicle.accepted(json!({ "order": "recover" }));
        vehicle.until_ready();
        flights += 2;
        if start.elapsed().as_secs_f64() >= seconds {
            break;
        }
    }
    // Quitting in the air lands first.
    vehicle.accepted(json!({ "order": "start" }));
    vehicle.until_status(|status| status["step"] == 2);
    vehicle.quit();
    println!("{} flights in {:.0} s", flights + 1, start.elapsed().as_secs_f64());
    let replay = program("ardrone-pilot").arg("replay").arg(&log).output().unwrap();
    let said = String::from_utf8_lossy(&replay.stdout).into_owned();
    assert!(said.contains("byte for byte"), "{said} {}", String::from_utf8_lossy(&replay.stderr));
}

#[test]
fn what_is_no_order_is_answered_and_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut vehicle = Conversation::start(&folder.path().join("session.mcap"));
    for (line, reason) in [
        ("what?", "not JSON"),
        ("[1, 2]", "invalid"),
        (r#"{"order":"fly"}"#, "unknown variant"),
        (r#"{"order":"hold","why":1}"#, "unknown field"),
        (r#"{"order":"load","plan":"goto 0 1 0 0"}"#, "on the ground"),
        (r#"{"order":"append","commands":"gotoo"}"#, "did you mean `goto`?"),
        (r#"{"order":"hold"}"#, "on the ground"),
        (r#"{"order":"recover"}"#, "no emergency"),
    ] {
        vehicle.write(line);
        let answer = vehicle.until("an answer", |object| object["type"] == "answer");
        assert_eq!(answer["accepted"], false, "{line}");
        assert!(answer["reason"].as_str().unwrap().contains(reason), "{line}: {answer}");
    }
    vehicle.until_ready();
    vehicle.quit();
}

#[test]
fn a_program_that_goes_away_in_flight_leaves_no_drone_in_the_air() {
    let folder = tempfile::tempdir().unwrap();
    let mut vehicle = Conversation::start(&folder.path().join("session.mcap"));
    vehicle.take_off();
    vehicle.orders = None;
    let end = vehicle.until("the end", |object| object["type"] == "end");
    assert_eq!((&end["exit_status"], vehicle.drone_phase()), (&json!(0), Phase::Landed));
}

#[test]
fn a_landing_overtakes_all_that_waits_in_front_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let mut vehicle = Conversation::start(&folder.path().join("session.mcap"));
    vehicle.take_off();
    let append = json!({ "order": "append", "commands": "goto 0 0 0 0" }).to_string() + "\n";
    let again = json!({ "id": "again", "order": "start" });
    let land = json!({ "id": "land", "order": "land" });
    vehicle.write(&format!("{}{again}\n{land}", append.repeat(3000)));
    let (start, lateness) = (Instant::now(), Lateness::measure());
    vehicle.until("a landing", |object| object["phase"] == "landing");
    let (took, lateness) = (start.elapsed(), lateness.worst());
    assert!(
        took < Duration::from_secs(1) + 20 * lateness,
        "{took:?}, machine late by {lateness:?}"
    );
    vehicle.until("the end", |object| object["type"] == "flight_ended");
    std::thread::sleep(Duration::from_secs(3));
    assert_eq!(vehicle.drone_phase(), Phase::Landed, "what it has overtaken lifts nothing");
    vehicle.quit();
}

#[test]
fn orders_are_read_as_people_type_them() {
    let mock = MockDrone::start(&WorldConfig::default(), Ports::LOOPBACK).unwrap();
    let mut child = pilot(&mock, &["--no-log"]).spawn().unwrap();
    let mut orders = child.stdin.take().unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines().map(Result::unwrap);
    let mut until = |text: &str| lines.find(|line| line.contains(text)).expect(text);
    until("ready to take off");
    orders.write_all(b"goto 0 1 0 0\n").unwrap();
    until("refused: goto 0 1 0 0: the drone is on the ground");
    orders.write_all(b"help\n").unwrap();
    until("load FILE");
    orders.write_all(b"takeoff\nsetStayTime 0.5\ngoto 0 1 0 0\nstart\n").unwrap();
    until("step 3 done");
    orders.write_all(b"land\n").unwrap();
    until("landed");
    orders.write_all(b"quit\n").unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(0));
}

#[test]
fn a_drone_that_is_gone_leaves_no_ticks_in_the_log() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("session.mcap");
    let mut vehicle = Conversation::start(&log);
    vehicle.until_ready();
    vehicle.mock = None;
    vehicle.until("no drone", |object| object["type"] == "ready" && object["ready"] == false);
    std::thread::sleep(Duration::from_secs(2));
    vehicle.quit();
    let log = Log::read(&std::fs::read(&log).unwrap()).unwrap();
    let ticks: Vec<Duration> = log.ticks().map(|(at, _)| at).collect();
    assert!(ticks.len() > 30 && ticks.is_sorted_by(|a, b| a < b), "{ticks:?}");
}
