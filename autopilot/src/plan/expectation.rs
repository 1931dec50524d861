//! Expected duration and battery use of a plan, estimated before the flight.

use std::time::Duration;

use estimator::SurveyedTag;
use kinematics::{Pose, wrap_deg};
use nalgebra::Vector2;

use super::dry_run::DryRun;
use super::interpreter::{AgentOrder, Interpreter};
use super::{Command, FlightLimits, Plan, Step};
use crate::agent::ApproachSettings;

/// Expected course of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expectation {
    /// Target pose in the world, if the step flies to one: a target, or the place above the tag to land on.
    pub target: Option<Pose>,
    /// Pose at the end of the step in the world, of which the place of take-off on the floor is the origin, unless
    /// [`FlightLimits::start`] is given.
    pub place: Pose,
    /// Length of the way, in metres.
    pub leg_m: f64,
    /// Stay time at the end.
    pub stay: Duration,
    /// Duration of the step, including the stay.
    pub time: Duration,
    /// Whether the target as written lies outside the fence, which is an error.
    pub(super) outside: bool,
}

/// Time from the take-off order until the drone hovers, in seconds.
const TAKE_OFF_S: f64 = 3.2;
/// The drone's own landing: seconds before it sinks, and its rate of descent.
const LANDING_S: f64 = 1.2;
/// A search for a tag: it may be seen at once, or be searched for in vain.
const SEARCH_S: f64 = 15.0;
/// Settling above a tag before the descent.
const SETTLING_S: f64 = 3.0;
const LANDING_M_S: f64 = 0.45;
/// Duration of a leg: a constant part for acceleration and braking, and a speed. Fitted to flights of the
/// `rec` airframe over 1 to 8 m, 1 to 1.4 m up and down, 90° and 180°.
const ACROSS_S: f64 = 0.8;
const ACROSS_M_S: f64 = 2.0;
const UPWARDS_S: f64 = 0.3;
const UPWARDS_M_S: f64 = 0.65;
const TURN_S: f64 = 0.2;
const TURN_DEG_S: f64 = 90.0;
/// Battery use in percent per second. A new battery of 1000 mAh lasts about 12 minutes of hovering; moving
/// takes 20 % more.
const PERCENT_PER_S: f64 = 1.2 * 100.0 / 720.0;

/// Executes a plan's commands and estimates each.
#[derive(Debug, Clone)]
pub(super) struct Expectations {
    run: DryRun,
}

impl Expectations {
    pub(super) fn new(limits: &FlightLimits) -> Self {
        Self { run: DryRun::new(limits) }
    }

    /// The same with tags at these places.
    #[must_use]
    pub(super) fn with_tags(self, tags: &[SurveyedTag]) -> Self {
        Self { run: self.run.with_tags(tags.iter().map(|tag| tag.place_m)) }
    }

    /// The tag that is nearest to the drone, of those whose place is known.
    pub(super) fn nearest_tag_m(&self) -> Option<Vector2<f64>> {
        self.run.nearest_tag_m()
    }

    /// Pose after the last command.
    pub(super) fn place(&self) -> Pose {
        self.run.place()
    }

    /// Approach parameters after the last command.
    pub(super) fn settings(&self) -> ApproachSettings {
        self.run.interpreter().settings()
    }

    /// Estimates the next command.
    pub(super) fn step(&mut self, command: Command) -> Expectation {
        let (before, was_airborne) = (self.run.place(), self.run.is_airborne());
        let order = self.run.step(command);
        let place = self.run.place();
        let (mut target, mut outside, mut stay_s) = (None, false, 0.0);
        let (leg_m, time_s) = match order {
            Some(AgentOrder::TakeOff) if was_airborne => (0.0, 0.0),
            Some(AgentOrder::TakeOff) => (place.z_m, TAKE_OFF_S),
            Some(AgentOrder::Land) => (before.z_m, LANDING_S + before.z_m / LANDING_M_S),
            Some(AgentOrder::FindTag) => (0.0, SEARCH_S),
            Some(AgentOrder::LandOnTag) => {
                let above = Pose { z_m: before.z_m, ..place };
                let (leg_m, time_s) = leg(&before, &above, self.run.interpreter());
                target = Some(above);
                let down_s = LANDING_S + before.z_m / LANDING_M_S;
                (leg_m + before.z_m, time_s + SETTLING_S + down_s)
            }
            Some(AgentOrder::GoTo(to)) => {
                (target, outside) = (Some(to.pose), to.is_corrected());
                stay_s = self.settings().stay_time_ms as f64 / 1000.0;
                leg(&before, &to.pose, self.run.interpreter())
            }
            None => (0.0, 0.0),
        };
        Expectation {
            target,
            place,
            leg_m,
            stay: Duration::from_secs_f64(stay_s),
            time: Duration::from_secs_f64(time_s + stay_s),
            outside,
        }
    }
}

