//! The vehicle as its clients see it.

mod emergency;
mod qgroundcontrol;

use autopilot::plan::Command;
use autopilot::vehicle::{
    ManualControl, Phase, Place, Station as Kind, Telemetry, Vehicle, VehicleConfig,
};
use mavlink_core::Message as _;

use super::*;
use crate::dialect::{
    COMMAND_LONG_DATA, HEARTBEAT_DATA, MISSION_COUNT_DATA, MISSION_ITEM_DATA, MavModeFlag,
    MavResult, PositionTargetTypemask, SET_POSITION_TARGET_LOCAL_NED_DATA, SETUP_SIGNING_DATA,
};
use crate::signing::Key;

const SECOND: Duration = Duration::from_secs(1);

/// A `MAVLink` vehicle with a client, and a vehicle that accepts every order.
struct Bench {
    vehicle: MavlinkVehicle,
    now: Duration,
    client: Encoder,
    peer: u8,
    /// Whom its commands are for.
    target_system: u8,
    status: Status,
    /// What it sent and ordered, and who ordered it.
    sent: Vec<(To, MavMessage)>,
    orders: Vec<(Operator, OperatorOrder)>,
    /// The answer to every order.
    answer: Result<(), autopilot::vehicle::Refused>,
}

impl Bench {
    fn new(config: Config) -> Self {
        let status = Vehicle::new(&VehicleConfig::default()).unwrap().status(Duration::ZERO);
        let mut bench = Self {
            vehicle: MavlinkVehicle::new(config),
            now: SECOND,
            client: Encoder::new(255, 190),
            peer: 0,
            target_system: 1,
            status: Status { phase: Phase::Standby, battery_percent: Some(80), ..status },
            sent: Vec::new(),
            orders: Vec::new(),
            answer: Ok(()),
        };
        bench.vehicle.handle(bench.now, Input::Telemetry(&Telemetry::Readiness([].into())));
        bench.pass(Duration::from_millis(20));
        bench.sent.clear();
        bench
    }

    fn pass(&mut self, time: Duration) {
        let end = self.now + time;
        while self.now < end {
            self.now += Duration::from_millis(20);
            self.vehicle.handle(self.now, Input::Telemetry(&Telemetry::Status(self.status)));
            self.vehicle.tick(self.now);
            self.collect();
        }
    }

    fn collect(&mut self) {
        let system = self.vehicle.config.system;
        loop {
            let order = match self.vehicle.poll(self.now) {
                None => return,
                Some(Output::Datagram { to, bytes }) => {
                    let frame = frames(bytes).next().unwrap().unwrap();
                    assert_eq!(frame.system, system);
                    self.sent.push((to, frame.message));
                    continue;
                }
                Some(Output::Order { ticket, by, order }) => (ticket, by, order),
            };
            let (ticket, by, order) = order;
            match &order {
                OperatorOrder::Take => self.status.controls = Some(by),
                OperatorOrder::Release => self.status.controls = None,
                _ => {}
            }
            self.orders.push((by, order));
            let answer = self.answer.clone();
            self.vehicle.handle(self.now, Input::Answer { ticket, answer });
        }
    }

    fn say(&mut self, message: &MavMessage) {
        let mut buffer = [0; LONGEST_FRAME];
        let bytes = self.client.encode(message, None, self.now, &mut buffer);
        let peer = self.peer;
        self.vehicle.handle(self.now, Input::Datagram { peer, local: true, bytes });
        self.collect();
    }

