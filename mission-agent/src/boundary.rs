//! What an agent senses in a step, and what it orders and says: the functions that `agents/boundary.conf` declares.

use std::fmt::{self, Write as _};
use std::time::Duration;

use arrayvec::{ArrayString, ArrayVec};
use kinematics::Pose;

/// Longest line between agents, in bytes.
pub const MAX_LINE: usize = 192;

/// Most lines that an agent says in a step.
const MAX_SAID: usize = 64;

/// A message between agents as text: `VERSION SENDER MESSAGE`.
pub type Line = ArrayString<MAX_LINE>;

/// What has not been said for so long is no longer said again and again.
pub const SAID_AGAIN_WITHIN: Duration = Duration::from_secs(3);

/// A message without its values. Messages of one kind count as the same one said again, even with other numbers.
pub fn kind(message: &str) -> &str {
    message.split_once('(').map_or(message, |(kind, _)| kind)
}

/// What an agent says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Said {
    /// The peer to which it is said: the name of its vehicle.
    pub to: &'static str,
    /// The whole line, with version and sender.
    pub line: Line,
}

impl Said {
    /// What it says, without version and sender.
    pub fn text(&self) -> &str {
        text(&self.line)
    }
}

/// What a line says, without version and sender.
pub fn text(line: &str) -> &str {
    line.splitn(3, ' ').nth(2).unwrap_or_default()
}

/// Who says a line, by itself.
pub fn sender(line: &str) -> &str {
    line.split(' ').nth(1).unwrap_or_default()
}

/// What an agent wants of its pilot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Wanted {
    Keep,
    TakeOff,
    Hover,
    FlyTo(Pose),
    Follow(Pose),
    Land { on_tag: bool },
    Finish,
}

/// What an agent senses.
#[allow(clippy::struct_excessive_bools, reason = "each is a sense of its own")]
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Sensed {
    pub(crate) now_ms: i64,
    pub(crate) pose: Option<Pose>,
    pub(crate) battery_percent: Option<u32>,
    pub(crate) on_ground: bool,
    pub(crate) flying: bool,
    pub(crate) obeyed: bool,
    pub(crate) tags_in_use: bool,
}

/// What an agent has said, until it is taken.
#[derive(Debug, Default)]
pub(crate) struct Outbox {
    pub(crate) said: ArrayVec<Said, MAX_SAID>,
    /// Lines for which there was no room.
    pub(crate) unsaid: u64,
}

/// One step of an agent: its senses, its order, and what it says.
#[derive(Debug)]
pub(crate) struct Step<'a> {
    pub(crate) sensed: Sensed,
    pub(crate) places: &'a [Pose],
    /// The number of the agent among its peers.
    pub(crate) me: u8,
    /// The last order of the step; an agent without one keeps to what goes on.
    pub(crate) wanted: Wanted,
    outbox: &'a mut Outbox,
}

impl<'a> Step<'a> {
    pub(crate) fn new(sensed: Sensed, places: &'a [Pose], me: u8, outbox: &'a mut Outbox) -> Self {
        Self { sensed, places, me, wanted: Wanted::Keep, outbox }
    }

    /// An agent says something to a peer.
    pub(crate) fn say(&mut self, to: &'static str, envelope: &dyn fmt::Display) {
        let mut line = Line::new();
        let fits = write!(line, "{envelope}").is_ok();
        if !fits || self.outbox.said.try_push(Said { to, line }).is_err() {
            self.outbox.unsaid += 1;
        }
    }

    fn place(&self, number: i32) -> Pose {
        let index = usize::try_from(number).ok().and_then(|number| number.checked_sub(1));
        index.and_then(|index| self.places.get(index)).copied().unwrap_or_default()
    }
}

fn pose(x_m: f64, y_m: f64, z_m: f64, yaw_deg: f64) -> Pose {
    Pose { x_m, y_m, z_m, yaw_deg }
}

