//! The agent: `agent/autopilot.asl`, translated to C, behind a safe interface.
//!
//! [`AgentStep`] is what the agent sees and does in one step. This is the only file with `unsafe`
//! code: the bindings that the translator generates, each block with its argument.

use pid::Pose;

use crate::agent::bindings::{Beliefs, Environment};

#[allow(
    unsafe_code,
    unnameable_types,
    clippy::pedantic,
    reason = "generated: the Rust side of the C boundary"
)]
mod bindings {
    include!(concat!(env!("OUT_DIR"), "/bindings.rs"));
}

pub use bindings::{Agent, STATE_BYTES};

/// How orders are flown; plans can change it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ApproachSettings {
    /// A target is reached within this distance.
    pub reach_distance_m: f64,
    /// While staying at a target the drone may be this far from it.
    pub stay_distance_m: f64,
    /// How long the drone stays at a target.
    pub stay_time_ms: i64,
}

impl Default for ApproachSettings {
    /// The defaults of `tum_ardrone`.
    fn default() -> Self {
        Self { reach_distance_m: 0.2, stay_distance_m: 0.5, stay_time_ms: 2000 }
    }
}

/// A target's heading is reached within this angle.
const REACH_ANGLE_DEG: f64 = 5.0;

/// What the agent can know in one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Senses {
    /// Milliseconds since the program started.
    pub now_ms: i64,
    /// Where the drone is, once it is known.
    pub pose: Option<Pose>,
    /// The drone says that it has landed.
    pub on_ground: bool,
    /// The drone says that it hovers or flies.
    pub hovering: bool,
    /// Charge, once it is known.
    pub battery_percent: Option<u32>,
    /// Milliseconds since the newest navdata that could be believed.
    pub blind_for_ms: i64,
    /// Standard deviation of the place.
    pub doubt_m: f64,
    /// What pushes the drone, as a share of what full tilt gives.
    pub wind: f64,
    /// The pilot moves the sticks.
    pub steering: bool,
    /// How orders are flown.
    pub settings: ApproachSettings,
}

/// What the agent wants the drone to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AgentCommand {
    /// Stay on the ground.
    Standby,
    /// Take off.
    TakeOff,
    /// Stay in the air and hold still.
    Hover,
    /// Fly towards a pose.
    GoTo(Pose),
    /// Fly as the pilot moves the sticks.
    Sticks,
    /// Land.
    Land,
}

/// Why the agent lands, or warns that it soon will.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Danger {
    /// The battery will soon be empty: a warning.
    BatteryLow,
    /// The battery is nearly empty.
    BatteryEmpty,
    /// No navdata that could be believed.
    Blind,
    /// The place is not known well enough.
    Lost,
    /// The wind is stronger than the drone.
    Wind,
    /// A target was not reached in its time.
    NoProgress,
}

/// How the agent's last order ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Report {
    /// It was carried out.
    Done,
    /// It cannot be carried out now.
    Refused,
    /// It was tried and did not succeed.
    Failed,
}

/// One step of the agent: what it senses, and what it decided.
#[derive(Debug)]
pub struct AgentStep {
    senses: Senses,
    /// What it wants the drone to do; the last word counts.
    pub command: Option<AgentCommand>,
    /// How many commands it issued; always one.
    pub commands: u32,
    /// What it said of its last order.
    pub report: Option<Report>,
    /// What it said of the flight.
    pub danger: Option<Danger>,
}

impl AgentStep {
    /// Runs one deliberation cycle of `agent`.
    pub fn run(agent: &mut Agent, senses: Senses) -> Self {
        let mut step = Self { senses, command: None, commands: 0, report: None, danger: None };
        agent.next_step(&mut step);
        step
    }

    fn issue(&mut self, command: AgentCommand) {
        self.command = Some(command);
        self.commands += 1;
    }
}

