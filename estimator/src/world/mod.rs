//! Where the odometry's frame lies in the world, how well that is known, and the tags on the floor that show it.
//!
//! The odometry remains the integral of the velocity: smooth, in a frame that drifts. This module estimates
//! position and direction of that frame in the world: `world = odometry + correction`, rotated by a heading
//! correction. Each sighting of a tag is compared with the odometry at the time of its picture, so
//! nothing has to be rolled back. The world frame is that of the start: right and forward of the drone's
//! initial position, unless the [`Start`] is elsewhere.
//!
//! Jumps of the correction do not reach the controller at once: see [`World::smooth`].

mod camera;
mod filter;
mod heading;
mod history;
mod known;
mod map;
mod orientation;
mod take_back;
#[cfg(test)]
mod tests;

use std::fmt;
use std::time::Duration;

use nalgebra::Vector2;

use self::camera::Look;
use self::filter::{Correction, Filter};
use self::history::{History, Moment};
pub use self::known::{KnownTag, KnownTags, SurveyedTag};
use self::map::Map;
use self::orientation::Orientation;
pub use self::orientation::OrientationSign;
use self::take_back::TakeBack;
use crate::Start;
use crate::sensor::FLOW_SCALE;
use kinematics::{body_from_world, world_from_body};

/// Maximum number of known tags.
pub const MAX_TAGS: usize = 8;
/// Known tags plus tags on trial.
const SLOTS: usize = MAX_TAGS + 3;
/// Maximum number of sightings in one packet.
pub const MAX_SIGHTS: usize = 4;

/// Camera and tags.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TagConfig {
    /// Tags with known positions. Other tags are found and mapped.
    pub surveyed: [Option<SurveyedTag>; MAX_TAGS],
    /// Age of a sighting when its packet is sent: exposure, processing, and half a packet's interval.
    pub delay: Duration,
    /// Focal length of the bottom camera, horizontal and vertical, in thousandths of its picture.
    pub focal_units: [f64; 2],
    /// Centre of its picture, in the same units.
    pub centre_units: [f64; 2],
    /// Diameter of the printed pattern.
    pub size_m: f64,
    /// Sign of the reported orientations, if known for this drone; otherwise it is determined in flight.
    pub orientation: Option<OrientationSign>,
}

impl Default for TagConfig {
    fn default() -> Self {
        Self {
            surveyed: [None; MAX_TAGS],
            delay: Duration::from_millis(60),
            focal_units: [1072.0, 1452.0],
            centre_units: [500.0, 450.0],
            size_m: 0.19,
            orientation: None,
        }
    }
}

/// A tag in the bottom camera's picture, as reported in navdata.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sight {
    /// Centre, 0 to 1000 from left to right.
    pub x: f64,
    /// Centre, 0 to 1000 from top to bottom.
    pub y: f64,
    /// Width of the box, in thousandths of the picture's width.
    pub width: f64,
    /// Height of the box, in thousandths of the picture's height.
    pub height: f64,
    /// Distance derived from the tag's apparent size.
    pub distance_m: f64,
    /// Orientation of the pattern in the picture; 270 when the drone is aligned with it. On its sign see [`OrientationSign`].
    pub orientation_deg: f64,
}

/// More than [`MAX_TAGS`] tags would be known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoRoom;

impl fmt::Display for NoRoom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "more than {MAX_TAGS} tags would be known")
    }
}

impl std::error::Error for NoRoom {}

/// Status of the tags.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TagStatus {
    /// The tags with known positions.
    pub known: KnownTags,
    /// Time since one of them was seen.
    pub seen_ago: Option<Duration>,
    /// Whether the sign of orientations is known, so that tags correct the heading too.
    pub heading_held: bool,
    /// Drift of the odometry since the start: (x, y) in the world.
    pub drift_m: Vector2<f64>,
    /// Number of tags that were given up, because they and the odometry moved against each other.
    pub given_up: u32,
    /// Whether a known tag should be in the picture, wherever within four of its deviations the drone is.
    pub is_due: bool,
}

/// Largest turn rate with a sharp and timely picture.
const FASTEST_TURN_DEG_S: f64 = 60.0;
/// Below this height a tag is hardly ever complete in the picture.
const LOWEST_M: f64 = 0.45;
/// A drone this low stands, even with its motors running.
const STANDS_M: f64 = 0.1;
/// Four standard deviations of the flow's bias on a bad day.
const MOST_BIAS_M_S: f64 = 0.09;
/// After a tag was seen to move, tags need more sightings for this long.
const CAUTIOUS_S: f64 = 30.0;
/// Standard deviation of the heading that each step of the compass leaves.
const HEADING_STEP_DEG: f64 = 2.0;
/// Time since a sighting during which a tag counts as in view.
const IN_VIEW_S: f64 = 0.5;
/// A tag is due that these errors of the position leave in the picture, from a drone this high and no faster: its picture
/// is whole, sharp and timely.
const DUE_DEVIATIONS: f64 = 4.0;
const DUE_LOWEST_M: f64 = 0.7;
const DUE_SLOW_M_S: f64 = 0.5;

