//! Contents and layout of the screen.

use std::collections::VecDeque;
use std::time::Duration;

use autopilot::agent::WARNING_BATTERY_PERCENT;
use autopilot::outcome::Outcome;
use autopilot::plan::FlightLimits;
use autopilot::vehicle::{
    FlightEvent, ManualControl, NotReady, Phase, RestsOn, Status, Telemetry, VehicleName,
};
use diagnostic::{printable, printable_lines};
use kinematics::Pose;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::symbols::Marker;
use ratatui::text::{Line, Span};
use ratatui::widgets::canvas::{Canvas, Line as Segment, Points};
use ratatui::widgets::{Block, Gauge, List, ListItem, Paragraph};

use super::super::progress::{STALE, in_short, is_heard, phase};
use super::{WARNING, tags, texts};
use crate::flight::{Content, Message};
use crate::flown_path::FlownPath;
use crate::network::Seen;
use crate::timing::TickHealth;

/// Capacity of the lists of events and decisions.
const REMEMBERED: usize = 50;

/// Fewest lines of the mission.
const LEAST_STEPS: u16 = 3;
/// Fewest columns beside the map: a target with its distance fits.
const LEAST_SIDE: u16 = 40;
/// Lines of a pane's border, and of the height in front of the lines about the drone.
const BORDER: usize = 2;
const HEIGHT: usize = 1;
/// Fewest of those lines, so that nothing below them moves when one comes.
const LEAST_GAUGES: usize = 5;

const HERE: Color = Color::Cyan;
const TARGET: Color = Color::Yellow;
const OTHER: Color = Color::Magenta;

/// State of the display.
#[derive(Debug, Clone)]
pub(super) struct View {
    steps: Vec<String>,
    /// Reasons not to take off.
    not_ready: Vec<String>,
    /// Text of the open prompt.
    pub(super) prompt: Option<String>,
    /// Answer to the last line that was typed.
    pub(super) answer: Option<String>,
    limits: FlightLimits,
    at: Duration,
    status: Option<Status>,
    ticks: TickHealth,
    flown_path: FlownPath,
    /// Time and text of each change in the agent's decisions.
    decisions: VecDeque<(Duration, String)>,
    /// What happened, and whether each is a warning.
    events: VecDeque<(String, bool)>,
}

impl View {
    pub(super) fn new(limits: &FlightLimits) -> Self {
        Self {
            steps: Vec::new(),
            not_ready: Vec::new(),
            prompt: None,
            answer: None,
            limits: *limits,
            at: Duration::ZERO,
            status: None,
            ticks: TickHealth::default(),
            flown_path: FlownPath::default(),
            decisions: VecDeque::new(),
            events: VecDeque::new(),
        }
    }

    pub(super) fn print_line(&mut self, line: &str) {
        remember(&mut self.events, (printable(line).into_owned(), false));
    }

    /// As [`View::print_line`], but marked as a warning, and printed again when the screen closes.
    pub(super) fn warn(&mut self, line: &str) {
        remember(&mut self.events, (printable_lines(line).into_owned(), true));
    }

    /// All warnings.
    pub(super) fn warnings(&self) -> Vec<String> {
        let warnings = self.events.iter().filter(|(_, warns)| *warns);
        warnings.map(|(text, _)| text.clone()).collect()
    }

    /// Returns what was warned of.
    pub(super) fn take_in(&mut self, message: &Message) -> Option<String> {
        let (line, warns) = match &message.content {
            Content::Realtime(realtime) => (printable(&realtime.to_string()).into_owned(), false),
            Content::Said { again: true, .. } | Content::Heard { again: true, .. } => return None,
            Content::Heard { at, line, .. } => {
                let (from, text) =
                    (printable(mission_agent::sender(line)), printable(mission_agent::text(line)));
                (format!("{:6.1} s from {from}: {text}", at.as_secs_f64()), false)
            }
            Content::Said { at, said, .. } => {
                let text = printable(said.text());
                (format!("{:6.1} s to {}: {text}", at.as_secs_f64(), said.to), false)
            }
            Content::Trouble(at, trouble) => {
                (format!("{:6.1} s {trouble}", at.as_secs_f64()), true)
            }
            Content::Telemetry(at, telemetry, ticks) => {
                self.ticks = *ticks;
                let (text, warns) = self.tell(*at, telemetry)?;
                (format!("{:6.1} s {}", at.as_secs_f64(), printable(&text)), warns)
            }
        };
        let warned = warns.then(|| line.clone());
        remember(&mut self.events, (line, warns));
        warned
    }

