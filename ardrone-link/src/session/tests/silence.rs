//! Packets that are missing, late, old or damaged, and a drone that restarts.

use super::*;

#[test]
fn old_repeated_and_damaged_navdata_is_dropped_and_counted() {
    let mut bench = Bench::new(&[]);
    assert!(bench.hear(50, DroneState::empty()));
    assert!(!bench.hear(50, DroneState::empty()));
    assert!(!bench.hear(49, DroneState::empty()));
    bench.session.handle(bench.now, Input::Navdata(b"garbage"));
    assert!(matches!(bench.session.poll(), Some(Output::Damaged(_))));
    let expected = Statistics { received: 1, stale: 2, damaged: 1 };
    assert_eq!(bench.session.statistics(), expected);
}

#[test]
fn the_watchdog_bit_is_answered_and_nothing_else_is() {
    let mut bench = Bench::new(&[]);
    bench.hear(1, DroneState::COMMUNICATION_WATCHDOG);
    assert!(bench.tick(FlightOrder::Land).contains(&Command::CommunicationWatchdog));
    bench.hear(2, DroneState::empty());
    assert!(!bench.tick(FlightOrder::Land).contains(&Command::CommunicationWatchdog));
}

#[test]
fn silence_wakes_the_drone_again_and_becomes_a_loss() {
    let mut bench = Bench::new(&[]);
    assert_eq!(bench.handle(Input::Listen), (Vec::new(), true));
    bench.now += TICK;
    assert_eq!(bench.handle(Input::Listen), (Vec::new(), false));
    bench.hear(900, DroneState::FLYING);
    bench.now += Duration::from_millis(1900);
    let stay = Order { flight: FlightOrder::StayAirborne, motion: Motion::Hover };
    let (commands, wake_up) = bench.handle(Input::Tick(stay));
    assert!(!commands.is_empty() && wake_up);
    assert!(bench.session.is_alive());
    bench.now += Duration::from_millis(200);
    let datagram = bench.tick(FlightOrder::StayAirborne);
    assert!(!bench.session.is_alive());
    assert_eq!(datagram[0], Command::Ref(Ref::Land));
    // The drone is back with low numbers, which is accepted.
    assert!(bench.hear(1, DroneState::empty()));
    assert_eq!(
        bench.events(),
        [
            Event::Connected,
            Event::Airborne,
            Event::Ready,
            Event::LinkLost,
            Event::Connected,
            Event::Landed,
            Event::Ready
        ]
    );
}

#[test]
fn a_drone_that_restarts_in_flight_does_not_take_off_again() {
    let mut bench = Bench::new(&[]);
    bench.hear(500, DroneState::empty());
    assert!(bench.takes_off(FlightOrder::TakeOff));
    bench.hear(501, DroneState::FLYING);
    assert!(bench.takes_off(FlightOrder::StayAirborne));
    bench.hear_restart(1);
    assert!(bench.events().contains(&Event::DroneRestarted));
    // Neither staying in the air nor the order that is still given counts as new.
    assert!(!bench.takes_off(FlightOrder::StayAirborne));
    assert!(!bench.takes_off(FlightOrder::TakeOff));
    // A new order does.
    assert!(!bench.takes_off(FlightOrder::Land));
    assert!(bench.takes_off(FlightOrder::TakeOff));
}

#[test]
fn nothing_that_could_lift_the_drone_is_said_into_the_silence() {
    let mut bench = Bench::new(&[]);
    bench.hear(500, DroneState::empty());
    assert!(bench.takes_off(FlightOrder::TakeOff));
    bench.hear(501, DroneState::FLYING);
    bench.now += Duration::from_millis(280);
    for order in [FlightOrder::StayAirborne, FlightOrder::TakeOff] {
        assert_eq!(bench.tick(order)[..], [Command::Pcmd(Motion::Hover)]);
    }
    assert_eq!(bench.tick(FlightOrder::Land)[0], Command::Ref(Ref::Land));
    bench.hear(510, DroneState::FLYING);
    bench.now += HELD_UP;
    bench.hear(511, DroneState::FLYING);
    assert!(bench.takes_off(FlightOrder::StayAirborne));
}

/// A restart takes longer than packets are delayed.
#[test]
fn old_packets_that_come_again_are_no_restart() {
    let mut bench = Bench::new(&[]);
    let bootstrapping = DroneState::NAVDATA_BOOTSTRAP;
    assert!(bench.hear(40, bootstrapping));
    bench.hear(100, DroneState::FLYING);
    for old in [1, 2, 39, 40] {
        assert!(!bench.hear(old, bootstrapping), "amid new ones");
    }
    // The drone was lost, and waits in the air to be configured again.
    bench.now += UNHEARD;
    bench.hear(140, bootstrapping | DroneState::FLYING);
    assert!(!bench.hear(139, bootstrapping | DroneState::FLYING), "overtaken");
    assert!(bench.hear(1, bootstrapping));
    let restarts = bench.events().into_iter().filter(|event| *event == Event::DroneRestarted);
    assert_eq!(restarts.count(), 1, "that was one");
}

/// Delayed packets from before a restart do not describe the current state.
#[test]
fn packets_that_were_held_up_do_not_show_that_the_drone_still_flies() {
    let mut bench = Bench::new(&[]);
    let lifts = |commands: &[Command]| commands.contains(&Command::Ref(Ref::TakeOff));
    for sequence in 100..110 {
        bench.hear(sequence, DroneState::FLYING);
        assert!(lifts(&bench.tick(FlightOrder::TakeOff)));
    }
    bench.now += UNHEARD;
    for sequence in 110..113 {
        bench.hear(sequence, DroneState::FLYING);
        assert!(!lifts(&bench.tick(FlightOrder::StayAirborne)), "they came in a heap");
    }
    bench.now += HELD_UP;
    bench.hear(113, DroneState::FLYING);
    assert!(lifts(&bench.tick(FlightOrder::StayAirborne)), "it goes on telling");
}

#[test]
fn the_count_goes_on_after_a_loss_and_after_a_restart() {
    let mut bench = Bench::new(&[("general:navdata_demo", "TRUE")]);
    bench.hear(100, DroneState::empty());
    numbers(&mut bench);
    bench.hear(101, DroneState::COMMAND_ACKNOWLEDGE);
    let last = *numbers(&mut bench).last().unwrap();
    bench.now += Duration::from_millis(2500);
    assert_eq!(numbers(&mut bench)[0], last + 1);
    assert!(!bench.session.is_alive());
    bench.hear(1, DroneState::NAVDATA_BOOTSTRAP);
    assert!(numbers(&mut bench)[0] > last + 1);
}

#[test]
fn nothing_is_said_to_a_drone_that_was_not_heard() {
    let mut bench = Bench::new(&[]);
    assert_eq!(bench.tick(FlightOrder::TakeOff), []);
    bench.hear(1, DroneState::empty());
    assert_eq!(bench.tick(FlightOrder::Land)[0], Command::Ref(Ref::Land));
}

#[test]
fn silence_is_the_time_since_the_newest_packet() {
    let mut bench = Bench::new(&[]);
    assert_eq!(bench.session.silence(bench.now), None);
    bench.hear(1, DroneState::empty());
    bench.now += 3 * TICK;
    assert_eq!(bench.session.silence(bench.now), Some(3 * TICK));
}

#[test]
fn a_drone_that_is_heard_is_not_woken() {
    let mut bench = Bench::new(&[]);
    assert!(bench.handle(Input::Listen).1);
    for sequence in 1..40 {
        bench.now += TICK;
        bench.hear(sequence, DroneState::empty());
        assert!(!bench.handle(Input::Listen).1);
    }
}