    /// Gives a command and returns its result.
    fn command(&mut self, command: u16, p: [f32; 7]) -> Option<MavResult> {
        self.sent.clear();
        let [param1, param2, param3, param4, param5, param6, param7] = p;
        self.say(&MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
            param1,
            param2,
            param3,
            param4,
            param5,
            param6,
            param7,
            command,
            target_system: self.target_system,
            target_component: 1,
            confirmation: 0,
        }));
        self.sent.iter().find_map(|(_, message)| match message {
            MavMessage::COMMAND_ACK(data) if data.command == command => {
                assert_eq!((data.target_system, data.target_component), (255, 190));
                Some(data.result)
            }
            _ => None,
        })
    }

    fn accepts(&mut self, command: u16, p: [f32; 7]) {
        assert_eq!(self.command(command, p), Some(MavResult::MAV_RESULT_ACCEPTED), "{command}");
    }

    fn refuses(&mut self, command: u16, p: [f32; 7]) {
        let result = self.command(command, p);
        assert!(
            result.is_some_and(|result| result != MavResult::MAV_RESULT_ACCEPTED),
            "{result:?}"
        );
        assert!(self.ordered().is_empty(), "{command} {p:?}");
    }

    /// Names of the orders since the last call.
    fn ordered(&mut self) -> Vec<&'static str> {
        let names = self.orders.iter().map(|(_, order)| order.name());
        let names = names.filter(|name| *name != "present").collect();
        self.orders.clear();
        names
    }

    fn heartbeat(&mut self) -> HEARTBEAT_DATA {
        self.sent.clear();
        self.pass(SECOND);
        let heartbeat = self.sent.iter().rev().find_map(|(_, message)| match message {
            MavMessage::HEARTBEAT(data) => Some(data.clone()),
            _ => None,
        });
        heartbeat.unwrap()
    }

    fn mode(&mut self) -> Mode {
        Mode::from_custom(self.heartbeat().custom_mode).unwrap()
    }

    fn is_armed(&mut self) -> bool {
        self.heartbeat().base_mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED)
    }

    fn fly(&mut self) {
        self.status.phase = Phase::Flying;
        self.status.airborne = true;
        self.status.pose = Some(kinematics::Pose { z_m: 0.85, ..kinematics::Pose::default() });
        self.pass(SECOND);
        self.orders.clear();
    }

    fn said(&self, text: &str) -> bool {
        self.sent.iter().any(|(_, message)| match message {
            MavMessage::STATUSTEXT(data) => data.text.to_str().unwrap().contains(text),
            _ => false,
        })
    }
}

const NAN: f32 = f32::NAN;
const NOTHING: [f32; 7] = [NAN; 7];

fn first(p: f32) -> [f32; 7] {
    [p, NAN, NAN, NAN, NAN, NAN, NAN]
}

fn setpoint(x: f32) -> MavMessage {
    MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
        x,
        z: -1.0,
        type_mask: PositionTargetTypemask::from_bits_truncate(2552),
        target_system: 1,
        target_component: 1,
        coordinate_frame: 1,
        ..SET_POSITION_TARGET_LOCAL_NED_DATA::default()
    })
}

#[test]
fn a_vehicle_answers_to_its_own_number() {
    let mut bench = Bench::new(Config { system: 7, ..Config::default() });
    assert_eq!(bench.command(400, first(1.0)), None);
    assert_eq!(bench.ordered(), [""; 0]);
    bench.target_system = 7;
    bench.accepts(400, first(1.0));
    assert_eq!(bench.ordered(), ["take"]);
}

#[test]
fn armed_it_takes_off_and_unarmed_it_waits_to_be() {
    let mut bench = Bench::new(Config::default());
    bench.accepts(400, first(1.0));
    assert_eq!(bench.ordered(), ["take"]);
    assert!(bench.is_armed());
    bench.accepts(22, [NAN, NAN, NAN, NAN, NAN, NAN, 1.5]);
    let commands = bench.orders.iter().find_map(|(_, order)| match order {
        OperatorOrder::Append(commands) => Some(commands),
        _ => None,
    });
    let commands = commands.unwrap();
    assert!(commands.text().contains("takeoff") && commands.text().contains("goto 0 0 1.5 0"));
    assert_eq!(bench.ordered(), ["append", "start"]);
    let mut bench = Bench::new(Config::default());
    bench.accepts(22, NOTHING);
    assert!(bench.ordered().is_empty());
    bench.accepts(400, first(1.0));
    assert_eq!(bench.ordered(), ["take", "append", "start"]);
    // A take-off that waits is forgotten.
    let mut bench = Bench::new(Config::default());
    bench.accepts(22, NOTHING);
    bench.pass(SECOND * 5);
    bench.accepts(400, first(1.0));
    assert_eq!(bench.ordered(), ["take"]);
}

