//! Snapshot for a browser that connects, so that reloading the page loses nothing.

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use autopilot::agent::{
    LANDING_BATTERY_PERCENT, PLANS, SOURCE, WARNING_BATTERY_PERCENT, plan_text,
};
use autopilot::outcome::Outcome;
use autopilot::plan::{
    Declaration, FlightLimits, LANGUAGE, Plan, Step, battery_percent, expectations,
};
use autopilot::vehicle::{Telemetry, VehicleConfig, VehicleName};
use diagnostic::printable;
use serde_json::{Value, json};

use super::files::PLAN_BYTES;
use crate::flight::{Content, Message};
use crate::flown_path::FlownPath;
use crate::json;
use crate::recording::Place;
use crate::typed;

/// Capacity of the event list; the oldest events are dropped.
const EVENTS: usize = 100;

/// State of the vehicle and its recent history.
#[derive(Debug)]
pub(super) struct Snapshot {
    steps: Vec<Step>,
    limits: FlightLimits,
    vehicle: VehicleName,
    /// All vehicles, and those that the page can show in full.
    fleet: Vec<VehicleName>,
    here: Vec<VehicleName>,
    /// What the others do.
    others: BTreeMap<VehicleName, Value>,
    /// The drone that is flown, for people.
    drone: String,
    name: String,
    notes: Vec<String>,
    flown_path: FlownPath,
    events: VecDeque<Value>,
    status: Value,
    ready: Value,
    end: Value,
}

impl Snapshot {
    /// Initial state, with a plan or without a mission.
    pub(super) fn new(
        plan: Option<&Plan>,
        config: &VehicleConfig,
        drone: &str,
        fleet: &[VehicleName],
        here: &[VehicleName],
    ) -> Self {
        let name = plan.map_or("", Plan::name);
        Self {
            steps: plan.map_or(Vec::new(), |plan| plan.steps().to_vec()),
            limits: config.limits,
            vehicle: config.name,
            fleet: fleet.to_vec(),
            here: here.to_vec(),
            others: BTreeMap::new(),
            drone: printable(drone).into_owned(),
            name: printable(name).into_owned(),
            notes: plan.map_or(Vec::new(), |plan| plan.notes().to_vec()),
            flown_path: FlownPath::default(),
            events: VecDeque::new(),
            status: Value::Null,
            ready: Value::Null,
            end: Value::Null,
        }
    }

    /// Applies a message; returns the JSON object to send to browsers.
    pub(super) fn take_in(&mut self, message: &Message) -> Value {
        let object = json::message(message, &self.steps);
        let (at, telemetry) = match &message.content {
            Content::Telemetry(at, telemetry, _) => (at, telemetry),
            Content::Trouble(..) | Content::Said { again: false, .. } => {
                self.remember(&object);
                return object;
            }
            Content::Said { .. } | Content::Heard { .. } | Content::Realtime(_) => return object,
        };
        match telemetry {
            Telemetry::Status(status) => {
                if let Some(pose) = status.pose {
                    self.flown_path.add(&pose);
                }
                self.status = object.clone();
            }
            Telemetry::Event(_) => self.remember(&object),
            Telemetry::Mission { name, steps, steps_done, .. } => {
                if *steps != self.steps {
                    self.steps.clone_from(steps);
                    self.name = printable(name).into_owned();
                    self.notes.clear();
                    // The step of the last status is one of the mission before.
                    if let Some(status) = self.status.as_object_mut() {
                        status.insert("step".to_owned(), Value::Null);
                        status.insert("steps_done".to_owned(), json!(steps_done));
                    }
                    // The page redraws everything.
                    return self.so_far();
                }
            }
            Telemetry::Readiness(_) => self.ready = object.clone(),
            Telemetry::Ended(outcome, _) => {
                // What was ordered surprises nobody.
                let warns = !matches!(outcome, Outcome::Completed | Outcome::Interrupted);
                return self.tell(*at, warns, &outcome.to_string());
            }
            Telemetry::Waypoint(_) => {}
        }
        object
    }

    /// Adds an event; returns the JSON object to send to browsers.
    pub(super) fn tell(&mut self, at: Duration, warns: bool, text: &str) -> Value {
        let event = json!({
            "type": "event",
            "t_s": at.as_secs_f64(),
            "warning": warns,
            "text": text,
            "step": null,
            "command": null,
        });
        self.remember(&event);
        event
    }

    /// Another vehicle does this now, or its agent says it.
    pub(super) fn take_in_other(&mut self, vehicle: VehicleName, seen: &Value) {
        if seen["type"] == "message" {
            self.remember(seen);
        } else {
            self.others.insert(vehicle, seen.clone());
        }
    }

    /// What others see of this vehicle, after a message about it: nothing new but of a status, its end, or what its agent says.
    pub(super) fn as_other(&self, message: &Value) -> Option<Value> {
        if message["type"] == "message" && message["again"] == false {
            return Some(message.clone());
        }
        let is_news = matches!(message["type"].as_str(), Some("status" | "end"));
        is_news.then(|| {
            let seen = |key: &str| self.status.get(key).cloned().unwrap_or(Value::Null);
            json!({
                "type": "other",
                "vehicle": self.vehicle,
                "phase": if self.end.is_null() { seen("phase") } else { "over".into() },
                "emergency": seen("emergency"),
                "airborne": seen("airborne"),
                "pose": seen("pose"),
                "uncertainty_m": seen("uncertainty_m"),
                "battery_percent": seen("battery_percent"),
                "step": seen("step"),
                "steps": seen("steps"),
                "navdata_age_s": seen("navdata_age_s"),
                "outcome": self.end.get("outcome"),
            })
        })
    }