    /// What is to be said of it, and whether it is a warning.
    fn tell(&mut self, at: Duration, telemetry: &Telemetry) -> Option<(String, bool)> {
        match telemetry {
            Telemetry::Waypoint(_) => {}
            Telemetry::Mission { steps, .. } => {
                self.steps = steps.iter().map(|step| step.text.clone()).collect();
            }
            Telemetry::Readiness(reasons) => {
                self.not_ready = reasons
                    .iter()
                    .filter(|reason| **reason != NotReady::InFlight)
                    .map(|reason| printable(&reason.to_string()).into_owned())
                    .collect();
            }
            Telemetry::Ended(outcome, report) => {
                let (done, steps) = (report.steps_done, report.steps);
                let text = format!("{outcome}; {done} of {steps} steps");
                return Some((text, *outcome != Outcome::Completed));
            }
            Telemetry::Event(event) => {
                let text = match event {
                    FlightEvent::StepStarted { step } => {
                        let text = self.steps.get(*step).map_or("", String::as_str);
                        format!("step {}: {text}", step + 1)
                    }
                    other => other.to_string(),
                };
                return Some((text, event.warns()));
            }
            Telemetry::Status(status) => self.look(at, status),
        }
        None
    }

    /// What it does, in a few words; and whether somebody should look.
    fn summary(&self) -> (String, bool) {
        let Some(status) = &self.status else { return ("-".to_owned(), false) };
        (in_short(status), status.emergency || is_low(status) || !is_heard(status))
    }

    fn look(&mut self, at: Duration, status: &Status) {
        if let Some(pose) = status.pose {
            self.flown_path.add(&pose);
        }
        let decision = decision(status);
        if !decision.is_empty() && self.decisions.back().is_none_or(|(_, last)| *last != decision) {
            remember(&mut self.decisions, (at, decision));
        }
        self.at = at;
        self.status = Some(*status);
    }
}

fn remember<T>(lines: &mut VecDeque<T>, line: T) {
    lines.push_back(line);
    if lines.len() > REMEMBERED {
        lines.pop_front();
    }
}

/// The agent's command, and the plans that led to it.
fn decision(status: &Status) -> String {
    let plans = status.plans.places().map(|(line, trigger)| format!("{trigger} {line}"));
    let plans: Vec<String> = plans.collect();
    match status.command {
        Some(command) => format!("{command}: {}", plans.join(", ")),
        None => String::new(),
    }
}

/// The vehicles of the screen, and which of them is shown.
#[derive(Debug)]
pub(super) struct Views {
    /// At least one.
    pub(super) all: Vec<(VehicleName, View)>,
    /// Those that are flown elsewhere: they cannot be chosen.
    pub(super) elsewhere: Vec<Seen>,
    pub(super) shown: usize,
}

impl Views {
    /// One vehicle alone.
    #[cfg(test)]
    pub(super) fn alone(view: &View) -> Self {
        Self { all: vec![(VehicleName::default(), view.clone())], elsewhere: Vec::new(), shown: 0 }
    }

    pub(super) fn shown(&self) -> &View {
        &self.all[self.shown.min(self.all.len() - 1)].1
    }

