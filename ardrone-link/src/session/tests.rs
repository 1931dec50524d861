use bytes::BytesMut;

use super::silence::{HELD_UP, UNHEARD};
use super::*;
use crate::at::{Command, Config, ControlMode, Fraction, Identity, Motion, Ref, decode};
use crate::configuration::Configuration;
use crate::navdata::{Demo, NavdataOption, PacketWriter};
use crate::settings::{NavdataMode, Setting, SettingError};

const TICK: Duration = Duration::from_millis(30);

/// A session with its simulated time.
struct Bench {
    session: Session,
    now: Duration,
    /// Events that were polled with other outputs.
    events: Vec<Event>,
}

impl Bench {
    fn new(keys: &[(&str, &str)]) -> Self {
        let settings = keys.iter().map(|(key, value)| Config::new(*key, value).unwrap()).collect();
        Self::with(SessionConfig { settings, ..SessionConfig::default() })
    }

    fn reading_back() -> Self {
        Self::with(SessionConfig { read_back: true, ..SessionConfig::default() })
    }

    fn with(config: SessionConfig) -> Self {
        Self { session: Session::new(config), now: Duration::ZERO, events: Vec::new() }
    }

    /// What is to be sent after an input: the commands of the datagram, with their numbers, and whether a
    /// wake-up follows. Events are kept.
    fn handle(&mut self, input: Input<'_>) -> (Vec<(u32, Command)>, bool) {
        self.session.handle(self.now, input);
        let (mut commands, mut wake_up) = (Vec::new(), false);
        while let Some(output) = self.session.poll() {
            match output {
                Output::Transmit(Transmit::Command(datagram)) => {
                    assert_ne!(datagram, b"", "an empty datagram is none");
                    commands = decode(datagram).map(Result::unwrap).collect();
                }
                Output::Transmit(Transmit::WakeUp) => wake_up = true,
                Output::Event(event) => self.events.push(event),
                Output::Navdata(_) | Output::Damaged(_) => {}
            }
        }
        (commands, wake_up)
    }

    fn request(&mut self, request: Request) {
        assert_eq!(self.handle(Input::Request(request)), (Vec::new(), false));
    }

    /// The next packet; returns whether it was accepted.
    fn hear(&mut self, sequence: u32, state: DroneState) -> bool {
        let control_state = if state.contains(DroneState::FLYING) {
            ControlState::Flying
        } else {
            ControlState::Landed
        };
        self.hear_in(sequence, state, control_state)
    }

    fn hear_in(&mut self, sequence: u32, state: DroneState, control_state: ControlState) -> bool {
        let demo = Demo { control_state, ..Demo::default() };
        let mut bytes = BytesMut::new();
        let mut packet = PacketWriter::new(&mut bytes, state, sequence, 0);
        packet.option(&NavdataOption::Demo(demo)).unwrap();
        packet.finish();
        let received = self.session.statistics().received;
        self.handle(Input::Navdata(&bytes));
        self.session.statistics().received > received
    }

    /// The first packets of a restarted drone, after the time that it takes to start.
    fn hear_restart(&mut self, first: u32) {
        self.now += UNHEARD;
        for sequence in first..first + 4 {
            self.hear(sequence, DroneState::NAVDATA_BOOTSTRAP);
            self.now += Duration::from_millis(66);
        }
    }

    /// Commands of one tick.
    fn tick(&mut self, flight: FlightOrder) -> Vec<Command> {
        self.now += TICK;
        let (commands, _) = self.handle(Input::Tick(Order { flight, motion: Motion::Hover }));
        commands.into_iter().map(|(_, command)| command).collect()
    }

    fn takes_off(&mut self, flight: FlightOrder) -> bool {
        self.tick(flight)[0] == Command::Ref(Ref::TakeOff)
    }

    fn events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }
}

const CLEAR: Command = Command::Control(ControlMode::ClearAcknowledge);

