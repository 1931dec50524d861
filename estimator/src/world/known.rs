//! Tags with known positions.

use std::time::Duration;

use nalgebra::Vector2;

use super::MAX_TAGS;

/// A tag with a measured position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurveyedTag {
    /// Position in the world: (x, y).
    pub place_m: Vector2<f64>,
    /// Direction of its pattern as a yaw in the world, if it was measured.
    pub heading_deg: Option<f64>,
}

/// A known tag.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownTag {
    /// Number of the tag, counted from 1 in the order in which tags became known. It is not given to another tag.
    pub id: u32,
    /// Position in the world: (x, y).
    pub place_m: Vector2<f64>,
    /// Direction of its pattern as a yaw in the world, once it is known.
    pub heading_deg: Option<f64>,
    /// Standard deviation of the position on the worse axis.
    pub uncertainty_m: f64,
    /// Whether its position was given.
    pub surveyed: bool,
    /// Time since it was last seen; `None` if it has not been seen yet.
    pub seen_ago: Option<Duration>,
}

/// All known tags by increasing id.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct KnownTags([Option<KnownTag>; MAX_TAGS]);

impl KnownTags {
    /// The tags.
    pub fn iter(&self) -> impl Iterator<Item = &KnownTag> {
        self.0.iter().flatten()
    }

    /// Number of tags.
    pub fn count(&self) -> usize {
        self.iter().count()
    }
}

impl FromIterator<KnownTag> for KnownTags {
    /// At most [`MAX_TAGS`] tags; others are left out.
    fn from_iter<T: IntoIterator<Item = KnownTag>>(tags: T) -> Self {
        let mut known = Self::default();
        for (slot, tag) in known.0.iter_mut().zip(tags) {
            *slot = Some(tag);
        }
        known.0.sort_unstable_by_key(|slot| slot.map_or(u32::MAX, |tag| tag.id));
        known
    }
}
