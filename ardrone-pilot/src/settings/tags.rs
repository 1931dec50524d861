//! `[tags]`: roundels on the floor that hold the place.

use std::str::FromStr;
use std::time::Duration;

use estimator::{MAX_TAGS, OrientationSign, SurveyedTag, TagConfig};
use nalgebra::Vector2;
use serde::{Deserialize, Serialize};

use super::outside;

/// What a `pilot.toml` says of tags.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Tags {
    pub(super) detect: bool,
    surveyed: Vec<Vec<f64>>,
    size_m: f64,
    delay_ms: u32,
    focal_units: [f64; 2],
    centre_units: [f64; 2],
    orientation: Orientation,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Orientation {
    Find,
    Clockwise,
    Counterclockwise,
}

/// A tag as it is given on the command line: `X,Y` or `X,Y,HEADING`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GivenTag {
    /// Right and forward of the start, in metres.
    pub place_m: [f64; 2],
    /// Clockwise from the drone's heading at the start, in degrees, if it was measured.
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

impl Default for Tags {
    fn default() -> Self {
        let config = TagConfig::default();
        Self {
            detect: false,
            surveyed: Vec::new(),
            size_m: config.size_m,
            delay_ms: u32::try_from(config.delay.as_millis()).unwrap_or(u32::MAX),
            focal_units: config.focal_units,
            centre_units: config.centre_units,
            orientation: Orientation::Find,
        }
    }
}

impl Tags {
    pub(super) fn add(&mut self, tag: &GivenTag) {
        self.detect = true;
        self.surveyed.push(tag.place_m.into_iter().chain(tag.heading_deg).collect());
    }

    pub(super) fn surveyed(&self) -> impl Iterator<Item = GivenTag> + '_ {
        self.surveyed.iter().filter_map(|numbers| GivenTag::from_numbers(numbers))
    }

    /// Nothing if tags are not used.
    pub(super) fn config(&self) -> Option<TagConfig> {
        let mut surveyed = [None; MAX_TAGS];
        for (slot, tag) in surveyed.iter_mut().zip(self.surveyed()) {
            let place_m = Vector2::from(tag.place_m);
            *slot = Some(SurveyedTag { place_m, heading_deg: tag.heading_deg });
        }
        self.detect.then(|| TagConfig {
            surveyed,
            delay: Duration::from_millis(self.delay_ms.into()),
            focal_units: self.focal_units,
            centre_units: self.centre_units,
            size_m: self.size_m,
            orientation: match self.orientation {
                Orientation::Find => None,
                Orientation::Clockwise => Some(OrientationSign::Clockwise),
                Orientation::Counterclockwise => Some(OrientationSign::CounterClockwise),
            },
        })
    }

    pub(super) fn reasons_against(&self) -> Vec<String> {
        /// Tags nearer to each other than this are confused.
        const APART_M: f64 = 1.5;
        let [focal_x, focal_y] = self.focal_units;
        let [centre_x, centre_y] = self.centre_units;
        let mut reasons: Vec<String> = [
            ("tags.size_m", self.size_m, 0.05..=1.0),
            ("tags.delay_ms", self.delay_ms.into(), 0.0..=300.0),
            ("tags.focal_units", focal_x, 500.0..=3000.0),
            ("tags.focal_units", focal_y, 500.0..=3000.0),
            ("tags.centre_units", centre_x, 300.0..=700.0),
            ("tags.centre_units", centre_y, 300.0..=700.0),
        ]
        .iter()
        .filter_map(|(name, value, range)| outside(name, *value, range))
        .collect();
        let wrong = self.surveyed.iter().filter(|tag| GivenTag::from_numbers(tag).is_none());
        reasons.extend(wrong.map(|tag| {
            format!("tags.surveyed has {tag:?}: it must be [right, forward] or [right, forward, heading]")
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
