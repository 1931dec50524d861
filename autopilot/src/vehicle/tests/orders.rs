//! Orders of operators: which are accepted when, and what they change.

use ardrone_link::at::{Command, Motion, Ref};
use ardrone_link::settings::Camera;
use kinematics::Sticks;

use super::bench::{Bench, SECOND, START};
use super::*;
use crate::agent::AgentCommand;
use crate::plan::{Border, Commands};

const PLAN: &str = "takeoff\nland";
const STAY: &str = "takeoff\ngoto 0 0 0 0\ngoto 0 1 0 0\nland";
const WHEN_READY: OperatorOrder = OperatorOrder::Start { when_ready: true };
const REMOTE: Operator = Operator { station: Station::Mavlink, number: 1, local: false };
const OTHER: Operator = Operator { station: Station::Browser, number: 2, local: false };

fn plan(text: &str) -> OperatorOrder {
    OperatorOrder::Load(Plan::parse("plan", text).unwrap())
}

fn append(text: &str) -> OperatorOrder {
    OperatorOrder::Append(Commands::parse("commands", text).unwrap())
}

fn steer() -> OperatorOrder {
    OperatorOrder::Steer(Sticks { roll: 0.3, ..Sticks::default() })
}

const HERE: OperatorOrder = OperatorOrder::GoTo(Place::at(0.0, 0.0));

/// Whoever counts them would take the new plan for flown.
#[test]
fn of_a_plan_that_replaces_another_in_flight_no_step_is_done() {
    let mut bench = Bench::in_the_air(STAY);
    bench.accepted(OperatorOrder::Load(Plan::parse("next", "takeoff\nland").unwrap()));
    let report = bench.vehicle.report();
    assert_eq!((report.steps, report.steps_done), (2, 0));
}

/// The report is that of the plan that was flown, whatever is ordered from the landing on.
#[test]
fn a_plan_that_comes_too_late_for_a_flight_is_counted_for_the_next() {
    let next = || plan("takeoff\ngoto 0 0 0 0\nland");
    let lands = |bench: &Bench| bench.vehicle.decision().unwrap().wanted == AgentCommand::Land;
    for (flown, is_ordered_down, late, outcome, counted) in [
        (PLAN, false, next(), Outcome::Completed, (2, 2)),
        (PLAN, false, OperatorOrder::Clear, Outcome::Completed, (2, 2)),
        (STAY, true, next(), Outcome::Interrupted, (4, 1)),
        (STAY, true, OperatorOrder::Clear, Outcome::Interrupted, (4, 1)),
    ] {
        let mut bench = Bench::in_the_air(flown);
        if is_ordered_down {
            bench.accepted(OperatorOrder::Land);
        }
        bench.until(SECOND, lands);
        bench.accepted(late.clone());
        let status = bench.vehicle.status(bench.now);
        assert_eq!((status.step, status.steps_done), (None, None), "it is none of the next one");
        bench.comes_down();
        bench.until(5 * SECOND, |bench| bench.phase() == Phase::Standby);
        assert_eq!(bench.outcomes, [outcome]);
        let steps = |bench: &Bench| {
            let report = bench.vehicle.report();
            (report.steps, report.steps_done)
        };
        assert_eq!(steps(&bench), counted, "{flown}: {}", late.name());
        bench.accepted(late.clone());
        assert_eq!(steps(&bench), counted, "{flown}: {} on the ground", late.name());
        bench.accepted(next());
        bench.accepted(START);
        assert_eq!(steps(&bench), (3, 0));
    }
}

