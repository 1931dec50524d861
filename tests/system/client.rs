//! The client of `ardrone-link` with the mock drone, over UDP and TCP.

use std::process::{Command, Stdio};
use std::sync::Arc;
use std::time::{Duration, Instant};

use ardrone_link::navdata::{NavdataOption, Time};
use ardrone_link::{
    Client, ClientBuilder, ConfigureError, DroneAddress, Event, FlightError, Identity, NavdataMode,
    Packet, ReadyError, Refusal, Setting, Steering,
};
use mock_drone::firmware::Phase;
use mock_drone::scenario::Scenario;
use mock_drone::server::{MockDrone, Ports};
use mock_drone::{DroneConfig, Tag27, WorldConfig};
use system_tests::lateness::Lateness;
use tokio::time::{sleep, timeout};

use crate::parting::{EACCES, FLOOD, ended_within, refuse, refusing_library, wait_until};
use crate::relay::Relay;
use crate::udp::address;

/// Timeout, longer than any machine should need.
const PATIENCE: Duration = Duration::from_mins(1);

fn builder(mock: &MockDrone) -> ClientBuilder {
    // A busy machine needs more time than a real drone.
    Client::builder()
        .address(address(mock))
        .ready_limit(PATIENCE)
        .take_off_limit(PATIENCE)
        .landing_limit(PATIENCE)
}

fn mock() -> MockDrone {
    MockDrone::start(&WorldConfig::default(), Ports::LOOPBACK).unwrap()
}

fn mock_with(scenario: &str) -> MockDrone {
    let scenario = Scenario::parse("scenario", scenario).unwrap();
    let world = WorldConfig { scenario, ..WorldConfig::default() };
    MockDrone::start(&world, Ports::LOOPBACK).unwrap()
}

fn mock_with_battery(battery_percent: f64) -> MockDrone {
    let drone = DroneConfig { battery_percent, ..DroneConfig::default() };
    MockDrone::start(&WorldConfig { drone, ..WorldConfig::default() }, Ports::LOOPBACK).unwrap()
}

/// A client whose drone hovers.
async fn flying(mock: &MockDrone) -> Client {
    let drone = builder(mock).start().await.unwrap();
    drone.ready().await.unwrap();
    drone.take_off().await.unwrap();
    drone
}

async fn until(what: &str, so: impl Fn() -> bool) {
    let waiting = async {
        while !so() {
            sleep(Duration::from_millis(10)).await;
        }
    };
    assert!(timeout(PATIENCE, waiting).await.is_ok(), "{what} did not come");
}

/// All events up to and including `wanted`.
async fn events_until(drone: &Client, wanted: &Event) -> Vec<Event> {
    let (mut stream, mut events) = (drone.events(), Vec::new());
    while events.last() != Some(wanted) {
        events.push(stream.next(PATIENCE).await.unwrap());
    }
    events
}

#[tokio::test]
async fn a_client_takes_off_flies_and_lands() {
    let mock = mock();
    let drone = builder(&mock).start().await.unwrap();
    drone.ready().await.unwrap();
    drone.flat_trim().unwrap();
    assert_eq!(drone.steer(Steering::forward(0.5), PATIENCE), Err(Refusal::NotFlying.into()));
    drone.take_off().await.unwrap();
    assert_eq!(mock.truth().phase, Phase::Flying);
    drone.configure(&Setting::EulerAngleMaxDeg(15.0)).await.unwrap();
    let mode = drone.configure(&Setting::NavdataDemo(false)).await;
    assert!(matches!(mode, Err(ConfigureError::Setting(_))), "{mode:?}");
    assert_eq!(drone.flat_trim(), Err(Refusal::NotStanding.into()));
    let start = mock.truth().position_m;
    drone.steer(Steering::forward(0.5), PATIENCE).unwrap();
    until("the way", || (mock.truth().position_m - start).norm() > 0.5).await;
    drone.hover().unwrap();
    assert!(drone.navdata().is_some_and(|navdata| navdata.demo.is_some()));
    drone.land().await.unwrap();
    assert_eq!(mock.truth().phase, Phase::Landed);
    assert_eq!(drone.hover(), Err(Refusal::NotFlying.into()));
    assert_eq!(events_until(&drone, &Event::Landed).await.len(), 6);
    // A new order takes off again.
    drone.take_off().await.unwrap();
    assert_eq!(mock.truth().phase, Phase::Flying);
    drone.close().await.unwrap();
    until("the landing", || mock.truth().phase != Phase::Flying).await;
}

#[tokio::test]
async fn a_client_that_is_dropped_lands() {
    let mock = mock();
    let drone = flying(&mock).await;
    drone.steer(Steering::up(0.5), PATIENCE).unwrap();
    drop(drone);
    until("the ground", || mock.truth().phase == Phase::Landed).await;
}

