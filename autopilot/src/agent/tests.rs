//! The agent's decisions, step by step.

#![allow(clippy::large_types_passed_by_value, reason = "percepts are copied in every step")]

mod station;
mod tags;

use super::*;
use crate::fence::Border;

const GROUND: Percepts = Percepts {
    now_ms: 0,
    pose: Some(Pose { x_m: 0.0, y_m: 0.0, z_m: 0.0, yaw_deg: 0.0 }),
    on_ground: true,
    hovering: false,
    battery_percent: Some(80),
    blind_for_ms: 0,
    uncertainty_m: 0.1,
    saturated_for_ms: 0,
    wind: 0.0,
    steering: false,
    setpoint: None,
    station: StationPercepts { silent_for_ms: 0, hold_after_ms: 10_000, land_after_ms: 20_000 },
    settings: ApproachSettings { reach_distance_m: 0.2, stay_distance_m: 0.5, stay_time_ms: 2000 },
    speed_m_s: 0.0,
    fence: FlightLimits::new(Border::circle(10.0), 0.3, 3.0),
    tags: None,
};
const HOVERING: Percepts = Percepts { on_ground: false, hovering: true, ..GROUND };
const TARGET: Pose = Pose { x_m: 1.0, y_m: 0.0, z_m: 0.0, yaw_deg: 0.0 };

/// The state is all the memory that the agent uses; this limit makes its growth visible.
const _: () = assert!(STATE_BYTES <= 1024);

/// An agent and its percepts.
struct Bench {
    agent: Agent,
    activity: Activity,
    percepts: Percepts,
}

impl Bench {
    /// An agent that is already waiting: its initial goal took the first step.
    fn new(percepts: Percepts) -> Self {
        let mut bench = Self { agent: Agent::new(), activity: Activity::default(), percepts };
        bench.step();
        bench
    }

    fn step(&mut self) -> (Option<AgentCommand>, Option<Report>) {
        let step = self.run();
        assert_eq!(step.commands, 1, "exactly one AT command a step");
        (step.command, step.report)
    }

    fn run(&mut self) -> AgentStep {
        let step = AgentStep::run(&mut self.agent, &mut self.activity, self.percepts);
        self.percepts.now_ms += 30;
        step
    }

    fn go_to(&mut self, pose: Pose) {
        assert!(self.agent.achieve_go_to(pose.x_m, pose.y_m, pose.z_m, pose.yaw_deg));
    }
}

#[test]
fn it_waits_on_the_ground_and_in_the_air() {
    let mut bench = Bench::new(GROUND);
    assert_eq!(bench.step(), (Some(AgentCommand::Standby), None));
    bench.percepts = HOVERING;
    assert_eq!(bench.step(), (Some(AgentCommand::Hover), None));
}

#[test]
fn it_reports_which_plans_it_chose() {
    let mut bench = Bench::new(HOVERING);
    let chosen = |step: &AgentStep| {
        let name = |number: &u32| PLANS[*number as usize].1;
        step.plans.numbers().iter().map(name).collect::<Vec<_>>()
    };
    assert_eq!(chosen(&bench.run()), ["+!wait", "+!watch"]);
    bench.percepts.battery_percent = Some(5);
    assert_eq!(chosen(&bench.run()), ["+!wait", "+!watch", "-!wait", "+!goDown"]);
}

#[test]
fn it_takes_off_until_the_drone_hovers_and_then_holds_the_place() {
    let mut bench = Bench::new(GROUND);
    assert!(bench.agent.achieve_take_off());
    assert!(!bench.agent.can_add_event());
    assert_eq!(bench.step(), (Some(AgentCommand::TakeOff), None));
    assert_eq!(bench.step(), (Some(AgentCommand::TakeOff), None));
    bench.percepts = Percepts { pose: Some(TARGET), now_ms: 3000, ..HOVERING };
    let hold = Some(AgentCommand::GoTo(TARGET));
    assert_eq!(bench.step(), (hold, Some(Report::Done)));
    assert_eq!(bench.step(), (hold, None));
}

#[test]
fn an_empty_battery_does_not_take_off() {
    let mut bench = Bench::new(Percepts { battery_percent: Some(12), ..GROUND });
    assert!(bench.agent.achieve_take_off());
    let step = bench.run();
    assert_eq!((step.command, step.report), (Some(AgentCommand::Standby), Some(Report::Refused)));
    assert_eq!(step.danger, Some(Danger::BatteryEmpty));
    assert_eq!(bench.step(), (Some(AgentCommand::Standby), None));
}

