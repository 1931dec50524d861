//! Two connections of one fleet in one process: states, lines of agents, and who is kept out by Zenoh's configuration.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use ardrone_pilot::flight::{Placed, Places, Seat};
use ardrone_pilot::network::bridge::{Bridge, NetworkConfig, NetworkError};
use ardrone_pilot::network::{LONGEST_LINE_BYTES, LineError, NoLine, Roster, Talk, WAITING};
use ardrone_pilot::runtime::{Runtime, SecondSignal};
use autopilot::separation::{Neighbour, Presence};
use autopilot::vehicle::{Start, VehicleName};
use nalgebra::Vector2;
use zenoh::Wait as _;

use crate::flights::own_address;
use crate::lab::Lab;
use crate::pilot::{Pilot, fleets, program, zenoh};

const PATIENCE: Duration = Duration::from_secs(20);

pub(crate) fn roster(here: &str) -> Roster {
    let vehicles = [("left", 1, -2.5), ("right", 2, 2.5)].map(|(name, system, x_m)| {
        let start = Start {
            place_m: Vector2::new(x_m, 0.0),
            heading_deg: 0.0,
            uncertainty_m: 0.05,
            ..Start::default()
        };
        (name.parse().unwrap(), system, start)
    });
    Roster::new("two".parse().unwrap(), vehicles, &[here.parse().unwrap()]).unwrap()
}

pub(crate) fn stands(system: u8) -> Neighbour {
    Neighbour {
        system,
        at: Duration::ZERO,
        place_m: Vector2::new(f64::from(system), 0.5),
        velocity_m_s: Vector2::zeros(),
        uncertainty_m: 0.1,
        separation_m: 1.5,
        presence: Presence::Stands,
        claim: None,
    }
}

/// A program that flies one vehicle.
struct Program {
    bridge: Bridge,
    places: Places,
    own: usize,
}

impl Program {
    fn open(runtime: &Runtime, own: usize, config: &Path) -> Result<Self, NetworkError> {
        let names = ["left", "right"].map(|name| name.parse().unwrap());
        let places = Seat::in_one_room(names).next().unwrap().places();
        let roster = roster(["left", "right"][own]);
        let config = NetworkConfig::read(config)?;
        let bridge = Bridge::open(runtime, config, roster, places.clone())?;
        Ok(Self { bridge, places, own })
    }

    /// Its vehicle is where it is now.
    fn tick(&self) {
        let system = u8::try_from(self.own + 1).unwrap();
        let placed = Placed { at: Instant::now(), neighbour: stands(system), is_parked: false };
        self.places.write(self.own, placed);
    }

    fn heard(&self) -> Option<Placed> {
        self.places.read(1 - self.own)
    }

    fn talk(&mut self) -> Talk {
        self.bridge.take_talk(self.own).unwrap()
    }
}

