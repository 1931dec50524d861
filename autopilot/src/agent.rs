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

mod source;

pub use bindings::{Agent, PLANS, STATE_BYTES};
pub use source::{SOURCE, plan_text};

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

/// Charge at which the agent lands: its belief `landingBattery`.
pub const LANDING_BATTERY_PERCENT: u32 = 12;

/// A target's heading is reached within this angle.
const REACH_ANGLE_DEG: f64 = 5.0;

/// What the agent can know in one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Percepts {
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
    pub position_sd_m: f64,
    /// Milliseconds for which the sticks have been at their limit while the drone came no nearer to where
    /// it is sent.
    pub saturated_for_ms: i64,
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

impl AgentCommand {
    /// What it is called in the agent, without `send`.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Standby => "Standby",
            Self::TakeOff => "TakeOff",
            Self::Hover => "Hover",
            Self::GoTo(_) => "Goto",
            Self::Sticks => "Sticks",
            Self::Land => "Land",
        }
    }
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
    /// A take-off, or the way to a target, was not done in its time.
    NoProgress,
}

impl Danger {
    /// Its name in logs.
    pub fn name(self) -> &'static str {
        match self {
            Self::BatteryLow => "BatteryLow",
            Self::BatteryEmpty => "BatteryEmpty",
            Self::Blind => "Blind",
            Self::Lost => "Lost",
            Self::Wind => "Wind",
            Self::NoProgress => "NoProgress",
        }
    }
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

impl Report {
    /// Its name in logs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Done => "Done",
            Self::Refused => "Refused",
            Self::Failed => "Failed",
        }
    }
}

/// What the agent makes the drone do that takes its time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Pursuit {
    TakingOff,
    Approaching,
    Staying,
    Descending,
}

/// What the agent has been making the drone do, and for how long: the agent is told that, and knows no
/// other clock. That it hovers meanwhile does not end it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Activity {
    /// And the milliseconds at its first command.
    pursuit: Option<(Pursuit, i64)>,
    /// How long the drone had approached its target before it last arrived there. A drone that arrives
    /// and drifts off again and again would else never be given up.
    approached_ms: i64,
}

impl Activity {
    /// How long this has lasted, in milliseconds; 0 if something else goes on.
    fn lasted_ms(self, pursuit: Pursuit, now_ms: i64) -> i64 {
        let Some((current, since_ms)) = self.pursuit else { return 0 };
        let lasted_ms = now_ms.saturating_sub(since_ms);
        match pursuit {
            _ if current != pursuit => 0,
            Pursuit::Approaching => lasted_ms.saturating_add(self.approached_ms),
            Pursuit::TakingOff | Pursuit::Staying | Pursuit::Descending => lasted_ms,
        }
    }

    fn go_on(&mut self, pursuit: Pursuit, now_ms: i64) {
        let current = self.pursuit.map(|(current, _)| current);
        if current == Some(pursuit) {
            return;
        }
        if current == Some(Pursuit::Approaching) {
            self.approached_ms = self.lasted_ms(Pursuit::Approaching, now_ms);
        }
        self.pursuit = Some((pursuit, now_ms));
    }
}

/// One step of the agent: what it senses, and what it decided.
#[derive(Debug)]
pub struct AgentStep {
    percepts: Percepts,
    activity: Activity,
    /// What it wants the drone to do; the last word counts.
    pub command: Option<AgentCommand>,
    /// How many commands it issued; always one.
    pub commands: u32,
    /// What it said of its last order.
    pub report: Option<Report>,
    /// What it said of the flight.
    pub danger: Option<Danger>,
    /// The plans that it chose.
    pub plans: ChosenPlans,
}

/// The plans of one step in the order in which they were chosen, as indices into [`PLANS`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ChosenPlans {
    numbers: [u32; Self::MOST],
    count: usize,
}

impl ChosenPlans {
    /// A step of this agent chooses at most four: for its event, to watch, to mend, and to go down. What is
    /// beyond this is forgotten.
    const MOST: usize = 8;

    /// Their numbers.
    pub fn numbers(&self) -> &[u32] {
        &self.numbers[..self.count]
    }

    /// The first line of each in the agent's source, and its trigger.
    pub fn places(&self) -> impl Iterator<Item = (u32, &'static str)> + '_ {
        let plan = |number: &u32| PLANS.get(usize::try_from(*number).ok()?).copied();
        self.numbers().iter().filter_map(plan)
    }

    fn push(&mut self, number: u32) {
        if let Some(place) = self.numbers.get_mut(self.count) {
            *place = number;
            self.count += 1;
        }
    }
}

impl AgentStep {
    /// Runs one deliberation cycle of `agent`, which goes on with its `activity`.
    pub fn run(agent: &mut Agent, activity: &mut Activity, percepts: Percepts) -> Self {
        let mut step = Self {
            percepts,
            activity: *activity,
            command: None,
            commands: 0,
            report: None,
            danger: None,
            plans: ChosenPlans::default(),
        };
        agent.next_step(&mut step);
        *activity = step.activity;
        step
    }