/// The odometry's frame in the world, with the one covariance of all that is known of it, whether there are tags or not.
#[derive(Debug, Clone)]
pub(crate) struct World {
    /// `None` if tags are not used.
    config: Option<TagConfig>,
    /// Where the odometry began.
    start_m: Vector2<f64>,
    filter: Filter,
    map: Map,
    orientation: Orientation,
    history: History,
    take_back: TakeBack,
    last_sights: [Option<Sight>; MAX_SIGHTS],
    /// Last sighting of a known tag: its time, the arrival of its packet, and the odometry.
    fix: Option<Fix>,
    /// Until then tags have to prove that they do not move, because one did.
    cautious_until_s: f64,
    /// Unmeasured or disputed variance that has already been added.
    unseen_m2: f64,
    /// It has lifted off since it last stood.
    has_risen: bool,
    /// Tags that were given up because they moved.
    given_up: u32,
}

#[derive(Debug, Clone, Copy)]
struct Fix {
    at_s: f64,
    odometry_m: Vector2<f64>,
}

/// The odometry's newest step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OdometryStep {
    /// Time of the newest sample.
    pub(crate) made_s: f64,
    /// Time of the odometry.
    pub(crate) at_s: f64,
    pub(crate) place_m: Vector2<f64>,
    pub(crate) velocity_m_s: Vector2<f64>,
    pub(crate) yaw_deg: f64,
    /// Time and value of the tilt: right side down, nose up.
    pub(crate) tilt: (f64, Vector2<f64>),
    /// Time and value of the height above the floor.
    pub(crate) height: (f64, f64),
    /// The newest echo, which may be a wrong one.
    pub(crate) echo_m: f64,
    pub(crate) airborne: bool,
    /// Total variance from motion that was not measured.
    pub(crate) unseen_m2: f64,
}

impl World {
    pub(crate) fn new(config: Option<&TagConfig>, start: &Start) -> Self {
        let surveyed = config.map_or([None; MAX_TAGS], |config| config.surveyed);
        let mut filter = Filter::new(surveyed.iter().any(Option::is_some), start);
        let map = Map::new(&surveyed, &mut filter);
        Self {
            start_m: start.place_m,
            filter,
            map,
            orientation: Orientation::new(config.and_then(|config| config.orientation)),
            history: History::new(),
            take_back: TakeBack::default(),
            last_sights: [None; MAX_SIGHTS],
            fix: None,
            cautious_until_s: f64::NEG_INFINITY,
            unseen_m2: 0.0,
            has_risen: false,
            given_up: 0,
            config: config.copied(),
        }
    }

    /// Adds tags that are surveyed in flight; the odometry is at `odometry_m`.
    pub(crate) fn survey(
        &mut self,
        tags: &[SurveyedTag],
        odometry_m: Vector2<f64>,
    ) -> Result<(), NoRoom> {
        if !self.map.has_room_for(&self.filter, tags) {
            return Err(NoRoom);
        }
        let before = self.filter.correction();
        if !tags.is_empty() && !self.map.has_surveyed() {
            self.filter.doubt_frame(self.place_m(odometry_m));
        }
        for tag in tags {
            if let Some(slot) = self.map.survey(&mut self.filter, tag) {
                self.orientation.forget(slot);
            }
        }
        self.take_back_jump(before);
        Ok(())
    }

    /// The estimate has jumped since `before`: the reference jumps along and then moves back.
    fn take_back_jump(&mut self, before: Correction) {
        let after = self.filter.correction();
        self.take_back
            .jumped(after.place_m - before.place_m, after.heading_rad - before.heading_rad);
    }

    /// The odometry has advanced.
    pub(crate) fn fly(&mut self, step: &OdometryStep) {
        if let Some((way_m, step_s)) = self.history.push(step) {
            let flown_s = if step.airborne { step_s } else { 0.0 };
            self.filter.fly(way_m, step.yaw_deg, flown_s);
        }
        let unseen_m2 = (step.unseen_m2 - self.unseen_m2).max(0.0);
        self.unseen_m2 = step.unseen_m2;
        // Before it lifts off, a drone with its motors running measures nothing, and does not move. After a gap its height may not
        // be believed yet.
        self.has_risen |= step.airborne && step.height.1.max(step.echo_m) > STANDS_M;
        if self.has_risen {
            self.filter.doubt_place(unseen_m2);
        }
        self.has_risen &= step.airborne;
    }

