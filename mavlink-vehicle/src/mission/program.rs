//! A checked mission as commands of the plan language.

use std::fmt;

use kinematics::Pose;

/// A target is reached within this distance, in metres.
pub(super) const REACH_M: f64 = 0.2;

/// A part of a mission as a flight plan. It sets all that it depends on, so that no mission flown before counts.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Program {
    /// One command in each line; empty if nothing is left to fly.
    pub text: String,
    /// The item to which each line belongs.
    pub items: Vec<u16>,
}

/// A mission of which each item can be flown.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Translated {
    pub(super) steps: Vec<Step>,
    /// Speed limit where the mission sets none, in metres per second.
    pub(super) speed_m_s: f64,
    /// What is flown otherwise than an item says, for a person.
    pub(super) limited: Vec<String>,
}

/// What is to be done for an item; an item may have several steps, or none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Step {
    pub(super) item: u16,
    pub(super) action: Action,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Action {
    TakeOff,
    /// To a pose in our frame.
    GoTo {
        pose: Pose,
        reach_m: f64,
        stay_s: f64,
    },
    /// Where the drone is: no item before has a place.
    Stay {
        stay_s: f64,
    },
    Land,
    Speed {
        limit_m_s: f64,
    },
}

impl Translated {
    /// What is flown otherwise than an item says, because it was outside the limits: for a person, each at most 100 bytes.
    pub fn limited(&self) -> &[String] {
        &self.limited
    }

    /// The commands from item `first` on. On the ground a take-off is put in front if none comes first; with the
    /// drone `airborne` there is none. A stay or a turn begins with the way to its place. What does not end with a
    /// landing is held at its end.
    pub fn commands_from(&self, first: u16, airborne: bool) -> Program {
        let begin = self.steps.partition_point(|step| step.item < first);
        let (before, steps) = self.steps.split_at(begin);
        let speed_m_s = before.iter().rev().find_map(|step| match step.action {
            Action::Speed { limit_m_s } => Some(limit_m_s),
            _ => None,
        });
        let is_flight = |step: &&Step| !matches!(step.action, Action::Speed { .. } | Action::Land);
        let is_landing = |step: &Step| step.action == Action::Land;
        if !steps.iter().any(|step| is_flight(&step) || airborne && is_landing(step)) {
            return Program::default();
        }
        let takes_off = || {
            let first = steps.iter().find(is_flight);
            first.is_some_and(|step| step.action == Action::TakeOff)
        };
        let mut writer = Writer::default();
        writer.line(first, format_args!("setReference $START$"));
        writer.speed(first, speed_m_s.unwrap_or(self.speed_m_s));
        let mut airborne = airborne;
        if !airborne && !takes_off() {
            writer.line(first, format_args!("takeoff"));
            airborne = true;
        }
        for step in steps {
            match step.action {
                Action::TakeOff if airborne => {}
                Action::TakeOff => {
                    writer.line(step.item, format_args!("takeoff"));
                    airborne = true;
                }
                Action::GoTo { pose, reach_m, stay_s } => {
                    writer.settings(step.item, reach_m, stay_s);
                    let [x, y, z, yaw] = [pose.x_m, pose.y_m, pose.z_m, pose.yaw_deg].map(Number);
                    writer.line(step.item, format_args!("goto {x} {y} {z} {yaw}"));
                }
                Action::Stay { stay_s } => {
                    writer.settings(step.item, REACH_M, stay_s);
                    writer.line(step.item, format_args!("moveByRel 0 0 0 0"));
                }
                Action::Land => writer.line(step.item, format_args!("land")),
                Action::Speed { limit_m_s } => writer.speed(step.item, limit_m_s),
            }
        }
        writer.program
    }
}

/// Writes lines, and settings only where they change.
#[derive(Default)]
struct Writer {
    program: Program,
    reach_m: Option<f64>,
    stay_s: Option<f64>,
}

impl Writer {
    fn line(&mut self, item: u16, command: fmt::Arguments<'_>) {
        // Writing to a text cannot fail.
        _ = fmt::Write::write_fmt(&mut self.program.text, command);
        self.program.text.push('\n');
        self.program.items.push(item);
    }

    fn speed(&mut self, item: u16, limit_m_s: f64) {
        self.line(item, format_args!("setSpeed {}", Number(limit_m_s)));
    }

