//! Semantics of plan commands.
//!
//! All users of plans share this interpreter. Coordinates in a plan are relative to a reference, to the last
//! target or to the drone; the results are poses in the estimator's frame. The drone's pose is an input: in
//! flight it comes from the estimator, in a [dry run](super::dry_run) from an ideal drone.
//!
//! As in `tum_ardrone`, only `setReference` moves the reference; landing and taking off again do not. The
//! origin is the pose at the end of the first take-off, because that is the first pose known in flight.

use kinematics::{Pose, wrap_deg};

use super::{Command, FlightLimits};
use crate::agent::{ApproachSettings, distance};

/// An order to the agent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AgentOrder {
    /// Take off.
    TakeOff,
    /// Fly to a target and stay there for the stay time.
    GoTo(Target),
    /// Land.
    Land,
    /// Look for a tag until one is seen.
    FindTag,
    /// Land on the nearest tag.
    LandOnTag,
}

/// A target of a plan, in the estimator's frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// Where the drone is sent: the target moved inside the fence.
    pub pose: Pose,
    /// The target as written in the plan.
    pub wanted: Pose,
}

impl Target {
    /// Whether the target was moved inside the fence.
    pub fn is_corrected(&self) -> bool {
        distance(&self.pose, &self.wanted) > FlightLimits::TOLERANCE_M
    }
}

/// Executes the commands of a plan one after the other.
#[derive(Debug, Clone)]
pub(crate) struct Interpreter {
    limits: FlightLimits,
    /// Origin of the plan's coordinates; `None` before the end of the first take-off.
    origin: Option<Pose>,
    reference: Reference,
    /// The last target.
    target: Pose,
    settings: ApproachSettings,
    speed_m_s: Option<f64>,
    max_control: f64,
    /// Stay time of the present target, if it is not that of the settings.
    held_for_s: Option<f64>,
}

/// Reference of `goto`.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Reference {
    /// Relative to the origin, which may become known later: a plan may set the reference before it takes
    /// off.
    FromOrigin(Pose),
    /// A pose where the drone was.
    Fixed(Pose),
}

impl Interpreter {
    /// State at the beginning of a plan, on the ground.
    pub(crate) fn new(limits: &FlightLimits) -> Self {
        Self {
            limits: *limits,
            origin: None,
            reference: Reference::FromOrigin(Pose::default()),
            target: Pose::default(),
            settings: ApproachSettings::default(),
            speed_m_s: None,
            max_control: 1.0,
            held_for_s: None,
        }
    }

    /// Executes a command while the drone is at `pose`. Returns the order to the agent; `None` for a setting,
    /// which applies to all later commands.
    ///
    /// After a take-off, call [`Interpreter::take_off_ended`] before the next command.
    pub(crate) fn carry_out(&mut self, command: Command, pose: &Pose) -> Option<AgentOrder> {
        self.held_for_s = None;
        match command {
            Command::TakeOff { .. } => return Some(AgentOrder::TakeOff),
            Command::Land => return Some(AgentOrder::Land),
            Command::FindTag => return Some(AgentOrder::FindTag),
            Command::LandOnTag => return Some(AgentOrder::LandOnTag),
            Command::GoTo(to) => return Some(self.go_to(self.reference(), to)),
            Command::MoveBy(by) => return Some(self.go_to(self.target, by)),
            Command::MoveByRelative(by) => return Some(self.go_to(*pose, by)),
            Command::Hold { time_s } => {
                self.held_for_s = Some(time_s);
                return Some(self.go_to(self.target, Pose::default()));
            }
            Command::SetReference(to) => self.reference = Reference::FromOrigin(to),
            Command::SetReferenceHere => self.reference = Reference::Fixed(*pose),
            // The estimator's frame begins there unless the start is surveyed.
            Command::SetReferenceStart => {
                self.reference = Reference::Fixed(self.limits.start.unwrap_or_default());
            }
            Command::SetReachDistance { distance_m } => self.settings.reach_distance_m = distance_m,
            Command::SetStayDistance { distance_m } => self.settings.stay_distance_m = distance_m,
            Command::SetStayTime { time_s } => self.settings.stay_time_ms = milliseconds(time_s),
            Command::SetSpeed { speed_m_s } => self.speed_m_s = Some(speed_m_s),
            Command::SetMaxControl { fraction } => self.max_control = fraction,
        }
        None
    }

