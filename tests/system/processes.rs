//! Both programs as separate processes.

use std::fs::File;
use std::io::{BufRead as _, BufReader, Write as _};
use std::net::{Ipv4Addr, UdpSocket};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Output, Stdio};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use ardrone_link::at::{self, Datagram, Motion, Ref};
use ardrone_pilot::recording::Log;
use mock_drone::WorldConfig;
use mock_drone::firmware::Phase;
use mock_drone::server::{MockDrone, Ports};
use system_tests::lateness::Lateness;

/// A program of this workspace, built in the same profile.
pub(crate) fn program(name: &str) -> Command {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| {
        // Who has built them, and runs another cargo now that holds the folder, says so.
        if std::env::var_os("PROGRAMS_ARE_BUILT").is_none() {
            let mut build = Command::new(env!("CARGO"));
            // All packages: the dependencies of some of them would have other features, and be built again.
            build.args(["build", "--quiet", "--workspace", "--bins"]);
            if !cfg!(debug_assertions) {
                build.arg("--release");
            }
            assert!(build.status().unwrap().success());
        }
        // The test is in `deps`, below the folder of the programs.
        let test = std::env::current_exe().unwrap();
        test.ancestors().nth(2).unwrap().to_owned()
    });
    Command::new(folder.join(name))
}

/// Starts a pilot with a page; also returns the address that it prints.
pub(crate) fn with_page(pilot: &mut Command) -> (Child, String) {
    let mut child = pilot.stderr(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
    let url = lines
        .find_map(|line| Some(line.unwrap().strip_prefix("watch it at ")?.to_owned()))
        .unwrap();
    // Further messages must not fill the pipe.
    std::thread::spawn(move || lines.for_each(drop));
    (child, url)
}

/// A mock drone process, killed when dropped.
struct MockProcess {
    child: Child,
    /// AT, navdata, control.
    ports: [u16; 3],
}

impl MockProcess {
    fn start() -> Self {
        let mut child = program("mock-drone")
            .args(["--at-port", "0", "--navdata-port", "0", "--control-port", "0"])
            .args(["--ftp-port", "0", "--video-port", "0"])
            .env("NO_COLOR", "1")
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(child.stderr.take().unwrap()).read_line(&mut line).unwrap();
        // "... AT 1234/udp, navdata 1235/udp, configuration 1236/tcp"
        let ports: Vec<u16> = line
            .split_whitespace()
            .filter_map(|word| word.split_once('/')?.0.parse().ok())
            .collect();
        Self { child, ports: ports.try_into().expect(&line) }
    }

    fn pilot(&self, plan: &Path) -> Command {
        let mut pilot = self.pilot_without_plan();
        pilot.arg("--plan").arg(plan);
        pilot
    }

    fn pilot_without_plan(&self) -> Command {
        let [at, navdata, control] = self.ports.map(|port| port.to_string());
        let mut pilot = program("ardrone-pilot");
        pilot.args(["--drone", "127.0.0.1", "--no-log"]);
        pilot.args(["--at-port", &at, "--navdata-port", &navdata, "--control-port", &control]);
        pilot
    }

    fn kill(&mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

impl Drop for MockProcess {
    fn drop(&mut self) {
        self.kill();
    }
}

pub(crate) fn plan_file(text: &str) -> tempfile::NamedTempFile {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), text).unwrap();
    file
}

/// Starts a pilot whose standard error goes to a file that can be read meanwhile.
fn start(pilot: &mut Command) -> (Child, tempfile::NamedTempFile) {
    let log = tempfile::NamedTempFile::new().unwrap();
    let child =
        pilot.stdout(Stdio::piped()).stderr(File::create(log.path()).unwrap()).spawn().unwrap();
    (child, log)
}

fn wait_for(log: &Path, text: &str) {
    let start = Instant::now();
    while !std::fs::read_to_string(log).unwrap().contains(text) {
        assert!(start.elapsed() < Duration::from_secs(20), "`{text}` never came");
        std::thread::sleep(Duration::from_millis(50));
    }
}

pub(crate) fn signal(child: &Child, name: &str) {
    let status = Command::new("kill").args([name, &child.id().to_string()]).status();
    assert!(status.as_ref().is_ok_and(ExitStatus::success), "{status:?}");
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

const SHORT: &str = "takeoff\nsetStayTime 0.2\ngoto 0 0.5 0 0\nland\n";
const LONG: &str = "takeoff\nsetStayTime 50\ngoto 0 0.5 0 0\nland\n";

#[test]
fn two_processes_fly_the_plan() {
    let mock = MockProcess::start();
    let plan = plan_file(SHORT);
    let output = mock.pilot(plan.path()).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(text(&output).contains("steps done      4 of 4"), "{}", text(&output));
    // The drone is still available for a second flight.
    let output = mock.pilot(plan.path()).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_drone_that_vanishes_in_flight_is_reported_within_seconds() {
    let mut mock = MockProcess::start();
    let plan = plan_file(LONG);
    let (child, log) = start(&mut mock.pilot(plan.path()));
    wait_for(log.path(), "step 3/4");
    mock.kill();
    let (killed, lateness) = (Instant::now(), Lateness::measure());
    let output = child.wait_with_output().unwrap();
    let taken = killed.elapsed();
    assert!(taken < Duration::from_secs(10) + 3 * lateness.worst(), "{taken:?}");
    assert_eq!(output.status.code(), Some(10));
    assert!(text(&output).contains("the drone stopped answering"), "{}", text(&output));
    assert!(std::fs::read_to_string(log.path()).unwrap().contains("link lost"));
}

/// Whoever leaves then has not landed it.
#[test]
fn a_drone_that_vanishes_is_reported_without_a_plan_too() {
    for leave in ["quit\n", ""] {
        let mut mock = MockProcess::start();
        let (mut child, log) = start(mock.pilot_without_plan().stdin(Stdio::piped()));
        wait_for(log.path(), "ready to take off");
        let mut orders = child.stdin.take().unwrap();
        writeln!(orders, "append takeoff\nappend hold 50\nstart").unwrap();
        wait_for(log.path(), "step 2");
        mock.kill();
        wait_for(log.path(), "the drone stopped answering");
        if leave.is_empty() {
            signal(&child, "-INT");
        } else {
            write!(orders, "{leave}").unwrap();
        }
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(10), "{leave} {}", text(&output));
    }
}

#[test]
fn control_c_lands_and_waits_for_the_ground() {
    let mock = MockProcess::start();
    let plan = plan_file(LONG);
    let (child, log) = start(&mut mock.pilot(plan.path()));
    wait_for(log.path(), "step 3/4");
    signal(&child, "-INT");
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert!(text(&output).contains("landed on the operator's order"));
    assert!(!text(&output).contains("flight time     -"), "{}", text(&output));
}

#[test]
fn a_terminated_pilot_and_a_closed_terminal_land() {
    for name in ["-TERM", "-HUP"] {
        let mock = MockProcess::start();
        let plan = plan_file(LONG);
        let (child, log) = start(&mut mock.pilot(plan.path()));
        wait_for(log.path(), "step 3/4");
        signal(&child, name);
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130), "{name}");
        assert!(text(&output).contains("landed on the operator's order"), "{name}");
    }
}

