//! What `QGroundControl` 4.4.2 does, in its own order, and what its person sees.

use autopilot::vehicle::LandingReason;

use super::*;
use crate::dialect::{ALTITUDE_DATA, MavSysStatusSensor, PARAM_SET_DATA, SET_MODE_DATA};
use mavlink_core::types::CharArray;

fn px4() -> Bench {
    Bench::new(Config { autopilot: Autopilot::Px4, ..Config::default() })
}

impl Bench {
    /// As its firmware plug-in does: a message, not a command.
    fn set_mode(&mut self, mode: Mode) {
        self.sent.clear();
        self.say(&MavMessage::SET_MODE(SET_MODE_DATA {
            custom_mode: mode.custom(),
            target_system: 1,
            base_mode: MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED,
        }));
    }

    /// Texts put together, with the number of their severity.
    fn texts(&self) -> Vec<(u8, String)> {
        let mut texts: Vec<(u8, String)> = Vec::new();
        for (_, message) in &self.sent {
            let MavMessage::STATUSTEXT(data) = message else { continue };
            let chunk = data.text.to_str().unwrap();
            match texts.last_mut() {
                Some((_, text)) if data.chunk_seq > 0 => text.push_str(chunk),
                _ => texts.push((data.severity as u8, chunk.to_owned())),
            }
        }
        texts
    }

    #[track_caller]
    fn assert_said(&self, severity: MavSeverity, text: &str) {
        let texts = self.texts();
        let found =
            texts.iter().any(|(number, said)| *number == severity as u8 && said.contains(text));
        assert!(found, "{text}: {texts:?}");
    }

    /// What was handed over by the last orders.
    fn handed_over(&mut self) -> String {
        let text = self.orders.iter().rev().find_map(|(_, order)| match order {
            OperatorOrder::Append(commands) => Some(commands.text().to_owned()),
            _ => None,
        });
        self.orders.clear();
        text.unwrap()
    }

    fn tell(&mut self, event: FlightEvent) {
        self.sent.clear();
        self.vehicle.handle(self.now, Input::Telemetry(&Telemetry::Event(event)));
        self.collect();
    }
}

const ERROR: MavSeverity = MavSeverity::MAV_SEVERITY_ERROR;

#[test]
fn a_mission_is_started_from_the_ground_by_mode_and_arming() {
    let mut bench = px4();
    bench.upload();
    bench.set_mode(Mode::Mission);
    bench.pass(Duration::from_millis(40));
    let told = bench.sent.iter().find_map(|(_, message)| match message {
        MavMessage::HEARTBEAT(data) => Some(data.custom_mode),
        _ => None,
    });
    assert_eq!(told, Some(Mode::Mission.custom()), "before it is armed, and at once");
    bench.accepts(400, first(1.0));
    assert_eq!(bench.ordered(), ["take", "append", "start"]);
    assert_eq!(bench.mode(), Mode::Mission, "before the vehicle flies");
    let id = Some(autopilot::plan::MissionId(0));
    let mission =
        Telemetry::Mission { name: String::new(), id, steps: Vec::new(), steps_done: Some(0) };
    bench.vehicle.handle(bench.now, Input::Telemetry(&mission));
    bench.status.step = Some(0);
    bench.status.command = Some("TakeOff");
    bench.fly();
    assert_eq!(bench.mode(), Mode::Mission, "during its take-off");
}

#[test]
fn the_mode_of_what_waits_ends_with_it() {
    let mut bench = px4();
    bench.upload();
    bench.set_mode(Mode::Mission);
    assert_eq!(bench.mode(), Mode::Mission);
    bench.pass(SECOND * 4);
    assert_eq!(bench.mode(), Mode::Hold);
    bench.set_mode(Mode::Mission);
    bench.set_mode(Mode::Hold);
    assert_eq!(bench.mode(), Mode::Hold);
    // Refused by the vehicle after it was armed.
    bench.accepts(400, first(1.0));
    bench.answer = Err(autopilot::vehicle::Refused::Busy);
    bench.set_mode(Mode::Mission);
    bench.assert_said(ERROR, "refused: ");
    assert_eq!(bench.mode(), Mode::Hold);
}

