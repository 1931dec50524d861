//! Plans have one meaning: the targets that `check` prints are flown.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use ardrone_pilot::recording::Record;
use autopilot::outcome::Outcome;
use autopilot::plan::{Border, Command, Expectation, FlightLimits, ZOrigin};
use autopilot::vehicle::{FlightEvent, Telemetry};
use autopilot::{Plan, VehicleConfig};
use kinematics::Pose;
use mock_drone::{DroneConfig, WorldConfig};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use system_tests::plan;
use system_tests::sim::{SimulatedFlight, Simulation};

/// Small, so that flights are short and many targets are at the fence.
const LIMITS: FlightLimits = FlightLimits::new(Border::circle(3.0), 0.3, 2.0);
const PLANS: u64 = 300;
/// Largest distance of a hovering or standing drone from its target.
const HOVER_M: f64 = 0.3;

fn simulation(seed: u64, limits: &FlightLimits) -> Simulation {
    let drone = DroneConfig { seed, ..DroneConfig::default() };
    let world = WorldConfig { drone, ..WorldConfig::default() };
    let pilot = VehicleConfig { limits: *limits, ..VehicleConfig::default() };
    Simulation { world, pilot, ..Simulation::default() }
}

/// Rounding error of sums in a different order.
const TOLERANCE: f64 = 1e-9;

/// Difference of two poses, in each coordinate. Headings are not wrapped.
fn apart(pose: &Pose, other: &Pose) -> Pose {
    Pose {
        x_m: pose.x_m - other.x_m,
        y_m: pose.y_m - other.y_m,
        z_m: pose.z_m - other.z_m,
        yaw_deg: pose.yaw_deg - other.yaw_deg,
    }
}

fn moved(pose: &Pose, by: &Pose) -> Pose {
    Pose {
        x_m: pose.x_m + by.x_m,
        y_m: pose.y_m + by.y_m,
        z_m: pose.z_m + by.z_m,
        yaw_deg: pose.yaw_deg + by.yaw_deg,
    }
}

fn is_same(pose: &Pose, other: &Pose) -> bool {
    let off = apart(pose, other);
    let turns = off.yaw_deg / 360.0;
    let lengths_m = [off.x_m, off.y_m, off.z_m];
    lengths_m.into_iter().chain([turns - turns.round()]).all(|off| off.abs() < TOLERANCE)
}

/// A flight, with the poses that affect the meaning of the plan.
struct Flown {
    flight: SimulatedFlight,
    /// Pose at the begin of each step, used by `$POSE$` and `moveByRel`.
    began: BTreeMap<usize, Pose>,
    /// Pose at the end of each step.
    ended: BTreeMap<usize, Pose>,
    /// Stay time of each step, in milliseconds.
    stay_ms: BTreeMap<usize, i64>,
}

fn fly(simulation: &Simulation, plan: &Plan) -> Flown {
    let (mut began, mut ended, mut stay_ms) = (BTreeMap::new(), BTreeMap::new(), BTreeMap::new());
    let mut place = Pose::default();
    let record = |record: Record| match record {
        // Recorded before the events of its tick.
        Record::Tick { decision, .. } => {
            let state = decision.state;
            let [x_m, y_m, z_m] = state.position_m.into();
            place = Pose { x_m, y_m, z_m, yaw_deg: state.yaw_deg };
            if let Some(step) = decision.step {
                stay_ms.insert(step, decision.percepts.settings.stay_time_ms);
            }
        }
        Record::Telemetry { telemetry: Telemetry::Event(event), .. } => match event {
            FlightEvent::StepStarted { step } => _ = began.insert(step, place),
            FlightEvent::StepDone { step } => _ = ended.insert(step, place),
            _ => {}
        },
        _ => {}
    };
    let flight = simulation.fly_recorded(plan.clone(), record).unwrap();
    Flown { flight, began, ended, stay_ms }
}

/// Accumulated difference between a flight and the assumptions of `check`: that the drone hovers at the
/// expected height above its take-off place, and reaches each target exactly. The target of each step differs
/// as much as its reference.
#[derive(Default)]
struct Deviation {
    take_off: Option<Pose>,
    reference: Reference,
    target: Pose,
    /// Place of the drone in the dry run.
    place: Pose,
}

#[derive(Default)]
enum Reference {
    #[default]
    TakeOff,
    Pose(Pose),
}

impl Deviation {
    /// Difference between the drone and the dry run. Its only new part is the accuracy of hovering.
    fn known_in_flight(&self, pose: &Pose, place: &Pose) -> Pose {
        let off = apart(pose, place);
        let new = apart(&off, &self.target);
        let lengths_m = [new.x_m, new.y_m, new.z_m];
        assert!(lengths_m.iter().all(|off_m| off_m.abs() < HOVER_M), "{pose:?}, not {place:?}");
        off
    }

