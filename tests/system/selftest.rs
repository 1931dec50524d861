//! A drone is asked what is assumed of its firmware: the simulated one passes, and each of its lies is found.

use std::collections::BTreeSet;
use std::time::Duration;

use ardrone_link::at::{Command, Config, ControlMode, Datagram, Ref};
use ardrone_link::selftest::{Assumption, Contact, Heard, Outcome, Refusal, Report, examine};
use autopilot::vehicle::VehicleConfig;
use mock_drone::firmware::Phase;
use mock_drone::server::{MockDrone, Ports};
use mock_drone::{DroneConfig, Lies, LinkFaults, Message, World, WorldConfig};

use crate::processes::program;

/// The simulated drone in simulated time, without video and FTP.
struct Simulated {
    world: World,
    now: Duration,
    /// Everything that was sent, for what must never be.
    sent: Vec<u8>,
    /// Another client takes off then.
    taken_off_at: Option<Duration>,
    /// When it was last seen on the ground, and how much had been sent by then.
    grounded: (Duration, usize),
    /// The examination is called off then.
    stopped_at: Option<Duration>,
}

/// How finely time passes.
const STEP: Duration = Duration::from_micros(2500);

impl Contact for Simulated {
    fn now(&self) -> Duration {
        self.now
    }

    fn send(&mut self, datagram: &[u8]) {
        self.sent.extend_from_slice(datagram);
        self.world.send_at(self.now, datagram);
    }

    fn wake(&mut self) {
        self.world.send_wake_up(self.now, &ardrone_link::WAKE_UP);
    }

    fn next(&mut self, until: Duration) -> Option<Heard> {
        loop {
            match self.world.receive(self.now) {
                Some(Message::Navdata(packet)) => return Some(Heard::Navdata(packet)),
                Some(Message::Control(text)) => return Some(Heard::Control(text.into())),
                None if self.now >= until => return None,
                None => {
                    self.now = (self.now + STEP).min(until);
                    self.world.advance(self.now);
                    self.others();
                }
            }
        }
    }

    fn watch(&mut self) -> bool {
        false
    }

    fn is_stopped(&self) -> bool {
        self.stopped_at.is_some_and(|at| self.now >= at)
    }

    fn version(&mut self) -> Option<Result<String, String>> {
        None
    }
}

impl Simulated {
    fn new(config: &WorldConfig) -> Self {
        Self {
            world: World::new(config),
            now: Duration::ZERO,
            sent: Vec::new(),
            taken_off_at: None,
            grounded: (Duration::ZERO, 0),
            stopped_at: None,
        }
    }

    /// What another client does meanwhile.
    fn others(&mut self) {
        if self.world.truth().phase == Phase::Landed {
            self.grounded = (self.now, self.sent.len());
        }
        if self.taken_off_at.take_if(|at| *at <= self.now).is_some() {
            let mut datagram = Datagram::new();
            datagram.push(1_000_000, &Command::Ref(Ref::TakeOff)).unwrap();
            self.world.send_at(self.now, datagram.as_bytes());
        }
    }
}

fn simulated(drone: DroneConfig, link: LinkFaults) -> Simulated {
    Simulated::new(&WorldConfig { drone, link, ..WorldConfig::default() })
}

fn examined(drone: &mut Simulated) -> Result<Report, Refusal> {
    let settings = VehicleConfig::default().drone_settings().unwrap();
    let mut told = Vec::new();
    let report = examine(drone, &settings, &mut |check| told.push(check.clone()))?;
    assert_eq!(told, report.checks);
    Ok(report)
}

fn differing(report: &Report) -> BTreeSet<&'static str> {
    let differs = report.checks.iter().filter(|check| matches!(check.outcome, Outcome::Differs(_)));
    differs.map(|check| check.assumption.name()).collect()
}

/// The configuration that a drone would send now.
fn configuration(world: &mut World) -> String {
    let now = world.truth().time + Duration::from_millis(100);
    let mut datagram = Datagram::new();
    datagram.push(1, &Command::Control(ControlMode::SendConfiguration)).unwrap();
    world.send_at(now, datagram.as_bytes());
    world.advance(now + STEP);
    std::iter::from_fn(|| world.receive(now + STEP))
        .find_map(|message| match message {
            Message::Control(text) => Some(text),
            Message::Navdata(_) => None,
        })
        .unwrap()
}

