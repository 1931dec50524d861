//! Settings and their acknowledgement, the dump of the configuration.

use super::*;

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
