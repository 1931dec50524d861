//! The mission and its progress.
//!
//! A mission consists of a loaded plan, of appended commands, or of both. The meaning of commands is defined
//! in [`crate::plan`]; this module keeps track of the next one.

use estimator::SurveyedTag;
use kinematics::Pose;

use crate::agent::ApproachSettings;
use crate::plan::{
    AgentOrder, Command, Commands, DryRun, FlightLimits, Interpreter, MissionId, Plan, Step,
};

/// An order that is due.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Due {
    /// Index of its step, from 0.
    pub step: usize,
    /// The order to the agent.
    pub order: AgentOrder,
}

impl Due {
    /// Whether the target was moved inside the fence because the drone hovers elsewhere than expected when
    /// the plan was checked.
    pub fn is_corrected(&self) -> bool {
        match self.order {
            AgentOrder::GoTo(target) => target.is_corrected(),
            AgentOrder::TakeOff
            | AgentOrder::Land
            | AgentOrder::FindTag
            | AgentOrder::LandOnTag => false,
        }
    }
}

/// A flight to which commands are appended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Underway {
    /// Where the drone is.
    pub here: Pose,
    /// Whether it is in the air.
    pub airborne: bool,
    /// The order that it carries out.
    pub due: Option<Due>,
}

/// Why commands cannot be appended: all reasons, as [`Plan::parse`] would give them.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", .reasons.join("; "))]
pub struct AppendError {
    /// Never empty.
    pub reasons: Vec<String>,
}

/// The mission of a vehicle; may be empty.
#[derive(Debug)]
pub struct Mission {
    limits: FlightLimits,
    /// The loaded plan's; empty without one.
    name: String,
    /// Of the commands that it consists of, if it consists of nothing else.
    id: Option<MissionId>,
    steps: Vec<Step>,
    tags: Vec<SurveyedTag>,
    next: usize,
    interpreter: Interpreter,
}

impl Mission {
    /// An empty mission within this fence.
    pub fn new(limits: FlightLimits) -> Self {
        Self {
            limits,
            name: String::new(),
            id: None,
            steps: Vec::new(),
            tags: Vec::new(),
            next: 0,
            interpreter: Interpreter::new(&limits),
        }
    }

    /// Replaces the mission by a plan. The origin of coordinates is kept while the drone is `airborne`.
    pub fn load(&mut self, plan: Plan, airborne: bool) {
        self.tags = plan.tags().to_vec();
        plan.name().clone_into(&mut self.name);
        self.id = None;
        self.steps = plan.into_steps();
        self.next = 0;
        self.interpreter =
            if airborne { self.interpreter.of_new_plan() } else { Interpreter::new(&self.limits) };
    }

    /// Appends commands, before a landing that the plan implies. At rest, where the next flight begins with the
    /// first step, commands behind a mission that has ended begin a new one.
    ///
    /// # Errors
    /// [`AppendError`] if a command leads outside the fence or does not fit there. Nothing has changed then.
    pub fn append(
        &mut self,
        commands: Commands,
        underway: Option<Underway>,
    ) -> Result<(), AppendError> {
        let begins_anew = underway.is_none() && (self.has_ended() || commands.clears());
        let end = self.steps.len() - usize::from(self.lands_implicitly());
        let (mut run, next) = match underway {
            None => (DryRun::new(&self.limits), 0),
            Some(Underway { here, airborne, due }) => {
                let mut run = DryRun::from_here(self.interpreter.clone(), here, airborne);
                run.finish(due.map(|due| due.order));
                (run, self.next.min(end))
            }
        };
        let kept = if begins_anew || commands.clears() { end } else { next };
        for step in self.steps.get(kept..end).unwrap_or_default() {
            run.step(step.command);
        }
        let reasons = commands.problems_behind(run, &self.limits);
        if !reasons.is_empty() {
            return Err(AppendError { reasons });
        }
        if begins_anew {
            self.clear();
        } else if commands.clears() {
            self.steps.drain(next..end);
        }
        // A mission that is extended is no longer the one that was handed over.
        self.id = commands.id().filter(|_| self.steps.is_empty());
        let end = self.steps.len() - usize::from(self.lands_implicitly());
        self.steps.splice(end..end, commands.into_steps());
        Ok(())
    }

    /// Removes all steps. The reference and the settings are kept.
    pub fn clear(&mut self) {
        self.name.clear();
        self.id = None;
        self.steps.clear();
        self.tags.clear();
        self.next = 0;
    }

    /// Returns to the first step, on the ground.
    pub fn rewind(&mut self) {
        self.next = 0;
        self.interpreter = Interpreter::new(&self.limits);
    }

    /// Name of the loaded plan; empty without one.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The number that its maker gave it, as long as it is what that one made.
    pub fn id(&self) -> Option<MissionId> {
        self.id
    }

    /// The tags that the loaded plan declares.
    pub fn tags(&self) -> &[SurveyedTag] {
        &self.tags
    }

