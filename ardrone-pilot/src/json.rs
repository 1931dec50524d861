//! JSON objects for programs and browsers, each with its `type`.

use std::fmt::Write as _;
use std::time::Duration;

use autopilot::plan::Step;
use autopilot::vehicle::{
    CrossCheck, FlightEvent, FlightReport, LandingReason, ManualControl, Status, Telemetry,
};
use diagnostic::is_printable;
use serde_json::{Value, json};

use crate::flight::{Content, FinishedFlight, Message};
use crate::recording::{GpsPosition, Place, Recorded, Tags};
use crate::timing::TickHealth;

/// A value as text that is safe anywhere: on a terminal, in a page, in a script. Characters with a meaning
/// there are written as escapes like `\u003c`, which are equivalent in JSON.
pub(crate) fn text(value: &Value) -> String {
    escaped(&value.to_string())
}

/// Like [`text`], on many lines.
pub(crate) fn text_in_lines(value: &Value) -> String {
    escaped(&format!("{value:#}"))
}

/// Escapes unsafe characters. Outside strings JSON contains none of them except line feeds, which are already
/// escaped inside strings.
fn escaped(json: &str) -> String {
    let mut text = String::with_capacity(json.len());
    for character in json.chars() {
        if matches!(character, '<' | '>' | '&') || (character != '\n' && !is_printable(character)) {
            for unit in character.encode_utf16(&mut [0; 2]) {
                // Writing to a string cannot fail.
                _ = write!(text, "\\u{unit:04x}");
            }
        } else {
            text.push(character);
        }
    }
    text
}

/// Version of the orders and objects of `--json`: greater when one of them has another meaning, not when there are more of them.
const INTERFACE: u32 = 1;

/// The first object, by which a program knows what it talks with.
pub(crate) fn hello() -> Value {
    json!({
        "type": "hello",
        "program": "ardrone-pilot",
        "version": env!("CARGO_PKG_VERSION"),
        "interface": INTERFACE,
    })
}

/// A message of the flight.
pub(crate) fn message(message: &Message, steps: &[Step]) -> Value {
    let mut object = content(&message.content, steps);
    object["vehicle"] = message.vehicle.as_str().into();
    object
}

fn content(content: &Content, steps: &[Step]) -> Value {
    match content {
        Content::Realtime(realtime) => json!({ "type": "realtime", "text": realtime.to_string() }),
        Content::Telemetry(at, told, ticks) => telemetry(*at, told, *ticks, steps),
        Content::Said { at, said, again } => json!({
            "type": "message",
            "t_s": at.as_secs_f64(),
            "to": said.to,
            "text": said.text(),
            "line": said.line.as_str(),
            "again": again,
        }),
        Content::Heard { at, line, again } => json!({
            "type": "heard",
            "t_s": at.as_secs_f64(),
            "from": mission_agent::sender(line),
            "text": mission_agent::text(line),
            "line": line.as_str(),
            "again": again,
        }),
        Content::Trouble(at, trouble) => json!({
            "type": "event",
            "t_s": at.as_secs_f64(),
            "warning": true,
            "text": trouble.to_string(),
            "step": null,
            "command": null,
        }),
    }
}

fn telemetry(at: Duration, telemetry: &Telemetry, ticks: TickHealth, steps: &[Step]) -> Value {
    match telemetry {
        Telemetry::Event(FlightEvent::Landed) => {
            json!({ "type": "landed", "t_s": at.as_secs_f64() })
        }
        Telemetry::Event(event) => {
            let step = match event {
                FlightEvent::StepStarted { step } | FlightEvent::StepDone { step } => Some(*step),
                _ => None,
            };
            let command = step.and_then(|step| steps.get(step)).map(|step| step.text.as_str());
            json!({
                "type": "event",
                "t_s": at.as_secs_f64(),
                "warning": event.warns(),
                "text": event.to_string(),
                "step": step,
                "command": command,
            })
        }
        Telemetry::Mission { name, steps, steps_done, .. } => json!({
            "type": "mission",
            "name": name,
            "steps": steps.iter().map(|step| step.text.as_str()).collect::<Vec<_>>(),
            "steps_done": steps_done,
        }),
        Telemetry::Readiness(reasons) => json!({
            "type": "ready",
            "t_s": at.as_secs_f64(),
            "ready": reasons.is_empty(),
            "reasons": reasons.iter().map(ToString::to_string).collect::<Vec<_>>(),
        }),
        Telemetry::Ended(outcome, report) => json!({
            "type": "flight_ended",
            "t_s": at.as_secs_f64(),
            "outcome": outcome.to_string(),
            "exit_status": outcome.exit_status(),
            "steps": report.steps,
            "steps_done": report.steps_done,
            "flight_time_s": report.flight_time().map(|time| time.as_secs_f64()),
            "final_error_m": report.final_error_m(),
            "last_target": last_target(report),
        }),
        Telemetry::Waypoint(waypoint) => json!({
            "type": "target",
            "t_s": waypoint.at.as_secs_f64(),
            "step": waypoint.step,
            "target": Place::from(&waypoint.target),
            "reached": Place::from(&waypoint.pose),
            "error_m": waypoint.error_m(),
        }),
        Telemetry::Status(status) => self::status(at, status, ticks),
    }
}

