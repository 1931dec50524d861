//! Which tags are known, and which of them a sight is of.

use nalgebra::Vector2;

use super::MAX_TAGS;
use super::candidates::Candidate;
use super::filter::{Filter, Sighted};

/// A tag whose place was measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurveyedTag {
    /// Right and forward of where the drone starts.
    pub place_m: Vector2<f64>,
    /// Which way its pattern points, clockwise from the drone's heading at the start, if that was measured.
    pub heading_deg: Option<f64>,
}

/// A tag that is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownTag {
    /// Right and forward of the start.
    pub place_m: Vector2<f64>,
    /// Which way it points, once that is known.
    pub heading_deg: Option<f64>,
    /// Standard deviation of the place on the worse axis.
    pub deviation_m: f64,
    /// Whether its place was given.
    pub surveyed: bool,
}

/// What a sight is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Association {
    Known(usize),
    /// Two tags could be meant, or one that was seen already.
    Unclear,
    Unknown,
}

#[derive(Debug, Clone, Copy, Default)]
struct Slot {
    used: bool,
    surveyed: bool,
    has_heading: bool,
    seen_s: f64,
}

#[derive(Debug, Clone)]
pub(super) struct Map {
    slots: [Slot; MAX_TAGS],
}

/// Another tag must be this many times as far as the one that is meant.
const RUNNER_UP: f64 = 2.0;
/// What lies this near to a known tag that is not seen any more is that tag: it was moved.
const MOVED_M: f64 = 1.0;
const MOVED_S: f64 = 1.0;

impl Map {
    pub(super) fn new(surveyed: &[Option<SurveyedTag>; MAX_TAGS], filter: &mut Filter) -> Self {
        let mut slots = [Slot::default(); MAX_TAGS];
        for (tag, surveyed) in surveyed.iter().enumerate() {
            if let Some(SurveyedTag { place_m, heading_deg }) = surveyed {
                filter.survey_tag(tag, *place_m, heading_deg.map(f64::to_radians));
                slots[tag] = Slot {
                    used: true,
                    surveyed: true,
                    has_heading: heading_deg.is_some(),
                    seen_s: f64::NEG_INFINITY,
                };
            }
        }
        Self { slots }
    }

    pub(super) fn known(&self) -> usize {
        self.slots.iter().filter(|slot| slot.used).count()
    }

    pub(super) fn iter<'a>(&'a self, filter: &'a Filter) -> impl Iterator<Item = KnownTag> + 'a {
        let used = self.slots.iter().enumerate().filter(|(_, slot)| slot.used);
        used.map(|(tag, slot)| KnownTag {
            place_m: filter.tag_place_m(tag),
            heading_deg: slot.has_heading.then(|| filter.tag_heading_rad(tag).to_degrees()),
            deviation_m: filter.tag_deviation_m(tag),
            surveyed: slot.surveyed,
        })
    }

    /// The nearest tag, if the sight may be of it and of no other.
    pub(super) fn associate(
        &self,
        filter: &Filter,
        sighted: &Sighted,
        seen: &[bool; MAX_TAGS],
    ) -> Association {
        let far = |tag: usize| (filter.tag_place_m(tag) - sighted.place_m).norm();
        let used = || (0..MAX_TAGS).filter(|tag| self.slots[*tag].used);
        let nearest = used().min_by(|a, b| far(*a).total_cmp(&far(*b)));
        let Some(nearest) = nearest.filter(|tag| filter.admits(sighted, *tag)) else {
            return Association::Unknown;
        };
        let alone = used()
            .filter(|tag| *tag != nearest && filter.admits(sighted, *tag))
            .all(|tag| far(tag) >= RUNNER_UP * far(nearest));
        if alone && !seen[nearest] { Association::Known(nearest) } else { Association::Unclear }
    }

    /// Takes a candidate among the known tags: a new one, or one that was moved.
    pub(super) fn add(
        &mut self,
        filter: &mut Filter,
        sighted: &Sighted,
        candidate: &Candidate,
        now_s: f64,
    ) -> Option<usize> {
        let far = |tag: usize| (filter.tag_place_m(tag) - candidate.place_m).norm();
        let moved = (0..MAX_TAGS)
            .filter(|tag| self.slots[*tag].used && far(*tag) < MOVED_M)
            .min_by(|a, b| far(*a).total_cmp(&far(*b)));
        let tag = match moved {
            // A tag that is still seen where it was has a neighbour.
            Some(tag) if now_s - self.slots[tag].seen_s > MOVED_S => tag,
            _ => (0..MAX_TAGS).find(|tag| !self.slots[*tag].used)?,
        };
        filter.begin_tag(tag, candidate.place_m, sighted);
        self.slots[tag] = Slot { used: true, seen_s: now_s, ..Slot::default() };
        Some(tag)
    }

    pub(super) fn saw(&mut self, tag: usize, now_s: f64) {
        self.slots[tag].seen_s = now_s;
    }

    pub(super) fn has_heading(&self, tag: usize) -> bool {
        self.slots[tag].has_heading
    }

    pub(super) fn learnt_heading(&mut self, tag: usize) {
        self.slots[tag].has_heading = true;
    }

    /// Orientations count the other way: the directions that were taken from them are wrong.
    pub(super) fn forget_found_headings(&mut self) {
        for slot in self.slots.iter_mut().filter(|slot| !slot.surveyed) {
            slot.has_heading = false;
        }
    }

    pub(super) fn forget_all(&mut self, filter: &mut Filter) {
        for (tag, slot) in self.slots.iter_mut().enumerate() {
            filter.forget_tag(tag);
            *slot = Slot::default();
        }
    }
}