    fn issue(&mut self, command: AgentCommand) {
        self.command = Some(command);
        self.commands += 1;
    }

    /// A command of something that takes its time.
    fn pursue(&mut self, pursuit: Pursuit, command: AgentCommand) {
        self.activity.go_on(pursuit, self.percepts.now_ms);
        self.issue(command);
    }

    /// A command that ends whatever went on.
    fn end(&mut self, command: AgentCommand) {
        self.activity = Activity::default();
        self.issue(command);
    }
}

impl Environment for AgentStep {
    fn update_beliefs(&mut self, beliefs: &mut Beliefs<'_>) {
        if let Some(pose) = self.percepts.pose {
            beliefs.set_position(pose.x_m, pose.y_m, pose.z_m, pose.yaw_deg);
        }
        if let Some(percent) = self.percepts.battery_percent {
            beliefs.set_battery(percent.into());
        }
        beliefs.set_blind_for(self.percepts.blind_for_ms);
        beliefs.set_doubt(self.percepts.position_sd_m);
        beliefs.set_saturated_for(self.percepts.saturated_for_ms);
        beliefs.set_wind(self.percepts.wind);
        let lasted_ms = |pursuit| self.activity.lasted_ms(pursuit, self.percepts.now_ms);
        beliefs.set_taking_off_for(lasted_ms(Pursuit::TakingOff));
        beliefs.set_approaching_for(lasted_ms(Pursuit::Approaching));
        beliefs.set_staying_for(lasted_ms(Pursuit::Staying));
        beliefs.set_descending_for(lasted_ms(Pursuit::Descending));
        let settings = self.percepts.settings;
        beliefs.set_reach_distance(settings.reach_distance_m);
        beliefs.set_stay_distance(settings.stay_distance_m);
        beliefs.set_stay_time(settings.stay_time_ms);
    }

    fn send_standby(&mut self) {
        self.end(AgentCommand::Standby);
    }

    fn send_take_off(&mut self) {
        self.pursue(Pursuit::TakingOff, AgentCommand::TakeOff);
    }

    fn send_take_off_again(&mut self) {
        self.pursue(Pursuit::TakingOff, AgentCommand::TakeOff);
    }

    fn send_hover(&mut self) {
        self.issue(AgentCommand::Hover);
    }

    fn send_goto(&mut self, x_m: f64, y_m: f64, z_m: f64, yaw_deg: f64) {
        self.activity = Activity::default();
        self.send_goto_again(x_m, y_m, z_m, yaw_deg);
    }

    fn send_goto_again(&mut self, x_m: f64, y_m: f64, z_m: f64, yaw_deg: f64) {
        let target = Pose { x_m, y_m, z_m, yaw_deg };
        self.pursue(Pursuit::Approaching, AgentCommand::GoTo(target));
    }

    fn send_stay(&mut self, x_m: f64, y_m: f64, z_m: f64, yaw_deg: f64) {
        let target = Pose { x_m, y_m, z_m, yaw_deg };
        self.pursue(Pursuit::Staying, AgentCommand::GoTo(target));
    }

    fn send_sticks(&mut self) {
        self.end(AgentCommand::Sticks);
    }

    fn send_descent(&mut self, x_m: f64, y_m: f64, z_m: f64, yaw_deg: f64) {
        let target = Pose { x_m, y_m, z_m, yaw_deg };
        self.pursue(Pursuit::Descending, AgentCommand::GoTo(target));
    }

    fn send_pause(&mut self) {
        self.pursue(Pursuit::Descending, AgentCommand::Hover);
    }

    fn send_land(&mut self) {
        self.end(AgentCommand::Land);
    }

    fn on_ground(&mut self) -> bool {
        self.percepts.on_ground
    }

    fn hovering(&mut self) -> bool {
        self.percepts.hovering
    }

    fn steering(&mut self) -> bool {
        self.percepts.steering
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
        self.percepts.pose.is_some_and(|pose| {
            distance(&pose, &target) <= distance_m
                && estimator::wrap_deg(yaw_deg - pose.yaw_deg).abs() <= REACH_ANGLE_DEG
        })
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

    fn trace_plan(&mut self, number: u32) {
        self.plans.push(number);
    }
}

/// The distance between two places; headings don't count.
pub fn distance(a: &Pose, b: &Pose) -> f64 {
    (a.x_m - b.x_m).hypot(a.y_m - b.y_m).hypot(a.z_m - b.z_m)
}

#[cfg(test)]
mod tests;
