//! Which step of the plan is next.
//!
//! What a step means is the plan's business; here is how far the flight has come, and where it was then.

use pid::Pose;

use crate::agent::ApproachSettings;
use crate::plan::{AgentOrder, FlightLimits, Interpreter, Plan};

/// The order that is due.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Due {
    /// Its step, from 0.
    pub step: usize,
    /// What the agent is to do.
    pub order: AgentOrder,
}

impl Due {
    /// Whether the target was moved into the fence: the drone hovers elsewhere than was expected when
    /// the plan was checked.
    pub fn is_corrected(&self) -> bool {
        match self.order {
            AgentOrder::GoTo(target) => target.is_corrected(),
            AgentOrder::TakeOff | AgentOrder::Land => false,
        }
    }
}

/// Progress through a plan.
#[derive(Debug)]
pub struct Mission {
    plan: Plan,
    next: usize,
    interpreter: Interpreter,
}

impl Mission {
    /// A plan at its beginning.
    pub fn new(plan: Plan, limits: FlightLimits) -> Self {
        Self { plan, next: 0, interpreter: Interpreter::new(limits) }
    }

    /// Carries out the settings that come next and returns the order behind them; nothing at the
    /// end of the plan. `pose` is where the drone is.
    pub fn advance(&mut self, pose: &Pose) -> Option<Due> {
        while let Some(command) = self.plan.steps().get(self.next).map(|step| step.command) {
            let step = self.next;
            self.next += 1;
            if let Some(order) = self.interpreter.carry_out(command, pose) {
                return Some(Due { step, order });
            }
        }
        None
    }

    /// The agent has taken off, and the drone is at `pose`. To be called before the plan advances.
    pub fn take_off_ended(&mut self, pose: &Pose) {
        self.interpreter.take_off_ended(pose);
    }

    /// The nearest place in the fence, at least `by_m` inside across the ground.
    pub fn inside(&self, target: &Pose, by_m: f64) -> Pose {
        self.interpreter.limits().nearest_inside(target, by_m)
    }

    /// How orders are to be flown now.
    pub fn settings(&self) -> ApproachSettings {
        self.interpreter.settings()
    }

    /// No stick is to be moved further than this.
    pub fn max_control(&self) -> f64 {
        self.interpreter.max_control()
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

    fn mission(text: &str) -> Mission {
        Mission::new(Plan::parse("plan", text).unwrap(), FlightLimits::default())
    }

    #[test]
    fn orders_come_one_by_one_and_end() {
        let mut mission =
            mission("setStayTime 1\ntakeoff\nsetReference $POSE$\ngoto 0 0 0 0\nland");
        let due = mission.advance(&Pose::default()).unwrap();
        assert_eq!(due, Due { step: 1, order: AgentOrder::TakeOff });
        mission.take_off_ended(&HOVER);
        // Where the drone is when the step begins.
        let drifted = Pose { x_m: 0.15, ..HOVER };
        let due = mission.advance(&drifted).unwrap();
        assert!(matches!(due.order, AgentOrder::GoTo(target) if target.pose == drifted));
        assert_eq!((due.step, due.is_corrected()), (3, false));
        let due = mission.advance(&drifted).unwrap();
        assert_eq!(due, Due { step: 4, order: AgentOrder::Land });
        assert_eq!(mission.advance(&drifted), None);
    }

    #[test]
    fn a_lower_hover_than_expected_does_not_lower_the_target_below_the_limit() {
        let mut mission = mission("takeoff\ngoto 0 0 -0.54 0\nland");
        mission.advance(&Pose::default());
        mission.take_off_ended(&HOVER);
        let due = mission.advance(&HOVER).unwrap();
        assert!(due.is_corrected());
        let AgentOrder::GoTo(target) = due.order else { panic!("{due:?}") };
        assert!((target.pose.z_m - 0.3).abs() < 1e-9);
    }

    #[test]
    fn settings_take_effect_when_their_step_is_reached() {
        let text = "takeoff\nsetStayTime 3\nsetMaxControl 0.5\ngoto 0 0 0 0\nsetInitialReachDist 0.1\nland";
        let mut mission = mission(text);
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