    /// State for a new plan in the same flight: the origin stays, reference and settings are reset.
    pub(crate) fn of_new_plan(&self) -> Self {
        Self { origin: self.origin, target: self.target, ..Self::new(&self.limits) }
    }

    /// A take-off has ended at `pose`, which is held. The first one sets the origin: there, or that of the world if the start
    /// is surveyed.
    pub(crate) fn take_off_ended(&mut self, pose: &Pose) {
        let here = if self.limits.start.is_some() { Pose::default() } else { *pose };
        let origin = Pose { z_m: self.limits.origin_height_m(pose.z_m), ..here };
        self.origin.get_or_insert(origin);
        self.target = *pose;
    }

    /// The drone has stopped at `pose`, which is held, and from which `moveBy` counts.
    pub(crate) fn stopped_at(&mut self, pose: &Pose) {
        self.target = *pose;
    }

    /// Current approach parameters.
    pub(crate) fn settings(&self) -> ApproachSettings {
        let held_ms = self.held_for_s.map(milliseconds);
        ApproachSettings {
            stay_time_ms: held_ms.unwrap_or(self.settings.stay_time_ms),
            ..self.settings
        }
    }

    /// The least of all current limits of the horizontal speed, in m/s.
    pub(crate) fn speed_limit_m_s(&self) -> f64 {
        let of_controller_m_s = self.limits.speed_max_m_s * self.max_control;
        self.speed_m_s.map_or(of_controller_m_s, |speed_m_s| speed_m_s.min(of_controller_m_s))
    }

    /// Current limit of the horizontal speed in m/s, besides that of the controller.
    pub(crate) fn speed_m_s(&self) -> Option<f64> {
        self.speed_m_s
    }

    /// Current limit of the sticks, as a fraction.
    pub(crate) fn max_control(&self) -> f64 {
        self.max_control
    }

    fn reference(&self) -> Pose {
        match self.reference {
            Reference::FromOrigin(by) => {
                // Without a take-off before it this is a plan that will be refused.
                let expected = || Pose {
                    z_m: self.limits.origin_height_m(FlightLimits::EXPECTED_HOVER_M),
                    ..Pose::default()
                };
                offset(&self.origin.unwrap_or_else(expected), &by)
            }
            Reference::Fixed(pose) => pose,
        }
    }

    fn go_to(&mut self, from: Pose, by: Pose) -> AgentOrder {
        let wanted = offset(&from, &by);
        self.target = self.limits.nearest_inside(&wanted, 0.0);
        AgentOrder::GoTo(Target { pose: self.target, wanted })
    }
}

/// A time that the language limits to 600 s.
fn milliseconds(time_s: f64) -> i64 {
    #[allow(clippy::cast_possible_truncation, reason = "the language limits it to 600 s")]
    let milliseconds = (time_s * 1000.0).round() as i64;
    milliseconds
}

