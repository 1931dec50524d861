//! However a pilot process ends, its last datagrams order the landing and the drone comes down.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use ardrone_pilot::flight::{Connections, Flight};
use autopilot::VehicleConfig;
use mock_drone::firmware::Phase;
use mock_drone::{DroneConfig, WorldConfig};
use nalgebra::Vector2;
use system_tests::lateness::Lateness;
use system_tests::plan;

use crate::processes::{plan_file, program, signal};
use crate::relay::{Relay, Said};

const LONG: &str = "takeoff\nsetStayTime 50\ngoto 0 0.5 0 0\nland\n";
const SHORT: &str = "takeoff\nsetStayTime 2\ngoto 0 0.5 0 0\nland\n";
const TICK: Duration = Duration::from_millis(30);
pub(crate) const FLOOD: Duration = Duration::from_secs(4);
/// Datagrams that the pilot handles in a tick.
const PROCESSED_PER_TICK: u128 = 1000;

fn breeze() -> WorldConfig {
    let drone = DroneConfig { wind_m_s: Vector2::new(0.5, 0.0), ..DroneConfig::default() };
    WorldConfig { drone, ..WorldConfig::default() }
}

/// A pilot process that flies a plan over a relay.
fn pilot(relay: &Relay, plan: &Path) -> Command {
    let mut pilot = command(relay, plan);
    pilot.arg("--no-log");
    pilot
}

/// As [`pilot`], with a log.
fn recording_pilot(relay: &Relay, plan: &Path, log: &Path) -> Command {
    let mut pilot = command(relay, plan);
    pilot.arg("--log").arg(log);
    pilot
}

fn command(relay: &Relay, plan: &Path) -> Command {
    let address = relay.address();
    let mut pilot = program("ardrone-pilot");
    pilot.arg("--plan").arg(plan).args(["--drone", &address.host]);
    for (name, port) in [
        ("--at-port", address.at_port),
        ("--navdata-port", address.navdata_port),
        ("--control-port", address.control_port),
    ] {
        pilot.args([name, &port.to_string()]);
    }
    pilot.stdout(Stdio::null()).stderr(Stdio::null());
    pilot
}