#[tokio::test]
async fn a_take_off_that_the_drone_refuses_ends_with_an_error() {
    let limit = Duration::from_secs(1);
    let mock = mock_with_battery(15.0);
    let drone = builder(&mock).take_off_limit(limit).start().await.unwrap();
    drone.ready().await.unwrap();
    let error = drone.take_off().await.unwrap_err();
    let expected = FlightError::TakeOffTimedOut { limit, battery_percent: Some(15) };
    assert_eq!(error, expected, "the drone says nothing, it only stays where it is");
    assert_eq!(drone.steer(Steering::forward(0.5), limit), Err(Refusal::NotFlying.into()));
    // A drone that reports an empty battery is not ordered to take off at all.
    let mock = mock_with_battery(9.0);
    let drone = builder(&mock).start().await.unwrap();
    drone.ready().await.unwrap();
    assert_eq!(drone.take_off().await, Err(Refusal::BatteryLow.into()));
}

#[tokio::test]
async fn a_drone_that_disappears_ends_every_wait() {
    let mock = mock();
    let drone = flying(&mock).await;
    let (mut events, mut packets) = (drone.events(), drone.packets());
    drop(mock);
    let waits = async {
        tokio::join!(
            drone.land(),
            drone.emergency_stop(),
            drone.configure(&Setting::AltitudeMaxM(2.0)),
            events.wait_for(PATIENCE, |event| *event == Event::LinkLost),
            async { while packets.next(Duration::from_secs(3)).await.is_ok() {} },
        )
    };
    let (landing, cut, configured, lost, ()) = timeout(PATIENCE, waits).await.unwrap();
    assert_eq!(landing, Err(FlightError::LinkLost));
    assert_eq!(cut, Err(FlightError::LinkLost));
    let key = "control:altitude_max".to_owned();
    assert_eq!(configured, Err(ConfigureError::NotAcknowledged { key }));
    assert_eq!(lost, Ok(Event::LinkLost));
    assert_eq!(drone.navdata(), None, "what was true may not be any more");
    assert_eq!(drone.take_off().await, Err(Refusal::NotReady.into()));
    assert_eq!(drone.steer(Steering::up(0.1), PATIENCE), Err(Refusal::NotFlying.into()));
    timeout(PATIENCE, drone.close()).await.unwrap().unwrap();
}

#[tokio::test]
async fn a_drone_that_disappears_ends_a_take_off_and_the_wait_to_be_ready() {
    let mock = mock();
    let drone = builder(&mock).ready_limit(Duration::from_secs(4)).start().await.unwrap();
    drone.ready().await.unwrap();
    let disappears = async {
        until("the take-off", || matches!(mock.truth().phase, Phase::TakingOff { .. })).await;
        drop(mock);
    };
    let both = async { tokio::join!(drone.take_off(), disappears) };
    let (taken_off, ()) = timeout(PATIENCE, both).await.unwrap();
    assert_eq!(taken_off, Err(FlightError::LinkLost));
    let ready = timeout(PATIENCE, drone.ready()).await.unwrap();
    assert_eq!(ready, Err(ReadyError::NotHeard { limit: Duration::from_secs(4) }));
}

#[tokio::test(flavor = "current_thread")]
async fn tasks_share_a_client() {
    let mock = mock();
    let drone = builder(&mock).start().await.unwrap();
    let (one, other) = tokio::join!(drone.ready(), drone.ready());
    assert_eq!((one, other), (Ok(()), Ok(())));
    let (one, other) = tokio::join!(drone.take_off(), drone.take_off());
    assert_eq!((one, other), (Ok(()), Ok(())));
    let drone = Arc::new(drone);
    let steering = Arc::clone(&drone);
    let steers = tokio::spawn(async move {
        loop {
            if let Err(error) = steering.steer(Steering::up(0.2), Duration::from_millis(200)) {
                return error;
            }
            sleep(Duration::from_millis(20)).await;
        }
    });
    sleep(Duration::from_millis(500)).await;
    // The landing overrides steering, and a take-off after it.
    let (landed, refused) = tokio::join!(drone.land(), drone.take_off());
    assert_eq!((landed, refused), (Ok(()), Err(Refusal::Landing.into())));
    assert_eq!(steers.await.unwrap(), Refusal::NotFlying.into());
    assert_eq!(mock.truth().phase, Phase::Landed);
}

#[tokio::test]
async fn a_take_off_for_which_nobody_waits_lands() {
    let mock = mock();
    let drone = builder(&mock).start().await.unwrap();
    drone.ready().await.unwrap();
    tokio::select! {
        result = drone.take_off() => panic!("it takes seconds: {result:?}"),
        () = until("the take-off", || mock.truth().phase != Phase::Landed) => {}
    }
    until("the ground", || mock.truth().phase == Phase::Landed).await;
    drone.land().await.unwrap();
    // If the future of a landing is dropped, the landing goes on.
    drone.take_off().await.unwrap();
    drop(drone.land());
    until("the ground", || mock.truth().phase == Phase::Landed).await;
}