#[test]
fn the_simulated_drone_is_as_it_is_assumed_to_be_and_stays_on_the_ground() {
    let mut drone = simulated(DroneConfig::default(), LinkFaults::default());
    // Each client sets this first, whatever it was.
    let before = configuration(&mut drone.world.clone())
        .replace("navdata_demo = FALSE", "navdata_demo = TRUE");
    let report = examined(&mut drone).unwrap();
    assert_eq!(differing(&report), BTreeSet::new(), "{report:#?}");
    let asked: Vec<_> = report.checks.iter().map(|check| check.assumption).collect();
    assert_eq!(asked.len(), Assumption::ALL.len(), "each once");
    let unasked =
        report.checks.iter().filter(|check| matches!(check.outcome, Outcome::NotAsked(_)));
    let unasked: Vec<_> = unasked.map(|check| check.assumption).collect();
    assert_eq!(unasked, [Assumption::Video], "there is no video in simulated time");
    assert!(!report.is_as_assumed(), "what was not asked is not known");
    assert_eq!(configuration(&mut drone.world), before, "what was set is set back");
    let sent = String::from_utf8(drone.sent).unwrap();
    for never in ["AT*REF", "AT*PCMD", "AT*FTRIM", "AT*CALIB", "AT*ANIM", "flight_anim"] {
        assert!(!sent.contains(never), "{never}");
    }
    assert!(drone.world.truth().position_m.z.abs() < 1e-9);
}

/// What each lie is found by, alone.
const FOUND_BY: [(&str, &[&str]); 28] = [
    ("no-acknowledgement", &["acknowledged", "found-again", "settings"]),
    ("stuck-acknowledgement", &["acknowledgement-cleared", "number-one", "old-numbers"]),
    ("fixed-ceiling", &["settings"]),
    ("tilt-in-degrees", &["settings"]),
    ("obeys-old-numbers", &["old-numbers"]),
    ("ignores-number-one", &["number-one"]),
    ("no-watchdog", &[]),
    ("stuck-watchdog", &["watchdog-cleared"]),
    ("patient-link", &["lost-link"]),
    ("deaf-after-loss", &["found-again"]),
    ("no-configuration", &["configuration"]),
    ("endless-configuration", &["configuration"]),
    ("missing-key", &["settings"]),
    ("other-version", &["version"]),
    ("slow-demo", &["demo-rate"]),
    ("slow-full", &["full-rate"]),
    ("fixed-options", &["requested-options"]),
    ("short-option", &["all-options", "requested-options"]),
    ("wrong-checksum", &["intact"]),
    ("repeated-number", &["counted"]),
    ("claims-to-fly", &[]),
    ("fast-clock", &["clock"]),
    ("charge-in-millivolts", &["charge"]),
    ("gravity-up", &["attitude", "gravity"]),
    ("tilted", &["attitude"]),
    ("moves-at-rest", &["at-rest"]),
    ("claims-to-hover", &["at-rest"]),
    ("follows-tags", &["unset-keys"]),
];
/// Those of the video, which is not simulated in simulated time.
const OF_THE_VIDEO: [&str; 2] = ["other-codec", "other-size"];

#[test]
fn each_lie_is_found() {
    let mut names: Vec<_> = FOUND_BY.iter().map(|(name, _)| *name).chain(OF_THE_VIDEO).collect();
    let mut all = Lies::names();
    names.sort_unstable();
    all.sort_unstable();
    assert_eq!(names, all, "each lie is tried");
    for (name, found_by) in FOUND_BY {
        let lies = Lies::named(name).unwrap();
        let mut drone =
            simulated(DroneConfig { lies, ..DroneConfig::default() }, LinkFaults::default());
        let found = examined(&mut drone);
        // With these it is not examined at all.
        if lies == Lies::CLAIMS_TO_FLY {
            assert_eq!(found, Err(Refusal::Flies));
            assert!(drone.sent.is_empty(), "no command is sent to a drone that flies");
            continue;
        }
        if lies == Lies::NO_WATCHDOG {
            assert_eq!(found, Err(Refusal::Commanded));
            continue;
        }
        let report = found.unwrap();
        let expected: BTreeSet<_> = found_by.iter().copied().collect();
        assert_eq!(differing(&report), expected, "{name}: {report:#?}");
    }
}

#[test]
fn no_command_is_sent_to_a_drone_that_flies_is_silent_or_obeys_somebody_else() {
    let flies = DroneConfig { flies_at_m: Some(1.0), ..DroneConfig::default() };
    let mut flying = simulated(flies, LinkFaults::default());
    assert_eq!(examined(&mut flying), Err(Refusal::Flies));
    assert!(flying.sent.is_empty());
    let mut gone =
        simulated(DroneConfig::default(), LinkFaults { loss: 1.0, ..LinkFaults::default() });
    assert_eq!(examined(&mut gone), Err(Refusal::Silent));
    assert!(gone.sent.is_empty());
    let scenario = mock_drone::scenario::Scenario::parse("s", "0 second-pilot 60").unwrap();
    let mut commanded = Simulated::new(&WorldConfig { scenario, ..WorldConfig::default() });
    // Somebody has configured the drone, and flies it soon.
    let mut datagram = Datagram::new();
    let demo = Config::new("general:navdata_demo", "TRUE").unwrap();
    datagram.push(1, &Command::Config(demo)).unwrap();
    commanded.world.send_at(Duration::ZERO, datagram.as_bytes());
    let refused = examined(&mut commanded);
    assert!(matches!(refused, Err(Refusal::Commanded | Refusal::Flies)), "{refused:?}");
    assert!(commanded.sent.is_empty());
}

