//! A vehicle that stays: many flights, changing missions, orders in flight, and faults in between.

use std::time::Duration;

use ardrone_link::at::{Command, Datagram, Fraction, Motion, Ref};
use ardrone_pilot::drive::{Driver, Passed, Simulated};
use autopilot::outcome::Outcome;
use autopilot::plan::{Border, Commands, FlightLimits};
use autopilot::vehicle::{
    FlightEvent, LandingReason, NotReady, Operator, OperatorOrder, Phase, Refused, Station, TICK,
    Telemetry, Transmit,
};
use autopilot::{Vehicle, VehicleConfig};
use mock_drone::scenario::Scenario;
use mock_drone::{DroneConfig, Tag27, Truth, WorldConfig, firmware};
use system_tests::sim::{Moment, Simulation};
use system_tests::{SQUARE, plan};

const SECOND: Duration = Duration::from_secs(1);
const START: OperatorOrder = OperatorOrder::Start { when_ready: false };
const REMOTE: Operator = Operator { station: Station::Mavlink, number: 1, local: false };

/// A vehicle without a mission, with its collected outputs.
struct Bench {
    driver: Driver<Simulated>,
    events: Vec<(Duration, FlightEvent)>,
    outcomes: Vec<Outcome>,
    ready: Option<Vec<NotReady>>,
    missions: usize,
    /// The drone was sent something in the last step.
    is_told: bool,
}

impl Bench {
    fn new(scenario: &str) -> Self {
        let scenario = Scenario::parse("scenario", scenario).unwrap();
        Self::in_world(&WorldConfig { scenario, ..WorldConfig::default() })
    }

    fn in_world(world: &WorldConfig) -> Self {
        Self::with(&VehicleConfig::default(), world)
    }

    fn with(config: &VehicleConfig, world: &WorldConfig) -> Self {
        let driver = Driver::new(Vehicle::new(config).unwrap(), world);
        let (events, outcomes) = (Vec::new(), Vec::new());
        Self { driver, events, outcomes, ready: None, missions: 0, is_told: false }
    }

    /// A vehicle in standby.
    fn standing_by(scenario: &str) -> Self {
        let mut bench = Self::new(scenario);
        bench.until(10 * SECOND, |bench| bench.ready.as_ref().is_some_and(Vec::is_empty));
        assert_eq!(bench.phase(), Phase::Standby);
        bench
    }

    fn order(&mut self, order: OperatorOrder) -> Result<(), Refused> {
        self.driver.order(Operator::TERMINAL, order)
    }

    fn accepted(&mut self, order: OperatorOrder) {
        let name = order.name();
        let answer = self.order(order);
        assert_eq!(answer, Ok(()), "{name} at {:?}", self.driver.now());
    }

    fn append(&mut self, command: &str) -> Result<(), Refused> {
        self.order(OperatorOrder::Append(Commands::parse("command", command).unwrap()))
    }

    fn phase(&self) -> Phase {
        self.driver.vehicle.status(self.driver.now()).phase
    }

    fn truth(&self) -> Truth {
        self.driver.world().truth()
    }

    fn step(&mut self) {
        let now = self.driver.now();
        let Self { driver, events, outcomes, ready, missions, is_told } = self;
        *is_told = false;
        driver.step(|_, passed| match passed {
            Passed::Told(Telemetry::Event(event)) => events.push((now, event)),
            Passed::Told(Telemetry::Ended(outcome, _)) => outcomes.push(outcome),
            Passed::Told(Telemetry::Readiness(reasons)) => *ready = Some(reasons.to_vec()),
            Passed::Told(Telemetry::Mission { .. }) => *missions += 1,
            Passed::Sent { transmit: Transmit::Command { .. }, .. } => *is_told = true,
            _ => {}
        });
        driver.pass();
    }

    fn run(&mut self, time: Duration) {
        self.run_to(self.driver.now() + time);
    }

    fn run_to(&mut self, end: Duration) {
        while self.driver.now() < end {
            self.step();
        }
    }

    /// Runs until the condition is true, which must happen within `time`.
    #[track_caller]
    fn until(&mut self, time: Duration, mut is_so: impl FnMut(&Self) -> bool) {
        let end = self.driver.now() + time;
        while !is_so(self) {
            assert!(self.driver.now() < end, "{:?} {:?}", self.phase(), self.events);
            self.step();
        }
    }

