//! `[tags]`: tags on the floor that hold the place.

use std::str::FromStr;

use estimator::{MAX_TAGS, OrientationSign, SurveyedTag, TagConfig};
use nalgebra::Vector2;
use serde::{Deserialize, Serialize};

use super::section::{Milliseconds, Pair, Section as _, Setting, section};

section! {
    struct Tags("tags") of TagConfig {
        /// Whether tags (black and white roundels) on the floor hold the position: the drone is asked to look for them. docs/position.md
        detect: bool = [default false],
        /// Tags whose place was measured, [right, forward] or [right, forward, heading] from where the drone starts, in metres
        /// and degrees clockwise. Others are found and mapped.
        surveyed: Vec<Vec<f64>> = [default Vec::new()],
        /// Diameter of the printed pattern.
        size_m: f64 = [size_m] in 0.05..=1.0,
        /// Age of a sighting when its packet is sent.
        delay_ms: Milliseconds = [delay] in 0.0..=300.0,
        /// The bottom camera: focal length across and along, and centre, in thousandths of its picture.
        focal_units: Pair = [focal_units] in 500.0..=3000.0,
        centre_units: Pair = [centre_units] in 300.0..=700.0,
        /// Direction in which the reported orientation grows: "clockwise" or "counterclockwise" with the drone, or "find" it in flight, for
        /// which the drone turns by 8 degrees to and fro above its first tag.
        orientation: Orientation = [orientation],
    }
}

/// In which direction of the drone's turn the reported orientation of a tag grows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Orientation {
    /// Not known: it is found in flight.
    Find,
    /// When the drone turns clockwise, seen from above.
    Clockwise,
    /// When the drone turns counterclockwise, seen from above.
    Counterclockwise,
}

impl Setting<Option<OrientationSign>> for Orientation {
    fn of(value: &Option<OrientationSign>) -> Self {
        match value {
            None => Self::Find,
            Some(OrientationSign::Clockwise) => Self::Clockwise,
            Some(OrientationSign::CounterClockwise) => Self::Counterclockwise,
        }
    }

    fn value(&self) -> Option<OrientationSign> {
        match self {
            Self::Find => None,
            Self::Clockwise => Some(OrientationSign::Clockwise),
            Self::Counterclockwise => Some(OrientationSign::CounterClockwise),
        }
    }
}

/// A tag as it is given on the command line, `X,Y` or `X,Y,HEADING`, and in the same order in a `pilot.toml`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GivenTag {
    /// Right and forward of the start, or of the origin of a room: -100 to 100 m.
    pub place_m: [f64; 2],
    /// Clockwise from the drone's heading at the start, or from forward in a room: -360° to 360°. `None` if it was not measured.
    pub heading_deg: Option<f64>,
}

impl GivenTag {
    fn from_numbers(numbers: &[f64]) -> Option<Self> {
        let (place_m, heading_deg) = match *numbers {
            [x, y] => ([x, y], None),
            [x, y, heading] => ([x, y], Some(heading)),
            _ => return None,
        };
        let near = place_m.iter().all(|metres| metres.abs() <= 100.0);
        let turned = heading_deg.is_none_or(|deg| deg.abs() <= 360.0);
        (near && turned).then_some(Self { place_m, heading_deg })
    }
}

impl From<GivenTag> for SurveyedTag {
    fn from(tag: GivenTag) -> Self {
        Self { place_m: tag.place_m.into(), heading_deg: tag.heading_deg }
    }
}

impl FromStr for GivenTag {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<f64>> =
            text.split(',').map(|word| word.trim().parse().ok()).collect();
        numbers.as_deref().and_then(Self::from_numbers).ok_or_else(|| {
            "expected metres right and forward of the start, and degrees if they were measured: \
             1.5,-0.5 or 1.5,-0.5,90"
                .to_owned()
        })
    }
}

impl Tags {
    /// Adds a surveyed tag, and uses tags.
    pub(super) fn add(&mut self, tag: &GivenTag) {
        self.detect = true;
        self.surveyed.push(tag.place_m.into_iter().chain(tag.heading_deg).collect());
    }

    /// The surveyed tags, without those that are invalid.
    pub(super) fn surveyed(&self) -> impl Iterator<Item = GivenTag> + '_ {
        self.surveyed.iter().filter_map(|numbers| GivenTag::from_numbers(numbers))
    }

    /// What the estimator is to know of tags; `None` if tags are not used.
    pub(super) fn config(&self) -> Option<TagConfig> {
        let mut config = TagConfig::default();
        self.apply(&mut config);
        for (slot, tag) in config.surveyed.iter_mut().zip(self.surveyed()) {
            *slot = Some(tag.into());
        }
        self.detect.then_some(config)
    }

    /// Reasons why the values are out of range, or the surveyed tags invalid, too many or too near to each other.
    pub(super) fn reasons_against(&self) -> Vec<String> {
        /// Tags nearer to each other than this are confused.
        const APART_M: f64 = 1.5;
        let mut reasons = self.out_of_range();
        let wrong = self.surveyed.iter().filter(|tag| GivenTag::from_numbers(tag).is_none());
        reasons.extend(wrong.map(|tag| {
            format!("tags.surveyed has {tag:?}: it must be [right, forward] or [right, forward, heading], at most 100 m away and 360° turned")
        }));
        if self.surveyed.len() > MAX_TAGS {
            reasons.push(format!("tags.surveyed has more than {MAX_TAGS} tags"));
        }
        let places: Vec<Vector2<f64>> =
            self.surveyed().map(|tag| Vector2::from(tag.place_m)).collect();
        for (i, place_m) in places.iter().enumerate() {
            if places.iter().skip(i + 1).any(|other| (other - place_m).norm() < APART_M) {
                reasons.push(format!(
                    "tags.surveyed has tags nearer than {APART_M} m to each other: they all look alike"
                ));
                break;
            }
        }
        reasons
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tag_is_given_by_two_or_three_numbers() {
        let tag: GivenTag = "1.5,-0.5".parse().unwrap();
        assert_eq!(tag, GivenTag { place_m: [1.5, -0.5], heading_deg: None });
        let tag: GivenTag = "0, 2, -90".parse().unwrap();
        assert_eq!(tag, GivenTag { place_m: [0.0, 2.0], heading_deg: Some(-90.0) });
        for wrong in ["", "1", "1,2,3,4", "1,two", "1,nan", "1,2,inf", "1e9,0"] {
            assert!(wrong.parse::<GivenTag>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn tags_are_off_unless_asked_for_and_must_be_apart() {
        let mut tags = Tags::default();
        assert_eq!(tags.config(), None);
        tags.detect = true;
        assert_eq!(tags.config(), Some(TagConfig::default()));
        tags.add(&"0,0,10".parse().unwrap());
        tags.add(&"2,0".parse().unwrap());
        assert!(tags.reasons_against().is_empty());
        assert_eq!(tags.config().unwrap().surveyed.iter().flatten().count(), 2);
        tags.add(&"2.5,0.5".parse().unwrap());
        assert!(tags.reasons_against()[0].contains("look alike"));
    }
}