/// Nobody has ordered it to fly again.
#[test]
fn what_comes_right_after_the_last_step_lifts_nobody() {
    // With the steps of the mission after it.
    let late = [
        (plan("takeoff\ngoto 0 0 0 0\nland"), 3),
        (OperatorOrder::Clear, 0),
        // What is appended to a mission that has ended begins a new one.
        (append("takeoff"), 1),
    ];
    // The last plan ends with a landing that it does not say, on the ground: it begins at once.
    for (flown, appended, counted) in [
        (PLAN, "", (2, 2)),
        (PLAN, "setStayTime 1", (3, 2)),
        ("takeoff\nland\nsetStayTime 1", "", (4, 4)),
    ] {
        for (order, left) in &late {
            let mut bench = Bench::in_the_air(flown);
            if !appended.is_empty() {
                bench.accepted(append(appended));
            }
            bench.run(SECOND);
            bench.comes_down();
            bench.until(SECOND, |bench| bench.vehicle.report().steps_done == 2);
            assert!(bench.outcomes.is_empty(), "it ends in the next tick");
            let said = format!("{flown} {appended}: {}", order.name());
            let lands = counted.0 == 4;
            if lands && matches!(order, OperatorOrder::Append(_)) {
                assert_eq!(bench.order(order.clone()), Err(Refused::Landing), "{said}");
            } else {
                bench.accepted(order.clone());
                assert_eq!(bench.vehicle.mission().len(), *left, "{said}");
            }
            for _ in 0..100 {
                bench.step();
                assert_ne!(bench.reference(), Some(Ref::TakeOff), "{said}");
            }
            let (phase, outcomes) = (bench.phase(), &bench.outcomes[..]);
            assert_eq!((phase, outcomes), (Phase::Standby, &[Outcome::Completed][..]), "{said}");
            let report = bench.vehicle.report();
            assert_eq!((report.steps, report.steps_done), counted, "{said}");
            assert!(report.flight_time_at(bench.now).is_some(), "{said}");
        }
    }
}

/// Those of the plan before it stay in the report, and a tick must not allocate.
#[test]
fn a_plan_that_replaces_another_in_flight_has_room_for_its_waypoints() {
    let goto = "goto 0 0 0 0\n";
    let mut bench = Bench::in_the_air(&format!("takeoff\nsetStayTime 0\n{}", goto.repeat(6)));
    bench.until(60 * SECOND, |bench| bench.vehicle.report().waypoints.len() == 6);
    bench.accepted(plan(&format!("takeoff\n{}land", goto.repeat(5))));
    let waypoints = &bench.vehicle.report().waypoints;
    assert!(waypoints.capacity() >= 6 + 5, "{}", waypoints.capacity());
}

/// An order that comes between the packet that says so and the next tick.
#[test]
fn what_comes_when_the_drone_has_come_down_by_itself_lifts_nobody() {
    for order in [plan(STAY), OperatorOrder::Clear, append("takeoff")] {
        let mut bench = Bench::in_the_air(STAY);
        bench.run(SECOND);
        bench.comes_down();
        loop {
            bench.now += TICK;
            bench.hear();
            if bench.vehicle.on_ground() {
                break;
            }
            bench.tick();
        }
        let is_refused = matches!(order, OperatorOrder::Append(_));
        let expected = if is_refused { Err(Refused::Landing) } else { Ok(()) };
        let name = order.name();
        assert_eq!(bench.order(order), expected, "{name}");
        for _ in 0..100 {
            bench.tick();
            assert_ne!(bench.reference(), Some(Ref::TakeOff), "{name}");
            bench.now += TICK;
            bench.hear();
        }
        assert_eq!(bench.phase(), Phase::Standby, "{name}");
        assert!(matches!(&bench.outcomes[..], [Outcome::Failsafe { .. }]), "{:?}", bench.outcomes);
        assert_eq!(bench.vehicle.report().steps_done, 1, "{name}");
    }
}

/// Orders may end a flight and begin the next before anybody is told of the first one's end.
#[test]
fn each_flights_end_is_told_once_and_before_the_next_one() {
    let mut bench = Bench::in_the_air(PLAN);
    bench.run(SECOND);
    bench.comes_down();
    bench.until(SECOND, |bench| bench.vehicle.report().steps_done == 2);
    bench.accepted(plan(STAY));
    bench.accepted(START);
    bench.accepted(OperatorOrder::Land);
    bench.accepted(START);
    assert_eq!(bench.vehicle.outcome(), None);
    let told: Vec<_> = std::iter::from_fn(|| {
        bench.vehicle.poll().map(|output| match output {
            Output::Telemetry(Telemetry::Ended(outcome, report)) => {
                Some((outcome, report.steps_done, report.flight_time_at(bench.now).is_some()))
            }
            _ => None,
        })
    })
    .collect();
    let ends = [Some((Outcome::Completed, 2, true)), Some((Outcome::CalledOff, 0, false))];
    assert_eq!(told[..2], ends);
    assert!(told.len() > 2 && told[2..].iter().all(Option::is_none), "{told:?}");
    bench.step();
    assert!(bench.outcomes.is_empty());
}