pub(crate) fn wait_until(what: &str, patience: Duration, so: impl Fn() -> bool) {
    let start = Instant::now();
    while !so() {
        assert!(start.elapsed() < patience, "{what} did not come");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Waits until the drone has flown for a while.
fn flying(relay: &Relay) {
    wait_until("the flight", Duration::from_secs(20), || relay.truth().phase == Phase::Flying);
    std::thread::sleep(Duration::from_secs(2));
}

pub(crate) fn ended_within(mut child: Child, patience: Duration) -> Option<i32> {
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait().unwrap() {
            return status.code();
        }
        if start.elapsed() > patience {
            child.kill().unwrap();
            child.wait().unwrap();
            panic!("it has not ended within {patience:?}");
        }
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Checks that the last datagrams were ten landing orders, one tick apart, with rising numbers, and that the
/// drone comes down.
fn assert_parted(relay: &Relay) {
    // The last datagrams may still be on their way.
    std::thread::sleep(Duration::from_millis(100));
    let said = relay.said();
    let parting: Vec<&Said> = said.iter().rev().take_while(|said| said.parts()).collect();
    assert!(parting.len() >= 10, "{} landings at the end", parting.len());
    let took = parting[0].at - parting[9].at;
    assert!(took > 8 * TICK, "ten landings in {took:?}");
    let numbers: Vec<u32> =
        parting[..10].iter().rev().flat_map(|said| said.commands.iter().map(|(n, _)| *n)).collect();
    assert!(numbers[0] == 1 || numbers.is_sorted_by(|a, b| a < b), "{numbers:?}");
    let down = || matches!(relay.truth().phase, Phase::Landed | Phase::Emergency);
    wait_until("the ground", Duration::from_secs(10), down);
}

/// Time of the second Ctrl-C.
#[derive(Debug, Clone, Copy)]
enum Moment {
    Configuring,
    Settling,
    TakingOff,
    Flying,
    Descending,
    Landing,
}

fn says_trim(said: &Said) -> bool {
    said.commands.iter().any(|(_, command)| *command == ardrone_link::at::Command::FlatTrim)
}

fn leave_at(moment: Moment) {
    let relay = Relay::start(&breeze());
    let plan = plan_file(LONG);
    let child = pilot(&relay, plan.path()).spawn().unwrap();
    let patience = Duration::from_secs(20);
    match moment {
        Moment::Configuring => wait_until("a word", patience, || !relay.said().is_empty()),
        Moment::Settling => wait_until("trim", patience, || relay.said().iter().any(says_trim)),
        Moment::TakingOff => {
            wait_until("the take-off", patience, || {
                matches!(relay.truth().phase, Phase::TakingOff { .. })
            });
            std::thread::sleep(Duration::from_millis(1300));
        }
        Moment::Flying | Moment::Descending | Moment::Landing => flying(&relay),
    }
    signal(&child, "-INT");
    match moment {
        // The agent is descending by now; near the ground it leaves the landing to the drone.
        Moment::Descending => std::thread::sleep(Duration::from_millis(700)),
        Moment::Landing => {
            wait_until("the landing", patience, || relay.truth().phase == Phase::Landing);
        }
        _ => std::thread::sleep(Duration::from_millis(50)),
    }
    let lateness = Lateness::measure();
    let ordered = relay.said().len();
    signal(&child, "-INT");
    assert_eq!(ended_within(child, Duration::from_mins(1)), Some(130), "{moment:?}");
    // The ticks have real-time priority. On a machine that is late by more than one, what receives the signal,
    // which has none, is so much later that nothing can be said.
    if lateness.worst() < TICK {
        let until_the_end = relay.said().len() - ordered;
        assert!(until_the_end < 40, "{moment:?}: {until_the_end} datagrams");
    }
    assert_parted(&relay);
}

#[test]
fn a_second_control_c_at_any_moment_leaves_with_the_landing_ordered() {
    use Moment::{Configuring, Descending, Flying, Landing, Settling, TakingOff};
    // Two at a time: the ticks of more would leave one core no time for their signals.
    for pair in [[Configuring, Flying], [Settling, Descending], [TakingOff, Landing]] {
        let threads = pair.map(|moment| (moment, std::thread::spawn(move || leave_at(moment))));
        for (moment, thread) in threads {
            assert!(thread.join().is_ok(), "{moment:?}");
        }
    }
}

/// Its output is not read, and the pipe is full.
#[test]
fn a_second_signal_ends_a_pilot_whose_output_is_stuck() {
    /// Capacity of a pipe on Linux.
    const PIPE_BYTES: usize = 65_536;
    let (_reader, mut writer) = std::io::pipe().unwrap();
    writer.write_all(&vec![b'x'; PIPE_BYTES]).unwrap();
    let relay = Relay::start(&WorldConfig::default());
    let plan = plan_file(LONG);
    let child = pilot(&relay, plan.path()).arg("--json").stdout(writer).spawn().unwrap();
    flying(&relay);
    signal(&child, "-INT");
    wait_until("the ground", Duration::from_secs(20), || relay.truth().phase == Phase::Landed);
    signal(&child, "-TERM");
    assert_eq!(ended_within(child, Duration::from_secs(10)), Some(130));
}

#[test]
fn a_busy_control_port_swallows_no_signal() {
    let relay = Relay::start(&WorldConfig::default());
    relay.keep_control_port_busy();
    let plan = plan_file(LONG);
    // Without the read-back the drone is flown only if the settings allow it.
    let settings = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(settings.path(), "[drone]\nread_back = false\n").unwrap();
    let mut command = pilot(&relay, plan.path());
    let child = command.arg("--config").arg(settings.path()).spawn().unwrap();
    flying(&relay);
    signal(&child, "-TERM");
    wait_until("the landing", Duration::from_secs(3), || relay.truth().phase == Phase::Landing);
    assert_eq!(ended_within(child, Duration::from_secs(20)), Some(130));
}

#[test]
fn other_ends_land_as_control_c_does() {
    let threads = ["-QUIT", "-USR1", "-ALRM", "-XCPU", "-PROF"].map(|name| {
        std::thread::spawn(move || {
            let relay = Relay::start(&WorldConfig::default());
            let plan = plan_file(LONG);
            let child = pilot(&relay, plan.path()).spawn().unwrap();
            flying(&relay);
            signal(&child, name);
            assert_eq!(ended_within(child, Duration::from_secs(20)), Some(130), "{name}");
            assert_eq!(relay.truth().phase, Phase::Landed, "{name}");
        })
    });
    for thread in threads {
        thread.join().unwrap();
    }
}

#[test]
fn a_log_that_may_not_grow_ends_the_log_and_not_the_flight() {
    let relay = Relay::start(&WorldConfig::default());
    let plan = plan_file(SHORT);
    let folder = tempfile::tempdir().unwrap();
    let pilot = recording_pilot(&relay, plan.path(), &folder.path().join("flight.mcap"));
    let words = std::iter::once(pilot.get_program()).chain(pilot.get_args());
    let words: Vec<&str> = words.map(|word| word.to_str().unwrap()).collect();
    let mut shell = Command::new("sh");
    shell
        .args(["-c", &format!("ulimit -f 64; exec {}", words.join(" "))])
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    let child = shell.spawn().unwrap();
    assert_eq!(ended_within(child, Duration::from_secs(40)), Some(0));
    assert_eq!(relay.truth().phase, Phase::Landed);
}

#[test]
fn a_flight_that_is_dropped_lands() {
    let relay = Relay::start(&WorldConfig::default());
    let (runtime, config) = (crate::udp::runtime(), VehicleConfig::default());
    let flight =
        Flight::start(&runtime, Some(plan(LONG)), &config, relay.address(), Connections::default())
            .unwrap();
    flying(&relay);
    drop(flight);
    assert_eq!(relay.truth().phase, Phase::Landed);
    assert_parted(&relay);
}

/// Builds a library that makes `send` fail with the error in a file while that file exists.
pub(crate) fn refusing_library(folder: &Path) -> PathBuf {
    let source = folder.join("refuse.c");
    std::fs::write(
        &source,
        r#"
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/socket.h>
ssize_t send(int fd, const void *bytes, size_t length, int flags) {
    int type = 0;
    socklen_t size = sizeof type;
    FILE *file = fopen(getenv("REFUSED"), "r");
    if (file) {
        int error = 0;
        int found = fscanf(file, "%d", &error);
        fclose(file);
        if (found == 1 && !getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &size) && type == SOCK_DGRAM) {
            errno = error;
            return -1;
        }
    }
    ssize_t (*next)(int, const void *, size_t, int) = dlsym(RTLD_NEXT, "send");
    return next(fd, bytes, length, flags);
}
"#,
    )
    .unwrap();
    let library = folder.join("refuse.so");
    let mut compiler = Command::new("cc");
    compiler.args(["-shared", "-fPIC", "-o"]).arg(&library).arg(&source).arg("-ldl");
    assert!(compiler.status().unwrap().success());
    library
}

pub(crate) const EACCES: &str = "13";
const EINVAL: &str = "22";

/// Makes `send` fail for a while.
pub(crate) fn refuse(refused: &Path, error: &str, time: Duration) {
    // Written elsewhere and renamed, so that it is never read incomplete.
    let new = refused.with_extension("new");
    std::fs::write(&new, error).unwrap();
    std::fs::rename(&new, refused).unwrap();
    std::thread::sleep(time);
    std::fs::remove_file(refused).unwrap();
}

/// Flies a plan while `send` fails for a while; returns the exit status when the drone is down.
fn flown_with(text: &str, error: &str, time: Duration) -> Option<i32> {
    let folder = tempfile::tempdir().unwrap();
    let library = refusing_library(folder.path());
    let refused = folder.path().join("refused");
    let relay = Relay::start(&WorldConfig::default());
    let plan = plan_file(text);
    let mut pilot = pilot(&relay, plan.path());
    let child = pilot.env("LD_PRELOAD", &library).env("REFUSED", &refused).spawn().unwrap();
    flying(&relay);
    refuse(&refused, error, time);
    let status = ended_within(child, Duration::from_secs(40));
    let down = || relay.truth().phase == Phase::Landed;
    wait_until("the ground", Duration::from_secs(10), down);
    status
}

#[test]
fn a_refused_datagram_ends_no_flight() {
    let ms = Duration::from_millis;
    let cases = [(EACCES, ms(100)), (EINVAL, ms(100)), (EACCES, ms(1000))];
    // One after another: the ticks of three would leave one core no time for their drones.
    for (error, time) in cases {
        assert_eq!(flown_with(SHORT, error, time), Some(0), "{error}, {time:?}");
    }
}

#[test]
fn a_drone_that_cannot_be_told_anything_lands_by_itself_and_that_is_said() {
    let status = flown_with(LONG, EACCES, Duration::from_secs(15));
    // Link loss, or a landing by the drone itself: whichever is noticed first.
    assert!(matches!(status, Some(10 | 40)), "{status:?}");
}

#[test]
fn a_flood_delays_no_tick_and_loses_no_tick_of_the_log() {
    let relay = Relay::start(&WorldConfig::default());
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("flight.mcap");
    let plan = plan_file(LONG);
    let mut pilot = recording_pilot(&relay, plan.path(), &log);
    let child = pilot.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    flying(&relay);
    let lateness = Lateness::measure();
    let begun = Instant::now();
    relay.flood(FLOOD);
    wait_until("the end of the flood", Duration::from_mins(1), || !relay.floods());
    let ended = Instant::now();
    let (lateness, flooded) = (lateness.worst(), relay.flooded());
    let said = relay.said();
    let meanwhile = said.windows(2).filter(|pair| pair[0].at >= begun && pair[1].at <= ended);
    let gap = meanwhile.map(|pair| pair[1].at - pair[0].at).max().unwrap();
    signal(&child, "-INT");
    let output = child.wait_with_output().unwrap();
    let [summary, progress] = [&output.stdout, &output.stderr].map(|t| String::from_utf8_lossy(t));
    println!(
        "{flooded} datagrams in {:?}, worst gap {gap:?}, machine late by {lateness:?}\n{summary}",
        ended - begun
    );
    assert_eq!(relay.truth().phase, Phase::Landed);
    // A slow machine sends no more than the pilot can process.
    if u128::from(flooded) > 2 * PROCESSED_PER_TICK * (FLOOD.as_millis() / TICK.as_millis()) {
        assert!(
            progress.contains("navdata arrive faster than they can be processed"),
            "{progress}"
        );
    }
    assert!(!summary.contains("the disk was too slow"), "{summary}");
    // On a busy machine both pilot and relay are delayed as a thread that only sleeps is.
    assert!(gap < Duration::from_millis(100) + 3 * lateness, "{gap:?}");
}