#[test]
fn arming_passes_and_needs_a_ready_drone() {
    let mut bench = Bench::new(Config::default());
    bench.accepts(400, first(1.0));
    bench.pass(SECOND * 8);
    assert!(bench.is_armed());
    bench.pass(SECOND);
    assert!(!bench.is_armed());
    assert_eq!(bench.ordered(), ["take", "release"]);
    for forced in [2989.0, 21196.0] {
        bench.refuses(400, [1.0, forced, NAN, NAN, NAN, NAN, NAN]);
    }
    for odd in [NAN, 0.5, 7.0, f32::INFINITY] {
        bench.refuses(400, first(odd));
    }
    bench
        .vehicle
        .handle(bench.now, Input::Telemetry(&Telemetry::Readiness([NotReady::NoDrone].into())));
    bench.refuses(400, first(1.0));
    bench.pass(SECOND);
    assert!(bench.said("PreArm: "));
}

#[test]
fn in_flight_only_the_code_cuts_the_motors() {
    let mut bench = Bench::new(Config::default());
    bench.accepts(400, first(1.0));
    bench.fly();
    bench.refuses(400, first(0.0));
    bench.refuses(400, [0.0, 21195.0, NAN, NAN, NAN, NAN, NAN]);
    for odd in [NAN, 0.0, 0.5, -1.0] {
        bench.refuses(185, first(odd));
    }
    bench.accepts(400, [0.0, 21196.0, NAN, NAN, NAN, NAN, NAN]);
    assert_eq!(bench.ordered(), ["cut"]);
    bench.accepts(185, first(1.0));
    assert_eq!(bench.ordered(), ["cut"]);
    // On the floor it only disarms.
    let mut bench = Bench::new(Config::default());
    bench.accepts(400, [0.0, 21196.0, NAN, NAN, NAN, NAN, NAN]);
    assert!(bench.ordered().is_empty());
}

#[test]
fn the_mode_is_what_the_vehicle_does() {
    let mut bench = Bench::new(Config::default());
    assert_eq!(bench.mode(), Mode::Hold);
    bench.fly();
    assert_eq!(bench.mode(), Mode::Hold);
    for (manual, mode) in [
        (ManualControl::Hold, Mode::Hold),
        (ManualControl::Target, Mode::Hold),
        (ManualControl::Sticks, Mode::Position),
        (ManualControl::Setpoints, Mode::Offboard),
    ] {
        bench.status.manual = Some(manual);
        assert_eq!(bench.mode(), mode);
    }
    bench.status.manual = None;
    bench.status.step = Some(1);
    assert_eq!(bench.mode(), Mode::Mission);
    bench.status.command = Some("Land");
    assert_eq!(bench.mode(), Mode::Land);
    bench.status.command = Some("TakeOff");
    assert_eq!(bench.mode(), Mode::TakeOff);
    bench.status.phase = Phase::Landing;
    assert_eq!(bench.mode(), Mode::Land);
    // A change is told at once.
    bench.sent.clear();
    bench.status.phase = Phase::Standby;
    bench.pass(Duration::from_millis(40));
    let heartbeats = |(_, message): &(To, MavMessage)| message.message_id() == 0;
    assert!(bench.sent.iter().any(heartbeats));
}