/// What was told of the end stays so, also when the drone is heard again.
#[test]
fn a_landing_that_is_confirmed_too_late_changes_no_count_of_steps() {
    let mut bench = Bench::in_the_air(PLAN);
    bench.run(SECOND);
    bench.accepted(plan(PLAN));
    bench.run(40 * SECOND);
    assert_eq!(bench.outcomes.len(), 1, "{:?}", bench.outcomes);
    let told = bench.vehicle.report().steps_done;
    bench.comes_down();
    bench.until(5 * SECOND, |bench| bench.phase() == Phase::Standby);
    assert_eq!((told, bench.vehicle.report().steps_done), (1, 1));
}

#[test]
fn orders_are_named_like_their_variants_and_three_are_for_anyone() {
    let orders = [
        plan(PLAN),
        append("goto 0 0 0 0"),
        OperatorOrder::Clear,
        START,
        OperatorOrder::Hold,
        OperatorOrder::Resume,
        steer(),
        HERE,
        OperatorOrder::Land,
        OperatorOrder::Cut,
        OperatorOrder::Recover,
        OperatorOrder::Camera { camera: Camera::Bottom },
        OperatorOrder::Take,
        OperatorOrder::Release,
    ];
    for order in &orders {
        let debug = format!("{order:?}").to_lowercase();
        assert_eq!(debug.split([' ', '(']).next(), Some(order.name()));
    }
    let for_anyone: Vec<_> =
        orders.iter().filter(|order| order.is_for_anyone()).map(OperatorOrder::name).collect();
    assert_eq!(for_anyone, ["hold", "land", "cut"]);
}

/// It takes no controls, and no remote operator switches the picture of whoever flies.
#[test]
fn the_camera_is_chosen_by_whoever_flies() {
    const BOTTOM: OperatorOrder = OperatorOrder::Camera { camera: Camera::Bottom };
    let mut bench = Bench::in_the_air(STAY);
    let refused = Err(Refused::ControlsHeld(Operator::TERMINAL));
    assert_eq!(bench.vehicle.order(bench.now, REMOTE, BOTTOM), refused);
    bench.accepted(BOTTOM);
    bench.until(SECOND, |bench| {
        let is_camera = |command: &Command| matches!(command, Command::Config(config) if config.key() == "video:video_channel" && config.value() == "1");
        bench.commands.iter().any(is_camera)
    });
    bench.accepted(OperatorOrder::Release);
    assert_eq!(bench.vehicle.order(bench.now, REMOTE, BOTTOM), Ok(()));
    assert_eq!(bench.vehicle.order(bench.now, OTHER, steer()), Ok(()));
    for (by, expected) in
        [(OTHER, Ok(())), (Operator::TERMINAL, Ok(())), (REMOTE, Err(Refused::ControlsHeld(OTHER)))]
    {
        assert_eq!(bench.vehicle.order(bench.now, by, BOTTOM), expected, "{by}");
    }
    let mut bench = Bench::standing_by(PLAN);
    bench.rises();
    bench.run(SECOND);
    assert_eq!(bench.order(BOTTOM), Err(Refused::FlownByAnother), "nothing is sent to it");
}

#[test]
fn on_the_ground_there_is_nothing_to_hold_steer_or_resume() {
    let mut bench = Bench::standing_by(PLAN);
    for order in [OperatorOrder::Hold, steer(), HERE] {
        assert_eq!(bench.order(order), Err(Refused::OnGround));
    }
    assert_eq!(bench.order(OperatorOrder::Resume), Err(Refused::NothingHeld));
    assert_eq!(bench.order(OperatorOrder::Recover), Err(Refused::NoEmergency));
    bench.accepted(OperatorOrder::Land);
    bench.run(SECOND);
    assert_eq!((bench.outcomes.len(), bench.events.len()), (0, 0), "it stands already");
}

