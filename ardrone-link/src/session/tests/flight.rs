//! Take-off, landing and emergency.

use super::*;

#[test]
fn after_an_emergency_or_a_landing_the_order_to_fly_is_spent() {
    for end in [DroneState::EMERGENCY, DroneState::empty()] {
        let mut bench = Bench::new(&[]);
        bench.hear(1, DroneState::empty());
        assert!(bench.takes_off(FlightOrder::TakeOff));
        bench.hear(2, DroneState::FLYING);
        bench.hear(3, end);
        assert!(!bench.takes_off(FlightOrder::StayAirborne));
        assert!(!bench.takes_off(FlightOrder::TakeOff));
    }
}

#[test]
fn staying_airborne_never_takes_off() {
    let mut bench = Bench::new(&[]);
    bench.hear(1, DroneState::empty());
    assert!(!bench.takes_off(FlightOrder::StayAirborne));
}

#[test]
fn flying_and_landing_are_reported_and_a_take_off_that_does_not_come_is_given_up() {
    let mut bench = Bench::new(&[]);
    let mut events = Vec::new();
    let take_off = |commands: &[Command]| commands.contains(&Command::Ref(Ref::TakeOff));
    let mut ordered = 0;
    for sequence in 1..400 {
        bench.hear(sequence, DroneState::empty());
        ordered += usize::from(take_off(&bench.tick(FlightOrder::TakeOff)));
        events.extend(bench.events());
    }
    assert!(events.contains(&Event::TakeOffTimedOut));
    assert!((260..275).contains(&ordered), "eight seconds, then never again: {ordered}");
    bench.tick(FlightOrder::Land);
    assert!(take_off(&bench.tick(FlightOrder::TakeOff)), "until it is ordered anew");
    bench.hear(400, DroneState::FLYING);
    assert_eq!(bench.events(), [Event::Airborne]);
    bench.hear(401, DroneState::empty());
    assert_eq!(bench.events(), [Event::Landed]);
}

#[test]
fn an_emergency_stop_beats_every_order_and_is_never_left_on() {
    let mut bench = Bench::new(&[]);
    bench.hear(1, DroneState::FLYING);
    bench.request(Request::EmergencyStop);
    let reference = |commands: &[Command]| match commands[0] {
        Command::Ref(reference) => reference,
        _ => panic!("REF comes first"),
    };
    assert_eq!(reference(&bench.tick(FlightOrder::TakeOff)), Ref::ToggleEmergency);
    bench.hear(2, DroneState::EMERGENCY);
    for _ in 0..10 {
        assert_eq!(reference(&bench.tick(FlightOrder::TakeOff)), Ref::Land);
    }
    bench.request(Request::EmergencyReset);
    assert_eq!(reference(&bench.tick(FlightOrder::Land)), Ref::ToggleEmergency);
    bench.hear(9, DroneState::empty());
    assert_eq!(reference(&bench.tick(FlightOrder::Land)), Ref::Land);
    assert_eq!(
        bench.events()[2..],
        [Event::Ready, Event::Emergency, Event::EmergencyCleared],
        "both ends of the emergency are reported"
    );
}

#[test]
fn a_drone_that_falls_or_has_restarted_has_not_landed() {
    let mut bench = Bench::new(&[]);
    bench.hear(500, DroneState::FLYING);
    bench.hear(501, DroneState::EMERGENCY);
    let events = bench.events();
    assert!(events.contains(&Event::Emergency) && !events.contains(&Event::Landed), "{events:?}");
    let mut bench = Bench::new(&[]);
    bench.hear(500, DroneState::FLYING);
    bench.hear_restart(1);
    let events = bench.events();
    assert!(events.contains(&Event::DroneRestarted), "{events:?}");
    assert!(!events.contains(&Event::Landed), "{events:?}");
}

