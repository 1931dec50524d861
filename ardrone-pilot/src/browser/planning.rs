//! Plans of the page: checked and simulated by the rules of the flight that they would be.

use autopilot::plan::TagUse;
use autopilot::vehicle::{SurveyedTag, VehicleConfig};
use serde_json::{Value, json};

use crate::checked_plan::CheckedPlan;
use crate::simulation::{self, SimulatedFlight};

/// The settings of the flights.
#[derive(Debug, Clone)]
pub struct Planning {
    /// The vehicle's.
    pub config: VehicleConfig,
    /// The tags of the settings; `None` if tags are not in use.
    pub surveyed: Option<Vec<SurveyedTag>>,
}

impl Planning {
    /// What is known of tags in a flight.
    pub(super) fn tags(&self) -> TagUse<'_> {
        self.surveyed.as_deref().map_or(TagUse::Unknown, TagUse::On)
    }

    /// The expected course of a plan, and everything that is wrong or unwise in it.
    pub(super) fn check(&self, text: &str) -> Value {
        self.checked(text).json("plan", text)
    }

    /// The plan flown on a simulated drone; null if it cannot be flown.
    pub(super) fn simulate(&self, text: &str) -> Value {
        let Some(plan) = self.checked(text).plan else { return Value::Null };
        let world = simulation::world(&self.config, Some(&plan));
        match simulation::fly(plan, &self.config, &world) {
            Ok(flight) => simulated(&flight),
            Err(refused) => json!({ "outcome": refused.to_string(), "completed": false }),
        }
    }

    fn checked(&self, text: &str) -> CheckedPlan {
        CheckedPlan::new(text, &self.config.limits, self.surveyed.as_deref())
    }
}

fn simulated(flight: &SimulatedFlight) -> Value {
    let outcome = flight.outcome.as_ref();
    let track: Vec<[f64; 5]> = (flight.track.iter())
        .map(|(at, pose)| [at.as_secs_f64(), pose.x_m, pose.y_m, pose.z_m, pose.yaw_deg])
        .collect();
    let warnings: Vec<Value> = (flight.warnings.iter())
        .map(|(at, event)| json!({ "t_s": at.as_secs_f64(), "text": event.to_string() }))
        .collect();
    json!({
        "outcome": outcome.map_or("did not end within 20 minutes".to_owned(), ToString::to_string),
        "completed": outcome.is_some_and(|outcome| outcome.exit_status() == 0),
        "length_s": flight.duration.as_secs_f64(),
        "battery_percent": flight.battery_percent,
        "track": track,
        "warnings": warnings,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn planning() -> Planning {
        Planning { config: VehicleConfig::default(), surveyed: None }
    }

    #[test]
    fn a_plan_is_checked_and_simulated() {
        let text = "takeoff\ngoto 0 1 0 0\nland\n";
        let checked = planning().check(text);
        assert_eq!(checked["steps"][1]["target"]["y_m"], 1.0);
        assert_eq!(checked["problems"], json!([]));
        let simulated = planning().simulate(text);
        assert_eq!(simulated["completed"], true, "{simulated}");
        let track = simulated["track"].as_array().unwrap();
        let furthest = track.iter().filter_map(|point| point[2].as_f64()).fold(0.0, f64::max);
        assert!((0.9..1.2).contains(&furthest), "{furthest}");
        assert_eq!(track[0][0], 0.0, "it begins when the drone leaves the ground");
    }

    #[test]
    fn what_is_wrong_is_said_and_not_flown() {
        let text = "takeoff\ngoto 99 0 0 0\nfly\n";
        let checked = planning().check(text);
        assert_eq!(checked["steps"], Value::Null);
        let lines: Vec<_> = checked["problems"].as_array().unwrap().iter().collect();
        assert!(lines.iter().any(|problem| problem["line"] == 3), "{checked}");
        assert_eq!(planning().simulate(text), Value::Null);
    }
}