    /// Runs until the flight has ended and the vehicle is in standby.
    #[track_caller]
    fn until_it_stands_by(&mut self) -> Outcome {
        let flights = self.outcomes.len();
        self.until(120 * SECOND, |bench| {
            bench.outcomes.len() > flights && bench.phase() == Phase::Standby
        });
        assert_eq!(self.truth().phase, firmware::Phase::Landed);
        self.outcomes.last().unwrap().clone()
    }

    fn count(&self, event: &FlightEvent) -> usize {
        self.events.iter().filter(|(_, other)| other == event).count()
    }
}

fn is_flying(bench: &Bench) -> bool {
    bench.truth().phase == firmware::Phase::Flying
}

/// The position by the flight recorder is shown if it is asked for, and moves with the drone.
#[test]
fn the_flight_recorder_tells_where_the_drone_is() {
    for asked in [true, false] {
        let drone = DroneConfig { tag_27: Tag27::Gps, ..DroneConfig::default() };
        let world = WorldConfig { drone, ..WorldConfig::default() };
        let pilot = VehicleConfig { gps: asked, ..VehicleConfig::default() };
        let simulation = Simulation { world, pilot, ..Simulation::default() };
        let mut northernmost_deg = f64::NAN;
        let watch = |moment: &Moment| {
            if let Some(gps) = moment.status.gps {
                northernmost_deg = gps.latitude_deg.max(northernmost_deg);
            }
        };
        let flown = plan("takeoff\ngoto 0 2 0 0\nland\n");
        assert_eq!(simulation.fly_watched(flown, watch).unwrap().outcome, Outcome::Completed);
        let forward_m = (northernmost_deg - 48.879_12) * 111_320.0;
        assert_eq!((1.8..2.3).contains(&forward_m), asked, "{forward_m}");
    }
}

#[test]
fn a_vehicle_without_orders_stays_on_the_ground() {
    let mut bench = Bench::standing_by("");
    bench.run(60 * SECOND);
    assert_eq!((bench.phase(), bench.truth().phase), (Phase::Standby, firmware::Phase::Landed));
    assert_eq!(bench.order(START), Err(Refused::NoMission));
    assert_eq!(bench.append("setStayTime 1"), Ok(()));
    assert_eq!(bench.order(START), Err(Refused::NeverTakesOff));
    assert!(bench.outcomes.is_empty());
}

