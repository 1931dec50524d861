//! Conditions that last: what is believed of navdata, and what the drone says of itself.

use ardrone_link::navdata::DroneState;
use diagnostic::printable;
use serde::Serialize;

use super::rows::Row;
use super::words::spoken;

/// Most spans of a strip; a healthy flight has a few.
const MOST_SPANS: usize = 1000;
/// Maximum length of a text of the log.
const LONGEST_TEXT: usize = 60;

/// Quantities of navdata, as in the log.
pub(super) const QUANTITIES: [&str; 4] = ["velocity", "altitude", "heading", "attitude"];

/// States of the drone that explain something, and what they mean.
pub(super) const STATES: [(DroneState, &str); 11] = [
    (DroneState::EMERGENCY, "emergency: the motors are cut"),
    (DroneState::USER_EMERGENCY, "a client's emergency bit stopped the motors"),
    (DroneState::MOTORS_PROBLEM, "a motor is broken or blocked"),
    (DroneState::CUTOUT_DETECTED, "a motor was cut out"),
    (DroneState::ANGLES_OUT_OF_RANGE, "it tilts too far to fly"),
    (DroneState::TOO_MUCH_WIND, "the wind is too strong"),
    (DroneState::ULTRASOUND_DEAF, "the ultrasound hears no echo"),
    (DroneState::SOFTWARE_FAULT, "its software is faulty"),
    (DroneState::BATTERY_LOW, "the battery is too low to fly"),
    (DroneState::COMMUNICATION_LOST, "it has heard no commands for 2 s"),
    (DroneState::COMMUNICATION_WATCHDOG, "it hears no commands"),
];

/// How serious a span is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Level {
    /// As it should be.
    Plain,
    /// Not yet a reason to act.
    Suspect,
    /// Something is wrong.
    Wrong,
}

/// A condition from one time to another, in seconds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Span {
    pub(super) from_s: f64,
    pub(super) to_s: f64,
    pub(super) level: Level,
    pub(super) text: String,
}

/// A row of conditions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Strip {
    pub(super) name: &'static str,
    pub(super) spans: Vec<Span>,
}

impl Strip {
    fn extend(&mut self, at_s: f64, condition: Option<(Level, &str)>) {
        let Some((level, text)) = condition else { return };
        if let Some(last) = self.spans.last_mut()
            && last.to_s.is_nan()
        {
            last.to_s = at_s;
            if last.level == level && last.text == text {
                last.to_s = f64::NAN;
                return;
            }
        }
        if self.spans.len() < MOST_SPANS {
            let text = text.to_owned();
            self.spans.push(Span { from_s: at_s, to_s: f64::NAN, level, text });
        }
    }

    /// Ends the condition that lasts.
    fn end(&mut self, at_s: f64) {
        if let Some(last) = self.spans.last_mut()
            && last.to_s.is_nan()
        {
            last.to_s = at_s;
        }
    }
}

/// What was believed of each quantity; empty if it was not recorded.
pub(super) fn beliefs(rows: &[Row<'_>]) -> Vec<Strip> {
    if rows.iter().all(|row| row.tick.disbelieved.is_none()) {
        return Vec::new();
    }
    let strip = |quantity: &'static str| {
        let mut strip = Strip { name: quantity, spans: Vec::new() };
        for row in rows {
            let Some(disbelieved) = &row.tick.disbelieved else { continue };
            let found = disbelieved.get(quantity).map(|text| short(text));
            let condition = match found.as_deref() {
                None => (Level::Plain, "sound"),
                Some("suspect") => (Level::Suspect, "suspect"),
                Some(wrong) => (Level::Wrong, wrong),
            };
            strip.extend(row.at_s, Some(condition));
        }
        strip.end(rows.last().map_or(0.0, |row| row.at_s));
        strip
    };
    QUANTITIES.map(strip).into()
}

/// What the drone said of itself: its control state, and whatever is wrong with it.
pub(super) fn states(rows: &[Row<'_>]) -> Vec<Strip> {
    let mut control = Strip { name: "control state", spans: Vec::new() };
    let mut wrong = Strip { name: "reports", spans: Vec::new() };
    for row in rows {
        let state = row.heard.and_then(|heard| heard.control_state.as_deref());
        let state = state.map(|state| short(&spoken(state)));
        match &state {
            Some(state) => control.extend(row.at_s, Some((Level::Plain, state))),
            None => control.end(row.at_s),
        }
        let texts: Vec<&str> = set(row).map(|(_, text)| text).collect();
        if texts.is_empty() {
            wrong.end(row.at_s);
        } else {
            wrong.extend(row.at_s, Some((Level::Wrong, &texts.join("; "))));
        }
    }
    let end_s = rows.last().map_or(0.0, |row| row.at_s);
    control.end(end_s);
    wrong.end(end_s);
    vec![control, wrong]
}

/// The states in [`STATES`] that are set.
pub(super) fn set(row: &Row<'_>) -> impl Iterator<Item = (DroneState, &'static str)> {
    let state = row.state.unwrap_or_default();
    STATES.into_iter().filter(move |(bit, _)| state.contains(*bit))
}

fn short(text: &str) -> String {
    let text: String = text.chars().take(LONGEST_TEXT).collect();
    printable(&text).into_owned()
}