/// Whether a pilot with this plan is running.
fn runs(plan: &Path) -> bool {
    let processes = std::fs::read_dir("/proc").unwrap().filter_map(Result::ok);
    let mut commands = processes.filter_map(|process| {
        let command = std::fs::read(process.path().join("cmdline")).ok()?;
        Some(String::from_utf8_lossy(&command).into_owned())
    });
    // The command line of `script` and its shell contains the path too.
    commands.any(|command| {
        command.contains(plan.to_str().unwrap())
            && command.split('\0').next().is_some_and(|name| name.ends_with("ardrone-pilot"))
    })
}

/// Closing a terminal window hangs up its terminal: the drone lands and the process ends.
#[test]
fn a_real_terminal_that_is_closed_lands_and_ends() {
    let mock = MockProcess::start();
    let plan = plan_file(LONG);
    let pilot = mock.pilot(plan.path());
    let words = std::iter::once(pilot.get_program()).chain(pilot.get_args());
    let words: Vec<&str> = words.map(|word| word.to_str().unwrap()).collect();
    let mut terminal = Command::new("script");
    terminal.args(["-qfc", &words.join(" "), "/dev/null"]);
    let shown = tempfile::NamedTempFile::new().unwrap();
    let terminal = terminal
        .stdin(Stdio::piped())
        .stdout(shown.reopen().unwrap())
        .stderr(Stdio::null())
        .spawn();
    let mut terminal = terminal.expect("`script` of util-linux is there");
    wait_for(shown.path(), "step 3");
    assert!(runs(plan.path()));
    terminal.kill().unwrap();
    terminal.wait().unwrap();
    let closed = Instant::now();
    while runs(plan.path()) {
        assert!(closed.elapsed() < Duration::from_secs(20), "it does not end");
        std::thread::sleep(Duration::from_millis(100));
    }
    assert!(closed.elapsed() > Duration::from_secs(1), "it lands first");
}

/// A pilot for a drone in this process, whose truth can be seen.
fn pilot_of(mock: &MockDrone, plan: &Path) -> Command {
    let ports = mock.ports();
    let mut pilot = program("ardrone-pilot");
    pilot.arg("--plan").arg(plan).args(["--drone", "127.0.0.1"]);
    for (name, port) in [
        ("--at-port", ports.at),
        ("--navdata-port", ports.navdata),
        ("--control-port", ports.control),
    ] {
        pilot.args([name, &port.to_string()]);
    }
    pilot
}

