//! Setpoints that stop, and a ground station that falls silent.

use super::*;

const THERE: Pose = Pose { x_m: 0.5, y_m: 0.5, z_m: 1.0, yaw_deg: 10.0 };

/// Where the course has got to: a height and a heading that are wanted are not reached yet.
const REACHED: Pose = Pose { x_m: 0.2, y_m: 0.3, ..THERE };

fn following(age_ms: i64) -> Percepts {
    let setpoint = Some(SetpointPercept { pose: THERE, reached: REACHED, age_ms });
    Percepts { setpoint, ..HOVERING }
}

fn silent(silent_for_ms: i64, percepts: Percepts) -> Percepts {
    Percepts { station: StationPercepts { silent_for_ms, ..percepts.station }, ..percepts }
}

/// The hold after setpoints of a drone that is at `pose`.
fn held(pose: Pose) -> AgentCommand {
    AgentCommand::GoTo(Pose { x_m: REACHED.x_m, y_m: REACHED.y_m, ..pose })
}

#[test]
fn setpoints_are_followed_until_they_stop() {
    let mut bench = Bench::new(following(0));
    assert!(bench.agent.achieve_follow());
    let (there, here) = (AgentCommand::GoTo(THERE), HOVERING.pose.map(held));
    for age_ms in [0, 500] {
        bench.percepts.setpoint = following(age_ms).setpoint;
        assert_eq!(bench.step(), (Some(there), None));
    }
    // Blind for a moment, it waits for better.
    bench.percepts.blind_for_ms = 301;
    assert_eq!(bench.step(), (Some(AgentCommand::Hover), None));
    bench.percepts.blind_for_ms = 0;
    assert_eq!(bench.step(), (Some(there), None));
    bench.percepts.setpoint = following(501).setpoint;
    assert_eq!(bench.step(), (here, Some(Report::Paused)));
    // New ones alone are no order to fly on.
    bench.percepts.setpoint = following(0).setpoint;
    assert_eq!(bench.step(), (here, None));
    bench.percepts.setpoint = following(10_500).setpoint;
    assert_eq!(bench.step(), (here, None));
    bench.percepts.setpoint = following(10_501).setpoint;
    let step = bench.run();
    assert_eq!(
        (step.command, step.danger),
        (Some(AgentCommand::Land), Some(Danger::SetpointsGone))
    );
}

#[test]
fn setpoints_are_not_followed_on_the_ground_or_while_landing() {
    let mut bench = Bench::new(Percepts { setpoint: following(0).setpoint, ..GROUND });
    assert!(bench.agent.achieve_follow());
    assert_eq!(bench.step(), (Some(AgentCommand::Standby), None));
    bench.percepts = following(0);
    assert!(bench.agent.achieve_land());
    assert_eq!(bench.step().0, Some(AgentCommand::Land));
    assert!(bench.agent.achieve_follow());
    assert_eq!(bench.step().0, Some(AgentCommand::Land));
}

#[test]
fn a_silent_station_is_told_then_stops_the_mission_and_then_lands() {
    let mut bench = Bench::new(HOVERING);
    bench.go_to(TARGET);
    let there = Some(AgentCommand::GoTo(TARGET));
    let here = HOVERING.pose.map(AgentCommand::GoTo);
    for (silent_ms, command, report, danger) in [
        (3000, there, None, None),
        (3001, there, None, Some(Danger::StationSilent)),
        (10_000, there, None, Some(Danger::StationSilent)),
        (10_001, here, Some(Report::Paused), Some(Danger::StationSilent)),
        // Heard again, it waits to be told.
        (0, here, None, None),
        (20_000, here, None, Some(Danger::StationSilent)),
        (20_001, Some(AgentCommand::Land), None, Some(Danger::StationGone)),
        (0, Some(AgentCommand::Land), None, None),
    ] {
        bench.percepts = silent(silent_ms, bench.percepts);
        let step = bench.run();
        let found = (step.command, step.report, step.danger);
        assert_eq!(found, (command, report, danger), "{silent_ms}");
    }
}

#[test]
fn the_times_can_be_shorter() {
    let mut bench = Bench::new(HOVERING);
    bench.go_to(TARGET);
    let station = StationPercepts { silent_for_ms: 1001, hold_after_ms: 1000, land_after_ms: 2000 };
    bench.percepts.station = station;
    assert_eq!(bench.step().1, Some(Report::Paused));
    bench.percepts.station = StationPercepts { silent_for_ms: 2001, ..station };
    assert_eq!(bench.run().danger, Some(Danger::StationGone));
}

/// Whatever it was doing, it holds; what waits is offered again later.
#[test]
fn nothing_leads_anywhere_for_a_silent_station() {
    for (name, mut bench) in in_the_air() {
        bench.percepts = silent(10_001, bench.percepts);
        let here = bench.percepts.pose.map(AgentCommand::GoTo);
        let waits = matches!(name, "approach" | "stay");
        let held = (here, waits.then_some(Report::Paused));
        match name {
            "take-off" => assert_eq!(bench.step().0, Some(AgentCommand::TakeOff), "{name}"),
            "wait" => assert_eq!(bench.step().0, Some(AgentCommand::Hover), "{name}"),
            _ => assert_eq!(bench.step(), held, "{name}"),
        }
    }
    let mut bench = Bench::new(silent(10_001, following(0)));
    let here = HOVERING.pose.map(AgentCommand::GoTo);
    bench.go_to(TARGET);
    assert_eq!(bench.step(), (here, Some(Report::Paused)));
    assert!(bench.agent.achieve_follow());
    assert_eq!(bench.step(), (here, Some(Report::Paused)));
    bench.percepts.steering = true;
    assert!(bench.agent.achieve_steer());
    assert_eq!(bench.step(), (here, None));
    assert!(bench.agent.achieve_find_tag());
    assert_eq!(bench.step(), (here, Some(Report::Paused)));
    assert!(bench.agent.achieve_land_on_tag());
    assert_eq!(bench.step(), (here, Some(Report::Paused)));
}