    /// The target that must have been flown in a step, and whether it was moved inside the fence.
    fn follow(
        &mut self,
        index: usize,
        command: Command,
        expected: &Expectation,
        (flown, limits): (&Flown, &FlightLimits),
    ) -> Option<(Pose, bool)> {
        let before = std::mem::replace(&mut self.place, expected.place);
        // A setting takes effect with the next step.
        let here = || self.known_in_flight(flown.began.range(index..).next().unwrap().1, &before);
        let off = match command {
            Command::TakeOff { .. } => {
                let mut off = self.known_in_flight(&flown.ended[&index], &expected.place);
                self.target = off;
                if limits.z_origin == ZOrigin::Floor {
                    off.z_m = 0.0;
                }
                self.take_off.get_or_insert(off);
                return None;
            }
            Command::GoTo(_) => match self.reference {
                Reference::TakeOff => self.take_off.unwrap(),
                Reference::Pose(off) => off,
            },
            Command::MoveBy(_) | Command::Hold { .. } => self.target,
            Command::MoveByRelative(_) => here(),
            Command::SetReference(_) => {
                self.reference = Reference::TakeOff;
                return None;
            }
            Command::SetReferenceHere => {
                self.reference = Reference::Pose(here());
                return None;
            }
            Command::Land | Command::LandOnTag => {
                self.target.z_m = 0.0;
                return None;
            }
            Command::SetReachDistance { .. }
            | Command::SetStayDistance { .. }
            | Command::SetStayTime { .. }
            | Command::SetReferenceStart
            | Command::SetSpeed { .. }
            | Command::SetMaxControl { .. }
            | Command::FindTag => return None,
        };
        let printed = expected.target.unwrap();
        assert_eq!(printed, expected.place);
        let wanted = moved(&printed, &off);
        let target = limits.nearest_inside(&wanted, 0.0);
        self.target = apart(&target, &printed);
        Some((target, !is_same(&target, &wanted)))
    }
}

/// Flies `text` and compares each target with the output of `check`. Returns how many were moved inside the
/// fence.
fn fly_and_compare(simulation: &Simulation, text: &str) -> usize {
    let limits = simulation.pilot.limits;
    let plan = Plan::parse_within("plan.txt", text, &limits).unwrap();
    let flown = fly(simulation, &plan);
    assert_eq!(flown.flight.outcome, Outcome::Completed, "{text}");
    let mut deviation = Deviation::default();
    let mut waypoints = flown.flight.report.waypoints.iter();
    let mut corrected = Vec::new();
    let expectations = plan.expectations(&limits);
    for (index, (step, expected)) in plan.steps().iter().zip(&expectations).enumerate() {
        let wanted = deviation.follow(index, step.command, expected, (&flown, &limits));
        assert_eq!(wanted.is_some(), expected.target.is_some(), "`{}` in\n{text}", step.text);
        let Some((wanted, is_moved)) = wanted else { continue };
        let waypoint = waypoints.next().unwrap();
        assert_eq!(waypoint.step, index, "{text}");
        let target = waypoint.target;
        assert!(
            is_same(&target, &wanted),
            "line {}, `{}`: flown to {target:?}, not {wanted:?}; in\n{text}",
            step.line,
            step.text,
        );
        assert_eq!(u128::try_from(flown.stay_ms[&index]), Ok(expected.stay.as_millis()), "{text}");
        if is_moved {
            corrected.push(FlightEvent::TargetCorrected { step: index });
        }
    }
    assert_eq!(waypoints.next(), None, "{text}");
    let events = flown.flight.events.iter().map(|(_, event)| event.clone());
    let corrections: Vec<_> =
        events.filter(|event| matches!(event, FlightEvent::TargetCorrected { .. })).collect();
    assert_eq!(corrections, corrected, "{text}");
    corrected.len()
}

/// A random plan that `check` accepts: invalid lines are left out.
fn random_plan(random: &mut ChaCha8Rng, limits: &FlightLimits) -> String {
    let mut text = String::new();
    if random.random_bool(0.1) {
        text.push_str("takeoff\ngoto 0 90 0 0\nclearCommands\n");
    }
    let mut lines = vec!["setStayTime 0.3".to_owned()];
    if random.random_bool(0.4) {
        lines.push(random_reference(random));
    }
    lines.push("takeoff".to_owned());
    for _ in 0..random.random_range(4..12) {
        lines.extend(random_lines(random, limits));
    }
    for line in lines {
        let longer = format!("{text}{line}\n");
        // Commands before the take-off are checked together with one.
        let judged = format!("{longer}takeoff\nland\n");
        if Plan::review(&judged, limits).0.is_some() {
            text = longer;
        }
    }
    text
}

fn random_reference(random: &mut ChaCha8Rng) -> String {
    if random.random_bool(0.5) {
        return "setReference $POSE$".to_owned();
    }
    format!("setReference {}", random_pose(random, 0.7))
}

fn random_pose(random: &mut ChaCha8Rng, reach_m: f64) -> String {
    let mut text = String::new();
    for reach_m in [reach_m, reach_m, reach_m / 2.0] {
        let _ = write!(text, "{:.2} ", random.random_range(-reach_m..reach_m));
    }
    text + &random.random_range(-200..200).to_string()
}