#[test]
fn a_landing_is_not_taken_back_by_any_order() {
    let mut by_order = Bench::in_the_air(STAY);
    by_order.accepted(OperatorOrder::Land);
    let mut by_plan = Bench::in_the_air(PLAN);
    by_plan.until(SECOND, |bench| bench.reference() == Some(Ref::Land));
    for bench in [&mut by_order, &mut by_plan] {
        for order in [OperatorOrder::Hold, steer(), HERE, append("goto 0 0 0 0")] {
            let name = order.name();
            assert_eq!(bench.order(order), Err(Refused::Landing), "{name}");
        }
        bench.run(SECOND);
        assert_eq!(bench.reference(), Some(Ref::Land));
    }
    assert_eq!(by_order.order(START), Err(Refused::Landing));
    assert_eq!(by_order.order(OperatorOrder::Resume), Err(Refused::Landing));
    assert_eq!(by_plan.order(START), Err(Refused::Flying));
}

#[test]
fn a_held_mission_goes_on_when_it_is_resumed_or_started() {
    for resume in [OperatorOrder::Resume, START] {
        let mut bench = Bench::in_the_air(STAY);
        assert_eq!(bench.order(START), Err(Refused::Flying));
        assert_eq!(bench.order(OperatorOrder::Resume), Err(Refused::NothingHeld));
        for _ in 0..2 {
            bench.accepted(OperatorOrder::Hold);
            bench.step();
            let held = bench.events.iter().filter(|event| **event == FlightEvent::Held);
            assert_eq!(held.count(), 1, "a second hold changes nothing");
        }
        bench.run(5 * SECOND);
        assert_eq!(bench.vehicle.report().steps_done, 1);
        assert!(bench.vehicle.status(bench.now).mission_waits);
        bench.accepted(resume);
        assert!(!bench.vehicle.status(bench.now).mission_waits);
        bench.until(20 * SECOND, |bench| bench.vehicle.report().steps_done == 2);
        assert_eq!(bench.waypoints.len(), 1);
        assert_eq!(bench.waypoints[0].step, 1);
    }
}

#[test]
fn the_sticks_steer_and_hold_when_they_are_let_go() {
    let mut bench = Bench::in_the_air(STAY);
    bench.accepted(steer());
    bench.run(2 * TICK);
    let roll = |bench: &Bench| match bench.commands[1] {
        Command::Pcmd(Motion::Progressive { roll, .. }) => roll.get(),
        _ => 0.0,
    };
    assert!((roll(&bench) - 0.3).abs() < 1e-6, "{:?}", bench.commands);
    bench.accepted(steer());
    bench.run(SECOND);
    let wanted = bench.vehicle.decision().unwrap().wanted;
    assert_ne!(wanted, AgentCommand::Sticks, "expired");
    let steered = bench.events.iter().filter(|event| **event == FlightEvent::Steered);
    assert_eq!(steered.count(), 1, "repeated sticks are one order");
    assert!(bench.vehicle.status(bench.now).mission_waits);
}

#[test]
fn a_place_must_be_numbers() {
    let mut bench = Bench::in_the_air(STAY);
    for (x_m, y_m) in [(f64::NAN, 0.0), (0.0, f64::INFINITY)] {
        assert_eq!(bench.order(OperatorOrder::GoTo(Place::at(x_m, y_m))), Err(Refused::NoPlace));
    }
    assert!(!bench.vehicle.status(bench.now).mission_waits);
    bench.accepted(OperatorOrder::GoTo(Place::at(1.0, -2.0)));
    // The agent gives up its order and holds before it is given the place.
    bench.step();
    let held = bench.vehicle.status(bench.now).target.unwrap();
    assert!(held.x_m.hypot(held.y_m) < 0.5, "{held:?}");
    bench.run(2 * TICK);
    let target = bench.vehicle.status(bench.now).target.unwrap();
    assert!((target.x_m - 1.0).hypot(target.y_m + 2.0) < 1e-9, "{target:?}");
    // The drone of this test stands still; sent to where it is, it arrives.
    bench.accepted(HERE);
    bench.until(20 * SECOND, |bench| bench.events.contains(&FlightEvent::ManualTargetReached));
}

