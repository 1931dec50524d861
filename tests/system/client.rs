//! `ardrone-link`'s own client against the mock drone, over UDP and TCP.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use ardrone_link::DroneAddress;
use ardrone_link::at::Identity;
use ardrone_link::navdata::{NavdataOption, Packet};
use ardrone_link::net::Client;
use ardrone_link::session::{Event, FlightOrder, Order, SessionConfig};
use ardrone_link::settings::Setting;
use mock_drone::firmware::Phase;
use mock_drone::server::{MockDrone, Ports};
use mock_drone::{DroneConfig, Tag27, WorldConfig};

use crate::parting::{EACCES, ended_within, refuse, refusing_library, wait_until};
use crate::relay::Relay;

async fn start(mock: &MockDrone, config: SessionConfig) -> Client {
    let ports = mock.ports();
    let address = DroneAddress {
        host: ports.host.to_string(),
        at_port: ports.at,
        navdata_port: ports.navdata,
        control_port: ports.control,
    };
    Client::start(&address, config).await.unwrap()
}

fn session(settings: &[Setting]) -> SessionConfig {
    let settings = settings.iter().map(|setting| setting.config().unwrap()).collect();
    SessionConfig { settings, ..SessionConfig::default() }
}

/// All events up to the one that is waited for.
async fn events_until(drone: &mut Client, wanted: &Event) -> Vec<Event> {
    let mut events = Vec::new();
    let waiting = async {
        while events.last() != Some(wanted) {
            events.push(drone.next_event().await.unwrap());
        }
    };
    let came = tokio::time::timeout(Duration::from_secs(20), waiting).await.is_ok();
    assert!(came, "{wanted:?} never came: {events:?}");
    events
}

#[tokio::test]
async fn a_client_takes_off_lands_and_orders_the_landing_when_it_goes() {
    let mock = MockDrone::start(&WorldConfig::default(), Ports::LOOPBACK).unwrap();
    let mut drone = start(&mock, session(&[Setting::NavdataDemo(true)])).await;
    events_until(&mut drone, &Event::Ready).await;
    drone.order(Order { flight: FlightOrder::TakeOff, ..Order::default() });
    events_until(&mut drone, &Event::Airborne).await;
    while mock.truth().phase != Phase::Flying {
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    assert!(drone.navdata().is_some_and(|navdata| navdata.demo.is_some()));
    drone.close().await.unwrap();
    assert_eq!(mock.truth().phase, Phase::Landing);
}

#[tokio::test]
async fn a_client_selects_its_identity_and_reads_the_configuration_back() {
    let mock = MockDrone::start(&WorldConfig::default(), Ports::LOOPBACK).unwrap();
    let config = SessionConfig {
        identity: Some(Identity { session: 1, user: 2, application: 3 }),
        read_back: true,
        ..session(&[Setting::NavdataDemo(true), Setting::AltitudeMaxM(1.75)])
    };
    let mut drone = start(&mock, config).await;
    let events = events_until(&mut drone, &Event::Ready).await;
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

#[tokio::test]
async fn a_client_hears_every_option_two_hundred_times_a_second() {
    let drone = DroneConfig { tag_27: Tag27::Gps, ..DroneConfig::default() };
    let world = WorldConfig { drone, ..WorldConfig::default() };
    let mock = MockDrone::start(&world, Ports::LOOPBACK).unwrap();
    let mut drone = start(&mock, session(&[Setting::NavdataDemo(false)])).await;
    events_until(&mut drone, &Event::Ready).await;
    // What was sent before may still be on its way.
    let tags = loop {
        let bytes = drone.next_packet().await.unwrap();
        let packet = Packet::decode(&bytes).unwrap();
        let tags: Vec<u16> = packet.options().map(|option| option.tag()).collect();
        let known = packet.options().all(|option| !matches!(option, NavdataOption::Unknown { .. }));
        assert!(known);
        if tags.len() > 3 {
            break tags;
        }
    };
    assert_eq!(tags, (0..=27).collect::<Vec<u16>>());
    let first = Packet::decode(&drone.next_packet().await.unwrap()).unwrap().sequence;
    tokio::time::sleep(Duration::from_secs(1)).await;
    let last = Packet::decode(&drone.next_packet().await.unwrap()).unwrap().sequence;
    // The clock of the test is not exact.
    assert!((150..=260).contains(&(last - first)), "{}", last - first);
}

#[tokio::test]
async fn an_emergency_stop_cuts_the_motors_and_can_be_cleared() {
    let mock = MockDrone::start(&WorldConfig::default(), Ports::LOOPBACK).unwrap();
    let mut drone = start(&mock, session(&[Setting::NavdataDemo(true)])).await;
    events_until(&mut drone, &Event::Ready).await;
    drone.order(Order { flight: FlightOrder::TakeOff, ..Order::default() });
    events_until(&mut drone, &Event::Airborne).await;
    drone.request_emergency_stop();
    events_until(&mut drone, &Event::Emergency).await;
    assert_eq!(mock.truth().phase, Phase::Emergency);
    drone.request_emergency_reset();
    events_until(&mut drone, &Event::EmergencyCleared).await;
    // The old order to take off is spent.
    tokio::time::sleep(Duration::from_millis(500)).await;
    assert_eq!(mock.truth().phase, Phase::Landed);
}

const PORTS: &str = "CLIENT_PORTS";

/// The client of the test below.
#[tokio::test]
#[ignore = "flown by another test, in a process of its own"]
async fn in_a_process_of_its_own() {
    let ports = std::env::var(PORTS).unwrap();
    let ports: Vec<u16> = ports.split(' ').map(|port| port.parse().unwrap()).collect();
    let host = "127.0.0.1".to_owned();
    let (at_port, navdata_port, control_port) = (ports[0], ports[1], ports[2]);
    let address = DroneAddress { host, at_port, navdata_port, control_port };
    let config = session(&[Setting::NavdataDemo(true)]);
    let mut drone = Client::start(&address, config).await.unwrap();
    events_until(&mut drone, &Event::Ready).await;
    drone.order(Order { flight: FlightOrder::TakeOff, ..Order::default() });
    events_until(&mut drone, &Event::Airborne).await;
    tokio::time::sleep(Duration::from_secs(6)).await;
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
    let config = session(&[Setting::NavdataDemo(true)]);
    let mut drone = Client::start(relay.address(), config).await.unwrap();
    events_until(&mut drone, &Event::Ready).await;
    let begun = Instant::now();
    relay.flood(1_000_000);
    while relay.floods() {
        tokio::time::sleep(Duration::from_millis(10)).await;
    }
    let ended = Instant::now();
    let said = relay.said();
    let meanwhile = said.windows(2).filter(|pair| pair[0].at >= begun && pair[1].at <= ended);
    let gap = meanwhile.map(|pair| pair[1].at - pair[0].at).max().unwrap();
    println!("flooded for {:?}, worst gap {gap:?}", ended - begun);
    drone.close().await.unwrap();
    // The machine may be busy with other things.
    assert!(gap < Duration::from_millis(100), "{gap:?}");
}