    /// All steps in order.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// Whether all steps have begun; false for an empty mission.
    pub fn has_ended(&self) -> bool {
        !self.steps.is_empty() && self.next >= self.steps.len()
    }

    /// Whether a take-off is among the steps.
    pub fn takes_off(&self) -> bool {
        take_off_is_among(&self.steps)
    }

    /// Whether a take-off is among the steps that have not begun.
    pub fn takes_off_again(&self) -> bool {
        self.steps.get(self.next..).is_some_and(take_off_is_among)
    }

    /// Applies the settings that come next and returns the order after them; `None` at the end of the
    /// mission. The drone is at `pose`.
    pub fn advance(&mut self, pose: &Pose) -> Option<Due> {
        while let Some(command) = self.steps.get(self.next).map(|step| step.command) {
            let step = self.next;
            self.next += 1;
            if let Some(order) = self.interpreter.carry_out(command, pose) {
                return Some(Due { step, order });
            }
        }
        None
    }

    /// The take-off has ended with the drone at `pose`. Call this before the mission advances.
    pub fn take_off_ended(&mut self, pose: &Pose) {
        self.interpreter.take_off_ended(pose);
    }

    /// A search for a tag has ended with the drone at `pose`, which is held.
    pub fn stopped_at(&mut self, pose: &Pose) {
        self.interpreter.stopped_at(pose);
    }

    /// The nearest place inside the fence, `by_m` from its border, or as far as there is room.
    pub fn inside(&self, target: &Pose, by_m: f64) -> Pose {
        self.limits.nearest_inside(target, by_m)
    }

    /// Current approach parameters.
    pub fn settings(&self) -> ApproachSettings {
        self.interpreter.settings()
    }

    /// Current limit of the horizontal speed in m/s, besides that of the controller.
    pub fn speed_m_s(&self) -> Option<f64> {
        self.interpreter.speed_m_s()
    }

    /// Current limit of the sticks, as a fraction.
    pub fn max_control(&self) -> f64 {
        self.interpreter.max_control()
    }

    /// Whether the mission may start with a drone that is already in the air.
    pub fn takes_over(&self) -> bool {
        crate::plan::takes_over(&self.steps)
    }

    /// Expected duration from its beginning.
    pub fn expected_time(&self) -> std::time::Duration {
        crate::plan::expected_time(&self.steps, &self.limits)
    }

    /// Whether the last step is a landing that the plan implies but does not contain.
    fn lands_implicitly(&self) -> bool {
        self.steps.last().is_some_and(Step::is_implied)
    }
}

