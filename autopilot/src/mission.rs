//! Which step of the plan is next, and where that is.
//!
//! A plan speaks relative to a reference, to the last target or to the drone; the agent is given
//! poses in the estimator's frame. Settings take effect when their step is reached.

use pid::Pose;

use crate::agent::ApproachSettings;
use crate::plan::{Command, FlightLimits, Plan, offset};

/// What the agent is to be told next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AgentOrder {
    /// Be in the air.
    TakeOff,
    /// Go to a pose and stay there a while.
    GoTo(Pose),
    /// Land.
    Land,
}

/// The order that is due.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Due {
    /// Its step, from 0.
    pub step: usize,
    /// What the agent is to do.
    pub order: AgentOrder,
    /// Whether the target was moved into the fence: the drone hovers elsewhere than was expected when
    /// the plan was checked.
    pub corrected: bool,
}

/// Progress through a plan.
#[derive(Debug)]
pub struct Mission {
    plan: Plan,
    limits: FlightLimits,
    next: usize,
    /// The take-off reference: where z = 0, x = 0, y = 0 of the plan's first coordinates is.
    origin: Pose,
    reference: Pose,
    target: Pose,
    settings: ApproachSettings,
    max_control: f64,
}

impl Mission {
    /// A plan at its beginning.
    pub fn new(plan: Plan, limits: FlightLimits) -> Self {
        Self {
            plan,
            limits,
            next: 0,
            origin: Pose::default(),
            reference: Pose::default(),
            target: Pose::default(),
            settings: ApproachSettings::default(),
            max_control: 1.0,
        }
    }

    /// Carries out the settings that come next and returns the order behind them; nothing at the
    /// end of the plan. `pose` is where the drone is.
    pub fn advance(&mut self, pose: &Pose) -> Option<Due> {
        while let Some(step) = self.plan.steps().get(self.next) {
            let index = self.next;
            self.next += 1;
            let order = match step.command {
                Command::TakeOff { .. } => AgentOrder::TakeOff,
                Command::Land => AgentOrder::Land,
                Command::GoTo(to) => return Some(self.go_to(index, offset(&self.reference, &to))),
                Command::MoveBy(by) => return Some(self.go_to(index, offset(&self.target, &by))),
                Command::MoveByRelative(by) => return Some(self.go_to(index, offset(pose, &by))),
                Command::SetReference(to) => {
                    self.reference = offset(&self.origin, &to);
                    continue;
                }
                Command::SetReferenceHere => {
                    self.reference = *pose;
                    continue;
                }
                Command::SetReachDistance { distance_m } => {
                    self.settings.reach_distance_m = distance_m;
                    continue;
                }
                Command::SetStayDistance { distance_m } => {
                    self.settings.stay_distance_m = distance_m;
                    continue;
                }
                Command::SetStayTime { time_s } => {
                    // At most 600 s, as the parser has checked.
                    #[allow(clippy::cast_possible_truncation)]
                    let stay_time_ms = (time_s * 1000.0).round() as i64;
                    self.settings.stay_time_ms = stay_time_ms;
                    continue;
                }
                Command::SetMaxControl { fraction } => {
                    self.max_control = fraction;
                    continue;
                }
            };
            return Some(Due { step: index, order, corrected: false });
        }
        None
    }

    /// The take-off has ended at `pose`: the reference of what follows.
    pub fn set_origin(&mut self, pose: &Pose) {
        self.origin = Pose { z_m: self.limits.origin_height_m(pose.z_m), ..*pose };
        self.reference = self.origin;
        self.target = *pose;
    }

    fn go_to(&mut self, step: usize, target: Pose) -> Due {
        self.target = self.inside(&target, 0.0);
        let corrected = self.target != target;
        Due { step, order: AgentOrder::GoTo(self.target), corrected }
    }

    /// The nearest place in the fence, and so far inside across the ground.
    pub fn inside(&self, target: &Pose, by_m: f64) -> Pose {
        self.limits.nearest_inside(target, by_m)
    }

    /// How orders are to be flown now.
    pub fn settings(&self) -> ApproachSettings {
        self.settings
    }

