//! Progress display in lines.

use std::io::stderr;
use std::time::Duration;

use autopilot::plan::Step;
use autopilot::vehicle::{FlightEvent, NotReady, Phase, Status, TICK, Telemetry};
use rustix::termios::tcgetwinsize;

use super::prompt::PromptLine;
use super::terminal;
use crate::flight::{Content, Message};

/// Interval of status lines in plain mode.
const PLAIN_STATUS_INTERVAL: Duration = Duration::from_secs(1);

/// Prints events as lines, and the status on a line that is overwritten, or in plain mode as one line per
/// second. Everything goes to standard error, because it is meant for people.
pub(super) struct Progress {
    steps: Vec<Step>,
    prompt: PromptLine,
    plain: bool,
    status_shown: bool,
    next_plain_status: Duration,
}

impl Progress {
    pub(super) fn new(prompt: PromptLine, plain: bool) -> Self {
        Self {
            steps: Vec::new(),
            prompt,
            plain,
            status_shown: false,
            next_plain_status: Duration::ZERO,
        }
    }

    pub(super) fn show(&mut self, message: &Message) {
        if let Some(answer) = self.prompt.take_answer() {
            self.print_line(&answer);
        }
        match &message.content {
            Content::Telemetry(at, telemetry, _) => self.tell(*at, telemetry),
            Content::Trouble(at, trouble) => self.print_line(&format!("{} {trouble}", time(*at))),
            Content::Realtime(realtime) => self.print_line(&realtime.to_string()),
        }
    }

    fn tell(&mut self, at: Duration, telemetry: &Telemetry) {
        let text = match telemetry {
            Telemetry::Event(event) => Some(self.event_text(event)),
            Telemetry::Readiness(reasons) => readiness(reasons),
            Telemetry::Ended(outcome, _) => Some(outcome.to_string()),
            Telemetry::Waypoint(_) => None,
            Telemetry::Mission { steps, .. } => {
                self.steps.clone_from(steps);
                None
            }
            Telemetry::Status(status) => {
                self.status(at, status);
                None
            }
        };
        if let Some(text) = text {
            self.print_line(&format!("{} {text}", time(at)));
        }
    }

    /// Prints a line.
    pub(super) fn print_line(&mut self, line: &str) {
        if std::mem::take(&mut self.status_shown) {
            terminal::replace_line(line);
        } else {
            terminal::print_message(line);
        }
    }

    /// Prints a warning.
    pub(super) fn warn(&mut self, line: &str) {
        self.print_line(&format!("warning: {line}"));
    }

    /// Clears the status line at the end of the flight.
    pub(super) fn end(&mut self) {
        if std::mem::take(&mut self.status_shown) {
            terminal::clear();
        }
    }

    fn event_text(&self, event: &FlightEvent) -> String {
        match event {
            FlightEvent::StepStarted { step } => {
                let text = self.steps.get(*step).map_or("", |step| step.text.as_str());
                format!("step {}/{}: {text}", step + 1, self.steps.len())
            }
            other => other.to_string(),
        }
    }

    fn status(&mut self, at: Duration, status: &Status) {
        let line = match self.prompt.shown() {
            Some(prompt) if !self.plain => prompt,
            _ => status_line(at, status),
        };
        if !self.plain {
            terminal::show(shortened(&line, terminal_columns()));
            self.status_shown = true;
        // In standby the status line would not change.
        } else if status.phase != Phase::Standby && at + TICK > self.next_plain_status {
            self.next_plain_status = at + PLAIN_STATUS_INTERVAL;
            self.print_line(&line);
        }
    }
}

/// The readiness as text; `None` in flight, where it is not of interest.
pub(super) fn readiness(reasons: &[NotReady]) -> Option<String> {
    match reasons {
        [] => Some("ready to take off".to_owned()),
        [NotReady::InFlight] => None,
        reasons => {
            let reasons: Vec<String> = reasons.iter().map(ToString::to_string).collect();
            Some(format!("not ready: {}", reasons.join("; ")))
        }
    }
}