fn take_off_is_among(steps: &[Step]) -> bool {
    steps.iter().any(|step| matches!(step.command, Command::TakeOff { .. }))
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOVER: Pose = Pose { x_m: 0.1, y_m: -0.1, z_m: 0.8, yaw_deg: 2.0 };

    fn mission(text: &str) -> Mission {
        let mut mission = Mission::new(FlightLimits::default());
        mission.load(Plan::parse("plan", text).unwrap(), false);
        mission
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

    fn append(mission: &mut Mission, text: &str, due: Option<Due>) -> Result<(), String> {
        let commands = Commands::parse("command", text).unwrap();
        let underway = due.map(|due| Underway { here: HOVER, airborne: true, due: Some(due) });
        mission.append(commands, underway).map_err(|error| error.to_string())
    }

    fn texts(mission: &Mission) -> Vec<&str> {
        mission.steps().iter().map(|step| step.text.as_str()).collect()
    }

    #[test]
    fn commands_are_appended_before_an_implied_landing() {
        let mut implied = mission("takeoff\ngoto 0 1 0 0");
        append(&mut implied, "goto 0 2 0 0", None).unwrap();
        assert_eq!(texts(&implied), ["takeoff", "goto 0 1 0 0", "goto 0 2 0 0", "land"]);
        let mut written = mission("takeoff\nland");
        let error = append(&mut written, "goto 0 2 0 0", None).unwrap_err();
        assert!(error.contains("on the ground"), "{error}");
        append(&mut written, "takeoff\ngoto 0 2 0 0", None).unwrap();
        assert_eq!(texts(&written), ["takeoff", "land", "takeoff", "goto 0 2 0 0"]);
        assert!(!written.has_ended());
    }

    #[test]
    fn only_the_whole_mission_has_the_number_of_its_commands() {
        let made = |id, clears| {
            let hover = [Command::TakeOff { take_over: false }, Command::Hold { time_s: 1.0 }];
            Commands::new("made", MissionId(id), clears, hover).unwrap()
        };
        let mut mission = mission("takeoff\ngoto 0 1 0 0\nland");
        assert_eq!(mission.id(), None);
        mission.append(made(1, true), None).unwrap();
        assert_eq!(
            (mission.id(), texts(&mission)),
            (Some(MissionId(1)), vec!["takeoff", "hold 1"])
        );
        // What is refused leaves it as it is, and what is appended makes another of it.
        assert!(append(&mut mission, "goto 0 50 0 0", None).is_err());
        assert_eq!(mission.id(), Some(MissionId(1)));
        append(&mut mission, "land", None).unwrap();
        assert_eq!(mission.id(), None);
        mission.append(made(2, false), None).unwrap();
        assert_eq!((mission.id(), mission.steps().len()), (None, 5));
        // Behind its end commands begin a new one.
        mission.clear();
        mission.append(made(3, false), None).unwrap();
        assert_eq!(mission.id(), Some(MissionId(3)));
        while mission.advance(&HOVER).is_some() {}
        mission.append(made(4, false), None).unwrap();
        assert_eq!((mission.id(), mission.steps().len()), (Some(MissionId(4)), 2));
        // In flight what has been flown stays in front of it.
        let due = mission.advance(&Pose::default()).unwrap();
        let underway = Underway { here: HOVER, airborne: true, due: Some(due) };
        mission.append(made(5, true), Some(underway)).unwrap();
        assert_eq!((mission.id(), mission.steps().len()), (None, 3));
        mission.load(Plan::parse("plan", "takeoff\nland").unwrap(), false);
        assert_eq!(mission.id(), None);
    }

    #[test]
    fn what_is_appended_counts_from_where_the_mission_leads() {
        let mut mission = mission("takeoff\ngoto 0 6 0 0\nmoveBy 0 3 0 0");
        let error = append(&mut mission, "moveBy 0 2 0 0", None).unwrap_err();
        assert!(error.contains("11.00 m from the start"), "{error}");
        assert_eq!(mission.steps().len(), 4, "nothing has changed");
        append(&mut mission, "moveBy 0 1 0 0", None).unwrap();
        // The same while the first step is being flown.
        let due = mission.advance(&Pose::default()).unwrap();
        let error = append(&mut mission, "moveBy 0 0.5 0 0", Some(due)).unwrap_err();
        assert!(error.contains("beyond the fence"), "{error}");
        append(&mut mission, "clearCommands\nmoveBy 0 2 0 0", Some(due)).unwrap();
        assert_eq!(texts(&mission), ["takeoff", "moveBy 0 2 0 0", "land"]);
    }

    #[test]
    fn an_empty_mission_takes_commands_one_by_one() {
        let mut mission = Mission::new(FlightLimits::default());
        assert!(append(&mut mission, "goto 0 1 0 0", None).unwrap_err().contains("`takeoff`"));
        append(&mut mission, "setStayTime 1", None).unwrap();
        assert!(!mission.takes_off());
        append(&mut mission, "takeoff", None).unwrap();
        assert!(mission.takes_off() && !mission.has_ended());
        let due = mission.advance(&Pose::default()).unwrap();
        assert_eq!(due, Due { step: 1, order: AgentOrder::TakeOff });
        mission.take_off_ended(&HOVER);
        assert!(mission.has_ended());
        append(&mut mission, "goto 0 1 0 0", Some(due)).unwrap();
        assert_eq!(mission.advance(&HOVER).unwrap().step, 2);
    }

    #[test]
    fn a_plan_that_is_loaded_in_the_air_counts_from_the_same_origin() {
        let mut mission = mission("takeoff\nsetReference 5 0 0 0\nsetMaxControl 0.5\ngoto 0 0 0 0");
        mission.advance(&Pose::default());
        mission.take_off_ended(&HOVER);
        mission.advance(&HOVER);
        mission.load(Plan::parse("plan", "takeoff\ngoto 0 2 0 0").unwrap(), true);
        assert!((mission.max_control() - 1.0).abs() < 1e-9);
        mission.advance(&HOVER);
        let there = Pose { x_m: 4.0, ..HOVER };
        mission.take_off_ended(&there);
        let due = mission.advance(&there).unwrap();
        let AgentOrder::GoTo(target) = due.order else { panic!("{due:?}") };
        assert!((target.pose.x_m - HOVER.x_m).abs() < 1e-9);
        assert!((target.pose.y_m - HOVER.y_m - 2.0).abs() < 1e-9);
    }

    #[test]
    fn at_rest_commands_count_from_the_next_take_off() {
        let mut mission = mission("takeoff\ngoto 3 0 0 0\nland");
        mission.advance(&Pose::default());
        mission.take_off_ended(&HOVER);
        while mission.advance(&Pose { x_m: 3.0, ..HOVER }).is_some() {}
        assert!(mission.has_ended());
        assert!(append(&mut mission, "goto 0 50 0 0", None).is_err());
        assert_eq!(
            texts(&mission),
            ["takeoff", "goto 3 0 0 0", "land"],
            "what is refused changes nothing"
        );
        append(&mut mission, "takeoff\nmoveBy 8 0 0 0", None).unwrap();
        assert_eq!(texts(&mission), ["takeoff", "moveBy 8 0 0 0"]);
    }
}