/// The pose `by` away from `from`. Displacements are along the world's axes; headings add up.
fn offset(from: &Pose, by: &Pose) -> Pose {
    Pose {
        x_m: from.x_m + by.x_m,
        y_m: from.y_m + by.y_m,
        z_m: from.z_m + by.z_m,
        yaw_deg: wrap_deg(from.yaw_deg + by.yaw_deg),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{LANGUAGE, Plan, ZOrigin, parser};

    const FIRST_HOVER: Pose = Pose { x_m: 0.1, y_m: -0.1, z_m: 0.8, yaw_deg: 2.0 };
    const SECOND_HOVER: Pose = Pose { x_m: 0.4, y_m: 1.2, z_m: 0.9, yaw_deg: -3.0 };

    /// The last target of a plan, flown by an ideal drone.
    fn last_target(text: &str, limits: &FlightLimits) -> Target {
        let plan = Plan::parse_within("plan", text, limits).unwrap();
        let mut interpreter = Interpreter::new(limits);
        let mut hovers = [FIRST_HOVER, SECOND_HOVER].into_iter();
        let (mut pose, mut last) = (Pose::default(), None);
        for step in plan.steps() {
            match interpreter.carry_out(step.command, &pose) {
                Some(AgentOrder::TakeOff) => {
                    pose = hovers.next().unwrap();
                    interpreter.take_off_ended(&pose);
                }
                Some(AgentOrder::GoTo(target)) => {
                    pose = target.pose;
                    last = Some(target);
                }
                Some(AgentOrder::Land | AgentOrder::LandOnTag) => pose.z_m = 0.0,
                Some(AgentOrder::FindTag) | None => {}
            }
        }
        last.unwrap()
    }

    #[track_caller]
    fn assert_target(plan: &str, expected: [f64; 4]) {
        let target = last_target(&format!("{plan}\nland"), &FlightLimits::default());
        assert!(!target.is_corrected());
        let Pose { x_m, y_m, z_m, yaw_deg } = target.pose;
        for (value, expected) in [x_m, y_m, z_m, yaw_deg].into_iter().zip(expected) {
            assert!((value - expected).abs() < 1e-9, "{plan}: {target:?}");
        }
    }

    #[test]
    fn targets_follow_from_the_reference_the_last_target_or_the_drone() {
        assert_target("takeoff\ngoto 1 2 0.5 90", [1.1, 1.9, 1.3, 92.0]);
        assert_target("takeoff\ngoto 1 0 0 0\nmoveBy 1 1 0 -10", [2.1, 0.9, 0.8, -8.0]);
        assert_target("takeoff\ngoto 1 0 0 0\nmoveByRel 0 1 0 0", [1.1, 0.9, 0.8, 2.0]);
        assert_target("takeoff\nmoveBy 1 1 0 0", [1.1, 0.9, 0.8, 2.0]);
        assert_target("takeoff\ngoto 0 0 0 181", [0.1, -0.1, 0.8, -177.0]);
    }

    #[test]
    fn a_hold_stays_at_the_last_target_for_its_own_time() {
        let mut interpreter = Interpreter::new(&FlightLimits::default());
        interpreter.take_off_ended(&FIRST_HOVER);
        interpreter.carry_out(Command::SetStayTime { time_s: 0.5 }, &FIRST_HOVER);
        let by = Pose { x_m: 1.0, ..Pose::default() };
        let moved = interpreter.carry_out(Command::MoveBy(by), &FIRST_HOVER);
        let held = interpreter.carry_out(Command::Hold { time_s: 2.5 }, &SECOND_HOVER);
        assert_eq!((held, interpreter.settings().stay_time_ms), (moved, 2500));
        interpreter.carry_out(Command::MoveBy(by), &FIRST_HOVER);
        assert_eq!(interpreter.settings().stay_time_ms, 500);
    }

    #[test]
    fn the_reference_is_moved_by_its_command() {
        let here = "takeoff\ngoto 1 0 0 0\nsetReference $POSE$\ngoto 1 0 0 0";
        assert_target(here, [2.1, -0.1, 0.8, 2.0]);
        assert_target("takeoff\nsetReference 5 0 0 0\ngoto 1 0 0 0", [6.1, -0.1, 0.8, 2.0]);
        // It is relative to the take-off, not to the reference set before.
        let twice = "takeoff\nsetReference $POSE$\nsetReference 5 0 0 0\nsetReference 1 0 0 9\n";
        assert_target(&format!("{twice}goto 0 0 0 0"), [1.1, -0.1, 0.8, 11.0]);
    }

    #[test]
    fn a_reference_that_is_set_on_the_ground_counts_in_the_air() {
        assert_target("setReference 1 2 0.1 30\ntakeoff\ngoto 0 0 0 0", [1.1, 1.9, 0.9, 32.0]);
        // The drone stands on the floor, at the origin of the estimator's frame.
        assert_target("setReference $POSE$\ntakeoff\ngoto 0 1 1.5 0", [0.0, 1.0, 1.5, 0.0]);
    }

    #[test]
    fn only_the_first_take_off_is_where_coordinates_begin() {
        let again = "takeoff\ngoto 0 6 0 0\nland\ntakeoff\n";
        assert_target(&format!("{again}goto 0 6 0 0"), [0.1, 5.9, 0.8, 2.0]);
        assert_target(&format!("{again}setReference 1 0 0 0\ngoto 0 0 0 0"), [1.1, -0.1, 0.8, 2.0]);
        // The drone holds the place where it then is.
        assert_target(&format!("{again}moveBy 0 1 0 0"), [0.4, 2.2, 0.9, -3.0]);
        let moved = "takeoff\nsetReference 1 0 0 0\nland\ntakeoff\ngoto 0 0 0 0";
        assert_target(moved, [1.1, -0.1, 0.8, 2.0]);
    }

    #[test]
    fn heights_count_from_the_floor_if_asked() {
        let limits = FlightLimits { z_origin: ZOrigin::Floor, ..FlightLimits::default() };
        let target = last_target("takeoff\ngoto 0 0 1.2 0\nland", &limits);
        assert!((target.pose.z_m - 1.2).abs() < 1e-9);
    }

    #[test]
    fn a_target_outside_is_moved_into_the_fence_and_the_next_counts_from_there() {
        // Inside at the expected hover height of 0.85 m; this drone hovers 5 cm lower.
        let low = last_target("takeoff\ngoto 0 0 -0.54 0\nland", &FlightLimits::default());
        assert!(low.is_corrected());
        assert!((low.wanted.z_m - 0.26).abs() < 1e-9 && (low.pose.z_m - 0.3).abs() < 1e-9);
        assert_target("takeoff\ngoto 0 0 -0.54 0\nmoveBy 0 0 0.1 0", [0.1, -0.1, 0.4, 2.0]);
        // A target on the fence is not moved again because of rounding.
        let on_it =
            last_target("takeoff\ngoto 7 7.08 0 0\nmoveBy 0 0 0 0", &FlightLimits::default());
        assert!(!on_it.is_corrected(), "{on_it:?}");
    }

    #[test]
    fn places_can_count_from_the_start_of_the_flight() {
        let start = "setReference $START$\ngoto 1 0 1.5 90";
        assert_target(&format!("takeoff\ngoto 2 2 0 0\n{start}"), [1.0, 0.0, 1.5, 90.0]);
        assert_target("setReference $START$\ntakeoff\ngoto 1 0 1.5 90", [1.0, 0.0, 1.5, 90.0]);
    }

    #[test]
    fn a_setting_orders_nothing() {
        let examples =
            LANGUAGE.iter().map(|declared| declared.example).filter(|line| !line.is_empty());
        for example in examples.chain(["setReference 1 0 0 0", "setReference $START$"]) {
            let (lines, _) = parser::parse(example);
            let Some(command) = lines[0].command else { continue };
            let order =
                Interpreter::new(&FlightLimits::default()).carry_out(command, &Pose::default());
            assert_eq!(command.is_setting(), order.is_none(), "{example}");
        }
    }

    #[test]
    fn settings_hold_from_their_command_on() {
        let mut interpreter = Interpreter::new(&FlightLimits::default());
        assert_eq!(interpreter.settings(), ApproachSettings::default());
        for command in [
            Command::SetReachDistance { distance_m: 0.1 },
            Command::SetStayDistance { distance_m: 0.7 },
            Command::SetStayTime { time_s: 1.2345 },
            Command::SetSpeed { speed_m_s: 0.4 },
            Command::SetMaxControl { fraction: 0.5 },
        ] {
            assert_eq!(interpreter.carry_out(command, &Pose::default()), None);
        }
        let settings =
            ApproachSettings { reach_distance_m: 0.1, stay_distance_m: 0.7, stay_time_ms: 1235 };
        assert_eq!(interpreter.settings(), settings);
        assert!((interpreter.max_control() - 0.5).abs() < 1e-9);
        assert_eq!(interpreter.speed_m_s(), Some(0.4));
        assert_eq!(interpreter.of_new_plan().speed_m_s(), None);
    }
}