#[tokio::test]
async fn a_drone_that_starts_again_stays_down_until_it_is_told_otherwise() {
    let mock = mock_with("+12 restart");
    let drone = flying(&mock).await;
    let mut events = drone.events();
    events.wait_for(PATIENCE, |event| *event == Event::DroneRestarted).await.unwrap();
    drone.ready().await.unwrap();
    sleep(Duration::from_secs(1)).await;
    assert_eq!(mock.truth().phase, Phase::Landed);
    assert_eq!(drone.hover(), Err(Refusal::NotFlying.into()));
    drone.take_off().await.unwrap();
    assert_eq!(mock.truth().phase, Phase::Flying);
    drone.land().await.unwrap();
}

#[tokio::test]
async fn a_client_selects_its_identity_and_reads_the_configuration_back() {
    let mock = mock();
    let drone = builder(&mock)
        .identity(Identity { session: 1, user: 2, application: 3 })
        .setting(Setting::AltitudeMaxM(1.75))
        .read_back(true);
    let drone = drone.start().await.unwrap();
    drone.ready().await.unwrap();
    let events = events_until(&drone, &Event::Ready).await;
    let acknowledged =
        events.iter().filter(|event| matches!(event, Event::Configured { .. })).count();
    assert_eq!(acknowledged, 5);
    let read = events.iter().find_map(|event| match event {
        Event::ConfigurationRead(configuration) => Some(configuration),
        _ => None,
    });
    assert_eq!(read.unwrap().get("control:altitude_max"), Some("1750"));
    assert_eq!(read.unwrap().get("custom:profile_id"), Some("00000002"));
}

/// Measured by the drone's own clock, so independent of the machine's load.
#[tokio::test]
async fn a_client_hears_every_option_two_hundred_times_a_second() {
    let drone = DroneConfig { tag_27: Tag27::Gps, ..DroneConfig::default() };
    let world = WorldConfig { drone, ..WorldConfig::default() };
    let mock = MockDrone::start(&world, Ports::LOOPBACK).unwrap();
    let drone = builder(&mock).navdata(NavdataMode::Full).start().await.unwrap();
    drone.ready().await.unwrap();
    let mut packets = drone.packets();
    let mut first: Option<(u32, Duration)> = None;
    loop {
        let bytes = packets.next(PATIENCE).await.unwrap();
        let packet = Packet::decode(&bytes).unwrap();
        let tags: Vec<u16> = packet.options().map(|option| option.tag()).collect();
        let known = packet.options().all(|option| !matches!(option, NavdataOption::Unknown { .. }));
        assert!(known);
        // Packets sent before the setting may still arrive.
        if first.is_none() && tags.len() <= 3 {
            continue;
        }
        assert_eq!(tags, (0..=27).collect::<Vec<u16>>());
        let Some(Time { since_start }) = packet.time() else { panic!("{tags:?}") };
        let (sequence, start) = *first.get_or_insert((packet.sequence, since_start));
        let elapsed = since_start.saturating_sub(start);
        if elapsed >= Duration::from_secs(1) {
            let rate = f64::from(packet.sequence - sequence) / elapsed.as_secs_f64();
            assert!((198.0..=202.0).contains(&rate), "{rate}");
            return;
        }
    }
}

#[tokio::test]
async fn an_emergency_stop_cuts_the_motors_and_can_be_cleared() {
    let mock = mock();
    let drone = flying(&mock).await;
    drone.emergency_stop().await.unwrap();
    assert_eq!(mock.truth().phase, Phase::Emergency);
    assert_eq!(drone.take_off().await, Err(Refusal::Emergency.into()));
    assert_eq!(drone.land().await, Err(FlightError::Emergency));
    drone.reset_emergency().await.unwrap();
    events_until(&drone, &Event::EmergencyCleared).await;
    // The old take-off order is no longer valid.
    sleep(Duration::from_millis(500)).await;
    assert_eq!(mock.truth().phase, Phase::Landed);
}

#[path = "../../ardrone-link/examples/configure.rs"]
#[allow(dead_code, reason = "its main is for the command line")]
mod configure;
#[path = "../../ardrone-link/examples/print_navdata.rs"]
#[allow(dead_code, reason = "its main is for the command line")]
mod print_navdata;
#[path = "../../ardrone-link/examples/takeoff_land.rs"]
#[allow(dead_code, reason = "its main is for the command line")]
mod takeoff_land;