/// Whatever is asked just then, not a command is sent after the first packet that says so.
#[test]
fn a_drone_that_another_client_lifts_meanwhile_is_left_alone() {
    for seconds in 3..18 {
        let mut drone = simulated(DroneConfig::default(), LinkFaults::default());
        drone.taken_off_at = Some(Duration::from_secs(seconds));
        let found = examined(&mut drone);
        assert!(matches!(found, Err(Refusal::Flies | Refusal::Commanded)), "{seconds}: {found:?}");
        let (at, sent) = drone.grounded;
        let sent = String::from_utf8_lossy(&drone.sent[sent..]).into_owned();
        // Until the next packet, which comes after 67 ms at most, we cannot know.
        assert!(sent.lines().count() <= 8, "{seconds}, from {at:?}: {sent}");
        assert!(drone.now < at + Duration::from_secs(6), "{seconds}: it ends soon");
    }
}

#[test]
fn an_examination_that_is_called_off_sets_back_what_it_has_set() {
    let before = configuration(&mut World::new(&WorldConfig::default()));
    let before = before.replace("navdata_demo = FALSE", "navdata_demo = TRUE");
    // Later it is the last question, after which there is nothing to be set back.
    for seconds in 1..15 {
        let mut drone = simulated(DroneConfig::default(), LinkFaults::default());
        drone.stopped_at = Some(Duration::from_secs(seconds));
        assert_eq!(examined(&mut drone), Err(Refusal::Stopped), "{seconds}");
        let after = configuration(&mut drone.world);
        let after = after.replace("navdata_demo = FALSE", "navdata_demo = TRUE");
        assert_eq!(after, before, "{seconds}");
        assert!(drone.now < Duration::from_secs(seconds + 12), "{seconds}: {:?}", drone.now);
    }
}

/// A link that loses is none of the firmware's lies.
#[test]
fn a_bad_link_is_not_taken_for_a_lie() {
    for seed in 1..=5 {
        let link = LinkFaults {
            loss: 0.05,
            delay: Duration::from_millis(10),
            jitter: Duration::from_millis(5),
            ..LinkFaults::default()
        };
        let mut drone = simulated(DroneConfig { seed, ..DroneConfig::default() }, link);
        let report = examined(&mut drone).unwrap();
        assert_eq!(differing(&report), BTreeSet::new(), "{seed}: {report:#?}");
    }
}

/// Over sockets, with video and FTP: the program, as it is called.
#[test]
fn the_program_examines_a_drone_on_its_ports() {
    let examined = |lies: Lies| {
        let drone = DroneConfig { lies, ..DroneConfig::default() };
        let ports = Ports { video: Some(0), ftp: Some(0), ..Ports::LOOPBACK };
        let config = WorldConfig { drone, ..WorldConfig::default() };
        let mock = MockDrone::start(&config, ports).unwrap();
        let ports = mock.ports();
        let mut pilot = program("ardrone-pilot");
        pilot.args(["selftest", "--json", "--drone", &ports.host.to_string()]);
        for (name, port) in [
            ("--at-port", Some(ports.at)),
            ("--navdata-port", Some(ports.navdata)),
            ("--control-port", Some(ports.control)),
            ("--video-port", ports.video),
            ("--ftp-port", ports.ftp),
        ] {
            pilot.args([name, &port.unwrap().to_string()]);
        }
        let output = pilot.output().unwrap();
        let lines = String::from_utf8_lossy(&output.stdout);
        let lines: Vec<serde_json::Value> =
            lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        let differing = lines.iter().filter(|line| line["outcome"] == "differs");
        let text = |value: &serde_json::Value| value.as_str().unwrap().to_owned();
        let differing: Vec<_> =
            differing.map(|line| (text(&line["assumption"]), text(&line["seen"]))).collect();
        let end = lines.last().unwrap();
        assert_eq!(end["not_asked"], 0, "{lines:#?}");
        assert_eq!(end["exit_status"], output.status.code().unwrap());
        (output.status.code(), differing)
    };
    // No more than two at once: each encodes its video, and a machine that is busy with four shows too few pictures a second.
    let lies = Lies::OTHER_CODEC | Lies::OTHER_VERSION;
    let [honest, lying] =
        [Lies::empty(), lies].map(|lies| std::thread::spawn(move || examined(lies)));
    assert_eq!(honest.join().unwrap(), (Some(0), Vec::new()));
    let (status, differing) = lying.join().unwrap();
    assert_eq!(status, Some(70));
    let of_the_video: Vec<_> = differing.iter().filter(|(what, _)| what == "video").collect();
    assert_eq!(of_the_video, [&("video".to_owned(), "the codec is Mpeg4".to_owned())]);
    // The configuration says another version, and something else than the file.
    let of_the_version = differing.iter().filter(|(what, _)| what == "version").count();
    assert_eq!((of_the_version, differing.len()), (2, 3), "{differing:#?}");
    let size = ("video".to_owned(), "a picture has 320 x 360".to_owned());
    assert_eq!(examined(Lies::OTHER_SIZE), (Some(70), vec![size]));
}