/// Whether both hear each other before the time is over.
fn hear_each_other(programs: &[Program; 2], patience: Duration) -> bool {
    let start = Instant::now();
    while start.elapsed() < patience {
        programs.iter().for_each(Program::tick);
        if programs.iter().all(|program| program.heard().is_some()) {
            return true;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    false
}

fn written(folder: &tempfile::TempDir, name: &str, text: &str) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    path
}

#[test]
fn states_and_lines_go_both_ways_and_the_last_word_is_how_the_drone_was_left() {
    let folder = tempfile::tempdir().unwrap();
    let at = format!("tcp/{}", own_address());
    let runtime = Runtime::start(SecondSignal::IsPassedOn).unwrap();
    let configs = [
        written(&folder, "left.json5", &zenoh(&at, None)),
        written(&folder, "right.json5", &zenoh(&format!("tcp/{}", own_address()), Some(&at))),
    ];
    let mut programs = [0, 1].map(|own| Program::open(&runtime, own, &configs[own]).unwrap());
    assert!(hear_each_other(&programs, PATIENCE));
    let heard = programs[0].heard().unwrap();
    assert_eq!((heard.neighbour.system, heard.is_parked), (2, false));
    assert!(heard.at.elapsed() < Duration::from_secs(2), "{heard:?}");

    let [mut left, mut right] = programs.each_mut().map(Program::talk);
    assert!(programs[0].bridge.take_talk(0).is_none() && programs[0].bridge.take_talk(1).is_none());
    let [to_left, to_right]: [VehicleName; 2] = ["left", "right"].map(|name| name.parse().unwrap());
    let longest = "x".repeat(LONGEST_LINE_BYTES);
    assert_eq!(
        left.say(to_right, &(longest.clone() + "x")),
        Err(LineError::NoLine(NoLine::TooLong))
    );
    left.say(to_right, "tell held(3)").unwrap();
    left.say(to_right, &longest).unwrap();
    right.say(to_left, "achieve come").unwrap();
    let next = |talk: &Talk| {
        let start = Instant::now();
        loop {
            if let Some(line) = talk.next_line() {
                return (line.from.to_string(), line.text.to_string());
            }
            assert!(start.elapsed() < PATIENCE);
            std::thread::sleep(Duration::from_millis(5));
        }
    };
    assert_eq!(next(&right), ("left".to_owned(), "tell held(3)".to_owned()));
    assert_eq!(next(&right), ("left".to_owned(), longest));
    assert_eq!(next(&left), ("right".to_owned(), "achieve come".to_owned()));

    // Somebody says more than is read, and what is no line, also in the name of who is flown there.
    let foreign =
        zenoh::Config::from_json5(&zenoh(&format!("tcp/{}", own_address()), Some(&at))).unwrap();
    let foreign = zenoh::open(foreign).wait().unwrap();
    std::thread::sleep(Duration::from_millis(500));
    for (from, text) in
        [("right", "a\nb"), ("left", "a"), ("up", "a"), ("right", &"x".repeat(513)[..])]
    {
        foreign.put(format!("ardrone/two/{from}/agent/left"), text).wait().unwrap();
    }
    for number in 0..WAITING + 9 {
        foreign.put("ardrone/two/right/agent/left", number.to_string()).wait().unwrap();
    }
    let start = Instant::now();
    while left.dropped() != [0, 9] {
        assert!(start.elapsed() < PATIENCE, "{:?}", left.dropped());
        std::thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(next(&left).1, "0", "the newest were dropped");
    let whys: Vec<&str> =
        programs[0].bridge.totals().refused.iter().map(|count| count.why.name()).collect();
    for why in ["malformed", "flown_here", "unknown", "too_long", "full"] {
        assert!(whys.contains(&why), "{whys:?}");
    }

    let [left, right] = programs;
    let placed = right.places.read(1).unwrap();
    right.places.write(1, Placed { at: Instant::now(), is_parked: true, ..placed });
    let totals = right.bridge.end();
    assert!(totals.told > 0 && totals.heard > 0, "{totals:?}");
    let start = Instant::now();
    while !left.heard().unwrap().is_parked {
        assert!(start.elapsed() < PATIENCE);
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Makes an authority, and certificates of it for both machines; all have the prefix.
fn certificates(folder: &Path, prefix: &str) {
    let openssl = |arguments: &str| {
        let output = Command::new("openssl")
            .current_dir(folder)
            .args(arguments.split(' '))
            .output()
            .unwrap();
        assert!(
            output.status.success(),
            "{arguments}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
    };
    openssl(&format!(
        "req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 2 -subj /CN=fleet -keyout {prefix}ca.key -out {prefix}ca.pem"
    ));
    std::fs::write(
        folder.join("names.cnf"),
        "subjectAltName = IP:127.0.0.1\nextendedKeyUsage = serverAuth, clientAuth\nbasicConstraints = CA:FALSE\n",
    )
    .unwrap();
    for name in ["left", "right"] {
        openssl(&format!(
            "req -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -subj /CN={name} -keyout {prefix}{name}.key -out {prefix}{name}.csr"
        ));
        openssl(&format!(
            "x509 -req -days 2 -in {prefix}{name}.csr -CA {prefix}ca.pem -CAkey {prefix}ca.key -CAcreateserial -extfile names.cnf -out {prefix}{name}.pem"
        ));
    }
}

/// The configuration of docs/fleet.md.
fn with_tls(
    folder: &Path,
    prefix: &str,
    name: &str,
    listen: &str,
    connect: Option<&str>,
) -> String {
    let file = |suffix: &str| folder.join(format!("{prefix}{suffix}")).display().to_string();
    let connect = connect.map(|at| format!("\"{at}\"")).unwrap_or_default();
    let (ca, key, certificate) =
        (file("ca.pem"), file(&format!("{name}.key")), file(&format!("{name}.pem")));
    format!(
        r#"{{
  mode: "peer",
  listen: {{ endpoints: ["{listen}"] }},
  connect: {{ endpoints: [{connect}] }},
  transport: {{
    link: {{
      tls: {{
        enable_mtls: true,
        root_ca_certificate: "{ca}",
        listen_private_key: "{key}",
        listen_certificate: "{certificate}",
        connect_private_key: "{key}",
        connect_certificate: "{certificate}",
      }},
    }},
  }},
}}"#
    )
}

#[test]
fn with_certificates_only_who_has_one_of_the_fleets_authority_is_heard() {
    let folder = tempfile::tempdir().unwrap();
    certificates(folder.path(), "");
    certificates(folder.path(), "foreign-");
    let runtime = Runtime::start(SecondSignal::IsPassedOn).unwrap();
    let hear = |prefix: &str, patience| {
        // The address that the certificates name.
        let port = 20_000 + std::process::id() % 10_000 + u32::from(!prefix.is_empty());
        let at = format!("tls/127.0.0.1:{port}");
        let configs = [
            written(&folder, "left.json5", &with_tls(folder.path(), "", "left", &at, None)),
            written(
                &folder,
                "right.json5",
                &with_tls(
                    folder.path(),
                    prefix,
                    "right",
                    &format!("tls/{}", own_address()),
                    Some(&at),
                ),
            ),
        ];
        let programs = [0, 1].map(|own| Program::open(&runtime, own, &configs[own]).unwrap());
        hear_each_other(&programs, patience)
    };
    assert!(hear("", PATIENCE));
    assert!(!hear("foreign-", Duration::from_secs(4)));
}

#[test]
fn with_passwords_only_who_has_one_is_heard() {
    let folder = tempfile::tempdir().unwrap();
    let runtime = Runtime::start(SecondSignal::IsPassedOn).unwrap();
    let dictionary = written(&folder, "passwords.txt", "left:apple\nright:pear\n");
    let config = |listen: &str, connect: Option<&str>, user: &str, password: &str| {
        let auth = format!(
            "transport: {{ auth: {{ usrpwd: {{ user: \"{user}\", password: \"{password}\", dictionary_file: \"{}\" }} }} }}, listen:",
            dictionary.display()
        );
        zenoh(listen, connect).replace("listen:", &auth)
    };
    let hear = |password: &str, patience| {
        let at = format!("tcp/{}", own_address());
        let configs = [
            written(&folder, "left.json5", &config(&at, None, "left", "apple")),
            written(
                &folder,
                "right.json5",
                &config(&format!("tcp/{}", own_address()), Some(&at), "right", password),
            ),
        ];
        let programs = [0, 1].map(|own| Program::open(&runtime, own, &configs[own]).unwrap());
        hear_each_other(&programs, patience)
    };
    assert!(hear("pear", PATIENCE));
    assert!(!hear("plum", Duration::from_secs(4)));
}

/// The port at which Zenoh looks for others by multicast, and the group, as the kernel writes them.
const SCOUTING: [(&str, &str); 2] = [("udp", ":1D16 "), ("igmp", "E00000E0")];

/// What a program does without being told would have it find, and be found by, whoever is in the same network.
#[test]
fn others_are_looked_for_by_multicast_only_if_the_file_says_so() {
    let Some(lab) = Lab::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    for (text, is_wanted) in [
        ("{ mode: \"peer\" }", false),
        ("{ scouting: { gossip: { enabled: true } } }", false),
        ("{ mode: \"peer\", scouting: { multicast: { enabled: true } } }", true),
    ] {
        let net = written(&folder, "net.json5", text);
        let mut command = lab.command(0, &program());
        command.arg("fleet").arg(fleets().join("two.toml")).args(["--mock", "--json", "--no-log"]);
        let pilot = Pilot::start(command.args(["--vehicle", "left", "--net"]).arg(net));
        // It flies, so that the network is there.
        pilot.until(PATIENCE, |object| object["type"] == "status");
        for (file, entry) in SCOUTING {
            let path = format!("/proc/{}/net/{file}", pilot.id());
            let open = std::fs::read_to_string(path).unwrap();
            assert_eq!(open.contains(entry), is_wanted, "{text}, {file}: {open}");
        }
    }
}

#[test]
fn what_is_no_configuration_is_said_with_its_file() {
    let folder = tempfile::tempdir().unwrap();
    for text in ["", "{ mode: \"pear\" }", "{ listen: 1 }", "{"] {
        let path = written(&folder, "net.json5", text);
        let error = NetworkConfig::read(&path).unwrap_err().to_string();
        assert!(error.contains("net.json5: no configuration of Zenoh"), "{text}: {error}");
    }
    assert!(NetworkConfig::read(&folder.path().join("none.json5")).is_err());
}

/// Zenoh tells only once who listens to what: a datagram that is lost would leave two vehicles deaf to each other.
#[test]
fn datagrams_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let runtime = Runtime::start(SecondSignal::IsPassedOn).unwrap();
    let at = format!("udp/{}", own_address());
    for text in [zenoh(&at, None), zenoh(&format!("tcp/{}", own_address()), Some(&at))] {
        let path = written(&folder, "net.json5", &text);
        let error = Program::open(&runtime, 0, &path).map(|_| ()).unwrap_err().to_string();
        assert!(error.contains("not supported for udp"), "{error}");
    }
}