    /// No stick is to be moved further than this.
    pub fn max_control(&self) -> f64 {
        self.max_control
    }

    /// Whether the plan may start with a drone that is in the air.
    pub fn takes_over(&self) -> bool {
        self.plan.takes_over()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOVER: Pose = Pose { x_m: 0.1, y_m: -0.1, z_m: 0.8, yaw_deg: 2.0 };

    fn targets(plan: &str, limits: FlightLimits) -> Vec<Pose> {
        let plan = Plan::parse_within("plan", plan, &limits).unwrap();
        let mut mission = Mission::new(plan, limits);
        let mut targets = Vec::new();
        // The drone is always exactly at its last target.
        let mut pose = HOVER;
        while let Some(due) = mission.advance(&pose) {
            match due.order {
                AgentOrder::TakeOff => mission.set_origin(&HOVER),
                AgentOrder::GoTo(target) => {
                    pose = target;
                    targets.push(target);
                }
                AgentOrder::Land => {}
            }
        }
        targets
    }

    fn assert_target(plan: &str, x_m: f64, y_m: f64, z_m: f64, yaw_deg: f64) {
        let plan = format!("takeoff\n{plan}\nland");
        let targets = targets(&plan, FlightLimits::default());
        let target = targets.last().unwrap();
        let expected = Pose { x_m, y_m, z_m, yaw_deg };
        let off = crate::agent::distance(target, &expected);
        assert!(off < 1e-9 && (target.yaw_deg - yaw_deg).abs() < 1e-9, "{plan}: {target:?}");
    }

    #[test]
    fn targets_follow_from_the_reference_the_last_target_or_the_drone() {
        assert_target("goto 1 2 0.5 90", 1.1, 1.9, 1.3, 92.0);
        assert_target("goto 1 0 0 0\nmoveBy 1 1 0 -10", 2.1, 0.9, 0.8, -8.0);
        assert_target("goto 1 0 0 0\nmoveByRel 0 1 0 0", 1.1, 0.9, 0.8, 2.0);
        assert_target("goto 1 0 0 0\nsetReference $POSE$\ngoto 1 0 0 0", 2.1, -0.1, 0.8, 2.0);
        assert_target("setReference 5 0 0 0\ngoto 1 0 0 0", 6.1, -0.1, 0.8, 2.0);
        assert_target("goto 0 0 0 181", 0.1, -0.1, 0.8, -177.0);
    }

    #[test]
    fn heights_count_from_the_floor_if_asked() {
        let limits =
            FlightLimits { z_origin: crate::plan::ZOrigin::Floor, ..FlightLimits::default() };
        let target = targets("takeoff\ngoto 0 0 1.2 0\nland", limits)[0];
        assert!((target.z_m - 1.2).abs() < 1e-9);
    }

    #[test]
    fn a_lower_hover_than_expected_does_not_lower_the_target_below_the_limit() {
        let plan = Plan::parse("plan", "takeoff\ngoto 0 0 -0.54 0\nland").unwrap();
        let mut mission = Mission::new(plan, FlightLimits::default());
        mission.advance(&HOVER);
        mission.set_origin(&HOVER);
        let due = mission.advance(&HOVER).unwrap();
        assert!(due.corrected);
        assert!(matches!(due.order, AgentOrder::GoTo(target) if (target.z_m - 0.3).abs() < 1e-9));
    }

    #[test]
    fn settings_take_effect_when_their_step_is_reached() {
        let text = "takeoff\nsetStayTime 3\nsetMaxControl 0.5\ngoto 0 0 0 0\nsetInitialReachDist 0.1\nland";
        let plan = Plan::parse("plan", text).unwrap();
        let mut mission = Mission::new(plan, FlightLimits::default());
        mission.advance(&HOVER);
        assert_eq!(mission.settings().stay_time_ms, 2000);
        mission.advance(&HOVER);
        assert_eq!(mission.settings().stay_time_ms, 3000);
        assert!((mission.max_control() - 0.5).abs() < 1e-9);
        assert!((mission.settings().reach_distance_m - 0.2).abs() < 1e-9);
        mission.advance(&HOVER);
        assert!((mission.settings().reach_distance_m - 0.1).abs() < 1e-9);
    }
}