#[test]
fn implausible_navdata_forbid_the_take_off() {
    for percepts in [
        Percepts { blind_for_ms: 301, ..GROUND },
        Percepts { blind_for_ms: i64::MAX, ..GROUND },
        Percepts { pose: None, ..GROUND },
        Percepts { uncertainty_m: 3.1, ..GROUND },
        Percepts { uncertainty_m: f64::NAN, ..GROUND },
    ] {
        let mut bench = Bench::new(percepts);
        assert!(bench.agent.achieve_take_off());
        let refused = (Some(AgentCommand::Standby), Some(Report::Refused));
        assert_eq!(bench.step(), refused, "{percepts:?}");
        assert_eq!(bench.step(), (Some(AgentCommand::Standby), None));
    }
}

#[test]
fn a_take_off_that_becomes_blind_is_landed() {
    let mut bench = Bench::new(GROUND);
    assert!(bench.agent.achieve_take_off());
    bench.step();
    for (blind_for_ms, command) in [(2000, AgentCommand::TakeOff), (2001, AgentCommand::Land)] {
        bench.percepts = Percepts { on_ground: false, blind_for_ms, ..bench.percepts };
        assert_eq!(bench.step(), (Some(command), None));
    }
}

/// Without a position the drone can only hover.
#[test]
fn holding_and_steering_work_without_a_place() {
    let mut bench = Bench::new(Percepts { pose: None, ..HOVERING });
    assert!(bench.agent.achieve_hold());
    assert_eq!(bench.step(), (Some(AgentCommand::Hover), None));
    assert!(bench.agent.achieve_steer());
    assert_eq!(bench.step(), (Some(AgentCommand::Hover), None));
    bench.percepts.battery_percent = Some(5);
    assert!(bench.agent.achieve_steer());
    let step = bench.run();
    assert_eq!((step.command, step.danger), (Some(AgentCommand::Land), Some(Danger::BatteryEmpty)));
}

/// A key that is held down repeats its order.
#[test]
fn manual_control_does_not_keep_a_drone_in_danger_in_the_air() {
    for pose in [Some(TARGET), None] {
        let mut bench = Bench::new(Percepts { pose, blind_for_ms: 2001, ..HOVERING });
        for _ in 0..3 {
            assert!(bench.agent.achieve_hold());
            assert_eq!(bench.step().0, Some(AgentCommand::Land));
            assert!(bench.agent.achieve_steer());
            assert_eq!(bench.step().0, Some(AgentCommand::Land));
        }
    }
}

/// Repeated orders to take off do not keep the agent from checking for dangers.
#[test]
fn taking_over_in_the_air_looks_at_the_dangers() {
    for pose in [Some(TARGET), None] {
        let mut bench = Bench::new(Percepts { pose, ..HOVERING });
        assert!(bench.agent.achieve_take_off());
        bench.percepts.battery_percent = Some(5);
        let step = bench.run();
        assert_eq!((step.command, step.report), (Some(AgentCommand::Land), None));
        assert_eq!(step.danger, Some(Danger::BatteryEmpty));
        assert!(bench.agent.achieve_take_off());
        assert_eq!(bench.step().0, Some(AgentCommand::Land));
    }
}

#[test]
fn setting_out_looks_at_the_dangers() {
    let mut bench = Bench::new(HOVERING);
    bench.go_to(TARGET);
    bench.percepts.uncertainty_m = 3.1;
    let step = bench.run();
    assert_eq!((step.command, step.danger), (Some(AgentCommand::Land), Some(Danger::Lost)));
    assert_eq!(bench.step(), (Some(AgentCommand::Land), None));
}

#[test]
fn a_take_off_that_does_not_succeed_is_given_up() {
    let mut bench = Bench::new(GROUND);
    assert!(bench.agent.achieve_take_off());
    bench.step();
    bench.percepts.now_ms = 10_031;
    let step = bench.run();
    assert_eq!((step.command, step.danger), (Some(AgentCommand::Land), Some(Danger::NoProgress)));
    assert_eq!(bench.step(), (Some(AgentCommand::Standby), Some(Report::Done)));
}

