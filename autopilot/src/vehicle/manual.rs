//! What an operator does with the drone by hand.

use std::time::Duration;

use kinematics::{Pose, Sticks};
use pid::Course;

use super::Setpoint;
use crate::agent::{SetpointPercept, distance};

/// Manual control of the current flight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Manual {
    /// What the agent is told in the next tick. It handles one pre-empting goal in a step, so of several orders in a tick it
    /// gets the last; one that stayed for later would end whatever was ordered after it. Nothing else is offered meanwhile.
    pub(super) goal: Option<Goal>,
    pub(super) mode: Mode,
    /// The course that was flown in the last tick.
    pub(super) flown: Option<Course>,
}

/// A pre-empting goal of the agent, besides landing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Goal {
    Hold,
    Steer,
    Follow,
    NewMission,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) enum Mode {
    /// No manual control: the mission is flown.
    #[default]
    Mission,
    /// The mission is paused, and the drone holds.
    Hold,
    Steered {
        sticks: Sticks,
        until: Duration,
    },
    SentTo {
        place: Pose,
        /// The target has been handed to the agent.
        offered: bool,
    },
    Following {
        setpoint: Setpoint,
        /// When it came.
        at: Duration,
        /// Where it wants the drone now.
        target: Pose,
        /// The way there.
        course: Course,
        /// The agent has stopped following, and waits for whoever sent the setpoints.
        stopped: bool,
    },
}

/// What an operator does with the drone by hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ManualControl {
    /// It holds.
    Hold,
    /// It flies as the sticks say.
    Sticks,
    /// It flies to a place.
    Target,
    /// It follows setpoints.
    Setpoints,
}

impl ManualControl {
    /// Its name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Hold => "hold",
            Self::Sticks => "sticks",
            Self::Target => "target",
            Self::Setpoints => "setpoints",
        }
    }
}

impl Manual {
    /// Nobody flies by hand.
    pub(super) const NONE: Self = Self { goal: None, mode: Mode::Mission, flown: None };

    /// Whether the mission is paused.
    pub(super) fn pauses_mission(&self) -> bool {
        self.mode != Mode::Mission
    }

    /// The current stick input; `None` once it has expired.
    pub(super) fn sticks(&self, now: Duration) -> Option<Sticks> {
        match self.mode {
            Mode::Steered { sticks, until } if now < until => Some(sticks),
            _ => None,
        }
    }

    /// What the operator does; `None` if the mission is not paused.
    pub(super) fn control(&self, now: Duration) -> Option<ManualControl> {
        Some(match self.mode {
            Mode::Mission => return None,
            Mode::Steered { until, .. } if now < until => ManualControl::Sticks,
            Mode::SentTo { .. } => ManualControl::Target,
            Mode::Following { stopped: false, .. } => ManualControl::Setpoints,
            Mode::Hold | Mode::Steered { .. } | Mode::Following { .. } => ManualControl::Hold,
        })
    }

    /// The setpoints that are followed, or were until they stopped.
    pub(super) fn setpoint(&self, now: Duration) -> Option<SetpointPercept> {
        let Mode::Following { at, target, course, .. } = self.mode else { return None };
        let age = now.saturating_sub(at);
        Some(SetpointPercept {
            pose: target,
            reached: Pose { x_m: course.position_m.x, y_m: course.position_m.y, ..target },
            age_ms: i64::try_from(age.as_millis()).unwrap_or(i64::MAX),
        })
    }

    /// The way to the target of the setpoints that are followed, if this is it. Its heading may differ.
    pub(super) fn course(&self, to: &Pose) -> Option<&Course> {
        match &self.mode {
            Mode::Following { target, course, stopped: false, .. }
                if distance(target, to) <= f64::EPSILON =>
            {
                Some(course)
            }
            _ => None,
        }
    }

    /// The mission was replaced. A paused mission stays paused.
    pub(super) fn mission_replaced(&mut self) {
        if self.pauses_mission() {
            self.mode = Mode::Hold;
        }
        self.goal = Some(Goal::NewMission);
    }

    /// Whether a manual target is being flown to.
    pub(super) fn sends(&self) -> bool {
        matches!(self.mode, Mode::SentTo { .. })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector2;

    use super::*;
    use crate::vehicle::{Heading, Horizontal, Vertical};

    #[test]
    fn stick_input_expires() {
        let (sticks, until) = (Sticks { roll: 0.5, ..Sticks::default() }, Duration::from_secs(5));
        let manual = Manual { mode: Mode::Steered { sticks, until }, ..Manual::default() };
        let last = until.saturating_sub(Duration::from_millis(1));
        assert_eq!(manual.sticks(last), Some(sticks));
        assert_eq!(manual.sticks(until), None);
        assert_eq!(manual.control(last), Some(ManualControl::Sticks));
        assert_eq!(manual.control(until), Some(ManualControl::Hold), "then it holds");
        assert_eq!(Manual::default().sticks(last), None);
        assert!(!manual.sends(), "no place was given");
        let mode = Mode::SentTo { place: Pose::default(), offered: false };
        assert!(Manual { mode, ..manual }.sends());
    }

    #[test]
    fn what_is_done_by_hand_is_named_like_its_variants() {
        for control in [
            ManualControl::Hold,
            ManualControl::Sticks,
            ManualControl::Target,
            ManualControl::Setpoints,
        ] {
            assert_eq!(control.name(), format!("{control:?}").to_lowercase());
        }
    }

    const TARGET: Pose = Pose { x_m: 1.0, y_m: 2.0, z_m: 1.5, yaw_deg: 30.0 };

    fn following(stopped: bool) -> Manual {
        let setpoint = Setpoint {
            horizontal: Horizontal::Place { x_m: TARGET.x_m, y_m: TARGET.y_m },
            vertical: Vertical::Height(TARGET.z_m),
            heading: Heading::Yaw(TARGET.yaw_deg),
        };
        let course = Course::new(Vector2::new(0.25, 0.5), Vector2::zeros());
        let at = Duration::from_secs(5);
        let mode = Mode::Following { setpoint, at, target: TARGET, course, stopped };
        Manual { mode, ..Manual::default() }
    }

    #[test]
    fn set_points_have_got_as_far_as_their_course() {
        let percept = following(false).setpoint(Duration::from_millis(5400)).unwrap();
        assert_eq!((percept.pose, percept.age_ms), (TARGET, 400));
        assert_eq!(percept.reached, Pose { x_m: 0.25, y_m: 0.5, ..TARGET });
        assert_eq!(Manual::default().setpoint(Duration::from_secs(6)), None);
    }

    #[test]
    fn the_course_leads_to_the_target_of_set_points_that_are_followed_and_nowhere_else() {
        let leads = |stopped, to| following(stopped).course(&to).is_some();
        assert!(leads(false, TARGET));
        assert!(leads(false, Pose { yaw_deg: -90.0, ..TARGET }), "its heading may differ");
        assert!(!leads(false, Pose { x_m: 1.001, ..TARGET }));
        assert!(!leads(true, TARGET), "it has stopped");
        assert_eq!(Manual::default().course(&TARGET), None);
    }
}
