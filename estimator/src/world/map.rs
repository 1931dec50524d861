//! The known tags, and the association of sightings with them.
//!
//! A sighting where no tag is known creates a tag on trial at once, so that little of the drift before its
//! first sighting is lost. After enough sightings it becomes known; otherwise it is forgotten.

mod directions;
mod survey;

use std::time::Duration;

use nalgebra::Vector2;

use self::directions::Direction;
use super::filter::{Filter, Sighted};
use super::orientation::Orientation;
use super::{KnownTag, KnownTags, MAX_TAGS, SLOTS, SurveyedTag};

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Standing {
    #[default]
    Free,
    /// On trial, with its number of sightings.
    OnTrial(u32),
    Known,
}

#[derive(Debug, Clone, Copy, Default)]
struct Slot {
    standing: Standing,
    /// Number of a known tag.
    id: u32,
    surveyed: bool,
    direction: Direction,
    seen_s: f64,
    /// Mean residual of its sightings, and whether it is too large.
    off_m: Vector2<f64>,
    moves: bool,
    /// Mean residual of its direction.
    turned_deg: f64,
}

#[derive(Debug, Clone)]
pub(super) struct Map {
    slots: [Slot; SLOTS],
    /// Number of tags that have been known so far.
    numbered: u32,
}

/// Minimum ratio of the distance of the second nearest tag to that of the nearest.
const RUNNER_UP: f64 = 2.0;
/// Number of sightings after which a tag on trial becomes known, and after which it is recognised as one that
/// was known before.
const ENOUGH: u32 = 10;
const AGAIN: u32 = 5;
/// Number of sightings after which a tag on trial corrects the position.
const LIKELY: u32 = 3;
/// The same after another tag has moved; all of them must agree.
const STILL: u32 = 60;
/// Number of sightings in the mean of the residuals.
const MEAN_SIGHTS: f64 = 8.0;
/// Largest mean residual of a tag that does not move: a constant, and fractions of height and offset.
const OFF_M: f64 = 0.03;
const OFF_HEIGHT: f64 = 0.025;
const OFF_ASIDE: f64 = 0.15;
/// Maximum speed for this check; at higher speeds delays cause residuals.
const SLOW_M_S: f64 = 0.4;
/// Time without sightings after which a tag on trial is forgotten.
const TRIAL_S: f64 = 2.0;
/// Time without sightings after which a tag is recognised only by several sightings: while the position is
/// uncertain, one sighting of something else must not decide it.
const IN_VIEW_S: f64 = 1.0;
/// Largest correction by a single sighting.
const NEAR_M: f64 = 0.3;
/// A new tag within this distance of a known tag that is no longer seen, and cannot be where it is, is that tag
/// after it was moved.
const MOVED_M: f64 = 1.0;
/// Expected number of tags per square metre that are not in the map. Where tags were surveyed, hardly one was
/// left out.
const OTHERS_1_M2: f64 = 0.1;
const NOT_SURVEYED_1_M2: f64 = 0.01;
/// Odds from which a tag on trial counts as a known one, and not as one that is not in the map yet: a wrong
/// position is worse than a lost correction.
const CERTAIN_ODDS: f64 = 10.0;

impl Map {
    pub(super) fn new(surveyed: &[Option<SurveyedTag>; MAX_TAGS], filter: &mut Filter) -> Self {
        let mut slots = [Slot::default(); SLOTS];
        let mut numbered = 0;
        for (tag, surveyed) in surveyed.iter().enumerate() {
            if let Some(SurveyedTag { place_m, heading_deg }) = surveyed {
                filter.survey_tag(tag, *place_m, heading_deg.map(f64::to_radians));
                numbered += 1;
                slots[tag] = Slot {
                    standing: Standing::Known,
                    id: numbered,
                    surveyed: true,
                    direction: Direction::given(heading_deg.is_some()),
                    seen_s: f64::NEG_INFINITY,
                    ..Slot::default()
                };
            }
        }
        Self { slots, numbered }
    }