fn status_line(at: Duration, status: &Status) -> String {
    let phase = if status.emergency { "EMERGENCY" } else { status.phase.name() };
    let mut parts = vec![format!("{} {phase:<11}", time(at))];
    if let Some(step) = status.step {
        parts.push(format!("{}/{}", step + 1, status.steps));
    }
    if let Some(pose) = status.pose {
        parts.push(format!(
            " at {:+.2} {:+.2} {:.2} m {:+.0}°",
            pose.x_m,
            pose.y_m,
            pose.z_m,
            // Avoids printing "-0".
            pose.yaw_deg.round() + 0.0
        ));
    }
    if let (Some(target), Some(distance_m)) = (status.target, status.distance_m) {
        parts.push(format!(
            " to {:+.2} {:+.2} {:.2} m, {distance_m:.2} m off",
            target.x_m, target.y_m, target.z_m
        ));
    }
    if let Some(battery_percent) = status.battery_percent {
        parts.push(format!(" battery {battery_percent} %"));
    }
    match status.navdata_age {
        Some(age) if age > Duration::from_millis(300) => {
            parts.push(format!(" NO NAVDATA for {:.1} s", age.as_secs_f64()));
        }
        Some(_) => {}
        None => parts.push(" no navdata yet".to_owned()),
    }
    parts.join(" ")
}

/// Truncates a line that is overwritten, because it must not wrap.
fn shortened(line: &str, columns: usize) -> &str {
    let end = line.char_indices().nth(columns.saturating_sub(1)).map(|(index, _)| index);
    &line[..end.unwrap_or(line.len())]
}

fn terminal_columns() -> usize {
    const USUAL: usize = 80;
    tcgetwinsize(stderr()).map_or(USUAL, |size| usize::from(size.ws_col).max(1))
}

fn time(at: Duration) -> String {
    format!("{:6.1} s", at.as_secs_f64())
}

#[cfg(test)]
mod tests {
    use kinematics::Pose;

    use super::*;
    use autopilot::agent::ChosenPlans;
    use autopilot::vehicle::{RestsOn, Trust};
    use kinematics::Airframe;

    #[test]
    fn a_status_line_does_not_wrap() {
        assert_eq!(shortened("12°45", 4), "12°");
        assert_eq!(shortened("12°45", 80), "12°45");
        assert_eq!(shortened("", 1), "");
    }

    #[test]
    fn the_status_line_says_where_and_where_to() {
        let status = Status {
            phase: Phase::Flying,
            step: Some(2),
            steps: 6,
            mission_waits: false,
            landing: None,
            emergency: false,
            airborne: true,
            flight_time: None,
            camera: None,
            altitude_m: None,
            manual: None,
            controls: None,
            pose: Some(Pose { x_m: 0.12, y_m: 0.98, z_m: 0.85, yaw_deg: -1.0 }),
            velocity_m_s: None,
            target: Some(Pose { x_m: 1.0, y_m: 1.0, z_m: 0.85, yaw_deg: 0.0 }),
            distance_m: Some(0.88),
            battery_percent: Some(87),
            battery_v: Some(11.9),
            turn_rate_deg_s: Some(0.0),
            horizontal_deviation_m: 0.1,
            rests_on: RestsOn::Velocity,
            contradicted_by: None,
            vertical_deviation_m: 0.02,
            tags: None,
            gps: None,
            trust: Trust::Sound,
            airframe: Airframe::default(),
            navdata_age: Some(Duration::from_millis(40)),
            navdata_hz: 15.0,
            attitude_deg: None,
            plans: ChosenPlans::default(),
            command: None,
        };
        assert_eq!(
            status_line(Duration::from_millis(12_340), &status),
            "  12.3 s flying      3/6  at +0.12 +0.98 0.85 m -1°  to +1.00 +1.00 0.85 m, 0.88 m off  battery 87 %"
        );
        // With its motors cut it does not stand by.
        let fallen = Status { phase: Phase::Standby, emergency: true, ..status };
        assert!(status_line(Duration::ZERO, &fallen).starts_with("   0.0 s EMERGENCY  "));
    }
}