#[test]
fn modes_of_others_are_refused_and_ours_are_orders() {
    let mut bench = Bench::new(Config::default());
    bench.fly();
    let mode = |main: f32, sub: f32| [1.0, main, sub, NAN, NAN, NAN, NAN];
    for (main, sub) in [(4.0, 0.0), (5.0, 0.0), (9.0, 0.0), (6.0, 0.0), (NAN, NAN), (4.5, 3.0)] {
        bench.refuses(176, mode(main, sub));
    }
    bench.accepts(176, mode(4.0, 3.0));
    assert_eq!(bench.ordered(), ["hold"]);
    // As MAVProxy sends it.
    bench.accepts(176, mode(67_371_008.0 + 33_554_432.0, 0.0));
    assert_eq!(bench.ordered(), ["land"]);
    bench.accepts(262, first(7.0));
    assert_eq!(bench.ordered(), ["land"]);
    bench.accepts(20, NOTHING);
    assert_eq!(bench.ordered(), ["clear", "append", "start"]);
}

#[test]
fn set_points_are_followed_on_order_and_only_fresh_ones() {
    let mut bench = Bench::new(Config::default());
    bench.fly();
    let offboard = [1.0, 6.0, 0.0, NAN, NAN, NAN, NAN];
    bench.say(&setpoint(1.0));
    assert!(bench.ordered().is_empty());
    bench.pass(SECOND);
    bench.refuses(176, offboard);
    bench.say(&setpoint(1.0));
    bench.accepts(176, offboard);
    assert_eq!(bench.ordered(), ["follow"]);
    bench.status.manual = Some(ManualControl::Setpoints);
    bench.pass(Duration::from_millis(100));
    bench.say(&setpoint(2.0));
    assert_eq!(bench.ordered(), ["setpoint"]);
    // Of another station none is taken.
    bench.client = Encoder::new(254, 190);
    bench.say(&setpoint(3.0));
    assert!(bench.ordered().is_empty());
}

#[test]
fn a_way_to_nowhere_is_a_hold_and_one_over_the_fence_is_refused() {
    let mut bench = Bench::new(Config::default());
    bench.fly();
    bench.accepts(192, [-1.0, 1.0, NAN, NAN, NAN, NAN, NAN]);
    assert_eq!(bench.ordered(), ["hold"]);
    bench.accepts(192, [-1.0, 1.0, NAN, NAN, NAN, NAN, 489.5]);
    let (_, order) = bench.orders.pop().unwrap();
    assert_eq!(order, OperatorOrder::GoTo(Place { height_m: Some(1.5), ..Place::default() }));
    bench.refuses(192, [-1.0, 1.0, NAN, NAN, NAN, NAN, 499.5]);
    bench.refuses(192, [-1.0, 1.0, NAN, NAN, 47.5, 8.5, NAN]);
}

#[test]
fn everything_is_answered() {
    let mut bench = Bench::new(Config::default());
    bench.refuses(65_000, NOTHING);
    for command in [16, 179, 246, 300, 192, 193] {
        bench.refuses(command, NOTHING);
    }
    bench.accepts(512, first(148.0));
    assert!(bench.sent.iter().any(|(_, message)| message.message_id() == 148));
    bench.refuses(512, first(9999.0));
    bench.refuses(512, first(NAN));
    bench.accepts(511, [30.0, -1.0, NAN, NAN, NAN, NAN, NAN]);
    bench.sent.clear();
    bench.pass(SECOND);
    assert!(bench.sent.iter().all(|(_, message)| message.message_id() != 30));
    // Busy or not: an order that is not answered is rejected in time.
    bench.answer = Err(autopilot::vehicle::Refused::Busy);
    bench.fly();
    bench.refuses_order();
}

impl Bench {
    fn refuses_order(&mut self) {
        let result = self.command(21, NOTHING);
        assert_eq!(result, Some(MavResult::MAV_RESULT_TEMPORARILY_REJECTED));
    }
}