#[test]
fn it_reaches_stays_and_reports() {
    let mut bench = Bench::new(HOVERING);
    bench.go_to(TARGET);
    let approach = (Some(AgentCommand::GoTo(TARGET)), None);
    assert_eq!(bench.step(), approach);
    assert_eq!(bench.step(), approach);
    bench.percepts.pose = Some(TARGET);
    assert_eq!(bench.step(), approach);
    bench.percepts.now_ms += 1900;
    assert_eq!(bench.step(), approach);
    // Drifting away restarts the stay time.
    bench.percepts.pose = Some(Pose { x_m: 0.4, ..TARGET });
    assert_eq!(bench.step(), approach);
    bench.percepts.pose = Some(TARGET);
    assert_eq!(bench.step(), approach);
    bench.percepts.now_ms += 1900;
    assert_eq!(bench.step(), approach);
    bench.percepts.now_ms += 200;
    assert_eq!(bench.step(), (approach.0, Some(Report::Done)));
    assert_eq!(bench.step(), approach);
}

/// The time limit of the way back is independent of how long the stay lasted.
#[test]
fn a_drone_that_drifts_off_late_has_its_time_to_come_back() {
    let mut bench = Bench::new(HOVERING);
    bench.percepts.settings.stay_time_ms = 90_000;
    bench.go_to(TARGET);
    bench.step();
    bench.percepts.pose = Some(TARGET);
    bench.step();
    bench.percepts.now_ms += 70_000;
    let there = (Some(AgentCommand::GoTo(TARGET)), None);
    assert_eq!(bench.step(), there);
    bench.percepts.pose = Some(Pose { x_m: 0.2, ..TARGET });
    for _ in 0..100 {
        assert_eq!(bench.step(), there);
    }
    bench.percepts.pose = Some(TARGET);
    assert_eq!(bench.step(), there);
    bench.percepts.now_ms += 90_001;
    assert_eq!(bench.step(), (there.0, Some(Report::Done)));
    // And not longer than that.
    bench.go_to(TARGET);
    bench.percepts.pose = Some(Pose { x_m: 0.2, ..TARGET });
    bench.step();
    bench.percepts.now_ms += 60_001;
    assert_eq!(bench.run().danger, Some(Danger::NoProgress));
}

/// A drone that keeps reaching its target and drifting away is given up too.
#[test]
fn arrivals_do_not_prolong_an_approach() {
    let mut bench = Bench::new(HOVERING);
    bench.go_to(TARGET);
    let mut steps = 0;
    while bench.run().danger.is_none() {
        steps += 1;
        let x_m = if steps % 4 == 0 { 0.0 } else { 1.0 };
        bench.percepts.pose = Some(Pose { x_m, ..TARGET });
        assert!(steps < 8100, "a quarter of the steps");
    }
    assert!(steps > 2000);
}

/// An approach that is interrupted by missing navdata does not restart its time limit.
#[test]
fn a_flickering_view_does_not_prolong_an_approach() {
    let mut bench = Bench::new(HOVERING);
    bench.go_to(TARGET);
    let mut steps = 0;
    while bench.run().danger.is_none() {
        steps += 1;
        bench.percepts.blind_for_ms = if steps % 2 == 0 { 0 } else { 400 };
        assert!(steps < 2100, "60 s are 2000 steps");
    }
}

#[test]
fn a_heading_across_the_jump_is_close() {
    let mut bench = Bench::new(HOVERING);
    let target = Pose { yaw_deg: 181.0, ..TARGET };
    bench.percepts.pose = Some(Pose { yaw_deg: -178.0, ..TARGET });
    bench.go_to(target);
    bench.step();
    bench.step();
    bench.percepts.now_ms += 2100;
    assert_eq!(bench.step().1, Some(Report::Done));
}

#[test]
fn landing_is_obeyed_in_the_next_step_whatever_runs() {
    let mut bench = Bench::new(HOVERING);
    bench.go_to(TARGET);
    bench.step();
    bench.step();
    assert!(bench.agent.achieve_land());
    assert_eq!(bench.step(), (Some(AgentCommand::Land), None));
    assert_eq!(bench.step(), (Some(AgentCommand::Land), None));
    bench.percepts = GROUND;
    assert_eq!(bench.step(), (Some(AgentCommand::Standby), Some(Report::Done)));
    // The old target is dropped: after the next take-off the new place is held.
    bench.percepts = HOVERING;
    assert_eq!(bench.step(), (Some(AgentCommand::Hover), None));
}

