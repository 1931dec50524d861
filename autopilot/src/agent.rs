//! The agent: `agent/autopilot.asl`, translated to C, behind a safe interface.
//!
//! [`AgentStep`] runs one deliberation cycle. This is the only file with `unsafe` code: the bindings that the
//! translator generates, each block with a comment on its soundness.

use kinematics::Pose;

use crate::agent::bindings::{Beliefs, Environment};
use crate::fence::FlightLimits;

#[allow(
    unsafe_code,
    unnameable_types,
    clippy::pedantic,
    reason = "generated: the Rust side of the C boundary"
)]
mod bindings {
    include!(concat!(env!("OUT_DIR"), "/bindings.rs"));
}

mod activity;
mod said;
mod source;
mod tags;

pub use activity::Activity;
use activity::Pursuit;
pub use bindings::{Agent, PLANS, STATE_BYTES};
pub use said::{Danger, Report};
pub use source::{SOURCE, plan_text};
pub use tags::TagPercepts;
use tags::place_to_look_from;

/// Parameters of approaching and holding a target; plans can change them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ApproachSettings {
    /// A target is reached within this distance, in metres.
    pub reach_distance_m: f64,
    /// Largest distance from the target while staying at it, in metres.
    pub stay_distance_m: f64,
    /// Stay time at a target, in milliseconds.
    pub stay_time_ms: i64,
}

impl Default for ApproachSettings {
    /// The defaults of `tum_ardrone`.
    fn default() -> Self {
        Self { reach_distance_m: 0.2, stay_distance_m: 0.5, stay_time_ms: 2000 }
    }
}

/// Charge at which the agent lands, in percent: its belief `landingBattery`.
pub const LANDING_BATTERY_PERCENT: u32 = 12;

/// Charge from which the agent warns, in percent: its belief `warningBattery`.
pub const WARNING_BATTERY_PERCENT: u32 = 20;

/// Heading tolerance for reaching a target, in degrees.
const REACH_ANGLE_DEG: f64 = 5.0;

/// A tag whose place has turned out to be this far from where it seemed, in metres, is elsewhere.
const NEAR_TAG_M: f64 = 0.05;
/// Largest horizontal speed of a drone that is steady, in m/s.
const STEADY_M_S: f64 = 0.08;

/// The agent's inputs in one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Percepts {
    /// Time since the program started, in milliseconds.
    pub now_ms: i64,
    /// Predicted pose; `None` until it is known.
    pub pose: Option<Pose>,
    /// The drone reports that it has landed.
    pub on_ground: bool,
    /// The drone reports that it hovers or flies.
    pub hovering: bool,
    /// Remaining charge; `None` until it is known.
    pub battery_percent: Option<u32>,
    /// Time since the newest plausible navdata, in milliseconds.
    pub blind_for_ms: i64,
    /// Position uncertainty: standard deviation on the worse horizontal axis, in metres.
    pub uncertainty_m: f64,
    /// How long the sticks have been at their limit without progress towards the target, in milliseconds.
    pub saturated_for_ms: i64,
    /// What lasts of the wind's disturbance, as a fraction of the acceleration at full tilt.
    pub wind: f64,
    /// An operator flies by stick.
    pub steering: bool,
    /// The setpoints that an operator sends; `None` if they are not followed.
    pub setpoint: Option<SetpointPercept>,
    /// Whether the operator's ground station can be heard.
    pub station: StationPercepts,
    /// Parameters of approaching and holding a target.
    pub settings: ApproachSettings,
    /// Horizontal speed in m/s.
    pub speed_m_s: f64,
    /// The fence, within which tags are looked for.
    pub fence: FlightLimits,
    /// What is known of tags; `None` if they are not in use.
    pub tags: Option<TagPercepts>,
}

/// The setpoints that are followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SetpointPercept {
    /// Where they want the drone now.
    pub pose: Pose,
    /// Where the way there has got to: the drone is held there if it is told to hold.
    pub reached: Pose,
    /// Time since the last one, in milliseconds.
    pub age_ms: i64,
}

/// What is known of the ground station that has the controls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StationPercepts {
    /// Time since it was heard, in milliseconds; 0 if no station has the controls that must be heard.
    pub silent_for_ms: i64,
    /// The drone holds after a silence of this length, in milliseconds.
    pub hold_after_ms: i64,
    /// It lands after a silence of this length, in milliseconds.
    pub land_after_ms: i64,
}

/// The agent's command to the drone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AgentCommand {
    /// Stay on the ground.
    Standby,
    /// Take off.
    TakeOff,
    /// Hold position in the air.
    Hover,
    /// Fly towards a pose.
    GoTo(Pose),
    /// Fly by the operator's sticks.
    Sticks,
    /// Land.
    Land,
}