#[test]
fn the_handshake_sets_acknowledges_and_clears_each_key() {
    let mut bench =
        Bench::new(&[("general:navdata_demo", "TRUE"), ("control:altitude_max", "3000")]);
    let acknowledge = DroneState::COMMAND_ACKNOWLEDGE;
    let quiet = DroneState::empty();
    let config = |key: &str, value: &str| Command::Config(Config::new(key, value).unwrap());
    // Another client has left the acknowledge bit set.
    bench.hear(1, acknowledge | DroneState::NAVDATA_BOOTSTRAP);
    assert_eq!(bench.tick(FlightOrder::Land)[2..], [CLEAR]);
    bench.hear(2, DroneState::NAVDATA_BOOTSTRAP);
    let demo = config("general:navdata_demo", "TRUE");
    assert_eq!(bench.tick(FlightOrder::Land)[2], demo);
    // Not acknowledged: sent again, but not in every tick.
    assert_eq!(bench.tick(FlightOrder::Land)[2..], []);
    for _ in 0..3 {
        bench.tick(FlightOrder::Land);
    }
    assert_eq!(bench.tick(FlightOrder::Land)[2..], [demo]);
    bench.hear(3, acknowledge);
    assert_eq!(bench.tick(FlightOrder::Land)[2..], [CLEAR]);
    bench.hear(4, quiet);
    let ceiling = config("control:altitude_max", "3000");
    assert_eq!(bench.tick(FlightOrder::Land)[2..], [ceiling]);
    bench.hear(5, acknowledge);
    bench.tick(FlightOrder::Land);
    assert!(!bench.session.is_ready());
    bench.hear(6, quiet);
    assert!(bench.session.is_ready());
    let key = |key: &str| Event::Configured { key: key.to_owned() };
    assert_eq!(
        bench.events(),
        [Event::Connected, key("general:navdata_demo"), key("control:altitude_max"), Event::Ready]
    );
}

#[test]
fn a_key_that_is_never_acknowledged_is_given_up_and_reported() {
    let mut bench = Bench::new(&[("general:navdata_demo", "TRUE")]);
    for sequence in 1..100 {
        bench.hear(sequence, DroneState::empty());
        bench.tick(FlightOrder::Land);
    }
    assert!(bench.session.is_ready());
    let key = "general:navdata_demo".to_owned();
    assert!(bench.events().contains(&Event::ConfigurationTimedOut { key }));
}

#[test]
fn the_configuration_is_read_back_in_pieces() {
    let mut bench = Bench::reading_back();
    bench.hear(1, DroneState::empty());
    assert_eq!(
        bench.tick(FlightOrder::Land)[2..],
        [Command::Control(ControlMode::SendConfiguration)]
    );
    bench.handle(Input::Control(b"control:outdoor = FA"));
    assert!(!bench.session.is_ready());
    bench.handle(Input::Control(b"LSE\n\0"));
    assert!(bench.session.is_ready());
    let read = Configuration::parse("control:outdoor = FALSE\n");
    assert!(bench.events().contains(&Event::ConfigurationRead(read)));
}

#[test]
fn without_a_control_port_the_session_goes_on_and_says_so() {
    let mut bench = Bench::reading_back();
    for sequence in 1..240 {
        bench.hear(sequence, DroneState::empty());
        bench.tick(FlightOrder::Land);
    }
    assert!(bench.session.is_ready());
    assert!(bench.events().contains(&Event::ConfigurationNotRead));
}

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
fn identities_are_selected_first_and_stand_before_each_key() {
    let identity = Identity { session: 0xABCD, user: 2, application: 3 };
    let settings = ["general:navdata_demo", "control:control_yaw"]
        .map(|key| Config::new(key, "1").unwrap())
        .to_vec();
    let config = SessionConfig { settings, identity: Some(identity), ..SessionConfig::default() };
    let mut bench = Bench::with(config);
    let mut sent = Vec::new();
    let mut acknowledged = false;
    for sequence in 1..60 {
        let state =
            if acknowledged { DroneState::COMMAND_ACKNOWLEDGE } else { DroneState::empty() };
        bench.hear(sequence, state);
        let commands = bench.tick(FlightOrder::Land);
        for pair in commands.windows(2) {
            if let Command::Config(config) = &pair[1] {
                assert_eq!(pair[0], Command::ConfigIds(identity));
                sent.push((config.key().to_owned(), config.value().to_owned()));
                acknowledged = true;
            }
        }
        if commands.contains(&Command::Control(ControlMode::ClearAcknowledge)) {
            acknowledged = false;
        }
    }
    let keys: Vec<&str> = sent.iter().map(|(key, _)| key.as_str()).collect();
    assert_eq!(
        keys,
        [
            "general:navdata_demo",
            "custom:session_id",
            "custom:profile_id",
            "custom:application_id",
            "control:control_yaw",
        ]
    );
    assert_eq!(sent[1].1, "0000abcd");
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

/// Sequence numbers of one tick's commands.
fn numbers(bench: &mut Bench) -> Vec<u32> {
    bench.now += TICK;
    let (commands, _) = bench.handle(Input::Tick(Order::LAND));
    commands.into_iter().map(|(number, _)| number).collect()
}

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
    assert!(first[0].0 > 1_000_000, "beyond whatever another client has counted to");
    assert_eq!(part(&mut bench)[0].0, first[1].0 + 1, "numbers go on");
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
    assert!((0..30).any(|_| first_number(&mut bench) > 2_000_000), "until it lands");
}