#[test]
fn a_parting_says_land_and_nothing_else_and_only_to_a_drone_that_was_spoken_to() {
    let part = |bench: &mut Bench| bench.handle(Input::Part).0;
    let mut bench = Bench::new(&[("general:navdata_demo", "TRUE")]);
    bench.hear(1, DroneState::FLYING);
    assert_eq!(part(&mut bench), []);
    bench.tick(FlightOrder::Land);
    bench.hear(2, DroneState::FLYING | DroneState::COMMAND_ACKNOWLEDGE);
    bench.request(Request::FlatTrim);
    let first = part(&mut bench);
    let landing = [Command::Ref(Ref::Land), Command::Pcmd(Motion::Hover)];
    assert_eq!(first.iter().map(|(_, command)| command.clone()).collect::<Vec<_>>(), landing);
    assert_eq!(first[0].0, 1, "accepted whatever another client has counted to");
    let second = part(&mut bench);
    assert!(second[0].0 > 1_000_000, "nothing older is accepted after it");
    assert_eq!(part(&mut bench)[0].0, 1);
    assert_eq!(part(&mut bench)[0].0, second[1].0 + 1, "numbers go on");
    // A cut of the motors is not taken back.
    bench.request(Request::EmergencyStop);
    assert_eq!(part(&mut bench)[0].1, Command::Ref(Ref::ToggleEmergency));
    bench.hear(3, DroneState::EMERGENCY);
    assert_eq!(part(&mut bench)[0].1, Command::Ref(Ref::Land));
}

/// Another client may have used numbers far above ours.
#[test]
fn a_landing_that_is_not_obeyed_is_counted_far_ahead() {
    let mut bench = Bench::new(&[]);
    bench.hear(1, DroneState::empty());
    bench.tick(FlightOrder::TakeOff);
    bench.hear(2, DroneState::FLYING);
    assert!(numbers(&mut bench)[0] > 1, "it hears us");
    let mut sequence = 3;
    let mut first_number = |bench: &mut Bench| {
        bench.hear(sequence, DroneState::FLYING);
        sequence += 1;
        numbers(bench)[0]
    };
    assert!(first_number(&mut bench) > 1, "it may be on its way");
    let ahead = (0..30).position(|_| first_number(&mut bench) > 1_000_000);
    assert!(ahead.is_some_and(|tick| (15..18).contains(&tick)), "{ahead:?}");
    // It has counted further: number 1 is accepted all the same.
    let anew = (0..30).position(|_| first_number(&mut bench) == 1);
    assert!(anew.is_some_and(|tick| (14..18).contains(&tick)), "{anew:?}");
    for _ in 0..30 {
        assert!(first_number(&mut bench) > 1_000_000, "no older datagram is accepted for long");
        assert_eq!(first_number(&mut bench), 1);
    }
}

#[test]
fn flat_trim_is_made_once_on_the_ground_and_never_in_the_air() {
    let mut bench = Bench::new(&[]);
    let trims = |bench: &mut Bench| bench.tick(FlightOrder::Land).contains(&Command::FlatTrim);
    bench.hear(1, DroneState::empty());
    assert!(!trims(&mut bench), "it was not requested");
    bench.request(Request::FlatTrim);
    assert!(trims(&mut bench));
    assert!(!trims(&mut bench));
    bench.hear(2, DroneState::FLYING);
    bench.request(Request::FlatTrim);
    assert!(!trims(&mut bench));
    bench.hear(3, DroneState::empty());
    assert!(!trims(&mut bench), "the request is dropped, not delayed");
}

#[test]
fn a_take_off_that_has_happened_does_not_time_out_nor_does_one_that_was_not_ordered() {
    for (order, state) in
        [(FlightOrder::TakeOff, DroneState::FLYING), (FlightOrder::Land, DroneState::empty())]
    {
        let mut bench = Bench::new(&[]);
        bench.hear(1, DroneState::empty());
        bench.tick(order);
        for sequence in 2..400 {
            bench.hear(sequence, state);
            let lifts = bench.tick(order)[0] == Command::Ref(Ref::TakeOff);
            assert_eq!(lifts, order == FlightOrder::TakeOff);
        }
        assert!(!bench.events().contains(&Event::TakeOffTimedOut), "{order:?}");
    }
}

#[test]
fn a_landing_that_is_obeyed_is_not_counted_ahead() {
    for (state, control_state) in
        [(DroneState::FLYING, ControlState::Landing), (DroneState::empty(), ControlState::Landed)]
    {
        let mut bench = Bench::new(&[]);
        bench.hear(1, DroneState::empty());
        bench.tick(FlightOrder::TakeOff);
        bench.hear(2, DroneState::FLYING);
        for sequence in 3..100 {
            bench.hear_in(sequence, state, control_state);
            assert!(numbers(&mut bench)[0] < 1000, "{control_state:?}");
        }
    }
}
