//! Progress display in lines.

use std::io::stderr;
use std::time::Duration;

use autopilot::plan::Step;
use autopilot::vehicle::{FlightEvent, NotReady, Phase, Status, TICK, Telemetry, VehicleName};
use diagnostic::printable;
use rustix::termios::tcgetwinsize;

use super::prompt::PromptLine;
use super::terminal;
use crate::flight::{Content, Message};

/// Interval of status lines in plain mode.
const PLAIN_STATUS_INTERVAL: Duration = Duration::from_secs(1);
/// Navdata older than this are told of.
pub(super) const STALE: Duration = Duration::from_millis(300);

/// Prints events as lines, and the status on a line that is overwritten, or in plain mode as one line per
/// second. Everything goes to standard error, because it is meant for people.
pub(super) struct Progress {
    /// In the order of the fleet.
    vehicles: Vec<Watched>,
    prompt: PromptLine,
    plain: bool,
    status_shown: bool,
}

/// What is known of a vehicle.
struct Watched {
    name: VehicleName,
    steps: Vec<Step>,
    /// Its part of the line that is overwritten.
    status: String,
    next_plain_status: Duration,
}

impl Progress {
    /// Of these vehicles; lines of several begin with their names.
    pub(super) fn new(
        prompt: PromptLine,
        plain: bool,
        names: impl IntoIterator<Item = VehicleName>,
    ) -> Self {
        let watched = |name| Watched {
            name,
            steps: Vec::new(),
            status: String::new(),
            next_plain_status: Duration::ZERO,
        };
        let vehicles = names.into_iter().map(watched).collect();
        Self { vehicles, prompt, plain, status_shown: false }
    }

    pub(super) fn show(&mut self, message: &Message) {
        if let Some(answer) = self.prompt.take_answer() {
            self.print_line(&answer);
        }
        let place = self.vehicles.iter().position(|watched| watched.name == message.vehicle);
        let Some(place) = place else { return };
        let line = match &message.content {
            Content::Telemetry(at, Telemetry::Status(status), _) => {
                return self.status(place, *at, status);
            }
            Content::Telemetry(at, telemetry, _) => {
                self.vehicles[place].line(telemetry).map(|text| format!("{} {text}", time(*at)))
            }
            Content::Trouble(at, trouble) => Some(format!("{} {trouble}", time(*at))),
            Content::Realtime(realtime) => Some(realtime.to_string()),
            Content::Said { again: true, .. } | Content::Heard { again: true, .. } => None,
            Content::Heard { at, line, .. } => {
                let text = printable(mission_agent::text(line));
                Some(format!(
                    "{} from {}: {text}",
                    time(*at),
                    printable(mission_agent::sender(line))
                ))
            }
            Content::Said { at, said, .. } => {
                Some(format!("{} to {}: {}", time(*at), said.to, said.text()))
            }
        };
        if let Some(line) = line {
            self.print_line(&format!("{}{line}", self.whose(place)));
        }
    }

    /// What a line begins with.
    fn whose(&self, place: usize) -> String {
        let names = self.vehicles.iter().map(|watched| watched.name.as_str().len());
        match names.max() {
            Some(width) if self.vehicles.len() > 1 => {
                format!("{:<width$} ", self.vehicles[place].name.as_str())
            }
            _ => String::new(),
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

    fn status(&mut self, place: usize, at: Duration, status: &Status) {
        let whose = self.whose(place);
        let is_alone = self.vehicles.len() == 1;
        let watched = &mut self.vehicles[place];
        if self.plain {
            // In standby the status line would not change.
            if status.phase != Phase::Standby && at + TICK > watched.next_plain_status {
                watched.next_plain_status = at + PLAIN_STATUS_INTERVAL;
                self.print_line(&format!("{whose}{}", status_line(at, status)));
            }
            return;
        }
        watched.status = if is_alone {
            status_line(at, status)
        } else {
            format!("{} {}", watched.name, in_short(status))
        };
        let all = || self.vehicles.iter().map(|watched| watched.status.as_str());
        let line = self.prompt.shown().unwrap_or_else(|| all().collect::<Vec<_>>().join(" | "));
        terminal::show(shortened(&line, terminal_columns()));
        self.status_shown = true;
    }
}

impl Watched {
    /// What is said of it in a line of its own.
    fn line(&mut self, telemetry: &Telemetry) -> Option<String> {
        match telemetry {
            Telemetry::Event(FlightEvent::StepStarted { step }) => {
                let text = self.steps.get(*step).map_or("", |step| step.text.as_str());
                Some(format!("step {}/{}: {text}", step + 1, self.steps.len()))
            }
            Telemetry::Event(event) => Some(event.to_string()),
            Telemetry::Readiness(reasons) => readiness(reasons),
            Telemetry::Ended(outcome, _) => Some(outcome.to_string()),
            Telemetry::Mission { steps, .. } => {
                self.steps.clone_from(steps);
                None
            }
            Telemetry::Waypoint(_) | Telemetry::Status(_) => None,
        }
    }
}

/// What matters most of one vehicle among others.
pub(super) fn in_short(status: &Status) -> String {
    let step = status.step.map(|step| format!(" {}/{}", step + 1, status.steps));
    let charge = status.battery_percent.map(|percent| format!(" {percent} %"));
    let lost = if is_heard(status) { "" } else { " NO NAVDATA" };
    [phase(status), &step.unwrap_or_default(), &charge.unwrap_or_default(), lost].concat()
}

/// Whether its navdata are not too old.
pub(super) fn is_heard(status: &Status) -> bool {
    status.navdata_age.is_some_and(|age| age <= STALE)
}

pub(super) fn phase(status: &Status) -> &'static str {
    if status.emergency { "EMERGENCY" } else { status.phase.name() }
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
    let mut parts = vec![format!("{} {:<11}", time(at), phase(status))];
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
        Some(age) if age > STALE => {
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
            steps_done: Some(2),
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
            uncertainty_m: 0.1,
            rests_on: RestsOn::Velocity,
            contradicted_by: None,
            height_uncertainty_m: 0.02,
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
