//! Tags that are surveyed in flight.

use super::directions::Direction;
use super::{Map, Slot, Standing, is_known, is_on_trial};
use crate::world::filter::Filter;
use crate::world::{MAX_TAGS, SurveyedTag};

/// A tag that is surveyed in flight is taken for a known one within half the least distance between tags.
const SAME_M: f64 = 0.75;

impl Map {
    /// Whether a position was given for one of the known tags.
    pub(in crate::world) fn has_surveyed(&self) -> bool {
        self.slots.iter().any(|slot| slot.surveyed)
    }

    /// Whether there is room for tags that are surveyed in flight.
    pub(in crate::world) fn has_room_for(&self, filter: &Filter, tags: &[SurveyedTag]) -> bool {
        let is_new = |tag: &&SurveyedTag| self.nearest_within(filter, tag, SAME_M).is_none();
        self.known() + tags.iter().filter(is_new).count() <= MAX_TAGS
    }

    /// Adds a tag that is surveyed in flight. A known one near it is taken to be the same: if its position was
    /// found, it now has the surveyed one; if it was surveyed, it keeps its own. Returns its slot if it is new
    /// there.
    pub(in crate::world) fn survey(
        &mut self,
        filter: &mut Filter,
        tag: &SurveyedTag,
    ) -> Option<usize> {
        let SurveyedTag { place_m, heading_deg } = tag;
        let heading_rad = heading_deg.map(f64::to_radians);
        if let Some(known) = self.nearest_within(filter, tag, SAME_M) {
            let slot = &mut self.slots[known];
            if !slot.surveyed {
                let has_heading = slot.direction == Direction::Known;
                filter.correct_by_survey(known, *place_m, heading_rad, has_heading);
                slot.surveyed = true;
                if heading_rad.is_some() {
                    (slot.direction, slot.turned_deg) = (Direction::Known, 0.0);
                }
            }
            return None;
        }
        let has_trial = self.those(is_on_trial).last();
        let free = self.those(|standing| standing == Standing::Free).next().or(has_trial)?;
        self.forget(filter, free);
        filter.survey_tag(free, *place_m, heading_rad);
        self.numbered = self.numbered.saturating_add(1);
        self.slots[free] = Slot {
            standing: Standing::Known,
            id: self.numbered,
            surveyed: true,
            direction: Direction::given(heading_rad.is_some()),
            seen_s: f64::NEG_INFINITY,
            ..Slot::default()
        };
        Some(free)
    }

    fn nearest_within(&self, filter: &Filter, tag: &SurveyedTag, far_m: f64) -> Option<usize> {
        let far = |known: usize| (filter.tag_place_m(known) - tag.place_m).norm();
        let nearest = self.those(is_known).min_by(|a, b| far(*a).total_cmp(&far(*b)))?;
        (far(nearest) < far_m).then_some(nearest)
    }
}
