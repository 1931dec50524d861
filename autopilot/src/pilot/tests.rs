use super::*;

fn pilot(plan: &str) -> Pilot {
    Pilot::new(Plan::parse("plan", plan).unwrap(), &PilotConfig::default()).unwrap()
}

#[test]
fn nothing_is_said_to_a_drone_that_was_not_heard() {
    let mut pilot = pilot("takeoff\nland");
    let mut datagram = Datagram::new();
    pilot.tick(Duration::ZERO, &mut datagram).unwrap();
    assert_eq!(datagram.as_bytes(), b"");
    assert!(pilot.wake_up_due(Duration::ZERO));
}

#[test]
fn a_drone_that_never_answers_ends_the_flight() {
    let mut pilot = pilot("takeoff\nland");
    let mut datagram = Datagram::new();
    pilot.tick(CONNECT_TIMEOUT.saturating_sub(TICK), &mut datagram).unwrap();
    assert_eq!(pilot.outcome(), None);
    pilot.tick(CONNECT_TIMEOUT, &mut datagram).unwrap();
    assert_eq!(pilot.outcome(), Some(&Outcome::NoDrone));
}

#[test]
fn an_order_to_land_before_the_flight_just_ends_it() {
    let mut pilot = pilot("takeoff\nland");
    pilot.order(Duration::ZERO, PilotOrder::Land);
    assert_eq!(pilot.outcome(), Some(&Outcome::Interrupted));
}

#[test]
fn random_navdata_is_ignored() {
    let mut pilot = pilot("takeoff\nland");
    for length in 0..600_usize {
        let bytes: Vec<u8> =
            (0_u8..=255).cycle().map(|i| i.wrapping_mul(37)).take(length).collect();
        pilot.handle_navdata(Duration::ZERO, &bytes);
        pilot.handle_control(Duration::ZERO, &bytes);
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