#[test]
fn a_take_off_to_10_m_is_one_to_the_vehicles_own_height() {
    for (height_m, flown, said) in [
        (10.0, "takeoff\n", "take-off to the hover, not 10.00 m, which is not between 0.3 and 3 m"),
        (3.048, "takeoff\n", "take-off to the hover, not 3.05 m"),
        (3.0, "takeoff\nsetStayTime 0.3\ngoto 0 0 3 0\n", "take-off to 3.00 m"),
        (1.5, "takeoff\nsetStayTime 0.3\ngoto 0 0 1.5 0\n", "take-off to 1.50 m"),
    ] {
        let mut bench = px4();
        bench.accepts(22, [-1.0, NAN, NAN, NAN, NAN, NAN, 488.0 + height_m]);
        let texts = bench.texts();
        assert!(texts.iter().any(|(_, text)| text.starts_with(said)), "{texts:?}");
        bench.accepts(400, first(1.0));
        assert!(bench.handed_over().ends_with(flown), "{height_m}");
    }
    // The height of the vehicle's own take-off may have been set.
    let mut bench = px4();
    bench.say(&MavMessage::PARAM_SET(PARAM_SET_DATA {
        param_value: 1.2,
        target_system: 1,
        target_component: 1,
        param_id: CharArray::from(parameters::TAKE_OFF_HEIGHT),
        param_type: 9,
    }));
    bench.accepts(22, [-1.0, NAN, NAN, NAN, NAN, NAN, 498.0]);
    bench.assert_said(MavSeverity::MAV_SEVERITY_WARNING, "take-off to 1.20 m, not 10.00 m");
    bench.accepts(400, first(1.0));
    assert!(bench.handed_over().contains("goto 0 0 1.2 0"));
}

#[test]
fn a_go_to_at_the_momentary_height_stays_below_the_ceiling() {
    let mut bench = px4();
    bench.fly();
    for above_m in [0.0, 0.002, 0.05, 0.15] {
        bench.status.pose = Some(kinematics::Pose { z_m: 3.0 + above_m, ..Default::default() });
        bench.pass(Duration::from_millis(200));
        bench.orders.clear();
        let told = bench.sent.iter().rev().find_map(|(_, message)| match message {
            MavMessage::ALTITUDE(ALTITUDE_DATA { altitude_amsl, .. }) => Some(*altitude_amsl),
            _ => None,
        });
        bench.accepts(192, [-1.0, 1.0, NAN, NAN, NAN, NAN, told.unwrap()]);
        let (_, order) = bench.orders.pop().unwrap();
        assert_eq!(order, OperatorOrder::GoTo(Place { height_m: Some(3.0), ..Place::default() }));
    }
    // It holds where it is: no alarm; elsewhere it is one.
    let outside = FlightEvent::Veto(Veto::TargetOutside);
    bench.tell(outside.clone());
    assert_eq!(bench.texts(), []);
    bench.status.pose = Some(kinematics::Pose { z_m: 1.0, ..Default::default() });
    bench.pass(Duration::from_millis(20));
    bench.tell(outside);
    bench.assert_said(MavSeverity::MAV_SEVERITY_WARNING, "target outside the fence");
    bench.pass(Duration::from_millis(200));
    bench.orders.clear();
    bench.refuses(192, [-1.0, 1.0, NAN, NAN, NAN, NAN, 491.1]);
    bench.assert_said(ERROR, "go-to refused: 3.10 m above the start, not between 0.3 and 3 m");
}

#[test]
fn reasons_are_errors_and_those_before_arming_begin_with_prearm() {
    let mut bench = px4();
    bench.set_mode(Mode::Mission);
    bench.assert_said(ERROR, "there is no mission: upload it");
    bench.set_mode(Mode::Return);
    bench.assert_said(ERROR, "mode Return: take off first");
    bench.refuses(176, [1.0, 2.0, 0.0, NAN, NAN, NAN, NAN]);
    bench.assert_said(ERROR, "mode Altitude is not flown here: use Hold, Takeoff, Mission");
    bench.refuses(400, [1.0, 2989.0, NAN, NAN, NAN, NAN, NAN]);
    bench.assert_said(ERROR, "forced arming is refused");
    let reasons = Telemetry::Readiness([NotReady::NoDrone].into());
    bench.sent.clear();
    bench.vehicle.handle(bench.now, Input::Telemetry(&reasons));
    // Without anybody trying; not what passes, and not all the time.
    let prearm = |bench: &Bench| {
        bench.texts().iter().filter(|(_, text)| text.starts_with("PreArm: ")).count()
    };
    bench.pass(SECOND);
    assert_eq!(prearm(&bench), 0);
    bench.pass(SECOND * 25);
    assert_eq!(prearm(&bench), 1);
    bench.vehicle.handle(bench.now, Input::Telemetry(&reasons));
    bench.pass(SECOND * 10);
    assert_eq!(prearm(&bench), 2);
    bench.refuses(400, first(1.0));
    bench.assert_said(ERROR, "PreArm: ");
    bench.vehicle.handle(bench.now, Input::Telemetry(&Telemetry::Readiness([].into())));
    bench.sent.clear();
    bench.pass(SECOND * 60);
    assert_eq!(prearm(&bench), 0);
}