    fn settings(&mut self, item: u16, reach_m: f64, stay_s: f64) {
        if self.reach_m.replace(reach_m) != Some(reach_m) {
            self.line(item, format_args!("setInitialReachDist {}", Number(reach_m)));
            // A drone that has just reached its target must not be too far from it to stay.
            let within_m = Number((reach_m + 0.3).max(0.5));
            self.line(item, format_args!("setStayWithinDist {within_m}"));
        }
        if self.stay_s.replace(stay_s) != Some(stay_s) {
            self.line(item, format_args!("setStayTime {}", Number(stay_s)));
        }
    }
}

/// A number with four digits behind the point at most.
struct Number(f64);

impl fmt::Display for Number {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rounded = (self.0 * 1e4).round() / 1e4;
        // Neither -0 nor an exponent.
        write!(formatter, "{}", rounded + 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_plain() {
        for (number, text) in
            [(0.0, "0"), (-0.0, "0"), (-0.000_04, "0"), (1.234_56, "1.2346"), (-10.5, "-10.5")]
        {
            assert_eq!(Number(number).to_string(), text);
        }
    }

    fn program(actions: &[Action], first: u16, airborne: bool) -> Program {
        let steps = (0..).zip(actions).map(|(item, &action)| Step { item, action }).collect();
        Translated { steps, speed_m_s: 2.2, ..Translated::default() }.commands_from(first, airborne)
    }

    const TO: Action = Action::GoTo {
        pose: Pose { x_m: 1.0, y_m: 2.0, z_m: 1.5, yaw_deg: 90.0 },
        reach_m: 0.2,
        stay_s: 0.3,
    };
    const START: &str = "setReference $START$\nsetSpeed 2.2\n";
    const SETTINGS: &str = "setInitialReachDist 0.2\nsetStayWithinDist 0.5\nsetStayTime 0.3\n";

    #[test]
    fn each_line_has_its_item() {
        let Program { text, items } = program(&[Action::TakeOff, TO, Action::Land], 0, false);
        assert_eq!(text, format!("{START}takeoff\n{SETTINGS}goto 1 2 1.5 90\nland\n"));
        assert_eq!(items, [0, 0, 0, 1, 1, 1, 1, 2]);
    }

    #[test]
    fn a_take_off_comes_first_on_the_ground_and_never_in_the_air() {
        let mission = [Action::TakeOff, TO, TO, Action::Land];
        let on_ground = program(&mission, 2, false);
        assert_eq!(on_ground.text, format!("{START}takeoff\n{SETTINGS}goto 1 2 1.5 90\nland\n"));
        assert_eq!(on_ground.items, [2, 2, 2, 2, 2, 2, 2, 3]);
        for first in 0..3 {
            assert!(!program(&mission, first, true).text.contains("takeoff"), "{first}");
        }
        // Behind a setting it is still the first that is flown.
        let later = program(&[Action::Speed { limit_m_s: 1.0 }, Action::TakeOff], 0, false);
        assert_eq!(later.text, format!("{START}setSpeed 1\ntakeoff\n"));
        // In the air a second one means nothing.
        let twice = program(&[TO, Action::TakeOff, TO], 0, false);
        assert_eq!(twice.text.matches("takeoff").count(), 1);
    }

    #[test]
    fn the_speed_in_effect_is_set() {
        let mission = [Action::Speed { limit_m_s: 0.5 }, TO, Action::Speed { limit_m_s: 1.0 }, TO];
        assert!(
            program(&mission, 1, true).text.starts_with("setReference $START$\nsetSpeed 0.5\n")
        );
        assert!(program(&mission, 3, true).text.starts_with("setReference $START$\nsetSpeed 1\n"));
    }

    #[test]
    fn nothing_is_written_if_nothing_is_left_to_fly() {
        let mission = [TO, Action::Land, Action::Speed { limit_m_s: 1.0 }];
        assert_eq!(program(&mission, 1, false), Program::default());
        assert_eq!(program(&mission, 2, true), Program::default());
        assert_eq!(program(&mission, 9, true), Program::default());
        assert_eq!(program(&mission, 1, true).text, format!("{START}land\nsetSpeed 1\n"));
    }

    #[test]
    fn a_stay_without_a_place_is_where_the_drone_is() {
        let text = program(&[Action::Stay { stay_s: 5.0 }], 0, true).text;
        assert!(text.ends_with("setStayTime 5\nmoveByRel 0 0 0 0\n"), "{text}");
    }
}