impl Environment for AgentStep {
    fn update_beliefs(&mut self, beliefs: &mut Beliefs<'_>) {
        if let Some(pose) = self.senses.pose {
            beliefs.set_position(pose.x_m, pose.y_m, pose.z_m, pose.yaw_deg);
        }
        if let Some(percent) = self.senses.battery_percent {
            beliefs.set_battery(percent.into());
        }
        beliefs.set_blind_for(self.senses.blind_for_ms);
        beliefs.set_doubt(self.senses.doubt_m);
        beliefs.set_wind(self.senses.wind);
        let settings = self.senses.settings;
        beliefs.set_reach_distance(settings.reach_distance_m);
        beliefs.set_stay_distance(settings.stay_distance_m);
        beliefs.set_stay_time(settings.stay_time_ms);
    }

    fn send_standby(&mut self) {
        self.issue(AgentCommand::Standby);
    }

    fn send_take_off(&mut self) {
        self.issue(AgentCommand::TakeOff);
    }

    fn send_hover(&mut self) {
        self.issue(AgentCommand::Hover);
    }

    fn send_goto(&mut self, x_m: f64, y_m: f64, z_m: f64, yaw_deg: f64) {
        self.issue(AgentCommand::GoTo(Pose { x_m, y_m, z_m, yaw_deg }));
    }

    fn send_descent(&mut self, x_m: f64, y_m: f64, z_m: f64, yaw_deg: f64) {
        self.issue(AgentCommand::GoTo(Pose { x_m, y_m, z_m, yaw_deg }));
    }

    fn send_sticks(&mut self) {
        self.issue(AgentCommand::Sticks);
    }

    fn send_land(&mut self) {
        self.issue(AgentCommand::Land);
    }

    fn on_ground(&mut self) -> bool {
        self.senses.on_ground
    }

    fn hovering(&mut self) -> bool {
        self.senses.hovering
    }

    fn steering(&mut self) -> bool {
        self.senses.steering
    }

    fn close_enough(
        &mut self,
        x_m: f64,
        y_m: f64,
        z_m: f64,
        yaw_deg: f64,
        distance_m: f64,
    ) -> bool {
        let target = Pose { x_m, y_m, z_m, yaw_deg };
        self.senses.pose.is_some_and(|pose| {
            distance(&pose, &target) <= distance_m
                && estimator::wrap_deg(yaw_deg - pose.yaw_deg).abs() <= REACH_ANGLE_DEG
        })
    }

    fn get_current_time_ms(&mut self) -> i64 {
        self.senses.now_ms
    }

    fn long_enough(&mut self, since_ms: i64, time_ms: i64) -> bool {
        self.senses.now_ms.saturating_sub(since_ms) > time_ms
    }

    fn report_done(&mut self) {
        self.report = Some(Report::Done);
    }

    fn report_refused(&mut self) {
        self.report = Some(Report::Refused);
    }

    fn report_failed(&mut self) {
        self.report = Some(Report::Failed);
    }

    fn tell_battery_low(&mut self) {
        self.danger = Some(Danger::BatteryLow);
    }

    fn tell_battery_empty(&mut self) {
        self.danger = Some(Danger::BatteryEmpty);
    }

    fn tell_blind(&mut self) {
        self.danger = Some(Danger::Blind);
    }

    fn tell_lost(&mut self) {
        self.danger = Some(Danger::Lost);
    }

    fn tell_wind(&mut self) {
        self.danger = Some(Danger::Wind);
    }

    fn tell_no_progress(&mut self) {
        self.danger = Some(Danger::NoProgress);
    }
}