#[tokio::test]
async fn the_examples_do_what_they_say() {
    let mock = mock();
    let start = mock.truth().position_m;
    takeoff_land::fly(builder(&mock)).await.unwrap();
    assert_eq!(mock.truth().phase, Phase::Landed);
    assert!((mock.truth().position_m - start).norm() > 0.1, "{:?}", mock.truth());
    let second = Duration::from_secs(1);
    assert!(print_navdata::listen(builder(&mock), second).await.unwrap() > 10);
    let configuration = configure::configure(builder(&mock)).await.unwrap();
    assert_eq!(configuration.get("control:altitude_max"), Some("2500"));
}

/// Its README shows the example that was flown above.
#[test]
fn the_readme_shows_the_example_that_is_flown() {
    let example = include_str!("../../ardrone-link/examples/takeoff_land.rs");
    let program = example.split_inclusive('\n').skip_while(|line| line.starts_with("//!"));
    let program: String = program.collect();
    assert!(program.starts_with("use "), "{program}");
    let readme = include_str!("../../ardrone-link/README.md");
    assert!(readme.contains(&program), "it shows another program");
}

/// The lines of plans in the documentation's picture of the terminal are those of the agent.
#[test]
fn the_documentation_shows_the_lines_of_the_agent() {
    let page = include_str!("../../docs/terminal.md");
    let words: Vec<&str> = page.split_whitespace().collect();
    let mut shown = 0;
    for pair in words.windows(2) {
        let Ok(line) = pair[1].trim_end_matches(['|', ',', '│']).parse::<u32>() else { continue };
        let Some(goal) = pair[0].strip_prefix("+!") else { continue };
        let plan = autopilot::agent::plan_text(autopilot::agent::SOURCE, line);
        assert!(plan.contains(&format!("+!{goal}")), "{goal} is not in line {line}:\n{plan}");
        shown += 1;
    }
    assert_eq!(shown, 8);
}

const PORTS: &str = "CLIENT_PORTS";

/// The client process of the next test.
#[tokio::test]
#[ignore = "flown by another test, in a process of its own"]
async fn in_a_process_of_its_own() {
    let ports = std::env::var(PORTS).unwrap();
    let ports: Vec<u16> = ports.split(' ').map(|port| port.parse().unwrap()).collect();
    let host = "127.0.0.1".to_owned();
    let (at_port, navdata_port, control_port) = (ports[0], ports[1], ports[2]);
    let address = DroneAddress { host, at_port, navdata_port, control_port };
    let drone = Client::builder().address(address).ready_limit(PATIENCE).take_off_limit(PATIENCE);
    let drone = drone.start().await.unwrap();
    drone.ready().await.unwrap();
    drone.take_off().await.unwrap();
    sleep(Duration::from_secs(6)).await;
    drone.close().await.unwrap();
}

#[test]
fn a_refused_datagram_ends_no_client() {
    let folder = tempfile::tempdir().unwrap();
    let library = refusing_library(folder.path());
    let refused = folder.path().join("refused");
    let mock = MockDrone::start(&WorldConfig::default(), Ports::LOOPBACK).unwrap();
    let ports = mock.ports();
    let mut client = Command::new(std::env::current_exe().unwrap());
    client.args(["--ignored", "--exact", "client::in_a_process_of_its_own"]);
    client.env(PORTS, format!("{} {} {}", ports.at, ports.navdata, ports.control));
    client.env("LD_PRELOAD", library).env("REFUSED", &refused);
    let child = client.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let flies = || mock.truth().phase == Phase::Flying;
    wait_until("the flight", Duration::from_secs(20), flies);
    refuse(&refused, EACCES, Duration::from_millis(100));
    std::thread::sleep(Duration::from_secs(1));
    assert!(flies(), "it goes on: {:?}", mock.truth());
    assert_eq!(ended_within(child, Duration::from_secs(20)), Some(0));
    assert_eq!(mock.truth().phase, Phase::Landing, "with the landing ordered");
}

#[tokio::test]
async fn a_flood_delays_no_tick_of_a_client() {
    let relay = Relay::start(&WorldConfig::default());
    let drone = Client::builder().address(relay.address().clone()).start().await.unwrap();
    drone.ready().await.unwrap();
    let begun = Instant::now();
    let lateness = Lateness::measure();
    relay.flood(FLOOD);
    while relay.floods() {
        sleep(Duration::from_millis(10)).await;
    }
    let lateness = lateness.worst();
    let ended = Instant::now();
    let said = relay.said();
    let meanwhile = said.windows(2).filter(|pair| pair[0].at >= begun && pair[1].at <= ended);
    let gap = meanwhile.map(|pair| pair[1].at - pair[0].at).max().unwrap();
    println!("flooded for {:?}, worst gap {gap:?}, machine late by {lateness:?}", ended - begun);
    drone.close().await.unwrap();
    // On a busy machine a thread that only sleeps wakes up late too, and both client and relay are delayed by
    // that.
    assert!(gap < Duration::from_millis(100) + 3 * lateness, "{gap:?}");
}