#[test]
fn the_vehicle_hears_of_a_station_that_is_there() {
    let mut bench = Bench::new(Config::default());
    bench.accepts(400, first(1.0));
    bench.fly();
    let present =
        |bench: &Bench| bench.orders.iter().filter(|(_, o)| o.name() == "present").count();
    bench.pass(SECOND * 3);
    assert_eq!(present(&bench), 0, "it said nothing");
    for _ in 0..10 {
        bench.say(&MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
        bench.pass(Duration::from_millis(300));
    }
    assert_eq!(present(&bench), 10);
    // A program elsewhere with the same numbers does not speak for it.
    bench.orders.clear();
    bench.peer = 1;
    bench.say(&MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
    bench.pass(SECOND);
    assert_eq!(present(&bench), 0);
    bench.peer = 0;
    // Another one's heartbeats do not count.
    bench.orders.clear();
    bench.client = Encoder::new(254, 190);
    bench.say(&MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
    bench.pass(SECOND);
    assert_eq!(present(&bench), 0);
}

#[test]
fn the_controls_of_a_silent_station_go_to_another() {
    let mut bench = Bench::new(Config::default());
    bench.accepts(400, first(1.0));
    bench.fly();
    let holder = bench.status.controls.unwrap();
    assert_eq!(
        (holder.station, holder.to_string().as_str()),
        (Kind::Mavlink, "the local mavlink 255.190")
    );
    bench.client = Encoder::new(254, 190);
    bench.pass(SECOND);
    bench.say(&MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
    bench.orders.clear();
    let reply = |bench: &mut Bench| {
        bench.say(&MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
            param1: 1.0,
            command: 193,
            target_system: 1,
            ..COMMAND_LONG_DATA::default()
        }));
        bench.ordered()
    };
    assert_eq!(reply(&mut bench), ["resume"], "the vehicle itself refuses it");
    bench.pass(SECOND * 5);
    bench.orders.clear();
    assert_eq!(reply(&mut bench), ["release", "resume"]);
}

#[test]
fn only_looking_orders_nothing() {
    let mut bench = Bench::new(Config { view_only: true, ..Config::default() });
    for command in [400, 22, 21, 20, 176, 192, 193, 300, 185] {
        bench.refuses(command, first(1.0));
    }
    bench.say(&setpoint(1.0));
    assert!(bench.ordered().is_empty());
    bench.accepts(512, first(148.0));
}

#[test]
fn with_a_key_only_what_is_signed_is_heard() {
    let key = Key::from_pass_phrase("secret").unwrap();
    let mut bench = Bench::new(Config { key: Some(key), ..Config::default() });
    assert_eq!(bench.command(512, first(148.0)), None);
    let setup = MavMessage::SETUP_SIGNING(SETUP_SIGNING_DATA::default());
    bench.say(&setup);
    assert_eq!(bench.command(512, first(148.0)), None);
}

#[test]
fn nothing_is_told_of_a_vehicle_without_news() {
    let mut bench = Bench::new(Config::default());
    bench.sent.clear();
    for _ in 0..100 {
        bench.now += Duration::from_millis(100);
        bench.vehicle.tick(bench.now);
        bench.collect();
    }
    let last = bench.sent.iter().filter(|(_, message)| message.message_id() == 0).count();
    assert!(last <= 3, "{last} heartbeats in 10 s without news");
}

#[test]
fn a_take_off_that_waits_is_given_up_by_what_is_ordered_after_it() {
    let hold = [1.0, 4.0, 3.0, NAN, NAN, NAN, NAN];
    for (command, p) in [(21, NOTHING), (176, hold), (193, first(0.0)), (185, first(1.0))] {
        let mut bench = Bench::new(Config::default());
        bench.accepts(22, NOTHING);
        bench.client = Encoder::new(255, 190);
        bench.accepts(command, p);
        bench.orders.clear();
        bench.accepts(400, first(1.0));
        assert_eq!(bench.ordered(), ["take"], "{command}");
    }
    let mut bench = Bench::new(Config::default());
    bench.accepts(22, NOTHING);
    let taken = FlightEvent::ControlsTaken { by: Operator::TERMINAL };
    bench.vehicle.handle(bench.now, Input::Telemetry(&Telemetry::Event(taken.clone())));
    bench.accepts(400, first(1.0));
    assert_eq!(bench.ordered(), ["take"]);
    bench.vehicle.handle(bench.now, Input::Telemetry(&Telemetry::Event(taken.clone())));
    assert!(!bench.is_armed());
    // A local operator who takes free controls and gives them back has stepped in, too.
    let mut bench = Bench::new(Config::default());
    bench.accepts(22, NOTHING);
    bench.status.controls = Some(Operator::TERMINAL);
    bench.pass(Duration::from_millis(40));
    bench.status.controls = None;
    bench.pass(Duration::from_millis(40));
    bench.accepts(400, first(1.0));
    assert_eq!(bench.ordered(), ["take"]);
}

#[test]
fn disarmed_at_once_it_has_given_the_controls_back() {
    let mut bench = Bench::new(Config::default());
    bench.accepts(400, first(1.0));
    bench.accepts(400, first(0.0));
    assert_eq!(bench.ordered(), ["take", "release"]);
}

#[test]
fn a_station_that_ordered_is_told_of_while_nobody_or_somebody_else_has_the_controls() {
    let mut bench = Bench::new(Config::default());
    bench.accepts(400, first(1.0));
    bench.fly();
    for controls in [None, Some(Operator::TERMINAL)] {
        bench.status.controls = controls;
        bench.pass(SECOND);
        bench.orders.clear();
        bench.say(&MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
        bench.pass(SECOND);
        let told = bench.orders.iter().filter(|(_, order)| order.name() == "present");
        assert_eq!(told.count(), 1, "{controls:?}");
    }
}

/// The vehicle would refuse it; what is known of the mission must not be lost before.
#[test]
fn an_order_of_another_station_changes_nothing_of_the_mission_that_flies() {
    let mut bench = Bench::new(Config::default());
    bench.accepts(400, first(1.0));
    bench.accepts(22, NOTHING);
    let steps = bench.vehicle.flown.steps().to_vec();
    bench.fly();
    bench.say(&MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
    bench.orders.clear();
    bench.client = Encoder::new(254, 190);
    bench.say(&MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
        command: 20,
        target_system: 1,
        ..COMMAND_LONG_DATA::default()
    }));
    assert!(bench.ordered().is_empty());
    assert_eq!(bench.vehicle.flown.steps(), steps);
}

impl Bench {
    /// Uploads a mission that takes off, flies to two places and lands.
    fn upload(&mut self) {
        let item = |seq, command, x: f32| MISSION_ITEM_DATA {
            seq,
            command,
            x,
            z: 1.0,
            autocontinue: 1,
            frame: 1,
            target_system: 1,
            ..MISSION_ITEM_DATA::default()
        };
        let items = [item(0, 24, 0.0), item(1, 16, 1.0), item(2, 16, 0.5), item(3, 23, 0.5)];
        let up = |item: MISSION_ITEM_DATA| MISSION_ITEM_DATA { z: -item.z, ..item };
        self.say(&MavMessage::MISSION_COUNT(MISSION_COUNT_DATA {
            count: 4,
            target_system: 1,
            ..MISSION_COUNT_DATA::default()
        }));
        for item in items.map(up) {
            self.say(&MavMessage::MISSION_ITEM(item));
        }
        assert_eq!(self.vehicle.transfer.items().len(), 4, "{:?}", self.sent);
    }
}

#[test]
fn a_mission_begins_where_whoever_has_the_controls_says() {
    let start = |item: f32| [item, 0.0, NAN, NAN, NAN, NAN, NAN];
    let mut bench = Bench::new(Config::default());
    bench.upload();
    bench.accepts(400, first(1.0));
    bench.orders.clear();
    bench.refuses(300, start(4.0));
    // Another station's start is refused, also before the vehicle's status says who has armed, and moves nothing.
    bench.client = Encoder::new(254, 190);
    bench.say(&MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
        param1: 2.0,
        command: 300,
        target_system: 1,
        ..COMMAND_LONG_DATA::default()
    }));
    assert_eq!((bench.ordered().len(), bench.vehicle.flown.first_item()), (0, 0));
    bench.client = Encoder::new(255, 190);
    bench.accepts(300, start(2.0));
    assert_eq!(bench.ordered(), ["append", "start"]);
    let steps = bench.vehicle.flown.steps();
    assert!(steps.iter().all(|step| step.item >= 2), "{steps:?}");
    assert_eq!(steps.last().map(|step| step.command), Some(Command::Land));
    assert_eq!(bench.vehicle.flown.first_item(), 0, "the next time it begins at its beginning");
}

