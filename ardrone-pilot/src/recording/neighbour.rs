//! What other vehicles tell of themselves, in the flight log.

use std::time::Duration;

use autopilot::separation;
use nalgebra::Vector2;
use serde::{Deserialize, Serialize};

/// Another vehicle, as [`separation::Neighbour`]. A number that is not finite is null, and makes no sense when it is read
/// again either.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Neighbour {
    system: u8,
    at_ns: u64,
    x_m: Option<f64>,
    y_m: Option<f64>,
    x_m_s: Option<f64>,
    y_m_s: Option<f64>,
    uncertainty_m: Option<f64>,
    separation_m: Option<f64>,
    presence: Presence,
    claim: Option<Claim>,
}

/// As [`separation::Presence`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Presence {
    Stands,
    Starts,
    Flies,
}

impl From<separation::Presence> for Presence {
    fn from(presence: separation::Presence) -> Self {
        match presence {
            separation::Presence::Stands => Self::Stands,
            separation::Presence::Starts => Self::Starts,
            separation::Presence::Flies => Self::Flies,
        }
    }
}

impl From<Presence> for separation::Presence {
    fn from(presence: Presence) -> Self {
        match presence {
            Presence::Stands => Self::Stands,
            Presence::Starts => Self::Starts,
            Presence::Flies => Self::Flies,
        }
    }
}

/// As [`separation::Claim`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Claim {
    x_m: Option<f64>,
    y_m: Option<f64>,
    system: u8,
    behind: u8,
}

impl From<&separation::Neighbour> for Neighbour {
    fn from(heard: &separation::Neighbour) -> Self {
        let finite = |number: f64| Some(number).filter(|number| number.is_finite());
        Self {
            system: heard.system,
            at_ns: u64::try_from(heard.at.as_nanos()).unwrap_or(u64::MAX),
            x_m: finite(heard.place_m.x),
            y_m: finite(heard.place_m.y),
            x_m_s: finite(heard.velocity_m_s.x),
            y_m_s: finite(heard.velocity_m_s.y),
            uncertainty_m: finite(heard.uncertainty_m),
            separation_m: finite(heard.separation_m),
            presence: heard.presence.into(),
            claim: heard.claim.map(|separation::Claim { to_m, rank }| Claim {
                x_m: finite(to_m.x),
                y_m: finite(to_m.y),
                system: rank.system,
                behind: rank.behind,
            }),
        }
    }
}

impl Neighbour {
    /// What was heard.
    pub fn heard(&self) -> separation::Neighbour {
        let number = |number: Option<f64>| number.unwrap_or(f64::NAN);
        separation::Neighbour {
            system: self.system,
            at: Duration::from_nanos(self.at_ns),
            place_m: Vector2::new(number(self.x_m), number(self.y_m)),
            velocity_m_s: Vector2::new(number(self.x_m_s), number(self.y_m_s)),
            uncertainty_m: number(self.uncertainty_m),
            separation_m: number(self.separation_m),
            presence: self.presence.into(),
            claim: self.claim.map(|Claim { x_m, y_m, system, behind }| separation::Claim {
                to_m: Vector2::new(number(x_m), number(y_m)),
                rank: separation::Rank { system, behind },
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_read_was_heard() {
        let heard = |presence| separation::Neighbour {
            system: 3,
            at: Duration::from_nanos(1_234_567_890_123_456_789),
            place_m: Vector2::new(0.1, -2.0 / 3.0),
            velocity_m_s: Vector2::new(1e-3, 4.0),
            uncertainty_m: 0.25,
            separation_m: 1.25,
            presence,
            claim: Some(separation::Claim {
                to_m: Vector2::new(3.0, -0.1),
                rank: separation::Rank { system: 2, behind: 1 },
            }),
        };
        let again = |heard: &separation::Neighbour| {
            let text = serde_json::to_string(&Neighbour::from(heard)).unwrap();
            serde_json::from_str::<Neighbour>(&text).unwrap().heard()
        };
        for presence in [separation::Presence::Stands, separation::Presence::Starts] {
            assert_eq!(again(&heard(presence)), heard(presence));
        }
        let heard = heard(separation::Presence::Flies);
        assert_eq!(again(&heard), heard);
        let nonsense = separation::Neighbour { uncertainty_m: f64::INFINITY, ..heard };
        assert!(again(&nonsense).uncertainty_m.is_nan());
    }

    #[test]
    fn neighbours_have_a_schema() {
        let schema = include_str!("schemas/neighbour.json");
        let schema: serde_json::Value = serde_json::from_str(schema).unwrap();
        let written = serde_json::to_value(Neighbour {
            system: 1,
            at_ns: 0,
            x_m: None,
            y_m: None,
            x_m_s: None,
            y_m_s: None,
            uncertainty_m: None,
            separation_m: None,
            presence: Presence::Stands,
            claim: None,
        });
        let keys = |value: &serde_json::Value| -> Vec<String> {
            value.as_object().unwrap().keys().cloned().collect()
        };
        assert_eq!(keys(&schema["properties"]), keys(&written.unwrap()));
    }
}
