//! Directions of the known tags, and whether a tag was turned.

use super::Map;
use crate::sensor::CLEAR;

/// Number of sightings in the mean of the residuals of a direction, the limit of each, because one may be of
/// something else, and the largest mean of a tag that does not turn, besides that of an uncertain heading.
const MEAN_DIRECTIONS: f64 = 20.0;
const MOST_OFF_DEG: f64 = 40.0;
const TURNED_DEG: f64 = 10.0;

/// Whether the direction of a tag is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Direction {
    #[default]
    Unknown,
    Known,
    /// The tag was turned: its direction is not used any more.
    Distrusted,
}

impl Direction {
    pub(super) fn given(is_given: bool) -> Self {
        if is_given { Self::Known } else { Self::Unknown }
    }
}

impl Map {
    pub(in crate::world) fn has_heading(&self, tag: usize) -> bool {
        self.slots[tag].direction == Direction::Known
    }

    pub(in crate::world) fn learnt_heading(&mut self, tag: usize) {
        self.slots[tag].direction = Direction::Known;
    }

    /// The sign of orientations was wrong: discards the directions that were derived from them.
    pub(in crate::world) fn forget_found_headings(&mut self) {
        for slot in &mut self.slots {
            // With the wrong sign every tag seems to turn with the drone.
            slot.turned_deg = 0.0;
            if !slot.surveyed || slot.direction == Direction::Distrusted {
                slot.direction = Direction::Unknown;
            }
        }
    }

    /// Adds the difference between a sighting's direction and the known one, with the standard deviation of the
    /// heading. Returns whether their mean shows that the tag turns.
    pub(in crate::world) fn watch_direction(
        &mut self,
        tag: usize,
        off_deg: f64,
        uncertainty_deg: f64,
    ) -> bool {
        let slot = &mut self.slots[tag];
        let off_deg = off_deg.clamp(-MOST_OFF_DEG, MOST_OFF_DEG);
        slot.turned_deg += (off_deg - slot.turned_deg) / MEAN_DIRECTIONS;
        slot.turned_deg.abs() > TURNED_DEG.max(CLEAR * uncertainty_deg)
    }

    /// Whether a tag was turned, so that its direction is not used.
    pub(in crate::world) fn was_turned(&self, tag: usize) -> bool {
        self.slots[tag].direction == Direction::Distrusted
    }

    /// A tag was turned: its direction is not used any more.
    pub(in crate::world) fn distrust_direction(&mut self, tag: usize) {
        self.slots[tag].direction = Direction::Distrusted;
    }
}