/// Another client sends orders to fly, numbered far ahead of the pilot's, until it is told to end.
fn fly_on(mock: &MockDrone, first: u32, ends: &AtomicBool) {
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    let ports = mock.ports();
    let mut number = first;
    while !ends.load(Ordering::Relaxed) {
        let mut datagram = Datagram::new();
        datagram.push(number, &at::Command::Ref(Ref::TakeOff)).unwrap();
        datagram.push(number + 1, &at::Command::Pcmd(Motion::Hover)).unwrap();
        socket.send_to(datagram.as_bytes(), (ports.host, ports.at)).unwrap();
        number += 2;
        std::thread::sleep(Duration::from_millis(33));
    }
}

/// The numbers of another client are above ours: the drone drops what we send, until a landing escalates.
#[test]
fn another_clients_numbers_do_not_drown_control_c() {
    for first in [10_000_000, 2_000_000_000] {
        let mock = MockDrone::start(&WorldConfig::default(), Ports::LOOPBACK).unwrap();
        let plan = plan_file(LONG);
        let (child, log) = start(pilot_of(&mock, plan.path()).arg("--no-log"));
        wait_for(log.path(), "step 3/4");
        let ends = AtomicBool::new(false);
        std::thread::scope(|scope| {
            scope.spawn(|| fly_on(&mock, first, &ends));
            std::thread::sleep(Duration::from_millis(500));
            let before = mock.truth().phase;
            signal(&child, "-INT");
            let (ordered, lateness) = (Instant::now(), Lateness::measure());
            while mock.truth().phase == Phase::Flying && ordered.elapsed() < Duration::from_secs(8)
            {
                std::thread::sleep(Duration::from_millis(5));
            }
            let taken = ordered.elapsed();
            ends.store(true, Ordering::Relaxed);
            assert_eq!(before, Phase::Flying);
            let limit = Duration::from_secs(2) + 3 * lateness.worst();
            assert!(taken <= limit, "{first}: it lands after {taken:?}");
        });
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130), "{}", text(&output));
    }
}

/// No process of ours is left: the drone's own watchdog lands it where it is.
#[test]
fn a_killed_pilot_leaves_the_drone_to_its_own_landing() {
    let mock = MockDrone::start(&WorldConfig::default(), Ports::LOOPBACK).unwrap();
    let plan = plan_file(LONG);
    let folder = tempfile::tempdir().unwrap();
    let flight_log = folder.path().join("flight.mcap");
    let (mut child, log) = start(pilot_of(&mock, plan.path()).arg("--log").arg(&flight_log));
    wait_for(log.path(), "step 3/4");
    // While moving it would keep its last sticks for the 2 s of its watchdog.
    std::thread::sleep(Duration::from_secs(3));
    let before = mock.truth();
    assert_eq!(before.phase, Phase::Flying);
    child.kill().unwrap();
    child.wait().unwrap();
    let killed = Instant::now();
    while mock.truth().phase != Phase::Landed {
        assert!(killed.elapsed() < Duration::from_secs(15), "{:?}", mock.truth());
        std::thread::sleep(Duration::from_millis(50));
    }
    assert!(killed.elapsed() > Duration::from_secs(2), "it hovers first");
    let moved_m = (mock.truth().position_m - before.position_m).xy().norm();
    assert!(moved_m < 2.0, "{moved_m:.2} m");
    // Its records up to then are in the log.
    let recorded = Log::read(&std::fs::read(&flight_log).unwrap()).unwrap();
    assert!(!recorded.complete);
    // A late tick is skipped, so a busy machine has fewer.
    assert!(recorded.ticks().count() > 150, "{}", recorded.ticks().count());
}

#[test]
fn a_second_control_c_leaves_at_once_with_the_landing_ordered() {
    let mock = MockProcess::start();
    let plan = plan_file(LONG);
    let (child, log) = start(&mut mock.pilot(plan.path()));
    wait_for(log.path(), "step 3/4");
    signal(&child, "-INT");
    wait_for(log.path(), "landing: the operator's order");
    let (second, lateness) = (Instant::now(), Lateness::measure());
    signal(&child, "-INT");
    let output = child.wait_with_output().unwrap();
    let taken = second.elapsed();
    assert!(taken < Duration::from_secs(2) + 3 * lateness.worst(), "{taken:?}");
    assert_eq!(output.status.code(), Some(130));
}

#[test]
fn control_c_before_the_drone_is_found_ends_at_once() {
    let plan = plan_file(SHORT);
    let mut pilot = program("ardrone-pilot");
    pilot.arg("--plan").arg(plan.path()).args(["--drone", "127.0.0.1", "--navdata-port", "9"]);
    pilot.arg("--no-log");
    let (child, log) = start(&mut pilot);
    wait_for(log.path(), "connecting");
    signal(&child, "-INT");
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
}