#[test]
fn ten_flights_in_half_an_hour_with_all_that_happens_between_them() {
    let mut bench = Bench::standing_by("1300 restart");
    // 1 to 4: the same mission again and again.
    bench.accepted(OperatorOrder::Load(plan(SQUARE)));
    for _ in 0..4 {
        bench.accepted(START);
        assert_eq!(bench.order(START), Err(Refused::Flying));
        assert_eq!(bench.until_it_stands_by(), Outcome::Completed);
        assert_eq!(bench.driver.vehicle.report().waypoints.len(), 4);
        bench.run(20 * SECOND);
    }
    // 5: single orders. The drone holds after the last of them.
    bench.accepted(OperatorOrder::Clear);
    bench.append("takeoff").unwrap();
    bench.append("setStayTime 0.5").unwrap();
    bench.accepted(START);
    bench.run(30 * SECOND);
    assert!(is_flying(&bench));
    for command in ["goto 0 1 0 0", "moveBy 0 0 0.4 0", "goto 0 0 0 0"] {
        bench.append(command).unwrap();
        bench.run(10 * SECOND);
    }
    assert!(bench.append("goto 0 100 0 0").is_err());
    let place = bench.truth().odometry_m;
    assert!(place.norm() < 0.2 && is_flying(&bench), "{place}");
    bench.append("land").unwrap();
    assert_eq!(bench.until_it_stands_by(), Outcome::Completed);
    assert_eq!(bench.driver.vehicle.report().waypoints.len(), 3);
    // 6: the mission is replaced in the air, twice.
    bench.accepted(OperatorOrder::Load(plan(SQUARE)));
    bench.accepted(START);
    bench.run(12 * SECOND);
    for target in ["goto -1 0 0 0", "goto 0 -1 0.3 90"] {
        bench.accepted(OperatorOrder::Load(plan(&format!("takeoff\n{target}\nland\n"))));
        bench.run(3 * SECOND);
        assert!(is_flying(&bench));
    }
    assert_eq!(bench.until_it_stands_by(), Outcome::Completed);
    let last = *bench.driver.vehicle.report().waypoints.last().unwrap();
    assert!((last.target.y_m + 1.0).abs() < 0.2 && last.error_m() < 0.2, "{last:?}");
    // 7: held, resumed, and landed by order.
    bench.accepted(OperatorOrder::Load(plan(SQUARE)));
    bench.accepted(START);
    bench.run(8 * SECOND);
    bench.accepted(OperatorOrder::Hold);
    bench.run(20 * SECOND);
    assert!(is_flying(&bench));
    bench.accepted(OperatorOrder::Resume);
    bench.run(3 * SECOND);
    bench.accepted(OperatorOrder::Land);
    assert_eq!(bench.order(OperatorOrder::Hold), Err(Refused::Landing));
    // A mission loaded during the landing is for the next flight.
    bench.accepted(OperatorOrder::Load(plan("takeoff\ngoto 0 0.5 0 0\nland\n")));
    assert_eq!(bench.until_it_stands_by(), Outcome::Interrupted);
    bench.run(10 * SECOND);
    assert_eq!(bench.phase(), Phase::Standby);
    // 8: the motors are cut in the air. Nothing flies until the operator has cleared the emergency.
    bench.accepted(START);
    bench.until(20 * SECOND, is_flying);
    bench.run(SECOND);
    bench.accepted(OperatorOrder::Cut);
    bench.run(5 * SECOND);
    assert_eq!(bench.outcomes.last(), Some(&Outcome::Emergency));
    assert!(matches!(bench.order(START), Err(Refused::NotReady(_))));
    assert_eq!(bench.ready, Some(vec![NotReady::Emergency]));
    bench.accepted(OperatorOrder::Recover);
    bench.run(3 * SECOND);
    assert_eq!(bench.order(OperatorOrder::Recover), Err(Refused::NoEmergency));
    // 9: and again.
    bench.accepted(START);
    assert_eq!(bench.until_it_stands_by(), Outcome::Completed);
    // The drone is switched off and on in standby: it is found again.
    assert!(bench.driver.now() < 1290 * SECOND, "{:?}", bench.driver.now());
    bench.run_to(1320 * SECOND);
    assert_eq!((bench.phase(), bench.ready.as_deref()), (Phase::Standby, Some(&[][..])));
    assert!(bench.count(&FlightEvent::Configured) == 2, "{:?}", bench.events);
    // 10.
    bench.accepted(OperatorOrder::Load(plan(SQUARE)));
    bench.accepted(START);
    assert_eq!(bench.until_it_stands_by(), Outcome::Completed);
    bench.run_to(1800 * SECOND);
    assert_eq!((bench.phase(), bench.outcomes.len()), (Phase::Standby, 10));
    let take_offs = bench.events.iter().filter(|(_, event)| *event == FlightEvent::Landed).count();
    assert_eq!(take_offs, 9, "but for the one that fell");
}

#[test]
fn the_second_flight_begins_where_the_drone_stands() {
    let mut bench = Bench::standing_by("");
    bench.accepted(OperatorOrder::Load(plan("takeoff\ngoto 3 0 0 0\nland\n")));
    for flight in 1..=3_u32 {
        bench.accepted(START);
        assert_eq!(bench.until_it_stands_by(), Outcome::Completed);
        let right_m = bench.truth().position_m.x;
        assert!((right_m - 3.0 * f64::from(flight)).abs() < 0.5 * f64::from(flight), "{right_m}");
    }
}

#[test]
fn a_mission_that_is_replaced_while_it_lands_lifts_nothing() {
    let mut bench = Bench::standing_by("");
    bench.accepted(OperatorOrder::Load(plan("takeoff\nland\n")));
    bench.accepted(START);
    bench.until(20 * SECOND, |bench| bench.truth().phase == firmware::Phase::Landing);
    bench.accepted(OperatorOrder::Load(plan(SQUARE)));
    assert_eq!(bench.append("goto 0 1 0 0"), Err(Refused::Landing));
    assert_eq!(bench.until_it_stands_by(), Outcome::Completed);
    bench.run(20 * SECOND);
    assert_eq!(bench.truth().phase, firmware::Phase::Landed);
    bench.accepted(START);
    bench.until(20 * SECOND, is_flying);
}