#[test]
fn what_is_ordered_before_the_take_off_ends_the_flight_on_the_ground() {
    for order in
        [OperatorOrder::Hold, OperatorOrder::Land, OperatorOrder::Clear, OperatorOrder::Cut]
    {
        let name = order.name();
        let mut bench = Bench::new();
        bench.accepted(plan(PLAN));
        bench.accepted(WHEN_READY);
        assert!(!bench.vehicle.is_at_rest());
        bench.accepted(order);
        assert!(bench.vehicle.is_at_rest(), "{name}");
        bench.run(5 * SECOND);
        assert_eq!(bench.outcomes, [Outcome::CalledOff], "{name}");
        assert_eq!(bench.phase(), Phase::Standby, "{name}");
    }
}

/// The take-off has been ordered, but the drone still stands.
#[test]
fn a_take_off_on_its_way_is_taken_back() {
    for order in [OperatorOrder::Hold, OperatorOrder::Land, OperatorOrder::Clear] {
        let name = order.name();
        let mut bench = Bench::standing_by(PLAN);
        bench.accepted(START);
        bench.until(SECOND, |bench| bench.reference() == Some(Ref::TakeOff));
        assert_eq!(bench.order(steer()), Err(Refused::OnGround));
        bench.accepted(order);
        bench.step();
        assert_eq!((bench.phase(), bench.reference()), (Phase::Landing, Some(Ref::Land)), "{name}");
        assert_eq!(bench.outcomes, [], "it may rise yet");
        bench.run(SECOND);
        assert_eq!(bench.outcomes, [Outcome::Interrupted], "{name}");
    }
}

#[test]
fn a_start_needs_a_mission_that_takes_off_and_a_vehicle_that_is_ready() {
    let mut bench = Bench::new();
    assert_eq!(bench.order(START), Err(Refused::NoMission));
    bench.accepted(plan(PLAN));
    assert_eq!(bench.order(START), Err(Refused::NotReady(vec![NotReady::NoDrone.to_string()])));
    assert!(bench.vehicle.is_at_rest(), "a refused order changes nothing");
    bench.run(3 * SECOND);
    bench.accepted(START);
    assert_eq!(bench.order(START), Err(Refused::Flying), "it is about to fly");
    assert_eq!(bench.order(WHEN_READY), Err(Refused::Flying));
}

#[test]
fn a_start_says_each_reason_once() {
    for (percent, text, expected) in [
        (15, PLAN, "battery at 15 %: more than 20 % are needed"),
        (
            60,
            "takeoff\nsetStayTime 300\ngoto 0 0 1 0\nland",
            "battery at 60 %: the plan takes about 310 s, for which 64 % are needed",
        ),
    ] {
        let mut bench = Bench::standing_by(text);
        bench.battery_percent = percent;
        bench.step();
        assert_eq!(bench.order(START), Err(Refused::NotReady(vec![expected.to_owned()])));
    }
}

#[test]
fn a_flying_drone_may_be_taken_over_at_once_and_only_by_a_plan_that_does_so() {
    let mut bench = Bench::new();
    bench.rises();
    bench.accepted(plan("autoTakeover 500 800 4000 0.5\nland"));
    assert!(matches!(bench.order(START), Err(Refused::NotReady(_))), "it was not heard");
    bench.run(SECOND);
    bench.accepted(START);
}

