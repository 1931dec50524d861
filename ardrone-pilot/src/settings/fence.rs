//! `[fence]`: where the drone may fly. It is a circle or a polygon, so that one value stands in place of another, which a
//! [`section!`](super::section) cannot say.

use autopilot::plan::{Border, FlightLimits, Shape};
use autopilot::vehicle::VehicleConfig;
use serde::{Deserialize, Serialize};

use super::section::{Declared, Section, Value, outside};

/// Ranges of the values.
const FLOOR_M: [f64; 2] = [0.1, 3.0];
const CEILING_M: [f64; 2] = [0.5, 100.0];
const RADIUS_M: [f64; 2] = [0.5, 200.0];

/// Where the drone may fly: between two heights, and inside a border around the start, or around the origin of a room.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Written", into = "Written")]
pub(crate) struct Fence {
    /// The lowest target, in metres above the floor.
    pub(super) floor_m: f64,
    /// The highest target, in metres above the floor.
    pub(super) ceiling_m: f64,
    border: Border,
}

/// The section as it is written: the border may be missing, or be there twice.
#[derive(Debug, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[allow(clippy::struct_field_names, reason = "the unit belongs to the name")]
struct Written {
    floor_m: f64,
    ceiling_m: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    radius_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    polygon_m: Option<Corners>,
}

/// The corners of a polygon that is a border.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(try_from = "Vec<Vec<f64>>", into = "Vec<[f64; 2]>")]
struct Corners(Border);

impl Fence {
    /// Name, and what is known of each value.
    pub(super) const DECLARED: Declared = (
        "fence",
        &[
            Value {
                name: "floor_m",
                comments: &[" Lowest and highest target. Metres above the floor."],
                range: Some(FLOOR_M),
            },
            Value { name: "ceiling_m", comments: &[], range: Some(CEILING_M) },
            Value {
                name: "radius_m",
                comments: &[
                    " Largest horizontal distance of a target from the start. Metres. In its place `polygon_m = [[-2, -1], [2, -1], [0, 4]]`",
                    " gives 3 to 32 corners of a polygon around the start: right and forward of it, in their order along the border.",
                ],
                range: Some(RADIUS_M),
            },
            Value {
                name: "polygon_m",
                comments: &[
                    " In place of `radius_m`: 3 to 32 corners of a polygon around the start, right and forward of it, in their order",
                    " along the border. Metres.",
                ],
                range: None,
            },
        ],
    );

    /// The value in whose place this one stands: of a circle and a polygon only one is written.
    pub(super) fn replaced_by(section: &str, name: &str) -> Option<&'static str> {
        match (section, name) {
            ("fence", "radius_m") => Some("polygon_m"),
            ("fence", "polygon_m") => Some("radius_m"),
            _ => None,
        }
    }

    /// This one with the values of a section `[fence]` that are given.
    pub(super) fn with(&self, changes: &toml::Table) -> Result<Self, toml::de::Error> {
        let serialized = toml::Table::try_from(self);
        let mut table = serialized.map_err(serde::de::Error::custom)?;
        for other in changes.keys().filter_map(|name| Self::replaced_by("fence", name)) {
            table.remove(other);
        }
        table.extend(changes.clone());
        table.try_into()
    }

    /// Of a circle.
    fn radius_m(&self) -> Option<f64> {
        match self.border.shape() {
            Shape::Circle { radius_m } => Some(radius_m),
            Shape::Polygon(_) => None,
        }
    }
}

impl Default for Fence {
    fn default() -> Self {
        let FlightLimits { floor_m, ceiling_m, border, .. } = VehicleConfig::default().limits;
        Self { floor_m, ceiling_m, border }
    }
}

impl Default for Written {
    fn default() -> Self {
        let Fence { floor_m, ceiling_m, .. } = Fence::default();
        Self { floor_m, ceiling_m, radius_m: None, polygon_m: None }
    }
}

impl From<Fence> for Written {
    fn from(fence: Fence) -> Self {
        let (radius_m, Fence { floor_m, ceiling_m, border }) = (fence.radius_m(), fence);
        let polygon_m = radius_m.is_none().then_some(Corners(border));
        Self { floor_m, ceiling_m, radius_m, polygon_m }
    }
}

impl TryFrom<Written> for Fence {
    type Error = &'static str;

    fn try_from(written: Written) -> Result<Self, Self::Error> {
        let Written { floor_m, ceiling_m, radius_m, polygon_m } = written;
        let border = match (radius_m, polygon_m) {
            (Some(_), Some(_)) => {
                return Err("a fence has `radius_m` or `polygon_m`: leave one of them out");
            }
            (None, Some(Corners(border))) => border,
            (Some(radius_m), None) => Border::circle(radius_m),
            (None, None) => Self::default().border,
        };
        Ok(Self { floor_m, ceiling_m, border })
    }
}

impl TryFrom<Vec<Vec<f64>>> for Corners {
    type Error = String;