    fn remember(&mut self, event: &Value) {
        self.events.push_back(event.clone());
        if self.events.len() > EVENTS {
            self.events.pop_front();
        }
    }

    /// Stores the end of the flight.
    pub(super) fn end(&mut self, end: Value) {
        self.end = end;
    }

    /// The snapshot as JSON.
    pub(super) fn so_far(&self) -> Value {
        let expected = expectations(&self.steps, &self.limits);
        let steps: Vec<Value> = (self.steps.iter().zip(&expected))
            .map(|(step, expected)| {
                json!({
                    "text": step.text,
                    "line": step.line,
                    "target": expected.target.map(|target| Place::from(&target)),
                })
            })
            .collect();
        let plans: serde_json::Map<String, Value> = PLANS
            .iter()
            .map(|(line, _)| (line.to_string(), plan_text(SOURCE, *line).into()))
            .collect();
        json!({
            "type": "flight",
            "version": env!("CARGO_PKG_VERSION"),
            "vehicle": self.vehicle,
            "fleet": self.fleet,
            "here": self.here,
            "others": self.others.values().collect::<Vec<_>>(),
            "drone": self.drone,
            "plan": self.name,
            "notes": self.notes,
            "steps": steps,
            "fence": {
                "text": self.limits.border.to_string(),
                // To a millimetre: a circle is drawn with many corners.
                "outline_m": self.limits.border.outline_m().map(rounded).collect::<Vec<_>>(),
            },
            "start_m": self.limits.start.map_or([0.0; 2], |start| [start.x_m, start.y_m]),
            "floor_m": self.limits.floor_m,
            "ceiling_m": self.limits.ceiling_m,
            "battery_percent_s": battery_percent(Duration::from_secs(1)),
            "battery_lands_percent": LANDING_BATTERY_PERCENT,
            "battery_warns_percent": WARNING_BATTERY_PERCENT,
            "plan_bytes": PLAN_BYTES,
            "plans": plans,
            "words": typed::remote_words().collect::<Vec<_>>(),
            "commands": LANGUAGE.iter().map(command).collect::<Vec<_>>(),
            "trail": self.flown_path.places_m().collect::<Vec<_>>(),
            "events": self.events,
            "status": self.status,
            "ready": self.ready,
            "end": self.end,
        })
    }
}

fn rounded(place_m: [f64; 2]) -> [f64; 2] {
    place_m.map(|metres| (metres * 1000.0).round() / 1000.0)
}

/// A command of the plan language, for the editor.
fn command(declared: &Declaration) -> Value {
    let Declaration { name, help, example, numbers, .. } = declared;
    json!({
        "name": name,
        "help": help,
        "example": example,
        "numbers": numbers.iter().map(|number| [number.name, number.unit]).collect::<Vec<_>>(),
        "isTarget": declared.is_target(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::timing::TickHealth;
    use autopilot::vehicle::{FlightEvent, Status, Vehicle};

    fn of(plan: &Plan) -> Snapshot {
        let vehicles = [VehicleName::default()];
        let config = VehicleConfig::default();
        Snapshot::new(Some(plan), &config, "192.168.1.1", &vehicles, &vehicles)
    }

    /// Its own status comes a moment later.
    #[test]
    fn of_a_new_mission_no_step_of_the_one_before_is_shown() {
        let plan = |text| Plan::parse("p", text).unwrap();
        let mut snapshot = of(&plan("takeoff\nland\n"));
        let mut take_in = |telemetry| {
            let content = Content::Telemetry(Duration::ZERO, telemetry, TickHealth::default());
            snapshot.take_in(&Message { vehicle: VehicleName::default(), content })
        };
        let status = Vehicle::new(&VehicleConfig::default()).unwrap().status(Duration::ZERO);
        take_in(Telemetry::Status(Status { step: Some(1), steps_done: Some(1), ..status }));
        let steps = plan("takeoff\ngoto 0 1 0 0\nland\n").steps().to_vec();
        let next = Telemetry::Mission { name: "p".to_owned(), id: None, steps, steps_done: None };
        let shown = &take_in(next)["status"];
        assert_eq!((&shown["step"], &shown["steps_done"]), (&Value::Null, &Value::Null));
    }

    #[test]
    fn a_late_viewer_knows_what_happened() {
        let plan = Plan::parse("p", "takeoff\ngoto 0 1 0 0\nland\n").unwrap();
        let mut snapshot = of(&plan);
        for step in 0..EVENTS + 5 {
            let at = Duration::from_secs(step as u64);
            let started = Telemetry::Event(FlightEvent::StepStarted { step });
            snapshot.take_in(&Message {
                vehicle: VehicleName::default(),
                content: Content::Telemetry(at, started, TickHealth::default()),
            });
        }
        let snapshot_json = snapshot.so_far();
        assert_eq!(snapshot_json["steps"][1]["text"], "goto 0 1 0 0");
        assert_eq!(snapshot_json["steps"][1]["target"]["y_m"], 1.0);
        let events = snapshot_json["events"].as_array().unwrap();
        assert_eq!((events.len(), &events[0]["step"]), (EVENTS, &json!(5)));
        let (line, _) = PLANS[0];
        let first = snapshot_json["plans"][line.to_string()].as_str().unwrap();
        assert!(first.contains("+!watch") && first.ends_with('.'), "{first}");
        assert_eq!((&snapshot_json["status"], &snapshot_json["end"]), (&Value::Null, &Value::Null));
    }
}