impl AgentCommand {
    /// The name of its action in the agent, without `send`.
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

/// One step of the agent: its percepts and its decisions.
#[derive(Debug)]
pub struct AgentStep {
    percepts: Percepts,
    activity: Activity,
    /// The command to the drone; the last one issued.
    pub command: Option<AgentCommand>,
    /// Number of commands issued in the step; always one.
    pub commands: u32,
    /// How the last order ended, if it ended in this step.
    pub report: Option<Report>,
    /// Danger reported in this step.
    pub danger: Option<Danger>,
    /// Plans chosen in this step.
    pub plans: ChosenPlans,
}

/// Plans of one step in the order in which they were chosen, as indices into [`PLANS`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ChosenPlans {
    numbers: [u32; Self::MOST],
    count: usize,
}

impl ChosenPlans {
    /// Capacity. A step of this agent chooses at most five plans: for its event, for watching, for where to
    /// search, for correcting, and for landing. Further ones are dropped.
    const MOST: usize = 8;

    /// Indices of the plans.
    pub fn numbers(&self) -> &[u32] {
        &self.numbers[..self.count]
    }

    /// Line in the agent's source and trigger of each plan.
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
    /// Runs one deliberation cycle of `agent` and updates its `activity`.
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

    /// A command that belongs to an activity with a time limit.
    fn pursue(&mut self, pursuit: Pursuit, command: AgentCommand) {
        self.activity.go_on(pursuit, self.percepts.now_ms);
        self.issue(command);
    }

    fn nearest_tag_m(&self) -> Option<[f64; 2]> {
        self.percepts.tags?.nearest_m
    }

    fn landing_m(&self) -> Option<[f64; 2]> {
        self.percepts.tags?.landing_m()
    }

    /// A command that ends the current activity.
    fn end(&mut self, command: AgentCommand) {
        self.activity.end();
        self.issue(command);
    }
}

impl Environment for AgentStep {
    fn update_beliefs(&mut self, beliefs: &mut Beliefs<'_>) {
        if let Some(pose) = self.percepts.pose {
            let Pose { x_m, y_m, z_m, yaw_deg } = self.activity.place_to_stay(&pose);
            beliefs.set_position(x_m, y_m, z_m, yaw_deg);
            beliefs.set_fence_room(-self.percepts.fence.outside_m(&pose));
        }
        if let Some(tags) = self.percepts.tags {
            beliefs.set_tag_age(tags.age_ms);
        }
        if let Some(percent) = self.percepts.battery_percent {
            beliefs.set_battery(percent.into());
        }
        beliefs.set_blind_for(self.percepts.blind_for_ms);
        beliefs.set_doubt(self.percepts.uncertainty_m);
        beliefs.set_saturated_for(self.percepts.saturated_for_ms);
        beliefs.set_wind(self.percepts.wind);
        let lasted_ms = |pursuit| self.activity.lasted_ms(pursuit, self.percepts.now_ms);
        beliefs.set_taking_off_for(lasted_ms(Pursuit::TakingOff));
        beliefs.set_approaching_for(lasted_ms(Pursuit::Approaching));
        beliefs.set_search_ago(self.activity.searched_ago_ms(self.percepts.now_ms));
        beliefs.set_searching_for(lasted_ms(Pursuit::Searching));
        beliefs.set_over_tag_for(lasted_ms(Pursuit::OverTag));
        beliefs.set_staying_for(lasted_ms(Pursuit::Staying));
        beliefs.set_descending_for(lasted_ms(Pursuit::Descending));
        let settings = self.percepts.settings;
        beliefs.set_reach_distance(settings.reach_distance_m);
        beliefs.set_stay_distance(settings.stay_distance_m);
        beliefs.set_stay_time(settings.stay_time_ms);
        beliefs.set_setpoint_age(self.percepts.setpoint.map_or(0, |setpoint| setpoint.age_ms));
        let station = self.percepts.station;
        beliefs.set_station_silent_for(station.silent_for_ms);
        beliefs.set_hold_without_station(station.hold_after_ms);
        beliefs.set_land_without_station(station.land_after_ms);
    }

    fn send_standby(&mut self) {
        self.activity.stand_by(self.percepts.now_ms);
        self.issue(AgentCommand::Standby);
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
        self.activity.end();
        self.send_goto_again(x_m, y_m, z_m, yaw_deg);
    }

    fn send_goto_again(&mut self, x_m: f64, y_m: f64, z_m: f64, yaw_deg: f64) {
        let target = Pose { x_m, y_m, z_m, yaw_deg };
        self.pursue(Pursuit::Approaching, AgentCommand::GoTo(target));
    }