    /// Marks and places of the others.
    fn others(&self) -> impl Iterator<Item = (String, Pose)> + '_ {
        let others = self.all.iter().enumerate().filter(|(place, _)| *place != self.shown);
        let others = others
            .filter_map(|(place, (_, view))| Some(((place + 1).to_string(), view.status?.pose?)));
        let elsewhere = self.elsewhere.iter().filter_map(|seen| {
            let place_m = seen.told?.place_m;
            let pose = Pose { x_m: place_m.x, y_m: place_m.y, ..Pose::default() };
            Some((seen.vehicle.to_string(), pose))
        });
        others.chain(elsewhere)
    }

    /// All vehicles of several, with the keys that choose them, on as many lines as they need.
    fn list(&self, columns: usize) -> Vec<Line<'_>> {
        if self.all.len() == 1 && self.elsewhere.is_empty() {
            return Vec::new();
        }
        let items = self.all.iter().enumerate().map(|(place, (name, view))| {
            let (text, ill) = view.summary();
            let mut style = if ill { Style::new().fg(WARNING) } else { Style::new() };
            if place == self.shown {
                style = style.add_modifier(Modifier::REVERSED);
            }
            Span::styled(format!(" {} {name} {text} ", place + 1), style)
        });
        let elsewhere = self.elsewhere.iter().map(|seen| {
            let (text, ill) = seen.in_short();
            let style = if ill { Style::new().fg(WARNING) } else { Style::new() };
            Span::styled(format!("   {} {text} ", seen.vehicle), style)
        });
        let mut lines: Vec<Line<'_>> = Vec::new();
        for item in items.chain(elsewhere) {
            match lines.last_mut().filter(|line| line.width() + item.width() <= columns) {
                Some(line) => line.push_span(item),
                None => lines.push(Line::from(item)),
            }
        }
        lines
    }
}

/// Draws the whole screen.
pub(super) fn draw(frame: &mut Frame<'_>, views: &Views) {
    let view = views.shown();
    let list = views.list(frame.area().width.into());
    let [fleet, head, body, foot, keys] = Layout::vertical([
        Constraint::Length(u16::try_from(list.len()).unwrap_or_default()),
        Constraint::Length(1),
        Constraint::Min(10),
        Constraint::Length(7),
        Constraint::Length(1),
    ])
    .areas(frame.area());
    let columns = (body.width * 9 / 20).max(LEAST_SIDE.min(body.width / 2));
    let [map, side] =
        Layout::horizontal([Constraint::Min(0), Constraint::Length(columns)]).areas(body);
    let about =
        texts::wrapped_all(&about_the_drone(view), usize::from(columns).saturating_sub(BORDER));
    let most = usize::from(side.height.saturating_sub(LEAST_STEPS));
    let gauges = (about.len().max(LEAST_GAUGES) + HEIGHT + BORDER).min(most);
    let table = tags::lines(view.status.as_ref(), most - gauges);
    let length = |lines| Constraint::Length(u16::try_from(lines).unwrap_or_default());
    let [gauges, table, steps] =
        Layout::vertical([length(gauges), length(table), Constraint::Min(LEAST_STEPS)]).areas(side);
    let [decisions, events] =
        Layout::horizontal([Constraint::Percentage(50), Constraint::Percentage(50)]).areas(foot);
    frame.render_widget(Paragraph::new(list), fleet);
    frame.render_widget(headline(view), head);
    draw_map(frame, map, view, &views.others().collect::<Vec<_>>());
    draw_gauges(frame, gauges, view, &about);
    tags::draw(frame, table, view.status.as_ref());
    draw_steps(frame, steps, view);
    let decided = view.decisions.iter().rev();
    let decided = decided.map(|(at, text)| (format!("{:6.1} s {text}", at.as_secs_f64()), false));
    texts::draw_newest(frame, decisions, "decisions: plans and their lines", decided);
    let told = view.events.iter().rev().map(|(text, warns)| (text.as_str(), *warns));
    texts::draw_newest(frame, events, "events", told);
    frame.render_widget(foot_line(view), keys);
    texts::draw_answer(frame, body, view.answer.as_deref());
}

/// The prompt, or the summary of keys.
fn foot_line(view: &View) -> Paragraph<'_> {
    match &view.prompt {
        Some(prompt) => Paragraph::new(prompt.as_str()),
        None => Paragraph::new(
            ": order  space hold  r resume  l land  q quit  wasd+arrows fly  e Enter cut",
        )
        .style(Style::new().add_modifier(Modifier::DIM)),
    }
}

fn is_low(status: &Status) -> bool {
    status.battery_percent.is_some_and(|percent| percent <= WARNING_BATTERY_PERCENT)
}