    fn try_from(written_m: Vec<Vec<f64>>) -> Result<Self, String> {
        // Read as pairs, what is behind the second number would be dropped without a word.
        let pair = |(index, corner_m): (usize, Vec<f64>)| {
            corner_m.try_into().map_err(|_| {
                format!("corner {} is not two numbers: give [right, forward] in metres", index + 1)
            })
        };
        let corners_m = written_m.into_iter().enumerate().map(pair);
        let corners_m = corners_m.collect::<Result<Vec<[f64; 2]>, _>>()?;
        Border::polygon(&corners_m).map(Self).map_err(|error| error.to_string())
    }
}

impl From<Corners> for Vec<[f64; 2]> {
    fn from(corners: Corners) -> Self {
        corners.0.outline_m().collect()
    }
}

impl Section<VehicleConfig> for Fence {
    fn apply(&self, config: &mut VehicleConfig) {
        let Self { floor_m, ceiling_m, border } = *self;
        config.limits = FlightLimits { floor_m, ceiling_m, border, ..config.limits };
    }

    fn out_of_range(&self) -> Vec<String> {
        let numbers = [
            ("fence.floor_m", Some(self.floor_m), FLOOR_M),
            ("fence.ceiling_m", Some(self.ceiling_m), CEILING_M),
            ("fence.radius_m", self.radius_m(), RADIUS_M),
        ];
        let wrong =
            |(name, value, [from, to]): (_, _, [f64; 2])| outside(name, value?, &(from..=to));
        numbers.into_iter().filter_map(wrong).collect()
    }
}

#[cfg(test)]
mod tests {
    use autopilot::plan::ZOrigin;

    use crate::settings::Settings;

    const L: &str = "[[-2, -2], [1, -2], [1, 1], [4, 1], [4, 4], [-2, 4]]";

    #[test]
    fn a_polygon_stands_in_place_of_a_radius_and_is_read_back() {
        let text = format!("[fence]\npolygon_m = {L}\nceiling_m = 2.5");
        let settings = Settings::parse("p", &text).unwrap();
        let limits = settings.pilot_config(ZOrigin::Floor).limits;
        assert_eq!(limits.border.outline_m().count(), 6);
        assert!((limits.ceiling_m - 2.5).abs() < 1e-9 && (limits.floor_m - 0.3).abs() < 1e-9);
        let written = settings.to_toml().unwrap();
        assert!(written.contains("polygon_m") && !written.contains("radius_m"), "{written}");
        assert_eq!(Settings::parse("p", &written).unwrap(), settings);
    }

    #[test]
    fn what_is_no_border_is_refused_with_its_place_and_what_to_do() {
        for (fence, place, said) in [
            (
                "radius_m = 4.0\npolygon_m = [[-2, -2], [2, -2], [0, 2]]",
                "line 1, column 1",
                "leave one of them out",
            ),
            ("polygon_m = [[-2, -2], [2, -2]]", "line 2, column 13", "give at least three"),
            (
                "polygon_m = [[-2, -2], [2, -2], [nan, 2]]",
                "line 2, column 13",
                "corner 3 is no place",
            ),
            (
                "polygon_m = [[-2, -2], [2, -2], [0, 201]]",
                "line 2, column 13",
                "corner 3 is no place",
            ),
            (
                "polygon_m = [[-2, -2], [2, 2], [2, -2], [-2, 2]]",
                "line 2, column 13",
                "in their order",
            ),
            (
                "polygon_m = [[-1, -0.1], [1, -0.1], [1, 0.1], [-1, 0.1]]",
                "line 2, column 13",
                "make it wider",
            ),
            (
                "polygon_m = [[1, -2], [3, -2], [3, 2]]",
                "line 2, column 13",
                "the start (0, 0) is outside",
            ),
            (
                "polygon_m = [[-2, -2], [2, -2, 1], [0, 2]]",
                "line 2, column 13",
                "corner 2 is not two numbers",
            ),
            ("polygon_m = [[-2, -2], [2], [0, 2]]", "line 2, column 13", "corner 2 is not two"),
            ("polygon_m = \"round\"", "line 2, column 13", ""),
            ("polygon = 1", "line 2, column 1", "polygon_m"),
        ] {
            let text = format!("[fence]\n{fence}");
            let error = Settings::parse("my.toml", &text).unwrap_err().to_string();
            assert!(error.contains(place) && error.contains(said), "{fence}: {error}");
        }
        let many = vec!["[0, 1]"; 33].join(", ");
        let error = Settings::parse("p", &format!("[fence]\npolygon_m = [{many}]")).unwrap_err();
        assert!(error.to_string().contains("at most 32"), "{error}");
        let error = Settings::parse("p", "[fence]\nradius_m = 0.4").unwrap_err();
        assert!(error.to_string().contains("fence.radius_m is 0.4"), "{error}");
    }
}
