//! A checked mission as commands of the plan language.

use std::mem::{discriminant, replace};

use autopilot::plan::Command;

/// The take-off of a plan.
pub(crate) const TAKE_OFF: Command = Command::TakeOff { take_over: false };

/// A command, and the item to which it belongs; an item may have several, or none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Step {
    /// Index of the item.
    pub(crate) item: u16,
    /// What to do.
    pub(crate) command: Command,
}

/// A mission of which each item can be flown.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Translated {
    /// With the settings of each target, also if they are those of the one before.
    pub(super) steps: Vec<Step>,
    /// Speed limit where the mission sets none, in metres per second.
    pub(super) speed_m_s: f64,
    /// What is flown otherwise than an item says, for a person.
    pub(super) limited: Vec<String>,
}

impl Translated {
    /// What is flown otherwise than an item says, because it was outside the limits: for a person, each at most 100 bytes.
    pub(crate) fn limited(&self) -> &[String] {
        &self.limited
    }

    /// The steps from item `first` on; none if nothing is left to fly. They set all that they depend on, so that no mission
    /// flown before counts. On the ground a take-off is put in front if none comes first; with the drone `airborne` there is
    /// none. A stay or a turn begins with the way to its place. What does not end with a landing is held at its end.
    pub(crate) fn steps_from(&self, first: u16, mut airborne: bool) -> Vec<Step> {
        let begin = self.steps.partition_point(|step| step.item < first);
        let (before, steps) = self.steps.split_at(begin);
        let is_flight = |step: &&Step| !step.command.is_setting() && step.command != Command::Land;
        let is_landing = |step: &Step| step.command == Command::Land;
        if !steps.iter().any(|step| is_flight(&step) || airborne && is_landing(step)) {
            return Vec::new();
        }
        let takes_off = steps.iter().find(is_flight).is_some_and(|step| step.command == TAKE_OFF);
        let mut set = before.iter().rev().map(|step| step.command);
        let speed = set.find(|command| matches!(command, Command::SetSpeed { .. }));
        let front = [
            Some(Command::SetReferenceStart),
            speed.or(Some(Command::SetSpeed { speed_m_s: self.speed_m_s })),
            (!airborne && !takes_off).then_some(TAKE_OFF),
        ];
        let front = front.into_iter().flatten().map(|command| Step { item: first, command });
        let mut program: Vec<Step> = Vec::with_capacity(steps.len() + 3);
        for step in front.chain(steps.iter().copied()) {
            let kind = discriminant(&step.command);
            let last = program.iter().rfind(|other| discriminant(&other.command) == kind);
            let is_needless = match step.command {
                Command::TakeOff { .. } => replace(&mut airborne, true),
                Command::SetSpeed { .. } => false,
                command => command.is_setting() && last.is_some_and(|last| last.command == command),
            };
            if !is_needless {
                program.push(step);
            }
        }
        program
    }
}

#[cfg(test)]
mod tests {
    use kinematics::Pose;

    use super::*;
    use crate::mission::tests::written;

    const TO: &[Command] = &[
        Command::SetReachDistance { distance_m: 0.2 },
        Command::SetStayDistance { distance_m: 0.5 },
        Command::SetStayTime { time_s: 0.3 },
        Command::GoTo(Pose { x_m: 1.0, y_m: 2.0, z_m: 1.5, yaw_deg: 90.0 }),
    ];
    const UP: &[Command] = &[TAKE_OFF];
    const DOWN: &[Command] = &[Command::Land];
    const START: &str = "setReference $START$\nsetSpeed 2.2\n";
    const SETTINGS: &str = "setInitialReachDist 0.2\nsetStayWithinDist 0.5\nsetStayTime 0.3\n";

    /// The steps from an item on, of a mission whose items have these commands.
    fn steps(mission: &[&[Command]], first: u16, airborne: bool) -> Vec<Step> {
        let steps = (0..).zip(mission).flat_map(|(item, commands)| {
            commands.iter().map(move |command| Step { item, command: *command })
        });
        let steps = steps.collect();
        Translated { steps, speed_m_s: 2.2, ..Translated::default() }.steps_from(first, airborne)
    }

    fn program(mission: &[&[Command]], first: u16, airborne: bool) -> String {
        written(&steps(mission, first, airborne))
    }

    fn items(steps: &[Step]) -> Vec<u16> {
        steps.iter().map(|step| step.item).collect()
    }

    const fn speed(speed_m_s: f64) -> [Command; 1] {
        [Command::SetSpeed { speed_m_s }]
    }

    #[test]
    fn each_step_has_its_item() {
        let steps = steps(&[UP, TO, DOWN], 0, false);
        assert_eq!(written(&steps), format!("{START}takeoff\n{SETTINGS}goto 1 2 1.5 90\nland\n"));
        assert_eq!(items(&steps), [0, 0, 0, 1, 1, 1, 1, 2]);
    }

    #[test]
    fn a_take_off_comes_first_on_the_ground_and_never_in_the_air() {
        let mission = [UP, TO, TO, DOWN];
        let on_ground = steps(&mission, 2, false);
        assert_eq!(
            written(&on_ground),
            format!("{START}takeoff\n{SETTINGS}goto 1 2 1.5 90\nland\n")
        );
        assert_eq!(items(&on_ground), [2, 2, 2, 2, 2, 2, 2, 3]);
        for first in 0..3 {
            assert!(!program(&mission, first, true).contains("takeoff"), "{first}");
        }
        // Behind a setting it is still the first that is flown.
        let later = program(&[&speed(1.0), UP], 0, false);
        assert_eq!(later, format!("{START}setSpeed 1\ntakeoff\n"));
        // In the air a second one means nothing.
        assert_eq!(program(&[TO, UP, TO], 0, false).matches("takeoff").count(), 1);
    }

    #[test]
    fn settings_are_made_where_they_change() {
        let longer = [TO[0], TO[1], Command::SetStayTime { time_s: 2.0 }, TO[3]];
        let expected =
            "goto 1 2 1.5 90\nsetStayTime 2\ngoto 1 2 1.5 90\nsetStayTime 0.3\ngoto 1 2 1.5 90\n";
        assert!(program(&[TO, &longer, TO], 0, true).ends_with(expected));
    }

    #[test]
    fn the_speed_in_effect_is_set() {
        let mission = [&speed(0.5), TO, &speed(1.0), TO];
        assert!(program(&mission, 1, true).starts_with("setReference $START$\nsetSpeed 0.5\n"));
        assert!(program(&mission, 3, true).starts_with("setReference $START$\nsetSpeed 1\n"));
    }

    #[test]
    fn there_are_no_steps_if_nothing_is_left_to_fly() {
        let mission = [TO, DOWN, &speed(1.0)];
        assert_eq!(steps(&mission, 1, false), []);
        assert_eq!(steps(&mission, 2, true), []);
        assert_eq!(steps(&mission, 9, true), []);
        assert_eq!(program(&mission, 1, true), format!("{START}land\nsetSpeed 1\n"));
    }
}