impl Plan {
    /// Expected course of each step, in the order of [`Plan::steps`].
    pub fn expectations(&self, limits: &FlightLimits) -> Vec<Expectation> {
        let mut expectations = Expectations::new(limits).with_tags(&self.tags);
        self.steps().iter().map(|step| expectations.step(step.command)).collect()
    }

    /// Expected duration of the flight. In contrast to [`Plan::expectations`] it leaves out the ways to tags that the plan
    /// declares.
    pub fn expected_time(&self, limits: &FlightLimits) -> Duration {
        expected_time(self.steps(), limits)
    }
}

/// Expected course of each of these steps. A landing on a tag is expected where the drone is.
pub fn expectations(steps: &[Step], limits: &FlightLimits) -> Vec<Expectation> {
    let mut expectations = Expectations::new(limits);
    steps.iter().map(|step| expectations.step(step.command)).collect()
}

/// Expected duration of these steps.
pub(crate) fn expected_time(steps: &[Step], limits: &FlightLimits) -> Duration {
    expectations(steps, limits).iter().map(|step| step.time).sum()
}

/// Battery use of a flight of this duration, in percent of a new battery.
pub fn battery_percent(time: Duration) -> f64 {
    time.as_secs_f64() * PERCENT_PER_S
}

/// Length of a leg in metres, and its duration in seconds.
fn leg(from: &Pose, to: &Pose, flown: &Interpreter) -> (f64, f64) {
    let share = flown.max_control();
    let across_m = (to.x_m - from.x_m).hypot(to.y_m - from.y_m);
    let upwards_m = (to.z_m - from.z_m).abs();
    let turn_deg = wrap_deg(to.yaw_deg - from.yaw_deg);
    let moves = [
        (across_m, ACROSS_S, (ACROSS_M_S * share).min(flown.speed_limit_m_s())),
        (upwards_m, UPWARDS_S, UPWARDS_M_S * share),
        (turn_deg.abs(), TURN_S, TURN_DEG_S * share),
    ];
    let times =
        moves.map(|(way, least_s, speed)| if way > 0.0 { least_s + way / speed } else { 0.0 });
    (across_m.hypot(upwards_m), times.into_iter().fold(0.0, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(text: &str) -> Vec<f64> {
        let limits = FlightLimits::default();
        let plan = Plan::parse("plan", text).unwrap();
        plan.expectations(&limits).iter().map(|step| step.time.as_secs_f64()).collect()
    }

    #[test]
    fn each_step_has_its_time() {
        let plan = "takeoff\ngoto 0 2 0 0\nsetStayTime 10\nmoveBy 0 0 1 90\nsetMaxControl 0.5\n\
                    moveBy 4 0 0 0\nland\n";
        let expected = [3.2, 3.8, 0.0, 0.3 + 1.0 / 0.65 + 10.0, 0.0, 14.8, 1.2 + 1.85 / 0.45];
        for (time, expected) in times(plan).into_iter().zip(expected) {
            assert!((time - expected).abs() < 1e-6, "{time} {expected}");
        }
    }

    #[test]
    fn a_limit_of_the_speed_makes_a_way_longer() {
        let plan = "takeoff\nsetSpeed 0.4\ngoto 0 2 0 0\nsetStayTime 0\ngoto 0 2 1 0\nsetSpeed 5\n\
                    goto 0 0 1 0\nland\n";
        let slow = times(plan);
        assert!((slow[2] - (0.8 + 2.0 / 0.4 + 2.0)).abs() < 1e-6, "{slow:?}");
        assert!((slow[4] - (0.3 + 1.0 / 0.65)).abs() < 1e-6, "upwards it is another: {slow:?}");
        assert!((slow[6] - (0.8 + 2.0 / 2.0)).abs() < 1e-6, "{slow:?}");
        let limits = FlightLimits { speed_max_m_s: 0.5, ..FlightLimits::default() };
        let plan = Plan::parse("plan", "takeoff\ngoto 0 2 0 0\nsetMaxControl 0.5\ngoto 0 0 0 0\n");
        let times = plan.unwrap().expectations(&limits);
        let times: Vec<f64> = times.iter().map(|step| step.time.as_secs_f64()).collect();
        assert!((times[1] - (0.8 + 2.0 / 0.5 + 2.0)).abs() < 1e-6, "{times:?}");
        assert!((times[3] - (0.8 + 2.0 / 0.25 + 2.0)).abs() < 1e-6, "{times:?}");
    }

    #[test]
    fn a_take_off_in_the_air_takes_no_time() {
        assert!((times("takeoff\ngoto 0 0 1 0\nautoInit\nland\n")[2]).abs() < 1e-9);
    }

    #[test]
    fn turns_go_the_short_way() {
        let [_, turn, ..] = times("takeoff\ngoto 0 0 0 270\nland\n")[..] else { panic!() };
        assert!((turn - (0.2 + 1.0 + 2.0)).abs() < 1e-9, "{turn}");
    }

    #[test]
    fn a_battery_carries_ten_minutes() {
        assert!((battery_percent(Duration::from_mins(10)) - 100.0).abs() < 1e-9);
    }
}