#[test]
fn an_emergency_is_cleared_on_the_ground_only_and_ends_a_start_that_waits() {
    let mut bench = Bench::standing_by(PLAN);
    bench.state |= DroneState::EMERGENCY | DroneState::FLYING;
    bench.hear();
    assert_eq!(bench.order(OperatorOrder::Recover), Err(Refused::NoEmergency), "it falls");
    let mut bench = Bench::new();
    bench.accepted(plan(PLAN));
    bench.accepted(WHEN_READY);
    bench.state |= DroneState::EMERGENCY;
    assert_eq!(bench.order(OperatorOrder::Recover), Err(Refused::NoEmergency), "not heard yet");
    bench.run(2 * TICK);
    bench.accepted(OperatorOrder::Recover);
    bench.run(TICK);
    assert_eq!(bench.outcomes, [Outcome::CalledOff]);
    assert_eq!(bench.reference(), Some(Ref::ToggleEmergency));
}

/// Another pilot's drone has cut its motors: nothing may be sent to it.
#[test]
fn an_emergency_of_another_pilots_drone_is_not_cleared() {
    let mut bench = Bench::new();
    bench.rises();
    bench.run(SECOND);
    bench.state |= DroneState::EMERGENCY;
    bench.comes_down();
    // For long enough to be believed, but it is ours only with the next tick.
    for _ in 0..20 {
        bench.now += TICK;
        bench.hear();
        assert_eq!(bench.order(OperatorOrder::Recover), Err(Refused::NoEmergency));
    }
    assert!(bench.vehicle.on_ground());
    bench.step();
    bench.accepted(OperatorOrder::Recover);
}

#[test]
fn a_remote_operator_has_the_controls_until_it_releases_them_or_a_local_one_takes_them() {
    let mut bench = Bench::standing_by(PLAN);
    let order = |bench: &mut Bench, by, order| bench.vehicle.order(bench.now, by, order);
    let mut bench_2 = Bench::new();
    assert_eq!(order(&mut bench_2, REMOTE, OperatorOrder::Clear), Ok(()));
    let holder = |bench: &Bench| bench.vehicle.status(bench.now).controls;
    assert_eq!(holder(&bench_2), Some(REMOTE));
    assert_eq!(
        order(&mut bench_2, OTHER, OperatorOrder::Clear),
        Err(Refused::ControlsHeld(REMOTE))
    );
    assert_eq!(order(&mut bench_2, OTHER, OperatorOrder::Release), Ok(()));
    assert_eq!(holder(&bench_2), Some(REMOTE), "it had nothing to release");
    assert_eq!(order(&mut bench_2, REMOTE, OperatorOrder::Release), Ok(()));
    assert_eq!(holder(&bench_2), None);
    assert_eq!(order(&mut bench_2, OTHER, OperatorOrder::Clear), Ok(()));
    bench_2.step();
    assert!(!bench_2.events.iter().any(|event| matches!(event, FlightEvent::ControlsTaken { .. })));
    bench_2.accepted(OperatorOrder::Clear);
    bench_2.step();
    let taken = FlightEvent::ControlsTaken { by: Operator::TERMINAL };
    assert_eq!(bench_2.events.iter().filter(|event| **event == taken).count(), 1);
    // Anyone may land.
    assert_eq!(order(&mut bench, REMOTE, OperatorOrder::Land), Ok(()));
    assert_eq!(holder(&bench), Some(Operator::TERMINAL));
}

#[test]
fn the_controls_can_be_taken_without_changing_anything_else() {
    let mut bench = Bench::in_the_air(STAY);
    bench.accepted(OperatorOrder::Release);
    assert_eq!(bench.vehicle.order(bench.now, REMOTE, OperatorOrder::Take), Ok(()));
    let held = Err(Refused::ControlsHeld(REMOTE));
    assert_eq!(bench.vehicle.order(bench.now, OTHER, OperatorOrder::Take), held);
    bench.accepted(OperatorOrder::Take);
    bench.step();
    let status = bench.vehicle.status(bench.now);
    assert_eq!((status.controls, status.mission_waits), (Some(Operator::TERMINAL), false));
}

