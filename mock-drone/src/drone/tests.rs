use ardrone_link::at::{Command, Config, ControlMode, Datagram, Fraction, Motion, Ref};
use ardrone_link::navdata::{ControlState, DroneState, Navdata};

use super::*;

/// A drone, and a client that sends a datagram every 30 ms.
struct Bench {
    drone: Drone,
    now: Duration,
    sequence: u32,
    heard: Vec<Navdata>,
}

const TICK: Duration = Duration::from_millis(30);
const HOVER: Motion = Motion::Hover;

impl Bench {
    fn new(config: &DroneConfig) -> Self {
        let mut bench =
            Self { drone: Drone::new(config), now: Duration::ZERO, sequence: 0, heard: Vec::new() };
        bench.drone.handle_wake_up(bench.now);
        bench
    }

    /// A configured drone.
    fn ready(config: &DroneConfig) -> Self {
        let mut bench = Self::new(config);
        bench.send(&[Command::Config(Config::new("general:navdata_demo", "TRUE").unwrap())]);
        bench.send(&[Command::Control(ControlMode::ClearAcknowledge)]);
        bench
    }

    fn send(&mut self, commands: &[Command]) {
        let mut datagram = Datagram::new();
        for command in commands {
            self.sequence += 1;
            datagram.push(self.sequence, command).unwrap();
        }
        assert_eq!(self.drone.handle_at(self.now, datagram.as_bytes()), []);
        self.wait(TICK);
    }

    fn wait(&mut self, time: Duration) {
        self.now += time;
        self.drone.advance(self.now);
        while let Some(packet) = self.drone.poll_navdata() {
            self.heard.push(Navdata::decode(&packet).unwrap());
        }
    }

    fn fly(&mut self, reference: Ref, motion: Motion, seconds: f64) {
        for _ in 0..(Duration::from_secs_f64(seconds).as_millis() / TICK.as_millis()) {
            self.send(&[Command::Ref(reference), Command::Pcmd(motion)]);
        }
    }

    fn last(&self) -> &Navdata {
        self.heard.last().unwrap()
    }

    fn control_state(&self) -> ControlState {
        self.last().demo.unwrap().control_state
    }
}

fn progressive(roll: f64, pitch: f64, gaz: f64, yaw: f64) -> Motion {
    let [roll, pitch, gaz, yaw] = [roll, pitch, gaz, yaw].map(Fraction::saturating);
    Motion::Progressive { roll, pitch, gaz, yaw }
}

#[test]
fn the_drone_bootstraps_until_it_is_configured() {
    let mut bench = Bench::new(&DroneConfig::default());
    bench.wait(Duration::from_secs(1));
    assert!(bench.heard.len() >= 14);
    assert!(bench.last().state.contains(DroneState::NAVDATA_BOOTSTRAP));
    assert_eq!(bench.last().demo, None);
    bench.send(&[Command::Config(Config::new("general:navdata_demo", "TRUE").unwrap())]);
    bench.wait(Duration::from_millis(70));
    assert!(bench.last().state.contains(DroneState::COMMAND_ACKNOWLEDGE));
    assert!(!bench.last().state.contains(DroneState::NAVDATA_BOOTSTRAP));
    assert_eq!(bench.control_state(), ControlState::Landed);
    assert_eq!(bench.last().time, None);
    bench.send(&[Command::Control(ControlMode::ClearAcknowledge)]);
    bench.wait(Duration::from_millis(70));
    assert!(!bench.last().state.contains(DroneState::COMMAND_ACKNOWLEDGE));
}

#[test]
fn full_navdata_comes_at_two_hundred_hertz_with_the_clock() {
    let mut bench = Bench::new(&DroneConfig::default());
    bench.send(&[Command::Config(Config::new("general:navdata_demo", "FALSE").unwrap())]);
    bench.wait(Duration::from_millis(100));
    bench.heard.clear();
    bench.wait(Duration::from_secs(1));
    assert!((195..=205).contains(&bench.heard.len()), "{}", bench.heard.len());
    assert!(bench.last().time.is_some());
}

#[test]
fn take_off_climbs_to_a_hover_and_landing_ends_on_the_ground() {
    let mut bench = Bench::ready(&DroneConfig::default());
    bench.fly(Ref::TakeOff, HOVER, 0.6);
    assert_eq!(bench.control_state(), ControlState::TakingOff);
    bench.fly(Ref::TakeOff, HOVER, 4.5);
    assert_eq!(bench.control_state(), ControlState::Hovering);
    let height_m = bench.drone.truth().position_m.z;
    assert!((0.75..0.95).contains(&height_m), "{height_m}");
    bench.fly(Ref::Land, HOVER, 5.0);
    assert_eq!(bench.control_state(), ControlState::Landed);
    assert!(bench.drone.truth().position_m.z.abs() < 1e-9);
}