/// The vehicle's status, with the timing of the ticks.
fn status(at: Duration, status: &Status, ticks: TickHealth) -> Value {
    let Status { phase, step, steps, target, distance_m, battery_percent, .. } = status;
    json!({
        "type": "status",
        "t_s": at.as_secs_f64(),
        "phase": phase.name(),
        "landing": status.landing.map(|reason| reason.to_string()),
        "landing_ordered": status.landing == Some(LandingReason::Operator),
        "emergency": status.emergency,
        "airborne": status.airborne,
        "flight_time_s": status.flight_time.map(|time| time.as_secs_f64()),
        "camera": status.camera,
        "step": step,
        "steps": steps,
        "steps_done": status.steps_done,
        "mission_waits": status.mission_waits,
        "manual": status.manual.map(ManualControl::name),
        "controls": status.controls.map(|operator| operator.to_string()),
        "pose": status.pose.map(|pose| Place::from(&pose)),
        "velocity_m_s": status.velocity_m_s,
        "target": target.map(|target| Place::from(&target)),
        "distance_m": distance_m,
        "battery_percent": battery_percent,
        "battery_v": status.battery_v,
        "uncertainty_m": status.uncertainty_m,
        "uncertainty_holds": status.rests_on.to_string(),
        "rests_on": status.rests_on.name(),
        "contradicted_by": status.contradicted_by.map(CrossCheck::name),
        "height_uncertainty_m": status.height_uncertainty_m,
        "tags": status.tags.as_ref().map(|tags| json!({
            "known": tags.known.count(),
            "map": Tags::from(tags).tags,
            "seen_s": tags.seen_ago.map(|ago| ago.as_secs_f64()),
            "heading_held": tags.heading_held,
            "drift_m": [tags.drift_m.x, tags.drift_m.y],
        })),
        "gps": status.gps.map(GpsPosition::from),
        "attitude_deg": status.attitude_deg,
        "navdata_hz": status.navdata_hz,
        "navdata_age_s": status.navdata_age.map(|age| age.as_secs_f64()),
        "tick_late_s": ticks.lateness.as_secs_f64(),
        "ticks_skipped": ticks.skipped,
        "order": status.command,
        "plans": status.plans.places().map(|(line, _)| line).collect::<Vec<_>>(),
    })
}

/// The end of the flight.
pub(crate) fn end(
    finished: &FinishedFlight,
    recorded: Option<&Recorded>,
    exit_status: u8,
) -> Value {
    let report = &finished.report;
    json!({
        "type": "end",
        "vehicle": finished.vehicle,
        "outcome": finished.outcome.to_string(),
        "exit_status": exit_status,
        "steps": report.steps,
        "steps_done": report.steps_done,
        "flight_time_s": report.flight_time().map(|time| time.as_secs_f64()),
        "final_error_m": report.final_error_m(),
        "last_target": last_target(report),
        "log": recorded.map(|recorded| recorded.path.display().to_string()),
    })
}

/// The uncertainty at the last target, and what it rests on.
fn last_target(report: &FlightReport) -> Value {
    report.waypoints.last().map_or(Value::Null, |waypoint| {
        json!({
            "uncertainty_m": waypoint.uncertainty_m,
            "uncertainty_holds": waypoint.rests_on.to_string(),
            "rests_on": waypoint.rests_on.name(),
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_text_can_stand_anywhere_and_means_the_same() {
        let foreign = "</script><!--<script>&\u{2028}\u{2029}\x1b[2J\u{9b}\u{7f}\u{202e}\n\"\\\u{e0041}\u{b0}";
        let value = json!({ "text": [foreign, 1.5] });
        for text in [text(&value), text_in_lines(&value)] {
            let odd =
                text.chars().find(|c| "<>&".contains(*c) || (*c != '\n' && !is_printable(*c)));
            assert_eq!(odd, None, "{text:?}");
            assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), value);
        }
        assert_eq!(text(&json!("<\u{b0}\u{e0041}")), "\"\\u003c\u{b0}\\udb40\\udc41\"");
        assert!(!text(&value).contains('\n'));
    }
}
