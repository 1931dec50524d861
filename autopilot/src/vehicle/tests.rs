use ardrone_link::navdata::{NavdataOption, PacketWriter};
use bytes::BytesMut;

use super::*;

fn pilot(plan: &str) -> Pilot {
    Pilot::new(Plan::parse("plan", plan).unwrap(), &PilotConfig::default()).unwrap()
}

#[test]
fn nothing_is_said_to_a_drone_that_was_not_heard() {
    let mut pilot = pilot("takeoff\nland");
    pilot.tick(Duration::ZERO).unwrap();
    assert_eq!(pilot.poll(), Some(Output::Transmit(Transmit::WakeUp)));
    assert_eq!(pilot.poll(), None);
}

#[test]
fn a_drone_that_never_answers_ends_the_flight() {
    let mut pilot = pilot("takeoff\nland");
    pilot.tick(CONNECT_TIMEOUT.saturating_sub(TICK)).unwrap();
    assert_eq!(pilot.outcome(), None);
    while pilot.poll().is_some() {}
    pilot.tick(CONNECT_TIMEOUT).unwrap();
    assert_eq!(pilot.outcome(), Some(&Outcome::NoDrone));
    let said: Vec<_> =
        std::iter::from_fn(|| pilot.poll().map(|output| matches!(output, Output::Ended(_))))
            .collect();
    assert_eq!(said.iter().filter(|ended| **ended).count(), 1, "the end is said once");
    assert_eq!(said.last(), Some(&true), "and last");
}

#[test]
fn an_order_to_land_before_the_flight_just_ends_it() {
    let mut pilot = pilot("takeoff\nland");
    pilot.handle(Duration::ZERO, Input::Order(PilotOrder::Land));
    assert_eq!(pilot.outcome(), Some(&Outcome::Interrupted));
}

#[test]
fn random_navdata_is_ignored() {
    let mut pilot = pilot("takeoff\nland");
    for length in 0..600_usize {
        let bytes: Vec<u8> =
            (0_u8..=255).cycle().map(|i| i.wrapping_mul(37)).take(length).collect();
        pilot.handle(Duration::ZERO, Input::Navdata(&bytes));
        pilot.handle(Duration::ZERO, Input::Control(&bytes));
    }
    assert_eq!(pilot.status(Duration::ZERO).battery_percent, None);
}

#[test]
fn limits_that_the_drone_has_not_taken_forbid_the_flight_and_a_missing_clock_does_not() {
    let mut pilot = pilot("takeoff\nland");
    let taken = |pilot: &Pilot, without: &str| {
        let kept = pilot.settings.iter().filter(|setting| setting.key() != without);
        let lines = kept.map(|setting| format!("{} = {}\n", setting.key(), setting.value()));
        Configuration::parse(&lines.collect::<Vec<_>>().concat())
    };
    pilot.compare_configuration(&taken(&pilot, NAVDATA_OPTIONS_KEY));
    assert!(pilot.events.contains(&FlightEvent::NoDroneClock));
    assert!(pilot.report.unconfirmed_settings.is_empty());
    pilot.compare_configuration(&taken(&pilot, "control:altitude_max"));
    assert_eq!(pilot.report.unconfirmed_settings, ["control:altitude_max"]);
}

/// Why a pilot that has just heard a drone on the ground does not take off.
fn refusals(plan: &str, demo: Demo, packets: u64, later: Duration) -> Vec<String> {
    let mut pilot = pilot(plan);
    let mut bytes = BytesMut::new();
    let mut packet = PacketWriter::new(&mut bytes, DroneState::empty(), 1, 0);
    packet.option(&NavdataOption::Demo(demo)).unwrap();
    packet.finish();
    pilot.handle(Duration::ZERO, Input::Navdata(&bytes));
    pilot.take_off_or_refuse(later, Duration::from_secs(1), packets);
    match pilot.outcome() {
        Some(Outcome::PreflightRefused { reasons }) => reasons.clone(),
        None => Vec::new(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_pre_flight_check_tells_every_reason() {
    let control_state = ControlState::Landed;
    let fine = Demo { battery_percent: 60, control_state, ..Demo::default() };
    let short = "takeoff\nland";
    let now = Duration::from_millis(60);
    assert_eq!(refusals(short, fine, 15, now), [""; 0]);
    let leaning = Demo { pitch_deg: -9.0, ..fine };
    assert_eq!(
        refusals(short, leaning, 3, now),
        [
            "the drone leans by 9°: put it on level ground",
            "only 3 packets of flight data a second: at least 5 are needed; go nearer, or to \
             another channel",
        ]
    );
    assert_eq!(
        refusals(short, fine, 15, Duration::from_millis(501)),
        ["the newest flight data are 501 ms old: go nearer, or to another channel"]
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