    fn send_stay(&mut self, x_m: f64, y_m: f64, z_m: f64, yaw_deg: f64) {
        let target = Pose { x_m, y_m, z_m, yaw_deg };
        self.pursue(Pursuit::Staying, AgentCommand::GoTo(target));
        self.activity.stays_at(target);
    }

    fn send_search(&mut self, x_m: f64, y_m: f64, z_m: f64, yaw_deg: f64) {
        let place = place_to_look_from(&Pose { x_m, y_m, z_m, yaw_deg }, &self.percepts.fence);
        self.pursue(Pursuit::Searching, AgentCommand::GoTo(place));
    }

    fn send_over_tag(&mut self, x_m: f64, y_m: f64, z_m: f64, yaw_deg: f64) {
        self.activity.end();
        self.send_over_tag_again(x_m, y_m, z_m, yaw_deg);
    }

    fn send_over_tag_again(&mut self, x_m: f64, y_m: f64, z_m: f64, yaw_deg: f64) {
        let target = Pose { x_m, y_m, z_m, yaw_deg };
        self.pursue(Pursuit::OverTag, AgentCommand::GoTo(target));
    }

    fn send_tag_pause(&mut self) {
        self.pursue(Pursuit::OverTag, AgentCommand::Hover);
    }

    fn send_sticks(&mut self) {
        self.end(AgentCommand::Sticks);
    }

    fn send_setpoint(&mut self) {
        // Without one nothing is followed, so this command is not issued.
        let pose = self.percepts.setpoint.map(|setpoint| setpoint.pose);
        self.end(pose.map_or(AgentCommand::Hover, AgentCommand::GoTo));
        if let Some(setpoint) = self.percepts.setpoint {
            self.activity.stays_at(setpoint.reached);
        }
    }

    fn send_setpoint_pause(&mut self) {
        self.end(AgentCommand::Hover);
    }

    fn send_descent(&mut self, x_m: f64, y_m: f64, z_m: f64, yaw_deg: f64) {
        let target = Pose { x_m, y_m, z_m, yaw_deg };
        self.pursue(Pursuit::Descending, AgentCommand::GoTo(target));
        self.activity.stays_at(target);
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
                && kinematics::wrap_deg(yaw_deg - pose.yaw_deg).abs() <= REACH_ANGLE_DEG
        })
    }

    fn steady(&mut self) -> bool {
        self.percepts.speed_m_s <= STEADY_M_S
    }

    fn tags_in_use(&mut self) -> bool {
        self.percepts.tags.is_some()
    }

    fn tag_seen(&mut self) -> bool {
        self.percepts.tags.is_some_and(|tags| tags.seen)
    }

    fn tag_known(&mut self) -> bool {
        self.nearest_tag_m().is_some()
    }

    fn tag_x(&mut self) -> f64 {
        self.nearest_tag_m().map_or(0.0, |[x_m, _]| x_m)
    }

    fn tag_y(&mut self) -> f64 {
        self.nearest_tag_m().map_or(0.0, |[_, y_m]| y_m)
    }

    fn near_tag(&mut self, x_m: f64, y_m: f64) -> bool {
        self.nearest_tag_m()
            .is_some_and(|[tag_x_m, tag_y_m]| (tag_x_m - x_m).hypot(tag_y_m - y_m) <= NEAR_TAG_M)
    }

    fn landing_x(&mut self) -> f64 {
        self.landing_m().map_or(0.0, |[x_m, _]| x_m)
    }

    fn landing_y(&mut self) -> f64 {
        self.landing_m().map_or(0.0, |[_, y_m]| y_m)
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

    fn report_paused(&mut self) {
        self.report = Some(Report::Paused);
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

    fn tell_searching(&mut self) {
        self.danger = Some(Danger::Searching);
    }

    fn tell_no_tag(&mut self) {
        self.danger = Some(Danger::NoTag);
    }

    fn tell_tag_lost(&mut self) {
        self.danger = Some(Danger::TagLost);
    }

    fn tell_setpoints_gone(&mut self) {
        self.danger = Some(Danger::SetpointsGone);
    }

    fn tell_station_silent(&mut self) {
        self.danger = Some(Danger::StationSilent);
    }

    fn tell_station_gone(&mut self) {
        self.danger = Some(Danger::StationGone);
    }

    fn trace_plan(&mut self, number: u32) {
        self.plans.push(number);
    }
}

/// Distance between two poses in metres; their headings are ignored.
pub fn distance(a: &Pose, b: &Pose) -> f64 {
    (a.x_m - b.x_m).hypot(a.y_m - b.y_m).hypot(a.z_m - b.z_m)
}

#[cfg(test)]
mod tests;