    /// The compass made a step, which was compensated.
    pub(crate) fn step_of_the_heading(&mut self) {
        self.filter.doubt_heading(HEADING_STEP_DEG.to_radians());
    }

    /// The drone has restarted: its earlier data are obsolete. `unseen_m2` is the variance of the way that it has moved since.
    pub(crate) fn handle_restart(&mut self, unseen_m2: f64) {
        self.filter.doubt_place(unseen_m2);
        self.history = History::new();
        self.last_sights = [None; MAX_SIGHTS];
    }

    /// Processes the sightings of the newest packet. `yaw_deg` is the odometry's heading at a time,
    /// `turn_deg_s` the turn rate.
    pub(crate) fn see(
        &mut self,
        sights: &[Sight],
        yaw_deg: impl Fn(f64) -> f64,
        turn_deg_s: f64,
        airborne: bool,
    ) {
        let Some(config) = self.config else { return };
        let mut newest = [None; MAX_SIGHTS];
        for (slot, sight) in newest.iter_mut().zip(sights) {
            *slot = Some(*sight);
        }
        // Packets come more often than pictures: identical values are the same picture.
        if std::mem::replace(&mut self.last_sights, newest) == newest || !airborne {
            return;
        }
        let Some(made_s) = self.history.newest_s() else { return };
        let at_s = made_s - config.delay.as_secs_f64();
        let Some(moment) = self.history.at(at_s, yaw_deg(at_s)) else { return };
        if moment.height_m < LOWEST_M || turn_deg_s.abs() > FASTEST_TURN_DEG_S {
            return;
        }
        self.map.forget_old(&mut self.filter, made_s);
        let before = self.filter.correction();
        let mut seen = [false; SLOTS];
        for sight in newest.iter().flatten() {
            if let Some(look) = Look::new(sight, &moment, &config) {
                self.take_in(&look, &moment, made_s, &mut seen);
            }
        }
        self.take_back_jump(before);
    }

    fn take_in(&mut self, look: &Look, moment: &Moment, made_s: f64, seen: &mut [bool; SLOTS]) {
        let way_m = self.way_since_fix_m(moment);
        let sighted = self.filter.sighted(look, moment, way_m);
        let tag = self.map.associate(&mut self.filter, &sighted, seen, made_s);
        let Some(tag) = tag else { return };
        seen[tag] = true;
        if self.map.is_new(tag) {
            self.orientation.forget(tag);
        }
        let is_cautious = made_s < self.cautious_until_s;
        if self.map.is_known(tag) || self.map.is_likely(tag) && !is_cautious {
            let off_m = sighted.place_m - self.filter.tag_place_m(tag);
            self.map.watch(tag, off_m, look.height_m, look.offset_m.norm(), moment.speed_m_s);
            self.filter.correct(&sighted, tag);
            if !self.map.is_known(tag) && self.filter.bias_m_s().norm() > MOST_BIAS_M_S {
                self.filter.forget_bias();
            }
        }
        if !self.map.is_known(tag) {
            self.orientation.saw_on_trial(
                tag,
                self.heading_deg(moment.yaw_deg),
                look.orientation_deg,
            );
        }
        let Self { map, filter, orientation, .. } = self;
        let known = map.saw(filter, orientation, tag, made_s, way_m, is_cautious);
        if let Some(tag) = known {
            seen[tag] = true;
            self.fix = Some(Fix { at_s: made_s, odometry_m: moment.place_m });
            self.orient(tag, look, moment);
            self.distrust_what_moves(tag, made_s);
        }
    }

    /// Distrusts a moving tag, which would drag the position along: its residuals do not average out, or
    /// imply an impossible bias of the flow.
    fn distrust_what_moves(&mut self, tag: usize, made_s: f64) {
        /// Position error that a moving tag may have caused before its detection.
        const LED_ASTRAY_M: f64 = 0.2;
        if self.map.moves(tag) || self.filter.bias_m_s().norm() > MOST_BIAS_M_S {
            self.map.forget_moving(&mut self.filter, tag);
            self.given_up = self.given_up.saturating_add(1);
            self.orientation.forget(tag);
            self.filter.forget_bias();
            self.filter.doubt_place(LED_ASTRAY_M * LED_ASTRAY_M);
            self.cautious_until_s = made_s + CAUTIOUS_S;
        }
    }

    fn way_since_fix_m(&self, moment: &Moment) -> f64 {
        self.fix.map_or(moment.place_m.norm(), |fix| (moment.place_m - fix.odometry_m).norm())
    }