#[test]
fn sticks_move_the_drone_as_the_protocol_says() {
    for (motion, axis, sign) in [
        (progressive(0.5, 0.0, 0.0, 0.0), 0, 1.0),
        (progressive(0.0, -0.5, 0.0, 0.0), 1, 1.0),
        (progressive(0.0, 0.0, -0.5, 0.0), 2, -1.0),
    ] {
        let mut bench = Bench::ready(&DroneConfig::default());
        bench.fly(Ref::TakeOff, HOVER, 5.0);
        let before = bench.drone.truth().position_m;
        bench.fly(Ref::TakeOff, motion, 1.0);
        let moved = bench.drone.truth().position_m - before;
        assert!(moved[axis] * sign > 0.1, "{motion:?}: {moved}");
        assert_eq!(bench.control_state(), ControlState::Flying);
    }
    let mut bench = Bench::ready(&DroneConfig::default());
    bench.fly(Ref::TakeOff, HOVER, 5.0);
    bench.fly(Ref::TakeOff, progressive(0.0, 0.0, 0.0, 0.5), 1.0);
    assert!(bench.drone.truth().yaw_deg > 20.0);
}

#[test]
fn hover_brakes_and_holds_the_place() {
    let mut bench = Bench::ready(&DroneConfig::default());
    bench.fly(Ref::TakeOff, HOVER, 5.0);
    bench.fly(Ref::TakeOff, progressive(0.0, -1.0, 0.0, 0.0), 1.0);
    bench.fly(Ref::TakeOff, HOVER, 4.0);
    let place = bench.drone.truth().position_m;
    bench.fly(Ref::TakeOff, HOVER, 5.0);
    let moved = bench.drone.truth().position_m - place;
    assert!(moved.norm() < 0.15, "{moved}");
}

#[test]
fn the_emergency_bit_is_an_edge_that_cuts_and_clears() {
    let mut bench = Bench::ready(&DroneConfig::default());
    bench.fly(Ref::TakeOff, HOVER, 5.0);
    bench.fly(Ref::ToggleEmergency, HOVER, 1.0);
    assert!(bench.last().state.contains(DroneState::EMERGENCY | DroneState::USER_EMERGENCY));
    assert!(bench.drone.truth().position_m.z < 0.01);
    bench.fly(Ref::TakeOff, HOVER, 1.0);
    assert!(bench.last().state.contains(DroneState::EMERGENCY));
    bench.fly(Ref::ToggleEmergency, HOVER, 0.2);
    bench.fly(Ref::Land, HOVER, 0.2);
    assert!(!bench.last().state.contains(DroneState::EMERGENCY));
}

#[test]
fn old_commands_are_ignored_and_number_one_starts_anew() {
    let mut bench = Bench::ready(&DroneConfig::default());
    bench.sequence = 100;
    bench.fly(Ref::Land, HOVER, 0.2);
    bench.sequence = 50;
    bench.fly(Ref::TakeOff, HOVER, 0.3);
    assert_eq!(bench.drone.truth().phase, Phase::Landed);
    bench.sequence = 0;
    bench.fly(Ref::TakeOff, HOVER, 0.3);
    assert!(matches!(bench.drone.truth().phase, Phase::TakingOff { .. }));
}

#[test]
fn a_silent_pilot_raises_the_watchdog_then_loses_the_link() {
    let mut bench = Bench::ready(&DroneConfig::default());
    bench.fly(Ref::TakeOff, HOVER, 5.0);
    bench.wait(Duration::from_millis(300));
    assert!(bench.last().state.contains(DroneState::COMMUNICATION_WATCHDOG));
    bench.wait(Duration::from_secs(2));
    let packets = bench.heard.len();
    bench.wait(Duration::from_secs(1));
    assert_eq!(bench.heard.len(), packets, "the drone sends to nobody");
    assert_eq!(bench.drone.truth().phase, Phase::Flying);
    bench.wait(Duration::from_secs(6));
    assert_eq!(bench.drone.truth().phase, Phase::Landed);
    bench.drone.handle_wake_up(bench.now);
    bench.fly(Ref::Land, HOVER, 0.3);
    assert!(bench.last().state.contains(DroneState::NAVDATA_BOOTSTRAP));
}

