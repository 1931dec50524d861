//! What operators are told of a network.

use std::fmt;
use std::time::Duration;

use autopilot::separation::Presence;
use autopilot::vehicle::VehicleName;
use nalgebra::Vector2;
use serde_json::{Value, json};

use super::peers::{Change, TOO_OLD};
use super::refused::{Count, Refused};

/// Something that happens on the network.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum News {
    /// A vehicle that is flown elsewhere comes, or goes.
    Changed(Change),
    /// Something is not believed; told once of each kind and vehicle.
    Refused(Option<VehicleName>, Refused),
}

/// A vehicle that is flown elsewhere, for displays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Which one.
    pub vehicle: VehicleName,
    /// What it told last; nothing if it was never heard.
    pub told: Option<Told>,
}

/// What a vehicle told last.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Told {
    /// Whether it is in the air.
    pub presence: Presence,
    /// Right and forward in the common frame.
    pub place_m: Vector2<f64>,
    /// Standard deviation of the place.
    pub uncertainty_m: f64,
    /// How long ago it was there at most; zero if it stays there.
    pub age: Duration,
}

impl Seen {
    /// What it does, in few words, and whether somebody should look.
    pub fn in_short(&self) -> (String, bool) {
        let Some(told) = self.told else { return ("elsewhere, not heard".to_owned(), true) };
        let presence = match told.presence {
            Presence::Stands => "stands",
            Presence::Starts => "starts",
            Presence::Flies => "flies",
        };
        let is_lost = told.age > TOO_OLD;
        let lost = if is_lost { ", not heard" } else { "" };
        (format!("elsewhere, {presence}{lost}"), is_lost)
    }

    /// As other vehicles are told of to a page.
    pub(crate) fn json(&self) -> Value {
        let (phase, is_lost) = self.in_short();
        let pose =
            |told: Told| json!({ "x_m": told.place_m.x, "y_m": told.place_m.y, "yaw_deg": 0.0 });
        json!({
            "type": "other",
            "vehicle": self.vehicle,
            "phase": phase,
            "emergency": false,
            "airborne": self.told.map(|told| told.presence == Presence::Flies),
            "pose": self.told.map(pose),
            "uncertainty_m": self.told.map(|told| told.uncertainty_m),
            "battery_percent": null,
            "step": null,
            "steps": null,
            // The page calls what is older than 0.3 s lost; over a network that is usual.
            "navdata_age_s": if is_lost { None } else { Some(0.0) },
            "outcome": null,
        })
    }
}

/// What has become of it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Totals {
    /// How many states were told.
    pub told: u64,
    /// How many were believed.
    pub heard: u64,
    /// What was refused.
    pub refused: Vec<Count>,
}

impl News {
    /// Whether an operator should look.
    pub fn warns(&self) -> bool {
        !matches!(self, Self::Changed(Change { is_heard: true, .. }))
    }

    /// As an object for programs.
    pub(crate) fn json(&self, at: Duration) -> Value {
        let (vehicle, is_heard, refused) = match self {
            Self::Changed(Change { vehicle, is_heard }) => (Some(vehicle), Some(is_heard), None),
            Self::Refused(vehicle, why) => (vehicle.as_ref(), None, Some(why.name())),
        };
        json!({
            "type": "network",
            "t_s": at.as_secs_f64(),
            "vehicle": vehicle,
            "heard": is_heard,
            "refused": refused,
            "warning": self.warns(),
            "text": self.to_string(),
        })
    }
}

impl fmt::Display for News {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Changed(Change { vehicle, is_heard: true }) => {
                write!(f, "{vehicle} is heard over the network")
            }
            Self::Changed(Change { vehicle, is_heard: false }) => {
                write!(f, "{vehicle} is not heard over the network any more")
            }
            Self::Refused(Some(vehicle), why) => {
                write!(f, "what the network tells of {vehicle} is not believed: {why}")
            }
            Self::Refused(None, why) => {
                write!(f, "something that the network tells is not believed: {why}")
            }
        }
    }
}

impl Totals {
    /// As an object for programs.
    pub(crate) fn json(&self) -> Value {
        let refused = self.refused.iter().map(|Count { vehicle, why, count }| {
            json!({ "vehicle": vehicle, "why": why.name(), "count": count })
        });
        json!({ "told": self.told, "heard": self.heard, "refused": refused.collect::<Vec<_>>() })
    }
}

impl fmt::Display for Totals {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "network: {} states told, {} believed", self.told, self.heard)?;
        for (number, Count { vehicle, why, count }) in self.refused.iter().enumerate() {
            let before = if number == 0 { "; refused:" } else { "," };
            write!(f, "{before} {count}")?;
            if let Some(vehicle) = vehicle {
                write!(f, " of {vehicle}")?;
            }
            write!(f, " ({why})")?;
        }
        writeln!(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_is_flown_elsewhere_is_shown_with_how_it_is_heard() {
        let vehicle = "right".parse().unwrap();
        let seen = |ms: u64| {
            let (place_m, uncertainty_m) = (Vector2::new(1.0, 2.0), 0.1);
            let age = Duration::from_millis(ms);
            Seen {
                vehicle,
                told: Some(Told { presence: Presence::Flies, place_m, uncertainty_m, age }),
            }
        };
        assert_eq!(seen(1500).in_short(), ("elsewhere, flies".to_owned(), false));
        assert_eq!(seen(2500).in_short(), ("elsewhere, flies, not heard".to_owned(), true));
        assert_eq!(
            Seen { vehicle, told: None }.in_short(),
            ("elsewhere, not heard".to_owned(), true)
        );
        let object = seen(1500).json();
        assert_eq!((&object["pose"]["y_m"], &object["navdata_age_s"]), (&json!(2.0), &json!(0.0)));
        assert_eq!(Seen { vehicle, told: None }.json()["pose"], Value::Null);
    }

    #[test]
    fn news_and_totals_are_words_and_objects() {
        let right = "right".parse().unwrap();
        let gone = News::Changed(Change { vehicle: right, is_heard: false });
        let object = gone.json(Duration::from_secs(2));
        assert_eq!((&object["vehicle"], &object["heard"]), (&json!("right"), &json!(false)));
        assert!(gone.warns() && !News::Changed(Change { vehicle: right, is_heard: true }).warns());
        let refused = News::Refused(Some(right), Refused::TooLong);
        assert_eq!(refused.json(Duration::ZERO)["refused"], "too_long");
        let counted = |vehicle, why, count| Count { vehicle, why, count };
        let totals = Totals {
            told: 3,
            heard: 2,
            refused: vec![counted(Some(right), Refused::TooOld, 7), counted(None, Refused::Key, 1)],
        };
        assert_eq!(
            totals.to_string(),
            "network: 3 states told, 2 believed; refused: 7 of right (it may be more than 2 s old), 1 (it is at the key of another one)\n"
        );
        assert_eq!(totals.json()["refused"][0]["count"], 7);
    }
}