/// A page repeats its sticks more often than a terminal repeats a key.
#[test]
fn sticks_of_a_page_expire_sooner_than_those_of_a_terminal() {
    const PAGE: Operator = Operator { station: Station::Browser, number: 1, local: true };
    let steers = |bench: &Bench| bench.vehicle.decision().unwrap().wanted == AgentCommand::Sticks;
    for (by, expected) in [(PAGE, 250), (Operator::TERMINAL, 600)] {
        let mut bench = Bench::in_the_air(STAY);
        let since = bench.now;
        bench.vehicle.order(bench.now, by, steer()).unwrap();
        bench.step();
        assert!(steers(&bench));
        bench.until(2 * SECOND, |bench| !steers(bench));
        let lasted = bench.now.saturating_sub(since).as_millis();
        assert!((expected..expected + 100).contains(&lasted), "{lasted}");
    }
}

#[test]
fn a_new_mission_ends_manual_control_and_waits_if_the_last_one_was_held() {
    let mut bench = Bench::in_the_air(STAY);
    bench.accepted(OperatorOrder::GoTo(Place::at(0.0, 3.0)));
    bench.accepted(plan(STAY));
    for _ in 0..30 {
        bench.step();
        let status = bench.vehicle.status(bench.now);
        assert!(status.mission_waits && status.step.is_none());
        let target = status.target.unwrap_or_default();
        assert!(target.y_m < 1.0, "it is not sent there any more: {target:?}");
    }
}

#[test]
fn a_mission_that_is_replaced_in_the_air_is_flown_at_once() {
    let mut bench = Bench::in_the_air(STAY);
    bench.accepted(plan("takeoff\ngoto 0 0 0 0\nland"));
    bench.until(20 * SECOND, |bench| bench.reference() == Some(Ref::Land));
    let reached: Vec<_> = bench.waypoints.iter().map(|waypoint| waypoint.step).collect();
    assert_eq!((reached, bench.missions.last()), (vec![1], Some(&3)));
    // A landing goes on, and what is loaded meanwhile waits on the ground.
    bench.accepted(plan(STAY));
    bench.comes_down();
    bench.until(SECOND, |bench| bench.phase() == Phase::Standby);
    bench.run(SECOND);
    assert_eq!((bench.phase(), bench.reference()), (Phase::Standby, Some(Ref::Land)));
    assert_eq!(bench.outcomes, [Outcome::Completed]);
    assert_eq!(bench.vehicle.mission().len(), 4);
}

#[test]
fn coordinates_of_a_mission_loaded_in_the_air_begin_where_the_drone_took_off() {
    for resets in [false, true] {
        let mut bench = Bench::in_the_air(STAY);
        bench.accepted(OperatorOrder::Hold);
        bench.drifts_m_s = 0.3;
        bench.run(SECOND);
        bench.drifts_m_s = 0.0;
        bench.run(SECOND / 5);
        let x_m = |bench: &Bench| bench.vehicle.status(bench.now).pose.unwrap().x_m;
        assert!(x_m(&bench) > 0.2, "{} {:?}", x_m(&bench), bench.events);
        assert_eq!(bench.phase(), Phase::Flying, "{:?}", bench.events);
        if resets {
            bench.accepted(OperatorOrder::Land);
            bench.comes_down();
            bench.run(SECOND);
        }
        bench.accepted(plan(STAY));
        if resets {
            bench.accepted(START);
            bench.run(SECOND);
            bench.rises();
        } else {
            bench.accepted(OperatorOrder::Resume);
        }
        bench.until(5 * SECOND, |bench| bench.vehicle.status(bench.now).step == Some(1));
        bench.step();
        let target = bench.vehicle.status(bench.now).target.unwrap();
        assert!(target.x_m.abs() < 0.1, "the frame of a new flight begins with it: {target:?}");
    }
}