/// A drone waits for configuration after two seconds without our commands, even if its navdata still arrive.
#[test]
fn a_drone_that_waits_to_be_configured_again_is() {
    let mut bench = Bench::new(&[("general:navdata_demo", "TRUE")]);
    bench.hear(1, DroneState::empty());
    bench.tick(FlightOrder::Land);
    bench.hear(2, DroneState::COMMAND_ACKNOWLEDGE);
    bench.hear(3, DroneState::empty());
    assert!(bench.session.is_ready());
    bench.tick(FlightOrder::TakeOff);
    bench.hear(4, DroneState::FLYING);
    assert!(bench.takes_off(FlightOrder::StayAirborne));
    bench.hear(5, DroneState::FLYING | DroneState::NAVDATA_BOOTSTRAP);
    assert!(!bench.session.is_ready());
    let demo = Command::Config(Config::new("general:navdata_demo", "TRUE").unwrap());
    let commands = bench.tick(FlightOrder::StayAirborne);
    assert!(commands.contains(&demo) && commands[0] == Command::Ref(Ref::Land), "{commands:?}");
}

#[test]
fn the_navdata_mode_comes_first_and_only_once() {
    let keys = |mode: NavdataMode| -> Vec<(String, String)> {
        let config = SessionConfig::new(&mode, &[Setting::AltitudeMaxM(2.0)]).unwrap();
        let pair = |config: &Config| (config.key().to_owned(), config.value().to_owned());
        config.settings.iter().map(pair).collect()
    };
    let pair = |key: &str, value: &str| (key.to_owned(), value.to_owned());
    let demo = |value| pair("general:navdata_demo", value);
    let ceiling = pair("control:altitude_max", "2000");
    assert_eq!(keys(NavdataMode::Demo), [demo("TRUE"), ceiling.clone()]);
    assert_eq!(keys(NavdataMode::Full), [demo("FALSE"), ceiling.clone()]);
    let options = pair("general:navdata_options", "65537");
    assert_eq!(keys(NavdataMode::DemoWith(vec![16])), [demo("TRUE"), options, ceiling]);
    for setting in [Setting::NavdataDemo(false), Setting::NavdataOptions(vec![0])] {
        let key = setting.key();
        let error = SessionConfig::new(&NavdataMode::Demo, &[setting]).unwrap_err();
        assert_eq!(error, SettingError::Navdata { key });
    }
    let unknown = SessionConfig::new(&NavdataMode::DemoWith(vec![28]), &[]);
    assert!(matches!(unknown, Err(SettingError::Range { .. })));
}