#[test]
fn an_empty_battery_refuses_take_off_and_a_low_one_lands() {
    let low = DroneConfig { battery_percent: 19.0, ..DroneConfig::default() };
    let mut bench = Bench::ready(&low);
    bench.fly(Ref::TakeOff, HOVER, 3.0);
    assert_eq!(bench.drone.truth().phase, Phase::Landed);
    let flat = DroneConfig { battery_percent: 20.5, ..DroneConfig::default() };
    let mut bench = Bench::ready(&flat);
    for _ in 0..100 {
        bench.fly(Ref::TakeOff, HOVER, 1.0);
        if bench.drone.battery_percent() < 8.5 {
            assert!(bench.last().state.contains(DroneState::BATTERY_LOW));
        }
    }
    assert_eq!(bench.drone.truth().phase, Phase::Landed);
}

#[test]
fn the_configuration_is_stored_and_dumped() {
    let mut bench = Bench::ready(&DroneConfig::default());
    bench.send(&[Command::Config(Config::new("control:altitude_max", "2000").unwrap())]);
    assert_eq!(bench.drone.poll_control(), None);
    bench.send(&[Command::Control(ControlMode::SendConfiguration)]);
    let dump = bench.drone.poll_control().unwrap();
    assert!(dump.contains("control:altitude_max = 2000\n") && dump.ends_with('\0'));
}

#[test]
fn the_ceiling_holds() {
    let mut bench = Bench::ready(&DroneConfig::default());
    bench.send(&[Command::Config(Config::new("control:altitude_max", "1500").unwrap())]);
    bench.fly(Ref::TakeOff, HOVER, 5.0);
    bench.fly(Ref::TakeOff, progressive(0.0, 0.0, 1.0, 0.0), 5.0);
    let height_m = bench.drone.truth().position_m.z;
    assert!((1.4..2.0).contains(&height_m), "{height_m}");
}

#[test]
fn navdata_say_something_wrong_while_the_drone_hovers_by_the_truth() {
    let mut bench = Bench::ready(&DroneConfig::default());
    bench.fly(Ref::TakeOff, HOVER, 5.0);
    bench.drone.break_sensor(Quantity::Altitude, SensorFault::StuckAt(5.0), TICK * 20);
    bench.drone.break_sensor(Quantity::VelocityRight, SensorFault::NotANumber, TICK * 20);
    let place = bench.drone.truth();
    bench.fly(Ref::TakeOff, HOVER, 0.5);
    let demo = bench.last().demo.unwrap();
    assert!((demo.altitude_m - 5.0).abs() < 1e-3 && demo.velocity_right_m_s.is_nan());
    let moved = bench.drone.truth().position_m - place.position_m;
    assert!(moved.norm() < 0.1, "{moved}");
    bench.fly(Ref::TakeOff, HOVER, 0.5);
    let demo = bench.last().demo.unwrap();
    assert!((demo.altitude_m - 0.85).abs() < 0.1 && demo.velocity_right_m_s.is_finite());
    let drift_m = (bench.drone.truth().drift_m() - place.drift_m()).norm();
    assert!(drift_m < 0.1, "the odometry is that of healthy sensors: {drift_m}");
}

#[test]
fn the_drone_claims_states_for_a_time() {
    let mut bench = Bench::ready(&DroneConfig::default());
    bench.drone.claim_state(DroneState::ULTRASOUND_DEAF, TICK * 10);
    bench.drone.claim_minor_state(6, TICK * 20);
    let mut heard = |time| {
        bench.wait(time);
        let deaf = bench.last().state.contains(DroneState::ULTRASOUND_DEAF);
        (deaf, bench.last().demo.unwrap().control_state_minor)
    };
    assert_eq!(heard(TICK * 6), (true, 6));
    assert_eq!(heard(TICK * 8), (false, 6));
    assert_eq!(heard(TICK * 10), (false, 0));
}

#[test]
fn a_drone_that_flies_from_the_start_hovers_and_lands_without_a_pilot() {
    let flying = DroneConfig { flies_at_m: Some(1.5), ..DroneConfig::default() };
    let mut bench = Bench::new(&flying);
    bench.wait(Duration::from_secs(1));
    assert_eq!(bench.control_state(), ControlState::Hovering);
    let truth = bench.drone.truth();
    assert!((truth.position_m.z - 1.5).abs() < 0.1 && truth.phase == Phase::Flying, "{truth:?}");
    bench.wait(Duration::from_secs(10));
    assert_eq!(bench.drone.truth().phase, Phase::Landed);
}