#[test]
fn what_is_cleared_is_given_up_where_the_drone_is() {
    let mut bench = Bench::standing_by("");
    bench.accepted(OperatorOrder::Load(plan("takeoff\ngoto 0 5 0 0\nland\n")));
    bench.accepted(START);
    bench.until(20 * SECOND, |bench| bench.truth().odometry_m.y > 1.0);
    bench.accepted(OperatorOrder::Clear);
    bench.run(30 * SECOND);
    let away_m = bench.truth().odometry_m.y;
    assert!(is_flying(&bench) && (0.9..2.5).contains(&away_m), "{away_m} {:?}", bench.events);
    bench.accepted(OperatorOrder::Land);
    bench.until_it_stands_by();
    // Before the take-off this ends the flight.
    bench.accepted(OperatorOrder::Load(plan(SQUARE)));
    bench.accepted(START);
    bench.accepted(OperatorOrder::Clear);
    bench.run(20 * SECOND);
    assert_eq!((bench.phase(), bench.outcomes.len()), (Phase::Standby, 2));
}

#[test]
fn a_drone_that_disappears_is_found_again() {
    let mut bench = Bench::standing_by("20 outage 8");
    bench.run_to(24 * SECOND);
    assert_eq!(
        (bench.phase(), bench.ready.clone()),
        (Phase::Connecting, Some(vec![NotReady::NoDrone]))
    );
    bench.accepted(OperatorOrder::Load(plan(SQUARE)));
    assert!(matches!(bench.order(START), Err(Refused::NotReady(_))));
    bench.until(20 * SECOND, |bench| bench.phase() == Phase::Standby);
    bench.run(SECOND);
    bench.accepted(START);
    assert_eq!(bench.until_it_stands_by(), Outcome::Completed);
}

#[test]
fn a_drone_that_is_lost_in_the_air_is_landed_when_it_is_heard_again() {
    let mut bench = Bench::standing_by("+5 outage 12");
    bench.accepted(OperatorOrder::Load(plan("takeoff\nsetStayTime 60\ngoto 0 1 0 0\nland\n")));
    bench.accepted(START);
    bench.until(40 * SECOND, |bench| !bench.outcomes.is_empty());
    assert_eq!(bench.outcomes, [Outcome::LinkLost]);
    bench.until(30 * SECOND, |bench| bench.phase() == Phase::Standby);
    assert_eq!(bench.truth().phase, firmware::Phase::Landed);
    bench.run(5 * SECOND);
    bench.accepted(OperatorOrder::Load(plan(SQUARE)));
    bench.accepted(START);
    assert_eq!(bench.until_it_stands_by(), Outcome::Completed);
}

#[test]
fn a_drone_that_somebody_else_flies_is_left_alone_until_it_stands() {
    // The other pilot's numbers are far above ours: the drone obeys only that one.
    let mut bench = Bench::standing_by("10 second-pilot 10 from 100000");
    bench.until(15 * SECOND, is_flying);
    bench.run(SECOND);
    assert_eq!(bench.phase(), Phase::Observing);
    assert_eq!(bench.count(&FlightEvent::FlownByAnother), 1);
    bench.accepted(OperatorOrder::Load(plan(SQUARE)));
    assert!(matches!(bench.order(START), Err(Refused::NotReady(_))));
    let end = bench.driver.now() + 3 * TICK;
    while bench.driver.now() < end {
        bench.step();
        assert!(!bench.is_told, "nothing is said to it");
    }
    // It is lost by its pilot, and lands by itself.
    bench.until(60 * SECOND, |bench| bench.phase() == Phase::Standby);
    bench.run(SECOND);
    bench.accepted(START);
    assert_eq!(bench.until_it_stands_by(), Outcome::Completed);
}

