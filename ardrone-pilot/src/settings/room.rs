//! `[room]`: the frame that a vehicle shares with others, and how it keeps apart from them.

use autopilot::separation::MAX_NEIGHBOURS;
use autopilot::vehicle::{Start, VehicleConfig};
use nalgebra::Vector2;
use serde::{Deserialize, Serialize};

use super::section::{Declared, Section, Value, outside};

/// Ranges of the values.
const PLACE_M: [f64; 2] = [-200.0, 200.0];
const HEADING_DEG: [f64; 2] = [-360.0, 360.0];
const DEVIATION_M: [f64; 2] = [0.0, 5.0];
const HEADING_DEVIATION_DEG: [f64; 2] = [0.0, 45.0];
const SEPARATION_M: [f64; 2] = [0.8, 20.0];
/// Standard deviation of a start that is measured with a tape.
const USUAL_DEVIATION_M: f64 = 0.05;

/// The room that vehicles share, for one of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Room {
    /// Where this one starts.
    pub(super) start: SurveyedStart,
    /// Least distance from other vehicles, across, in metres.
    pub(super) separation_m: f64,
    /// Numbers of the other vehicles' MAVLink systems.
    pub(super) peers: Vec<u8>,
}

/// A start as it is written: nothing, or three to five numbers, of which the file says what they are. Within it is where the
/// drone stands in the frame of the room; `None` if the room begins there.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "Vec<f64>", into = "Vec<f64>")]
pub(crate) struct SurveyedStart(pub(crate) Option<Start>);

impl Room {
    /// Name, and what is known of each value.
    pub(super) const DECLARED: Declared = (
        "room",
        &[
            Value {
                name: "start",
                comments: &[
                    " Where the drone stands at its first start in a room that it shares with others: [right, forward, heading]. A fourth number is",
                    " the standard deviation of the place, 0.05 m otherwise, a fifth one that of the heading, 0 degrees otherwise (at least 0.15 m and 5",
                    " degrees with surveyed tags). Metres; degrees clockwise. Targets, fence and tags are then places of the room. [] for a room that",
                    " begins where the drone starts.",
                ],
                range: None,
            },
            Value {
                name: "separation_m",
                comments: &[" Least distance from other vehicles, across. Metres."],
                range: Some(SEPARATION_M),
            },
            Value {
                name: "peers",
                comments: &[
                    " MAVLink systems of the other vehicles: it does not take off before all of them are heard.",
                ],
                range: None,
            },
        ],
    );
}

impl Default for Room {
    fn default() -> Self {
        let VehicleConfig { separation_m, peers, estimator, .. } = VehicleConfig::default();
        Self { start: SurveyedStart(estimator.start), separation_m, peers }
    }
}

impl TryFrom<Vec<f64>> for SurveyedStart {
    type Error = String;

    fn try_from(written: Vec<f64>) -> Result<Self, String> {
        let [x_m, y_m, heading_deg, uncertainty_m, heading_uncertainty_deg] = match *written {
            [] => return Ok(Self(None)),
            [x, y, heading] => [x, y, heading, USUAL_DEVIATION_M, 0.0],
            [x, y, heading, deviation] => [x, y, heading, deviation, 0.0],
            [x, y, heading, deviation, of_heading] => [x, y, heading, deviation, of_heading],
            _ => {
                return Err(format!(
                    "{} numbers where a start has three to five: [right, forward, heading] in metres and degrees, and the standard deviations \
                     of place and heading",
                    written.len()
                ));
            }
        };
        let numbers = [
            ("its place to the right", x_m, PLACE_M),
            ("its place forward", y_m, PLACE_M),
            ("its heading", heading_deg, HEADING_DEG),
            ("the standard deviation of its place", uncertainty_m, DEVIATION_M),
            (
                "the standard deviation of its heading",
                heading_uncertainty_deg,
                HEADING_DEVIATION_DEG,
            ),
        ];
        let wrong =
            |(name, value, [from, to]): (_, _, [f64; 2])| outside(name, value, &(from..=to));
        if let Some(reason) = numbers.into_iter().find_map(wrong) {
            return Err(format!("of a start {reason}"));
        }
        let place_m = Vector2::new(x_m, y_m);
        Ok(Self(Some(Start { place_m, heading_deg, uncertainty_m, heading_uncertainty_deg })))
    }
}

