//! The program that flies a fleet: several vehicles of one process, each with its simulated drone.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{BufRead as _, BufReader, Write as _};
use std::net::UdpSocket;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use ardrone_pilot::recording::Log;
use ardrone_pilot::replay::Replay;
use ardrone_pilot::report::html;
use serde_json::{Value, json};

use crate::browser::Live;
use crate::processes::{program, signal, with_page};

/// A folder with a fleet and its plans, each vehicle `(name, x, plan)` on a line.
struct Files(tempfile::TempDir);

impl Files {
    fn new(vehicles: &[(&str, f64, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mut fleet = vec!["[fleet]\nname = \"test\"".to_owned()];
        for (name, x_m, plan) in vehicles {
            fleet.push(format!("[[vehicle]]\nname = \"{name}\"\nstart = [{x_m:?}, 0.0, 0]"));
            if !plan.is_empty() {
                fleet.push(format!("plan = \"{name}.txt\""));
                std::fs::write(folder.path().join(format!("{name}.txt")), plan).unwrap();
            }
        }
        std::fs::write(folder.path().join("fleet.toml"), fleet.join("\n")).unwrap();
        Self(folder)
    }

    fn path(&self) -> String {
        self.0.path().join("fleet.toml").display().to_string()
    }

    fn fly(&self) -> Command {
        let mut pilot = program("ardrone-pilot");
        pilot.current_dir(self.0.path()).args(["fleet", &self.path(), "--mock", "--json"]);
        pilot
    }
}

/// Two that change places.
fn crossing() -> Files {
    let to = |x_m: f64| format!("takeoff\ngoto {x_m} 0 0 0\nland\n");
    Files::new(&[("left", -2.5, &to(2.5)), ("right", 2.5, &to(-2.5))])
}

fn objects(output: &Output) -> Vec<Value> {
    let text = String::from_utf8_lossy(&output.stdout);
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// The objects of a kind, of each vehicle.
fn of_kind(objects: &[Value], kind: &str) -> BTreeMap<String, Vec<Value>> {
    let mut found = BTreeMap::<String, Vec<Value>>::new();
    for object in objects.iter().filter(|object| object["type"] == kind) {
        found
            .entry(object["vehicle"].as_str().unwrap().to_owned())
            .or_default()
            .push(object.clone());
    }
    found
}

#[test]
fn two_that_change_places_keep_apart_and_their_flights_are_replayed() {
    let files = crossing();
    let output = files.fly().output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let objects = objects(&output);
    let statuses = of_kind(&objects, "status");
    let place = |status: &Value| {
        let pose = &status["pose"];
        Some((status["t_s"].as_f64()?, pose["x_m"].as_f64()?, pose["y_m"].as_f64()?))
    };
    let [left, right] =
        ["left", "right"].map(|name| statuses[name].iter().filter_map(place).collect::<Vec<_>>());
    let mut nearest_m = f64::INFINITY;
    for (at_s, x_m, y_m) in &left {
        let beside = right.iter().filter(|(other_s, ..)| (other_s - at_s).abs() < 0.1);
        let away_m = beside.map(|(_, x, y)| (x - x_m).hypot(y - y_m)).fold(f64::INFINITY, f64::min);
        nearest_m = nearest_m.min(away_m);
    }
    assert!((1.3..4.5).contains(&nearest_m), "{nearest_m}");
    let ends = of_kind(&objects, "end");
    for (name, x_m) in [("left", 2.5), ("right", -2.5)] {
        let target = &of_kind(&objects, "target")[name][0];
        assert!((target["reached"]["x_m"].as_f64().unwrap() - x_m).abs() < 0.5, "{target}");
        let end = &ends[name][0];
        assert_eq!(end["exit_status"], 0, "{end}");
        let path = files.0.path().join(end["log"].as_str().unwrap());
        let named =
            path.file_name().unwrap().to_string_lossy().ends_with(&format!("-test-{name}.mcap"));
        assert!(named, "{path:?}");
        let replay = Replay::new(&Log::read(&std::fs::read(&path).unwrap()).unwrap()).unwrap();
        assert!(replay.is_same(), "{replay}");
        let log = Log::read(&std::fs::read(&path).unwrap()).unwrap();
        let page = html(&log, &[]).unwrap();
        assert!(page.contains(&format!("\"system\":{}", if name == "left" { 2 } else { 1 })));
        assert!(page.contains(&format!("\"start\":[{:?},0.0]", -x_m)), "where it stood");
    }
    assert_eq!(objects.last().unwrap(), &json!({ "type": "fleet_end", "exit_status": 0 }));
}

/// A fleet that takes orders.
struct Ordered {
    child: Child,
    lines: Box<dyn Iterator<Item = Value>>,
}

impl Ordered {
    fn start(files: &Files) -> Self {
        let mut pilot = files.fly();
        pilot.arg("--no-log").stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut child = pilot.spawn().unwrap();
        let lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let lines = lines.map(|line| serde_json::from_str(&line.unwrap()).unwrap());
        Self { child, lines: Box::new(lines) }
    }

    fn order(&mut self, order: &Value) {
        writeln!(self.child.stdin.as_mut().unwrap(), "{order}").unwrap();
    }

    fn until(&mut self, wanted: impl Fn(&Value) -> bool) -> Value {
        self.lines.by_ref().find(wanted).unwrap()
    }

    fn answer(&mut self, id: u32) -> Value {
        self.until(|object| object["type"] == "answer" && object["id"] == id)
    }

    /// The exit status.
    fn end(mut self) -> Option<i32> {
        self.lines.by_ref().for_each(drop);
        self.child.wait().unwrap().code()
    }
}

impl Drop for Ordered {
    fn drop(&mut self) {
        // It may have ended already.
        _ = self.child.kill();
        _ = self.child.wait();
    }
}

#[test]
fn orders_name_a_vehicle_or_are_for_all() {
    let files = Files::new(&[("left", -2.0, ""), ("right", 2.0, "")]);
    let mut fleet = Ordered::start(&files);
    let is_ready = |name: &'static str| {
        move |object: &Value| {
            object["type"] == "ready" && object["ready"] == true && object["vehicle"] == name
        }
    };
    fleet.until(is_ready("right"));
    let plan = "takeoff\nsetStayTime 100\ngoto 2 1 0 0\nland\n";
    fleet.order(&json!({ "id": 1, "order": "load", "plan": plan }));
    let unnamed = fleet.answer(1);
    assert_eq!((&unnamed["accepted"], &unnamed["vehicle"]), (&json!(false), &Value::Null));
    fleet.order(&json!({ "id": 2, "vehicle": "middle", "order": "land" }));
    assert_eq!(fleet.answer(2)["reason"], "there is no vehicle \"middle\"");
    fleet.order(&json!({ "id": 3, "vehicle": "right", "order": "load", "plan": plan }));
    assert_eq!(fleet.answer(3)["accepted"], true);
    fleet.order(&json!({ "id": 4, "vehicle": "right", "order": "start", "when_ready": true }));
    assert_eq!(fleet.answer(4)["vehicle"], "right");
    fleet.until(|object| {
        object["vehicle"] == "right" && object["type"] == "status" && object["step"] == 2
    });
    fleet.order(&json!({ "id": 5, "order": "land" }));
    assert_eq!(fleet.answer(5)["accepted"], true);
    fleet.until(|object| object["type"] == "landed" && object["vehicle"] == "right");
    fleet.order(&json!({ "id": 6, "order": "quit" }));
    assert_eq!(fleet.end(), Some(0));
}

#[test]
fn a_signal_lands_all() {
    let hover = |x_m: f64| format!("takeoff\nsetStayTime 100\ngoto {x_m} 0 0 0\nland\n");
    let files = Files::new(&[("left", -2.5, &hover(-2.5)), ("right", 2.5, &hover(2.5))]);
    let mut fleet = Ordered::start(&files);
    for name in ["left", "right"] {
        fleet.until(|object| object["vehicle"] == name && object["airborne"] == true);
    }
    signal(&fleet.child, "-INT");
    let mut landed = BTreeSet::new();
    while landed.len() < 2 {
        let end = fleet.until(|object| object["type"] == "landed");
        landed.insert(end["vehicle"].as_str().unwrap().to_owned());
    }
    assert_eq!(fleet.end(), Some(130));
}

/// It lies on the floor, and everybody knows where.
#[test]
fn the_others_fly_on_beside_one_whose_motors_are_cut() {
    let stay = |s: u32, x_m: f64| format!("takeoff\nsetStayTime {s}\ngoto {x_m} 0 0 0\nland\n");
    let files = Files::new(&[("left", -2.5, &stay(10, -2.5)), ("right", 2.5, &stay(100, 2.5))]);
    let mut fleet = Ordered::start(&files);
    fleet.until(|object| object["vehicle"] == "right" && object["step"] == 2);
    fleet.order(&json!({ "id": 1, "vehicle": "right", "order": "cut" }));
    let end = fleet.until(|object| object["type"] == "end");
    assert_eq!((&end["vehicle"], &end["exit_status"]), (&json!("right"), &json!(50)), "at once");
    let end = fleet.until(|object| object["type"] == "end");
    assert_eq!((&end["vehicle"], &end["exit_status"]), (&json!("left"), &json!(0)), "{end}");
    assert_eq!(fleet.end(), Some(50));
}

/// Nobody knows where the second one is.
#[test]
fn who_does_not_hear_all_others_stays_on_the_ground() {
    let files = crossing();
    let text = std::fs::read_to_string(files.path()).unwrap();
    let mock = mock_drone::server::MockDrone::start(
        &mock_drone::WorldConfig::default(),
        mock_drone::server::Ports::LOOPBACK,
    );
    let mock = mock.unwrap();
    let ports = mock.ports();
    let at = format!(
        "drone = \"127.0.0.1\"\nat_port = {}\nnavdata_port = {}\ncontrol_port = {}\n",
        ports.at, ports.navdata, ports.control
    );
    // The other one's drone is at a port where nobody answers.
    let nobody = "drone = \"127.0.0.1\"\nat_port = 9\nnavdata_port = 9\ncontrol_port = 9\n";
    let mut parts = text.split("plan = ");
    let begin = parts.next().unwrap();
    let parts = parts.zip([at.as_str(), nobody]);
    let parts: Vec<String> = parts.map(|(part, drone)| format!("{drone}plan = {part}")).collect();
    std::fs::write(files.path(), begin.to_owned() + &parts.concat()).unwrap();
    let mut pilot = program("ardrone-pilot");
    let output = pilot.args(["fleet", &files.path(), "--no-log", "--json"]).output().unwrap();
    let objects = objects(&output);
    assert!(!objects.iter().any(|object| object["airborne"] == true));
    let ends = of_kind(&objects, "end");
    assert_eq!(ends["right"][0]["exit_status"], 10, "{ends:?}");
    assert_eq!(ends["left"][0]["exit_status"], 30, "{ends:?}");
    let why = ends["left"][0]["outcome"].as_str().unwrap();
    assert!(why.contains("vehicle 2"), "{why}");
    assert_eq!(output.status.code(), Some(10));
}

/// A program that is built with the feature `zenoh` is tried in `ardrone-pilot/tests/network`.
#[test]
fn other_machines_are_not_heard_without_the_feature_for_it() {
    let files = crossing();
    let fly = |arguments: &[&str]| {
        let output = files.fly().args(arguments).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let (status, said) = fly(&["--net", "zenoh.json5", "--vehicle", "left"]);
    assert_eq!(status, Some(2));
    assert!(said.contains("cargo build --release -p ardrone-pilot --features zenoh"), "{said}");
    let (status, said) = fly(&["--net", "zenoh.json5", "--vehicle", "middle"]);
    assert_eq!(status, Some(20));
    assert!(
        said.contains("there is no vehicle middle in this fleet: it has left, right"),
        "{said}"
    );
    // Nobody would ever hear the other one.
    assert_eq!(fly(&["--vehicle", "left"]).0, Some(2));
}

fn host_of(url: &str) -> &str {
    url.trim_start_matches("http://").trim_end_matches('/')
}

#[test]
fn the_page_shows_each_vehicle_with_the_others_and_lands_all() {
    let hover = |x_m: f64| format!("takeoff\nsetStayTime 100\ngoto {x_m} 0 0 0\nland\n");
    let files = Files::new(&[("left", -2.5, &hover(-2.5)), ("right", 2.5, &hover(2.5))]);
    let mut pilot = files.fly();
    pilot.args(["--no-log", "--plain", "--ui", "127.0.0.1:0"]).stdout(Stdio::null());
    let (mut child, url) = with_page(&mut pilot);
    let host = host_of(&url);
    assert!(Live::from(host, "/live?vehicle=middle", None).is_err());
    let mut right = Live::from(host, "/live?vehicle=right", None).unwrap();
    let flight = right.next("flight");
    assert_eq!(
        (&flight["vehicle"], &flight["fleet"]),
        (&json!("right"), &json!(["left", "right"]))
    );
    assert_eq!(flight["start_m"], json!([2.5, 0.0]));
    let mut left = Live::from(host, "/live", None).unwrap();
    assert_eq!(left.next("flight")["vehicle"], "left");
    loop {
        let other = right.next("other");
        assert_eq!(other["vehicle"], "left");
        if other["airborne"] == true {
            assert!((other["pose"]["x_m"].as_f64().unwrap() + 2.5).abs() < 0.5, "{other}");
            break;
        }
    }
    right.order(&json!({ "order": "land_all", "vehicle": "right" }));
    assert_eq!(right.next("accepted")["order"], "land");
    for live in [&mut left, &mut right] {
        live.next("landed");
    }
    assert_eq!(child.wait().unwrap().code(), Some(130));
}

#[test]
fn a_fence_of_a_fleet_changes_only_what_it_says() {
    let files = Files::new(&[("left", 0.0, "takeoff\ngoto 0 1 1.5 0\nland\n")]);
    let text = std::fs::read_to_string(files.path()).unwrap();
    std::fs::write(files.0.path().join("low.toml"), "[fence]\nceiling_m = 1.0\n").unwrap();
    let low = text.replace("name = \"test\"", "config = \"low.toml\"");
    for fence in
        ["", "[fence]\nradius_m = 6.0\n", "[fence]\npolygon_m = [[-3, -3], [3, -3], [0, 4]]\n"]
    {
        std::fs::write(files.path(), format!("{low}\n{fence}")).unwrap();
        let (status, said) = check(files.path().as_ref());
        assert!(status == Some(20) && said.contains("ceiling"), "{fence}: {said}");
    }
    std::fs::write(files.path(), format!("{low}\n[fence]\nceiling_m = 3.0\n")).unwrap();
    assert_eq!(check(files.path().as_ref()).0, Some(0));
    let config =
        program("ardrone-pilot").args(["check", &files.path(), "--config", "x.toml"]).output();
    assert_eq!(config.unwrap().status.code(), Some(2));
}

/// As QGroundControl tells vehicles apart.
#[test]
fn each_vehicle_is_a_mavlink_system_of_its_own() {
    let station = UdpSocket::bind("127.0.0.1:0").unwrap();
    station.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    let files = Files::new(&[("left", -2.0, ""), ("right", 2.0, "")]);
    let mut pilot = files.fly();
    pilot.args(["--no-log", "--mavlink", &format!("udp:{}", station.local_addr().unwrap())]);
    let mut child = pilot.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let mut heard = BTreeMap::new();
    let mut frame = [0; 300];
    while heard.len() < 2 {
        let (_, from) = station.recv_from(&mut frame).unwrap();
        // Of a frame of version 2 the sixth byte is the system.
        assert_eq!(frame[0], 0xfd);
        heard.insert(frame[5], from);
    }
    assert_eq!(heard.keys().copied().collect::<Vec<_>>(), [1, 2]);
    assert_ne!(heard[&1], heard[&2]);
    signal(&child, "-INT");
    child.wait().unwrap();
}

fn check(path: &Path) -> (Option<i32>, String) {
    let output = program("ardrone-pilot").arg("check").arg(path).output().unwrap();
    let text = [output.stdout, output.stderr].concat();
    (output.status.code(), String::from_utf8(text).unwrap())
}

#[test]
fn a_fleet_is_checked_as_it_would_fly() {
    let files = crossing();
    let (status, said) = check(files.path().as_ref());
    assert_eq!(status, Some(0));
    assert!(
        said.contains("left and right: 0.") && said.contains("kept apart, never nearer"),
        "{said}"
    );
    assert!(said.ends_with("fleet.toml can be flown\n"), "{said}");
    // One that has no plan stands there, and is heard.
    let waits =
        Files::new(&[("left", -2.5, ""), ("right", 2.5, "takeoff\ngoto 2.5 1 0 0\nland\n")]);
    let (status, said) = check(waits.path().as_ref());
    assert!(status == Some(0) && said.ends_with("fleet.toml can be flown\n"), "{said}");
    // One that has too little charge cannot begin, with a plan or with an agent.
    let folder = tempfile::tempdir().unwrap();
    let empty = folder.path().join("empty.toml");
    std::fs::write(folder.path().join("up.txt"), "takeoff\nland\n").unwrap();
    for mission in ["plan = \"up.txt\"", "agent = \"wingman\""] {
        let one = |name: &str, x: i32, mission: &str| {
            format!("[[vehicle]]\nname = \"{name}\"\nstart = [{x}, 0, 0]\n{mission}\n")
        };
        let text =
            one("leader", -3, &format!("{mission}\nmock_battery = 12.0")) + &one("wingman", 3, "");
        std::fs::write(&empty, text).unwrap();
        let (status, said) = check(&empty);
        assert_eq!(status, Some(20), "{said}");
        assert!(said.ends_with("cannot be flown: one vehicle cannot begin\n"), "{said}");
    }
    // Both want to one place, and neither leaves it: only one of them can be there.
    let to = "takeoff\nsetStayTime 120\ngoto 0 0 0 0\nland\n";
    let files = Files::new(&[("left", -2.5, to), ("right", 2.5, to)]);
    let (status, said) = check(files.path().as_ref());
    assert_eq!(status, Some(0));
    assert!(said.contains("does not fly its plan to the end with the others"), "{said}");
}

#[test]
fn tags_that_nobody_may_see_are_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("f.toml");
    std::fs::write(folder.path().join("tags.toml"), "[tags]\nsurveyed = [[0, 1], [11, 0]]\n")
        .unwrap();
    let tagged = "[fleet]\nconfig = \"tags.toml\"\n[[vehicle]]\nname = \"a\"\nstart = [0, 0, 0]\ntags = true\n";
    std::fs::write(&path, tagged).unwrap();
    let (status, said) = check(&path);
    assert!(status == Some(0) && said.contains("f.toml:2:10"), "{said}");
    assert!(said.contains("warning: the given tag 11,0 is 11.00 m from the start"), "{said}");
}

#[test]
fn what_is_wrong_in_a_fleet_is_shown_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("f.toml");
    for (text, said) in [
        ("", "a fleet has 1 to 32 vehicles, and this one 0"),
        ("version = 2\n[fleets]\n", "line 1, column 11"),
        ("version = 2\n", "version 2 of this file's format: this program reads version 1"),
        ("[[vehicle]]\nname = \"a\"\n", "line 1, column 1"),
        ("[[vehicle]]\nname = \"a\"\nstart = []\n", "a has no start"),
        ("[[vehicle]]\nname = \"a\"\nstart = [11, 0, 0]\n", "a starts 1.00 m outside the fence"),
        (
            "[[vehicle]]\nname = \"a\"\nstart = [0, 0, 0]\nsystem = 0\n",
            "a would be the MAVLink system 0",
        ),
        ("[[vehicle]]\nname = \"a\"\nstart = [0, 0, 0]\nplan = \"no.txt\"\n", "f.toml:4:8"),
        (
            "[[vehicle]]\nname = \"a\"\nstart = [0, 0, 0]\nplan = \"no.txt\"\n",
            "cannot read the plan",
        ),
        ("[fence]\nceiling_m = 2\nradius_m = 0.1\n", "f.toml:3:12"),
        ("[fence]\nceiling_m = 2\nradius_m = 0.1\n", "fence.radius_m is 0.1: it must lie in 0.5"),
        ("[fence]\nceiling_m = 0.6\nfloor_m = 0.7\n", "f.toml:3:11"),
        ("[fleet]\nseparation_m = 0.1\n", "f.toml:2:16"),
        ("[fleet]\nconfig = \"no.toml\"\n", "f.toml:2:10"),
        (
            "[[vehicle]]\nname = \"wingman\"\nstart = [0, 0, 0]\nagent = \"wingman\"\n\
             places = [[0, 1, 1, 0], [0, 12, 1, 0], [0, 1, 4, 0]]\n",
            "f.toml:5:25",
        ),
        (
            "[[vehicle]]\nname = \"wingman\"\nstart = [0, 0, 0]\nagent = \"wingman\"\n\
             places = [[0, 1, 1, 0], [0, 12, 1, 0], [0, 1, 4, 0]]\n",
            "place 3 of wingman is 4.00 m above the floor, above the ceiling of 3 m",
        ),
        ("[[vehicle]]\nname = \"a\"\nstart = [0, 0, 0]\nagents = \"b\"\n", "line 4, column 1"),
        (
            "[[vehicle]]\nname = \"a\"\nstart = [0, 0, 0]\nagent = \"b\"\n",
            "no agent is called `b`: built in are keeper, traveller, wingman",
        ),
        (
            "[[vehicle]]\nname = \"leader\"\nstart = [0, 0, 0]\nagent = \"wingman\"\n",
            "the agent of leader talks with `wingman`, which is no vehicle of this fleet",
        ),
        (
            "[[vehicle]]\nname = \"leader\"\nstart = [0, 0, 0]\nagent = \"wingman\"\nplan = \"no.txt\"\n",
            "leader has a plan and an agent",
        ),
        (
            "[[vehicle]]\nname = \"a\"\nstart = [0, 0, 0]\nplaces = [[0, 0, 1, 0]]\n",
            "a has places and no agent",
        ),
        ("[fleet]\nseparation_m = 0.1\n", "fleet.separation_m is 0.1"),
        ("[fleet]\nconfig = \"no.toml\"\n", "cannot read the settings"),
    ] {
        std::fs::write(&path, text).unwrap();
        let (status, error) = check(&path);
        assert_eq!(status, Some(20), "{text}");
        assert!(error.contains(said), "{text}: {error}");
    }
    std::fs::write(
        folder.path().join("one.toml"),
        "[vehicle]\nname = \"b\"\n[room]\nstart = [1, 0, 0]\n",
    )
    .unwrap();
    std::fs::write(&path, "[fleet]\nconfig = \"one.toml\"\n").unwrap();
    let (status, error) = check(&path);
    let said = "vehicle.name is one vehicle's: the fleet has it for each; room.start is one";
    assert!(status == Some(20) && error.contains(said), "{error}");
    let two = |name: &str, x_m: f64| {
        format!(
            "[[vehicle]]\nname = \"a\"\nstart = [0, 0, 0]\n[[vehicle]]\nname = \"{name}\"\nstart = [{x_m}, 0, 0]\n"
        )
    };
    for (text, said) in [
        (two("a", 5.0), "f.toml:5:8"),
        (two("b", 1.0), "b and a start 1.00 m from each other, and fly no nearer than 1.5 m"),
        (two("b", 1.6), "1.60 m from each other, give or take 0.14 m, and fly no nearer than 1.5"),
    ] {
        std::fs::write(&path, text).unwrap();
        let (status, error) = check(&path);
        assert!(status == Some(20) && error.contains(said), "{error}");
    }
    // The less is known of where they start, the further apart they have to.
    let roughly = two("b", 3.4).replace("[3.4, 0, 0]", "[3.4, 0, 0, 1, 20]");
    std::fs::write(&path, &roughly).unwrap();
    assert!(check(&path).1.contains("3.40 m from each other, give or take 2.00 m"));
    std::fs::write(&path, roughly.replace("3.4", "3.6")).unwrap();
    assert!(!check(&path).1.contains("from each other"));
    let many = "[[vehicle]]\nname = \"a\"\nstart = [0, 0, 0]\n".repeat(300);
    std::fs::write(&path, many).unwrap();
    assert!(check(&path).1.contains("a fleet has 1 to 32 vehicles, and this one 300"));
    std::fs::write(&path, two("b", 2.0)).unwrap();
    assert!(check(&path).1.contains("hear each other's ultrasound"));
    let output = program("ardrone-pilot").arg("fleet").arg(&path).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(20));
    assert!(error.contains("a and b are both to fly the drone at 192.168.1.1"), "{error}");
}
