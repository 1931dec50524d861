//! The two vehicles of `fleets/two.toml` on two machines: they change places over a network that is bad, cut, or has lost one of
//! the programs.

use std::path::PathBuf;
use std::process::Command;
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::{Duration, Instant};

use ardrone_pilot::fleet::Fleet;
use autopilot::plan::ZOrigin;
use mock_drone::firmware::Phase;
use mock_drone::server::{Air, MockDrone, Ports};
use nalgebra::Vector2;
use serde_json::{Value, json};

use crate::lab::{ADDRESSES, Lab};
use crate::pilot::{Pilot, fleets, has_told, program, refused, zenoh};

const NAMES: [&str; 2] = ["left", "right"];
/// Nobody may be nearer to another one, in truth.
const NEAREST_M: f64 = 0.8;
/// Longest flight.
const PATIENCE: Duration = Duration::from_secs(150);

/// Two machines, with a program and a simulated drone on each. The drones are in one air.
struct Room {
    lab: Lab,
    mocks: [MockDrone; 2],
    starts_m: [Vector2<f64>; 2],
    headings_deg: [f64; 2],
    pilots: [Pilot; 2],
    nearest_m: f64,
    folder: tempfile::TempDir,
}

/// A program's exit status, and what it said.
type Ended = (Option<i32>, Vec<Value>);

impl Room {
    fn new(protocol: &str) -> Option<Self> {
        Self::with(protocol, str::to_owned)
    }

    /// With a change of the fleet's file.
    fn with(protocol: &str, change: impl FnOnce(&str) -> String) -> Option<Self> {
        let mut lab = Lab::new()?;
        lab.wire(50, 0.1);
        let folder = tempfile::tempdir().unwrap();
        for file in ["left.txt", "right.txt"] {
            std::fs::copy(fleets().join(file), folder.path().join(file)).unwrap();
        }
        let fleet = Fleet::read(&fleets().join("two.toml"), ZOrigin::Hover).unwrap();
        let air = Air::default();
        let mocks = [0, 1].map(|end| {
            let world = fleet.members[end].world();
            lab.on(end, || MockDrone::start_in(&air, &world, Ports::LOOPBACK)).unwrap()
        });
        // Both machines read the same file.
        let mut text = change(&std::fs::read_to_string(fleets().join("two.toml")).unwrap());
        for (mock, address) in mocks.iter().zip(["192.168.1.10", "192.168.1.11"]) {
            let Ports { at, navdata, control, .. } = mock.ports();
            let ports =
                format!("at_port = {at}\nnavdata_port = {navdata}\ncontrol_port = {control}");
            let drone = format!("drone = \"{address}\"");
            assert!(text.contains(&drone));
            text = text.replace(&drone, &format!("drone = \"127.0.0.1\"\n{ports}"));
        }
        let path = folder.path().join("two.toml");
        std::fs::write(&path, text).unwrap();
        let pilots = [0, 1].map(|end| {
            let listen = format!("{protocol}/{}:7447", ADDRESSES[end]);
            let connect = format!("{protocol}/{}:7447", ADDRESSES[1 - end]);
            // One connects, the other one waits for it.
            let net = folder.path().join(format!("{}.json5", NAMES[end]));
            std::fs::write(&net, zenoh(&listen, (end == 1).then_some(&connect))).unwrap();
            let mut command = lab.command(end, &program());
            command.arg("fleet").arg(&path).args(["--json", "--no-log", "--vehicle", NAMES[end]]);
            Pilot::start(command.arg("--net").arg(&net))
        });
        let starts = [0, 1].map(|end| fleet.members[end].config.estimator.start.unwrap());
        Some(Self {
            lab,
            mocks,
            starts_m: starts.map(|start| start.place_m),
            headings_deg: starts.map(|start| start.heading_deg),
            pilots,
            nearest_m: f64::INFINITY,
            folder,
        })
    }