/// Phase, step, battery and link on one line.
fn headline(view: &View) -> Paragraph<'_> {
    let Some(status) = &view.status else { return Paragraph::new("looking for the drone") };
    let mut parts = vec![Span::styled(
        format!(" {:.1} s  {} ", view.at.as_secs_f64(), phase(status)),
        Style::new().add_modifier(Modifier::REVERSED),
    )];
    if let Some(step) = status.step {
        let by_hand = match (status.mission_waits, status.manual) {
            (false, _) => "",
            (true, None | Some(ManualControl::Hold)) => ", holding",
            (true, Some(_)) => ", by hand",
        };
        parts.push(Span::raw(format!("  step {}/{}{by_hand}", step + 1, status.steps)));
    }
    let charge = status.battery_percent.map_or("-".to_owned(), |percent| format!("{percent} %"));
    let style = if is_low(status) { Style::new().fg(WARNING) } else { Style::new() };
    parts.push(Span::styled(format!("  battery {charge}"), style));
    let (link, style) = match status.navdata_age {
        Some(age) if age > STALE => {
            let text = format!("  NO NAVDATA for {:.1} s", age.as_secs_f64());
            (text, Style::new().fg(WARNING))
        }
        Some(age) => {
            let text = format!("  navdata {:.0}/s, {} ms old", status.navdata_hz, age.as_millis());
            (text, Style::new())
        }
        None => ("  no navdata yet".to_owned(), Style::new().fg(WARNING)),
    };
    parts.push(Span::styled(link, style));
    Paragraph::new(Line::from(parts))
}

/// Map from above: fence, flown path, drone with its heading, target, other vehicles.
fn draw_map(frame: &mut Frame<'_>, area: Rect, view: &View, others: &[(String, Pose)]) {
    let pose = view.status.and_then(|status| status.pose).unwrap_or_default();
    let target = view.status.and_then(|status| status.target);
    let places = view
        .flown_path
        .places_m()
        .map(|[x_m, y_m, _]| (x_m, y_m))
        .chain(target.map(|target| (target.x_m, target.y_m)))
        .chain(others.iter().map(|(_, pose)| (pose.x_m, pose.y_m)));
    let (mut x, mut y) = ((0.0_f64, 0.0_f64), (0.0_f64, 0.0_f64));
    for place in places.chain(tags::places_m(view.status.as_ref())) {
        x = (x.0.min(place.0), x.1.max(place.0));
        y = (y.0.min(place.1), y.1.max(place.1));
    }
    let (columns, rows) = (f64::from(area.width.max(3)), f64::from(area.height.max(3)));
    // A character cell is about twice as high as it is wide.
    let wide = columns / (2.0 * rows);
    let half_m = ((y.1 - y.0) / 2.0).max((x.1 - x.0) / 2.0 / wide).max(0.7) * 1.2;
    let middle = (f64::midpoint(x.0, x.1), f64::midpoint(y.0, y.1));
    let trail: Vec<(f64, f64)> =
        view.flown_path.places_m().map(|[x_m, y_m, _]| (x_m, y_m)).collect();
    let title = format!("from above, {:.1} m high", 2.0 * half_m);
    let canvas = Canvas::default()
        .block(Block::bordered().title(title))
        .marker(Marker::Braille)
        .x_bounds([middle.0 - half_m * wide, middle.0 + half_m * wide])
        .y_bounds([middle.1 - half_m, middle.1 + half_m])
        .paint(|context| {
            for [[x1, y1], [x2, y2]] in view.limits.border.sides_m() {
                context.draw(&Segment { x1, y1, x2, y2, color: WARNING });
            }
            context.draw(&Points { coords: &trail, color: Color::DarkGray });
            context.print(0.0, 0.0, "·");
            tags::mark(context, view.status.as_ref());
            for (mark, pose) in others {
                let style = Style::new().fg(OTHER).add_modifier(Modifier::BOLD);
                context.print(pose.x_m, pose.y_m, Span::styled(mark.clone(), style));
            }
            if let Some(target) = target {
                context.print(target.x_m, target.y_m, Span::styled("o", Style::new().fg(TARGET)));
            }
            let yaw_rad = pose.yaw_deg.to_radians();
            let nose_m = half_m * 0.15;
            context.draw(&Segment {
                x1: pose.x_m,
                y1: pose.y_m,
                x2: pose.x_m + nose_m * yaw_rad.sin(),
                y2: pose.y_m + nose_m * yaw_rad.cos(),
                color: HERE,
            });
            context.print(pose.x_m, pose.y_m, Span::styled("X", Style::new().fg(HERE)));
        });
    frame.render_widget(canvas, area);
}