#[test]
fn a_drone_that_lands_by_itself_is_not_lifted_again() {
    let mut bench = Bench::new(HOVERING);
    bench.go_to(TARGET);
    bench.step();
    bench.percepts = GROUND;
    assert_eq!(bench.step(), (Some(AgentCommand::Standby), Some(Report::Failed)));
    bench.go_to(TARGET);
    assert_eq!(bench.step(), (Some(AgentCommand::Standby), Some(Report::Refused)));
    let mut bench = Bench::new(Percepts { pose: Some(TARGET), ..HOVERING });
    bench.go_to(TARGET);
    bench.step();
    assert_eq!(bench.step(), (Some(AgentCommand::GoTo(TARGET)), None), "it has arrived");
    bench.percepts = Percepts { now_ms: bench.percepts.now_ms, ..GROUND };
    assert_eq!(bench.step(), (Some(AgentCommand::Standby), Some(Report::Failed)));
}

/// Brings a drone into the air with each goal that can run there.
fn in_the_air() -> Vec<(&'static str, Bench)> {
    let mut benches = Vec::new();
    for name in ["wait", "hold", "approach", "stay", "steer", "take-off"] {
        let mut bench = Bench::new(if name == "take-off" { GROUND } else { HOVERING });
        assert!(match name {
            "take-off" => bench.agent.achieve_take_off(),
            "hold" => bench.agent.achieve_hold(),
            "steer" => bench.agent.achieve_steer(),
            "wait" => true,
            _ => bench.agent.achieve_go_to(1.0, 0.0, 0.0, 0.0),
        });
        bench.percepts.steering = name == "steer";
        if name == "stay" {
            bench.percepts.pose = Some(TARGET);
        }
        for _ in 0..5 {
            bench.step();
        }
        bench.percepts.on_ground = false;
        benches.push((name, bench));
    }
    benches
}

#[test]
fn each_danger_lands_whatever_runs_and_is_reported() {
    for danger in [Danger::BatteryEmpty, Danger::Blind, Danger::Lost, Danger::Wind] {
        for (name, mut bench) in in_the_air() {
            let percepts = bench.percepts;
            bench.percepts = match danger {
                Danger::BatteryEmpty => Percepts { battery_percent: Some(12), ..percepts },
                Danger::Blind => Percepts { blind_for_ms: 2001, ..percepts },
                Danger::Lost => Percepts { uncertainty_m: 3.1, ..percepts },
                _ => Percepts { saturated_for_ms: 2001, wind: 0.5, ..percepts },
            };
            let step = bench.run();
            let said = (step.command, step.danger, step.commands);
            assert_eq!(said, (Some(AgentCommand::Land), Some(danger), 1), "{name}");
            assert_eq!(bench.step().0, Some(AgentCommand::Land), "{name}");
        }
    }
    for (name, mut bench) in in_the_air() {
        // A wind that the drone can hold against does not land it.
        bench.percepts = Percepts { wind: 0.95, saturated_for_ms: 2000, ..bench.percepts };
        assert_ne!(bench.step().0, Some(AgentCommand::Land), "{name}: nothing is wrong");
    }
}

#[test]
fn in_the_wind_it_comes_down_where_it_is_before_it_lands() {
    let mut bench = Bench::new(HOVERING);
    bench.go_to(TARGET);
    bench.step();
    let here = Pose { x_m: 0.3, z_m: 2.0, ..TARGET };
    let windy = Percepts { wind: 0.7, battery_percent: Some(12), pose: Some(here), ..HOVERING };
    bench.percepts = windy;
    let down = Some(AgentCommand::GoTo(Pose { z_m: 0.35, ..here }));
    assert_eq!(bench.step().0, down);
    assert_eq!(bench.step().0, down);
    bench.percepts.pose = Some(Pose { z_m: 0.4, ..here });
    assert_eq!(bench.step().0, Some(AgentCommand::Land));
    // Only for a limited time and with usable navdata; in danger it does not wait for a short gap to end.
    let mut bench = Bench::new(windy);
    assert_eq!(bench.step().0, down);
    bench.percepts.blind_for_ms = 400;
    assert_eq!(bench.step().0, Some(AgentCommand::Land));
    // Nor where it cannot hold against the wind.
    for carried_off in
        [Percepts { wind: 0.9, ..windy }, Percepts { saturated_for_ms: 2001, ..windy }]
    {
        assert_eq!(Bench::new(carried_off).step().0, Some(AgentCommand::Land));
    }
    for (later_ms, blind_for_ms) in [(9000, 0), (30, 2001)] {
        let mut bench = Bench::new(Percepts { battery_percent: Some(80), ..windy });
        assert!(bench.agent.achieve_land());
        assert_eq!(bench.step().0, down);
        bench.percepts.blind_for_ms = 400;
        assert_eq!(bench.step().0, Some(AgentCommand::Hover));
        bench.percepts =
            Percepts { now_ms: bench.percepts.now_ms + later_ms, blind_for_ms, ..bench.percepts };
        assert_eq!(bench.step().0, Some(AgentCommand::Land));
    }
}