#[test]
fn one_operator_at_a_time_has_the_controls() {
    let mut bench = Bench::standing_by("");
    let load = || OperatorOrder::Load(plan(SQUARE));
    assert_eq!(bench.driver.order(REMOTE, load()), Ok(()));
    assert_eq!(bench.driver.order(REMOTE, START), Ok(()));
    bench.run(10 * SECOND);
    bench.accepted(OperatorOrder::Hold);
    // The hold came from a local operator: a remote one cannot end it.
    let held = Err(Refused::ControlsHeld(Operator::TERMINAL));
    assert_eq!(bench.driver.order(REMOTE, OperatorOrder::Resume), held);
    assert_eq!(bench.driver.order(REMOTE, load()), held);
    assert_eq!(bench.count(&FlightEvent::ControlsTaken { by: Operator::TERMINAL }), 0);
    bench.run(SECOND);
    assert_eq!(bench.count(&FlightEvent::ControlsTaken { by: Operator::TERMINAL }), 1);
    bench.accepted(OperatorOrder::Resume);
    bench.run(SECOND);
    // Anyone may land.
    assert_eq!(bench.driver.order(REMOTE, OperatorOrder::Land), Ok(()));
    assert_eq!(bench.until_it_stands_by(), Outcome::Interrupted);
    assert_eq!(bench.count(&FlightEvent::LandingOrdered(LandingReason::Operator)), 1);
    assert_eq!(bench.driver.order(REMOTE, START), held);
    bench.accepted(OperatorOrder::Release);
    assert_eq!(bench.driver.order(REMOTE, START), Ok(()));
}

#[test]
fn what_is_ordered_before_the_drone_has_lifted_keeps_it_down() {
    for (ticks, order) in (0..40_u32).flat_map(|ticks| {
        [(ticks, OperatorOrder::Hold), (ticks, OperatorOrder::Clear), (ticks, OperatorOrder::Cut)]
    }) {
        let mut bench = Bench::standing_by("");
        bench.accepted(OperatorOrder::Load(plan(SQUARE)));
        bench.accepted(START);
        bench.run(Duration::from_millis(30) * ticks);
        if bench.truth().phase != firmware::Phase::Landed {
            break;
        }
        let is_cut = order == OperatorOrder::Cut;
        bench.accepted(order);
        bench.run(Duration::from_millis(700));
        if is_cut {
            bench.accepted(OperatorOrder::Recover);
        }
        bench.run(20 * SECOND);
        let (phase, truth) = (bench.phase(), bench.truth().phase);
        assert_eq!((phase, truth), (Phase::Standby, firmware::Phase::Landed), "{ticks}");
        assert!(
            !bench.events.iter().any(|(_, event)| *event == FlightEvent::StepStarted { step: 1 })
        );
    }
}

#[test]
fn a_flight_does_not_end_while_a_drone_that_is_taken_over_still_flies() {
    let mut taken_over = 0;
    for ticks in 0..120_u32 {
        let drone = DroneConfig { flies_at_m: Some(1.0), ..DroneConfig::default() };
        let mut bench = Bench::in_world(&WorldConfig { drone, ..WorldConfig::default() });
        bench.accepted(OperatorOrder::Load(plan(
            "autoTakeover 500 800 0.5 0.5\ngoto 0 1 0 0\nland\n",
        )));
        bench.until(SECOND, |bench| bench.phase() == Phase::Observing);
        bench.accepted(START);
        bench.run(Duration::from_millis(30) * ticks);
        bench.accepted(OperatorOrder::Cut);
        let is_down = |bench: &Bench| {
            matches!(bench.truth().phase, firmware::Phase::Emergency | firmware::Phase::Landed)
        };
        bench.until(5 * SECOND, |bench| !bench.outcomes.is_empty() || is_down(bench));
        // Nothing is sent to a drone that has not been taken over yet.
        if matches!(bench.outcomes.first(), Some(Outcome::PreflightRefused { .. })) {
            continue;
        }
        assert!(is_down(&bench), "{ticks}: {:?}", bench.outcomes);
        taken_over += 1;
    }
    assert!(taken_over > 60, "{taken_over}");
}

#[test]
fn a_cut_is_refused_where_nothing_may_be_sent() {
    let drone = DroneConfig { flies_at_m: Some(1.0), ..DroneConfig::default() };
    let mut bench = Bench::in_world(&WorldConfig { drone, ..WorldConfig::default() });
    bench.until(SECOND, |bench| bench.phase() == Phase::Observing);
    assert_eq!(bench.order(OperatorOrder::Cut), Err(Refused::FlownByAnother));
}

