//! Sequence numbers, and the datagram of a tick.

use super::*;

#[test]
fn every_datagram_begins_the_count_anew_until_the_drone_shows_that_it_hears() {
    let mut bench = Bench::new(&[("general:navdata_demo", "TRUE")]);
    bench.hear(1, DroneState::empty());
    assert_eq!(numbers(&mut bench), [1, 2, 3]);
    assert_eq!(numbers(&mut bench), [1, 2]);
    // The key is acknowledged.
    bench.hear(2, DroneState::COMMAND_ACKNOWLEDGE);
    assert_eq!(numbers(&mut bench), [4, 5, 6]);
    assert_eq!(numbers(&mut bench), [7, 8, 9]);
}

#[test]
fn a_drone_that_flies_when_told_so_hears() {
    let mut bench = Bench::new(&[]);
    bench.hear(1, DroneState::empty());
    assert_eq!(numbers(&mut bench), [1, 2]);
    bench.tick(FlightOrder::TakeOff);
    bench.hear(2, DroneState::FLYING);
    assert_eq!(numbers(&mut bench), [3, 4]);
}

/// [`Session::push`] depends on it.
#[test]
fn the_longest_commands_of_one_tick_fit_into_its_datagram() {
    let most = u32::MAX;
    let identity = Identity { session: most, user: most, application: most };
    let key = format!("section:{}", "n".repeat(248));
    let settings = vec![Config::new(key, "v".repeat(256)).unwrap()];
    let config = SessionConfig { settings, identity: Some(identity), ..SessionConfig::default() };
    let mut bench = Bench::with(config);
    bench.hear(1, DroneState::COMMUNICATION_WATCHDOG);
    bench.request(Request::FlatTrim);
    let longest = Fraction::saturating(-0.123_456_79);
    let motion = Motion::Progressive { roll: longest, pitch: longest, gaz: longest, yaw: longest };
    let (commands, _) = bench.handle(Input::Tick(Order { flight: FlightOrder::Land, motion }));
    assert_eq!(commands.len(), 6, "{commands:?}");
    // Sequence numbers have up to ten digits.
    let digits = 10 * commands.len();
    assert!(bench.session.datagram().len() + digits <= crate::at::MAX_DATAGRAM_BYTES);
}

#[test]
fn the_datagram_of_a_tick_stays_readable_until_the_next() {
    let mut session = Session::new(SessionConfig::default());
    session.handle(Duration::ZERO, Input::Tick(Order::LAND));
    assert_eq!(session.datagram(), b"", "nothing is said to a drone that was not heard");
    let mut bytes = BytesMut::new();
    PacketWriter::new(&mut bytes, DroneState::FLYING, 1, 0).finish();
    session.handle(TICK, Input::Navdata(&bytes));
    assert_eq!(session.state(), DroneState::FLYING);
    session.handle(TICK, Input::Tick(Order::LAND));
    let sent = loop {
        match session.poll() {
            Some(Output::Transmit(Transmit::Command(datagram))) => break datagram.to_vec(),
            Some(_) => {}
            None => panic!("nothing was sent"),
        }
    };
    assert_eq!(session.datagram(), sent);
    session.handle(2 * TICK, Input::Listen);
    assert_eq!(session.datagram(), b"");
}

#[test]
fn an_acknowledged_change_shows_that_the_drone_hears() {
    let mut bench = Bench::new(&[]);
    bench.hear(1, DroneState::empty());
    assert_eq!(numbers(&mut bench), [1, 2]);
    bench.request(Request::Setting(Config::new("control:outdoor", "TRUE").unwrap()));
    bench.tick(FlightOrder::Land);
    bench.hear(2, DroneState::empty());
    assert_eq!(numbers(&mut bench)[0], 1, "not acknowledged yet");
    bench.hear(3, DroneState::COMMAND_ACKNOWLEDGE);
    assert!(numbers(&mut bench)[0] > 1);
}