#[test]
fn the_agents_limits_of_the_charge_are_those_that_others_are_told() {
    for (belief, percent) in
        [("warningBattery", WARNING_BATTERY_PERCENT), ("landingBattery", LANDING_BATTERY_PERCENT)]
    {
        assert!(SOURCE.contains(&format!("\n{belief}({percent}).\n")), "{belief}");
    }
}

#[test]
fn a_blind_descent_does_not_wait_with_an_empty_battery() {
    let lands = LANDING_BATTERY_PERCENT;
    for (percent, command) in [(lands + 1, AgentCommand::Hover), (lands, AgentCommand::Land)] {
        let here = Pose { z_m: 2.0, ..TARGET };
        let mut bench = Bench::new(Percepts { wind: 0.7, pose: Some(here), ..HOVERING });
        assert!(bench.agent.achieve_land());
        assert_ne!(bench.step().0, Some(AgentCommand::Land));
        bench.percepts =
            Percepts { blind_for_ms: 400, battery_percent: Some(percent), ..bench.percepts };
        assert_eq!(bench.step().0, Some(command), "{percent} %");
    }
}

/// Repeated `land` orders do not prolong the descent.
#[test]
fn a_descent_that_is_ordered_again_ends_in_its_time() {
    let here = Pose { z_m: 2.0, ..TARGET };
    let mut bench = Bench::new(Percepts { wind: 0.7, pose: Some(here), ..HOVERING });
    let lands_after = (0..300).position(|_| {
        assert!(bench.agent.achieve_land());
        bench.step().0 == Some(AgentCommand::Land)
    });
    // 8 s in steps of 30 ms.
    assert_eq!(lands_after, Some(267));
}

#[test]
fn a_descent_can_end_on_the_ground() {
    let mut bench =
        Bench::new(Percepts { wind: 0.3, pose: Some(Pose { z_m: 2.0, ..TARGET }), ..HOVERING });
    assert!(bench.agent.achieve_land());
    bench.step();
    bench.percepts.on_ground = true;
    assert_eq!(bench.step(), (Some(AgentCommand::Standby), Some(Report::Done)));
}

#[test]
fn an_ordered_landing_comes_down_by_itself_where_it_blows() {
    let here = Pose { z_m: 1.5, ..TARGET };
    let down = AgentCommand::GoTo(Pose { z_m: 0.35, ..here });
    for (wind, blind_for_ms, command) in
        [(0.1, 0, AgentCommand::Land), (0.3, 0, down), (0.3, 400, AgentCommand::Land)]
    {
        let mut bench = Bench::new(HOVERING);
        bench.percepts = Percepts { wind, blind_for_ms, pose: Some(here), ..bench.percepts };
        assert!(bench.agent.achieve_land());
        assert_eq!(bench.step().0, Some(command), "{wind} {blind_for_ms}");
    }
}

/// The pre-flight check reserves this charge.
#[test]
fn the_charge_at_which_it_lands_is_the_one_that_is_kept_back() {
    let kept = LANDING_BATTERY_PERCENT;
    for (percent, lands) in [(kept, true), (kept + 1, false)] {
        let mut bench = Bench::new(HOVERING);
        bench.percepts.battery_percent = Some(percent);
        assert_eq!(bench.run().danger == Some(Danger::BatteryEmpty), lands, "{percent}");
    }
}

#[test]
fn a_blind_drone_holds_still_and_goes_on_when_it_sees() {
    let mut bench = Bench::new(HOVERING);
    bench.go_to(TARGET);
    bench.step();
    bench.percepts.blind_for_ms = 301;
    assert_eq!(bench.step(), (Some(AgentCommand::Hover), None));
    bench.percepts.blind_for_ms = 30;
    assert_eq!(bench.step(), (Some(AgentCommand::GoTo(TARGET)), None));
}