#[test]
fn a_battery_that_sags_seems_emptier_in_flight() {
    let tired =
        DroneConfig { battery_percent: 30.0, battery_sag_percent: 33.0, ..DroneConfig::default() };
    let mut bench = Bench::ready(&tired);
    assert!(bench.drone.battery_percent() > 29.9);
    bench.fly(Ref::TakeOff, HOVER, 3.0);
    assert!(bench.last().demo.unwrap().battery_percent < 10);
    assert!(bench.last().state.contains(DroneState::BATTERY_LOW));
    bench.fly(Ref::Land, HOVER, 6.0);
    assert_eq!(bench.drone.truth().phase, Phase::Landed);
    assert!(bench.drone.battery_percent() > 28.0, "without load it recovers");
}

#[test]
fn the_truth_counts_meetings_with_the_floor_and_tells_their_speed() {
    let mut bench = Bench::ready(&DroneConfig::default());
    bench.fly(Ref::TakeOff, HOVER, 5.0);
    bench.fly(Ref::TakeOff, progressive(0.0, 0.0, -1.0, 0.0), 3.0);
    let truth = bench.drone.truth();
    assert_eq!(truth.floor_contacts, 1);
    assert!(truth.touch_down_m_s.is_some_and(|speed_m_s| speed_m_s > 0.5), "{truth:?}");
    let mut bench = Bench::ready(&DroneConfig::default());
    bench.fly(Ref::TakeOff, HOVER, 5.0);
    bench.fly(Ref::Land, HOVER, 5.0);
    let truth = bench.drone.truth();
    assert_eq!(truth.floor_contacts, 0, "a landing is not a floor contact");
    assert!(truth.touch_down_m_s.is_some_and(|speed_m_s| speed_m_s < 0.3), "{truth:?}");
}

#[test]
fn what_is_known_of_the_place_outlives_a_restart() {
    let mut bench = Bench::ready(&DroneConfig::default());
    bench.fly(Ref::TakeOff, HOVER, 5.0);
    bench.fly(Ref::TakeOff, progressive(0.0, -0.5, 0.0, 0.0), 2.0);
    bench.drone.restart(bench.now);
    let truth = bench.drone.truth();
    assert!(truth.odometry_m.y > 0.5 && truth.drift_m().norm() < 0.2, "{truth:?}");
}

#[test]
fn the_same_seed_flies_the_same_flight() {
    let fly = || {
        let mut bench = Bench::ready(&DroneConfig::default());
        bench.fly(Ref::TakeOff, HOVER, 5.0);
        bench.fly(Ref::TakeOff, progressive(0.3, -0.2, 0.1, 0.2), 2.0);
        (bench.drone.truth(), bench.heard)
    };
    assert_eq!(fly(), fly());
}

/// Number of tags in the newest packet.
fn reported_tags(bench: &mut Bench) -> u32 {
    bench.now += DEMO_PERIOD;
    bench.drone.advance(bench.now);
    let packet = std::iter::from_fn(|| bench.drone.poll_navdata()).last().unwrap();
    ardrone_link::navdata::Packet::decode(&packet).unwrap().vision_detect().unwrap().count
}

#[test]
fn tags_are_told_only_of_a_drone_that_was_asked_to_look_for_them() {
    let camera = CameraModel::perfect();
    let config = DroneConfig { flies_at_m: Some(1.5), camera, ..DroneConfig::default() };
    for (settings, seen) in [
        (&[][..], 0),
        (&[("detect:detect_type", "12")], 1),
        (&[("detect:detect_type", "10")], 0),
        (&[("detect:detect_type", "10"), ("detect:detections_select_v_hsync", "128")], 1),
        (&[("detect:detect_type", "10"), ("detect:detections_select_v", "4")], 0),
    ] {
        let mut bench = Bench::ready(&config);
        bench.drone.lay_tag(FloorTag::new(0.0, 0.0, 0.0));
        for (key, value) in settings {
            bench.send(&[Command::Config(Config::new(*key, *value).unwrap())]);
        }
        bench.wait(Duration::from_millis(200));
        assert_eq!(reported_tags(&mut bench), seen, "{settings:?}");
        bench.drone.move_tag(0, None);
        bench.wait(Duration::from_millis(200));
        assert_eq!(reported_tags(&mut bench), 0, "it was removed");
    }
}