/// Under the names that the bindings have for them.
impl Step<'_> {
    pub(crate) fn keep(&mut self) {
        self.wanted = Wanted::Keep;
    }

    pub(crate) fn take_off(&mut self) {
        self.wanted = Wanted::TakeOff;
    }

    pub(crate) fn hover(&mut self) {
        self.wanted = Wanted::Hover;
    }

    pub(crate) fn fly_to(&mut self, x_m: f64, y_m: f64, height_m: f64, yaw_deg: f64) {
        self.wanted = Wanted::FlyTo(pose(x_m, y_m, height_m, yaw_deg));
    }

    pub(crate) fn fly_through(&mut self, x_m: f64, y_m: f64, height_m: f64, yaw_deg: f64) {
        self.fly_to(x_m, y_m, height_m, yaw_deg);
    }

    pub(crate) fn follow(&mut self, x_m: f64, y_m: f64, height_m: f64, yaw_deg: f64) {
        self.wanted = Wanted::Follow(pose(x_m, y_m, height_m, yaw_deg));
    }

    pub(crate) fn land(&mut self) {
        self.wanted = Wanted::Land { on_tag: false };
    }

    pub(crate) fn land_on_tag(&mut self) {
        self.wanted = Wanted::Land { on_tag: true };
    }

    pub(crate) fn finish(&mut self) {
        self.wanted = Wanted::Finish;
    }

    pub(crate) fn now(&mut self) -> i64 {
        self.sensed.now_ms
    }

    pub(crate) fn on_ground(&mut self) -> bool {
        self.sensed.on_ground
    }

    pub(crate) fn flying(&mut self) -> bool {
        self.sensed.flying
    }

    pub(crate) fn obeyed(&mut self) -> bool {
        self.sensed.obeyed
    }

    pub(crate) fn tags_in_use(&mut self) -> bool {
        self.sensed.tags_in_use
    }

    pub(crate) fn near(&mut self, x_m: f64, y_m: f64, height_m: f64, within_m: f64) -> bool {
        self.sensed.pose.is_some_and(|pose| {
            let away = [pose.x_m - x_m, pose.y_m - y_m, pose.z_m - height_m];
            away.iter().map(|away| away * away).sum::<f64>() <= within_m * within_m
        })
    }

    pub(crate) fn places(&mut self) -> i32 {
        i32::try_from(self.places.len()).unwrap_or(i32::MAX)
    }

    pub(crate) fn place_x(&mut self, number: i32) -> f64 {
        self.place(number).x_m
    }

    pub(crate) fn place_y(&mut self, number: i32) -> f64 {
        self.place(number).y_m
    }

    pub(crate) fn place_height(&mut self, number: i32) -> f64 {
        self.place(number).z_m
    }

    pub(crate) fn place_yaw(&mut self, number: i32) -> f64 {
        self.place(number).yaw_deg
    }

    /// The belief `charge`.
    pub(crate) fn charge(&self) -> Option<(i64,)> {
        self.sensed.battery_percent.map(|percent| (percent.into(),))
    }

    /// The belief `position`.
    pub(crate) fn position(&self) -> Option<(f64, f64, f64, f64)> {
        self.sensed.pose.map(|Pose { x_m, y_m, z_m, yaw_deg }| (x_m, y_m, z_m, yaw_deg))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACES: [Pose; 1] = [Pose { x_m: 1.0, y_m: 2.0, z_m: 1.5, yaw_deg: 30.0 }];

    #[test]
    fn places_are_counted_from_one_and_others_are_at_the_origin() {
        let mut outbox = Outbox::default();
        let mut step = Step::new(Sensed::default(), &PLACES, 0, &mut outbox);
        assert_eq!((step.places(), step.place_x(1), step.place_height(1)), (1, 1.0, 1.5));
        for number in [0, 2, -1, i32::MIN, i32::MAX] {
            assert_eq!((step.place_x(number), step.place_yaw(number)), (0.0, 0.0), "{number}");
        }
    }

    #[test]
    fn near_is_within_a_distance_and_nowhere_for_a_drone_without_a_place() {
        let pose = Some(Pose { x_m: 1.0, y_m: 2.0, z_m: 1.0, yaw_deg: 0.0 });
        let mut outbox = Outbox::default();
        let mut step = Step::new(Sensed { pose, ..Sensed::default() }, &PLACES, 0, &mut outbox);
        assert!(step.near(1.3, 2.0, 1.4, 0.51) && !step.near(1.3, 2.0, 1.4, 0.49));
        assert!(!step.near(f64::NAN, 2.0, 1.0, 9.0));
        assert!(!Step::new(Sensed::default(), &PLACES, 0, &mut outbox).near(0.0, 0.0, 0.0, 9.0));
    }

    #[test]
    fn what_does_not_fit_is_counted() {
        let mut outbox = Outbox::default();
        let mut step = Step::new(Sensed::default(), &PLACES, 0, &mut outbox);
        step.say("b", &"x".repeat(MAX_LINE + 1));
        for _ in 0..=MAX_SAID {
            step.say("b", &"0 a tell at(1.0, 2.0)");
        }
        assert_eq!((outbox.said.len(), outbox.unsaid), (MAX_SAID, 2));
        assert_eq!(outbox.said[0].text(), "tell at(1.0, 2.0)");
    }
}