/// A setting requested later is applied like those at the start, and again after a restart.
#[test]
fn a_setting_can_be_changed_once_the_session_is_ready() {
    let acknowledge = DroneState::COMMAND_ACKNOWLEDGE;
    let key = |key: &str| Event::Configured { key: key.to_owned() };
    let mut bench = Bench::new(&[("general:navdata_demo", "TRUE"), ("control:outdoor", "FALSE")]);
    let mut sequence = 0;
    // Acknowledges every key; returns the keys.
    let mut converse = |bench: &mut Bench, bits: DroneState| -> Vec<String> {
        let (mut state, mut set) = (bits, Vec::new());
        for _ in 0..20 {
            sequence += 1;
            bench.hear(sequence, state);
            for command in bench.tick(FlightOrder::Land) {
                match command {
                    Command::Config(config) => {
                        set.push(format!("{}={}", config.key(), config.value()));
                        state = bits | acknowledge;
                    }
                    CLEAR => state = bits,
                    _ => {}
                }
            }
        }
        set
    };
    let quiet = DroneState::empty();
    converse(&mut bench, quiet);
    assert!(bench.session.is_ready());
    bench.events();
    for (name, value) in [("control:outdoor", "TRUE"), ("control:altitude_max", "2000")] {
        bench.request(Request::Setting(Config::new(name, value).unwrap()));
    }
    let changes = ["control:outdoor=TRUE", "control:altitude_max=2000"];
    assert_eq!(converse(&mut bench, quiet), changes);
    assert_eq!(bench.events(), [key("control:outdoor"), key("control:altitude_max")]);
    assert!(bench.session.is_ready());
    assert_eq!(converse(&mut bench, quiet), [""; 0], "that was all");
    // The drone has lost its client and is configured again, while one change is still queued.
    bench.request(Request::Setting(Config::new("control:outdoor", "FALSE").unwrap()));
    bench.hear(1000, DroneState::NAVDATA_BOOTSTRAP);
    assert!(!bench.session.is_ready());
    bench.now += Duration::from_secs(3);
    bench.tick(FlightOrder::Land);
    let all = ["general:navdata_demo=TRUE", "control:outdoor=FALSE", "control:altitude_max=2000"];
    assert_eq!(converse(&mut bench, quiet), all);
    // A change that is never acknowledged is given up like any other.
    bench.request(Request::Setting(Config::new("video:codec_fps", "30").unwrap()));
    bench.events();
    for _ in 0..100 {
        bench.tick(FlightOrder::Land);
        hear_silence(&mut bench);
    }
    let name = "video:codec_fps".to_owned();
    assert_eq!(bench.events(), [Event::ConfigurationTimedOut { key: name }]);
}

/// The next packet, without any state.
fn hear_silence(bench: &mut Bench) {
    let next = bench.session.last_navdata.map_or(1, |heard| heard.sequence + 1);
    bench.hear(next, DroneState::empty());
}

#[test]
fn settings_that_another_client_may_have_changed_are_made_again() {
    let mut bench = Bench::new(&[("control:altitude_max", "3000")]);
    let quiet = DroneState::empty();
    for sequence in [1, 201] {
        bench.hear(sequence, quiet);
        let ceiling = Command::Config(Config::new("control:altitude_max", "3000").unwrap());
        assert!(bench.tick(FlightOrder::Land).contains(&ceiling), "{sequence}");
        bench.hear(sequence + 1, DroneState::COMMAND_ACKNOWLEDGE);
        while !bench.session.is_ready() {
            bench.tick(FlightOrder::Land);
            bench.hear(sequence + 100, quiet);
        }
        assert!(bench.events().contains(&Event::Ready));
        bench.request(Request::AllSettings);
        assert!(!bench.session.is_ready());
    }
}

#[test]
fn nothing_is_said_to_a_drone_that_was_not_heard() {
    let mut bench = Bench::new(&[]);
    assert_eq!(bench.tick(FlightOrder::TakeOff), []);
    bench.hear(1, DroneState::empty());
    assert_eq!(bench.tick(FlightOrder::Land)[0], Command::Ref(Ref::Land));
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

#[test]
fn a_dump_without_an_end_is_not_collected_for_ever() {
    let mut bench = Bench::reading_back();
    bench.hear(1, DroneState::empty());
    bench.tick(FlightOrder::Land);
    bench.handle(Input::Control(&vec![b'x'; 60_000]));
    bench.handle(Input::Control(&vec![b'x'; 60_000]));
    bench.handle(Input::Control(b"control:outdoor = FALSE\n\0"));
    assert!(!bench.session.is_ready(), "what no drone sends is not read");
    let mut bench = Bench::reading_back();
    bench.hear(1, DroneState::empty());
    bench.tick(FlightOrder::Land);
    bench.handle(Input::Control(&vec![b'x'; 60_000]));
    bench.handle(Input::Control(b"\ncontrol:outdoor = FALSE\n\0"));
    assert!(bench.session.is_ready());
}