/// A drone obeys nobody whose numbers are below those that it has seen: five datagrams of another client are enough. Its last
/// tilt leads it out of the fence, unless it is made to hear the orders that brake it.
#[test]
fn numbers_of_another_client_do_not_carry_the_drone_far_out_of_its_fence() {
    for number in [100_000, 2_000_000_000] {
        let limits = FlightLimits { border: Border::circle(4.0), ..FlightLimits::default() };
        let config = VehicleConfig { limits, ..VehicleConfig::default() };
        let mut bench = Bench::with(&config, &WorldConfig::default());
        bench.until(10 * SECOND, |bench| bench.ready.as_ref().is_some_and(Vec::is_empty));
        bench.accepted(OperatorOrder::Load(plan("takeoff\ngoto 3.4 0 0 0\nland\n")));
        bench.accepted(START);
        bench.until(10 * SECOND, |bench| bench.truth().velocity_m_s.x > 1.0);
        for further in 0..5 {
            let mut datagram = Datagram::new();
            datagram.push(number + further, &Command::Ref(Ref::TakeOff)).unwrap();
            let now = bench.driver.now();
            bench.driver.surroundings.world.send_at(now, datagram.as_bytes());
            bench.step();
        }
        let mut furthest_m = 0.0_f64;
        bench.until(60 * SECOND, |bench| {
            furthest_m = furthest_m.max(bench.truth().position_m.xy().norm());
            !bench.outcomes.is_empty()
        });
        assert!(furthest_m < 4.8, "{furthest_m} m with numbers from {number}");
    }
}

/// Another client flies on until the drone lands, for at most three seconds; its numbers begin far above ours.
fn drown(bench: &mut Bench, first: u32, every: Duration, gaz: f64) {
    let begun = bench.driver.now();
    let [roll, pitch, yaw, gaz] = [0.0, 0.0, 0.0, gaz].map(Fraction::saturating);
    let motion = Motion::Progressive { roll, pitch, gaz, yaw };
    let (mut number, mut next) = (first, begun);
    while bench.truth().phase == firmware::Phase::Flying {
        let taken = bench.driver.now().saturating_sub(begun);
        assert!(taken <= 3 * SECOND, "from {first}, every {every:?}, {gaz:?}: it is still up");
        while bench.driver.now() >= next {
            let mut datagram = Datagram::new();
            datagram.push(number, &Command::Ref(Ref::TakeOff)).unwrap();
            datagram.push(number + 1, &Command::Pcmd(motion)).unwrap();
            bench.driver.surroundings.world.send_at(next, datagram.as_bytes());
            (number, next) = (number + 2, next + every);
        }
        bench.step();
    }
}

/// A vehicle in a breeze, in standby with this plan.
fn in_a_breeze(text: &str) -> Bench {
    let mut bench = Bench::standing_by("0 wind 1.5 0");
    bench.accepted(OperatorOrder::Load(plan(text)));
    bench
}

/// In a breeze a landing begins with a descent by our own orders, which another client drowns as well as it drowns the
/// order to land, whenever it begins: the drone must be made to hear those, too.
#[test]
fn an_ordered_landing_comes_down_in_a_breeze_although_another_client_flies_on() {
    let begins = [0, 300, 500, 1000, 1500].into_iter();
    let streams = [(100_000, 33), (2_000_000_000, 3), (2_000_000_000, 50)];
    let others = streams.into_iter().flat_map(|stream| [0.0, 1.0].map(|gaz| (stream, gaz)));
    for (after_ms, ((first, every_ms), gaz)) in
        begins.flat_map(|after_ms| others.clone().map(move |other| (after_ms, other)))
    {
        let mut bench = in_a_breeze("takeoff\nsetStayTime 60\ngoto 0 0 1 0\nland\n");
        bench.accepted(START);
        bench.until(15 * SECOND, |bench| bench.truth().position_m.z > 1.7);
        bench.run(2 * SECOND);
        bench.accepted(OperatorOrder::Land);
        bench.run(Duration::from_millis(after_ms));
        drown(&mut bench, first, Duration::from_millis(every_ms), gaz);
        assert_eq!(bench.until_it_stands_by(), Outcome::Interrupted);
    }
}

/// Nobody takes that for a drone that lands unasked, nor for the end of the plan.
#[test]
fn a_plan_whose_landing_another_client_drowns_is_flown_to_its_end() {
    let mut bench = in_a_breeze("takeoff\ngoto 0 0 1 0\nland\ntakeoff\ngoto 0 0 1 0\nland\n");
    bench.accepted(START);
    bench.until(30 * SECOND, |bench| bench.count(&FlightEvent::StepStarted { step: 2 }) > 0);
    drown(&mut bench, 2_000_000_000, Duration::from_millis(33), 0.0);
    assert_eq!(bench.until_it_stands_by(), Outcome::Completed);
}