#[test]
fn a_mission_that_is_cleared_in_the_air_leaves_the_drone_holding_and_may_be_appended_to() {
    let mut bench = Bench::in_the_air(STAY);
    bench.accepted(OperatorOrder::Clear);
    bench.run(5 * SECOND);
    assert_eq!(bench.phase(), Phase::Flying);
    assert!(bench.vehicle.mission().is_empty() && bench.outcomes.is_empty());
    assert_eq!(bench.reference(), Some(Ref::TakeOff), "it stays in the air");
    bench.accepted(append("goto 0 0 0 0"));
    bench.until(20 * SECOND, |bench| !bench.waypoints.is_empty());
    bench.accepted(append("land"));
    bench.until(SECOND, |bench| bench.reference() == Some(Ref::Land));
    bench.comes_down();
    bench.run(SECOND);
    assert_eq!(bench.outcomes, [Outcome::Completed]);
    assert_eq!(bench.order(START), Err(Refused::NeverTakesOff));
}

/// With the reason that the mission has: none.
#[test]
fn a_mission_that_is_replaced_during_its_landing_gives_no_reason_to_land() {
    let mut bench = Bench::in_the_air(PLAN);
    bench.until(SECOND, |bench| bench.reference() == Some(Ref::Land));
    bench.accepted(plan(STAY));
    bench.step();
    assert_eq!((bench.phase(), bench.vehicle.status(bench.now).landing), (Phase::Landing, None));
    let ordered = |event: &FlightEvent| matches!(event, FlightEvent::LandingOrdered(_));
    assert!(!bench.events.iter().any(ordered), "{:?}", bench.events);
}

/// Its state is the last that was heard of it.
#[test]
fn an_emergency_of_a_drone_that_was_lost_is_not_cleared() {
    let mut bench = Bench::standing_by(PLAN);
    bench.state |= DroneState::EMERGENCY;
    bench.run(SECOND);
    bench.is_heard = false;
    bench.run(3 * SECOND);
    assert_eq!(bench.phase(), Phase::Connecting);
    assert_eq!(bench.order(OperatorOrder::Recover), Err(Refused::NoEmergency));
}

#[test]
fn a_station_without_controls_is_watched_as_long_as_the_drone_flies_for_it() {
    const STATION: Operator = Operator { station: Station::Mavlink, number: 0xffbe, local: false };
    let told = |orders: &[OperatorOrder], expected: &[Result<(), Refused>]| {
        let mut bench = Bench::in_the_air("takeoff\nsetStayTime 60\ngoto 0 0 0 0\nland");
        bench.accepted(OperatorOrder::Release);
        for order in [OperatorOrder::Take, OperatorOrder::Hold, OperatorOrder::Release] {
            assert_eq!(bench.vehicle.order(bench.now, STATION, order), Ok(()));
        }
        let results: Vec<_> = orders.iter().map(|order| bench.order(order.clone())).collect();
        assert_eq!(results, expected);
        bench.accepted(OperatorOrder::Release);
        bench.run(5 * SECOND);
        bench.events.contains(&FlightEvent::StationSilent)
    };
    assert!(told(&[], &[]));
    assert!(told(&[OperatorOrder::Take], &[Ok(())]), "it has ordered nothing");
    let nowhere = OperatorOrder::GoTo(Place::at(f64::NAN, 0.0));
    assert!(told(&[nowhere], &[Err(Refused::NoPlace)]), "nor by a refused order");
    assert!(!told(&[HERE], &[Ok(())]), "it flies for the terminal now");
}

#[test]
fn a_drone_that_is_flown_back_into_its_fence_lands_where_it_is_on_order() {
    let mut config = VehicleConfig { read_back: false, ..VehicleConfig::default() };
    config.limits.border = Border::circle(0.1);
    let mut bench = Bench::in_the_air_with(&config, STAY);
    bench.accepted(OperatorOrder::Hold);
    bench.drifts_m_s = 0.3;
    bench.until(10 * SECOND, |bench| bench.phase() == Phase::Landing);
    let reason = LandingReason::Safety(Veto::OutsideFence);
    assert_eq!(bench.vehicle.status(bench.now).landing, Some(reason));
    bench.drifts_m_s = 0.0;
    bench.run(4 * TICK);
    assert_eq!(bench.reference(), Some(Ref::TakeOff), "it is flown back");
    bench.accepted(OperatorOrder::Land);
    bench.step();
    assert_eq!(bench.reference(), Some(Ref::Land));
}