/// The distance between two places; headings don't count.
pub fn distance(a: &Pose, b: &Pose) -> f64 {
    (a.x_m - b.x_m).hypot(a.y_m - b.y_m).hypot(a.z_m - b.z_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GROUND: Senses = Senses {
        now_ms: 0,
        pose: Some(Pose { x_m: 0.0, y_m: 0.0, z_m: 0.0, yaw_deg: 0.0 }),
        on_ground: true,
        hovering: false,
        battery_percent: Some(80),
        blind_for_ms: 0,
        doubt_m: 0.1,
        wind: 0.0,
        steering: false,
        settings: ApproachSettings {
            reach_distance_m: 0.2,
            stay_distance_m: 0.5,
            stay_time_ms: 2000,
        },
    };
    const HOVERING: Senses = Senses { on_ground: false, hovering: true, ..GROUND };
    const TARGET: Pose = Pose { x_m: 1.0, y_m: 0.0, z_m: 0.0, yaw_deg: 0.0 };

    /// The state is all the memory that the agent uses; it must not grow unseen.
    const _: () = assert!(STATE_BYTES <= 512);

    /// An agent and what it senses.
    struct Bench {
        agent: Agent,
        senses: Senses,
    }

    impl Bench {
        /// An agent that already waits: its initial goal took the first step.
        fn new(senses: Senses) -> Self {
            let mut bench = Self { agent: Agent::new(), senses };
            bench.step();
            bench
        }

        fn step(&mut self) -> (Option<AgentCommand>, Option<Report>) {
            let step = self.run();
            assert_eq!(step.commands, 1, "exactly one AT command a step");
            (step.command, step.report)
        }

        fn run(&mut self) -> AgentStep {
            let step = AgentStep::run(&mut self.agent, self.senses);
            self.senses.now_ms += 30;
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
        bench.senses = HOVERING;
        assert_eq!(bench.step(), (Some(AgentCommand::Hover), None));
    }

    #[test]
    fn it_takes_off_until_the_drone_hovers_and_then_holds_the_place() {
        let mut bench = Bench::new(GROUND);
        assert!(bench.agent.achieve_take_off());
        assert!(!bench.agent.can_add_event());
        assert_eq!(bench.step(), (Some(AgentCommand::TakeOff), None));
        assert_eq!(bench.step(), (Some(AgentCommand::TakeOff), None));
        bench.senses = Senses { pose: Some(TARGET), now_ms: 3000, ..HOVERING };
        let hold = Some(AgentCommand::GoTo(TARGET));
        assert_eq!(bench.step(), (hold, Some(Report::Done)));
        assert_eq!(bench.step(), (hold, None));
    }

    #[test]
    fn a_take_off_that_does_not_succeed_is_given_up() {
        let mut bench = Bench::new(GROUND);
        assert!(bench.agent.achieve_take_off());
        bench.step();
        bench.senses.now_ms = 10_031;
        assert_eq!(bench.step(), (Some(AgentCommand::Land), Some(Report::Failed)));
        assert_eq!(bench.step(), (Some(AgentCommand::Standby), Some(Report::Done)));
    }

    #[test]
    fn it_reaches_stays_and_reports() {
        let mut bench = Bench::new(HOVERING);
        bench.go_to(TARGET);
        let approach = (Some(AgentCommand::GoTo(TARGET)), None);
        assert_eq!(bench.step(), approach);
        assert_eq!(bench.step(), approach);
        bench.senses.pose = Some(TARGET);
        assert_eq!(bench.step(), approach);
        bench.senses.now_ms += 1900;
        assert_eq!(bench.step(), approach);
        // Drifting off starts the stay anew.
        bench.senses.pose = Some(Pose { x_m: 0.4, ..TARGET });
        assert_eq!(bench.step(), approach);
        bench.senses.pose = Some(TARGET);
        assert_eq!(bench.step(), approach);
        bench.senses.now_ms += 1900;
        assert_eq!(bench.step(), approach);
        bench.senses.now_ms += 200;
        assert_eq!(bench.step(), (approach.0, Some(Report::Done)));
        assert_eq!(bench.step(), approach);
    }

    #[test]
    fn a_heading_across_the_jump_is_close() {
        let mut bench = Bench::new(HOVERING);
        let target = Pose { yaw_deg: 181.0, ..TARGET };
        bench.senses.pose = Some(Pose { yaw_deg: -178.0, ..TARGET });
        bench.go_to(target);
        bench.step();
        bench.step();
        bench.senses.now_ms += 2100;
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
        bench.senses = GROUND;
        assert_eq!(bench.step(), (Some(AgentCommand::Standby), Some(Report::Done)));
        // The old target is forgotten: the next take-off holds the new place.
        bench.senses = HOVERING;
        assert_eq!(bench.step(), (Some(AgentCommand::Hover), None));
    }

    #[test]
    fn a_drone_that_lands_by_itself_is_not_lifted_again() {
        let mut bench = Bench::new(HOVERING);
        bench.go_to(TARGET);
        bench.step();
        bench.senses = GROUND;
        assert_eq!(bench.step(), (Some(AgentCommand::Standby), Some(Report::Failed)));
        bench.go_to(TARGET);
        assert_eq!(bench.step(), (Some(AgentCommand::Standby), Some(Report::Refused)));
    }

    /// Brings a drone into the air by each goal that can run there.
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
            bench.senses.steering = name == "steer";
            if name == "stay" {
                bench.senses.pose = Some(TARGET);
            }
            for _ in 0..5 {
                bench.step();
            }
            bench.senses.on_ground = false;
            benches.push((name, bench));
        }
        benches
    }

    #[test]
    fn each_danger_lands_whatever_runs_and_is_told() {
        for danger in [Danger::BatteryEmpty, Danger::Blind, Danger::Lost, Danger::Wind] {
            for (name, mut bench) in in_the_air() {
                let senses = bench.senses;
                bench.senses = match danger {
                    Danger::BatteryEmpty => Senses { battery_percent: Some(12), ..senses },
                    Danger::Blind => Senses { blind_for_ms: 2001, ..senses },
                    Danger::Lost => Senses { doubt_m: 3.1, ..senses },
                    // It comes down by itself first, unless it is low already.
                    _ => Senses {
                        wind: 0.81,
                        pose: senses.pose.map(|pose| Pose { z_m: 0.3, ..pose }),
                        ..senses
                    },
                };
                let step = bench.run();
                let said = (step.command, step.danger, step.commands);
                assert_eq!(said, (Some(AgentCommand::Hover), Some(danger), 1), "{name}");
                assert_eq!(bench.step().0, Some(AgentCommand::Land), "{name}");
                assert_eq!(bench.step().0, Some(AgentCommand::Land), "{name}");
            }
        }
        for (name, mut bench) in in_the_air() {
            assert_ne!(bench.step().0, Some(AgentCommand::Land), "{name}: nothing is wrong");
        }
    }

    #[test]
    fn in_the_wind_it_comes_down_where_it_is_before_it_lands() {
        let mut bench = Bench::new(HOVERING);
        bench.go_to(TARGET);
        bench.step();
        let here = Pose { x_m: 0.3, z_m: 2.0, ..TARGET };
        bench.senses = Senses { wind: 0.9, pose: Some(here), ..bench.senses };
        let down = Some(AgentCommand::GoTo(Pose { z_m: 0.35, ..here }));
        assert_eq!(bench.step().0, Some(AgentCommand::Hover));
        assert_eq!(bench.step().0, down);
        assert_eq!(bench.step().0, down);
        bench.senses.pose = Some(Pose { z_m: 0.4, ..here });
        assert_eq!(bench.step().0, Some(AgentCommand::Land));
        // Not for ever, and not blindly.
        for (later_ms, blind_for_ms) in [(9000, 0), (30, 2001)] {
            let mut bench = Bench::new(HOVERING);
            bench.senses = Senses { wind: 0.9, pose: Some(here), ..bench.senses };
            bench.step();
            assert_eq!(bench.step().0, down);
            bench.senses.blind_for_ms = 400;
            assert_eq!(bench.step().0, Some(AgentCommand::Hover));
            bench.senses =
                Senses { now_ms: bench.senses.now_ms + later_ms, blind_for_ms, ..bench.senses };
            assert_eq!(bench.step().0, Some(AgentCommand::Land));
        }
    }

    #[test]
    fn an_ordered_landing_comes_down_by_itself_where_it_blows() {
        let here = Pose { z_m: 1.5, ..TARGET };
        let down = AgentCommand::GoTo(Pose { z_m: 0.35, ..here });
        for (wind, blind_for_ms, command) in
            [(0.1, 0, AgentCommand::Land), (0.3, 0, down), (0.3, 400, AgentCommand::Land)]
        {
            let mut bench = Bench::new(HOVERING);
            bench.senses = Senses { wind, blind_for_ms, pose: Some(here), ..bench.senses };
            assert!(bench.agent.achieve_land());
            assert_eq!(bench.step().0, Some(command), "{wind} {blind_for_ms}");
        }
    }

    /// The pre-flight check reckons with it.
    #[test]
    fn the_charge_at_which_it_lands_is_the_one_that_is_kept_back() {
        let kept = crate::pilot::LANDING_BATTERY_PERCENT;
        for (percent, lands) in [(kept, true), (kept + 1, false)] {
            let mut bench = Bench::new(HOVERING);
            bench.senses.battery_percent = Some(percent);
            assert_eq!(bench.run().danger == Some(Danger::BatteryEmpty), lands, "{percent}");
        }
    }

    #[test]
    fn a_blind_drone_holds_still_and_goes_on_when_it_sees() {
        let mut bench = Bench::new(HOVERING);
        bench.go_to(TARGET);
        bench.step();
        bench.senses.blind_for_ms = 301;
        assert_eq!(bench.step(), (Some(AgentCommand::Hover), None));
        bench.senses.blind_for_ms = 30;
        assert_eq!(bench.step(), (Some(AgentCommand::GoTo(TARGET)), None));
    }

    #[test]
    fn a_low_battery_is_told_once() {
        let mut bench = Bench::new(HOVERING);
        bench.senses.battery_percent = Some(20);
        assert_eq!(bench.run().danger, Some(Danger::BatteryLow));
        assert_eq!(bench.run().danger, None);
    }

    #[test]
    fn a_target_that_is_not_reached_in_its_time_is_given_up() {
        let mut bench = Bench::new(HOVERING);
        bench.go_to(TARGET);
        bench.step();
        bench.senses.now_ms += 60_001;
        let step = bench.run();
        assert_eq!(
            (step.command, step.danger),
            (Some(AgentCommand::Land), Some(Danger::NoProgress))
        );
    }

    #[test]
    fn the_pilots_hand_comes_first() {
        let mut bench = Bench::new(HOVERING);
        bench.go_to(TARGET);
        bench.step();
        assert!(bench.agent.achieve_steer());
        bench.senses.steering = true;
        assert_eq!(bench.step().0, Some(AgentCommand::Sticks));
        assert_eq!(bench.step().0, Some(AgentCommand::Sticks));
        let here = Pose { x_m: 0.3, ..TARGET };
        bench.senses = Senses { steering: false, pose: Some(here), ..bench.senses };
        assert_eq!(bench.step().0, Some(AgentCommand::GoTo(here)), "it holds where it is");
        assert_eq!(bench.step().0, Some(AgentCommand::GoTo(here)));
        assert!(bench.agent.achieve_hold() && bench.agent.achieve_land());
        assert_eq!(bench.step().0, Some(AgentCommand::Land), "a landing comes before a hold");
    }

    /// Every order, given on the ground and in the air, while the drone then stays or changes over.
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
                bench.senses = Senses { now_ms: bench.senses.now_ms, ..then };
                // Long enough for a take-off to be given up.
                for _ in 0..400 {
                    bench.step();
                }
                assert_eq!(bench.agent.unhandled_events(), 0, "{order} {first:?} {then:?}");
            }
        }
    }
}