/// Height, and what else is said of the drone.
fn draw_gauges(frame: &mut Frame<'_>, area: Rect, view: &View, about: &[String]) {
    let block = Block::bordered().title("drone");
    let inside = block.inner(area);
    frame.render_widget(block, area);
    let Some(status) = &view.status else { return };
    let [height, text] =
        Layout::vertical([Constraint::Length(1), Constraint::Min(1)]).areas(inside);
    let height_m = status.pose.map_or(0.0, |pose| pose.z_m);
    let share = (height_m / view.limits.ceiling_m).clamp(0.0, 1.0);
    let share = if share.is_nan() { 0.0 } else { share };
    frame.render_widget(
        Gauge::default().ratio(share).gauge_style(Style::new().fg(HERE)).label(match status.pose {
            Some(pose) => format!("height {:.2} of {} m", pose.z_m, view.limits.ceiling_m),
            None => "height unknown".to_owned(),
        }),
        height,
    );
    frame.render_widget(Paragraph::new(about.join("\n")), text);
}

/// Whether it could fly, attitude, position and target.
fn about_the_drone(view: &View) -> Vec<String> {
    let Some(status) = &view.status else { return Vec::new() };
    let mut lines = vec![
        status.pose.map_or("at      -".to_owned(), |pose| {
            let yaw_deg = pose.yaw_deg.round() + 0.0;
            format!("at      {:+.2} {:+.2} {:.2} m {yaw_deg:+.0}°", pose.x_m, pose.y_m, pose.z_m)
        }),
        match (status.target, status.distance_m) {
            (Some(target), Some(distance_m)) => format!(
                "target  {:+.2} {:+.2} {:.2} m, {distance_m:.2} m off",
                target.x_m, target.y_m, target.z_m
            ),
            _ => "target  -".to_owned(),
        },
        format!("uncertainty {:.2} m, {}", status.uncertainty_m, rests_on(status)),
        timing(&view.ticks),
    ];
    if !view.not_ready.is_empty() {
        lines.insert(0, format!("NOT READY: {}", view.not_ready.join("; ")));
    } else if status.phase == Phase::Standby {
        lines.insert(0, "ready to take off".to_owned());
    }
    if let Some([roll_deg, pitch_deg]) = status.attitude_deg {
        lines.push(format!("tilt    {roll_deg:+.1}° right, {:+.1}° forward", -pitch_deg));
    }
    if let Some(gps) = status.gps {
        lines.push(format!(
            "gps     {:.5} {:.5}, ±{:.0} m",
            gps.latitude_deg, gps.longitude_deg, gps.horizontal_error_m
        ));
    }
    lines
}

/// What this rests on, in the room that there is.
fn rests_on(status: &Status) -> String {
    match (status.contradicted_by, status.rests_on) {
        (Some(by), _) => format!("CONTRADICTED: {}", by.name()),
        (None, RestsOn::Velocity) => "by velocity alone".to_owned(),
        (None, RestsOn::Tag { seen_ago }) => format!("tag {:.1} s ago", seen_ago.as_secs_f64()),
    }
}

fn timing(health: &TickHealth) -> String {
    let late_ms = health.lateness.as_secs_f64() * 1e3;
    format!("timing  {late_ms:.1} ms late, ticks skipped: {}", health.skipped)
}

/// The plan with its current step.
fn draw_steps(frame: &mut Frame<'_>, area: Rect, view: &View) {
    let current = view.status.and_then(|status| status.step);
    let (columns, rows) =
        (area.width.saturating_sub(2).into(), area.height.saturating_sub(2).into());
    let first = current.unwrap_or(0).saturating_sub(rows / 2);
    let first = first.min(view.steps.len().saturating_sub(rows));
    let steps = view.steps.iter().enumerate().skip(first);
    let steps: Vec<ListItem<'_>> = steps
        .map(|(index, text)| {
            let (mark, style) = if Some(index) == current {
                (">", Style::new().fg(TARGET).add_modifier(Modifier::BOLD))
            } else {
                (" ", Style::new())
            };
            let text = texts::clipped(&format!("{mark} {:>3} {text}", index + 1), columns);
            ListItem::new(text).style(style)
        })
        .collect();
    let title = if view.steps.is_empty() { "no mission: type : and a command" } else { "mission" };
    frame.render_widget(List::new(steps).block(Block::bordered().title(title)), area);
}

#[cfg(test)]
mod tests;