impl From<SurveyedStart> for Vec<f64> {
    fn from(SurveyedStart(start): SurveyedStart) -> Self {
        let numbers = |start: Start| {
            let Start { place_m, heading_deg, uncertainty_m, heading_uncertainty_deg } = start;
            vec![place_m.x, place_m.y, heading_deg, uncertainty_m, heading_uncertainty_deg]
        };
        start.map(numbers).unwrap_or_default()
    }
}

impl Section<VehicleConfig> for Room {
    fn apply(&self, config: &mut VehicleConfig) {
        config.starts_at(self.start.0);
        config.separation_m = self.separation_m;
        config.peers.clone_from(&self.peers);
    }

    fn out_of_range(&self) -> Vec<String> {
        let [from, to] = SEPARATION_M;
        let mut reasons = Vec::new();
        reasons.extend(outside("room.separation_m", self.separation_m, &(from..=to)));
        if self.peers.len() > MAX_NEIGHBOURS {
            reasons.push(format!("room.peers has more than {MAX_NEIGHBOURS} systems"));
        }
        reasons
    }
}

#[cfg(test)]
mod tests {
    use autopilot::plan::ZOrigin;

    use super::*;
    use crate::settings::Settings;

    #[test]
    fn a_start_has_three_to_five_numbers_and_is_read_back() {
        for (start, uncertainty_m, heading_uncertainty_deg) in [
            ("1, -2, 90", 0.05, 0.0),
            ("1, -2, 90, 0.2", 0.2, 0.0),
            ("1, -2, 90, 0.2, 10", 0.2, 10.0),
        ] {
            let text = format!("[room]\nstart = [{start}]\nseparation_m = 2\npeers = [2, 3]\n");
            let settings = Settings::parse("p", &text).unwrap();
            let config = settings.pilot_config(ZOrigin::Hover);
            let place_m = Vector2::new(1.0, -2.0);
            let expected =
                Start { place_m, heading_deg: 90.0, uncertainty_m, heading_uncertainty_deg };
            assert_eq!(config.estimator.start, Some(expected));
            assert_eq!((config.separation_m, config.peers), (2.0, vec![2, 3]));
            assert_eq!(Settings::parse("p", &settings.to_toml().unwrap()).unwrap(), settings);
        }
        assert_eq!(Settings::default().pilot_config(ZOrigin::Hover).estimator.start, None);
    }

    #[test]
    fn what_is_no_place_of_a_room_is_refused() {
        for (text, said) in [
            ("start = [1, 2]", "2 numbers where a start has three to five"),
            ("start = [1, 2, 3, 4, 5, 6]", "6 numbers"),
            ("start = [nan, 2, 3]", "its place to the right is NaN"),
            ("start = [1, 201, 3]", "its place forward is 201"),
            ("start = [1, 2, 361]", "its heading is 361"),
            ("start = [1, 2, 3, -0.1]", "the standard deviation of its place is -0.1"),
            ("start = [1, 2, 3, 1, 46]", "the standard deviation of its heading is 46"),
            ("separation_m = 0.5", "room.separation_m is 0.5"),
            ("peers = [256]", "line 2, column 10"),
        ] {
            let error = Settings::parse("p", &format!("[room]\n{text}")).unwrap_err().to_string();
            assert!(error.contains(said), "{text}: {error}");
        }
        let many = vec!["1"; MAX_NEIGHBOURS + 1].join(", ");
        let error = Settings::parse("p", &format!("[room]\npeers = [{many}]")).unwrap_err();
        assert!(error.to_string().contains("more than 31"), "{error}");
    }
}