#[test]
fn a_failsafe_is_critical_and_ones_own_landing_is_no_alarm() {
    let mut bench = px4();
    bench.fly();
    bench.tell(FlightEvent::LandingOrdered(LandingReason::StationGone));
    bench.assert_said(MavSeverity::MAV_SEVERITY_CRITICAL, "landing: the ground station");
    bench.tell(FlightEvent::LandingOrdered(LandingReason::Operator));
    bench.assert_said(MavSeverity::MAV_SEVERITY_INFO, "landing: the operator's order");
    bench.tell(FlightEvent::BatteryLow { percent: 19 });
    bench.assert_said(ERROR, "battery at 19 %");
    bench.tell(FlightEvent::LinkLost);
    bench.assert_said(MavSeverity::MAV_SEVERITY_CRITICAL, "ordering the landing blindly");
    bench.status.phase = Phase::Standby;
    bench.status.airborne = false;
    bench.pass(SECOND);
    bench.tell(FlightEvent::LinkLost);
    let texts = bench.texts();
    assert!(texts.iter().all(|(_, text)| !text.contains("landing")), "{texts:?}");
}

#[test]
fn a_parameter_that_is_not_set_says_so() {
    let mut bench = px4();
    let mut set = |name: &str, param_value| {
        bench.sent.clear();
        bench.say(&MavMessage::PARAM_SET(PARAM_SET_DATA {
            param_value,
            target_system: 1,
            target_component: 1,
            param_id: CharArray::from(name),
            param_type: 9,
        }));
        bench.texts()
    };
    let read_only = "GF_MAX_HOR_DIST not changed: it is read-only here, see pilot.toml";
    assert_eq!(set("GF_MAX_HOR_DIST", 5.0), [(ERROR as u8, read_only.to_owned())]);
    let outside = "MIS_TAKEOFF_ALT not changed: 99 is outside its range";
    assert_eq!(set("MIS_TAKEOFF_ALT", 99.0), [(ERROR as u8, outside.to_owned())]);
    assert_eq!(set("MIS_TAKEOFF_ALT", 1.0), []);
}

#[test]
fn the_landing_of_a_return_is_part_of_it() {
    let mut bench = px4();
    bench.fly();
    bench.accepts(20, NOTHING);
    let id = Some(autopilot::plan::MissionId(0));
    let mission =
        Telemetry::Mission { name: String::new(), id, steps: Vec::new(), steps_done: Some(0) };
    bench.vehicle.handle(bench.now, Input::Telemetry(&mission));
    bench.status.step = Some(3);
    for command in ["GoTo", "Land"] {
        bench.status.command = Some(command);
        assert_eq!(bench.mode(), Mode::Return, "{command}");
    }
}

#[test]
fn volts_and_the_turn_rate_are_told() {
    let mut bench = px4();
    bench.fly();
    bench.status.attitude_deg = Some([0.0, 0.0]);
    bench.status.turn_rate_deg_s = Some(40.0);
    bench.status.battery_v = Some(11.686);
    bench.sent.clear();
    bench.pass(SECOND);
    bench.accepts_request(31);
    let mut told = [false; 4];
    for (_, message) in &bench.sent {
        match message {
            MavMessage::ATTITUDE(data) => {
                assert!((data.yawspeed - 0.698_132).abs() < 1e-5);
                told[0] = true;
            }
            MavMessage::ATTITUDE_QUATERNION(data) => {
                assert!((data.yawspeed - 0.698_132).abs() < 1e-5);
                told[1] = true;
            }
            MavMessage::SYS_STATUS(data) => {
                assert_eq!(data.voltage_battery, 11_686);
                told[2] = true;
            }
            MavMessage::BATTERY_STATUS(data) => {
                assert_eq!((data.voltages[0], data.voltages[1]), (11_686, u16::MAX));
                told[3] = true;
            }
            _ => {}
        }
    }
    assert_eq!(told, [true; 4]);
}

impl Bench {
    /// Asks for a message, and keeps what was sent before.
    fn accepts_request(&mut self, id: u16) {
        let before = std::mem::take(&mut self.sent);
        self.accepts(512, first(id.into()));
        self.sent.extend(before);
    }
}

#[test]
fn a_drone_that_falls_is_not_ready() {
    let mut bench = px4();
    bench.fly();
    bench.status.phase = Phase::Standby;
    bench.sent.clear();
    bench.pass(SECOND * 2);
    let ready = bench.sent.iter().any(|(_, message)| match message {
        MavMessage::SYS_STATUS(data) => data
            .onboard_control_sensors_health
            .contains(MavSysStatusSensor::MAV_SYS_STATUS_PREARM_CHECK),
        _ => false,
    });
    assert!(!ready);
}

#[test]
fn heights_come_five_times_a_second() {
    let mut bench = px4();
    bench.fly();
    bench.sent.clear();
    bench.pass(SECOND * 2);
    let heights =
        bench.sent.iter().filter(|(_, message)| matches!(message, MavMessage::ALTITUDE(_)));
    assert!(heights.count() >= 10);
}