#[test]
fn what_waits_for_arming_is_begun_only_by_its_own_station() {
    let mut bench = Bench::new(Config::default());
    bench.upload();
    bench.accepts(300, [2.0, 0.0, NAN, NAN, NAN, NAN, NAN]);
    bench.client = Encoder::new(254, 190);
    bench.say(&MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
        param1: 1.0,
        command: 400,
        target_system: 1,
        ..COMMAND_LONG_DATA::default()
    }));
    assert_eq!(bench.ordered(), ["take"]);
    assert!(bench.is_armed());
    assert_eq!(bench.vehicle.flown.first_item(), 2, "it was not begun");
}

#[test]
fn a_mission_is_known_by_its_number_until_it_is_another() {
    let reached = |bench: &mut Bench, step| {
        bench.sent.clear();
        let done = Telemetry::Event(FlightEvent::StepDone { step });
        bench.vehicle.handle(bench.now, Input::Telemetry(&done));
        bench.collect();
        bench.sent.iter().find_map(|(_, message)| match message {
            MavMessage::MISSION_ITEM_REACHED(data) => Some(data.seq),
            _ => None,
        })
    };
    let mut bench = Bench::new(Config::default());
    bench.upload();
    bench.accepts(400, first(1.0));
    bench.accepts(300, NOTHING);
    let id = bench.orders.iter().find_map(|(_, order)| match order {
        OperatorOrder::Append(commands) => commands.id(),
        _ => None,
    });
    let take_off = bench
        .vehicle
        .flown
        .steps()
        .iter()
        .position(|step| matches!(step.command, Command::TakeOff { .. }));
    let take_off = take_off.unwrap();
    // The way up is still to come.
    let up = take_off + 4;
    bench.fly();
    assert_eq!(reached(&mut bench, up), None, "the vehicle has not said that it has the mission");
    let mission =
        |id| Telemetry::Mission { name: String::new(), id, steps: Vec::new(), steps_done: Some(0) };
    bench.vehicle.handle(bench.now, Input::Telemetry(&mission(id)));
    assert_eq!([take_off, up].map(|step| reached(&mut bench, step)), [None, Some(0)]);
    bench.vehicle.handle(bench.now, Input::Telemetry(&mission(None)));
    let last = bench.vehicle.flown.steps().len() - 1;
    assert_eq!(reached(&mut bench, last), None, "it was extended, or is another");
    let mission =
        |id| Telemetry::Mission { name: String::new(), id, steps: Vec::new(), steps_done: Some(0) };
    bench.vehicle.handle(bench.now, Input::Telemetry(&mission(id)));
    assert_eq!(reached(&mut bench, last), Some(3));
}

#[test]
fn the_next_status_says_who_has_the_controls() {
    let mut bench = Bench::new(Config::default());
    bench.accepts(400, first(1.0));
    bench.ordered();
    bench.status.controls = Some(Operator::TERMINAL);
    bench.pass(Duration::from_millis(20));
    bench.refuses(22, NOTHING);
}
