mod bench;
mod by_hand;
mod endings;
mod flight_time;
mod neighbours;
mod orders;
mod phases;
mod sightings;
mod station;
mod ticks;

use ardrone_link::configuration::Configuration;
use ardrone_link::navdata::{Gps, NavdataOption, PacketWriter};
use bytes::BytesMut;

use super::life::Preparation;
use super::link::{DETECTION_SECTION, GPS_MAX_AGE, NAVDATA_OPTIONS_KEY, VIDEO_SECTION};
use super::*;
use bench::{Bench, SECOND};

fn vehicle(plan: &str) -> Vehicle {
    Vehicle::flying(Plan::parse("plan", plan).unwrap(), &VehicleConfig::default()).unwrap()
}

#[test]
fn nothing_is_sent_to_a_drone_that_was_not_heard() {
    let mut vehicle = vehicle("takeoff\nland");
    assert_eq!(vehicle.handle(Duration::ZERO, Input::Tick), Ok(()));
    assert_eq!(vehicle.status(Duration::ZERO).pose, None, "unknown, not zero");
    assert_eq!(vehicle.poll(), Some(Output::Transmit(Transmit::WakeUp)));
    while let Some(output) = vehicle.poll() {
        assert!(matches!(output, Output::Telemetry(_)), "{output:?}");
    }
}

#[test]
fn a_drone_that_never_answers_ends_the_flight() {
    let mut vehicle = vehicle("takeoff\nland");
    assert_eq!(vehicle.handle(CONNECT_TIMEOUT.saturating_sub(TICK), Input::Tick), Ok(()));
    assert_eq!(vehicle.outcome(), None);
    while vehicle.poll().is_some() {}
    assert_eq!(vehicle.handle(CONNECT_TIMEOUT, Input::Tick), Ok(()));
    assert_eq!(vehicle.outcome(), Some(&Outcome::NoDrone));
    let outputs: Vec<_> = std::iter::from_fn(|| {
        vehicle.poll().map(|output| matches!(output, Output::Telemetry(Telemetry::Ended(..))))
    })
    .collect();
    assert_eq!(outputs.iter().filter(|ended| **ended).count(), 1, "the end is said once");
    assert_eq!(outputs.last(), Some(&true), "and last");
}

#[test]
fn an_order_to_land_before_the_flight_just_ends_it() {
    let mut vehicle = vehicle("takeoff\nland");
    let land = Input::Order(Operator::TERMINAL, OperatorOrder::Land);
    assert_eq!(vehicle.handle(Duration::ZERO, land), Ok(()));
    assert_eq!(vehicle.outcome(), Some(&Outcome::CalledOff));
}

#[test]
fn random_navdata_is_ignored() {
    let mut vehicle = vehicle("takeoff\nland");
    for length in 0..600_usize {
        let bytes: Vec<u8> =
            (0_u8..=255).cycle().map(|i| i.wrapping_mul(37)).take(length).collect();
        assert_eq!(vehicle.handle(Duration::ZERO, Input::Navdata(&bytes)), Err(Refused::Datagram));
        assert_eq!(vehicle.handle(Duration::ZERO, Input::Control(&bytes)), Ok(()));
    }
    assert_eq!(vehicle.status(Duration::ZERO).battery_percent, None);
}

#[test]
fn limits_that_the_drone_has_not_taken_forbid_the_flight_and_a_missing_clock_does_not() {
    let mut vehicle = vehicle("takeoff\nland");
    let taken = |vehicle: &Vehicle, without: &str| {
        let kept = vehicle.settings.iter().filter(|setting| setting.key() != without);
        let lines = kept.map(|setting| format!("{} = {}\n", setting.key(), setting.value()));
        Configuration::parse(&lines.collect::<Vec<_>>().concat())
    };
    vehicle.compare_configuration(&taken(&vehicle, NAVDATA_OPTIONS_KEY));
    assert!(vehicle.events.contains(&FlightEvent::NoDroneClock));
    assert!(vehicle.configured.unconfirmed.is_empty());
    vehicle.compare_configuration(&taken(&vehicle, "control:altitude_max"));
    vehicle.setting_unconfirmed("control:altitude_max");
    assert_eq!(vehicle.configured.unconfirmed, ["control:altitude_max"], "each key once");
    vehicle.setting_unconfirmed("control:outdoor");
    assert_eq!(vehicle.configured.unconfirmed, ["control:altitude_max", "control:outdoor"]);
}