#[test]
fn a_low_battery_is_reported_once() {
    let mut bench = Bench::new(HOVERING);
    bench.percepts.battery_percent = Some(20);
    assert_eq!(bench.run().danger, Some(Danger::BatteryLow));
    assert_eq!(bench.run().danger, None);
}

#[test]
fn a_target_that_is_not_reached_in_its_time_is_given_up() {
    let mut bench = Bench::new(HOVERING);
    bench.go_to(TARGET);
    bench.step();
    bench.percepts.now_ms += 60_001;
    let step = bench.run();
    assert_eq!((step.command, step.danger), (Some(AgentCommand::Land), Some(Danger::NoProgress)));
}

#[test]
fn manual_control_comes_first() {
    let mut bench = Bench::new(HOVERING);
    bench.go_to(TARGET);
    bench.step();
    assert!(bench.agent.achieve_steer());
    bench.percepts.steering = true;
    assert_eq!(bench.step().0, Some(AgentCommand::Sticks));
    assert_eq!(bench.step().0, Some(AgentCommand::Sticks));
    let here = Pose { x_m: 0.3, ..TARGET };
    bench.percepts = Percepts { steering: false, pose: Some(here), ..bench.percepts };
    assert_eq!(bench.step().0, Some(AgentCommand::GoTo(here)), "it holds where it is");
    assert_eq!(bench.step().0, Some(AgentCommand::GoTo(here)));
    assert!(bench.agent.achieve_hold() && bench.agent.achieve_land());
    assert_eq!(bench.step().0, Some(AgentCommand::Land), "a landing comes before a hold");
}

/// Every order, given on the ground and in the air, while the drone then stays there or changes over.
#[test]
fn every_event_finds_a_plan() {
    for order in 0..5 {
        for (first, then) in
            [(GROUND, GROUND), (GROUND, HOVERING), (HOVERING, GROUND), (HOVERING, HOVERING)]
        {
            let mut bench = Bench::new(first);
            assert!(match order {
                0 => bench.agent.achieve_take_off(),
                1 => bench.agent.achieve_go_to(1.0, 0.0, 0.0, 0.0),
                2 => bench.agent.achieve_hold(),
                3 => bench.agent.achieve_steer(),
                _ => bench.agent.achieve_land(),
            });
            bench.step();
            bench.percepts = Percepts { now_ms: bench.percepts.now_ms, ..then };
            // Long enough for the agent to give up a take-off.
            for _ in 0..400 {
                bench.step();
            }
            assert_eq!(bench.agent.unhandled_events(), 0, "{order} {first:?} {then:?}");
        }
    }
}

#[test]
fn a_new_mission_ends_what_was_ordered_and_lifts_nothing() {
    let mut bench = Bench::new(GROUND);
    assert!(bench.agent.achieve_new_mission());
    assert_eq!(bench.step(), (Some(AgentCommand::Standby), None));
    bench.percepts = HOVERING;
    bench.go_to(TARGET);
    assert_eq!(bench.step().0, Some(AgentCommand::GoTo(TARGET)));
    assert!(bench.agent.achieve_new_mission());
    let here = HOVERING.pose.unwrap();
    for _ in 0..3 {
        assert_eq!(
            bench.step(),
            (Some(AgentCommand::GoTo(here)), None),
            "it holds, and reports nothing"
        );
    }
    bench.go_to(TARGET);
    assert_eq!(bench.step().0, Some(AgentCommand::GoTo(TARGET)));
}

#[test]
fn a_new_mission_takes_no_landing_back() {
    for wind in [0.0, 0.3] {
        let mut bench = Bench::new(HOVERING);
        bench.percepts.pose = Some(Pose { z_m: 1.0, ..TARGET });
        bench.percepts.wind = wind;
        assert!(bench.agent.achieve_land());
        bench.step();
        assert!(bench.agent.achieve_new_mission());
        for _ in 0..3 {
            assert_eq!(bench.step().0, Some(AgentCommand::Land), "in a wind of {wind}");
        }
        bench.percepts = GROUND;
        assert_eq!(bench.step(), (Some(AgentCommand::Standby), Some(Report::Done)));
        // The next flight does not continue that landing.
        assert!(bench.agent.achieve_take_off());
        assert_eq!(bench.step().0, Some(AgentCommand::TakeOff));
        bench.percepts = HOVERING;
        bench.step();
        assert!(bench.agent.achieve_new_mission());
        assert!(matches!(bench.step().0, Some(AgentCommand::GoTo(_))));
    }
}