    fn those(&self, wanted: fn(Standing) -> bool) -> impl Iterator<Item = usize> + '_ {
        (0..SLOTS).filter(move |tag| wanted(self.slots[*tag].standing))
    }

    pub(super) fn known(&self) -> usize {
        self.those(is_known).count()
    }

    /// The known tags with the time since each was seen.
    pub(super) fn known_tags(&self, filter: &Filter, now_s: f64) -> KnownTags {
        let known = self.those(is_known).map(|tag| {
            let Slot { id, surveyed, seen_s, .. } = self.slots[tag];
            KnownTag {
                id,
                place_m: filter.tag_place_m(tag),
                heading_deg: self.has_heading(tag).then(|| filter.tag_heading_deg(tag)),
                uncertainty_m: filter.tag_uncertainty_m(tag),
                surveyed,
                seen_ago: Duration::try_from_secs_f64((now_s - seen_s).max(0.0)).ok(),
            }
        });
        known.collect()
    }

    /// Forgets tags on trial that were not seen again.
    pub(super) fn forget_old(&mut self, filter: &mut Filter, now_s: f64) {
        for tag in 0..SLOTS {
            let slot = self.slots[tag];
            if is_on_trial(slot.standing) && now_s - slot.seen_s > TRIAL_S {
                self.forget(filter, tag);
            }
        }
    }

    /// The tag of a sighting; a new one if none is near. `None` if two tags are possible, if the tag was
    /// already seen in this packet, or if there is no room.
    pub(super) fn associate(
        &mut self,
        filter: &mut Filter,
        sighted: &Sighted,
        seen: &[bool; SLOTS],
        now_s: f64,
    ) -> Option<usize> {
        let far = |tag: usize| (filter.tag_place_m(tag) - sighted.place_m).norm();
        for wanted in [is_known, is_on_trial] {
            let in_view = |tag: &usize| now_s - self.slots[*tag].seen_s <= IN_VIEW_S;
            let nearest =
                self.those(wanted).filter(in_view).min_by(|a, b| far(*a).total_cmp(&far(*b)));
            let admitted = |tag: &usize| far(*tag) < NEAR_M && filter.admits(sighted, *tag);
            if let Some(nearest) = nearest.filter(admitted) {
                let alone = self
                    .those(wanted)
                    .filter(|tag| *tag != nearest)
                    .all(|tag| far(tag) >= RUNNER_UP * far(nearest));
                return (alone && !seen[nearest]).then_some(nearest);
            }
        }
        let free = self.those(|standing| standing == Standing::Free).next()?;
        filter.begin_tag(free, sighted);
        let standing = Standing::OnTrial(0);
        self.slots[free] = Slot { standing, seen_s: now_s, ..Slot::default() };
        None
    }

    /// A tag was seen again, `way_m` from the last known one. Returns the known tag that it turns out to be,
    /// if any.
    pub(super) fn saw(
        &mut self,
        filter: &mut Filter,
        orientation: &Orientation,
        tag: usize,
        now_s: f64,
        way_m: f64,
        is_cautious: bool,
    ) -> Option<usize> {
        self.slots[tag].seen_s = now_s;
        let Standing::OnTrial(sights) = self.slots[tag].standing else { return Some(tag) };
        self.slots[tag].standing = Standing::OnTrial(sights + 1);
        let (again, enough) = if is_cautious { (STILL, STILL) } else { (AGAIN, ENOUGH) };
        if sights < again {
            return None;
        }
        if let Some(known) = self.recognised(filter, orientation, tag, now_s, way_m) {
            filter.make_one(tag, known, way_m);
            self.forget(filter, tag);
            self.slots[known].seen_s = now_s;
            return Some(known);
        }
        if sights < enough {
            return None;
        }
        let place_m = filter.tag_place_m(tag);
        for other in 0..SLOTS {
            let near = (filter.tag_place_m(other) - place_m).norm() < MOVED_M;
            let has_moved = near && !filter.may_be_one(tag, other, way_m);
            if other != tag && has_moved && self.is_out_of_view(other, now_s) {
                self.forget(filter, other);
            }
        }
        if self.known() >= MAX_TAGS {
            return None;
        }
        self.numbered = self.numbered.saturating_add(1);
        self.slots[tag].standing = Standing::Known;
        self.slots[tag].id = self.numbered;
        Some(tag)
    }

    /// The known tag that has reappeared as this tag on trial.
    fn recognised(
        &self,
        filter: &Filter,
        orientation: &Orientation,
        trial: usize,
        now_s: f64,
        way_m: f64,
    ) -> Option<usize> {
        let place_m = filter.tag_place_m(trial);
        let far = |tag: usize| (filter.tag_place_m(tag) - place_m).norm();
        let nearest = self.those(is_known).min_by(|a, b| far(*a).total_cmp(&far(*b)))?;
        // After a long drift the nearest tag may be another one.
        let has_rival = self.those(is_known).filter(|tag| *tag != nearest).any(|tag| {
            far(tag) < RUNNER_UP * far(nearest) || !filter.is_rather(trial, nearest, tag, way_m)
        });
        let alone = !has_rival && self.is_no_other(filter, orientation, trial, nearest, way_m);
        let is_it = alone
            && self.is_out_of_view(nearest, now_s)
            && filter.may_be_one(trial, nearest, way_m);
        is_it.then_some(nearest)
    }

    /// Whether a tag on trial is a known one, and not one that is not in the map.
    fn is_no_other(
        &self,
        filter: &Filter,
        orientation: &Orientation,
        trial: usize,
        known: usize,
        way_m: f64,
    ) -> bool {
        let others_1_m2 = if self.slots[known].surveyed { NOT_SURVEYED_1_M2 } else { OTHERS_1_M2 };
        let known_deg = self.has_heading(known).then(|| filter.tag_heading_deg(known));
        let uncertainty_deg = filter.heading_uncertainty_deg();
        let log_odds = filter.log_odds_of_one(trial, known, way_m, others_1_m2)
            + orientation.log_odds_of_one(trial, known, known_deg, uncertainty_deg);
        log_odds >= CERTAIN_ODDS.ln()
    }

    fn is_out_of_view(&self, tag: usize, now_s: f64) -> bool {
        let Slot { standing, seen_s, .. } = self.slots[tag];
        is_known(standing) && now_s - seen_s > IN_VIEW_S
    }

    pub(super) fn is_known(&self, tag: usize) -> bool {
        is_known(self.slots[tag].standing)
    }

    /// Whether a tag on trial has enough sightings to correct the position.
    pub(super) fn is_likely(&self, tag: usize) -> bool {
        matches!(self.slots[tag].standing, Standing::OnTrial(sights) if sights >= LIKELY)
    }

    /// Whether a tag has been seen only once.
    pub(super) fn is_new(&self, tag: usize) -> bool {
        self.slots[tag].standing == Standing::OnTrial(0)
    }

    /// Adds the residual of a sighting at a height and speed; the tag was this far aside.
    pub(super) fn watch(
        &mut self,
        tag: usize,
        off_m: Vector2<f64>,
        height_m: f64,
        aside_m: f64,
        speed_m_s: f64,
    ) {
        if speed_m_s > SLOW_M_S {
            return;
        }
        let slot = &mut self.slots[tag];
        slot.off_m += (off_m - slot.off_m) / MEAN_SIGHTS;
        let most_m = OFF_M + OFF_HEIGHT * height_m + OFF_ASIDE * aside_m;
        slot.moves = slot.off_m.norm() > most_m;
    }

    /// Whether the residuals of a tag show that it moves.
    pub(super) fn moves(&self, tag: usize) -> bool {
        self.slots[tag].moves
    }

    /// Forgets a moving tag, and the tags on trial.
    pub(super) fn forget_moving(&mut self, filter: &mut Filter, tag: usize) {
        self.forget(filter, tag);
        for trial in 0..SLOTS {
            if is_on_trial(self.slots[trial].standing) {
                self.forget(filter, trial);
            }
        }
    }

    fn forget(&mut self, filter: &mut Filter, tag: usize) {
        self.slots[tag] = Slot::default();
        filter.forget_tag(tag);
        let used = self.those(|standing| standing != Standing::Free).last();
        filter.use_tags(used.map_or(0, |tag| tag + 1));
    }
}

fn is_known(standing: Standing) -> bool {
    standing == Standing::Known
}

fn is_on_trial(standing: Standing) -> bool {
    matches!(standing, Standing::OnTrial(_))
}

#[cfg(test)]
mod tests;