    /// Where both are in truth; nothing of one on the ground.
    fn places_m(&self) -> [Option<Vector2<f64>>; 2] {
        let turned = self.headings_deg.iter().any(|heading_deg| *heading_deg != 0.0);
        assert!(!turned, "places are turned otherwise");
        [0, 1].map(|end| {
            let truth = self.mocks[end].truth();
            let is_up = truth.position_m.z > 0.1;
            is_up.then(|| self.starts_m[end] + truth.position_m.xy())
        })
    }

    /// Watches the truth until something is so.
    fn watch(&mut self, mut is_so: impl FnMut(&mut Self) -> bool) {
        let start = Instant::now();
        while !is_so(self) {
            assert!(
                start.elapsed() < PATIENCE,
                "{:?}",
                self.mocks.each_ref().map(MockDrone::truth)
            );
            if let [Some(left), Some(right)] = self.places_m() {
                self.nearest_m = self.nearest_m.min((left - right).norm());
            }
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Until both fly towards each other, and are so near.
    fn until_they_meet(&mut self, away_m: f64) {
        self.watch(|room| match room.places_m() {
            [Some(left), Some(right)] => (left - right).norm() < away_m,
            _ => false,
        });
    }

    fn watch_for(&mut self, time: Duration) {
        let start = Instant::now();
        self.watch(|_| start.elapsed() >= time);
    }

    /// Until all programs have ended and both drones are on the ground; how that was.
    fn until_the_end(mut self) -> ([Ended; 2], f64) {
        self.watch(|room| {
            let is_down = |mock: &MockDrone| {
                matches!(mock.truth().phase, Phase::Landed) && mock.truth().position_m.z < 0.1
            };
            !room.pilots.iter_mut().any(Pilot::is_running) && room.mocks.iter().all(is_down)
        });
        let Self { pilots, nearest_m, lab, folder, .. } = self;
        let ended = pilots.map(Pilot::end);
        drop((lab, folder));
        (ended, nearest_m)
    }
}

#[test]
fn two_change_places_over_a_bad_network() {
    for protocol in ["tcp", "udp"] {
        let Some(room) = Room::new(protocol) else { return };
        let ([(left, left_said), (right, right_said)], nearest_m) = room.until_the_end();
        eprintln!("{protocol}: nearest {nearest_m:.2} m");
        assert_eq!((left, right), (Some(0), Some(0)), "{:?}", left_said.last());
        assert!((NEAREST_M..5.5).contains(&nearest_m), "{nearest_m}");
        for (said, other) in [(&left_said, "right"), (&right_said, "left")] {
            let heard = said.iter().find(|object| object["type"] == "network").unwrap();
            assert_eq!((&heard["vehicle"], &heard["heard"]), (&json!(other), &json!(true)));
            let network = &said.last().unwrap()["network"];
            let [told, heard] = ["told", "heard"].map(|key| network[key].as_u64().unwrap());
            assert!(told > 200 && heard > 100, "{network}");
            for why in ["malformed", "absurd", "clock", "flown_here", "other_fleet", "two_programs"]
            {
                assert_eq!(refused(said, why), 0, "{network}");
            }
        }
    }
}

/// Both land, or go on when they hear each other again; what was held back by then is not taken for news.
#[test]
fn a_partition_in_flight_brings_nobody_together() {
    let Some(mut room) = Room::new("tcp") else { return };
    room.until_they_meet(4.0);
    room.lab.wire(50, 1.0);
    room.watch_for(Duration::from_secs(5));
    room.lab.wire(50, 0.1);
    let (ended, nearest_m) = room.until_the_end();
    eprintln!("nearest {nearest_m:.2} m; {:?}", ended.each_ref().map(|(status, _)| status));
    assert!(nearest_m > NEAREST_M, "{nearest_m}");
    for (status, said) in &ended {
        assert!(matches!(status, Some(0 | 40)), "{status:?} {:?}", said.last());
        assert!(has_told(said, "heard", &json!(false)), "{:?}", said.last());
        eprintln!("{}", said.last().unwrap()["network"]);
    }
}

/// TCP keeps what it could not deliver, and may bring it when it can; that is not taken for news.
#[test]
fn after_a_partition_they_hear_each_other_again() {
    let without_plans = |text: &str| {
        text.lines().filter(|line| !line.starts_with("plan =")).collect::<Vec<_>>().join("\n")
    };
    let Some(mut room) = Room::with("tcp", without_plans) else { return };
    let came = |said: &[Value]| {
        said.iter().filter(|it| it["type"] == "network" && it["heard"] == true).count()
    };
    let patience = Duration::from_mins(1);
    for pilot in &room.pilots {
        pilot.until(patience, |object| object["type"] == "network" && object["heard"] == true);
    }
    room.lab.wire(50, 1.0);
    room.watch_for(Duration::from_secs(6));
    room.lab.wire(50, 0.0);
    room.watch(|room| room.pilots.iter().all(|pilot| came(&pilot.said()) == 2));
    room.watch_for(Duration::from_secs(1));
    room.pilots.iter_mut().for_each(Pilot::quit);
    let (ended, _) = room.until_the_end();
    for (status, said) in &ended {
        assert_eq!(*status, Some(0));
        assert!(has_told(said, "heard", &json!(false)));
        eprintln!("{}", said.last().unwrap()["network"]);
        for why in ["clock", "absurd", "malformed", "two_programs"] {
            assert_eq!(refused(said, why), 0, "{:?}", said.last());
        }
    }
}

/// Its drone lands by itself, and nobody hears of it any more.
#[test]
fn a_program_that_is_killed_in_flight_brings_nobody_together() {
    let Some(mut room) = Room::new("tcp") else { return };
    room.until_they_meet(4.0);
    room.pilots[1].kill();
    let ([(left, said), (right, _)], nearest_m) = room.until_the_end();
    eprintln!("nearest {nearest_m:.2} m; {left:?}");
    assert!(nearest_m > NEAREST_M, "{nearest_m}");
    assert!(matches!(left, Some(0 | 40)), "{left:?} {:?}", said.last());
    assert_eq!(right, None, "killed");
    assert!(has_told(&said, "heard", &json!(false)));
}

/// Somebody looks on, by a program in Python.
#[test]
fn the_example_in_python_prints_the_states() {
    let Some(python) = std::env::var_os("ZENOH_PYTHON") else {
        assert!(
            std::env::var_os("CI").is_none(),
            "ZENOH_PYTHON names no Python with eclipse-zenoh"
        );
        eprintln!("skipped: ZENOH_PYTHON names no Python with eclipse-zenoh");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let net = folder.path().join("net.json5");
    let at = format!("tcp/{}", own_address());
    std::fs::write(&net, zenoh(&at, None)).unwrap();
    let mut command = Command::new(program());
    command.arg("fleet").arg(fleets().join("two.toml")).args(["--mock", "--json", "--no-log"]);
    let pilot = Pilot::start(command.arg("--net").arg(&net));
    pilot.until(Duration::from_mins(1), |object| object["airborne"] == true);
    let script: PathBuf = fleets().join("watch.py");
    let output = Command::new(python)
        .arg(script)
        .args(["two", "--connect", &at, "--count", "60"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(said.lines().count(), 60, "{said}");
    for name in NAMES {
        let flies = |line: &str| line.starts_with(name) && line.contains("flies");
        assert!(said.lines().any(flies), "{said}");
    }
    let (status, _) = pilot.end();
    assert_eq!(status, Some(0));
}

/// An address of this machine with a port that no other test has.
pub(crate) fn own_address() -> String {
    static NUMBER: AtomicU8 = AtomicU8::new(1);
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    format!("127.{}.{number}.1:7447", 64 + std::process::id() % 64)
}