/// Reasons why a vehicle that has just heard a drone on the ground does not take off.
fn refusals(plan: &str, demo: Demo, packets: u64, later: Duration) -> Vec<String> {
    let mut vehicle = vehicle(plan);
    let mut bytes = BytesMut::new();
    let mut packet = PacketWriter::new(&mut bytes, DroneState::empty(), 1, 0);
    packet.option(&NavdataOption::Demo(demo)).unwrap();
    packet.finish();
    assert_eq!(vehicle.handle(Duration::ZERO, Input::Navdata(&bytes)), Ok(()));
    vehicle.life.prepare(Preparation::Trimming(vehicle.watched_from(Duration::ZERO)));
    vehicle.take_off_or_refuse(later, packets as f64);
    match vehicle.outcome() {
        Some(Outcome::PreflightRefused { reasons }) => reasons.clone(),
        None => Vec::new(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_pre_flight_check_reports_every_reason() {
    let control_state = ControlState::Landed;
    let fine = Demo { battery_percent: 60, control_state, ..Demo::default() };
    let short = "takeoff\nland";
    let now = Duration::from_millis(60);
    assert_eq!(refusals(short, fine, 15, now), [""; 0]);
    let tilted = Demo { pitch_deg: -9.0, ..fine };
    assert_eq!(
        refusals(short, tilted, 3, now),
        [
            "the drone is tilted by 9°: put it on level ground",
            "only 3 packets of flight data a second: at least 5 are needed; move closer, or use \
             another Wi-Fi channel",
        ]
    );
    assert_eq!(
        refusals(short, fine, 15, Duration::from_millis(501)),
        ["the newest flight data are 501 ms old: move closer, or use another Wi-Fi channel"]
    );
    assert_eq!(
        refusals(short, Demo { battery_percent: 20, ..fine }, 15, now),
        ["battery at 20 %: more than 20 % are needed"]
    );
    assert_eq!(
        refusals("takeoff\nsetStayTime 300\ngoto 0 0 1 0\nland", fine, 15, now),
        ["battery at 60 %: the plan takes about 310 s, for which 64 % are needed"]
    );
}

#[test]
fn the_pre_flight_check_accepts_its_exact_limits() {
    let control_state = ControlState::Landed;
    let fine = Demo { battery_percent: 60, control_state, ..Demo::default() };
    let short = "takeoff\nland";
    let now = Duration::from_millis(60);
    for accepted in [
        Demo { pitch_deg: 8.0, ..fine },
        Demo { roll_deg: -8.0, ..fine },
        Demo { battery_percent: 21, ..fine },
        Demo { altitude_m: 0.6, ..fine },
    ] {
        assert_eq!(refusals(short, accepted, 5, now), [""; 0], "{accepted:?}");
    }
    assert_eq!(refusals(short, fine, 5, Duration::from_millis(500)), [""; 0]);
    assert_eq!(refusals(short, fine, 4, now).len(), 1);
    assert_eq!(
        refusals(short, Demo { roll_deg: -9.0, ..fine }, 15, now),
        ["the drone is tilted by 9°: put it on level ground"]
    );
    for altitude_m in [0.7, -0.7] {
        let reasons = refusals(short, Demo { altitude_m, ..fine }, 15, now);
        assert!(reasons.len() == 1 && reasons[0].contains("altitude"), "{reasons:?}");
    }
}

#[test]
fn a_firmware_that_does_not_look_for_tags_is_reported_and_flown() {
    let mut config = VehicleConfig::default();
    let keys = |config: &VehicleConfig| {
        let vehicle = Vehicle::new(config).unwrap();
        let keys = vehicle
            .settings
            .iter()
            .map(|setting| (setting.key().to_owned(), setting.value().to_owned()));
        keys.filter(|(key, _)| key.starts_with(DETECTION_SECTION)).collect::<Vec<_>>()
    };
    assert_eq!(keys(&config), [], "off unless asked for");
    config.estimator.tags = Some(TagConfig::default());
    let detection = [("detect:detections_select_v", "128"), ("detect:detect_type", "12")]
        .map(|(key, value)| (key.to_owned(), value.to_owned()));
    assert_eq!(keys(&config), detection);
    let mut vehicle = Vehicle::new(&config).unwrap();
    for (key, _) in &detection {
        vehicle.setting_unconfirmed(key);
        let said = vehicle.events.iter().filter(|event| **event == FlightEvent::NoTagDetection);
        assert_eq!(said.count(), 1, "once for all keys");
    }
    assert_eq!(vehicle.configured.unconfirmed, Vec::<String>::new());
}

#[test]
fn a_firmware_that_keeps_its_bit_rate_is_reported_and_flown() {
    let keys = |config: &VehicleConfig| {
        let vehicle = Vehicle::new(config).unwrap();
        let settings = vehicle.settings.iter();
        let settings = settings.filter(|setting| setting.key().starts_with(VIDEO_SECTION));
        settings.map(|one| (one.key().to_owned(), one.value().to_owned())).collect::<Vec<_>>()
    };
    let mut config = VehicleConfig::default();
    assert_eq!(keys(&config), [], "off unless asked for");
    config.video_kbit_s = Some(500);
    let rate = [("video:bitrate_ctrl_mode", "2"), ("video:bitrate", "500")]
        .map(|(key, value)| (key.to_owned(), value.to_owned()));
    assert_eq!(keys(&config), rate);
    let mut vehicle = Vehicle::new(&config).unwrap();
    for (key, _) in &rate {
        vehicle.setting_unconfirmed(key);
        let said = vehicle.events.iter().filter(|event| **event == FlightEvent::NoVideoRate);
        assert_eq!(said.count(), 1, "once for all keys");
    }
    assert_eq!(vehicle.configured.unconfirmed, Vec::<String>::new());
}

#[test]
fn a_position_by_gps_stays_until_it_is_old_or_lost() {
    let config = VehicleConfig { read_back: false, gps: true, ..VehicleConfig::default() };
    let mut bench = Bench::with(&config);
    bench.run(3 * SECOND);
    let found = Gps {
        plugged: 1,
        data_available: 1,
        satellite_count: 7,
        latitude_deg: 48.9,
        ..Gps::default()
    };
    let latitude_deg =
        |bench: &Bench| bench.vehicle.status(bench.now).gps.map(|fix| fix.latitude_deg);
    assert_eq!(latitude_deg(&bench), None);
    bench.gps = Some(found);
    bench.step();
    bench.gps = None;
    bench.run(GPS_MAX_AGE);
    assert_eq!(latitude_deg(&bench), Some(48.9), "packets without it do not take it back");
    bench.step();
    assert_eq!(latitude_deg(&bench), None, "too old");
    bench.gps = Some(found);
    bench.step();
    bench.gps = Some(Gps { satellite_count: 0, ..found });
    bench.step();
    assert_eq!(latitude_deg(&bench), None, "lost");
}

#[test]
fn the_batterys_voltage_is_asked_for_and_told_of_the_newest_packet() {
    let mut bench = Bench::new();
    let settings = VehicleConfig::default().drone_settings().unwrap();
    let asked = |config: &&Config| format!("{config:?}").contains(NAVDATA_OPTIONS_KEY);
    let asked = format!("{:?}", settings.iter().find(asked));
    assert!(asked.contains("65543"), "demo, time, raw_measures and vision_detect: {asked}");
    let told_v = |bench: &Bench| bench.vehicle.status(bench.now).battery_v;
    bench.run(3 * SECOND);
    assert_eq!(told_v(&bench), None);
    bench.battery_v = Some(11.686);
    bench.step();
    assert_eq!(told_v(&bench), Some(11.686));
    // A drone that does not measure it.
    bench.battery_v = Some(0.0);
    bench.step();
    assert_eq!(told_v(&bench), None);
}