    /// Transforms a position from the odometry to the world frame.
    pub(crate) fn place_m(&self, odometry_m: Vector2<f64>) -> Vector2<f64> {
        odometry_m + self.filter.correction().place_m
    }

    /// Transforms a velocity from the odometry to the world frame, at its heading.
    pub(crate) fn velocity_m_s(&self, odometry_m_s: Vector2<f64>, yaw_deg: f64) -> Vector2<f64> {
        let heading_deg = self.heading_deg(yaw_deg);
        self.turned(odometry_m_s) - world_from_body(self.filter.bias_m_s(), heading_deg)
    }

    /// Rotates a direction from the odometry to the world frame.
    pub(crate) fn turned(&self, odometry: Vector2<f64>) -> Vector2<f64> {
        world_from_body(odometry, self.filter.correction().heading_rad.to_degrees())
    }

    pub(crate) fn heading_deg(&self, yaw_deg: f64) -> f64 {
        yaw_deg + self.filter.correction().heading_rad.to_degrees()
    }

    /// Standard deviation of the position on the worse axis, at this odometry and height, without the
    /// contribution of silence.
    pub(crate) fn uncertainty_m(&self, odometry_m: Vector2<f64>, height_m: f64) -> f64 {
        /// Tilt, delay and the picture's centre do not average out: a fraction of the height.
        const SYSTEMATIC: f64 = 0.012;
        const FLOOR_M: f64 = 0.015;
        let (way_m, tilted_m) = match self.fix {
            Some(fix) => ((odometry_m - fix.odometry_m).norm(), SYSTEMATIC * height_m),
            None => (odometry_m.norm(), 0.0),
        };
        let squares = FLOOR_M.powi(2) + (FLOW_SCALE * way_m).powi(2) + tilted_m.powi(2);
        (self.filter.place_variance_m2() + squares).sqrt()
    }

    /// Moves the reference back towards the estimate.
    pub(crate) fn advance(&mut self, step_s: f64) {
        self.take_back.advance(step_s);
    }

    /// Position, velocity and heading for the controller: without the jumps of the corrections, which become
    /// a motion over time.
    pub(crate) fn smooth(
        &self,
        place_m: Vector2<f64>,
        velocity_m_s: Vector2<f64>,
        yaw_deg: f64,
    ) -> (Vector2<f64>, Vector2<f64>, f64) {
        let left = &self.take_back;
        (place_m - left.place_m(), velocity_m_s - left.rate_m_s(), yaw_deg - left.heading_deg())
    }

    /// Standard deviation of the heading.
    pub(crate) fn heading_uncertainty_deg(&self) -> f64 {
        self.filter.heading_uncertainty_deg()
    }

    /// The known tags; `None` if tags are not used.
    pub(crate) fn status(&self, now_s: f64) -> Option<TagStatus> {
        self.config.as_ref()?;
        Some(TagStatus {
            known: self.map.known_tags(&self.filter, now_s),
            seen_ago: self.fix.map(|fix| Duration::from_secs_f64((now_s - fix.at_s).max(0.0))),
            heading_held: self.orientation.sign().is_some(),
            drift_m: self.start_m - self.filter.correction().place_m,
            given_up: self.given_up,
            is_due: false,
        })
    }

    /// Whether a known tag should be in the picture of a drone at this moment, wherever within [`DUE_DEVIATIONS`] of this
    /// deviation it is.
    pub(crate) fn is_due(&self, now_s: f64, moment_yaw_deg: f64, uncertainty_m: f64) -> bool {
        let Some(config) = &self.config else { return false };
        let Some(moment) = self.history.at(now_s, moment_yaw_deg) else { return false };
        if moment.height_m < DUE_LOWEST_M || moment.speed_m_s > DUE_SLOW_M_S {
            return false;
        }
        let (here_m, yaw_deg) = (self.place_m(moment.place_m), self.heading_deg(moment.yaw_deg));
        let known = self.map.known_tags(&self.filter, now_s);
        known.iter().any(|tag| {
            let offset_m = body_from_world(tag.place_m - here_m, yaw_deg);
            let margin_m = DUE_DEVIATIONS * uncertainty_m.hypot(tag.uncertainty_m);
            camera::is_surely_whole(offset_m, margin_m, &moment, config)
        })
    }

    /// Whether a turn would reveal the sign of orientations.
    pub(crate) fn would_learn_from_a_turn(&self, now_s: f64) -> bool {
        let in_view = self.fix.is_some_and(|fix| now_s - fix.at_s < IN_VIEW_S);
        in_view && self.orientation.sign().is_none()
    }
}
