//! What a browser that has just come must know, so that a reload loses nothing.

use std::collections::VecDeque;

use autopilot::agent::{PLANS, SOURCE, plan_text};
use autopilot::plan::{FlightLimits, Plan};
use diagnostic::printable;
use serde_json::{Value, json};

use crate::flight::Message;
use crate::json;
use crate::recording::Place;
use crate::trail::Trail;

/// Events that are remembered; older ones go.
const EVENTS: usize = 100;

/// The flight so far.
#[derive(Debug)]
pub(super) struct Story {
    plan: Plan,
    limits: FlightLimits,
    name: String,
    trail: Trail,
    events: VecDeque<Value>,
    status: Value,
    end: Value,
}

impl Story {
    pub(super) fn new(name: &str, plan: &Plan, limits: &FlightLimits) -> Self {
        Self {
            plan: plan.clone(),
            limits: *limits,
            name: printable(name).into_owned(),
            trail: Trail::default(),
            events: VecDeque::new(),
            status: Value::Null,
            end: Value::Null,
        }
    }

    /// Something happened; returns what browsers are told.
    pub(super) fn take_in(&mut self, message: &Message) -> Value {
        let object = json::message(message, self.plan.steps());
        match message {
            Message::Status(_, status, _) => {
                self.trail.add(status.pose.x_m, status.pose.y_m);
                self.status = object.clone();
            }
            Message::Event(..) | Message::Trouble(..) => {
                self.events.push_back(object.clone());
                if self.events.len() > EVENTS {
                    self.events.pop_front();
                }
            }
            Message::Realtime(_) | Message::Waypoint(_) => {}
        }
        object
    }

    /// It is over.
    pub(super) fn end(&mut self, end: Value) {
        self.end = end;
    }

    /// Everything that is needed to go on from here.
    pub(super) fn so_far(&self) -> Value {
        let expected = self.plan.expectations(&self.limits);
        let steps: Vec<Value> = (self.plan.steps().iter().zip(&expected))
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
            "plan": self.name,
            "notes": self.plan.notes(),
            "steps": steps,
            "radius_m": self.limits.radius_m,
            "floor_m": self.limits.floor_m,
            "ceiling_m": self.limits.ceiling_m,
            "plans": plans,
            "trail": self.trail.places_m().collect::<Vec<_>>(),
            "events": self.events,
            "status": self.status,
            "end": self.end,
        })
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use autopilot::pilot::FlightEvent;

    #[test]
    fn whoever_comes_later_knows_what_happened() {
        let plan = Plan::parse("p", "takeoff\ngoto 0 1 0 0\nland\n").unwrap();
        let mut story = Story::new("plan.txt", &plan, &FlightLimits::default());
        for step in 0..EVENTS + 5 {
            let at = Duration::from_secs(step as u64);
            story.take_in(&Message::Event(at, FlightEvent::StepStarted { step }));
        }
        let told = story.so_far();
        assert_eq!(told["steps"][1]["text"], "goto 0 1 0 0");
        assert_eq!(told["steps"][1]["target"]["y_m"], 1.0);
        let events = told["events"].as_array().unwrap();
        assert_eq!((events.len(), &events[0]["step"]), (EVENTS, &json!(5)));
        let (line, _) = PLANS[0];
        let first = told["plans"][line.to_string()].as_str().unwrap();
        assert!(first.contains("+!watch") && first.ends_with('.'), "{first}");
        assert_eq!((&told["status"], &told["end"]), (&Value::Null, &Value::Null));
    }
}