fn random_lines(random: &mut ChaCha8Rng, limits: &FlightLimits) -> Vec<String> {
    let one = |line: String| vec![line];
    match random.random_range(0..17) {
        0..=2 => one(format!("goto {}", random_pose(random, 1.4))),
        3 => {
            // At the fence the actual hover height decides whether a target is inside.
            let angle = random.random_range(0.0..std::f64::consts::TAU);
            let radius_m = limits.border.furthest_m();
            let (x_m, y_m) = (radius_m * angle.sin(), radius_m * angle.cos());
            one(format!("goto {x_m:.3} {y_m:.3} 0 0"))
        }
        4 => {
            let heights = [limits.floor_m, limits.ceiling_m];
            let height_m = heights[random.random_range(0..heights.len())];
            one(format!("goto 0 0 {:.3} 0", height_m - limits.origin_height_m(0.85)))
        }
        5 | 6 => one(format!("moveBy {}", random_pose(random, 1.0))),
        7 | 8 => one(format!("moveByRel {}", random_pose(random, 1.0))),
        9 | 10 => one(random_reference(random)),
        11 => one(format!("setInitialReachDist {:.2}", random.random_range(0.15..0.3))),
        12 => one(format!("setStayWithinDist {:.2}", random.random_range(0.5..1.0))),
        13 => one(format!("setStayTime {:.3}", random.random_range(0.0..1.0))),
        15 => one(format!("hold {:.2}", random.random_range(0.0..1.0))),
        14 => one(format!("setMaxControl {:.2}", random.random_range(0.5..1.0))),
        _ => {
            let ups = ["takeoff", "autoInit 500 800", "autoTakeover 500 800", "lockScaleFP"];
            let up = ups[random.random_range(0..ups.len())].to_owned();
            if random.random_bool(0.3) { one(up) } else { vec!["land".to_owned(), up] }
        }
    }
}

#[test]
fn a_random_plan_is_flown_to_exactly_the_targets_that_check_prints() {
    let mut corrected = 0;
    let mut lines = String::new();
    for seed in 0..PLANS {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let z_origin = if seed % 4 == 0 { ZOrigin::Floor } else { ZOrigin::Hover };
        let limits = FlightLimits { z_origin, ..LIMITS };
        let text = random_plan(&mut random, &limits);
        corrected += fly_and_compare(&simulation(seed, &limits), &text);
        lines += &text;
    }
    // Ensures that the generator covers targets outside the fence.
    assert!(corrected > 25, "{corrected} targets were moved");
    for command in [
        "takeoff",
        "land\ntakeoff",
        "land\nautoInit",
        "land\nautoTakeover",
        "0\ntakeoff",
        "lockScaleFP",
        "clearCommands",
        "goto",
        "moveBy ",
        "moveByRel",
        "hold",
        "setReference $POSE$\ntakeoff",
        "setReference $POSE$\ngoto",
        "setReference -",
        "setInitialReachDist",
        "setStayWithinDist",
        "setStayTime",
        "setMaxControl",
    ] {
        let count = lines.matches(command).count();
        assert!(count >= 8, "`{command}` {count} times");
    }
}

#[test]
fn a_second_take_off_leaves_the_reference_where_it_is() {
    let text = "takeoff\ngoto 0 6 0 0\nland\ntakeoff\ngoto 0 6 0 0\nland\n";
    let flown = fly(&Simulation::default(), &plan(text));
    let [first, second] = &flown.flight.report.waypoints[..] else { panic!("two targets") };
    assert_eq!(first.target, second.target);
    assert_eq!(fly_and_compare(&Simulation::default(), text), 0);
}

#[test]
fn a_reference_that_is_set_before_the_take_off_counts_in_flight() {
    let text = "setReference 1 2 0 30\ntakeoff\ngoto 0 0 0 0\nland\n";
    let flown = fly(&Simulation::default(), &plan(text));
    let (hover, target) = (flown.ended[&1], flown.flight.report.waypoints[0].target);
    let by = Pose { x_m: 1.0, y_m: 2.0, z_m: 0.0, yaw_deg: 30.0 };
    assert!(is_same(&target, &moved(&hover, &by)), "{target:?}");
    assert_eq!(fly_and_compare(&Simulation::default(), text), 0);
}

/// The pose of a drone on the ground is on the floor.
#[test]
fn a_reference_on_the_floor_is_one_in_flight_too() {
    let text = "setReference $POSE$\ntakeoff\ngoto 0 1 1.2 0\nland\n";
    assert_eq!(fly_and_compare(&Simulation::default(), text), 0);
}

#[test]
fn a_take_off_in_the_air_stays_there() {
    let text = "takeoff\ngoto 0 1 0.8 0\ntakeoff\nmoveBy 0 0 -0.8 0\nland\n";
    assert_eq!(fly_and_compare(&Simulation::default(), text), 0);
}
